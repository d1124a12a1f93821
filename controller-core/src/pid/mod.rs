//! The sampled two-degree-of-freedom PID with one first-order filter over its proportional and derivative terms.
//!
//! Continuous law, eq. (4) of Vrančić & Huba 2021:
//!
//! ```text
//! u = (KI + b*KP*s + c*KD*s^2)/(s*(1+s*TF)) * r  -  (KI + KP*s + KD*s^2)/(s*(1+s*TF)) * y
//!   = KI/s*(r-y) + ((b*KP-KI*TF) + c*KD*s)/(1+s*TF)*r - ((KP-KI*TF) + KD*s)/(1+s*TF)*y
//! ```
//!
//! The second form is the one that runs: the integral stays a plain integral, whose value is a signal of the
//! output's unit, and the filtered rest needs one lag per input.

pub(crate) mod config;
mod conventions;
mod law;

pub use config::{Action, IntegralRule, PidConfig};
pub use conventions::Span;
pub use law::{Pid, PidCoefficients, PidInput, PidOutput, PidState};
