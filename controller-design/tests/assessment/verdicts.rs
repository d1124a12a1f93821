//! Verdicts over a grid of detunings: gain 0.4 to 1.5 times, integral time 0.3 to 3 times the best.

use crate::loops::{OPTIMA, Optimum, Plan, Recording, grid};
use controller_design::assessment::{AssessOptions, Assessment, Reason, Verdict, assess};

/// A loop whose IAE is so much above the best is good, or clearly off.
const GOOD: f64 = 0.05;
const OFF: f64 = 0.20;

fn assessed(recording: &Recording) -> Assessment {
    assess(&recording.experiment(), &AssessOptions::default()).expect("a record")
}

/// Dip, its time and the third peak of the best loops against those that another program found.
#[test]
fn the_best_loops_have_the_features_of_the_table() {
    for optimum in &OPTIMA {
        let recording = Plan::of(optimum).continuous();
        assert!((recording.iae / optimum.iae - 1.0).abs() < 1e-4, "the simulation of r = {}", optimum.r);
        let result = assessed(&recording);
        let features = result.features.expect("features");
        let [p1, dip, t_ratio, r3] = optimum.features;
        let off = |value: Option<f64>, expected: f64| (value.expect("a dip") - expected).abs();
        assert!((features.p1 / p1 - 1.0).abs() < 0.003, "{} {features:?}", optimum.r);
        assert!(off(features.dip, dip) < 0.003, "{} {features:?}", optimum.r);
        assert!(off(features.t_ratio, t_ratio) < 0.01, "{} {features:?}", optimum.r);
        assert!(off(features.r3, r3) < 0.003, "{} {features:?}", optimum.r);
        assert_eq!((result.verdict, &*result.reasons), (Verdict::NearOptimal, &[Reason::WithinRanges][..]));
    }
}

/// Continuous controllers: 9 processes, 168 detunings of each.
#[test]
fn continuous_loops_are_told_apart() {
    let (mut good, mut accepted) = (0, 0);
    for optimum in &OPTIMA {
        for (kp, ti) in grid(12, 14) {
            let recording = Plan { length: 40, ..Plan::of(optimum) }.detuned(kp, ti).continuous();
            let loss = recording.iae / optimum.iae - 1.0;
            let result = assessed(&recording);
            let what = || format!("r {}, kp x {kp:.2}, ti x {ti:.2}, loss {loss:.3}: {result:?}", optimum.r);
            assert_ne!(result.verdict, Verdict::Inconclusive, "{}", what());
            if result.verdict == Verdict::NearOptimal {
                assert!(loss <= 0.15, "{}", what());
            }
            if loss <= GOOD {
                good += 1;
                accepted += usize::from(result.verdict == Verdict::NearOptimal);
            }
            // Far off in both: there is no doubt on which side.
            if loss > OFF && kp <= 0.7 && ti >= 1.2 {
                assert_eq!(result.verdict, Verdict::Sluggish, "{}", what());
            }
            if loss > OFF && kp >= 1.2 && ti <= 0.8 {
                assert_eq!(result.verdict, Verdict::Aggressive, "{}", what());
            }
        }
    }
    assert!(good >= 40 && accepted * 10 >= good * 9, "{accepted} of {good} good loops accepted");
}

#[derive(Debug, Default)]
struct Count {
    good: usize,
    good_accepted: usize,
    off: usize,
    off_accepted: usize,
    unclear: usize,
}

/// The least IAE of the sampled loop on a fine grid: sampling costs some of what a continuous controller reaches.
fn least_iae(optimum: &Optimum) -> f64 {
    let near = (0..5 * 5).map(|k| (0.85 + 0.075 * (k / 5) as f64, 0.85 + 0.075 * (k % 5) as f64));
    let plans = near.map(|(kp, ti)| Plan::of(optimum).detuned(kp, ti));
    plans.map(|plan| plan.sampled().iae).fold(f64::INFINITY, f64::min)
}

/// Sampled controllers, 40 samples in the dead time, with noise that goes through the controller, too.
#[test]
fn sampled_loops_with_noise_are_told_apart() {
    let off_grid = [(1.0, 1.0), (0.9, 1.0), (1.0, 1.1), (0.95, 0.95), (1.05, 1.05), (0.9, 0.9)];
    let mut counts = [(); 4].map(|()| Count::default());
    for optimum in OPTIMA.iter().filter(|o| [0.1, 0.41, 1.7, 0.0].contains(&o.r)) {
        let least = least_iae(optimum);
        for (kp, ti) in grid(6, 7).chain(off_grid) {
            let quiet = Plan::of(optimum).detuned(kp, ti);
            let recording = quiet.sampled();
            let loss = recording.iae / least - 1.0;
            let first = quiet.rest * quiet.delay..(quiet.rest + 8) * quiet.delay;
            let p1 = recording.pv[first].iter().fold(0.0_f64, |p1, y| p1.max(y.abs()));
            for (count, share) in counts.iter_mut().zip([0.0, 0.005, 0.01, 0.02]) {
                for seed in 0..if share > 0.0 { 4 } else { 1 } {
                    let plan = Plan { noise: share * p1, seed, ..quiet };
                    let result = assessed(&plan.sampled());
                    let accepted = usize::from(result.verdict == Verdict::NearOptimal);
                    count.unclear += usize::from(result.verdict == Verdict::Inconclusive);
                    if loss <= GOOD {
                        (count.good, count.good_accepted) = (count.good + 1, count.good_accepted + accepted);
                    } else if loss > OFF {
                        (count.off, count.off_accepted) = (count.off + 1, count.off_accepted + accepted);
                        // A loop that noise alone drives to ever larger swings is at rest at no time.
                        let bounded = recording.pv.iter().all(|y| y.abs() < 2.0 * p1);
                        let unclear = result.verdict == Verdict::Inconclusive && bounded;
                        assert!(!unclear, "r {} x {kp:.2} {ti:.2}, noise {share}: {result:?}", optimum.r);
                    }
                }
            }
        }
    }
    for (count, level) in counts.iter().zip([0.0, 0.5, 1.0, 2.0]) {
        println!("noise {level} %: {count:?}");
    }
    for count in &counts {
        assert!(count.good_accepted * 10 >= count.good * 9, "{count:?}");
    }
    for count in &counts[..3] {
        assert_eq!(count.off_accepted, 0, "{count:?}");
    }
    assert!(counts[3].off_accepted * 500 <= counts[3].off, "{:?}", counts[3]);
}
