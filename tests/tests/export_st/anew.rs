//! Memory that was used before: zero bytes, any bytes, that of another design. The loop begins anew with the bits of a core
//! that begins at the output that is there.

use crate::compiled::{compile, compiler, not_run, run};
use crate::drive::{Driven, initial, outputs};
use crate::loops::{all, scenario};
use crate::print_c::{Memory, program, program_on};
use controller_core::{ControllerConfig, Real};
use controller_sim_host::export::block::{Block, Initial, Role};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::collections::HashMap;

const SAMPLES: u32 = 1500;

fn block(scenario: &Scenario, spec: &ControllerSpec, precision: Precision) -> (Block, usize) {
    let export = Export::new(scenario, spec, precision, None).expect("a loop");
    (export.block("test").expect("a block"), export.capacity())
}

/// The same loop that begins at another output.
fn beginning_at(spec: &ControllerSpec, op: Option<f64>) -> ControllerSpec {
    let initial_output = op.unwrap_or(spec.config.initial_output);
    ControllerSpec { config: ControllerConfig { initial_output, ..spec.config }, ..spec.clone() }
}

/// Runs `block` on `memory` beside a core that begins at `op`; `tuning`: values of KP, TN, TV, TF for a time, from the
/// inputs of another design, which must count as those of this one.
fn compare<T: Real>(
    cc: &str,
    name: &str,
    (scenario, spec, precision): (&Scenario, &ControllerSpec, Precision),
    memory: &Memory<'_>,
    (op, lost): (Option<f64>, bool),
    kept: Option<[T; 4]>,
) {
    let (block, capacity) = block(scenario, spec, precision);
    assert_eq!(block.faults(), Vec::<String>::new(), "{name}");
    let mut driven = Driven::<T>::new(scenario, &beginning_at(spec, op), &block, capacity, 11, false);
    let own = initial::<T>(&block);
    let (mut records, mut expected, mut lost) = (Vec::new(), Vec::new(), lost);
    for k in 0..SAMPLES {
        // Kept inputs, then those of the design, then again the first ones: now they are meant.
        let tuning = if k < 2 * SAMPLES / 3 { own } else { kept.or(own) };
        let (mut sample, out, mut more) = driven.sample_tuned(k, tuning);
        if let (Some(kept), true) = (kept, k < SAMPLES / 3) {
            sample.tuning = kept;
        }
        lost &= !sample.input.acknowledge;
        more.lost = lost;
        records.extend(sample.record(&block));
        expected.push(outputs(&block, &out, &more));
    }
    let file = format!("anew_{name}").replace([' ', ','], "_");
    let given = run(&compile(cc, &file, &program_on(&block, precision, memory), &["-O1"]), &records);
    let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for (k, (expected, given)) in expected.iter().zip(given.chunks(expected[0].len())).enumerate() {
        assert!(
            bits(expected) == bits(given),
            "{name}, sample {k}\nexpected {expected:?}\ngiven    {given:?}"
        );
    }
}

/// No value from a declaration is needed, and none that is in memory counts but the output.
#[test]
fn any_bytes_are_a_cold_start() {
    let Some(cc) = compiler() else { return not_run("exported blocks on used memory", "no C compiler") };
    let scenario = scenario(all());
    for spec in &scenario.controllers {
        // 0xFF: a number that is none. 0x41: 12.08 and 2261634.5, the size of the output's type.
        for (byte, precision, op) in [
            (0x00_u8, Precision::F32, None),
            (0x00, Precision::F64, None),
            (0xFF, Precision::F32, None),
            (0xFF, Precision::F64, None),
            (0x41, Precision::F32, Some(f64::from(f32::from_bits(0x4141_4141)))),
            (0x41, Precision::F64, Some(f64::from_bits(0x4141_4141_4141_4141))),
        ] {
            let name = format!("{} {precision:?} {byte:02x}", spec.name);
            let (loop_, memory) = ((&scenario, spec, precision), Memory::Bytes(byte));
            match precision {
                Precision::F32 => compare::<f32>(cc, &name, loop_, &memory, (op, byte != 0), None),
                Precision::F64 => compare::<f64>(cc, &name, loop_, &memory, (op, byte != 0), None),
            }
        }
    }
}

