//! Records that do not show what is asked, and those that look odd but do.

use crate::loops::{OPTIMA, Plan, Recording};
use crate::pcg::Pcg;
use controller_design::Refusal;
use controller_design::assessment::{AssessOptions, Assessment, Experiment, Reason, Verdict, assess};

fn optimum() -> Plan {
    Plan::of(&OPTIMA[3])
}

fn good() -> Recording {
    optimum().sampled()
}

/// The sample of the step.
const STEP: usize = 8 * 40;

fn result(recording: &Recording) -> Assessment {
    assess(&recording.experiment(), &AssessOptions::default()).expect("a record")
}

/// The only reason of a record that does not tell.
fn unclear(recording: &Recording) -> Reason {
    let result = result(recording);
    assert_eq!(result.verdict, Verdict::Inconclusive, "{result:?}");
    assert_eq!(result.reasons.len(), 1);
    assert!(result.advice.kp.is_none() && result.advice.ti.is_none());
    result.reasons[0]
}

fn keep(recording: &Recording, mut range: impl FnMut(usize) -> bool) -> Recording {
    let kept: Vec<usize> = (0..recording.t.len()).filter(|&k| range(k)).collect();
    let of = |list: &[f64]| kept.iter().map(|&k| list[k]).collect();
    Recording {
        t: of(&recording.t),
        sp: of(&recording.sp),
        pv: of(&recording.pv),
        co: of(&recording.co),
        iae: 0.0,
    }
}

fn noisy(recording: &mut Recording, std: f64) {
    let mut pcg = Pcg::new(5);
    recording.pv.iter_mut().for_each(|pv| *pv += std * pcg.gaussian());
}

/// Within the dead time it makes no difference how long the loop is in manual; afterwards the peak is too high.
#[test]
fn holds() {
    let short = result(&Plan { hold: 1, ..optimum() }.sampled());
    for hold in [10, 20, 40] {
        let long = result(&Plan { hold, ..optimum() }.sampled());
        let (a, b) = (short.features.unwrap(), long.features.unwrap());
        assert!((a.p1 / b.p1 - 1.0).abs() < 1e-9 && (a.t1 - b.t1).abs() < 1e-9, "{hold}: {b:?}");
        assert_eq!(long.verdict, Verdict::NearOptimal);
    }
    for hold in [60, 80, 120] {
        let reason = unclear(&Plan { hold, ..optimum() }.sampled());
        assert!(matches!(reason, Reason::AutoTooLate(gone) if gone > 0.2), "{reason:?}");
    }
    // Said by the caller, it is not looked for.
    let recording = good();
    let experiment = Experiment { auto_at: Some(STEP + 90), ..recording.experiment() };
    let result = assess(&experiment, &AssessOptions::default()).unwrap();
    assert!(matches!(result.reasons[..], [Reason::AutoTooLate(_)]), "{result:?}");
}

#[test]
fn never_back_in_automatic() {
    let plan = Plan { hold: 100_000, ..optimum() };
    assert_eq!(unclear(&plan.sampled()), Reason::NeverAuto);
}

#[test]
fn too_much_noise() {
    let mut recording = good();
    noisy(&mut recording, 0.05);
    assert!(matches!(unclear(&recording), Reason::Noise(share) if share > 0.06));
    // Slow noise, which smoothing leaves: seen at rest.
    let mut recording = good();
    let mut pcg = Pcg::new(9);
    let mut slow = 0.0;
    for pv in &mut recording.pv {
        slow += 0.05 * (0.03 * pcg.gaussian() - slow) + 0.003 * pcg.gaussian();
        *pv += slow;
    }
    let reason = unclear(&recording);
    assert!(matches!(reason, Reason::Noise(_) | Reason::NotSteady), "{reason:?}");
}

#[test]
fn coarse_resolution() {
    let rounded = |step: f64| {
        let mut recording = good();
        recording.pv.iter_mut().for_each(|pv| *pv = (*pv / step).round() * step);
        recording
    };
    // P1 is 0.43.
    assert!(matches!(unclear(&rounded(0.05)), Reason::Resolution(share) if share > 0.1));
    assert_eq!(result(&rounded(0.01)).verdict, Verdict::NearOptimal);
}

#[test]
fn valve_that_sticks() {
    let mut recording = good();
    recording.pv.iter_mut().for_each(|pv| *pv = 0.0);
    assert_eq!(unclear(&recording), Reason::NoResponse);
    noisy(&mut recording, 0.01);
    let reason = unclear(&recording);
    assert!(matches!(reason, Reason::NoResponse | Reason::Noise(_)), "{reason:?}");
}

