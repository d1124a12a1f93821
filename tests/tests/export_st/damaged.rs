//! Memory with flipped bits that the number of the design does not show: every variable of the block, one after another,
//! holds something else. Nothing outside of the delay line is touched, the output stays a number within its limits.

use crate::compiled::{compile, compiler, folder, not_run, run};
use crate::loops::{all, scenario};
use crate::text_bits::text;
use crate::translate::{Translated, translate};
use controller_sim_host::export::Export;
use controller_sim_host::export::block::{Block, IN_FORCE, Role, Type};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::fmt::Write;
use std::process::{Command, Stdio};

/// Samples of a case: a loop that begins anew, then the damage in the middle.
const CASE: usize = 60;

/// What a damaged variable of a type holds, in C.
fn values(kind: Type, cells: i64) -> Vec<String> {
    match kind {
        Type::Flag => vec!["!WAS".to_owned()],
        Type::Word => vec!["0u".to_owned(), "0xFFFFFFFFu".to_owned()],
        Type::Count => {
            [i64::from(i32::MIN), -1_000_000_000, -cells, -1, cells, cells + 1, i64::from(i32::MAX)]
                .map(|n| format!("(int32_t)({n}LL)"))
                .to_vec()
        }
        Type::Real | Type::Long => {
            ["(0.0f / 0.0f)", "(1.0f / 0.0f)", "-3.0e38f", "1.0e-45f"].map(str::to_owned).to_vec()
        }
    }
}

/// What is damaged. Limits of the output that are others are not the limits any more.
fn damages(block: &Block) -> Vec<(String, String)> {
    let cells = block.variables.iter().find_map(|v| v.cells).unwrap_or(10);
    let cells = i64::try_from(cells).expect("a size");
    let spared = [IN_FORCE, "OP_LIM_LO", "OP_LIM_HI"];
    let own = |role: Role| !matches!(role, Role::Input | Role::Output);
    let mut list = Vec::new();
    for v in block.variables.iter().filter(|v| own(v.role) && !spared.contains(&v.name.as_str())) {
        let place = if v.cells.is_some() { format!("v_{}[1]", v.name) } else { format!("v_{}", v.name) };
        list.extend(values(v.kind, cells).into_iter().map(|value| (place.clone(), value)));
    }
    list
}

/// The program with the damage before a sample in the middle of every case.
fn damaged(translated: &Translated, damages: &[(String, String)]) -> String {
    let mut fault = String::from("static long sample;\nstatic void damage(void)\n{\n");
    let _ = writeln!(fault, "if (sample % {CASE} == 0) {{ v_{IN_FORCE} = 0; }}");
    let _ = writeln!(fault, "if (sample++ % {CASE} != {}) {{ return; }}", CASE / 2);
    let _ = writeln!(fault, "switch (sample / {CASE}) {{");
    for (n, (place, value)) in damages.iter().enumerate() {
        let _ = writeln!(fault, "case {n}: {place} = {}; break;", value.replace("WAS", place));
    }
    fault += "}\n}\nstatic void step(void)\n{\ndamage();\n";
    let opening = "static void step(void)\n{\n";
    assert!(translated.source.contains(opening), "{}", translated.source);
    translated.source.replacen(opening, &fault, 1)
}

/// A loop at work; with `tuned` other parameters in every sample.
fn records(translated: &Translated, block: &Block, cases: usize, tuned: bool) -> Vec<f64> {
    use controller_sim_host::export::block::Initial;
    let begins = |name: &str| match block.variable(name).map(|v| &v.initial) {
        Some(Initial::Number(value)) => *value,
        _ => 0.0,
    };
    let mut records = Vec::new();
    for k in 0..cases * CASE {
        let odd = k % 2 == 1;
        records.extend(translated.inputs.iter().map(|name| match name.as_str() {
            "SP" => 0.5,
            "PV" => 0.4 + if odd { 0.01 } else { 0.0 },
            "PV_QUALITY" => 2.0,
            "AUTO" | "COMPENSATE" => 1.0,
            "KP" if tuned && odd => 1.01 * begins("KP"),
            name => begins(name),
        }));
    }
    records
}

