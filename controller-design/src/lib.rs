//! Design side of the controller library: plant models on paper, before anything runs.
//!
//! All of it computes in `f64`. The run-time blocks live in `controller_core`; this crate only produces what
//! they are configured with. Transcendental functions come from `libm`, so that a design has the same bits on
//! every machine.
//!
//! * [`model`]: plants written as expressions, such as `1.98*exp(-3.2*s)/(1+80.3*s)`, their polynomials,
//!   poles, zeros and factors.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod model;
