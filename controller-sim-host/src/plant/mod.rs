//! Linear plants, simulated exactly: state space, dead time, inputs that are held or ramp.

mod dense;
mod linear;
mod state_space;

pub use linear::{Input, LinearPlant, Wave};
pub use state_space::StateSpace;