#[test]
fn records_that_are_too_short() {
    let recording = good();
    let short = keep(&recording, |k| k < STEP + 300);
    assert!(matches!(unclear(&short), Reason::RecordShort(x) if (2.5..4.0).contains(&x)));
    let reason = unclear(&keep(&recording, |k| k < STEP + 60));
    assert!(matches!(reason, Reason::RecordShort(_)), "{reason:?}");
    assert_eq!(result(&keep(&recording, |k| k < STEP + 450)).verdict, Verdict::NearOptimal);
    assert_eq!(unclear(&keep(&recording, |k| k >= STEP - 5)), Reason::ShortBefore(5));
    assert_eq!(result(&keep(&recording, |k| k >= STEP - 10)).verdict, Verdict::NearOptimal);
    for n in 1..4 {
        assert_eq!(unclear(&keep(&recording, |k| k < n)), Reason::NoStep);
    }
}

#[test]
fn loops_that_were_not_at_rest() {
    let mut recording = good();
    for (t, pv) in recording.t.iter().zip(&mut recording.pv) {
        *pv += 0.01 * t;
    }
    assert_eq!(unclear(&recording), Reason::NotSteady);
    let mut recording = good();
    for (t, pv) in recording.t.iter().zip(&mut recording.pv) {
        *pv += 0.08 * (2.5 * t).sin();
    }
    assert_eq!(unclear(&recording), Reason::NotSteady);
    let mut recording = good();
    for k in 0..STEP {
        recording.co[k] -= 0.2 * (STEP - k) as f64 / 40.0;
    }
    assert_eq!(unclear(&recording), Reason::NotSteady);
    let mut recording = good();
    recording.sp.iter_mut().for_each(|sp| *sp = 0.1);
    assert!(matches!(unclear(&recording), Reason::NotAtSetpoint(x) if (0.2..0.3).contains(&x)));
}

#[test]
fn something_else_happens() {
    let mut recording = good();
    recording.sp[STEP + 100..].fill(0.5);
    assert_eq!(unclear(&recording), Reason::SetpointMoved);
    // After the response it does not matter, nor does what the loop does then.
    let mut recording = good();
    recording.sp[STEP + 600..].fill(0.5);
    recording.pv[STEP + 640..].fill(0.7);
    assert_eq!(self::result(&recording).verdict, Verdict::NearOptimal);
    let mut recording = good();
    recording.co[STEP + 150..STEP + 160].fill(0.6);
    assert_eq!(unclear(&recording), Reason::SteppedAgain);
    // The output ends somewhere else.
    let mut recording = good();
    for k in STEP + 100..recording.co.len() {
        recording.co[k] += 0.5 * ((k - STEP - 100) as f64 / 200.0).min(1.0);
    }
    assert!(matches!(unclear(&recording), Reason::OutputNotBack(x) if (0.4..0.6).contains(&x)));
    // A jump of the output with one of the set-point is a set-point test: what looks like a step comes later, if at all.
    let mut recording = good();
    recording.sp[STEP..].fill(0.5);
    assert!(matches!(unclear(&recording), Reason::NotAtSetpoint(_) | Reason::NoStep));
    let experiment = Experiment { step_at: Some(STEP), ..recording.experiment() };
    let result = assess(&experiment, &AssessOptions::default()).unwrap();
    assert_eq!(result.reasons, [Reason::SetpointMoved]);
}

#[test]
fn samples_that_are_missing() {
    let recording = good();
    let reason = unclear(&keep(&recording, |k| k % 16 == 0));
    assert!(matches!(reason, Reason::CoarseSampling(6 | 7)), "{reason:?}");
    let gap = keep(&recording, |k| !(STEP + 20..STEP + 70).contains(&k));
    assert!(matches!(unclear(&gap), Reason::Gap(x) if (0.4..0.6).contains(&x)));
    // Every fifth: the times are rough, and that is said.
    let rough = result(&keep(&recording, |k| k % 5 == 0));
    assert_eq!(rough.verdict, Verdict::NearOptimal);
    assert!(rough.warnings.iter().any(|warning| warning.to_string().contains("rough")), "{rough:?}");
    // Some here and there, times with jitter, bad and doubled samples.
    let mut pcg = Pcg::new(3);
    let mut odd = keep(&recording, |_| pcg.uniform() > 0.3);
    odd.t.iter_mut().for_each(|t| *t += 0.004 * pcg.uniform());
    odd.pv[500] = f64::NAN;
    odd.co[20] = f64::INFINITY;
    odd.t[701] = odd.t[700];
    let (clean, odd) = (result(&recording), result(&odd));
    let (a, b) = (clean.features.unwrap(), odd.features.unwrap());
    assert_eq!(odd.verdict, Verdict::NearOptimal);
    assert!((a.dip.unwrap() - b.dip.unwrap()).abs() < 0.01 && (a.t1 / b.t1 - 1.0).abs() < 0.01, "{b:?}");
    assert!(odd.warnings[0].to_string().starts_with("samples = 3"), "{}", odd.warnings[0]);
}

