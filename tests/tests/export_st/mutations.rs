//! Texts with one mistake each: a mistake that is made in printing, which the block knows nothing of, has other bits.
//!
//! The C that is made of the block itself stays as it is whatever the text says: only the text's own way finds these.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, scenario};
use crate::recorded::Recorded;
use crate::text_bits::{text, translated};
use controller_sim_host::export::block::{Initial, Role};
use controller_sim_host::simulate::Precision;

/// `text` with its last statement for which `other` gives another.
fn last(text: &str, other: impl Fn(&str) -> Option<String>) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let statement = |line: &str| !line.trim_start().starts_with("(*") && !line.contains(" : ");
    let found = lines.iter().enumerate().rev().filter(|(_, line)| statement(line));
    let (at, new) = found.filter_map(|(at, line)| Some((at, other(line)?))).next().expect("such a statement");
    lines[at] = new;
    lines.join("\n") + "\n"
}

/// Another operator in the last assignment that has this one.
pub(crate) fn swapped(text: &str, operator: &str, other: &str) -> String {
    last(text, |line| {
        (line.contains(" := ") && line.contains(operator)).then(|| line.replacen(operator, other, 1))
    })
}

/// The last `NOT (..)` of a row of conditions without its parentheses.
fn without_parentheses(text: &str) -> String {
    last(text, |line| {
        let (before, inner) = line.split_once("NOT ((")?;
        let mut depth = 1;
        let end = inner.bytes().position(|c| {
            depth += i32::from(c == b'(') - i32::from(c == b')');
            depth < 0
        })?;
        let (inner, after) = (&inner[..end], &inner[end + 1..]);
        Some(format!("{before}NOT ({inner}{after}"))
    })
}

/// The number that `name` begins with, with another last digit: the next one of double precision or nearly so. `None` for what is
/// computed.
fn next_digit(text: &str, name: &str) -> Option<String> {
    let number = |line: &&str| {
        let value = line.trim_start().strip_prefix(&format!("{name} := "))?.split_once(';')?.0;
        value.parse::<f64>().ok()
    };
    let line = text.lines().find(|line| number(line).is_some())?;
    let (before, value) = line.split_once(" := ").expect("a value");
    let (value, after) = value.split_once(';').expect("its end");
    let (digits, exponent) =
        value.split_once('E').map_or((value, String::new()), |(d, e)| (d, format!("E{e}")));
    let (kept, old) = digits.split_at(digits.len() - 1);
    let parsed = |digits: &str| format!("{digits}{exponent}").parse::<f64>().expect("a number");
    let steps = (1..10).flat_map(|step| [step, -step]);
    let old_digit: i32 = old.parse().expect("a digit");
    let digits = steps
        .map(|step| old_digit + step)
        .filter(|digit| (0..10).contains(digit))
        .map(|digit| format!("{kept}{digit}"))
        .find(|other| parsed(other).to_bits() != parsed(digits).to_bits())
        .expect("another number");
    Some(text.replacen(line, &format!("{before} := {digits}{exponent};{after}"), 1))
}

#[test]
fn a_mistake_in_the_text_has_other_bits() {
    let Some(cc) = compiler() else { return not_run("mistakes in exported texts", "no C compiler") };
    let scenario = scenario(all());
    let spec = &scenario.controllers[0];
    let recorded = Recorded::<f64>::new(&scenario, spec, Precision::F64, false, 4000);
    let right = text(&scenario, spec, Precision::F64);
    let mut texts = vec![
        ("right".to_owned(), right.clone()),
        ("sum for difference".to_owned(), swapped(&right, " - ", " + ")),
        ("difference for sum".to_owned(), swapped(&right, " + ", " - ")),
        ("quotient for product".to_owned(), swapped(&right, " * ", " / ")),
        ("above for below".to_owned(), swapped(&right, " < ", " > ")),
        ("and for or".to_owned(), swapped(&right, " OR ", " AND ")),
        ("no parentheses".to_owned(), without_parentheses(&right)),
    ];
    for v in recorded.block.variables.iter().filter(|v| v.role == Role::Coefficient) {
        // A number that stands for a part that this loop has not makes no difference.
        if !matches!(v.initial, Initial::Number(x) if x == 0.0 || x == 1.0) {
            texts.extend(next_digit(&right, &v.name).map(|text| (format!("digit of {}", v.name), text)));
        }
    }
    assert!(texts.len() > 10, "{}", texts.len());
    for (n, (what, text)) in texts.iter().enumerate() {
        assert_eq!(*text == right, n == 0, "{what}");
        let source = translated(what, text, &recorded.block).source;
        let program = compile(cc, &format!("mistake_{}", what.replace(' ', "_")), &source, &["-O0"]);
        let differing = recorded.differing(&run(&program, &recorded.records)).len();
        assert_eq!(differing == 0, n == 0, "{what}: {differing} samples differ");
    }
}
