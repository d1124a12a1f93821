//! No change of mode, compensator, parameter, limit or dead time moves the output by more than the new gains must.
//!
//! A twin keeps the old law or mode on the same inputs. In the sample of the change
//! `|u_new - u_twin| <= |dki|*ts*|e| + |d(high-frequency gain)|*|dy| + eps`, eps 1e-9 (f64) or 1e-4 (f32) of the output
//! range; for modes and for switching the compensator nothing but eps.

use controller_core::{
    AntiWindupConfig, CompensatorConfig, ControllerConfig, EstimatorConfig, IntegralRule, LimitConfig, Mode,
    ObserverConfig, PidConfig, Real, SetpointConfig,
};
use controller_tests::cases::model;
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::rig::{Rig, law};

const TS: f64 = 0.02;
const RANGE: f64 = 40.0;

/// Plant, PID with the derivative active, compensator.
fn setups() -> Vec<(&'static str, PlantFactors<'static>, PidConfig, CompensatorConfig)> {
    let second = PlantFactors { lags: &[1.0, 0.2], dead_time: 0.23, ..PlantFactors::UNITY };
    let integrating =
        PlantFactors { gain: 0.5, integrators: 1, lags: &[0.3], dead_time: 0.1, ..PlantFactors::UNITY };
    let negative = PlantFactors { gain: -2.0, lags: &[2.0, 1.0, 0.5], dead_time: 0.5, ..PlantFactors::UNITY };
    let estimator = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.23, kfd: 0.69, tfd: 0.15 };
    let observer = |plant: &PlantFactors<'_>, alpha| {
        ObserverConfig { model: model(plant), alpha, order: None }.to_compensator(0.0)
    };
    let pid = |kp, ki, kd, tf| PidConfig { kp, ki, kd, tf, b: 0.7, c: 0.4, ..PidConfig::default() };
    vec![
        ("second order, DE", second, pid(2.0, 1.4, 0.4, 0.12), estimator.to_compensator(0.0)),
        ("integrating, DOB", integrating, pid(1.2, 0.2, 0.3, 0.1), observer(&integrating, 0.4)),
        ("third order, negative gain, DOB", negative, pid(-0.5, -0.15, -0.2, 0.2), observer(&negative, 0.5)),
    ]
}

fn config(pid: PidConfig) -> ControllerConfig {
    ControllerConfig {
        pid,
        limits: LimitConfig::range(-0.5 * RANGE, 0.5 * RANGE),
        setpoint: SetpointConfig { track: true, ..SetpointConfig::default() },
        ..ControllerConfig::default()
    }
}

fn eps<T: Real>() -> f64 {
    RANGE * if T::WORDS == 1 { 1e-4 } else { 1e-9 }
}

/// Moments at which things change: at rest far from zero; just after a set-point step (derivative active); while a
/// disturbance is being fought; in saturation.
fn moments<T: Real>(
    config: &ControllerConfig,
    compensator: &CompensatorConfig,
    plant: &PlantFactors<'_>,
) -> Vec<(&'static str, Rig<T>)> {
    let mut rig = Rig::<T>::new(law(config, compensator, TS).expect("valid"), plant.sampled(TS));
    let sign = if plant.gain < 0.0 { -1.0 } else { 1.0 };
    let mut list = Vec::new();
    rig.input.r = T::from_f64(3.0);
    rig.input.offset = T::from_f64(0.3);
    rig.d = 0.5 * sign;
    run(&mut rig, 4000);
    list.push(("at rest", rig.clone()));
    rig.input.r = T::from_f64(3.8);
    run(&mut rig, 4);
    list.push(("after a set-point step", rig.clone()));
    run(&mut rig, 10);
    list.push(("while moving", rig.clone()));
    rig.d = -sign;
    run(&mut rig, 40);
    list.push(("fighting a disturbance", rig.clone()));
    rig.input.r = T::from_f64(60.0);
    run(&mut rig, 20);
    list.push(("saturated", rig));
    list
}

fn run<T: Real>(rig: &mut Rig<T>, samples: usize) {
    for _ in 0..samples {
        let _ = rig.step();
    }
}

