//! Discrete-time control that runs unchanged on a microcontroller, inside a PLC runtime and on a laptop.
//!
//! The crate holds the runtime blocks: a two-degree-of-freedom [`Pid`], the disturbance estimator and observer
//! ([`compensator`]), a second-order ADRC ([`Adrc`]), and a [`Controller`] that composes them with limits, set-point conditioning, anti-windup,
//! modes, bad-sample handling and alarms. `no_std`, no allocation, no unsafe code, `f32` and `f64`.
//!
//! # Three types per block
//!
//! `…Config` is what a person writes: `f64`, public fields, SI units. The law (`Pid`, `Compensator`, `Controller`) is
//! discretised for one sampling period, validated and immutable; building it may fail and names every fault at once.
//! `…State` is small and copyable. A law moves a state: `law.step(&mut state, input)`, which never fails. To change a
//! parameter, build another law and let it [`adopt`](Controller::adopt) the state: no bump.
//!
//! # What holds
//!
//! * A step uses `+ - * /`, comparison and `abs` only: equal inputs give equal bits on every machine.
//! * [`Controller::step`] is total: for every bit pattern of every input, finite output in its range, finite state.
//! * Memory that something has written over is no danger: every bit pattern of a [`Controller`] and of its state is a value,
//!   a step on it gives numbers and nothing worse, and a [`Checksum`] finds it.
//! * Nothing stalls: integrators and slow lags use compensated addition ([`Accumulator`]).
//! * Bad configurations cannot be built ([`ConfigErrors`]).
//!
//! ```
//! use controller_core::{Controller, ControllerConfig, ControllerInput, Estimator, EstimatorConfig, LimitConfig, PidConfig};
//!
//! // The DE-MOMI design for exp(-0.2 s)/((1+0.2 s)(1+s)) of Vrančić & Huba 2021, tables 4 and eqs (36), (37).
//! let ts = 0.01;
//! let config = ControllerConfig {
//!     pid: PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, b: 1.0, c: 1.0, ..PidConfig::default() },
//!     limits: LimitConfig::range(-10.0, 10.0),
//!     ..ControllerConfig::default()
//! };
//! let model = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
//! let estimator = Estimator::<f32, 32>::estimator(&model, 0.0, ts).unwrap();
//! let law = Controller::with_compensator(&config, estimator, ts).unwrap();
//! let mut state = law.zeroed();
//! let out = law.step(&mut state, &ControllerInput { r: 1.0, y: 0.0, ..ControllerInput::default() });
//! assert!(out.u.is_finite());
//! ```
//!
//! # Features
//!
//! None is on by itself. `defmt`: what a firmware logs implements `defmt::Format`, sent as numbers and decoded on the host;
//! a [`Status`] shows the names of its bits.
#![no_std]

mod accumulator;
pub mod adrc;
mod alarm;
mod anti_windup;
mod checksum;
pub mod compensator;
pub mod controller;
mod deadband;
mod delay;
mod error;
mod fingerprint;
mod instance;
mod lag;
mod limit;
mod mode;
mod param_cell;
pub mod pid;
pub mod plant_model;
mod real;
mod regulator;
mod sample;
mod setpoint;
pub mod snapshot;
mod status;
mod stored;
mod trace;

pub use accumulator::Accumulator;
pub use adrc::{Adrc, AdrcCoefficients, AdrcConfig, AdrcInput, AdrcOutput, AdrcState};
pub use alarm::{AlarmConfig, Alarms};
pub use anti_windup::{AntiWindup, AntiWindupConfig};
pub use checksum::Checksum;
pub use compensator::{
    AnyCompensator, AnyCompensatorState, Coefficients, Compensate, Compensator, CompensatorConfig,
    CompensatorInput, CompensatorOutput, CompensatorState, Estimator, EstimatorConfig, FilterNames,
    NoCompensator, Observer, ObserverConfig,
};
pub use controller::{
    Controller, ControllerConfig, ControllerInput, ControllerNumbers, ControllerOutput, ControllerState,
};
pub use deadband::Deadband;
pub use delay::{DelayLine, Memory};
pub use error::{ConfigError, ConfigErrors, MAX_FAULTS, Param, Reason};
pub use fingerprint::Fingerprint;
pub use instance::{Instance, Law};
pub use lag::{Lag, LagTap};
pub use limit::{Limit, LimitConfig, Limited};
pub use mode::Mode;
pub use param_cell::ParamCell;
pub use pid::{Action, IntegralRule, Pid, PidCoefficients, PidConfig, PidInput, PidOutput, PidState, Span};
pub use plant_model::PlantModel;
pub use real::Real;
pub use regulator::Regulator;
pub use sample::{
    FallbackAction, FallbackConfig, FallbackReturn, Quality, SampleGuard, SampleGuardState, Verdict,
};
pub use setpoint::{Setpoint, SetpointConfig};
pub use snapshot::SnapshotError;
pub use status::Status;
pub use trace::{Trace, TraceSample};
