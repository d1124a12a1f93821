//! Tuning rules, each a small type with its source, its validity and its warnings.
//!
//! From the characteristic areas of a process, for any self-regulating plant:
//!
//! * [`momi`]: PID for set-points, by the magnitude optimum.
//! * [`drmo`]: PID for disturbances, by the magnitude optimum.
//! * [`de_momi`]: MOMI with a disturbance estimator; [`reduction`] gives its model.
//! * [`noise_limit`]: what the controllers make of measurement noise, and filters for a wanted noise gain.

pub mod de_momi;
pub mod drmo;
mod magnitude_optimum;
pub mod momi;
pub mod noise_limit;
pub mod reduction;

#[cfg(feature = "std")]
pub mod pi_ms;
mod observer;
#[cfg(feature = "std")]
mod pi_ms;

#[cfg(feature = "std")]
pub use observer::ObserverDesign;
#[cfg(feature = "std")]
pub use pi_ms::PiMs;