fn every_pair_of_modes<T: Real>() {
    let mut pairs = 0;
    for (name, plant, pid, compensator) in setups() {
        for (moment, base) in moments::<T>(&config(pid), &compensator, &plant) {
            for from in Mode::REQUESTS {
                let mut old = base.clone();
                // The set-point of the remote source differs: Cascade must not jump to it either.
                old.input.r_remote = old.input.r + T::from_f64(0.4);
                old.input.track = T::from_f64(1.7);
                old.input.manual = Some(T::from_f64(-1.2));
                old.input.mode = from;
                run(&mut old, if from == Mode::Auto { 0 } else { 7 });
                for to in Mode::REQUESTS.into_iter().filter(|&to| to != from) {
                    // What the operator or the other block asks for is what is there.
                    let there = old.clone().step().u;
                    let mut new = old.clone();
                    let mut twin = old.clone();
                    if to == Mode::Manual {
                        new.input.manual = Some(there);
                    }
                    if to == Mode::Track {
                        new.input.track = there;
                    }
                    new.input.mode = to;
                    let (u_new, u_twin) = (new.step(), twin.step());
                    assert_eq!(u_new.mode, to);
                    let bump = (u_new.u.to_f64() - u_twin.u.to_f64()).abs();
                    assert!(bump <= eps::<T>(), "{name}, {moment}, {from:?} -> {to:?}: {bump:e}");
                    // A manual mode without a value keeps the output.
                    if to == Mode::Manual {
                        let mut keep = old.clone();
                        keep.input.manual = None;
                        keep.input.mode = to;
                        let bump = (keep.step().u.to_f64() - u_twin.u.to_f64()).abs();
                        assert!(
                            bump <= eps::<T>(),
                            "{name}, {moment}, {from:?} -> Manual, no value: {bump:e}"
                        );
                    }
                    pairs += 1;
                }
            }
        }
    }
    assert_eq!(pairs, 3 * 5 * 30);
}

#[test]
fn every_ordered_pair_of_modes_in_double_precision() {
    every_pair_of_modes::<f64>();
}

#[test]
fn every_ordered_pair_of_modes_in_single_precision() {
    every_pair_of_modes::<f32>();
}

fn compensator_on_and_off<T: Real>() {
    for (name, plant, pid, compensator) in setups() {
        for (moment, mut base) in moments::<T>(&config(pid), &compensator, &plant) {
            for on in [false, true] {
                let mut twin = base.clone();
                base.input.compensate = on;
                let bump = (base.step().u.to_f64() - twin.step().u.to_f64()).abs();
                assert!(bump <= eps::<T>(), "{name}, {moment}, compensate {on}: {bump:e}");
                run(&mut base, 25);
            }
        }
    }
}

#[test]
fn the_compensator_goes_on_and_off() {
    compensator_on_and_off::<f64>();
    compensator_on_and_off::<f32>();
}

/// Gain from `y` to `u` within one sample, and the integral's part of it, measured on the law itself.
fn instant_gain<T: Real>(rig: &Rig<T>) -> f64 {
    let u = |dy: f64| {
        let mut copy = rig.clone();
        copy.input.y = T::from_f64(rig.y() + dy);
        let input = copy.input;
        copy.law.step(&mut copy.state, &input).v.to_f64()
    };
    u(0.5) - u(-0.5)
}

