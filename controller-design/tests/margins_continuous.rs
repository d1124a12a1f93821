//! Margins of continuous loops against closed forms, root conditions and a dense sweep written here.

use core::f64::consts::PI;

use controller_core::PidConfig;
use controller_core::compensator::{EstimatorConfig, ObserverConfig};
use controller_design::Refusal;
use controller_design::margins::{ContinuousLoop, Margins};
use controller_design::model::{Complex, TransferFunction, parse};

fn plant(text: &str) -> TransferFunction {
    parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

fn pi(kp: f64, ki: f64) -> PidConfig {
    PidConfig { kp, ki, ..PidConfig::default() }
}

fn margins(text: &str, pid: &PidConfig) -> Result<Margins, Refusal> {
    ContinuousLoop::new(&plant(text), pid).margins()
}

fn near(what: &str, got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance * want.abs(), "{what}: {got:.15e}, want {want:.15e}");
}

/// `max|S|` on a dense sweep of `L`, by value only.
fn swept_ms(l: impl Fn(f64) -> Complex, low: f64, high: f64) -> f64 {
    let n = 400_000;
    (0..=n).fold(0.0, |ms: f64, k| {
        let omega = low * libm::pow(high / low, f64::from(k) / f64::from(n));
        ms.max(1.0 / (Complex::ONE + l(omega)).abs())
    })
}

#[test]
fn three_lags_under_proportional_control() {
    // L = k/(1+s)^3: phase -180 at sqrt(3), |L| = k/8 there; |L| = 1 at sqrt(k^(2/3) - 1).
    for scale in [1e-6, 1.0, 1e6] {
        let g = plant(&format!("1/(1+{scale}*s)^3"));
        let m = ContinuousLoop::new(&g, &pi(4.0, 0.0)).margins().expect("stable");
        let omega = libm::sqrt(libm::cbrt(16.0) - 1.0);
        let phase = 3.0 * libm::atan(omega);
        near("gm", m.gm, 2.0, 1e-13);
        near("omega_gm", m.omega_gm.expect("one"), libm::sqrt(3.0) / scale, 1e-12);
        near("pm", m.pm_deg, (PI - phase).to_degrees(), 1e-12);
        near("omega_pm", m.omega_pm.expect("one"), omega / scale, 1e-12);
        near("delay", m.delay_margin, (PI - phase) / omega * scale, 1e-12);
        assert_eq!((m.gm_low, m.omega_gm_low), (0.0, None));
        assert!(m.ms > m.gm / (m.gm - 1.0));
    }
    assert!(margins("1/(1+s)^3", &pi(7.999, 0.0)).is_ok());
    assert!(margins("1/(1+s)^3", &pi(8.001, 0.0)).is_err());
}

#[test]
fn second_order_peaks_have_closed_forms() {
    // L = w0^2/(s(s+2*z*w0)): Mt = 1/(2*z*sqrt(1-z^2)), and with e = 8*z^2, r = sqrt(1+e):
    // Ms^2 = (1+e+(e/2+1)*r)/(1+e+(e/2-1)*r).
    for z in [0.05, 0.2, 0.5] {
        let m = margins(&format!("1/(s*(s+{}))", 2.0 * z), &pi(1.0, 0.0)).expect("stable");
        let e = 8.0 * z * z;
        near("mt", m.mt, 1.0 / (2.0 * z * libm::sqrt(1.0 - z * z)), 1e-12);
        let root = libm::sqrt(e + 1.0);
        near(
            "ms",
            m.ms,
            libm::sqrt((e + 1.0 + (0.5 * e + 1.0) * root) / (e + 1.0 + (0.5 * e - 1.0) * root)),
            1e-12,
        );
        assert_eq!(m.gm, f64::INFINITY);
    }
}

