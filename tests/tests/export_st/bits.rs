//! Bit for bit: the statements, compiled as C, against the core's step.

use crate::compiled::{compile, compiler, not_run, run};
use crate::drive::{Driven, outputs};
use crate::loops::{all, scenario};
use crate::print_c::program;
use controller_core::{Real, Status};
use controller_sim_host::export::Export;
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;

const SAMPLES: u32 = 10_000;

/// Compares one loop; gives the modes and the bits that it has seen.
fn one<T: Real>(
    cc: &str,
    scenario: &Scenario,
    spec: &ControllerSpec,
    precision: Precision,
    tuning: bool,
) -> ([u32; 7], u32, [u32; 2]) {
    let name = format!("{} {precision:?} {tuning}", spec.name);
    let export = Export::new(scenario, spec, precision, None).unwrap_or_else(|why| panic!("{name}: {why:?}"));
    let block = export.block("test").expect("a block");
    assert_eq!(block.faults(), Vec::<String>::new(), "{name}");
    let seed = 7 + u64::from(tuning);
    let mut driven = Driven::<T>::new(scenario, spec, &block, export.capacity(), seed, tuning);
    let (mut records, mut expected) = (Vec::new(), Vec::new());
    for k in 0..SAMPLES {
        let (sample, out, refused) = driven.sample(k);
        records.extend(sample.record(&block));
        expected.push((sample, outputs(&block, &out, refused)));
    }
    let source = program(&block, precision);
    let file = name.replace(' ', "_");
    for options in [["-O0"], ["-O2"]] {
        let given = run(&compile(cc, &file, &source, &options), &records);
        let width = expected[0].1.len();
        assert_eq!(given.len(), width * expected.len());
        for (k, ((sample, expected), given)) in expected.iter().zip(given.chunks(width)).enumerate() {
            let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert!(
                bits(expected) == bits(given),
                "{name} {options:?}, sample {k}\nexpected {expected:?}\ngiven    {given:?}\ninput {:?}",
                sample.input
            );
        }
    }
    (driven.modes, driven.status, driven.tuned)
}

#[test]
fn every_loop_steps_with_the_bits_of_the_core() {
    let Some(cc) = compiler() else { return not_run("exported blocks against the core", "no C compiler") };
    let scenario = scenario(all());
    let (mut modes, mut status) = ([0; 7], 0);
    for spec in &scenario.controllers {
        for precision in [Precision::F32, Precision::F64] {
            let (seen, bits, _) = match precision {
                Precision::F32 => one::<f32>(cc, &scenario, spec, precision, false),
                Precision::F64 => one::<f64>(cc, &scenario, spec, precision, false),
            };
            assert!(seen[2] + seen[3] > SAMPLES / 4, "{}: hardly ever closed", spec.name);
            modes.iter_mut().zip(seen).for_each(|(all, more)| *all += more);
            status |= bits;
        }
    }
    assert!(modes.iter().all(|&n| n > 1000), "{modes:?}");
    // Everything that can happen has happened; samples are never lost here.
    for (bit, what) in Status::NAMES {
        assert!(status & bit.bits() != 0 || *bit == Status::OVERRUN, "never {what}");
    }
}

#[test]
fn parameters_that_are_changed_on_site_make_the_law_of_the_core() {
    let Some(cc) = compiler() else { return not_run("tuning on site against the core", "no C compiler") };
    let scenario = scenario(all());
    let mut tuned = [0; 2];
    for spec in &scenario.controllers {
        for precision in [Precision::F32, Precision::F64] {
            let (.., seen) = match precision {
                Precision::F32 => one::<f32>(cc, &scenario, spec, precision, true),
                Precision::F64 => one::<f64>(cc, &scenario, spec, precision, true),
            };
            assert!(spec.config.pid.kp == 0.0 || seen[0] > 40, "{}: {seen:?}", spec.name);
            tuned = [tuned[0] + seen[0], tuned[1] + seen[1]];
        }
    }
    assert!(tuned[0] > 1500 && tuned[1] > 1500, "{tuned:?}");
}
