//! A transfer function in one of the forms people have it in: an expression, polynomials, or a few parameters.

use super::expression;
use super::fault::{Fault, code};
use super::number::Allowed;
use super::table::{Located, Table};
use controller_design::model::{MAX_DEGREE, Polynomial, TransferFunction, parse};
use std::ops::Range;

/// The keys of which one says what a model is.
pub(super) const FORMS: [&str; 5] = ["tf", "num", "fopdt", "sopdt", "ipdt"];

const EXAMPLES: &str =
    "`tf = \"exp(-0.2*s)/(1+s)\"`, or `fopdt = { gain = 1.0, tau = 1.0, dead_time = 0.2 }`";
const EITHER: &str = "an expression in quotes, or a table such as `{ fopdt = { gain = 1.0, tau = 1.0 } }`";
const LIST: &str = "the coefficients of falling powers of s: `[2.0, 1.0]` is 2*s+1";
const FOPDT: &str = "`fopdt = { gain = 1.0, tau = 1.0, dead_time = 0.2 }`";
const SOPDT: &str = "`sopdt = { gain = 1.0, tau1 = 1.0, tau2 = 0.2, dead_time = 0.2 }`";
const IPDT: &str = "`ipdt = { gain = 1.0, dead_time = 0.2 }`";

const DEAD_TIME: Allowed = Allowed::new(0.0, 1e12, "s");

/// The model that the keys of `table` are; other keys are the caller's.
pub(super) fn read(table: &Table<'_>) -> Option<Located<TransferFunction>> {
    // A denominator alone is a model that lacks its numerator.
    let named =
        |form: &'static str| table.span(form).is_some() || (form == "num" && table.span("den").is_some());
    let given: Vec<&'static str> = FORMS.into_iter().filter(|form| named(form)).collect();
    let dead_time = dead_time_of_polynomials(table, &given);
    let [form] = given[..] else {
        several(table, &given);
        return None;
    };
    match form {
        "tf" => expression::read(table, "tf"),
        "num" => polynomials(table, dead_time),
        "fopdt" => table.table("fopdt", FOPDT).and_then(fopdt),
        "sopdt" => table.table("sopdt", SOPDT).and_then(sopdt),
        _ => table.table("ipdt", IPDT).and_then(ipdt),
    }
}

/// The model that is the value of `key`: an expression, or a table of the other forms.
pub(super) fn value(table: &Table<'_>, key: &'static str) -> Option<Located<TransferFunction>> {
    if table.is_text(key) {
        return expression::read(table, key);
    }
    let part = table.table(key, EITHER)?;
    let model = read(&part);
    part.finish();
    model
}

/// There is no model or more than one.
fn several(table: &Table<'_>, given: &[&'static str]) {
    let places: Vec<_> = given
        .iter()
        .filter_map(|&form| Some((form, table.key_span(form).or_else(|| table.key_span("den"))?)))
        .collect();
    let (Some((first, first_at)), Some((second, second_at))) = (places.first(), places.get(1)) else {
        table.missing_one_of(&["tf", "num", "den", "fopdt", "sopdt", "ipdt"], EXAMPLES);
        return;
    };
    let [one, other] = [(*first, first_at.clone()), (*second, second_at.clone())];
    two_plants(table, one, other);
}

/// Reports two plants, each with the place of its key. Their own mistakes are not looked for.
pub(super) fn two_plants(
    table: &Table<'_>,
    (first, first_at): (&str, Range<usize>),
    (second, second_at): (&str, Range<usize>),
) {
    let message =
        format!("`{}` and `{}` are two plants; one of them is needed", table.name(first), table.name(second));
    let fault = Fault::new(code::CONFLICT, second_at, message).help("remove one of the two");
    table.log.fault(fault.related(first_at, "the other one"));
    // The keys are known all the same.
    for key in FORMS.into_iter().chain(["den", "dead_time"]) {
        let _ = table.span(key);
    }
}

/// `dead_time` beside `num` and `den`; none when it is wrong.
fn dead_time_of_polynomials(table: &Table<'_>, given: &[&'static str]) -> Option<f64> {
    let Some(span) = table.key_span("dead_time") else { return Some(0.0) };
    let help = match given {
        ["tf"] => "write it in the expression, as a factor `exp(-0.5*s)`",
        [form @ ("fopdt" | "sopdt" | "ipdt")] => {
            let message = format!("`{}` belongs into the braces of `{form}`", table.name("dead_time"));
            let help = "outside of them it is the dead time of `num` and `den`";
            table.log.fault(Fault::new(code::CONFLICT, span, message).help(help));
            return None;
        }
        _ => return table.number_in("dead_time", DEAD_TIME).map(|time| time.value),
    };
    let message = format!("`{}` belongs to `num` and `den`", table.name("dead_time"));
    table.log.fault(Fault::new(code::CONFLICT, span, message).help(help));
    None
}

/// `num`, `den`, descending.
fn polynomials(table: &Table<'_>, dead_time: Option<f64>) -> Option<Located<TransferFunction>> {
    for (key, example) in [("num", "`num = [1.0]`"), ("den", "`den = [2.0, 1.0]`")] {
        if table.span(key).is_none() {
            table.missing(key, &format!("{example}, the coefficients of falling powers of s"));
        }
    }
    let (num, den) = (table.numbers("num", MAX_DEGREE + 1, LIST), table.numbers("den", MAX_DEGREE + 1, LIST));
    let (num, den, dead_time) = (num?, den?, dead_time?);
    for (key, list) in [("num", &num), ("den", &den)] {
        if list.value.iter().all(|c| *c == 0.0) {
            let message = format!("`{} = {}` is 0 for every s", table.name(key), table.log.slice(&list.span));
            table.log.fault(Fault::new(code::OUT_OF_RANGE, list.span.clone(), message));
            return None;
        }
    }
    let ascending = |list: &[f64]| Polynomial::new(list.iter().rev().copied().collect::<Vec<_>>());
    let model = TransferFunction::from_polynomials(&ascending(&num.value), &ascending(&den.value), dead_time);
    match model {
        Ok(value) => Some(Located { value, span: den.span }),
        Err(error) => {
            let message = format!("`{}` over `{}`: {error}", table.name("num"), table.name("den"));
            table
                .log
                .fault(Fault::new(code::EXPRESSION, num.span, message).related(den.span, "the denominator"));
            None
        }
    }
}