/// Whether the C compiler knows `options`; some installations lack the library of a check.
fn takes(cc: &str, options: &[&str]) -> bool {
    let file = folder().join("takes.c");
    std::fs::write(&file, "int main(void) { return 0; }\n").expect("the source can be written");
    let mut command = Command::new(cc);
    command.args(options).arg("-o").args([folder().join("takes"), file]);
    command.stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

fn check(cc: &str, scenario: &Scenario, spec: &ControllerSpec, precision: Precision, options: &[&str]) {
    let export = Export::new(scenario, spec, precision, None).expect("a loop");
    let block = export.block("test").expect("a block");
    let translated = translate(&text(scenario, spec, precision)).expect("a translation");
    let damages = damages(&block);
    let file = format!("damaged_{}_{precision:?}", spec.name).replace([' ', ','], "_");
    let program = compile(cc, &file, &damaged(&translated, &damages), options);
    let op = translated.outputs.iter().position(|name| name == "OP").expect("an output");
    let limits = spec.config.limits;
    for tuned in [false, true] {
        let given = run(&program, &records(&translated, &block, damages.len(), tuned));
        assert_eq!(given.len(), damages.len() * CASE * translated.outputs.len());
        for (k, outputs) in given.chunks(translated.outputs.len()).enumerate() {
            let u = outputs[op];
            let what = &damages[k / CASE];
            assert!((limits.lo..=limits.hi).contains(&u), "{} {precision:?} {what:?}: {u}", spec.name);
            // A loop that begins anew has nothing of the damage before.
            let healthy = given[k % CASE * translated.outputs.len() + op];
            let begun = k % CASE < CASE / 2;
            assert!(!begun || u.to_bits() == healthy.to_bits(), "{} {precision:?} after {what:?}", spec.name);
        }
    }
}

#[test]
fn flipped_bits_lead_nowhere_outside() {
    let Some(cc) = compiler() else { return not_run("exported blocks on damaged memory", "no C compiler") };
    // An index outside ends a translated program by itself; an overflow of a whole number is to end it, too.
    let mut options = vec!["-O1"];
    let checks = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    if takes(cc, &checks) {
        options.extend(checks);
    } else {
        not_run("the sanitizers on damaged memory", "the C compiler has none");
    }
    let scenario = scenario(all());
    for (n, spec) in scenario.controllers.iter().enumerate() {
        check(cc, &scenario, spec, [Precision::F32, Precision::F64][n % 2], &options);
    }
}

/// The way in which the test above finds an index outside: without the question for `NEWEST` the program ends.
#[test]
fn without_the_check_the_index_leads_outside() {
    let Some(cc) = compiler() else { return not_run("exported blocks on damaged memory", "no C compiler") };
    let scenario = scenario(all());
    let spec = scenario.controllers.iter().find(|spec| spec.name == "DOB first order").expect("a loop");
    let export = Export::new(&scenario, spec, Precision::F32, None).expect("a loop");
    let block = export.block("test").expect("a block");
    let text = text(&scenario, spec, Precision::F32);
    let unchecked = text.replace("NEWEST < 0", "NEWEST < -2147483647");
    assert_eq!(text.matches("NEWEST < 0").count(), 2, "one for the sample, one for tuning");
    for (name, text, well) in [("checked", &text, true), ("unchecked", &unchecked, false)] {
        let translated = translate(text).expect("a translation");
        let damages = [("v_NEWEST".to_owned(), "-7".to_owned())];
        let source = damaged(&translated, &damages);
        let program = compile(cc, &format!("damaged_{name}"), &source, &["-O0"]);
        let records = folder().join(format!("damaged_{name}.bin"));
        let bytes = self::records(&translated, &block, 1, true).into_iter().flat_map(f64::to_ne_bytes);
        std::fs::write(&records, bytes.collect::<Vec<u8>>()).expect("the records can be written");
        let input = std::fs::File::open(&records).expect("they can be read");
        let status = Command::new(program).stdin(input).stdout(Stdio::null()).status().expect("it starts");
        assert_eq!(status.success(), well, "{name}: {status}");
    }
}