/// Units, signs, time scales and the operating point make no difference.
#[test]
fn scales() {
    let plain = result(&good());
    let expected = plain.features.unwrap();
    for (time, y, u, t0, y0, u0) in [
        (1e-6, 1.0, 1.0, 0.0, 0.0, 0.0),
        (1e6, -1e6, 1e-6, 0.0, 0.0, 0.0),
        (60.0, 12.0, -8.0, 1.7e9, 350.0, 42.0),
        (1.0, 1e-30, 1e30, 5.0, 0.0, 0.0),
        (0.1, -1e60, 1e60, 0.0, 0.0, 0.0),
    ] {
        let mut recording = good();
        recording.t.iter_mut().for_each(|t| *t = t0 + time * *t);
        recording.pv.iter_mut().for_each(|pv| *pv = y0 + y * *pv);
        recording.sp.fill(y0);
        recording.co.iter_mut().for_each(|co| *co = u0 + u * *co);
        let result = result(&recording);
        let features = result.features.unwrap();
        assert_eq!((result.verdict, &result.reasons), (plain.verdict, &plain.reasons));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b.abs();
        assert!(close(features.p1, expected.p1 * f64::abs(y)), "{features:?}");
        assert!(close(features.t1, expected.t1 * time), "{features:?}");
        for (a, b) in
            [(features.dip, expected.dip), (features.t_ratio, expected.t_ratio), (features.r3, expected.r3)]
        {
            assert!(close(a.unwrap(), b.unwrap()), "{features:?}");
        }
    }
}

/// A step downwards, and marks that lie where the measurement is.
#[test]
fn marks_lie_on_the_response() {
    let mut recording = good();
    recording.co.iter_mut().for_each(|co| *co = 40.0 - *co);
    recording.pv.iter_mut().for_each(|pv| *pv = 20.0 - *pv);
    recording.sp.fill(20.0);
    let result = result(&recording);
    let (marks, features) = (result.marks.unwrap(), result.features.unwrap());
    assert_eq!((marks.step, marks.auto), (8.0, Some(9.025)), "the first sample whose output has moved");
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(near(marks.baseline, 20.0) && near(marks.inputs.0, 40.0) && near(marks.inputs.1, 39.0));
    let (peak, dip, third) = (marks.peak.unwrap(), marks.dip.unwrap(), marks.third.unwrap());
    assert!((peak.y - (20.0 - features.p1)).abs() < 1e-12 && dip.y > 20.0 && third.y < 20.0);
    assert!(peak.t < dip.t && dip.t < third.t && marks.span.0 < 8.0 && third.t < marks.span.1);
    for place in [peak, dip, third] {
        let k = recording.t.partition_point(|&t| t < place.t);
        assert!((recording.pv[k] - place.y).abs() < 0.01, "{place:?}");
    }
}

/// Where the step is can be said roughly.
#[test]
fn the_step_may_be_said() {
    let recording = good();
    let found = result(&recording);
    for at in [STEP - 4, STEP, STEP + 5] {
        let experiment = Experiment { step_at: Some(at), ..recording.experiment() };
        assert_eq!(assess(&experiment, &AssessOptions::default()).unwrap(), found);
    }
    let experiment = Experiment { step_at: Some(STEP - 100), ..recording.experiment() };
    let result = assess(&experiment, &AssessOptions::default()).unwrap();
    assert_eq!(result.reasons, [Reason::NoStep]);
    // In a longer log the largest step is taken, with a second one it can be said which.
    let mut twice = recording.clone();
    let length = twice.t[twice.t.len() - 1] + 0.025;
    for k in 0..recording.t.len() {
        twice.t.push(length + recording.t[k]);
        twice.sp.push(0.0);
        twice.pv.push(2.0 * recording.pv[k]);
        twice.co.push(2.0 * recording.co[k]);
    }
    let of =
        |step_at| assess(&Experiment { step_at, ..twice.experiment() }, &AssessOptions::default()).unwrap();
    let (largest, first) = (of(None), of(Some(STEP)));
    assert_eq!((largest.verdict, first.verdict), (Verdict::NearOptimal, Verdict::NearOptimal));
    assert!((largest.features.unwrap().p1 / first.features.unwrap().p1 - 2.0).abs() < 1e-6);
}