#[test]
fn a_first_order_loop_has_no_gain_margin_and_never_a_peak() {
    let m = margins("2/(1+5*s)", &pi(3.0, 0.6)).expect("stable");
    // kp/ki = tau: L = 1.2/s.
    near("pm", m.pm_deg, 90.0, 1e-12);
    near("delay", m.delay_margin, PI / 2.0 / 1.2, 1e-12);
    assert!(m.ms <= 1.0 + 1e-9 && m.gm == f64::INFINITY);
    assert_eq!(m.omega_gm, None);
}

#[test]
fn dead_time_alone_and_with_a_circle_at_high_frequency() {
    // L = k*exp(-s): |L| = k for ever.
    let m = margins("exp(-s)", &pi(0.5, 0.0)).expect("stable");
    near("ms", m.ms, 2.0, 1e-9);
    near("mt", m.mt, 1.0, 1e-9);
    near("gm", m.gm, 2.0, 1e-12);
    assert_eq!((m.pm_deg, m.delay_margin), (f64::INFINITY, f64::INFINITY));
    assert!(margins("exp(-s)", &pi(1.01, 0.0)).is_err());
    // Pure integral control: L = ki*exp(-s)/s, limit pi/2.
    let m = margins("exp(-s)", &pi(0.0, 0.5)).expect("stable");
    near("gm", m.gm, PI, 1e-12);
    assert!(margins("exp(-s)", &pi(0.0, 1.58)).is_err() && margins("exp(-s)", &pi(0.0, 1.56)).is_ok());
    // A dead time that is extremely long against the lag.
    let m = margins("exp(-s)/(1+1e-5*s)", &pi(0.3, 0.4)).expect("stable");
    assert!(m.ms > 1.0 / 0.7 && m.ms < 3.0, "{m:?}");
}

#[test]
fn stability_is_that_of_the_roots() {
    // 1/(1+s)^3 with PI: s(1+s)^3 + kp*s + ki; Routh: 0 < ki < (1+kp)*(8-kp)/9.
    for kp in [0.1, 1.0, 4.0, 7.5] {
        let limit = (1.0 + kp) * (8.0 - kp) / 9.0;
        for (share, stable) in [(0.5, true), (0.999, true), (1.001, false), (30.0, false), (-0.1, false)] {
            let m = margins("1/(1+s)^3", &pi(kp, share * limit));
            assert_eq!(m.is_ok(), stable, "kp {kp}, {share} of the limit: {m:?}");
        }
    }
    // An unstable plant needs at least its share of gain: 1/(s-1) with kp > 1, and two-sided margins.
    assert!(margins("1/(s-1)", &pi(0.9, 0.0)).is_err());
    let m = margins("1/(s-1)", &pi(4.0, 0.0)).expect("stable");
    near("ms", m.ms, 1.0, 1e-6);
    let m = margins("1/(s-1)", &pi(4.0, 1.0)).expect("stable");
    assert!(m.gm == f64::INFINITY && m.gm_low > 0.0 && m.gm_low < 1.0, "{m:?}");
    // s^2 + (k*kp - 1)*s + k*ki has its roots on the axis at k = 1/kp.
    near("gm_low", m.gm_low, 0.25, 1e-12);
    // Two integrators: conditionally stable with PI and a lead zero. s^3 + k*(s+0.3)*(2s+1).
    let m = margins("(1+2*s)/s^2", &pi(1.0, 0.3)).expect("stable");
    near("gm_low", m.gm_low, 0.3 / (1.6 * 2.0), 1e-12);
    // A conditionally stable loop below its window.
    assert!(margins("(1+2*s)/s^2", &pi(0.0937, 0.3 * 0.0937)).is_err());
    assert!(margins("(1+2*s)/s^2", &pi(0.0939, 0.3 * 0.0939)).is_ok());
}

