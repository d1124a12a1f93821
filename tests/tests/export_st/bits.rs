//! Bit for bit: the statements, compiled as C, against the core's step.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, random, scenario};
use crate::print_c::{program, wide_program};
use crate::recorded::Recorded;
use controller_core::{Real, Status};
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
    let recorded = Recorded::<T>::new(scenario, spec, precision, tuning, SAMPLES);
    let block = &recorded.block;
    let source = program(block, precision);
    let file = recorded.name.replace(' ', "_");
    let mut programs = vec![(&source, "-O0", file.clone()), (&source, "-O2", file.clone())];
    let wide = wide_program(block);
    if precision == Precision::F32 {
        // What the head of the text promises: REAL may be formed in LREAL.
        programs.push((&wide, "-O1", format!("{file}_wide")));
    }
    for (source, options, file) in programs {
        recorded.check(options, &run(&compile(cc, &file, source, &[options]), &recorded.records));
    }
    (recorded.driven.modes, recorded.driven.status, recorded.driven.tuned)
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

/// With `SOAK=1` in the environment many more.
#[test]
fn loops_of_random_parts_step_with_the_bits_of_the_core() {
    let Some(cc) = compiler() else {
        return not_run("random exported blocks against the core", "no C compiler");
    };
    let count = if std::env::var_os("SOAK").is_some() { 600 } else { 24 };
    let scenario = scenario((0..count).map(random).collect());
    for (n, spec) in scenario.controllers.iter().enumerate() {
        let _ = match n % 2 {
            0 => one::<f32>(cc, &scenario, spec, Precision::F32, true),
            _ => one::<f64>(cc, &scenario, spec, Precision::F64, true),
        };
    }
}
