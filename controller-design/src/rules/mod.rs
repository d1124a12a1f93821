//! Tuning rules, each a small type with its source, its validity and its warnings.
//!
//! From the characteristic areas of a process, for any self-regulating plant:
//!
//! * [`momi`]: PID for set-points, by the magnitude optimum.
//! * [`drmo`]: PID for disturbances, by the magnitude optimum.
//! * [`de_momi`]: MOMI with a disturbance estimator; [`reduction`] gives its model.
//! * [`noise_limit`]: what the controllers make of measurement noise, and filters for a wanted noise gain.
//!
//! From a first-order, second-order or integrating model with dead time:
//!
//! * [`fits`]: fits to the PI with the least IAE after a load step.
//! * [`ah`]: the kappa-tau PID; `inflexion` (with `std`) gives its apparent dead time.
//! * [`amigo`], [`simc`]: the rules that are most used today.
//! * [`adrc`]: second-order active disturbance rejection.
//!
//! From the plant itself (feature `std`):
//!
//! * `pi_ms`: the PI of the largest integral gain within a maximum sensitivity.
//! * `pi_iae`: the PI with the least IAE after a step of the load, by optimisation.
//! * `observer`: the disturbance observer beside a PI.
//! * `observer_indices`: the time constant of that observer for a wanted index.

pub mod adrc;
pub mod ah;
pub mod amigo;
mod checks;
pub mod de_momi;
pub mod drmo;
pub mod fits;
#[cfg(feature = "std")]
pub mod inflexion;
mod magnitude_optimum;
pub mod momi;
pub mod noise_limit;
#[cfg(feature = "std")]
pub mod observer;
#[cfg(feature = "std")]
pub mod observer_indices;
#[cfg(feature = "std")]
pub mod pi_iae;
#[cfg(feature = "std")]
pub mod pi_ms;
pub mod reduction;
pub mod simc;

#[cfg(feature = "std")]
pub use observer::ObserverDesign;
#[cfg(feature = "std")]
pub use observer_indices::{Wish, alpha_for};
#[cfg(feature = "std")]
pub use pi_iae::PiIae;
#[cfg(feature = "std")]
pub use pi_ms::PiMs;
