//! Integral of error, `ts*sum(e)`, settled start: identities that hold exactly for any loop that keeps its static gains.

use controller_core::{
    CompensatorConfig, ControllerConfig, EstimatorConfig, IntegralRule, LimitConfig, PidConfig,
};
use controller_tests::cases::{estimator, pid};
use controller_tests::oracle::de_cases::CASES;
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::rig::{Rig, law};

fn ie(
    plant: &PlantFactors<'_>,
    pid: PidConfig,
    compensator: Option<&CompensatorConfig>,
    (r, d): (f64, f64),
    ts: f64,
    samples: usize,
) -> f64 {
    let config =
        ControllerConfig { pid, limits: LimitConfig::range(-1e5, 1e5), ..ControllerConfig::default() };
    let unused = EstimatorConfig { gain: plant.gain, a1: 1.0, a2: 0.0, dead_time: 0.0, kfd: 0.0, tfd: 1.0 };
    let block = compensator.cloned().unwrap_or_else(|| unused.to_compensator(0.0));
    let mut rig = Rig::<f64>::new(law(&config, &block, ts).expect("valid"), plant.sampled(ts));
    rig.input.compensate = compensator.is_some();
    rig.input.r = r;
    rig.d = d;
    let mut sum = 0.0;
    for _ in 0..samples {
        sum += ts * (r - rig.y());
        let _ = rig.step();
    }
    sum
}

fn agrees(what: &str, ours: f64, exact: f64, size: f64) {
    println!("{what}: {ours:.9} exact {exact:.9}");
    assert!((ours - exact).abs() <= 1e-6 * size, "{what}: {ours} against {exact}");
}

/// Disturbance `-(1-K_FD)/K_I`, tracking `(1/A0 + (1-b) K_P)/K_I`, with and without the estimator, MOMI (`b = 1`) and
/// DRMO (`b = 0`), both integration rules.
#[test]
fn identities_of_the_chapter_hold_for_all_processes() {
    for case in &CASES {
        // Ten times the horizon of the tables; GP6 has a slow tail of 50 s.
        let samples = (10.0 * case.horizon / case.ts) as usize;
        for rule in [IntegralRule::Backward, IntegralRule::Trapezoid] {
            for (design, gains) in [("MOMI", &case.momi), ("DRMO", &case.drmo)] {
                let pid = PidConfig { integral_rule: rule, ..pid(gains) };
                let block = estimator(&case.estimator).to_compensator(0.0);
                let run =
                    |with: bool, what| ie(&case.plant, pid, with.then_some(&block), what, case.ts, samples);
                let name = format!("{} {design} {rule:?}", case.name);
                let (a0, ki) = (case.plant.gain, gains.ki);
                let tracking = (1.0 / a0 + (1.0 - gains.b) * gains.kp) / ki;
                agrees(&format!("{name} tracking"), run(false, (1.0, 0.0)), tracking, tracking);
                agrees(&format!("{name} tracking, DE"), run(true, (1.0, 0.0)), tracking, tracking);
                agrees(&format!("{name} load"), run(false, (0.0, 1.0)), -1.0 / ki, 1.0 / ki);
                let left = -(1.0 - case.estimator.kfd) / ki;
                agrees(&format!("{name} load, DE"), run(true, (0.0, 1.0)), left, 1.0 / ki);
            }
        }
    }
}

/// Partial set-point weights and plants of other gains.
#[test]
fn tracking_identity_with_partial_weight_and_gain() {
    let plant = PlantFactors { gain: -2.5, lags: &[1.0, 0.3], dead_time: 0.1, ..PlantFactors::UNITY };
    let pid = PidConfig { kp: -0.3, ki: -0.25, kd: -0.02, tf: 0.05, b: 0.4, c: 0.3, ..PidConfig::default() };
    let exact = (1.0 / plant.gain + (1.0 - pid.b) * pid.kp) / pid.ki;
    agrees("partial weight", ie(&plant, pid, None, (1.0, 0.0), 0.01, 20_000), exact, exact);
    agrees(
        "negative gain, load",
        ie(&plant, pid, None, (0.0, 1.0), 0.01, 20_000),
        -1.0 / pid.ki,
        1.0 / pid.ki.abs(),
    );
}