#[test]
fn a_lightly_damped_peak_is_not_missed() {
    for zeta in [1e-2, 1e-4, 1e-6] {
        // Gain margin of kp + resonance: s^2 + 2*zeta*s + 1 + k with an extra lag is cut by its resonance.
        let text = format!("1/((1+s)*(1+{}*s+s^2))", 2.0 * zeta);
        // (1+s)(1+2z*s+s^2) + k: a3 = 1, a2 = 1+2z, a1 = 1+2z, a0 = 1+k; limit k = (1+2z)^2 - 1.
        let limit = (1.0 + 2.0 * zeta) * (1.0 + 2.0 * zeta) - 1.0;
        let m = margins(&text, &pi(0.5 * limit, 0.0)).expect("stable");
        near("gm", m.gm, 2.0, 1e-7 + 1e-13 / zeta);
        assert!(margins(&text, &pi(1.01 * limit, 0.0)).is_err());
    }
    let refused = margins("1/((1+s)*(1+s^2))", &pi(0.1, 0.1)).expect_err("undamped");
    assert_eq!(refused.to_string(), "the plant must have no undamped pair of poles");
}

#[test]
fn compensated_loops_agree_with_a_sweep() {
    let g = plant("exp(-s)/((1+s)*(1+0.5*s)^2)");
    let pid = PidConfig { kp: 1.0, ki: 0.4, kd: 0.5, tf: 0.1, ..PidConfig::default() };
    // A model that is not the plant.
    let estimator = EstimatorConfig { gain: 1.1, a1: 1.9, a2: 0.95, dead_time: 1.05, kfd: 0.6, tfd: 0.4 };
    let design = ContinuousLoop::new(&g, &pid).with_estimator(&estimator).expect("valid");
    let m = design.margins().expect("stable");
    // L from the block diagram, term by term.
    let l = |omega: f64| {
        let s = Complex::new(0.0, omega);
        let one = Complex::ONE;
        let lag = |t: f64| one + s * t;
        let g = (s * -1.0).exp() / (lag(1.0) * lag(0.5) * lag(0.5));
        let c = Complex::real(1.0) / lag(0.1) + Complex::real(0.4) / (s * lag(0.1)) + s * 0.5 / lag(0.1);
        let f = Complex::real(0.6) / (lag(0.4) * lag(0.4) * lag(0.4));
        let inverse = (one + s * 1.9 + s * s * 0.95) * (1.0 / 1.1);
        g * (c + f * inverse) / (one - f * (s * -1.05).exp())
    };
    near("ms", m.ms, swept_ms(l, 1e-3, 1e3), 1e-8);
    near("l", design.loop_gain(2.0).abs(), l(2.0).abs(), 1e-14);
    let at_gm = l(m.omega_gm.expect("one"));
    near("gm", -1.0 / at_gm.re, m.gm, 1e-12);
    assert!(at_gm.im.abs() < 1e-11);
    let at_pm = l(m.omega_pm.expect("one"));
    near("|L|", at_pm.abs(), 1.0, 1e-12);
    // S + T = 1; the noise and load responses are C_eff*S and G*S.
    let sum = design.sensitivity(0.8) + design.complementary(0.8);
    assert!((sum - Complex::ONE).abs() < 1e-14);
    let noise = design.feedback(0.8) * design.sensitivity(0.8);
    assert!((noise - design.noise_response(0.8)).abs() < 1e-13);
    assert!((design.plant(0.8) * noise - design.complementary(0.8)).abs() < 1e-13);
    near("high", design.feedback(1e9).abs(), design.noise_gain(), 1e-7);
    near("noise gain", design.noise_gain(), 0.5 / 0.1, 1e-12);
    // The extra dead time that the delay margin promises.
    let delayed = |share: f64| design.clone().with_extra_delay(share * m.delay_margin).margins();
    assert!(delayed(0.999).is_ok() && delayed(1.001).is_err(), "{m:?}");
    // A latency that the compensator knows of is a dead time in both.
    let late = design.clone().with_latency(0.3).margins().expect("stable");
    let same = ContinuousLoop::new(&plant("exp(-1.3*s)/((1+s)*(1+0.5*s)^2)"), &pid);
    let same = same.with_estimator(&EstimatorConfig { dead_time: 1.35, ..estimator }).expect("valid");
    near("latency", late.ms, same.margins().expect("stable").ms, 1e-12);
}

