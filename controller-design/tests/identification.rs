//! Records of known processes without noise: the areas are those of the process.

mod support_identification;

use controller_design::Refusal;
use controller_design::identification::{Identified, IdentifyOptions, Recording, identify};
use support_identification::{Process, Random, chapter, momi_kp, step};

fn found(t: &[f64], u: &[f64], y: &[f64]) -> Identified {
    identify(&Recording { t, u, y }, &IdentifyOptions::default()).expect("a usable record")
}

/// Largest relative error of the raw areas.
fn error(found: &Identified, exact: &[f64; 6]) -> f64 {
    let pairs = found.raw_areas.values().into_iter().zip(exact);
    pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn raw_areas_of_clean_steps_are_those_of_the_process() {
    let mut cases: Vec<(String, Process)> = (1..=6).map(|n| (format!("G_P{n}"), chapter(n))).collect();
    cases.push(("eight lags".into(), Process::equal(8, 1.0, 0.3)));
    cases.push(("right zero".into(), Process::equal(3, 1.0, 0.0).zero(-0.6)));
    cases.push(("left zero".into(), Process::equal(3, 1.0, 0.2).zero(1.3)));
    cases.push(("first order".into(), Process::distinct(&[1.0], 0.015)));
    cases.push(("second order".into(), Process::distinct(&[1.0, 0.2], 0.0)));
    cases.push(("swinging".into(), Process::pair(1.0, 0.45, 0.1)));
    for (name, process) in cases {
        let exact = process.areas();
        // Swings die away more slowly than the mean time says.
        let tau = process.mean_time().max(if name == "swinging" { 5.0 } else { 2.0 });
        // A two-hundredth of the mean time: the trapezoid without correction would be wrong by 1e-5 in A2 here, and
        // kinks between samples by 1e-6.
        let (t, u, y) = step(&process, tau / 250.0, tau, 25.0 * tau, 1.0);
        let found = found(&t, &u, &y);
        let error = error(&found, &exact);
        println!(
            "{name}: {error:.1e} chosen {} {:?}",
            found.chosen.name(),
            found.fit.map(|f| (f.order, f.b1))
        );
        assert!(error < 1e-5, "{name}: {:?} {exact:?}", found.raw_areas);
    }
}

#[test]
fn scales_of_time_and_signals_do_not_matter() {
    for (time, gain, size) in [(1e-6, -4e5, 1e-3), (1e6, 3e-7, -2e4), (1.0, -1.0, 5.0), (40.0, 1e9, 1e-9)] {
        let process = Process::distinct(&[time, 0.3 * time], 0.237 * time).gain(gain);
        let (t, u, y) = step(&process, 0.01 * time, time, 30.0 * time, size);
        let y: Vec<f64> = y.iter().map(|y| y + 12.0 * (gain * size).abs()).collect();
        let found = found(&t, &u, &y);
        assert!(error(&found, &process.areas()) < 1e-5, "{time}: {:?}", found.raw_areas);
        let model = found.model.expect("a model");
        for (a, b) in [
            (model.gain, gain),
            (model.a1, 1.3 * time),
            (model.a2, 0.3 * time * time),
            (model.dead_time, 0.237 * time),
        ] {
            assert!((a / b - 1.0).abs() < 1e-6, "{time}: {a} {b}");
        }
        let kp = momi_kp(&process.areas(), found.tf);
        assert!((found.kp / kp - 1.0).abs() < 1e-3, "{time}: {} {kp}", found.kp);
    }
}

#[test]
fn any_change_between_two_steady_states_will_do() {
    let process = Process::equal(2, 1.0, 0.5).gain(2.0);
    let t: Vec<f64> = (0..4000).map(|i| 0.02 * f64::from(i)).collect();
    type Shape = fn(f64) -> f64;
    let shapes: [(&str, Shape); 4] = [
        ("two steps", |t| {
            if t < 3.0 {
                0.0
            } else if t < 5.0 {
                2.0
            } else {
                1.0
            }
        }),
        ("ramp", |t| (0.25 * (t - 3.0)).clamp(0.0, 1.0)),
        ("filtered step", |t| 1.0 - (-(t - 3.0).max(0.0) / 1.5).exp()),
        ("late and down", |t| if t < 13.0 { 0.4 } else { -3.0 }),
    ];
    for (name, shape) in shapes {
        let u: Vec<f64> = t.iter().map(|t| shape(*t)).collect();
        let y = process.output(&t, &u);
        let found = found(&t, &u, &y);
        let error = error(&found, &process.areas());
        println!("{name}: {error:.1e}");
        assert!(error < 1e-5, "{name}: {:?}", found.raw_areas);
        let model = found.model.expect("a model");
        assert!((model.dead_time - 0.5).abs() < 1e-5 && (model.a2 - 1.0).abs() < 1e-5, "{name}: {model:?}");
    }
}

#[test]
fn a_closed_loop_record_gives_the_process_alone() {
    let process = Process::equal(2, 1.0, 0.5).gain(2.0);
    // PI by hand: kp = 0.4, ki = 0.2; set-point step at row 100.
    let (h, rows) = (0.05, 1800);
    let t: Vec<f64> = (0..rows).map(|i| h * i as f64).collect();
    let (mut u, mut y, mut i) = (vec![0.0; rows], vec![0.0; rows], 0.0);
    for k in 1..rows {
        y[k] = (1..k).map(|j| (u[j] - u[j - 1]) * process.response(t[k] - t[j])).sum();
        let e = if k >= 100 { 1.0 } else { 0.0 } - y[k];
        i += 0.2 * h * e;
        u[k] = i + 0.4 * e;
    }
    let found = found(&t, &u, &y);
    println!("{:.1e}", error(&found, &process.areas()));
    assert_eq!(found.change_at, 5.0);
    assert!(error(&found, &process.areas()) < 1e-4, "{:?}", found.raw_areas);
}

#[test]
fn irregular_and_doubled_time_stamps_are_exact() {
    let process = Process::equal(3, 1.0, 0.23).gain(-1.5);
    let mut random = Random::new(7);
    // Rows 0.01 to 0.05 apart, gaps of half a time constant late in the record, and the step as a doubled stamp.
    let (mut t, mut u) = (vec![0.0, 0.0], vec![1.0, 3.0]);
    while t[t.len() - 1] < 75.0 {
        let gap = if t.len() % 97 == 0 && t[t.len() - 1] > 25.0 { 0.5 } else { 0.0 };
        t.push(t[t.len() - 1] + 0.01 + 0.04 * random.uniform() + gap);
        u.push(3.0);
    }
    let y = process.output(&t, &u);
    let found = found(&t, &u, &y);
    println!("{:.1e} {:?}", error(&found, &process.areas()), found.warnings);
    assert!(error(&found, &process.areas()) < 1e-5, "{:?}", found.raw_areas);
    let simulated = found.simulate(&Recording { t: &t, u: &u, y: &y }).expect("a model");
    let apart = simulated.iter().zip(&y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart <= 0.03, "a third-order step against its best second order: {apart}");
}

#[test]
fn the_end_correction_is_of_fourth_order() {
    // Halving the steps: the error of the plain trapezoid falls by 4, of the corrected one by 8 or more.
    let process = Process::distinct(&[1.0, 0.4], 0.0);
    let errors: Vec<f64> = [0.4, 0.2, 0.1]
        .into_iter()
        .map(|h| {
            let (t, u, y) = step(&process, h, 2.0, 60.0, 1.0);
            error(&found(&t, &u, &y), &process.areas())
        })
        .collect();
    println!("{errors:?}");
    assert!(errors[1] < errors[0] / 8.0 && errors[2] < errors[1] / 8.0, "{errors:?}");
}

#[test]
fn unusable_records_are_refused_with_the_reason() {
    let why =
        |t: &[f64], u: &[f64], y: &[f64]| match identify(&Recording { t, u, y }, &IdentifyOptions::default())
        {
            Err(Refusal::Data { why, .. }) => why,
            other => panic!("{other:?}"),
        };
    let process = Process::equal(2, 1.0, 0.5);
    let (t, u, y) = step(&process, 0.05, 5.0, 40.0, 1.0);
    let rows = t.len();
    assert!(why(&t, &vec![1.0; rows], &y).contains("does not change"));
    assert!(why(&t, &u, &vec![2.0; rows]).contains("did not move"));
    assert!(why(&t[..106], &u[..106], &y[..106]).contains("too few"));
    assert!(why(&t[..150], &u[..150], &y[..150]).contains("before the output is at rest"));
    assert!(why(&t, &u[..9], &y).contains("one length"));
    assert!(why(&[], &[], &[]).contains("too few"));
    let mut back = t.clone();
    back.swap(50, 51);
    assert!(why(&back, &u, &y).contains("goes back"));
    let mut bad = y.clone();
    bad[40] = f64::NAN;
    assert!(why(&t, &u, &bad).contains("finite"));
    let pulse: Vec<f64> = t.iter().map(|t| if (0.0..3.0).contains(t) { 1.0 } else { 0.0 }).collect();
    assert!(why(&t, &pulse, &process.output(&t, &pulse)).contains("ends where it began"));
    let ramp: Vec<f64> = t.iter().map(|t| t.max(0.0)).collect();
    assert!(why(&t, &u, &ramp).contains("the process integrates"));
    let mut random = Random::new(3);
    let noise: Vec<f64> = t.iter().map(|_| random.normal()).collect();
    assert!(why(&t, &u, &noise).contains("did not move"));
    // The output overshoots so far that its area is negative.
    let slow_zero = Process::equal(2, 1.0, 0.0).zero(8.0);
    assert!(why(&t, &u, &slow_zero.output(&t, &u)).contains("A1/A0"));
}

#[test]
fn nothing_panics_and_nothing_is_nan_on_odd_records() {
    let mut random = Random::new(99);
    let odd = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, 1e149, -1e149, 5e-324, f64::MAX, f64::NAN, f64::INFINITY];
    for round in 0..400 {
        let rows = (random.uniform() * 60.0) as usize;
        let pick = |random: &mut Random| match random.uniform() {
            x if x < 0.15 => odd[(random.uniform() * odd.len() as f64) as usize],
            x => x.round() * 10_f64.powi((random.uniform() * 8.0) as i32),
        };
        let mut t: Vec<f64> = (0..rows).map(|_| pick(&mut random)).collect();
        if round % 3 > 0 {
            t = (0..rows).map(|i| i as f64).collect();
        }
        let u = (0..rows).map(|i| if round % 2 > 0 { pick(&mut random) } else { f64::from(u8::from(i > 4)) });
        let u: Vec<f64> = u.collect();
        let y: Vec<f64> = (0..rows).map(|_| pick(&mut random)).collect();
        if let Ok(found) = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default()) {
            assert!(found.kp.is_finite() && found.areas.values().iter().all(|a| a.is_finite()), "{found:?}");
        }
    }
}
