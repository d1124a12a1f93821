//! estimator: the loop of `loops.toml`, exported by `controller-sim export`.
//!
//! Do not change numbers here: they have passed checks that this file cannot repeat, and the compiler will
//! refuse others. Change the design file and export it again. Declare it as `#[rustfmt::skip] mod ...;`.

use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, Compensator, ConfigErrors, Controller, ControllerConfig,
    ControllerState, EstimatorConfig, FallbackAction, FallbackConfig, FallbackReturn, Fingerprint,
    IntegralRule, LimitConfig, PidConfig, SetpointConfig,
};

/// Sampling period \[s\]: the timer that runs the loop must have it.
pub const TS: f64 = 0.01;

/// From reading the measurement to acting \[s\].
pub const LATENCY: f64 = 0.003;

/// PID, limits, set-point, anti-windup, bad samples, alarms.
pub const CONTROLLER: ControllerConfig = ControllerConfig {
    pid: PidConfig {
        kp: 2.35,
        ki: 1.88,
        kd: 0.48,
        tf: 0.119,
        b: 1.0,
        c: 1.0,
        action: Action::Reverse,
        integral_rule: IntegralRule::Backward,
    },
    limits: LimitConfig {
        lo: -10.0,
        hi: 10.0,
        rate_up: None,
        rate_down: None,
    },
    setpoint: SetpointConfig {
        lo: -1000000.0,
        hi: 1000000.0,
        rate_up: None,
        rate_down: None,
        track: false,
    },
    anti_windup: AntiWindupConfig::BackCalculation { tt: None },
    deadband: 0.0,
    measurement_lo: -1000000.0,
    measurement_hi: 1000000.0,
    offset_lo: -1000000.0,
    offset_hi: 1000000.0,
    fallback: FallbackConfig {
        hold_samples: 3,
        action: FallbackAction::Ramp { output: 0.5, rate: 2.0 },
        back: FallbackReturn::Acknowledged,
    },
    alarms: AlarmConfig {
        hi_hi: None,
        hi: None,
        lo: None,
        lo_lo: None,
        deviation: None,
        hysteresis: 0.0,
    },
    off_output: None,
    initial_output: 0.0,
};

/// The disturbance estimator.
pub const ESTIMATOR: EstimatorConfig = EstimatorConfig {
    gain: 1.0,
    a1: 1.2,
    a2: 0.2,
    dead_time: 0.2,
    kfd: 0.69,
    tfd: 0.06,
};

/// Samples of delay memory; more of it leaves room for longer dead times.
pub const CAPACITY: usize = 21;

/// The law: built once, never changed.
pub type Law = Controller<f64, Compensator<f64, 2, 1, CAPACITY>>;

/// Its state: `law.zeroed()` settles itself on the first good sample.
pub type State = ControllerState<f64, controller_core::CompensatorState<f64, 2, 1, CAPACITY>>;

/// Builds the law.
///
/// # Errors
/// None: this very law was built when it was exported.
pub fn law() -> Result<Law, ConfigErrors> {
    law_of(&CONTROLLER)
}

/// Builds the same loop with other parameters, every number rounded to the type it runs in.
///
/// # Errors
/// Every fault of `controller`.
pub fn law_of(controller: &ControllerConfig) -> Result<Law, ConfigErrors> {
    let ts = TS;
    Controller::with_compensator(
        &controller.rounded::<f64>(),
        Compensator::new(&ESTIMATOR.to_compensator(LATENCY).rounded::<f64>(), ts)?,
        ts,
    )
}

const _: () = assert!(
    Fingerprint::new().number(TS).number(LATENCY).controller(&CONTROLLER).estimator(&ESTIMATOR).word(CAPACITY as u64).value()
        == 0x77ace2df1d028a5b,
    "a number was changed by hand: change the design file and export it again"
);
