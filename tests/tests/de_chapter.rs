//! The disturbance estimator against the chapter of Vrancic and Huba (2021): IAE values of all six processes, and the
//! structure with a separate model that the chapter draws.

use controller_sim_host::scenario::Change;
use controller_sim_host::simulate::{Metrics, Precision, RunOptions, run};
use controller_tests::cases::{DISTURBANCE_STEP, SETPOINT_STEP, chapter_controllers, from_rest};
use controller_tests::oracle::de_cases::{CASES, DeCase, IaePair};
use controller_tests::oracle::sampled_loop::UnitStep;
use controller_tests::oracle::structure_a::{StructureA, respond};

/// Metrics of MOMI, DRMO, DE-MOMI for one experiment.
fn metrics(case: &DeCase, change: Change, precision: Precision) -> [Metrics; 3] {
    let scenario = from_rest(&case.plant, case.ts, case.horizon, change, chapter_controllers(case));
    let result = run(&scenario, RunOptions { precision, trace: false, ..RunOptions::default() })
        .expect("valid parameters");
    [0, 1, 2].map(|i| result.controllers[i].total)
}

fn check(precision: Precision, tolerance: f64) {
    let mut worst = 0.0_f64;
    for case in &CASES {
        let tracking = metrics(case, SETPOINT_STEP, precision);
        let rejection = metrics(case, DISTURBANCE_STEP, precision);
        let expected = [Some(case.iae_momi), case.iae_drmo, Some(case.iae_de_momi)];
        for (i, name) in ["MOMI", "DRMO", "DE-MOMI"].into_iter().enumerate() {
            let Some(IaePair { tracking: t, rejection: d }) = expected[i] else { continue };
            for (what, ours, reference) in
                [("tracking", tracking[i].iae, t), ("rejection", rejection[i].iae, d)]
            {
                let error = (ours / reference - 1.0).abs();
                worst = worst.max(error);
                println!(
                    "{} {name:8} {what:9} {ours:.6} reference {reference:.6} ({:+.3} %)",
                    case.name,
                    100.0 * (ours / reference - 1.0)
                );
                assert!(error <= tolerance, "{} {name} {what}: {ours} against {reference}", case.name);
            }
        }
    }
    println!("worst {:.3} %", 100.0 * worst);
}

#[test]
fn iae_of_the_six_processes_in_double_precision() {
    check(Precision::F64, 0.005);
}

#[test]
fn iae_of_the_six_processes_in_single_precision() {
    check(Precision::F32, 0.01);
}

/// The runtime's exact pair and structure A (a model beside the plant, one filter behind the difference) are the same
/// law: 0.1 % of IAE for `Ts/T_FD <= 0.2`.
#[test]
fn the_estimator_equals_the_structure_of_the_chapter() {
    for case in &CASES {
        assert!(case.ts / case.estimator.tfd <= 0.2);
        for (change, step) in
            [(SETPOINT_STEP, UnitStep::Reference), (DISTURBANCE_STEP, UnitStep::InputDisturbance)]
        {
            let ours = metrics(case, change, Precision::F64)[2];
            let limits = (-1e6, 1e6);
            let structure = StructureA::new(case.momi, Some(case.estimator), limits, case.ts);
            let fine = case.plant.sampled(case.ts / 20.0);
            let theirs = respond(structure, fine, step, case.horizon).measures;
            let deviation = ours.iae / theirs.iae - 1.0;
            println!(
                "{} {step:?}: IAE {:.6}, structure A {:.6} ({:+.4} %)",
                case.name,
                ours.iae,
                theirs.iae,
                100.0 * deviation
            );
            assert!(deviation.abs() <= 1e-3, "{} {step:?}: {} against {}", case.name, ours.iae, theirs.iae);
            assert!((ours.ie - theirs.ie).abs() <= 1e-6 * (1.0 + theirs.ie.abs()));
        }
    }
}
