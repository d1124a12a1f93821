//! oven: the loop of `oven.toml`, exported by `controller-sim export`.
//!
//! Do not change numbers here: they have passed checks that this file cannot repeat, and the compiler will
//! refuse others. Change the design file and export it again. Declare it as `#[rustfmt::skip] mod ...;`.

use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, ConfigErrors, Controller, ControllerConfig,
    ControllerState, FallbackAction, FallbackConfig, FallbackReturn, Fingerprint, IntegralRule,
    LimitConfig, NoCompensator, PidConfig, SetpointConfig,
};

/// Sampling period \[s\]: the timer that runs the loop must have it.
pub const TS: f64 = 0.1;

/// From reading the measurement to acting \[s\].
pub const LATENCY: f64 = 0.2;

/// PID, limits, set-point, anti-windup, bad samples, alarms.
pub const CONTROLLER: ControllerConfig = ControllerConfig {
    pid: PidConfig {
        kp: 2.5420123899205973,
        ki: 0.528378214587128,
        kd: 1.7144632417170103,
        tf: 0.6418324674886737,
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
        action: FallbackAction::Ramp { output: 0.0, rate: 10.0 },
        back: FallbackReturn::Automatic,
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

/// The law: built once, never changed.
pub type Law = Controller<f32, NoCompensator>;

/// Its state: `law.zeroed()` settles itself on the first good sample.
pub type State = ControllerState<f32, ()>;

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
    Controller::new(&controller.rounded::<f32>(), ts)
}

const _: () = assert!(
    Fingerprint::new().number(TS).number(LATENCY).controller(&CONTROLLER).value()
        == 0x979735f543ce1fef,
    "a number was changed by hand: change the design file and export it again"
);
