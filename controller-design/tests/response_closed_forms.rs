//! What can be said without any simulation: identities, closed forms, integrals over frequency, scaling, refusals.

use core::f64::consts::PI;

use controller_core::PidConfig;
use controller_core::pid::Action;
use controller_design::Refusal;
use controller_design::model::{Complex, TransferFunction, parse};
use controller_design::response::{ContinuousResponse, Indices, Load, Observer};

fn plant(text: &str) -> TransferFunction {
    parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

fn pi(kp: f64, ki: f64) -> PidConfig {
    PidConfig { kp, ki, ..PidConfig::default() }
}

fn try_indices(text: &str, pid: &PidConfig, alpha: Option<f64>, load: Load) -> Result<Indices, Refusal> {
    let g = plant(text);
    let observer = alpha.map(|alpha| Observer::new(&g, alpha));
    ContinuousResponse::new(&g, pid, observer)?.indices(load)
}

fn indices(text: &str, pid: &PidConfig, alpha: Option<f64>, load: Load) -> Indices {
    try_indices(text, pid, alpha, load).unwrap_or_else(|e| panic!("{text}: {e}"))
}

#[track_caller]
fn near(ours: f64, exact: f64, tolerance: f64) {
    assert!((ours - exact).abs() <= tolerance * exact.abs(), "{ours} is not {exact}");
}

#[test]
fn second_order_loops_have_closed_forms() {
    // G = 1/(1+tau*s), e = -w^2*s/(s^2 + 2*zeta*w*s + w^2)/s/ki, w^2 = ki/tau: e = -exp(-a*t)*sin(b*t)/(tau*b).
    for (tau, kp, ki) in [(1.0, 0.6, 2.0), (1e6, 1.2, 4e-6), (1e-6, 0.2, 5e6), (2.0, 5.0, 40.0)] {
        let i = indices(&format!("1/(1+{tau:e}*s)"), &pi(kp, ki), None, Load::Step);
        let (a, w2) = (0.5 * (1.0 + kp) / tau, ki / tau);
        let b = (w2 - a * a).sqrt();
        let q = (-a * PI / b).exp();
        let iae = (1.0 + q) / (1.0 - q) / ki;
        near(i.ie, -1.0 / ki, 1e-12);
        near(i.iae, iae, 1e-7);
        // Integral of (exp(-a*t)*sin(b*t))^2 = b^2/(4*a*(a^2+b^2)).
        near(i.ise, 1.0 / (tau * tau * 4.0 * a * w2), 1e-7);
        let t = (b / a).atan() / b;
        near(i.t_max, t, 1e-6);
        near(i.e_max, (-a * t).exp() * (b * t).sin() / (tau * b), 1e-8);
        // Each half wave from t_k to t_k+1: integral of t*exp(-a*t)*sin(b*t), summed.
        let half = |k: f64| {
            let f = |t: f64| {
                let (s, c) = (b * t).sin_cos();
                -(-a * t).exp()
                    * (t * (a * s + b * c) / w2 + ((a * a - b * b) * s + 2.0 * a * b * c) / (w2 * w2))
            };
            (f((k + 1.0) * PI / b) - f(k * PI / b)).abs()
        };
        let itae = (0..400).map(|k| half(f64::from(k))).sum::<f64>() / (tau * b);
        near(i.itae, itae, 1e-6);
    }
}

/// `integral of |E(jw)|^2 dw / (2 pi)`, E the error for a unit step: Parseval. Trapezoidal in log w after the
/// substitution, fine enough for 1e-6.
fn parseval(text: &str, pid: &PidConfig, alpha: Option<f64>, span: (f64, f64)) -> f64 {
    let g = plant(text);
    let order = Observer::new(&g, 1.0).order;
    let right: Vec<Complex> = g.zeros().into_iter().filter(|z| z.re >= 0.0).collect();
    let [kp, ki, kd] = pid.signed_gains();
    let squared = |w: f64| {
        let s = Complex::new(0.0, w);
        let c =
            Complex::real(ki) / s + (Complex::real(kp - ki * pid.tf) + s * kd) / (Complex::ONE + s * pid.tf);
        let mut load = Complex::ONE / s;
        if let Some(alpha) = alpha {
            let mut cu = (s * -g.dead_time()).exp();
            right.iter().for_each(|z| cu = cu * (Complex::ONE - s / *z));
            (0..order).for_each(|_| cu = cu / (Complex::ONE + s * alpha));
            load = load * (Complex::ONE - cu);
        }
        let e = load * g.at(s) / (Complex::ONE + c * g.at(s));
        e.abs() * e.abs()
    };
    let points = 200_000;
    let (lo, hi) = (span.0.ln(), span.1.ln());
    let step = (hi - lo) / f64::from(points);
    (0..=points).map(|i| (lo + step * f64::from(i)).exp()).map(|w| squared(w) * w).sum::<f64>() * step / PI
}

#[test]
fn ise_is_the_energy_of_the_spectrum() {
    let pid = PidConfig { kp: 1.5, ki: 0.8, kd: 1.0, tf: 0.1, ..PidConfig::default() };
    let cases = [
        ("exp(-0.3*s)/((1+s)*(1+0.5*s))", pi(1.0, 0.9), None),
        ("exp(-0.3*s)/((1+s)*(1+0.5*s))", pi(1.0, 0.9), Some(0.2)),
        ("3*(1-0.4*s)*exp(-2*s)/((1+s)^2*(1+5*s))", pi(0.3, 0.05), Some(0.7)),
        ("1/(1+s)^8", pi(0.4, 0.09), None),
        ("1/(1+s)^8", pi(0.4, 0.09), Some(1.3)),
        ("exp(-0.001*s)/((1+s)*(1+0.2*s)*(1+0.04*s))", pi(2.0, 1.5), Some(0.3)),
        ("exp(-0.4*s)/(1+0.3*s+s^2)", pi(0.05, 0.1), Some(1.0)),
        ("exp(-0.5*s)/(1+s)^2", pid, Some(0.3)),
        ("(1+8*s)*exp(-0.2*s)/((1+s)^2*(1+0.3*s))", pi(0.2, 0.1), None),
        ("0.2*exp(-0.5*s)/(s*(1+0.6*s+s^2))", pi(0.8, 0.05), Some(0.5)),
        ("(1-0.5*s+s^2)*exp(-0.3*s)/(1+s)^4", pi(0.1, 0.08), Some(0.9)),
        ("exp(-s)/(1+0.001*s)", pi(0.3, 0.5), None),
        ("exp(-s)/((1+0.001*s)*(1+0.3*s))", pi(0.2, 0.6), Some(0.002)),
    ];
    for (text, pid, alpha) in cases {
        let i = indices(text, &pid, alpha, Load::Step);
        near(i.ise, parseval(text, &pid, alpha, (1e-8, 3e4)), 3e-6);
    }
}

#[test]
fn closed_forms_of_ie_hold_for_steps_and_ramps() {
    // Under a ramp: (d*alpha + T + sum delta)/ki, Tena et al. 2022 eq. (33).
    for (text, kp, ki, alpha, delay, delta, order) in [
        ("exp(-20*s)/(1+80*s)", 0.7, 0.0115, 50.0, 20.0, 0.0, 1.0),
        ("2*(1-3*s)*exp(-5*s)/((1+10*s)*(1+4*s))", 0.3, 0.03, 4.0, 5.0, 3.0, 2.0),
        ("(1+2*s)*(1-0.4*s)/(1+s)^4", 0.4, 0.2, 0.5, 0.0, 0.4, 3.0),
        ("-0.5*exp(-0.3*s)/(s*(1+0.4*s))", -0.8, -0.15, 0.3, 0.3, 0.0, 2.0),
    ] {
        let pid = pi(kp, ki);
        near(indices(text, &pid, None, Load::Step).ie, -1.0 / ki, 1e-9);
        let step = indices(text, &pid, Some(alpha), Load::Step);
        assert!(step.ie.abs() < 1e-9 * step.iae, "{text}: {step:?}");
        let ramp = indices(text, &pid, Some(alpha), Load::Ramp);
        near(ramp.ie, -(order * alpha + delay + delta) / ki, 1e-9);
        assert!(ramp.iae >= ramp.ie.abs() * (1.0 - 1e-9) && ramp.tv == f64::INFINITY);
        // The state from which IE is read, against the area under the response itself.
        let g = plant(text);
        let response = ContinuousResponse::with_alpha(&g, &pid, alpha).expect("a loop");
        let end = 400.0 * (order * alpha + delay + delta + 1.0);
        let samples = response.trace(Load::Ramp, end, 2_000_001).expect("a trace");
        let area: f64 = samples.windows(2).map(|w| 0.5 * (w[0].y + w[1].y) * (w[1].t - w[0].t)).sum();
        near(-area, ramp.ie, 1e-5);
    }
}

#[test]
fn indices_scale_with_time_and_gain() {
    let base = indices("3*(1-0.2*s)*exp(-0.7*s)/((1+s)*(1+0.1*s))", &pi(0.2, 0.15), Some(0.4), Load::Step);
    for (time, gain) in [(1e-6, 1.0), (1e6, 1e9), (1e-3, -1e-12), (1.0, -4e7)] {
        let text = format!(
            "{:e}*(1-{:e}*s)*exp(-{:e}*s)/((1+{time:e}*s)*(1+{:e}*s))",
            3.0 * gain,
            0.2 * time,
            0.7 * time,
            0.1 * time
        );
        let i = indices(&text, &pi(0.2 / gain, 0.15 / gain / time), Some(0.4 * time), Load::Step);
        let g = gain.abs();
        near(i.iae, base.iae * g * time, 1e-9);
        near(i.ise, base.ise * g * g * time, 1e-9);
        near(i.itae, base.itae * g * time * time, 1e-9);
        near(i.e_max, base.e_max * g, 1e-9);
        near(i.t_max, base.t_max * time, 1e-9);
        near(i.tv, base.tv, 1e-9);
    }
}

#[test]
fn a_tiny_dead_time_changes_little() {
    let without = indices("1/((1+s)*(1+0.3*s)*(1+0.1*s))", &pi(2.0, 1.5), None, Load::Step);
    for delay in [1e-12, 1e-9, 1e-6] {
        let text = format!("exp(-{delay:e}*s)/((1+s)*(1+0.3*s)*(1+0.1*s))");
        let with = indices(&text, &pi(2.0, 1.5), None, Load::Step);
        near(with.iae, without.iae, 2e-6 + 10.0 * delay);
        near(with.itae, without.itae, 2e-6 + 10.0 * delay);
        near(with.tv, without.tv, 2e-6 + 10.0 * delay);
    }
}

#[test]
fn direct_action_is_the_other_sign() {
    let reverse = indices("-2*exp(-s)/(1+3*s)", &pi(-0.5, -0.2), None, Load::Step);
    let direct = PidConfig { action: Action::Direct, ..pi(0.5, 0.2) };
    assert_eq!(indices("-2*exp(-s)/(1+3*s)", &direct, None, Load::Step), reverse);
}

#[test]
fn accuracy_is_kept() {
    let text = "exp(-0.3*s)/((1+s)*(1+0.5*s)*(1+0.05*s))";
    let g = plant(text);
    let exact =
        ContinuousResponse::with_accuracy(&g, &pi(1.0, 0.9), None, 1e-9).and_then(|r| r.indices(Load::Step));
    let exact = exact.expect("a loop");
    for accuracy in [1e-2, 1e-4, 1e-6] {
        let i = ContinuousResponse::with_accuracy(&g, &pi(1.0, 0.9), None, accuracy)
            .and_then(|r| r.indices(Load::Step))
            .expect("a loop");
        for (a, b) in [(i.iae, exact.iae), (i.ise, exact.ise), (i.itae, exact.itae), (i.tv, exact.tv)] {
            near(a, b, accuracy);
        }
    }
}

#[test]
fn what_has_no_indices_is_refused() {
    let text = |r: Result<Indices, Refusal>| r.expect_err("refused").to_string();
    let refused = |t: &str, kp, ki| text(try_indices(t, &pi(kp, ki), None, Load::Step));
    assert!(refused("exp(-s)/(1+s)", 5.0, 1.0).contains("unstable"));
    assert!(refused("1/(1+s)^3", 9.0, 1.0).contains("unstable"));
    assert!(refused("1/s^2", 1.0, 1.0).contains("unstable"));
    assert!(refused("exp(-s)/(1+s)", 0.5, -1.0).contains("sign"));
    assert!(refused("exp(-s)/(1+s)", 0.5, 0.0).contains("must not be 0"));
    assert!(refused("2*exp(-s)", 0.1, 0.1).contains("more poles"));
    assert!(refused("s*exp(-s)/(1+s)^2", 0.1, 0.1).contains("s = 0"));
    assert!(refused("exp(-s)/(1+s)", f64::NAN, 0.1).contains("kp"));
    assert!(text(try_indices("exp(-s)/(1+s)", &pi(0.5, 0.5), None, Load::Ramp)).contains("ramp"));
    assert!(text(try_indices("exp(-s)/(1+s)", &pi(0.5, 0.5), Some(0.0), Load::Step)).contains("alpha"));
    let derivative = PidConfig { kd: 1.0, ..pi(0.5, 0.5) };
    assert!(text(try_indices("exp(-s)/(1+s)", &derivative, None, Load::Step)).contains("tf"));
    // On the limit of stability: 1/(1+s)^3 with kp + 1 = 8 - ki*.. swings for ever.
    assert!(try_indices("1/(s*(1+s))", &pi(1.0, 1.0), None, Load::Step).is_err());
}

#[test]
fn extreme_numbers_never_give_nonsense() {
    let plants = [
        "1e300*exp(-s)/(1+s)",
        "1e-300*exp(-s)/(1+s)",
        "exp(-1e-300*s)/(1+s)",
        "exp(-1e300*s)/(1+s)",
        "exp(-s)/(1+1e-200*s)",
        "exp(-s)/(1+1e200*s)",
        "exp(-s)/((1+1e-9*s)*(1+1e9*s))",
        "1/((1+1e-9*s)*(1+1e9*s))",
        "exp(-s)/(1+1e-8*s+1e-12*s^2)",
        "exp(-1e3*s)/(1+1e-4*s+s^2)",
        "1/s^8",
    ];
    for text in plants {
        for (kp, ki) in [(0.1, 0.1), (1e-300, 1e-300), (1e300, 1e300), (1e-9, 1e9)] {
            for alpha in [None, Some(1.0), Some(1e-250), Some(1e250)] {
                if let Ok(i) = try_indices(text, &pi(kp, ki), alpha, Load::Step) {
                    let numbers = [i.ie, i.iae, i.ise, i.itae, i.e_max, i.t_max, i.tv];
                    assert!(numbers.iter().all(|x| x.is_finite()), "{text} {kp} {ki} {alpha:?} {i:?}");
                }
            }
        }
    }
}
