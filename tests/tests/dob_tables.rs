//! The disturbance observer against tables 3 and 4 of Tena et al. (2022): eighteen cells, the true optimal PI, 100
//! samples per dead time; and against closed forms for plants the paper does not simulate.

use controller_core::{ControllerConfig, LimitConfig, ObserverConfig, PidConfig};
use controller_sim_host::simulate::{Metrics, RunOptions, run};
use controller_tests::cases::{DISTURBANCE_STEP, from_rest, model, pi_with_observer};
use controller_tests::oracle::dob_cases::CASES;
use controller_tests::oracle::hold_polynomials::HoldPolynomials;
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::rig::{Rig, law};

/// The reference's own sampling error at 100 samples per dead time, worst over the cells \[%\].
const SAMPLING_ERROR: [(&str, f64); 5] =
    [("IAE", 0.7), ("ISE", 1.2), ("ITAE", 0.8), ("e_max", 0.4), ("TV", 0.5)];

#[test]
fn the_eighteen_ratios_of_tables_3_and_4() {
    let mut worst = [0.0_f64; 5];
    for case in &CASES {
        let ts = case.plant.dead_time / 100.0;
        let mut specs = vec![pi_with_observer(&case.plant, case.kp, case.ki, None)];
        specs.extend(
            case.cells.iter().map(|c| pi_with_observer(&case.plant, case.kp, case.ki, Some(c.alpha))),
        );
        // Long enough for the tail of alpha = 100 s: ITAE is the last to settle.
        let scenario = from_rest(&case.plant, ts, 4000.0, DISTURBANCE_STEP, specs);
        let result = run(&scenario, RunOptions::default()).expect("valid parameters");
        let indices = |m: &Metrics| [m.iae, m.ise, m.itae, m.e_max, m.tv];
        let base = indices(&result.controllers[0].total);
        for (cell, with) in case.cells.iter().zip(&result.controllers[1..]) {
            let r = &cell.ratios;
            let expected = [r.iae, r.ise, r.itae, r.e_max, r.tv];
            let ours = indices(&with.total);
            for i in 0..5 {
                let deviation = 100.0 * ((ours[i] / base[i]) / expected[i] - 1.0);
                worst[i] = worst[i].max(deviation.abs());
                let (name, limit) = SAMPLING_ERROR[i];
                assert!(
                    deviation.abs() <= limit,
                    "Ms {} plant {} alpha {} {name}: {} against {} ({deviation:+.2} %)",
                    case.ms0,
                    case.plant_number,
                    cell.alpha,
                    ours[i] / base[i],
                    expected[i]
                );
            }
        }
    }
    println!("worst deviation [%] of IAE, ISE, ITAE, e_max, TV: {worst:.2?}");
}

/// Third order; integrating; right-half-plane zero; complex poles; a slow zero that moves into the `y` path.
const PLANTS: [(&str, PlantFactors<'static>, f64, f64); 5] = [
    (
        "third order",
        PlantFactors { lags: &[1.0, 0.7, 0.3], dead_time: 0.234, ..PlantFactors::UNITY },
        0.8,
        0.5,
    ),
    (
        "integrating",
        PlantFactors { gain: 0.5, integrators: 1, lags: &[0.4], dead_time: 0.2, ..PlantFactors::UNITY },
        0.9,
        0.12,
    ),
    (
        "right-half-plane zero",
        PlantFactors { lags: &[1.0, 0.5], zeros: &[(-0.3, 0.0)], dead_time: 0.1, ..PlantFactors::UNITY },
        0.5,
        0.4,
    ),
    (
        "complex poles",
        PlantFactors { gain: 2.0, pairs: &[(0.8, 1.0)], dead_time: 0.15, ..PlantFactors::UNITY },
        0.1,
        0.2,
    ),
    (
        "slow zero",
        PlantFactors { lags: &[2.0, 0.5], zeros: &[(0.6, 0.0)], dead_time: 0.3, ..PlantFactors::UNITY },
        0.9,
        0.6,
    ),
];
const TS: f64 = 0.02;
const ALPHA: f64 = 0.25;

/// IE of a disturbance that `d` gives sample by sample, from rest, in units of `ts*sum(e)`.
fn ie(plant: &PlantFactors<'_>, kp: f64, ki: f64, mut d: impl FnMut(usize) -> f64, samples: usize) -> f64 {
    let pid = PidConfig { kp, ki, ..PidConfig::default() };
    let config =
        ControllerConfig { pid, limits: LimitConfig::range(-1e5, 1e5), ..ControllerConfig::default() };
    let observer = ObserverConfig { model: model(plant), alpha: ALPHA, order: None }.to_compensator(0.0);
    let mut rig = Rig::<f64>::new(law(&config, &observer, TS).expect("valid"), plant.sampled(TS));
    let mut sum = 0.0;
    for k in 0..samples {
        rig.d = d(k);
        sum += TS * -rig.y();
        let _ = rig.step();
    }
    sum
}

#[test]
fn a_step_disturbance_leaves_no_integral_of_error() {
    for (name, plant, kp, ki) in &PLANTS {
        let with = ie(plant, *kp, *ki, |_| 1.0, 20_000);
        // Without the observer it would be -1/ki.
        assert!(with.abs() <= 1e-6 / ki, "{name}: {with:e}");
    }
}

/// Under a ramp the estimate lags by the mean delay of `C_u`: `IE = -slope*D/ki`. `D` follows from the discrete pair
/// (filter poles, taps of the hold equivalent), and is `d*alpha + T + sum(delta) + Ts/2` to second order in `Ts`.
#[test]
fn a_ramp_disturbance_leaves_the_mean_delay_of_the_estimate() {
    for (name, plant, kp, ki) in &PLANTS {
        let slope = 0.05;
        let ours = -ie(plant, *kp, *ki, |k| slope * TS * k as f64, 20_000) * ki / slope;

        let hold = HoldPolynomials::new(plant, TS);
        let sum: f64 = hold.b.iter().sum();
        let mean: f64 = hold.b.iter().enumerate().map(|(k, b)| k as f64 * b).sum::<f64>() / sum;
        let lag = |tau: f64| TS / ((TS / tau).exp() - 1.0);
        let moved: Vec<f64> = plant.zeros.iter().map(|z| z.0).filter(|&beta| beta >= TS).collect();
        let order = plant.order() - moved.len();
        let exact = order as f64 * lag(ALPHA)
            + moved.iter().map(|&beta| lag(beta)).sum::<f64>()
            + TS * (hold.dead_steps as f64 + 1.0 + mean);
        assert!((ours / exact - 1.0).abs() <= 1e-6, "{name}: {ours} against {exact}");

        let delta: f64 = plant.zeros.iter().map(|z| -z.0).filter(|&delta| delta > 0.0).sum();
        let continuous = order as f64 * ALPHA + plant.dead_time + delta + 0.5 * TS;
        // Second-order terms of the lags: Ts^2/12 over each time constant.
        let taus = plant.lags.iter().chain(&moved).copied().chain(std::iter::repeat_n(ALPHA, order));
        let pairs: f64 = plant.pairs.iter().map(|&(a1, a2)| a1 / a2).sum();
        let bound = TS * TS / 12.0 * (taus.map(|tau| 1.0 / tau).sum::<f64>() + pairs) * 1.01;
        println!(
            "{name}: D = {ours:.6} s, continuous {continuous:.6} s, bound of the difference {bound:.1e}"
        );
        assert!((ours - continuous).abs() <= bound, "{name}: {ours} against {continuous}");
    }
}
