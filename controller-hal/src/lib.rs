//! Sensors and actuators of a control loop, over embedded-hal 1.0.
//!
//! The core knows no hardware. This crate stands between it and a board: what reads a measurement is a [`Sense`], what
//! moves the plant is an [`Actuate`], and each adapter here is made of one embedded-hal driver and one span.
//!
//! | | made of | block |
//! |---|---|---|
//! | in | `SpiDevice` | [`Mcp3201`], [`Mcp3204`]: 12-bit ADCs |
//! | in | `I2c` | [`Ads1115`]: 16-bit ADC, single shots |
//! | in | any [`Sense`] | [`Monitored`]: failures become bad samples and are counted |
//! | out | `SetDutyCycle` | [`Pwm`]: a PWM channel |
//! | out | `I2c` | [`Mcp4725`]: 12-bit DAC |
//! | out | `OutputPin` | [`TimeProportioned`]: relays and heaters |
//! | between | | [`CountSpan`], [`OutputSpan`]: counts to units and back |
//! | between | | [`GainSchedule`]: laws for several operating points, bumpless transfer between them |
//! | between | feature `micromath` | `SquareRootFlow`: flow from a differential pressure |
//!
//! # What holds
//!
//! * Nothing panics, whatever a bus or a loop gives. No unsafe code, no allocation.
//! * A failed bus is a sample of [`Quality::Bad`](controller_core::Quality), which a `Controller` knows how to live with.
//! * What is not finite never becomes a duty, a code or a pulse: the actuator keeps its output or goes to a safe one, and
//!   says so.
//! * An actuator returns what it accepted, limited and quantised: give it to the loop as `u_applied`.
//!
//! ```
//! use controller_core::{Controller, ControllerConfig, ControllerInput, LimitConfig, PidConfig};
//! use controller_hal::{Actuate, Monitored, OutputConfig, Pwm, Sense};
//!
//! fn one_sample<S: Sense<f32>, P: embedded_hal::pwm::SetDutyCycle>(
//!     law: &Controller<f32>,
//!     state: &mut <Controller<f32> as controller_core::Law>::State,
//!     sensor: &mut Monitored<S, f32>,
//!     heater: &mut Pwm<P, f32>,
//! ) {
//!     let input = ControllerInput { r: 60.0, u_applied: heater.applied(), ..ControllerInput::default() };
//!     let output = law.step(state, &sensor.read().into_input(input));
//!     if heater.apply(output.u).is_err() {
//!         // The next sample's read-back says what the heater still does.
//!     }
//! }
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]
// As in the core: nothing that runs in a control task may panic, and these are the ways to write a panic.
#![deny(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::integer_division,
    clippy::modulo_arithmetic,
    clippy::panic,
    clippy::unreachable,
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss
)]

mod actuate;
mod ads1115;
mod faults;
#[cfg(feature = "micromath")]
mod flow;
mod mcp320x;
mod mcp4725;
mod number;
mod pwm;
mod schedule;
mod sense;
mod span;
mod time_proportioned;

pub use actuate::{Actuate, ActuateError, OnInvalid, OutputConfig, OutputSpan};
pub use ads1115::{Ads1115, Ads1115Config, Ads1115Error, Gain, Inputs, Rate};
#[cfg(feature = "micromath")]
pub use flow::{FlowConfig, NegativePressure, SquareRootFlow, fast_sqrt};
pub use mcp320x::{Mcp320xError, Mcp3201, Mcp3204};
pub use mcp4725::Mcp4725;
pub use number::Number;
pub use pwm::Pwm;
pub use schedule::{GainSchedule, OperatingPoint};
pub use sense::{Monitored, Reading, Sense};
pub use span::{CountSpan, SpanConfig};
pub use time_proportioned::{TimeProportioned, TimeProportionedConfig};
