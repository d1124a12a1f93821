//! The plant of a loop, linear or not.

use super::closed_loop::{ClosedLoop, SubStep};
use super::nonlinear_loop::NonlinearLoop;
use crate::scenario::{Scenario, Signal};

/// What the output of a controller drives.
#[derive(Debug, Clone)]
pub(super) enum PlantSide {
    Linear(Box<ClosedLoop>),
    Nonlinear(Box<NonlinearLoop>),
}

impl PlantSide {
    /// The plant of `scenario` at rest, and the output that holds it there; `None` when nothing does.
    pub(super) fn new(scenario: &Scenario, disturbances: &[(f64, Signal)]) -> Option<(Self, f64)> {
        let Scenario { ts, latency, substeps, initial, .. } = *scenario;
        let rest = (initial.setpoint, initial.disturbance);
        match scenario.nonlinear {
            None => ClosedLoop::new(&scenario.plant, ts, latency, substeps, rest, disturbances)
                .map(|(plant, u0)| (Self::Linear(Box::new(plant)), u0)),
            Some(plant) => NonlinearLoop::new(plant, ts, latency, substeps, rest, disturbances)
                .map(|(plant, u0)| (Self::Nonlinear(Box::new(plant)), u0)),
        }
    }

    /// The measurement of this sample \[y\].
    #[inline]
    pub(super) fn measure(&self) -> f64 {
        match self {
            Self::Linear(plant) => plant.measure(),
            Self::Nonlinear(plant) => plant.measure(),
        }
    }

    /// Time of this sample \[s\].
    #[inline]
    pub(super) fn time(&self) -> f64 {
        match self {
            Self::Linear(plant) => plant.time(),
            Self::Nonlinear(plant) => plant.time(),
        }
    }

    /// Applies `u` \[u\] and moves to the next sample; `each` sees the output between the samples.
    #[inline]
    pub(super) fn hold(&mut self, u: f64, each: impl FnMut(SubStep)) {
        match self {
            Self::Linear(plant) => plant.hold(u, each),
            Self::Nonlinear(plant) => plant.hold(u, each),
        }
    }

    /// When a non-linear plant could not be integrated any further \[s\].
    pub(super) fn stuck(&self) -> Option<f64> {
        match self {
            Self::Linear(_) => None,
            Self::Nonlinear(plant) => plant.stuck(),
        }
    }

    /// What the plant itself has to say of the run.
    pub(super) fn remarks(&self) -> Vec<String> {
        match self {
            Self::Linear(_) => Vec::new(),
            Self::Nonlinear(plant) => plant.remarks(),
        }
    }
}
