//! The pages about windup, sensors, precision, levels.

use super::page::{Page, mentions, near};
use controller_core::{Mode, Status};
use controller_sim_host::simulate::Precision;

#[test]
fn windup() {
    let page = Page::new("windup");
    let (step, pulse) = ("set-point 0 to 1", "pulse of -1.5");
    for (who, on_step, on_pulse) in
        [("back-calculation", "0.91", "0.81"), ("conditional", "1.03", "0.80"), ("none", "1.25", "1.34")]
    {
        page.says(&[(on_step, page.after(step, who).iae), (on_pulse, page.after(pulse, who).iae)]);
    }
    // After the pulse: how long the output stays at its limit.
    let stays = |who: &str| {
        let after = page.samples(who, 11.0, 15.0);
        after.iter().take_while(|s| s.status.has(Status::LIMITED_HIGH)).count() as f64 * page.scenario.ts
    };
    assert!(
        stays("none") > 2.0 * stays("back-calculation"),
        "{} {}",
        stays("none"),
        stays("back-calculation")
    );
    // The new limits make no bump.
    for controller in &page.result.controllers {
        let around = page.samples(&controller.name, 19.9, 20.1);
        assert!(around.windows(2).all(|w| (w[1].u - w[0].u).abs() < 0.02), "{}", controller.name);
    }
    // Without limits the rules do not matter.
    let free = Page::of(Page::edited("windup", &[("limits = { lo = 0.0, hi = 1.5 }\n", "")]));
    let all: Vec<_> = free.result.controllers.iter().map(|c| c.total).collect();
    assert!(all.windows(2).all(|w| w[0] == w[1]));
}

#[test]
fn a_sensor_that_fails() {
    let page = Page::new("sensor");
    let (hold, safe) = ("hold, go on", "safe output, wait");
    for who in [hold, safe] {
        assert!(page.after("2 bad samples", who).e_max < 0.01);
    }
    // True errors: the plant without noise, which e_max is made of.
    let events: Vec<f64> = page.scenario.events.iter().map(|e| e.at).collect();
    assert_eq!(events, [100.0, 200.0, 300.0, 450.0, 460.0, 560.0]);
    let e_max = |who: &str, at: usize| {
        let c = page.result.controllers.iter().find(|c| c.name == who).expect("there");
        c.events.iter().find(|s| s.at == events[at]).expect("a stretch").metrics.e_max
    };
    page.says(&[
        ("0.05", e_max(hold, 1)),
        ("15", e_max(safe, 2)),
        ("6.4", e_max(hold, 4)),
        ("6.5", e_max(safe, 5)),
    ]);
    // Which side: too hot, too cold when the sensor is back after 60 s.
    assert!(page.samples(hold, 511.0, 512.0).iter().all(|s| s.y > 55.0));
    assert!(page.samples(safe, 550.0, 560.0).iter().all(|s| s.y < 45.0));
    // It waits for the acknowledgement.
    let mode = |t: f64, who: &str| page.samples(who, t, t + 1.0)[0].mode;
    assert_eq!((mode(270.0, safe), mode(301.0, safe)), (Mode::Fallback, Mode::Auto));
    assert_eq!((mode(255.0, hold), mode(262.0, hold)), (Mode::Fallback, Mode::Auto));

    let bridged = Page::of(Page::edited(
        "sensor",
        &[("hold_samples = 4, action = \"ramp\"", "hold_samples = 200, action = \"ramp\"")],
    ));
    assert!(bridged.samples(safe, 0.0, 800.0).iter().all(|s| s.mode != Mode::Fallback));
    let other = Page::of(Page::edited("sensor", &[("disturbance = 6.0", "disturbance = -6.0")]));
    let coldest = other
        .samples(safe, 460.0, 800.0)
        .iter()
        .filter(|s| s.y.is_finite())
        .fold(0.0_f64, |a, s| a.max(s.r - s.y));
    other.says(&[("25", coldest)]);
}

