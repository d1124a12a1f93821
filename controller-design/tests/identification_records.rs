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