type Change = (&'static str, fn(&mut ControllerConfig, &mut CompensatorConfig));

const CHANGES: &[Change] = &[
    ("kp", |c, _| c.pid.kp *= 1.5),
    ("ki", |c, _| c.pid.ki *= 2.0),
    ("ki to zero", |c, _| c.pid.ki = 0.0),
    ("kd", |c, _| c.pid.kd *= 0.3),
    ("kd to zero", |c, _| c.pid.kd = 0.0),
    ("tf", |c, _| c.pid.tf *= 3.0),
    ("b", |c, _| c.pid.b = 0.1),
    ("c", |c, _| c.pid.c = 1.0),
    ("all gains", |c, _| {
        c.pid.kp *= 0.5;
        c.pid.ki *= 0.4;
        c.pid.kd *= 1.7;
        c.pid.tf *= 0.7;
    }),
    ("integral rule", |c, _| c.pid.integral_rule = IntegralRule::Trapezoid),
    ("tt", |c, _| c.anti_windup = AntiWindupConfig::BackCalculation { tt: Some(0.05) }),
    ("conditional anti-windup", |c, _| c.anti_windup = AntiWindupConfig::Conditional),
    ("wider limits", |c, _| c.limits = LimitConfig::range(-RANGE, RANGE)),
    ("rate limit", |c, _| c.limits.rate_up = Some(1e4)),
    ("filter gain", |_, k| k.gain *= 0.5),
    ("filter time", |_, k| k.time_constant *= 0.6),
    ("slower filter", |_, k| k.time_constant *= 2.5),
    ("model gain", |_, k| k.model.gain *= 1.3),
    ("model poles", |_, k| k.model.poles.iter_mut().for_each(|p| p.a1 *= 1.2)),
    ("longer dead time", |_, k| k.model.dead_time += 0.31),
    ("shorter dead time", |_, k| k.model.dead_time *= 0.45),
    ("latency", |_, k| k.latency = 0.013),
];

fn every_parameter<T: Real>() {
    for (name, plant, pid, compensator) in setups() {
        for (moment, base) in moments::<T>(&config(pid), &compensator, &plant) {
            for (what, change) in CHANGES {
                let (mut config, mut block) = (config(pid), compensator.clone());
                change(&mut config, &mut block);
                let mut twin = base.clone();
                let mut new = base.clone();
                let fresh = law::<T>(&config, &block, TS).unwrap_or_else(|f| panic!("{name} {what}: {f}"));
                fresh.adopt(&twin.law, &mut new.state);
                new.law = fresh;
                // The measurement of the sample before: the rig leaves it in its input.
                let y_before = base.input.y.to_f64();
                let dy = (twin.y() - y_before).abs();
                let e = (twin.input.r.to_f64() - twin.y()).abs();
                let dki = (config.pid.ki - pid.ki).abs();
                let rule = if config.pid.integral_rule == pid.integral_rule {
                    0.0
                } else {
                    0.5 * dy * pid.ki.abs() * TS
                };
                // The instant gain contains the integral's ki*ts, which may hide part of the change of the rest.
                let dhf = (instant_gain(&new) - instant_gain(&twin)).abs() + dki * TS;
                let bound = dki * TS * e + dhf * dy + rule + eps::<T>();
                let (a, b) = (new.step(), twin.step());
                let limits_equal = *what != "wider limits";
                let bump =
                    if limits_equal { a.u.to_f64() - b.u.to_f64() } else { a.v.to_f64() - b.v.to_f64() }
                        .abs();
                assert!(bump <= bound, "{name}, {moment}, {what}: {bump:e} > {bound:e} (dy {dy:e}, e {e:e})");
            }
        }
    }
}

#[test]
fn every_parameter_in_double_precision() {
    every_parameter::<f64>();
}

#[test]
fn every_parameter_in_single_precision() {
    every_parameter::<f32>();
}

/// Limits that move inwards hold at once; the loop goes on from there.
#[test]
fn tighter_limits_hold_at_once() {
    for (name, plant, pid, compensator) in setups() {
        for (moment, mut rig) in moments::<f64>(&config(pid), &compensator, &plant) {
            let mut tight = config(pid);
            tight.limits = LimitConfig::range(-0.2, 0.4);
            let fresh = law(&tight, &compensator, TS).expect("valid");
            fresh.adopt(&rig.law, &mut rig.state);
            rig.law = fresh;
            for _ in 0..200 {
                let u = rig.step().u;
                assert!((-0.2..=0.4).contains(&u), "{name}, {moment}: {u}");
            }
        }
    }
}

/// Power-up from a zeroed state with the measurement at 77: no kick; and a settled start followed by a step: the whole
/// response at once.
#[test]
fn power_up_does_not_kick_and_a_settled_start_does() {
    for (name, plant, pid, compensator) in setups() {
        let law = law::<f64>(&config(pid), &compensator, TS).expect("valid");
        let mut rig = Rig::new(law.clone(), plant.sampled(TS));
        rig.state = controller_core::ControllerState::over(
            law.compensator().state(vec![0.0; controller_tests::rig::CAPACITY]).expect("fits"),
        );
        for k in 0..200 {
            let input = controller_core::ControllerInput { r: 77.0, y: 77.0, ..Default::default() };
            let u = law.step(&mut rig.state, &input).u;
            assert!(u.abs() <= 1e-9, "{name}: {u} in sample {k}");
        }

        // With a read-back the loop starts where the actuator is, and stays there after the dead time, too.
        let mut state = controller_core::ControllerState::over(
            law.compensator().state(vec![0.0; controller_tests::rig::CAPACITY]).expect("fits"),
        );
        for k in 0..200 {
            let input = controller_core::ControllerInput {
                r: 77.0,
                y: 77.0,
                u_applied: Some(12.5),
                ..Default::default()
            };
            let u = law.step(&mut state, &input).u;
            assert!((u - 12.5).abs() <= 1e-9, "{name}: {u} in sample {k}");
        }

        let mut settled = Rig::new(law, plant.sampled(TS));
        settled.input.r = 1.0;
        let u = settled.step().u;
        let [kp, ki, kd] = [pid.kp, pid.ki, pid.kd];
        let g = 2.0 * TS / (TS + 2.0 * pid.tf);
        let full = ki * TS + (pid.b * kp - ki * pid.tf) * g / 2.0 + pid.c * kd * g / TS;
        assert!((u - full).abs() < 1e-12, "{name}: {u} instead of {full}");
    }
}
