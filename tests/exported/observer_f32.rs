//! observer: the loop of `loops.toml`, exported by `controller-sim export`.
//!
//! Do not change numbers here: they have passed checks that this file cannot repeat, and the compiler will
//! refuse others. Change the design file and export it again. Declare it as `#[rustfmt::skip] mod ...;`.

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, Compensator, ConfigErrors, Controller, ControllerConfig,
    ControllerState, FallbackAction, FallbackConfig, FallbackReturn, Fingerprint, IntegralRule,
    LimitConfig, ObserverConfig, PidConfig, SetpointConfig,
};

/// Sampling period \[s\]: the timer that runs the loop must have it.
pub const TS: f64 = 0.01;

/// From reading the measurement to acting \[s\].
pub const LATENCY: f64 = 0.003;

/// PID, limits, set-point, anti-windup, bad samples, alarms.
pub const CONTROLLER: ControllerConfig = ControllerConfig {
    pid: PidConfig {
        kp: 0.8,
        ki: 0.7,
        kd: 0.0,
        tf: 0.0,
        b: 1.0,
        c: 0.0,
        action: Action::Reverse,
        integral_rule: IntegralRule::Backward,
    },
    limits: LimitConfig {
        lo: -1000000.0,
        hi: 1000000.0,
        rate_up: None,
        rate_down: None,
    },
    setpoint: SetpointConfig {
        lo: -3.0,
        hi: 3.0,
        rate_up: Some(1.7),
        rate_down: None,
        track: true,
    },
    anti_windup: AntiWindupConfig::BackCalculation { tt: None },
    deadband: 0.0,
    measurement_lo: -1000000.0,
    measurement_hi: 1000000.0,
    offset_lo: -1000000.0,
    offset_hi: 1000000.0,
    fallback: FallbackConfig {
        hold_samples: 25,
        action: FallbackAction::Hold,
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

/// Gain of the observer's model.
pub const GAIN: f64 = 1.0;

/// Integrators of the model.
pub const INTEGRATORS: u64 = 0;

/// Denominator of the model.
pub const POLES: [Factor; 3] = [Factor::second(0.2, 0.0), Factor::second(1.0, 0.0), Factor::second(0.5, 0.0)];

/// Numerator of the model.
pub const ZEROS: [Factor; 1] = [Factor::second(0.1, 0.0)];

/// Dead time of the model \[s\].
pub const DEAD_TIME: f64 = 0.2;

/// Filter time constant \[s\].
pub const ALPHA: f64 = 0.1;

/// Filter order; 0: the smallest possible.
pub const ORDER: u64 = 3;

fn observer() -> ObserverConfig {
    let mut model = PlantModel::default().with_gain(GAIN).with_dead_time(DEAD_TIME);
    model.integrators = INTEGRATORS as usize;
    for pole in POLES {
        model = model.with_pole(pole);
    }
    for zero in ZEROS {
        model = model.with_zero(zero);
    }
    let order = if ORDER == 0 { None } else { Some(ORDER as usize) };
    ObserverConfig { model, alpha: ALPHA, order }
}

/// Samples of delay memory; more of it leaves room for longer dead times.
pub const CAPACITY: usize = 21;

/// The law: built once, never changed.
pub type Law = Controller<f32, Compensator<f32, 3, 1, CAPACITY>>;

/// Its state: `law.zeroed()` settles itself on the first good sample.
pub type State = ControllerState<f32, controller_core::CompensatorState<f32, 3, 1, CAPACITY>>;

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
        Compensator::new(&observer().to_compensator(LATENCY).rounded::<f32>(), ts)?,
        ts,
    )
}

const _: () = assert!(
    Fingerprint::new().number(TS).number(LATENCY).controller(&CONTROLLER)
        .numbers(&[GAIN, DEAD_TIME, ALPHA])
        .word(ORDER)
        .word(INTEGRATORS)
        .factors(&POLES)
        .factors(&ZEROS)
        .word(CAPACITY as u64).value()
        == 0xd95c3ad391253f12,
    "a number was changed by hand: change the design file and export it again"
);
