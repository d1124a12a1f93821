//! Design side of the controller library: from a plant model or a recording to parameters, before anything runs.
//!
//! All of it computes in `f64`. The run-time blocks live in `controller_core`; this crate only produces what
//! they are configured with. Transcendental functions come from `libm`, so that a design has the same bits on
//! every machine.
//!
//! Without the feature `std` the crate needs neither an operating system nor a heap; what is left are the closed
//! forms, so that a target can tune itself:
//!
//! * [`areas`]: the characteristic areas of a process, eq. (5) of Vrančić & Huba 2021.
//! * [`rules`]: tuning rules, each a small type with its source, its validity and its warnings.
//!
//! With it (the default):
//!
//! * [`assessment`]: whether a PI loop is tuned for loads, from an experiment of two minutes.
//! * [`model`]: plants written as expressions, such as `1.98*exp(-3.2*s)/(1+80.3*s)`, their polynomials,
//!   poles, zeros and factors.
//! * [`batch134`]: the test processes of Tena et al. 2022.
//! * [`margins`]: sensitivity peaks, gain, phase and delay margins of a design.
//! * [`design`]: one door to all tuning rules, with the margins and noise gains of what they give.
//! * [`hold`]: plants as a sampled controller sees them, exactly.
//! * [`response`]: load responses of continuous loops with dead time, and their indices.
//! * [`identification`]: areas and a model from a recorded change between two steady states.

#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod areas;
#[cfg(feature = "std")]
pub mod assessment;
#[cfg(feature = "std")]
pub mod batch134;
#[cfg(feature = "std")]
pub mod design;
mod double;
#[cfg(feature = "std")]
mod frequency;
#[cfg(feature = "std")]
pub mod hold;
#[cfg(feature = "std")]
pub mod identification;
#[cfg(feature = "std")]
pub mod margins;
#[cfg(feature = "std")]
pub mod model;
pub mod refusal;
#[cfg(feature = "std")]
pub mod response;
pub mod rules;
pub mod warning;

pub use refusal::Refusal;
pub use warning::{Warning, Warnings};