/// The stall of a plain sum: near 60 single precision numbers are 2^-18 apart, and half of that is `ki ts e` at the error
/// of the page.
#[test]
fn single_precision_does_not_stall() {
    let scenario = Page::scenario("single-precision");
    let (ki, ts) = (1.0 / 300.0, scenario.ts);
    let stall = 0.5 * 2.0_f64.powi(-18) / (ki * ts);
    for integral in [50.0_f32, 50.3, 50.5] {
        assert_eq!(integral + (ki * ts * 0.999 * stall) as f32, integral);
        assert_ne!(integral + (ki * ts * 1.001 * stall) as f32, integral);
    }
    let pages = [Precision::F32, Precision::F64].map(|p| Page::in_precision(scenario.clone(), p));
    let [single, double] = &pages;
    single.says(&[("0.0572", stall), ("3.3", 1e5 * ki * ts)]);
    let after = |page: &Page, who: &str| (page.after("100 to 101 °C", who), page.after("less load", who));
    for page in &pages {
        let (step, load) = after(page, "PI");
        page.says(&[("150.0", step.iae), ("149.9", load.iae)]);
        // Far below the stall: the integral goes on. Once at rest it has done all of its work: IE = change/(2 ki).
        assert!((page.last("PI").r - page.last("PI").y).abs() < 0.01 * stall);
        near("IE", step.ie, 0.5 / ki, 1e-3);
        let last = page.last("as if it stalled");
        near("the dead band", (last.r - last.y).abs(), stall, 0.05);
        assert!(after(page, "as if it stalled").1.iae > load.iae + 0.5 * stall * 2000.0);
    }
    single.says(&[("0.73", after(single, "PI").1.tv)]);
    double.says(&[("0.50", after(double, "PI").1.tv)]);
    mentions(&scenario, "ts = 0.002 and deadband = 0.286");
    assert!((stall * scenario.ts / 0.002 - 0.286).abs() < 5e-4);
}

/// In the cascade the inner integral term takes the disturbance, so the outer one ends where it was: IE is zero. One loop
/// has `IE = d/ki`.
#[test]
fn a_cascade() {
    let (step, load) = ("60 to 65 °C", "supply pressure falls");
    let page = Page::new("cascade");
    let after = |event: &str, who: &str| page.after(event, who);
    page.says(&[("2.5", after(load, "one loop").e_max), ("0.13", after(load, "cascade").e_max)]);
    page.says(&[("250", after(load, "one loop").iae), ("4.7", after(load, "cascade").iae)]);
    page.says(&[("147", after(step, "one loop").iae), ("112", after(step, "cascade").iae)]);
    let ki = 3.5 / 88.0;
    page.says(&[("251", 10.0 / ki)]);
    let mut long = page.scenario.clone();
    long.events[1].at += 2000.0;
    long.duration += 4000.0;
    let long = Page::of(long);
    near("IE", long.after(load, "one loop").ie, 10.0 / ki, 1e-4);
    assert!(long.after(load, "cascade").ie.abs() < 1e-3 * 10.0 / ki, "{:?}", long.after(load, "cascade"));

    let slow = Page::of(Page::edited("cascade", &[("k = 3.0, ti = 4.0", "k = 0.3, ti = 6.0")]));
    page.says(&[("274", slow.after(step, "cascade").iae)]);
}

#[test]
fn a_recorded_load() {
    let page = Page::new("recorded-load");
    let after = |who: &str| page.after("recorded load", who);
    page.says(&[("1.28", after("PI").e_max), ("0.83", after("PI + DOB").e_max)]);
    page.says(&[("967", after("PI").iae), ("275", after("PI + DOB").iae)]);
    // The file is what the comment in the scenario says.
    for row in 0..120 {
        let t = 30.0 * f64::from(row);
        let more = if (1500.0..2100.0).contains(&t) { 6.0 } else { 0.0 };
        let load = 12.0 + 4.0 * (t / 410.0).sin() + 2.5 * (t / 133.0 + 1.0).sin() + more;
        let d = page.samples("PI", t + 1.0, t + 2.0)[0].d;
        assert!((d + load).abs() <= 0.05 + 1e-9, "at {t}: {d} against {load}");
    }
}