#[test]
fn an_observer_with_a_fast_filter_and_a_wrong_dead_time_is_found_out() {
    let g = plant("exp(-s)/(1+s)");
    let observer = |dead_time: f64, alpha: f64| ObserverConfig {
        model: plant("1/(1+s)").to_plant_model().expect("a model").with_dead_time(dead_time),
        alpha,
        order: None,
    };
    let design = |dead_time, alpha| {
        ContinuousLoop::new(&g, &pi(0.3, 0.3)).with_observer(&observer(dead_time, alpha)).expect("valid")
    };
    let exact = design(1.0, 1e-3).margins().expect("stable");
    // 1 + L = (1+GC)/(1-C_u): C_u = exp(-jw)/(1+jw*alpha).
    let l = |omega: f64| design(1.0, 1e-3).loop_gain(omega);
    near("ms", exact.ms, swept_ms(l, 0.1, 30.0), 1e-7);
    assert!(design(1.05, 1e-3).margins().is_err());
    assert!(design(1.05, 1.0).margins().is_ok());
    near("an", design(1.0, 1e-3).noise_gain(), 0.3 + 1e3, 1e-12);
    // A high filter order needs no factor K: the y path falls off.
    let higher = ObserverConfig { order: Some(2), ..observer(1.0, 0.5) };
    let higher = ContinuousLoop::new(&g, &pi(0.3, 0.3)).with_observer(&higher).expect("valid");
    near("an", higher.noise_gain(), 0.3, 1e-15);
    let zero = ObserverConfig { order: Some(0), ..observer(1.0, 0.5) };
    assert!(ContinuousLoop::new(&g, &pi(0.3, 0.3)).with_observer(&zero).is_err());
}

#[test]
fn wrong_signs_and_hopeless_loops_are_refused() {
    assert!(margins("-exp(-s)/(1+s)", &pi(0.5, 0.5)).is_err());
    assert!(margins("-exp(-s)/(1+s)", &pi(-0.5, -0.5)).is_ok());
    assert!(margins("s/(1+s)^2", &pi(0.5, 0.5)).is_err());
    assert!(margins("s/(1+s)^2", &pi(0.5, 0.0)).is_ok());
    assert!(margins("1/s", &pi(0.0, 0.5)).is_err());
    assert!(margins("1/s^2", &pi(0.5, 0.5)).is_err());
    assert!(margins("1/s", &pi(0.0, 0.0)).is_err());
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(margins("1/(1+s)", &pi(bad, 0.5)).is_err());
        assert!(margins("1/(1+s)", &pi(0.5, bad)).is_err());
    }
    assert!(margins("1e300/(1+s)^3", &pi(1e200, 1.0)).is_err());
    // An integral action lost in rounding is none that holds the output.
    assert!(margins("1e-300/(1+s)^3", &pi(1.0, 1e-280)).is_err());
    near("gm", margins("1e-300/(1+s)^3", &pi(4e300, 0.0)).expect("stable").gm, 2.0, 1e-12);
}

#[test]
fn scales_change_nothing_but_the_scale() {
    let base = margins("exp(-0.3*s)*(1-0.2*s)/((1+s)*(1+0.4*s+s^2))", &pi(0.25, 0.2)).expect("stable");
    for (time, gain) in [(1e-6, 1e6), (1e6, -1e-9), (1e-3, 1e12)] {
        let text = format!(
            "{gain}*exp(-{}*s)*(1-{}*s)/((1+{time}*s)*(1+{}*s+{}*s^2))",
            0.3 * time,
            0.2 * time,
            0.4 * time,
            time * time
        );
        let m = margins(&text, &pi(0.25 / gain, 0.2 / (gain * time))).expect("stable");
        near("ms", m.ms, base.ms, 1e-11);
        near("mt", m.mt, base.mt, 1e-11);
        near("gm", m.gm, base.gm, 1e-10);
        near("pm", m.pm_deg, base.pm_deg, 1e-10);
        near("delay", m.delay_margin, base.delay_margin * time, 1e-10);
        near("omega", m.omega_ms, base.omega_ms / time, 1e-6);
    }
}
