//! Bad measurements in the middle of transients: one costs next to nothing, many never make the output jump.

use controller_sim_host::scenario::{Change, Event, Scenario};
use controller_sim_host::simulate::{RunOptions, RunResult, run};
use controller_tests::cases::{DISTURBANCE_STEP, SETPOINT_STEP, chapter_controllers, from_rest};
use controller_tests::oracle::de_cases::{CASES, DeCase};

/// `A1/A0 = sum of lags + dead time` of the process: its mean response time \[s\].
fn mean_time(case: &DeCase) -> f64 {
    case.plant.lags.iter().sum::<f64>() + case.plant.dead_time
}

fn result(case: &DeCase, change: &Change, bad: Option<(f64, u32)>) -> RunResult {
    let spec = chapter_controllers(case).remove(2);
    let mut scenario: Scenario = from_rest(&case.plant, case.ts, case.horizon, change.clone(), vec![spec]);
    if let Some((at, n)) = bad {
        scenario.events.push(Event {
            at,
            label: String::new(),
            changes: vec![Change::BadSamples(n)],
            controller: None,
        });
    }
    run(&scenario, RunOptions { trace: true, ..RunOptions::default() }).expect("valid parameters")
}

#[test]
fn bad_samples_in_transients_with_the_estimator() {
    println!("process  step         bad samples  from [s]  IAE [%]   |u| at return  (before)");
    for index in [0, 2, 4] {
        let case = &CASES[index];
        let mean = mean_time(case);
        for (what, change) in [("set-point", &SETPOINT_STEP), ("disturbance", &DISTURBANCE_STEP)] {
            let plain = result(case, change, None).controllers[0].total.iae;
            for n in [1, 20, (0.5 * mean / case.ts) as u32] {
                for share in [0.25, 0.5, 1.0] {
                    let first = (share * mean / case.ts).round();
                    let at = first * case.ts;
                    let run = result(case, change, Some((at, n)));
                    let one = &run.controllers[0];
                    let cost = 100.0 * (one.total.iae / plain - 1.0);
                    let sample = |k: usize| one.trace[k];
                    let back = first as usize + n as usize;
                    let (held, u) = (sample(back - 1).u, sample(back).u);
                    println!(
                        "{}      {what:12} {n:6}       {at:6.3}   {cost:+9.3}  {u:+8.3}      ({held:+.3})",
                        case.name
                    );
                    assert!(sample(back - 1).y.is_nan() && sample(back).y.is_finite());
                    assert!(one.trace.iter().all(|s| s.u.is_finite()));
                    if n == 1 {
                        assert!(cost <= 0.5, "{} {what} at {at}: one lost sample costs {cost} %", case.name);
                    }
                    assert!(u.abs() <= 3.0, "{} {what} n {n} at {at}: |u| at return {u}", case.name);
                }
            }
        }
    }
}
