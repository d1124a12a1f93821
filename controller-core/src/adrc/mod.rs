//! Second-order active disturbance rejection control (ADRC): a linear extended state observer and a state feedback.
//!
//! The plant is taken for `y'' = b0*(u + d)`, where `d` is everything that this leaves out: disturbances, lags, friction,
//! a wrong `b0`. The observer estimates `y`, `y'` and `d`; the feedback cancels `d` and places two poles:
//!
//! ```text
//! z1' = z2 + beta1*(y - z1)
//! z2' = z3 + b0*u + beta2*(y - z1)          z3 = b0*d
//! z3' = beta3*(y - z1)
//! u   = (kp*(r - z1) - kd*z2 - z3)/b0
//! ```
//!
//! Source: figure 13 and table 7 of Vrančić & Huba 2021. `1/b0`, there `K_C`, is never a parameter of its own: a `K_C`
//! that is not exactly `1/b0` leaves an offset.

mod config;
mod law;
mod poles;

pub use config::AdrcConfig;
pub use law::{Adrc, AdrcCoefficients, AdrcInput, AdrcOutput, AdrcState};
