//! Records that are not a clean step: coarse converters, loops that control while they are recorded.

mod support_identification;

use controller_design::identification::{IdentifyOptions, Recording, identify};
use support_identification::{Process, Random, momi_kp, step};

/// How often each of A0..A5 and K_P is in its interval, of the records that `make` gives for a seed.
fn covered(
    process: &Process,
    runs: u64,
    make: impl Fn(&mut Random) -> (Vec<f64>, Vec<f64>, Vec<f64>),
) -> [u64; 7] {
    let exact = process.areas();
    let mut covered = [0; 7];
    let (mut errors, mut fits) = (Vec::new(), 0);
    for seed in 0..runs {
        let (t, u, y) = make(&mut Random::new(seed));
        let found = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default())
            .unwrap_or_else(|refusal| panic!("{seed}: {refusal}"));
        let kp = momi_kp(&exact, found.tf);
        for k in 0..6 {
            let error = (found.areas.values()[k] - exact[k]).abs();
            covered[k] += u64::from(error <= found.area_interval[k]);
        }
        covered[6] += u64::from((found.kp - kp).abs() <= found.kp_interval);
        errors.push(100.0 * (found.kp / kp - 1.0).abs());
        fits += u64::from(found.chosen.name() == "fit");
    }
    errors.sort_by(f64::total_cmp);
    println!("{covered:?} of {runs}, fit {fits}, K_P off by {:.2} %", errors[errors.len() * 68 / 100]);
    covered
}

#[test]
fn a_coarse_converter_is_part_of_the_interval() {
    // 120 steps of the converter for the whole change and no noise: means keep up to half a step of error.
    let process = Process::distinct(&[1.0, 0.3], 0.4).gain(2.0);
    let covered = covered(&process, 100, |random| {
        let (t, u, y) = step(&process, 0.05, 3.0, 25.0, 1.0);
        let (q, offset) = (2.0 / 120.0, random.uniform());
        (t, u, y.iter().map(|y| q * (y / q + offset).round()).collect())
    });
    assert!(covered.iter().all(|n| *n >= 85), "{covered:?}");
}

#[test]
fn a_noisy_loop_gives_the_process_alone() {
    // PI with kp = 0.4, ki = 0.2 on a process with gain 2; the noise goes through the controller into the input.
    let process = Process::equal(2, 1.0, 0.5).gain(2.0);
    let covered = covered(&process, 40, |random| {
        let (h, rows) = (0.1, 700);
        let t: Vec<f64> = (0..rows).map(|i| h * i as f64).collect();
        let (mut u, mut y, mut i) = (vec![0.0; rows], vec![0.0; rows], 0.0);
        for k in 1..rows {
            let clean: f64 = (1..k).map(|j| (u[j] - u[j - 1]) * process.response(t[k] - t[j])).sum();
            y[k] = clean + 2e-3 * random.normal();
            let e = if k >= 100 { 1.0 } else { 0.0 } - y[k];
            i += 0.2 * h * e;
            u[k] = i + 0.4 * e;
        }
        (t, u, y)
    });
    assert!(covered.iter().all(|n| *n >= 34), "{covered:?}");
}

/// `K*exp(-L*s)/s` after a step of the input at 10 s: a ramp.
#[test]
fn an_integrating_process_is_refused_with_what_to_do() {
    for (rate, noise) in [(0.02, 0.0), (-3.0, 0.01), (0.5, 0.002)] {
        let mut random = Random::new(3);
        let t: Vec<f64> = (0..400).map(|i| 0.2 * f64::from(i)).collect();
        let u: Vec<f64> = t.iter().map(|t| if *t < 10.0 { 40.0 } else { 45.0 }).collect();
        let clean = |t: f64| 5.0 + rate * 5.0 * (t - 14.0).max(0.0);
        let size = (rate * 5.0 * 66.0_f64).abs();
        let y: Vec<f64> = t.iter().map(|t| clean(*t) + noise * size * random.normal()).collect();
        let refusal = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default())
            .expect_err("an integrator has no gain");
        let shown = format!("{refusal} {}", refusal.help());
        assert!(shown.contains("integrates") && shown.contains("K*exp(-L*s)/s"), "{rate}: {shown}");
    }
    // A lag whose record ends too early is told apart from it.
    let process = Process::distinct(&[10.0], 1.0);
    let (t, u, y) = step(&process, 0.05, 2.0, 12.0, 1.0);
    let refusal = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default())
        .expect_err("a third is still to come");
    assert!(format!("{refusal} {}", refusal.help()).contains("record longer"), "{refusal}");
}

/// One tiny lag and dead time: a second one is not determined, and the interval must not say that the gain is not known.
#[test]
fn the_interval_of_the_gain_is_its_spread_and_no_more_than_the_record_leaves_open() {
    let process = Process::distinct(&[1.0], 0.317).gain(-3.0);
    let exact = process.areas();
    for seed in 0..12 {
        let (t, u, y) = step(&process, 0.02, 1.317, 18.0, 1.0);
        let mut random = Random::new(seed);
        let y: Vec<f64> = y.iter().map(|y| y + 0.03 * random.normal()).collect();
        let found =
            identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default()).expect("a process");
        // Of a 90 % interval, by its documentation.
        let half = 1.8 * found.kp_spread * found.kp.abs();
        assert!((half / found.kp_interval - 1.0).abs() < 1e-12, "{half} {}", found.kp_interval);
        // Linear propagation at this noise gives some 2 %; a lag more that is anywhere would give several 100 %.
        assert!(found.kp_interval < 0.1 * found.kp.abs(), "{seed}: {} +/- {}", found.kp, found.kp_interval);
        assert!((found.kp / momi_kp(&exact, found.tf) - 1.0).abs() < 0.1, "{seed}: {}", found.kp);
    }
}

/// Three lags of which none can be left out: the best fit goes through the record where that of second order cannot.
#[test]
fn the_best_fit_is_simulated_as_it_was_fitted() {
    for process in [Process::equal(3, 1.0, 0.2), Process::equal(3, 1.0, 0.0).zero(-0.6)] {
        let (t, u, y) = step(&process, 0.02, 3.0, 40.0, 1.0);
        let recording = Recording { t: &t, u: &u, y: &y };
        let found = identify(&recording, &IdentifyOptions::default()).expect("a process");
        let worst = |simulated: Option<Vec<f64>>| {
            let simulated = simulated.expect("a model");
            simulated.iter().zip(&y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let fit = found.fit.expect("a fit");
        let (second, best) = (worst(found.simulate(&recording)), worst(found.simulate_fit(&recording)));
        println!("order {}, zero {}: {best:e}, of second order {second:e}", fit.order, fit.b1);
        assert!(fit.order > 2 && best < 1e-4 && second > 1e-3, "{best} {second}");
    }
}
