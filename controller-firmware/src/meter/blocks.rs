//! The blocks that are measured, with parameters from the two papers.

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Accumulator, Adrc, AdrcConfig, AlarmConfig, AntiWindup, AntiWindupConfig, Compensate, Compensator,
    CompensatorConfig, CompensatorInput, CompensatorOutput, CompensatorState, ConfigErrors, Controller,
    ControllerConfig, EstimatorConfig, FallbackAction, FallbackConfig, FallbackReturn, IntegralRule, Law,
    Limit, LimitConfig, Limited, NoCompensator, ObserverConfig, Pid, PidConfig, PidInput, PidState, Real,
    SetpointConfig,
};

/// Sampling period \[s\].
pub(super) const TS: f64 = 0.01;
/// Samples in a delay line; what it costs does not depend on it.
pub(super) const LINE: usize = 24;

/// The gains that go with the estimator, or a retuned set.
pub(super) fn pid(retuned: bool) -> PidConfig {
    let scale = if retuned { 0.8 } else { 1.0 };
    let integral_rule = if retuned { IntegralRule::Trapezoid } else { IntegralRule::Backward };
    PidConfig {
        kp: 2.35 * scale,
        ki: 1.88 * scale,
        kd: 0.48,
        tf: 0.119,
        b: 1.0,
        c: 1.0,
        integral_rule,
        ..PidConfig::default()
    }
}

/// The PI of the observer's paper.
fn pi() -> PidConfig {
    PidConfig { kp: 0.8, ki: 0.7, b: 1.0, c: 1.0, ..PidConfig::default() }
}

/// A model of second order.
pub(super) fn second_order(retuned: bool) -> CompensatorConfig {
    let kfd = if retuned { 0.5 } else { 0.69 };
    EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd, tfd: 0.06 }.to_compensator(0.0)
}

/// A model of first order.
pub(super) fn first_order(retuned: bool) -> CompensatorConfig {
    let kfd = if retuned { 0.5 } else { 0.69 };
    EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.0, dead_time: 0.2, kfd, tfd: 0.06 }.to_compensator(0.0)
}

/// An observer for a lag.
pub(super) fn observer(retuned: bool) -> CompensatorConfig {
    let alpha = if retuned { 0.15 } else { 0.1 };
    ObserverConfig { model: PlantModel::first_order(1.0, 1.0, 0.2), alpha, order: None }.to_compensator(0.0)
}

/// An observer for three lags.
pub(super) fn third_order(retuned: bool) -> CompensatorConfig {
    let alpha = if retuned { 0.15 } else { 0.1 };
    let model =
        PlantModel::first_order(1.0, 1.0, 0.2).with_pole(Factor::first(0.5)).with_pole(Factor::first(0.25));
    ObserverConfig { model, alpha, order: None }.to_compensator(0.0)
}

/// An ADRC for a plant of second order.
pub(super) fn adrc(retuned: bool) -> AdrcConfig {
    let observer = if retuned { 16.0 } else { 20.0 };
    AdrcConfig::from_bandwidths(5.0, 5.0, observer)
}

/// How a loop is configured: what it costs may depend on it.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// A range for the output and nothing else.
    Plain,
    /// Everything that can be configured.
    Full,
    /// As plain, with the other anti-windup rule and a fallback that ramps.
    Conditional,
}

/// The configuration of a loop, but for its law.
fn around(form: Form) -> ControllerConfig {
    let plain = ControllerConfig { limits: LimitConfig::range(-10.0, 10.0), ..ControllerConfig::default() };
    match form {
        Form::Plain => plain,
        Form::Full => ControllerConfig {
            limits: LimitConfig { rate_up: Some(100.0), rate_down: Some(80.0), ..plain.limits },
            setpoint: SetpointConfig {
                lo: -20.0,
                hi: 20.0,
                rate_up: Some(50.0),
                rate_down: Some(50.0),
                track: true,
            },
            measurement_lo: -100.0,
            measurement_hi: 100.0,
            offset_lo: -5.0,
            offset_hi: 5.0,
            fallback: FallbackConfig {
                hold_samples: 3,
                action: FallbackAction::Substitute { output: 1.0 },
                back: FallbackReturn::Acknowledged,
            },
            alarms: AlarmConfig {
                hi_hi: Some(18.0),
                hi: Some(12.0),
                lo: Some(-12.0),
                lo_lo: Some(-18.0),
                deviation: Some(5.0),
                hysteresis: 0.5,
            },
            off_output: Some(0.0),
            ..plain
        },
        Form::Conditional => ControllerConfig {
            anti_windup: AntiWindupConfig::Conditional,
            fallback: FallbackConfig {
                hold_samples: 3,
                action: FallbackAction::Ramp { output: 1.0, rate: 5.0 },
                back: FallbackReturn::Automatic,
            },
            ..plain
        },
    }
}

