//! The loops of `tests/c/cases.h`, as a Rust programmer writes them for the core.

use controller_core::plant_model::Factor;
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, EstimatorConfig,
    FallbackAction, FallbackConfig, FallbackReturn, IntegralRule, LimitConfig, ObserverConfig, PidConfig,
    PlantModel, SetpointConfig,
};

pub(crate) const COUNT: usize = 5;
pub(crate) const TS: f64 = 0.05;

/// A loop and the gain of a plant that it can control.
pub(crate) fn case(number: usize) -> (ControllerConfig, Option<CompensatorConfig>, f64) {
    match number {
        0 => (pid(), None, 1.0),
        1 => (estimator().0, Some(estimator().1.to_compensator(0.0)), 1.0),
        2 => (observer().0, Some(observer().1.to_compensator(0.03)), 1.0),
        3 => (full().0, Some(full().1.to_compensator(0.013)), -1.0),
        _ => (other_estimator().0, Some(other_estimator().1.to_compensator(0.0)), 1.0),
    }
}

fn pid() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig { kp: 2.0, ki: 1.0, kd: 0.2, tf: 0.05, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 3.0),
        ..ControllerConfig::default()
    }
}

fn estimator() -> (ControllerConfig, EstimatorConfig) {
    let config = ControllerConfig {
        pid: PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, c: 1.0, ..PidConfig::default() },
        limits: LimitConfig { lo: -2.0, hi: 2.5, rate_up: Some(20.0), rate_down: None },
        ..ControllerConfig::default()
    };
    (config, EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.237, kfd: 0.69, tfd: 0.06 })
}

fn observer() -> (ControllerConfig, ObserverConfig) {
    let config = ControllerConfig {
        pid: PidConfig { kp: 0.8, ki: 0.7, integral_rule: IntegralRule::Trapezoid, ..PidConfig::default() },
        limits: LimitConfig::range(-1.5, 1.5),
        anti_windup: AntiWindupConfig::Conditional,
        ..ControllerConfig::default()
    };
    let model = PlantModel::second_order(1.5, 0.6, 0.25, 0.08)
        .with_pole(Factor::first(0.4))
        .with_zero(Factor::first(0.11));
    (config, ObserverConfig { model, alpha: 0.15, order: Some(4) })
}

fn full() -> (ControllerConfig, ObserverConfig) {
    let config = ControllerConfig {
        pid: PidConfig {
            kp: 1.1,
            ki: 0.31,
            kd: 0.21,
            tf: 0.09,
            b: 0.7,
            c: 0.3,
            action: Action::Direct,
            integral_rule: IntegralRule::Trapezoid,
        },
        limits: LimitConfig { lo: -1.7, hi: 1.9, rate_up: Some(11.0), rate_down: Some(13.0) },
        setpoint: SetpointConfig { lo: -0.8, hi: 1.3, rate_up: Some(4.0), rate_down: Some(5.0), track: true },
        anti_windup: AntiWindupConfig::BackCalculation { tt: Some(0.9) },
        deadband: 0.01,
        measurement_lo: -6.0,
        measurement_hi: 7.0,
        offset_lo: -0.25,
        offset_hi: 0.35,
        fallback: FallbackConfig {
            hold_samples: 3,
            action: FallbackAction::Ramp { output: 0.4, rate: 0.6 },
            back: FallbackReturn::Acknowledged,
        },
        alarms: AlarmConfig {
            hi_hi: Some(1.1),
            hi: Some(0.9),
            lo: Some(-0.3),
            lo_lo: Some(-0.5),
            deviation: Some(0.45),
            hysteresis: 0.02,
        },
        off_output: Some(-0.15),
        initial_output: 0.22,
    };
    let model = PlantModel::integrating(-1.4, 0.11).with_pole(Factor::first(0.37));
    (config, ObserverConfig { model, alpha: 0.33, order: Some(3) })
}

fn other_estimator() -> (ControllerConfig, EstimatorConfig) {
    let (mut config, mut model) = estimator();
    config.pid.kp = 1.9;
    config.anti_windup = AntiWindupConfig::None;
    (model.a1, model.a2, model.dead_time) = (1.1, 0.0, 0.31);
    (config, model)
}
