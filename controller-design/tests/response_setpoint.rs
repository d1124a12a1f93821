//! Responses to a step of the set-point: closed forms, weights of the set-point, and the golden values of
//! `tests/bench/batch_python.py`.

use controller_core::PidConfig;
use controller_design::batch134::processes;
use controller_design::model::parse;
use controller_design::response::{ContinuousResponse, Indices, Load};

fn indices(plant: &str, pid: &PidConfig) -> Indices {
    let plant = parse(plant).expect("a plant");
    ContinuousResponse::new(&plant, pid, None)
        .and_then(|r| r.setpoint_indices())
        .unwrap_or_else(|e| panic!("{e}"))
}

fn close(ours: f64, expected: f64, tolerance: f64) {
    assert!((ours - expected).abs() <= tolerance * expected.abs(), "{ours}, expected {expected}");
}

/// A PI that cancels the lag leaves `e = exp(-t/lambda)`, `lambda = tau/(K*kp)`.
#[test]
fn a_lag_that_is_cancelled() {
    for (gain, tau, kp) in [(2.0, 3.0, 0.75), (-0.5, 0.01, -40.0), (1e4, 2e5, 1e-5)] {
        let pid = PidConfig { kp, ki: kp / tau, ..PidConfig::default() };
        let i = indices(&format!("{gain}/(1+{tau}*s)"), &pid);
        let lambda = tau / (gain * kp);
        close(i.ie, lambda, 1e-6);
        close(i.iae, lambda, 1e-6);
        close(i.ise, 0.5 * lambda, 1e-6);
        close(i.itae, lambda * lambda, 1e-5);
        close(i.e_max, 1.0, 1e-9);
        // A jump by kp, then monotonically to 1/K.
        close(i.tv, kp.abs() + (1.0 / gain - kp).abs(), 1e-6);
    }
}

/// An integrating plant under P and I with `b = 0`: `y'' + kp*y' + ki*y = ki*r`, critically damped.
#[test]
fn an_integrator_with_the_set_point_in_the_integral_only() {
    let pid = PidConfig { kp: 2.0, ki: 1.0, b: 0.0, ..PidConfig::default() };
    let i = indices("1/s", &pid);
    // e = (1+t)*exp(-t).
    close(i.iae, 2.0, 1e-6);
    close(i.ise, 1.25, 1e-6);
    close(i.itae, 3.0, 1e-5);
    // u = y' = t*exp(-t): up to 1/e and back.
    close(i.tv, 2.0 / core::f64::consts::E, 1e-6);
}

/// `IE = (1/K + (1-b)*kp)/ki`, whatever the derivative and its weight do; dead times, zeros, unstable and oscillating plants.
#[test]
fn the_integral_of_the_error_is_that_of_the_steady_states() {
    for (plant, inverse, kp, ki, kd, tf) in [
        ("2*exp(-0.3*s)/((1+s)*(1+0.2*s))", 0.5, 1.2, 0.9, 0.2, 0.02),
        ("(1-0.4*s)*exp(-0.1*s)/((1+s)*(1+0.6*s+0.5*s^2))", 1.0, 0.5, 0.4, 0.1, 0.05),
        ("exp(-0.05*s)/(s*(1+0.5*s))", 0.0, 0.8, 0.15, 0.3, 0.02),
        ("-3/(1+2*s)^3", -1.0 / 3.0, -0.4, -0.1, -0.3, 0.1),
        ("exp(-0.1*s)/(s-1)", -1.0, 3.0, 1.0, 0.0, 0.0),
        ("(1+0.5*s)/((1+3*s)*(1+0.3*s)*(1+0.1*s+0.2*s^2))", 1.0, 0.4, 0.3, 0.0, 0.01),
    ] {
        for b in [0.0, 0.4, 1.0] {
            for c in [0.0, 1.0] {
                let pid = PidConfig { kp, ki, kd, tf, b, c, ..PidConfig::default() };
                let i = indices(plant, &pid);
                let expected = (inverse + (1.0 - b) * kp) / ki;
                assert!((i.ie - expected).abs() < 1e-5 * i.iae, "{plant} {b} {c}: {i:?} for {expected}");
                assert!(i.iae >= i.ie.abs() * (1.0 - 1e-6) && i.ise <= i.e_max * i.iae * (1.0 + 1e-9));
            }
        }
    }
}

