//! The integral gain against the integral of the error that a load leaves in a run.

use super::cases::loops;
use controller_sim_host::scenario::{Change, Signal};
use controller_sim_host::simulate::{Precision, RunOptions, run};

/// After a unit load the integral of the error is 1/K_i, exactly so once the loop is at rest: with an estimator `1 - kfd` of
/// what the PID alone would leave, with an observer nothing, also where their models are wrong.
#[test]
fn the_integral_gain_is_what_a_load_leaves() {
    let mut seen = [0; 2];
    for case in loops() {
        let card = case.card(Precision::F64);
        let Some(ki) = card.value("ki") else { continue };
        let mut scenario = case.scenario();
        scenario.events[0].changes = vec![Change::Disturbance(Signal::Step(1.0))];
        scenario.duration = 30_000.0 * case.ts;
        scenario.substeps = 1;
        let result = run(&scenario, RunOptions { precision: Precision::F64, ..RunOptions::default() });
        let ie = result.expect("it runs").controllers[0].total.ie.abs();
        let own = case.spec.config.pid.ki.abs();
        seen[usize::from(ki.is_finite())] += 1;
        // Both in parts of what the PID alone would leave: the rest of 30 000 samples and of as many roundings.
        let (card, run) = (own / ki, own * ie);
        assert!((card - run).abs() < 1e-6, "{}: 1/K_i is {card} on the card, {run} in a run", case.name);
    }
    assert!(seen[0] >= 3 && seen[1] >= 12, "{seen:?}");
}
