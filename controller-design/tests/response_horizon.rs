//! Indices up to a horizon: closed forms, the integrals of the traced response, and the indices to the end.

use controller_core::PidConfig;
use controller_design::model::parse;
use controller_design::response::{ContinuousResponse, Indices, Load, Observer};

fn response(plant: &str, pid: PidConfig, alpha: Option<f64>) -> ContinuousResponse {
    let plant = parse(plant).expect("a plant");
    let observer = alpha.map(|alpha| Observer::new(&plant, alpha));
    ContinuousResponse::new(&plant, &pid, observer).expect("a loop")
}

fn close(what: &str, ours: f64, expected: f64, tolerance: f64) {
    assert!((ours - expected).abs() <= tolerance, "{what}: {ours}, expected {expected}");
}

/// `e = exp(-t/lambda)` of a lag that is cancelled, cut anywhere.
#[test]
fn an_exponential_cut_off() {
    let pid = PidConfig { kp: 0.75, ki: 0.25, ..PidConfig::default() };
    let loop_ = response("2/(1+3*s)", pid, None);
    for t in [1e-3, 0.1, 1.0, 2.0, 7.5, 60.0] {
        let i = loop_.setpoint_indices_until(t).expect("indices");
        let rest = (-t / 2.0_f64).exp();
        let area = 2.0 * (1.0 - rest);
        close("ie", i.ie, area, 1e-6 * area);
        close("iae", i.iae, area, 1e-6 * area);
        close("ise", i.ise, 1.0 - rest * rest, 1e-6 * (1.0 - rest * rest));
        let itae = 4.0 - (2.0 * t + 4.0) * rest;
        close("itae", i.itae, itae, 1e-5 * itae.max(1e-3));
        close("e_max", i.e_max, 1.0, 1e-9);
        // u jumps by kp and falls to 1/K with the same lag.
        close("tv", i.tv, 0.75 + 0.25 * (1.0 - rest), 1e-6);
    }
}

/// An undamped loop never settles, and has indices nevertheless: `y'' + y = d'`, `y = sin t`, over whole half-waves.
#[test]
fn a_loop_that_swings_for_ever() {
    let pid = PidConfig { kp: 0.0, ki: 1.0, ..PidConfig::default() };
    let loop_ = response("1/s", pid, None);
    assert!(loop_.indices(Load::Step).is_err());
    let pi = core::f64::consts::PI;
    for halves in 1..9 {
        let i = loop_.indices_until(Load::Step, pi * f64::from(halves)).expect("indices");
        close("iae", i.iae, 2.0 * f64::from(halves), 1e-4);
        close("ise", i.ise, 0.5 * pi * f64::from(halves), 1e-4);
        close("e_max", i.e_max, 1.0, 1e-5);
        close("ie", i.ie, if halves % 2 == 1 { -2.0 } else { 0.0 }, 1e-4);
        // u = cos t - 1 from a load of 1: v = cos t.
        close("tv", i.tv, 2.0 * f64::from(halves), 1e-4);
    }
}

/// The trapezoid over the traced response, whose error of the finest grid is below 1e-5 of each index.
#[test]
fn the_integrals_of_the_trace() {
    let cases = [
        ("exp(-20*s)/(1+80*s)", 0.696075276, 0.011533633, None, 137.0),
        ("exp(-20*s)/(1+80*s)", 0.696075276, 0.011533633, Some(100.0), 333.0),
        ("exp(-90*s)/(1+10*s)", 0.100985197, 0.00274121568, Some(1.0), 90.0),
        ("-2*(1-0.3*s)*exp(-0.1*s)/((1+s)*(1+0.4*s+0.5*s^2))", -0.3, -0.2, None, 4.4),
        ("1/(1+s)^4", 0.8, 0.3, Some(0.3), 1.0),
    ];
    for (plant, kp, ki, alpha, t) in cases {
        let loop_ = response(plant, PidConfig { kp, ki, ..PidConfig::default() }, alpha);
        let i = loop_.indices_until(Load::Step, t).expect("indices");
        let samples = loop_.trace(Load::Step, t, 200_001).expect("samples");
        let h = t / 200_000.0;
        let mean = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            samples.windows(2).map(|w| 0.5 * h * (f(w[0].t, w[0].y) + f(w[1].t, w[1].y))).sum()
        };
        let tv: f64 = samples.windows(2).map(|w| (w[1].u - w[0].u).abs()).sum();
        let e_max = samples.iter().fold(0.0_f64, |m, s| m.max(s.y.abs()));
        let iae = mean(&|_, y| y.abs());
        close("ie", i.ie, -mean(&|_, y| y), 2e-5 * iae);
        for (what, ours, expected) in [
            ("iae", i.iae, iae),
            ("ise", i.ise, mean(&|_, y| y * y)),
            ("itae", i.itae, mean(&|t, y| t * y.abs())),
            ("e_max", i.e_max, e_max),
            ("tv", i.tv, tv),
        ] {
            close(&format!("{plant} {what}"), ours, expected, 2e-5 * expected.abs().max(1e-6));
        }
    }
}

/// A horizon far behind the end changes nothing; nor does the sign of the gain.
#[test]
fn a_long_horizon_is_all_of_it() {
    let numbers = |i: Indices| [i.ie, i.iae, i.ise, i.itae, i.e_max, i.t_max, i.tv];
    for (plant, kp, ki) in [("exp(-s)/(1+2*s)", 0.6, 0.25), ("-1/(1+s)^3", -0.9, -0.4)] {
        let loop_ = response(plant, PidConfig { kp, ki, ..PidConfig::default() }, None);
        let both = [
            (loop_.indices(Load::Step), loop_.indices_until(Load::Step, 1e6)),
            (loop_.setpoint_indices(), loop_.setpoint_indices_until(1e6)),
        ];
        for (whole, until) in both {
            let (whole, until) = (numbers(whole.expect("indices")), numbers(until.expect("indices")));
            for (whole, until) in whole.iter().zip(until) {
                close(plant, until, *whole, 1e-5 * whole.abs());
            }
        }
    }
    let loop_ = response("exp(-s)/(1+2*s)", PidConfig { kp: 0.6, ki: 0.25, ..PidConfig::default() }, None);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(loop_.indices_until(Load::Step, wrong).is_err());
    }
}
