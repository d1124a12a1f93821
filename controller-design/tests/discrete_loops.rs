//! Sampled loops in closed form: what the margins must be, to many digits, on scales of any size.

use controller_core::{IntegralRule, ObserverConfig, PidConfig, PlantModel};
use controller_design::Refusal;
use controller_design::margins::{DiscreteLaw, DiscreteLoop, Margins};
use controller_design::model::parse;

fn held(plant: &str, pid: PidConfig, ts: f64, latency: f64) -> DiscreteLoop {
    let law = DiscreteLaw::new(&pid, ts).expect("a valid law");
    DiscreteLoop::new(&parse(plant).expect("a plant"), law, latency).expect("in range")
}

fn margins(plant: &str, pid: PidConfig, ts: f64, latency: f64) -> Margins {
    held(plant, pid, ts, latency).margins().unwrap_or_else(|fault| panic!("{plant}: {fault}"))
}

fn near(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} against {expected}");
}

/// `L = k/(z-1)`, `k = kp*K*ts`: `|L| = 1` at `2*sin(theta/2) = k`, phase margin `90 deg - theta/2`, gain margin `2/k`,
/// `|S|` largest at the Nyquist frequency: `2/(2-k)`. White noise: `u[k+1] = (1-k)*u[k] - ...`, hence
/// `std(u)/std(n) = kp*sqrt(2/(2-k))`.
#[test]
fn an_integrator_on_any_scale() {
    for (gain, ts) in [(1.0, 1.0), (1e-6, 1e6), (-4e8, 1e-7), (0.05, 0.5)] {
        for k in [1e-3, 0.3, 1.0, 1.7] {
            let kp = k / (gain * ts);
            let pid = PidConfig { kp, ..PidConfig::default() };
            let plant = format!("{gain}/s");
            let m = margins(&plant, pid, ts, 0.0);
            let theta = 2.0 * libm::asin(0.5 * k);
            near(m.gm, 2.0 / k, 1e-9);
            near(m.ms, 2.0 / (2.0 - k), 1e-9);
            near(m.pm_deg, 90.0 - 0.5 * theta.to_degrees(), 1e-9);
            near(m.omega_pm.expect("a crossover") * ts, theta, 1e-9);
            near(held(&plant, pid, ts, 0.0).noise().white, kp.abs() * libm::sqrt(2.0 / (2.0 - k)), 1e-7);
        }
    }
}

/// With a fraction `f` of a sample of dead time the poles solve `z^2 - (1 - k*(1-f))*z + k*f = 0`: at `f = 1/k` their product
/// is 1. A delay that only turned `L` would be off by several per cent.
#[test]
fn the_delay_margin_holds_fractions() {
    for k in [1.25, 1.1, 1.6] {
        let pid = PidConfig { kp: k, ..PidConfig::default() };
        let m = margins("1/s", pid, 1.0, 0.0);
        near(m.delay_margin, 1.0 / k, 1e-6);
        // The same in a loop a million times faster.
        let fast = margins("1e6/s", pid, 1e-6, 0.0);
        near(fast.delay_margin, 1e-6 / k, 1e-6);
        assert_eq!(held("1/s", pid, 1.0, 0.98 / k).unstable_poles(), 0);
        assert_eq!(held("1/s", pid, 1.0, 1.02 / k).unstable_poles(), 2);
    }
}

/// `ki` alone on a static gain seen one sample late: `L = ki*K*ts/(z-1)`, or with the trapezoid half of `(z+1)/(z*(z-1))`.
#[test]
fn integral_action_on_a_static_gain() {
    let backward = PidConfig { ki: 0.5, ..PidConfig::default() };
    near(margins("2", backward, 1.0, 0.0).gm, 2.0, 1e-9);
    let trapezoid = PidConfig { integral_rule: IntegralRule::Trapezoid, ..backward };
    // 0.5*k*(z+1)/(z*(z-1)): z^2 - (1-k/2)*z + k/2, product of the poles 1 at k = 2; k = ki*K*ts = 1.
    near(margins("2", trapezoid, 1.0, 0.0).gm, 2.0, 1e-9);
}

/// With a perfect model `1 + L = (1 + G_d*C)/(1 - C_u)`: the closed loop's poles are those without the observer.
#[test]
fn an_observer_with_a_perfect_model_leaves_the_poles() {
    let model = PlantModel::first_order(2.0, 1.0, 0.37);
    let observer = ObserverConfig { model, alpha: 0.3, order: None }.to_compensator(0.01);
    let plant = parse("2*exp(-0.37*s)/(1+s)").expect("a plant");
    for (kp, stable) in [(0.5, true), (0.9, true), (8.0, false)] {
        let pid = PidConfig { kp, ki: kp, ..PidConfig::default() };
        let law = DiscreteLaw::with_compensator(&pid, &observer, 0.05).expect("valid");
        let with = DiscreteLoop::new(&plant, law, 0.01).expect("in range");
        let without = held("2*exp(-0.37*s)/(1+s)", pid, 0.05, 0.01);
        assert_eq!(with.unstable_poles(), without.unstable_poles());
        assert_eq!(with.unstable_poles() == 0, stable);
        for theta in [1e-6, 1e-3, 0.1, 1.0, 3.0] {
            let (a, b) = (with.at(theta), without.at(theta));
            let expected = b.sensitivity() * a.own;
            assert!((a.sensitivity() - expected).abs() <= 1e-9 * expected.abs(), "{theta}");
        }
    }
}

#[test]
fn unstable_loops_have_no_margins() {
    for (plant, kp, poles) in
        [("1/s", 2.5, 1), ("1/s", -0.1, 1), ("1/(1-s)", 0.0, 1), ("1/s^2", 0.5, 2), ("exp(-5*s)/s", 1.0, 2)]
    {
        let looped = held(plant, PidConfig { kp, ..PidConfig::default() }, 1.0, 0.0);
        assert!(looped.unstable_poles() >= poles, "{plant}");
        assert!(matches!(looped.margins(), Err(Refusal::NoSolution { .. })), "{plant}");
    }
    // A hidden mode: the integral term behind a zero at s = 0.
    let pid = PidConfig { ki: 0.1, ..PidConfig::default() };
    assert!(held("s/(1+s)^2", pid, 0.1, 0.0).unstable_poles() > 0);
}
