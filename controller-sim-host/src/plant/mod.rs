//! Plants: linear ones, simulated exactly (state space, dead time, inputs that are held or ramp), and non-linear ones, by
//! an integrator.

mod dense;
mod linear;
mod nonlinear;
mod state_space;

pub use linear::{Input, LinearPlant, Wave};
pub(crate) use nonlinear::CONDITIONS;
pub use nonlinear::{Heater, Integrator, Nonlinear, Stuck, TOLERANCE, TankLoad, TwoTank};
pub use state_space::StateSpace;