/// The filtered derivative of the set-point makes its kick, and only with `c`.
#[test]
fn weights_change_the_kick() {
    let of = |b: f64, c: f64| {
        let pid = PidConfig { kp: 1.2, ki: 0.9, kd: 0.2, tf: 0.02, b, c, ..PidConfig::default() };
        indices("2*exp(-0.3*s)/((1+s)*(1+0.2*s))", &pid)
    };
    // 0.2/0.02 up at once and nearly as far down.
    assert!(of(1.0, 1.0).tv > 18.0 && of(1.0, 0.0).tv < 8.0, "{:?} {:?}", of(1.0, 1.0), of(1.0, 0.0));
    assert!(of(0.0, 0.0).tv < of(1.0, 0.0).tv && of(0.0, 0.0).iae > of(1.0, 0.0).iae);
}

/// An observer of the plant itself does not show; nor does an estimator.
#[test]
fn exact_models_do_not_show() {
    let plant = parse("exp(-0.2*s)/((1+0.2*s)*(1+s))").expect("a plant");
    let pid = PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, b: 1.0, c: 0.0, ..PidConfig::default() };
    let of = |r: Result<ContinuousResponse, controller_design::Refusal>| {
        r.and_then(|r| Ok([r.setpoint_indices()?, r.indices(Load::Step)?])).unwrap_or_else(|e| panic!("{e}"))
    };
    let [alone, load] = of(ContinuousResponse::new(&plant, &pid, None));
    let [observed, _] = of(ContinuousResponse::with_alpha(&plant, &pid, 0.1));
    let [estimated, less] = of(ContinuousResponse::with_estimator(&plant, &pid, 0.69, 0.06));
    for other in [observed, estimated] {
        close(other.iae, alone.iae, 1e-6);
        close(other.itae, alone.itae, 1e-5);
        close(other.tv, alone.tv, 1e-5);
    }
    close(less.ie, 0.31 * load.ie, 1e-6);
    assert!(less.iae < 0.5 * load.iae);
    // With a gain of 1 in its filter the estimator is an observer of third order.
    let observer = controller_design::response::Observer { alpha: 0.06, order: 3 };
    let [_, whole] = of(ContinuousResponse::new(&plant, &pid, Some(observer)));
    let [_, same] = of(ContinuousResponse::with_estimator(&plant, &pid, 1.0, 0.06));
    assert_eq!(whole, same);
    assert!(
        ContinuousResponse::with_estimator(&parse("1/(1+s)^3").expect("a plant"), &pid, 0.5, 0.1).is_err()
    );
    assert!(ContinuousResponse::with_estimator(&plant, &pid, 1.5, 0.1).is_err());
}

#[test]
fn golden_responses_of_the_134_processes() {
    let list = processes();
    let mut rows = 0;
    for line in include_str!("golden/batch134.csv").lines().filter(|line| line.contains(",set-point,")) {
        let cells: Vec<&str> = line.split(',').collect();
        let x: Vec<f64> = cells[3..11].iter().map(|x| x.parse().expect("a number")).collect();
        let process = list.iter().find(|process| process.name == cells[0]).expect("one of the 134");
        let pid = PidConfig { kp: x[0], ki: x[1], ..PidConfig::default() };
        let i = indices(&process.expression, &pid);
        // The golden values come from piecewise linear signals, extrapolated: a few 1e-5 at the corners of |e|. Their TV is that
        // of the samples, which miss the tops of the turns by up to 1e-4.
        for (ours, golden) in [i.iae, i.ise, i.itae, i.e_max, i.tv].iter().zip(&x[3..]) {
            assert!((ours / golden - 1.0).abs() < 5e-4, "{line}: {i:?}");
        }
        rows += 1;
    }
    assert!(rows > 250, "{rows}");
}