#[test]
fn without_a_setpoint() {
    let recording = good();
    let experiment = Experiment { setpoint: &[], ..recording.experiment() };
    let result = assess(&experiment, &AssessOptions::default()).unwrap();
    assert_eq!((result.verdict, result.warnings.len()), (Verdict::NearOptimal, 1));
}

/// The output is recorded with noise, too.
#[test]
fn noise_on_the_output() {
    let mut recording = good();
    let mut pcg = Pcg::new(4);
    recording.co.iter_mut().for_each(|co| *co += 0.02 * pcg.gaussian());
    let result = result(&recording);
    assert_eq!(result.verdict, Verdict::NearOptimal, "{result:?}");
}

#[test]
fn a_long_log_takes_no_time() {
    let plan = Plan { delay: 4000, rest: 20, length: 200, hold: 100, noise: 0.004, ..optimum() };
    let recording = plan.sampled();
    assert!(recording.t.len() > 800_000);
    let start = std::time::Instant::now();
    let result = result(&recording);
    assert_eq!(result.verdict, Verdict::NearOptimal, "{:?} {:?}", result.reasons, result.features);
    assert!(start.elapsed().as_secs_f64() < 10.0, "{:?}", start.elapsed());
}

#[test]
fn what_is_no_record_is_refused() {
    let options = AssessOptions::default();
    let refused = |t: &[f64], y: &[f64]| assess(&Experiment::new(t, y, y, y), &options).unwrap_err();
    for (t, y, word) in [
        (&[][..], &[][..], "no samples"),
        (&[0.0, 1.0], &[0.0], "different lengths"),
        (&[0.0, 1.0, 0.5], &[0.0; 3], "do not rise"),
        (&[0.0, 1.0], &[0.0, 1e200], "1e100"),
        (&[f64::NAN; 3], &[0.0; 3], "no sample"),
        (&[0.0, 1e-200], &[0.0; 2], "shorter"),
    ] {
        let refusal = refused(t, y);
        assert!(matches!(refusal, Refusal::Data { .. }) && refusal.to_string().contains(word), "{refusal}");
    }
    let recording = good();
    for (step_at, auto_at) in [(Some(5000), None), (None, Some(2320))] {
        let experiment = Experiment { step_at, auto_at, ..recording.experiment() };
        let refusal = assess(&experiment, &options).unwrap_err();
        assert!(matches!(refusal, Refusal::OutOfRange { value, max: 2319.0, .. } if value >= 2320.0));
    }
}

/// Whatever the record, there is no panic and no number that is none.
#[test]
fn any_record_at_all() {
    let mut pcg = Pcg::new(77);
    let special = [0.0, -0.0, 1.0, -1.0, 1e-320, 1e100, -1e100, f64::MAX, f64::NAN, f64::INFINITY, 1e-99];
    for round in 0..4000 {
        let n = pcg.next() as usize % 80;
        let mut value = |kind: usize| match kind % 4 {
            0 => pcg.gaussian(),
            1 => special[pcg.next() as usize % special.len()],
            2 => f64::from(pcg.next() % 3),
            _ => f64::from_bits(u64::from(pcg.next()) << 32 | u64::from(pcg.next())),
        };
        let mut t: Vec<f64> = (0..n).map(|k| k as f64 + 0.3 * value(0)).collect();
        if round % 2 == 0 {
            t = (0..n).map(|_| value(round / 2)).collect();
            t.sort_unstable_by(f64::total_cmp);
            t.retain(|t| t.is_nan() || t.abs() <= 1e100);
        }
        let n = t.len();
        let mut list = |kind: usize| -> Vec<f64> { (0..n).map(|_| value(kind)).collect() };
        let (sp, pv, mut co) = (list(2), list(round / 7), list(round / 5));
        let sp = if round % 3 == 0 { sp } else { vec![1.0; n] };
        if let Some(step) = (round % 5 > 1).then_some(n / 3) {
            co[step..].iter_mut().for_each(|co| *co += 20.0);
        }
        let step_at = (round % 11 == 0 && n > 0).then_some(n / 2);
        let experiment = Experiment { step_at, ..Experiment::new(&t, &sp, &pv, &co) };
        let Ok(result) = assess(&experiment, &AssessOptions::default()) else { continue };
        assert!(!result.reasons.is_empty());
        if let (Some(f), true) = (result.features, result.verdict != Verdict::Inconclusive) {
            let all =
                [f.p1, f.t1, f.sigma, f.dip.unwrap_or(0.0), f.t_ratio.unwrap_or(0.0), f.r3.unwrap_or(0.0)];
            assert!(all.iter().all(|x| x.is_finite()) && f.p1 > 0.0 && f.t1 > 0.0, "{f:?}");
        }
    }
}

