//! The test program's trace: replayed through the block, it passes; with another number, it would not.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, scenario};
use crate::print_c::program;
use controller_sim_host::export::block::{Block, Expression, Initial, Place, Role, Statement};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::simulate::Precision;
use std::collections::{HashMap, HashSet};

/// The arrays of the program, by name, as a reader of its text finds them.
fn arrays(text: &str) -> HashMap<String, Vec<f64>> {
    let mut arrays: HashMap<String, Vec<f64>> = HashMap::new();
    for line in text.lines().map(str::trim) {
        if let Some((name, _)) = line.split_once(" : ARRAY [0..219] OF ") {
            arrays.insert(name.to_owned(), vec![0.0; 220]);
        }
        let Some((place, value)) = line.trim_end_matches(';').split_once(" := ") else { continue };
        let Some((name, index)) = place.split_once('[') else { continue };
        let index: usize = index.trim_end_matches(']').parse().expect("an index");
        arrays.get_mut(name).expect("declared")[index] = match value {
            "TRUE" => 1.0,
            "FALSE" => 0.0,
            word => word.parse().expect("a number"),
        };
    }
    arrays
}

/// Samples of the trace in which an output of the block differs.
fn differing(
    cc: &str,
    name: &str,
    block: &Block,
    precision: Precision,
    trace: &HashMap<String, Vec<f64>>,
) -> usize {
    let samples = trace["IN_SP"].len();
    let list = |role: Role| block.variables.iter().filter(move |v| v.role == role);
    let mut records = Vec::new();
    for k in 0..samples {
        records.extend(list(Role::Input).map(|v| match (trace.get(&format!("IN_{}", v.name)), &v.initial) {
            (Some(column), _) => column[k],
            (None, Initial::Number(x)) => *x,
            (None, Initial::Count(n)) => f64::from(*n),
            (None, Initial::Flag(is)) => f64::from(u8::from(*is)),
            (None, _) => 0.0,
        }));
    }
    let given = run(&compile(cc, name, &program(block, precision), &["-O1"]), &records);
    let width = list(Role::Output).count();
    let same = |out: &[f64], k: usize| {
        let compared = list(Role::Output)
            .zip(out)
            .filter_map(|(v, x)| trace.get(&format!("OUT_{}", v.name)).map(|column| column[k] == *x));
        let compared: Vec<bool> = compared.collect();
        assert_eq!(compared.len(), width, "every output is compared");
        compared.iter().all(|same| *same)
    };
    given.chunks(width).enumerate().filter(|(k, out)| !same(out, *k)).count()
}

#[test]
fn the_test_program_passes_on_its_block_and_on_no_other() {
    let Some(cc) = compiler() else { return not_run("the trace of test programs", "no C compiler") };
    let scenario = scenario(all());
    for spec in &scenario.controllers {
        for precision in [Precision::F32, Precision::F64] {
            let export = Export::new(&scenario, spec, precision, None).expect("a loop");
            let mut block = export.block("test").expect("a block");
            let trace = arrays(&export.text(Format::StructuredTextTest, "test").expect("a program"));
            assert_eq!(trace["IN_SP"].len(), 220);
            let name = format!("trace {} {precision:?}", spec.name).replace([' ', ','], "_");
            assert_eq!(differing(cc, &name, &block, precision, &trace), 0, "{name}");
            let status = trace["OUT_STATUS"].iter().fold(0, |all, bits| all | *bits as u32);
            assert!(status & 0xA0 == 0xA0 || spec.config.fallback.hold_samples == 0, "{name}: {status:x}");
            let modes: HashSet<u32> = trace["OUT_MODE"].iter().map(|mode| *mode as u32).collect();
            let held = spec.config.fallback.hold_samples < 7;
            assert!(
                (1..=6).all(|mode| modes.contains(&mode)) && modes.contains(&7) == held,
                "{name}: {modes:?}"
            );
            assert!(spec.config.pid.kp == 0.0 || status & 1 << 26 != 0, "{name}: nothing was refused");
            // The gain of a step of the measurement a thousandth away.
            let gain = value_of(&mut block.body, "H_Y").expect("a coefficient");
            *gain = match precision {
                Precision::F32 => f64::from((*gain * 1.001) as f32),
                Precision::F64 => *gain * 1.001,
            };
            assert!(differing(cc, &format!("{name}_other"), &block, precision, &trace) > 10, "{name}");
        }
    }
}

/// The number that the block gives a variable when it begins.
fn value_of<'a>(statements: &'a mut [Statement], name: &str) -> Option<&'a mut f64> {
    let Some(Statement::If(branches, _)) = statements.first_mut() else { return None };
    branches.first_mut()?.1.iter_mut().find_map(|statement| match statement {
        Statement::Assign(Place::Variable(place), Expression::Number(value)) if place == name => Some(value),
        _ => None,
    })
}
