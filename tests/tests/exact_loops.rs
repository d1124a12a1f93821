//! Closed loops against 50-digit arithmetic that shares nothing with the simulator (`golden/make_loops.py`): plants of
//! order 1 to 6, multiple and complex poles, right-half-plane zeros, one and two integrators, feedthrough, fractions of dead
//! time and latency; disturbances of every exact kind that begin between samples; sensors, actuators, cascades.
//!
//! Tolerance: 1e-9 of the largest output, what is promised. What is to be expected is far less. A step of the plant is a
//! matrix exponential and a product: an error of some 10 units of 1e-16 of the state in each of the samples that the plant
//! remembers, here at most some hundred; the loops settle (the generator checks it), so the closed loop
//! forgets rounding, too. Hence 1e-13 to 1e-12; the table itself is rounded to 13 digits.

use controller_sim_host::simulate::{ClosedLoop, RunOptions, Sample, run};
use controller_tests::golden_loops::{BETWEEN, GoldenLoop, loops};

/// What is promised, relative to the largest output.
const TOLERANCE: f64 = 1e-9;

fn trace(case: &GoldenLoop) -> Vec<Sample> {
    let options = RunOptions { trace: true, ..RunOptions::default() };
    let result = run(&case.scenario, options).unwrap_or_else(|fault| panic!("{}: {fault}", case.name));
    result.controllers.into_iter().next().expect("one controller").trace
}

#[test]
fn the_table_is_complete() {
    let loops = loops();
    for order in 1..=6 {
        assert!(loops.iter().filter(|case| case.order == order).count() >= 3, "order {order}");
    }
    assert!(loops.iter().all(|case| case.rows.len() >= 20));
}

/// Measurement and controller output of every tabulated sample, whatever the steps in between.
#[test]
fn runs_agree_at_the_samples() {
    let mut worst = (0.0_f64, 0.0_f64);
    for mut case in loops() {
        let (y_scale, u_scale) = case.scales();
        let mut here = (0.0_f64, 0.0_f64);
        for substeps in [1, 3, 10] {
            case.scenario.substeps = substeps;
            let trace = trace(&case);
            for row in &case.rows {
                let sample = &trace[row.k];
                here.0 = here.0.max((sample.y - row.y).abs() / y_scale);
                here.1 = here.1.max((sample.u - row.u).abs() / u_scale);
                // Within a decade of each other in the cascades, so one scale does.
                assert_eq!(sample.inner.is_some(), row.inner.is_some(), "{}", case.name);
                if let (Some(inner), Some((r, y))) = (sample.inner, row.inner) {
                    here.0 = here.0.max((inner.r - r).abs().max((inner.y - y).abs()) / y_scale);
                }
            }
        }
        println!("{:62} order {} y {:.1e} u {:.1e}", case.name, case.order, here.0, here.1);
        assert!(here.0 <= TOLERANCE && here.1 <= TOLERANCE, "{}: {here:?}", case.name);
        worst = (worst.0.max(here.0), worst.1.max(here.1));
    }
    println!("worst of all: y {:.1e}, u {:.1e}", worst.0, worst.1);
}

/// The plant under the same controller outputs, at tabulated instants between the samples.
#[test]
fn outputs_agree_between_the_samples() {
    let mut worst = 0.0_f64;
    for mut case in loops() {
        let (y_scale, _) = case.scales();
        // The same steps as below: an unstable plant forgets no rounding without its loop.
        case.scenario.substeps = 10;
        let trace = trace(&case);
        let scenario = &case.scenario;
        let rest = (scenario.initial.setpoint, scenario.initial.disturbance);
        let disturbances = case.disturbances();
        let (mut plant, _) =
            ClosedLoop::new(&scenario.plant, scenario.ts, scenario.latency, 10, rest, &disturbances)
                .expect("rests");
        let mut rows = case.rows.iter().peekable();
        for (k, sample) in trace.iter().enumerate() {
            let row = rows.next_if(|row| row.k == k);
            let mut met = 0;
            plant.hold(sample.applied, |step| {
                let Some(row) = row else { return };
                for (tenths, exact) in BETWEEN.iter().zip(row.between) {
                    let instant = (k as f64 + *tenths as f64 / 10.0) * scenario.ts;
                    if (step.t1 - instant).abs() < 1e-9 * scenario.ts {
                        worst = worst.max((step.y1 - exact).abs() / y_scale);
                        met += 1;
                    }
                }
            });
            assert!(row.is_none() || met == BETWEEN.len(), "{} sample {k}: {met}", case.name);
        }
        assert!(worst <= TOLERANCE, "{}: {worst:e}", case.name);
    }
    println!("worst of all: {worst:.1e}");
}
