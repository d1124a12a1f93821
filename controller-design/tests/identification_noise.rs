//! Records with noise: the reported intervals cover the truth, and the chosen way is as good as the reference's.

mod support_identification;

use controller_design::identification::{Chosen, IdentifyOptions, Recording, identify};
use support_identification::{Process, Random, chapter, momi_kp, step};

const RUNS: usize = 100;

struct Outcome {
    /// Of A0..A5 and K_P: how often inside the interval.
    covered: [usize; 7],
    /// Errors of K_P in per cent, sorted by size.
    errors: Vec<f64>,
    fits: usize,
    refused: usize,
}

fn runs(process: &Process, sigma: f64, h: f64, windows: f64) -> Outcome {
    let exact = process.areas();
    let tau = process.mean_time();
    let (t, u, clean) = step(process, h, tau, windows * tau, 1.0);
    let size = process.gain.abs();
    let mut outcome = Outcome { covered: [0; 7], errors: vec![], fits: 0, refused: 0 };
    for seed in 0..RUNS {
        let mut random = Random::new(seed as u64);
        let y: Vec<f64> = clean.iter().map(|y| y + sigma * size * random.normal()).collect();
        let Ok(found) = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default()) else {
            outcome.refused += 1;
            continue;
        };
        outcome.fits += usize::from(found.chosen == Chosen::Fit);
        let kp = momi_kp(&exact, found.tf);
        let errors = (0..6).map(|k| (found.areas.values()[k] - exact[k], found.area_interval[k]));
        for (count, (error, half)) in
            outcome.covered.iter_mut().zip(errors.chain([(found.kp - kp, found.kp_interval)]))
        {
            *count += usize::from(error.abs() <= half);
        }
        outcome.errors.push(100.0 * (found.kp / kp - 1.0).abs());
    }
    outcome.errors.sort_by(f64::total_cmp);
    let Outcome { covered, errors, fits, refused } = &outcome;
    let (typical, most) = (errors[errors.len() * 68 / 100], errors[errors.len() - 1]);
    println!("{covered:?} fit {fits} refused {refused} K_P off by {typical:.2} %, at most {most:.2} %");
    outcome
}

/// At least 85 of 100 in the 90 % interval, for each area and `K_P`.
fn covers(name: &str, process: &Process, sigma: f64, h: f64, windows: f64) -> Outcome {
    print!("{name}, noise {sigma}: ");
    let outcome = runs(process, sigma, h, windows);
    assert_eq!(outcome.refused, 0, "{name}, noise {sigma}");
    assert!(outcome.covered.iter().all(|n| *n >= 85), "{name}, noise {sigma}: {:?}", outcome.covered);
    outcome
}

/// And `K_P` within twice the spread plus the bias of the reference's fit (per cent, at 0.01 s), where two thirds of the
/// runs are within its spread. Rows `h` apart have `h/0.01` times the variance.
fn as_good_as_the_reference(number: usize, h: f64, spreads: [f64; 2], bias: f64) {
    for (sigma, spread) in [1e-3, 1e-2].into_iter().zip(spreads) {
        let outcome = covers(&format!("G_P{number}"), &chapter(number), sigma, h, 14.0);
        let limit = 2.0 * spread * (h / 0.01).sqrt() + bias;
        let typical = outcome.errors[68];
        assert!(typical <= limit, "G_P{number}, noise {sigma}: {typical} % of {limit} %");
    }
}

#[test]
fn process_1() {
    as_good_as_the_reference(1, 0.04, [0.2, 1.6], 0.0);
}

#[test]
fn process_3() {
    as_good_as_the_reference(3, 0.02, [0.3, 2.7], 0.0);
}

#[test]
fn process_4() {
    as_good_as_the_reference(4, 0.04, [0.1, 0.6], 5.0);
}

#[test]
fn process_5() {
    as_good_as_the_reference(5, 0.01, [1.0, 15.0], 3.5);
}

#[test]
fn processes_that_are_not_of_the_structure_that_is_fitted() {
    for sigma in [1e-3, 1e-2] {
        covers("G_P2", &chapter(2), sigma, 0.04, 14.0);
        covers("G_P6", &chapter(6), sigma, 0.08, 14.0);
        covers("eight lags", &Process::equal(8, 1.0, 0.3), sigma, 0.08, 6.0);
        covers("zero on the right", &Process::equal(3, 1.0, 0.0).zero(-0.6), sigma, 0.04, 14.0);
    }
}

#[test]
fn processes_that_are() {
    for sigma in [1e-3, 1e-2] {
        covers("first order", &Process::distinct(&[1.0], 0.317).gain(-3.0), sigma, 0.02, 14.0);
        covers("no dead time", &Process::distinct(&[1.0, 0.5], 0.0), sigma, 0.02, 14.0);
        covers("delay dominant", &Process::distinct(&[1.0, 0.8], 6.0), sigma, 0.05, 5.0);
        covers("swinging", &Process::pair(1.0, 0.6, 0.5), sigma, 0.05, 14.0);
    }
}