/// All numbers of `block` after a run of its loop, by name; of an array nothing is kept but that it is full.
fn used<T: Real>(
    cc: &str,
    scenario: &Scenario,
    spec: &ControllerSpec,
    precision: Precision,
) -> (HashMap<String, f64>, Option<[T; 4]>) {
    let (mut block, capacity) = block(scenario, spec, precision);
    let mut driven = Driven::<T>::new(scenario, spec, &block, capacity, 5, false);
    let records: Vec<f64> = (0..600).flat_map(|k| driven.sample(k).0.record(&block)).collect();
    for v in block.variables.iter_mut().filter(|v| v.role != Role::Input && v.cells.is_none()) {
        v.role = Role::Output;
    }
    let names: Vec<String> =
        block.variables.iter().filter(|v| v.role == Role::Output).map(|v| v.name.clone()).collect();
    let file = format!("used_{}_{precision:?}", spec.name).replace([' ', ','], "_");
    let given = run(&compile(cc, &file, &program(&block, precision), &["-O1"]), &records);
    let last = given.chunks(names.len()).next_back().expect("samples").to_vec();
    let mut values: HashMap<String, f64> = names.into_iter().zip(last).collect();
    assert_eq!(values["DESIGN_IN_FORCE"], f64::from(block.design));
    values.insert("DELAY".to_owned(), 77.0);
    (values, initial::<T>(&block))
}

/// The memory of every loop under every other block with the same variables, and more: a loop begins at the output that is
/// there; inputs of tuning that were not touched count as the new design's.
#[test]
fn another_design_begins_anew_where_the_output_is() {
    let Some(cc) = compiler() else {
        return not_run("exported blocks after an online change", "no C compiler");
    };
    let scenario = scenario(all());
    let count = scenario.controllers.len();
    for (n, old) in scenario.controllers.iter().enumerate() {
        for next in [1, 4] {
            let spec = &scenario.controllers[(n + next) % count];
            let (memory, kept) = used::<f32>(cc, &scenario, old, Precision::F32);
            let name = format!("{} after {}", spec.name, old.name);
            let op = Some(memory["OP"]);
            // A loop that could not be tuned leaves nothing at inputs that it did not have.
            let tunable =
                |spec: &ControllerSpec| block(&scenario, spec, Precision::F32).0.variable("KP").is_some();
            let kept = kept.filter(|_| tunable(spec));
            let loop_ = (&scenario, spec, Precision::F32);
            compare::<f32>(cc, &name, loop_, &Memory::Values(&memory), (op, true), kept);
        }
    }
}

/// The same design again, under any head: the number is the same, and a loop goes on as if nothing had been.
#[test]
fn the_number_is_that_of_what_the_block_computes() {
    let scenario = scenario(all());
    let mut numbers = HashMap::new();
    for spec in &scenario.controllers {
        for precision in [Precision::F32, Precision::F64] {
            let export = Export::new(&scenario, spec, precision, None).expect("a loop");
            let number = export.block("a.toml").expect("a block").design;
            assert!(number > 0);
            assert_eq!(number, export.block("another.toml").expect("a block").design);
            let text = export.text(Format::StructuredText, "a.toml").expect("a text");
            assert!(text.contains(&format!("(* Design number {number}. ")), "{text}");
            assert!(text.contains(&format!("\nIF NOT (DESIGN_IN_FORCE = {number}) THEN\n")), "{text}");
            let twin = numbers.insert(number, format!("{} {precision:?}", spec.name));
            assert_eq!(twin, None, "{} {precision:?}", spec.name);
            // Another name is the same loop; another number anywhere is another one.
            let named = ControllerSpec { name: "other".to_owned(), ..spec.clone() };
            let other = |spec: &ControllerSpec| block(&scenario, spec, precision).0.design;
            assert_eq!(other(&named), number);
            let config = ControllerConfig { measurement_hi: 3.9, ..spec.config };
            assert_ne!(other(&ControllerSpec { config, ..spec.clone() }), number);
        }
    }
}

/// No value is taken from a declaration but those of inputs.
#[test]
fn only_inputs_have_initial_values() {
    let scenario = scenario(all());
    for spec in &scenario.controllers {
        let export = Export::new(&scenario, spec, Precision::F32, None).expect("a loop");
        let text = export.text(Format::StructuredText, "a.toml").expect("a text");
        let (declared, _) = text.rsplit_once("END_VAR").expect("declarations");
        let (_, own) = declared.split_once("END_VAR").expect("inputs, then others");
        assert!(!own.contains(":="), "{}", spec.name);
        let block = export.block("a.toml").expect("a block");
        let initial = |v: &&controller_sim_host::export::block::Variable| v.initial != Initial::Zero;
        assert!(block.variables.iter().filter(initial).any(|v| v.role == Role::Input));
    }
}