/// The configuration of a loop with these gains.
fn closed(form: Form, pid: PidConfig) -> ControllerConfig {
    let deadband = if matches!(form, Form::Full) { 0.01 } else { 0.0 };
    ControllerConfig { pid, deadband, ..around(form) }
}

/// A PID loop, with a compensator or without. (A list of errors is large: it goes no further than this.)
pub(super) fn pid_loop<T: Real, C: Compensate<T> + Copy>(
    &(form, compensator): &(Form, C),
    law: &mut Option<Controller<T, C>>,
) {
    *law = Controller::with_compensator(&closed(form, pid(false)), compensator, TS).ok();
}

/// A PI loop with a compensator.
pub(super) fn pi_loop<T: Real, C: Compensate<T> + Copy>(
    &(form, compensator): &(Form, C),
    law: &mut Option<Controller<T, C>>,
) {
    *law = Controller::with_compensator(&closed(form, pi()), compensator, TS).ok();
}

/// A loop with an ADRC.
pub(super) fn adrc_loop<T: Real>(
    &(form, _): &(Form, NoCompensator),
    law: &mut Option<Controller<T, NoCompensator, Adrc<T>>>,
) {
    *law = Controller::with_adrc(&around(form), &adrc(false), TS).ok();
}

/// A PID with output range and rate and back-calculation, put together from the small blocks: what a loop needs that is
/// always closed and whose measurement is always good.
#[derive(Clone, Copy)]
pub(super) struct Limiting<T> {
    pid: Pid<T>,
    limit: Limit<T>,
    anti_windup: AntiWindup<T>,
}

/// Its state.
#[derive(Clone, Copy)]
pub(super) struct LimitingState<T> {
    pid: PidState<T>,
    u: Accumulator<T>,
    v: T,
}

impl<T: Real> Limiting<T> {
    pub(super) fn new(retuned: bool) -> Result<Self, ConfigErrors> {
        let config = pid(retuned);
        let range =
            LimitConfig { rate_up: Some(100.0), rate_down: Some(80.0), ..LimitConfig::range(-10.0, 10.0) };
        Ok(Self {
            pid: Pid::new(&config, TS)?,
            limit: Limit::new(&range, TS)?,
            anti_windup: AntiWindup::new(&AntiWindupConfig::default(), &config, TS)?,
        })
    }
}

impl<T: Real> LimitingState<T> {
    pub(super) fn new() -> Self {
        Self { pid: PidState::default(), u: Accumulator::new(T::ZERO), v: T::ZERO }
    }
}

impl<T: Real> Law for Limiting<T> {
    type State = LimitingState<T>;
    type Input = PidInput<T>;
    type Output = Limited<T>;

    fn run(&self, state: &mut Self::State, input: &Self::Input) -> Limited<T> {
        let correction = self.anti_windup.correction(state.pid.increment(), state.v, state.u.value());
        state.pid.shift_integral(correction);
        let v = self.pid.step(&mut state.pid, *input).u();
        state.v = v;
        self.limit.apply(&mut state.u, v)
    }

    fn take_over(&self, old: &Self, state: &mut Self::State) {
        self.pid.adopt(&old.pid, &mut state.pid);
    }
}

/// One sample of a compensator, its input by address as all of them have it here.
pub(super) fn compensate<T: Real, const N: usize, const E: usize>(
    law: &Compensator<T, N, E, LINE>,
    state: &mut CompensatorState<T, N, E, LINE>,
    input: &CompensatorInput<T>,
) -> CompensatorOutput<T> {
    law.step(state, *input)
}
