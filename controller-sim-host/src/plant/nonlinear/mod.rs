//! Plants that are not linear: their equations, where they rest, and their linear model there.

mod heater;
mod integrate;
mod two_tank;

pub use heater::Heater;
pub use integrate::{Integrator, Stuck, TOLERANCE};
pub use two_tank::{TankLoad, TwoTank};

use crate::scenario::show_short;
use controller_design::model::TransferFunction;

/// Most conditions of a plant that a person should hear of: something is at its end, or takes less than it is told.
pub(crate) const CONDITIONS: usize = 5;

/// The states of a non-linear plant.
pub(crate) type State = [f64; 2];

/// A plant that is not linear. Its dead time is at the input, as that of a linear plant, and is the caller's business.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nonlinear {
    /// A pump, a tank, a drain with a valve, a feed tank.
    TwoTank(TwoTank),
    /// A heater with other lags or gains one way than the other.
    Heater(Heater),
}

impl Nonlinear {
    /// From the actuator to where it acts \[s\].
    #[must_use]
    pub fn dead_time(&self) -> f64 {
        match self {
            Self::TwoTank(tank) => tank.dead_time,
            Self::Heater(heater) => heater.dead_time,
        }
    }

    /// Whether a disturbance adds to the plant's input, before the dead time, as it does for a linear plant.
    #[must_use]
    pub fn is_disturbed_at_input(&self) -> bool {
        match self {
            Self::TwoTank(tank) => tank.load == TankLoad::Input,
            Self::Heater(_) => true,
        }
    }

    /// The states and the output of the actuator \[u\] for which the plant rests at `y0` under the disturbance `d0`; `None`
    /// when nothing holds it there.
    #[must_use]
    pub fn rest(&self, y0: f64, d0: f64) -> Option<([f64; 2], f64)> {
        match self {
            Self::TwoTank(tank) => tank.rest(y0, d0),
            Self::Heater(heater) => heater.rest(y0, d0),
        }
    }

    /// The measurements at which it can rest under the disturbance `d0`, lowest and highest \[y\]; `None`: there is none.
    #[must_use]
    pub fn range(&self, d0: f64) -> Option<[f64; 2]> {
        match self {
            Self::TwoTank(tank) => tank.range(d0),
            Self::Heater(heater) => Some(heater.range()),
        }
    }

    /// The linear model, from `u` to `y`, for small changes about the rest at `y0` under the disturbance `d0`; `None` where
    /// there is no such rest, or no gain.
    #[must_use]
    pub fn linear_model(&self, y0: f64, d0: f64) -> Option<TransferFunction> {
        match self {
            Self::TwoTank(tank) => tank.linear_model(y0, d0),
            Self::Heater(heater) => heater.linear_model(y0, d0),
        }
    }

    /// The shortest time constant that it can have \[s\]: what a step of the integrator has to go by.
    #[must_use]
    pub fn shortest_lag(&self) -> f64 {
        match self {
            Self::TwoTank(tank) => tank.shortest_lag(),
            Self::Heater(heater) => heater.shortest_lag(),
        }
    }

    /// A change of the states that matters: what absolute tolerances are counted in \[y\].
    #[must_use]
    pub fn scale(&self) -> f64 {
        match self {
            Self::TwoTank(tank) => tank.height,
            Self::Heater(heater) => heater.gain,
        }
    }

    /// Rates of change of the states `x` under the input `u` and the load `d`, whose dead time is over; a disturbance at
    /// the input is part of `u` already.
    #[must_use]
    pub fn derivative(&self, x: &[f64; 2], u: f64, d: f64) -> [f64; 2] {
        match self {
            Self::TwoTank(tank) => [tank.rise(x[0], u, d), 0.0],
            Self::Heater(heater) => heater.rates(x, u),
        }
    }

    /// The states, back within what is physically possible: a step ends a rounding beyond a limit.
    #[must_use]
    pub fn within(&self, x: [f64; 2]) -> [f64; 2] {
        match self {
            Self::TwoTank(tank) => [x[0].clamp(0.0, tank.top()), x[1]],
            Self::Heater(_) => x,
        }
    }

    /// What is measured \[y\].
    #[must_use]
    pub fn output(&self, x: &[f64; 2]) -> f64 {
        match self {
            Self::TwoTank(_) => x[0],
            Self::Heater(heater) => heater.output(x),
        }
    }

    /// Whether each of its conditions holds in the states `x`, under the inputs of [`derivative`](Self::derivative).
    pub(crate) fn conditions(&self, x: &State, u: f64, d: f64) -> [bool; CONDITIONS] {
        match self {
            Self::TwoTank(tank) => tank.conditions(x[0], u, d),
            Self::Heater(_) => [false; CONDITIONS],
        }
    }

    /// The conditions, each the beginning of a sentence that goes on with "for ... s".
    pub(crate) fn condition_texts(&self) -> [&'static str; CONDITIONS] {
        match self {
            Self::TwoTank(_) => two_tank::CONDITION_TEXTS,
            Self::Heater(_) => [""; CONDITIONS],
        }
    }

    /// Where its linear model at the rest at `y0` holds, as the end of a sentence.
    #[must_use]
    pub fn validity(&self, y0: f64) -> String {
        match self {
            Self::TwoTank(_) => {
                format!("this holds for small changes about the start, at {}", show_short(y0))
            }
            Self::Heater(_) => "this is with the shorter of its lags, and the gain at the start".to_owned(),
        }
    }

    /// Its parameters, each with its unit: as they are called in a scenario.
    #[must_use]
    pub fn parameters(&self) -> Vec<(&'static str, f64, &'static str)> {
        match self {
            Self::TwoTank(tank) => tank.parameters().to_vec(),
            Self::Heater(heater) => heater.parameters().to_vec(),
        }
    }

    /// What it is, for people: a few words.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::TwoTank(_) => "two-tank rig",
            Self::Heater(_) => "asymmetric heater",
        }
    }
}
