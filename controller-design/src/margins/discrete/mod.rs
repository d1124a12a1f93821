//! Margins of the loop that will run: the discrete laws themselves, the hold, dead time and latency with their fractions.
//!
//! For the plant input broken, with `G_d` the [hold equivalent](crate::hold), `C` the PID and `C_u`, `C_y` the
//! compensator's two paths, all at `z = exp(j*theta)`, `theta = w*ts` up to the Nyquist frequency `pi`:
//!
//! ```text
//! L = G_d*(C - C_y)/(1 - C_u),   S = (1 - C_u)/F,   T = G_d*(C - C_y)/F,   F = 1 - C_u + G_d*(C - C_y)
//! ```
//!
//! The zeros of `F` are the closed loop's poles.

mod delay;
mod extremes;
mod jitter;
mod law;
mod noise;
mod owned;
mod sampled;
mod sweep;

pub use law::DiscreteLaw;
pub use noise::NoiseGains;
pub(crate) use sampled::TOO_MANY_TURNS;
pub use sampled::{DiscreteLoop, LoopResponse};