fn fopdt(table: Table<'_>) -> Option<Located<TransferFunction>> {
    let gain = gain(&table);
    let tau = time(&table, "tau", "the time constant in seconds: `tau = 1.0`");
    let dead_time = dead_time(&table);
    let text = gain.zip(tau).map(|(gain, tau)| format!("({gain:e})/(1+{tau:e}*s)"));
    build(table, text, dead_time)
}

/// With two time constants, or with frequency and damping; `beta` is the time constant of a zero.
fn sopdt(table: Table<'_>) -> Option<Located<TransferFunction>> {
    let gain = gain(&table);
    let oscillating = table.key_span("omega").or_else(|| table.key_span("zeta"));
    let lagging = table.key_span("tau1").or_else(|| table.key_span("tau2"));
    let den = match (oscillating, lagging) {
        (Some(one), Some(other)) => {
            let message = "`omega` and `zeta` are given beside `tau1` and `tau2`; one pair is needed";
            let fault = Fault::new(code::CONFLICT, one, message).help("remove one of the two pairs");
            table.log.fault(fault.related(other, "the other pair"));
            for key in ["omega", "zeta", "tau1", "tau2"] {
                let _ = table.span(key);
            }
            None
        }
        (Some(_), None) => {
            let omega = required(
                &table,
                "omega",
                Allowed::new(1e-12, 1e12, "rad/s"),
                "the natural frequency in rad/s: `omega = 1.0`",
            );
            let zeta = required(&table, "zeta", Allowed::new(0.0, 1000.0, ""), "the damping: `zeta = 0.7`");
            omega.zip(zeta).map(|(omega, zeta)| {
                format!("(1+{:e}*s+{:e}*s^2)", 2.0 * zeta / omega, 1.0 / (omega * omega))
            })
        }
        (None, _) => {
            let tau1 = time(&table, "tau1", "the longer time constant in seconds: `tau1 = 1.0`");
            let tau2 = time(&table, "tau2", "the shorter time constant in seconds: `tau2 = 0.2`");
            tau1.zip(tau2).map(|(tau1, tau2)| format!("((1+{tau1:e}*s)*(1+{tau2:e}*s))"))
        }
    };
    let zero = match table.span("beta") {
        Some(_) => table.number_in("beta", Allowed::new(-1e12, 1e12, "s")).map(|beta| beta.value),
        None => Some(0.0),
    };
    let dead_time = dead_time(&table);
    let top = gain.zip(zero).map(|(gain, beta)| format!("({gain:e})*(1+({beta:e})*s)"));
    let text = top.zip(den).map(|(top, den)| format!("{top}/{den}"));
    build(table, text, dead_time)
}

fn ipdt(table: Table<'_>) -> Option<Located<TransferFunction>> {
    let gain = gain(&table);
    let lag = match table.span("tau") {
        Some(_) => table.number_in("tau", Allowed::TIME).map(|tau| format!("*(1+{:e}*s)", tau.value)),
        None => Some(String::new()),
    };
    let dead_time = dead_time(&table);
    let text = gain.zip(lag).map(|(gain, lag)| format!("({gain:e})/(s{lag})"));
    build(table, text, dead_time)
}

/// Finishes the table of a form and builds what `text` says, with a dead time. The numbers in it are printed exactly,
/// and its factors are kept.
fn build(
    table: Table<'_>,
    text: Option<String>,
    dead_time: Option<f64>,
) -> Option<Located<TransferFunction>> {
    let (place, name, log) = (table.place.clone(), table.whole_name(), table.log);
    table.finish();
    match parse(&format!("exp(-{:e}*s)*{}", dead_time?, text?)) {
        Ok(value) => Some(Located { value, span: place }),
        Err(errors) => {
            let reason = errors.first().map_or("", |error| &error.message);
            log.fault(Fault::new(code::EXPRESSION, place, format!("`{name}`: {reason}")));
            None
        }
    }
}

fn gain(table: &Table<'_>) -> Option<f64> {
    if table.span("gain").is_none() {
        table.missing("gain", "the gain: `gain = 1.0`");
    }
    let gain = table.number("gain", Some(Allowed::new(-1e15, 1e15, "")))?;
    if (1e-15..=1e15).contains(&gain.value.abs()) {
        return Some(gain.value);
    }
    let raw = table.log.slice(&gain.span);
    table.out_of_range("gain", &gain.span, raw, "size 1e-15 to 1e15");
    None
}

fn time(table: &Table<'_>, key: &'static str, example: &str) -> Option<f64> {
    required(table, key, Allowed::TIME, example)
}

fn dead_time(table: &Table<'_>) -> Option<f64> {
    match table.span("dead_time") {
        Some(_) => table.number_in("dead_time", DEAD_TIME).map(|time| time.value),
        None => Some(0.0),
    }
}

fn required(table: &Table<'_>, key: &'static str, allowed: Allowed, example: &str) -> Option<f64> {
    if table.span(key).is_none() {
        table.missing(key, example);
    }
    table.number_in(key, allowed).map(|number| number.value)
}
