//! The laws that every loop goes through.

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AdrcConfig, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, EstimatorConfig,
    FallbackAction, FallbackConfig, FallbackReturn, IntegralRule, LimitConfig, ObserverConfig, PidConfig,
    SetpointConfig,
};

/// Laws that one loop goes through.
pub(super) const LAWS: usize = 4;

/// Sampling period of the first law of every loop \[s\].
const TS: f64 = 0.01;

/// The configuration of the law with this number: other gains, filters, limits, policies in each.
pub(super) fn config(number: usize) -> ControllerConfig {
    let pids = [
        PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, c: 1.0, ..PidConfig::default() },
        PidConfig { kp: 0.8, ki: 0.7, integral_rule: IntegralRule::Trapezoid, ..PidConfig::default() },
        PidConfig { kp: -1.5, ki: -0.9, b: 0.3, action: Action::Direct, ..PidConfig::default() },
        PidConfig { kp: 1.1, ki: 0.0, kd: 0.02, tf: 0.02, ..PidConfig::default() },
    ];
    let rules = [
        AntiWindupConfig::BackCalculation { tt: None },
        AntiWindupConfig::Conditional,
        AntiWindupConfig::BackCalculation { tt: Some(0.3) },
        AntiWindupConfig::None,
    ];
    let actions = [
        FallbackAction::Hold,
        FallbackAction::Ramp { output: 0.5, rate: 2.0 },
        FallbackAction::Substitute { output: -0.25 },
        FallbackAction::Ramp { output: -1.0, rate: 0.7 },
    ];
    let size = [4.0, 10.0, 2.5, 1.0][number];
    let slow = [None, Some(50.0), Some(6.0), None][number];
    ControllerConfig {
        pid: pids[number],
        limits: LimitConfig { lo: -size, hi: 1.5 * size, rate_up: slow, rate_down: slow.map(|r| 0.7 * r) },
        setpoint: SetpointConfig {
            lo: -3.0,
            hi: 3.0,
            rate_up: [None, Some(1.7), None, Some(0.9)][number],
            rate_down: [None, None, Some(2.3), Some(0.4)][number],
            track: number & 1 == 1,
        },
        anti_windup: rules[number],
        deadband: [0.0, 0.0, 0.01, 0.003][number],
        measurement_lo: -50.0,
        measurement_hi: 50.0,
        fallback: FallbackConfig {
            hold_samples: [3, 0, 10, 25][number],
            action: actions[number],
            back: if number == 2 { FallbackReturn::Acknowledged } else { FallbackReturn::Automatic },
        },
        alarms: AlarmConfig {
            hi: Some(1.5),
            lo: Some(-1.5),
            deviation: Some(0.7),
            hysteresis: 0.1,
            ..AlarmConfig::default()
        },
        off_output: if number == 0 { Some(0.1) } else { None },
        ..ControllerConfig::default()
    }
}

/// Another sampling period for the last law.
pub(super) fn period(number: usize) -> f64 {
    if number == 3 { 1.3 * TS } else { TS }
}

/// The same around an ADRC, which has no gains of a PID and no band in which it is blind.
pub(super) fn around_adrc(number: usize) -> ControllerConfig {
    ControllerConfig { pid: PidConfig::default(), deadband: 0.0, ..config(number) }
}

/// The ADRC with this number: good and bad guesses of the plant's gain, one of the wrong sign.
pub(super) fn adrc(number: usize) -> AdrcConfig {
    let b0 = [5.0, 20.0, -8.0, 3.0][number];
    let omega_c = [3.0, 1.5, 2.0, 5.0][number];
    AdrcConfig::from_bandwidths(b0, omega_c, 4.0 * omega_c)
}

pub(super) fn estimator(number: usize, a2: f64) -> CompensatorConfig {
    let dead_time = [0.2, 0.05, 0.333, 0.0][number];
    let kfd = [0.69, 1.0, 0.4, 0.9][number];
    EstimatorConfig { gain: 1.0, a1: 1.2, a2, dead_time, kfd, tfd: 0.06 }.to_compensator(0.0)
}

pub(super) fn observer(number: usize, model: PlantModel, order: Option<usize>) -> CompensatorConfig {
    let dead_time = [0.2, 0.123, 0.0, 0.31][number];
    let alpha = [0.1, 0.3, 0.05, 0.2][number];
    let config = ObserverConfig { model: model.with_dead_time(dead_time), alpha, order };
    config.to_compensator([0.0, 0.004, 0.0, 0.01][number])
}

/// A lag and a complex pair, a zero on each side of the imaginary axis.
pub(super) fn third_order() -> PlantModel {
    PlantModel::first_order(1.0, 0.9, 0.0)
        .with_pole(Factor::second(0.1, 0.04))
        .with_zero(Factor::first(0.15))
        .with_zero(Factor::first(-0.08))
}

/// An integrator, lags from slow to fast, a pair, and complex zeros.
pub(super) fn fifth_order() -> PlantModel {
    PlantModel::integrating(0.5, 0.0)
        .with_pole(Factor::first(2.0))
        .with_pole(Factor::second(0.3, 0.02))
        .with_pole(Factor::first(0.011))
        .with_zero(Factor::second(0.02, 0.01))
}