#[test]
fn a_record_without_the_experiment_is_refused_for_what_it_shows() {
    // Nothing at all, with and without noise of the measurement.
    let mut still = good();
    still.co.iter_mut().for_each(|co| *co = 3.0);
    assert_eq!(unclear(&still), Reason::OutputConstant);
    noisy(&mut still, 0.05);
    assert_eq!(unclear(&still), Reason::OutputConstant);
    // A PI loop that follows a step of its set-point: kp (1 + 1/(ti s)), the process 1/(1+s).
    for (size, noise) in [(2.0, 0.0), (-0.3, 0.002), (0.5, 0.01)] {
        let (mut y, mut i, ts) = (0.0, 0.0, 0.02);
        let mut pcg = Pcg::new(11);
        let mut record = Recording { t: vec![], sp: vec![], pv: vec![], co: vec![], iae: 0.0 };
        for k in 0..2000 {
            let sp = if k < 500 { 0.0 } else { size };
            let pv = y + noise * pcg.gaussian();
            i += 1.5 * ts / 0.9 * (sp - pv);
            let co = i + 1.5 * (sp - pv);
            record.t.push(ts * f64::from(k));
            record.sp.push(sp);
            record.pv.push(pv);
            record.co.push(co);
            y += (co - y) * ts;
        }
        assert_eq!(unclear(&record), Reason::SetpointChange, "{size}, {noise}");
    }
    // Only noise.
    let mut pcg = Pcg::new(12);
    let mut noise = good();
    for (pv, co) in noise.pv.iter_mut().zip(&mut noise.co) {
        *pv = pcg.gaussian();
        *co = -0.5 * *pv;
    }
    assert_eq!(unclear(&noise), Reason::NoStep);
}

/// Upside down everything is the same, but the marks are where the measurement is.
#[test]
fn a_negative_gain_turns_the_picture_not_the_verdict() {
    let (plain, mut turned) = (good(), good());
    turned.pv.iter_mut().for_each(|pv| *pv = -*pv);
    let (plain, turned) = (result(&plain), result(&turned));
    assert_eq!((plain.verdict, &plain.features), (turned.verdict, &turned.features));
    let (a, b) = (plain.marks.expect("marks"), turned.marks.expect("marks"));
    assert!(!a.is_reverse() && b.is_reverse());
    assert_eq!(a.dip.map(|place| place.y), b.dip.map(|place| -place.y));
}

/// Marked from twice the deviation on that was added, and measured in either case.
#[test]
fn a_dip_that_no_eye_sees_is_not_marked() {
    let (mut hidden, mut shown) = (0, 0);
    // Sampled finely, smoothing finds a dip far below the noise of a sample.
    let fine = Plan { delay: 200, hold: 50, ..optimum() };
    for (kp, ti) in [0.6, 0.7, 0.8, 1.0].iter().flat_map(|kp| [0.9, 1.1].map(|ti| (*kp, ti))) {
        let clean = fine.detuned(kp, ti).sampled();
        let p1 = result(&clean).features.expect("features").p1;
        for share in [0.01, 0.03, 0.06, 0.09] {
            let mut recording = keep(&clean, |_| true);
            noisy(&mut recording, share * p1);
            let found = result(&recording);
            let (Some(features), Some(marks)) = (found.features, found.marks) else { continue };
            let Some((third, dip)) = features.r3.zip(features.dip) else { continue };
            // The deviation is itself an estimate.
            let depth = (third - dip) / share;
            let marked = [marks.dip.is_some(), marks.third.is_some()];
            if depth >= 2.3 {
                shown += 1;
                assert_eq!(marked, [true; 2], "{kp}, {ti}, {share}: {depth}");
            } else if depth <= 1.7 {
                hidden += 1;
                assert_eq!(marked, [false; 2], "{kp}, {ti}, {share}: {depth}");
            }
        }
    }
    assert!(hidden >= 2 && shown >= 8, "{hidden} {shown}");
}
