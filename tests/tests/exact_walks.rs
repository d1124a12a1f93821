//! Random walks against theory: how their variance grows, and the stationary indices of loops under them.

use controller_core::PidConfig;
use controller_sim_host::scenario::{Change, ControllerSpec, Event, Scenario, Signal};
use controller_sim_host::simulate::{RunOptions, run};
use controller_tests::cases::{from_rest, pi_with_observer};
use controller_tests::oracle::state_space::PlantFactors;

fn walk(std: f64, every: f64, seed: u64, duration: f64) -> Change {
    Change::Disturbance(Signal::Walk { std, every, seed, duration })
}

fn idle(ts: f64, duration: f64, at: f64, change: Change) -> Scenario {
    let plant = PlantFactors { lags: &[1.0], ..PlantFactors::UNITY };
    let spec = ControllerSpec::pid("none", PidConfig::default());
    let mut scenario = from_rest(&plant, ts, duration, change, vec![spec]);
    scenario.events[0].at = at;
    scenario.substeps = 1;
    scenario
}

/// The disturbance at every sample of a run.
fn disturbance(scenario: &Scenario) -> Vec<f64> {
    let options = RunOptions { trace: true, ..RunOptions::default() };
    let trace = run(scenario, options).expect("valid").controllers.remove(0).trace;
    trace.iter().map(|sample| sample.d).collect()
}

/// After `n` steps the variance is `n*std^2`, steps are Gaussian and know nothing of each other. Of `N` walks a variance
/// is known to `sqrt(2/N)`, a correlation to `1/sqrt(N)`; four times that is allowed.
#[test]
fn variance_grows_by_the_same_amount_with_each_step() {
    let (std, every, walks) = (0.3, 0.25, 4000);
    let all: Vec<Vec<f64>> = (0..walks)
        .map(|seed| disturbance(&idle(0.1, 10.0, 1.03, walk(std, every, seed, f64::INFINITY))))
        .collect();
    let mean_of = |f: &dyn Fn(&[f64]) -> f64| all.iter().map(|d| f(d)).sum::<f64>() / walks as f64;
    let scatter = (2.0 / walks as f64).sqrt();
    for k in [0_usize, 10, 11, 13, 14, 30, 60, 99] {
        // The first step at 1.03, then one every 0.25 s.
        let passed = (k as f64 * 0.1 - 1.03) / every;
        let steps = if passed < 0.0 { 0.0 } else { passed.floor() + 1.0 };
        let variance = mean_of(&|d| d[k] * d[k]);
        let exact = steps * std * std;
        assert!(
            (variance - exact).abs() <= 4.0 * scatter * exact,
            "sample {k}: {variance} instead of {exact}"
        );
        assert!(mean_of(&|d| d[k]).abs() <= 4.0 * (exact / walks as f64).sqrt(), "sample {k}");
    }
    // A step at 1.28 and one at 1.53.
    let (one, next) = (|d: &[f64]| (d[15] - d[12]) / std, |d: &[f64]| (d[16] - d[15]) / std);
    let together = mean_of(&|d| one(d) * next(d));
    assert!(together.abs() <= 4.0 / (walks as f64).sqrt(), "{together}");
    // The fourth moment of a Gaussian is 3, its estimate scatters by sqrt(96/N).
    let fourth = mean_of(&|d| one(d).powi(4));
    assert!((fourth - 3.0).abs() <= 4.0 * (96.0 / walks as f64).sqrt(), "{fourth}");
}

/// A walk stays where its duration left it, adds to the level, and repeats with its seed.
#[test]
fn a_walk_ends_and_stays() {
    let scenario = idle(0.1, 10.0, 1.0, walk(1.0, 0.5, 7, 3.0));
    let d = disturbance(&scenario);
    assert!(d[..10].iter().all(|d| *d == 0.0) && d[10] != 0.0);
    let changes = d.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(changes, 6, "at 1.0, 1.5 .. 3.5");
    assert!(d[36..].iter().all(|last| *last == d[35]));
    assert_eq!(d, disturbance(&scenario));
    let mut raised = scenario;
    let level =
        Event { at: 0.5, changes: vec![Change::Disturbance(Signal::Step(2.0))], ..raised.events[0].clone() };
    raised.events.insert(0, level);
    let moved = disturbance(&raised);
    assert!(d.iter().zip(&moved).skip(5).all(|(d, moved)| (moved - d - 2.0).abs() < 1e-12));
}

/// Table 5 of the observer's paper: the plant `exp(-5s)/(1+95s)` under a random walk, PI against PI with observer.
///
/// Stationary theory: the mean square of an error that white steps drive is the integral of the squared step response, so
/// the ratio of ISE is that of one step; of Gaussian signals the mean size is proportional to the root of the mean square,
/// hence IAE is its root; TV follows the rate of the output, its ratio is that of the norms of the transfer functions from
/// the disturbance to the output. Sampling at a fiftieth of the dead time changes ISE by up to 2.4 %, TV by 1 %; the rest
/// of the 10 % is the scatter of finite runs.
#[test]
fn observers_under_a_random_walk_meet_the_theory_of_table_5() {
    let theory =
        [(100.0, [0.853, 0.728, 1.187]), (10.0, [0.394, 0.155, 1.938]), (1.0, [0.188, 0.0354, 4.50])];
    let plant = PlantFactors { lags: &[95.0], dead_time: 5.0, ..PlantFactors::UNITY };
    let (kp, ti, ts) = (3.1642, 36.335, 0.1);
    let alphas = [None, Some(100.0), Some(10.0), Some(1.0)];
    let controllers = alphas.map(|alpha| {
        let mut spec = pi_with_observer(&plant, kp, kp / ti, alpha);
        spec.name = format!("{alpha:?}");
        spec
    });
    let runs = 24;
    let mut sums = [[0.0; 3]; 4];
    for seed in 1..=runs {
        let change = walk(0.01, ts, seed, f64::INFINITY);
        let mut scenario = from_rest(&plant, ts, 6000.0, change, controllers.to_vec());
        // Slow against a sample: what is between them adds nothing.
        scenario.substeps = 1;
        let result = run(&scenario, RunOptions::default()).expect("valid");
        for (sum, controller) in sums.iter_mut().zip(&result.controllers) {
            let m = &controller.total;
            for (sum, value) in sum.iter_mut().zip([m.iae, m.ise, m.tv]) {
                *sum += value;
            }
        }
    }
    for ((alpha, exact), sum) in theory.iter().zip(&sums[1..]) {
        for (i, name) in ["IAE", "ISE", "TV"].iter().enumerate() {
            let ratio = sum[i] / sums[0][i];
            println!("alpha {alpha}: {name} {ratio:.4}, theory {}", exact[i]);
            assert!(
                (ratio / exact[i] - 1.0).abs() <= 0.1,
                "alpha {alpha}: {name} {ratio}, theory {}",
                exact[i]
            );
        }
    }
}
