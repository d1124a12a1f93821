//! The plant as the sampled controller sees it: its zero-order-hold equivalent.
//!
//! Between the controller's output `u[k]`, held for a sampling period, and the measurement `y[k]`,
//!
//! ```text
//! G_d(z) = (1 - z^-1) * Z{ G(s)*exp(-s*(dead_time + latency))/s }
//! ```
//!
//! exactly: the dead time and the latency need not be whole numbers of samples, and nothing is approximated.

mod chain;
mod equivalent;
mod numerator;

pub use equivalent::{HoldEquivalent, MAX_DELAY};
pub(crate) use equivalent::{delay_by, minus_one};
