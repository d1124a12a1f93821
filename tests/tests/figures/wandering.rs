//! The pages about disturbances that do not rest, and about a level and a valve.

use super::page::{Page, near, quiet};
use controller_sim_host::scenario::{Actuator, Sensor};
use controller_sim_host::simulate::{Precision, Sample};
use std::f64::consts::TAU;

/// The amplitude of a signal at a period, from a whole number of periods.
fn amplitude(samples: &[Sample], period: f64, of: impl Fn(&Sample) -> f64) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for s in samples {
        let angle = TAU * s.t / period;
        sine += of(s) * angle.sin();
        cosine += of(s) * angle.cos();
    }
    2.0 * sine.hypot(cosine) / samples.len() as f64
}

/// `|1 - C_u|` of the observer at an angle per sample: its lag behind `late` samples (dead time and hold).
fn rest(angle: f64, late: f64, ts: f64, alpha: f64) -> f64 {
    let p = (-ts / alpha).exp();
    // C_u = (1 - p) e^{-i late angle}/(1 - p e^{-i angle}).
    let (re, im) = (1.0 - p * angle.cos(), p * angle.sin());
    let (size, phase) = ((1.0 - p) / re.hypot(im), -late * angle - im.atan2(re));
    (1.0 - size * phase.cos()).hypot(size * phase.sin())
}

/// With an exact model the observer multiplies the error of the PI by `1 - C_u`, exactly so at the samples. The rest of
/// what was before has died out by the last periods: the slowest pole of the loops is at about 1/80 s, but a zero near
/// hides most of it.
#[test]
fn an_observer_helps_up_to_a_frequency() {
    let page = Page::new("sine-disturbance");
    let ts = page.scenario.ts;
    // The last whole periods before the next event.
    for (period, from, to, slow, fast) in [
        (500.0, 1500.0, 2000.0, "0.166", "0.067"),
        (50.0, 2300.0, 2500.0, "1.03", "0.64"),
        (10.0, 2900.0, 3000.0, "1.15", "1.62"),
    ] {
        let y = |who: &str| amplitude(page.samples(who, from, to), period, |s| s.y);
        let alone = y("PI");
        for (who, alpha, figure) in [("alpha = 10", 10.0, slow), ("alpha = 2", 2.0, fast)] {
            let ratio = y(who) / alone;
            near(&format!("{who}, period {period}"), ratio, rest(TAU * ts / period, 17.0, ts, alpha), 1e-4);
            page.says(&[(figure, ratio)]);
        }
        if period == 10.0 {
            page.says(&[("0.042", alone)]);
        }
    }
}

/// One run, as the page says; that the mean of many runs is the theory is shown by the exact walks.
#[test]
fn a_wandering_disturbance() {
    let page = Page::new("random-walk");
    let alone = page.after("random walk", "PI");
    // IAE and TV of the run and of the theory for long ones (the reference has IAE .853 .394 .188, TV 1.187 1.938 4.50).
    for (who, iae, tv, theory) in [
        ("alpha = 100", "0.82", "1.18", (("0.85", 0.853_035_1), ("1.19", 1.186_800_86))),
        ("alpha = 10", "0.39", "1.92", (("0.39", 0.394_182_917), ("1.94", 1.937_826_36))),
        ("alpha = 1", "0.19", "4.15", (("0.19", 0.188_150_494), ("4.50", 4.497_973_21))),
    ] {
        let m = page.after("random walk", who);
        page.says(&[(iae, m.iae / alone.iae), (tv, m.tv / alone.tv), theory.0, theory.1]);
    }
}

/// A PI with `ti = 4/(K k)` on `K/s`: the response to a step `d` is `K d t e^{-w t}` with `w = K k/2`, at most
/// `2 d/(e k)`.
#[test]
fn a_level_loop() {
    let page = Page::new("level");
    let peak = |k: f64| 2.0 * 20.0 / (std::f64::consts::E * k);
    page.says(&[("1.47", peak(10.0)), ("15.0", peak(0.98))]);
    let step = "inflow 40 to 60 %";
    page.says(&[("1.48", page.after(step, "tight").e_max), ("15.0", page.after(step, "averaging").e_max)]);
    let mut ideal = quiet(page.scenario.clone());
    ideal.sensor = Sensor::default();
    ideal.actuator = Actuator::default();
    let ideal = Page::of(ideal);
    for (who, k) in [("tight", 10.0), ("averaging", 0.98)] {
        // The sample adds half a period of delay: a relative change of the order of w ts.
        near(who, ideal.after(step, who).e_max, peak(k), 0.002 * k / 2.0 * page.scenario.ts);
    }
    // What of the swing goes on: |K C/(s + K C)|. A sample's delay turns it by up to w ts.
    let w = TAU / 300.0;
    let passed = |k: f64, ti: f64| {
        let a = 0.002 * k;
        (a * w).hypot(a / ti) / (a / ti - w * w).hypot(a * w)
    };
    for (who, k, ti, figure) in [("tight", 10.0, 200.0, "8.1"), ("averaging", 0.98, 2040.0, "0.94")] {
        let u = amplitude(page.samples(who, 14_400.0 - 6000.0, 14_400.0), 300.0, |s| s.u);
        near(who, u, 10.0 * passed(k, ti), w * page.scenario.ts);
        page.says(&[(figure, u)]);
    }
}

#[test]
fn a_valve_with_steps() {
    for precision in [Precision::F64, Precision::F32] {
        let page = Page::in_precision(Page::scenario("actuator"), precision);
        let (tail, at_rest) = ((700.0, 900.0), (300.0, 450.0));
        let range = |who: &str, (from, to): (f64, f64), of: fn(&Sample) -> f64| {
            let of: Vec<f64> = page.samples(who, from, to).iter().map(of).collect();
            of.iter().fold((f64::MAX, f64::MIN), |(lo, hi), x| (lo.min(*x), hi.max(*x)))
        };
        for who in ["PI", "PI, dead band"] {
            assert_eq!(range(who, at_rest, |s| s.applied), (30.0, 30.0), "{who} rests at 30 %");
        }
        assert_eq!(range("PI", tail, |s| s.applied), (25.0, 26.0), "hunts");
        assert_eq!(range("PI, dead band", tail, |s| s.applied), (26.0, 26.0), "stands still");
        // At rest: 1.5 K for each of 26 + 4.3 - 30 %.
        near("beside", page.last("PI, dead band").y - 45.0, 0.45, 5e-3);
        page.says(&[("0.45", page.last("PI, dead band").y - 45.0)]);
        page.says(&[
            ("22", page.after("less load", "PI").tv),
            ("5", page.after("less load", "PI, dead band").tv),
        ]);
    }
    let narrow = Page::of(Page::edited("actuator", &[("deadband = 0.75", "deadband = 0.2")]));
    let moves =
        narrow.samples("PI, dead band", 600.0, 900.0).windows(2).filter(|w| w[0].applied != w[1].applied);
    assert!(moves.count() >= 2, "hunts, too");
}
