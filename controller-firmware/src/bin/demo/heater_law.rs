//! heater: the loop of `loop.toml`, exported by `controller-sim export`.
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
pub const LATENCY: f64 = 0.0;

/// PID, limits, set-point, anti-windup, bad samples, alarms.
pub const CONTROLLER: ControllerConfig = ControllerConfig {
    pid: PidConfig {
        kp: 1.9620757294206679,
        ki: 1.5663036058221853,
        kd: 0.396095721354207,
        tf: 0.11869815484379437,
        b: 1.0,
        c: 1.0,
        action: Action::Reverse,
        integral_rule: IntegralRule::Backward,
    },
    limits: LimitConfig {
        lo: 0.0,
        hi: 100.0,
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
        hold_samples: 25,
        action: FallbackAction::Ramp { output: 20.0, rate: 10.0 },
        back: FallbackReturn::Automatic,
    },
    alarms: AlarmConfig {
        hi_hi: None,
        hi: None,
        lo: None,
        lo_lo: None,
        deviation: Some(5.0),
        hysteresis: 1.0,
    },
    off_output: None,
    initial_output: 0.0,
};

/// The disturbance estimator.
pub const ESTIMATOR: EstimatorConfig = EstimatorConfig {
    gain: 1.2,
    a1: 1.2,
    a2: 0.19999999999999998,
    dead_time: 0.19999999999999998,
    kfd: 0.3202845547183012,
    tfd: 0.3150402651572641,
};

/// Samples of delay memory; more of it leaves room for longer dead times.
pub const CAPACITY: usize = 21;

/// The law: built once, never changed.
pub type Law = Controller<f32, Compensator<f32, 2, 1, CAPACITY>>;

/// Its state: `law.zeroed()` settles itself on the first good sample.
pub type State = ControllerState<f32, controller_core::CompensatorState<f32, 2, 1, CAPACITY>>;

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
    let ts = f64::from(TS as f32);
    Controller::with_compensator(
        &controller.rounded::<f32>(),
        Compensator::new(&ESTIMATOR.to_compensator(LATENCY).rounded::<f32>(), ts)?,
        ts,
    )
}

const _: () = assert!(
    Fingerprint::new().number(TS).number(LATENCY).controller(&CONTROLLER).estimator(&ESTIMATOR).word(CAPACITY as u64).value()
        == 0x731166d53f68e532,
    "a number was changed by hand: change the design file and export it again"
);
