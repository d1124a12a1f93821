//! First order or integrator with a dead time of 1, and the optimal PI.

use super::super::bench::{Bench, Stop};
use controller_core::PidConfig;
use controller_design::model::TransferFunction;
use controller_design::response::{ContinuousResponse, Load};
use controller_design::rules::PiIae;
use rayon::prelude::*;

/// `theta/tau` of the processes that are shown, and `None` for the integrator.
pub(super) const SHOWN: [Option<f64>; 9] =
    [Some(0.05), Some(0.1), Some(0.2), Some(0.41), Some(0.84), Some(1.0), Some(1.7), Some(3.0), None];
/// Those from 0.1 to 3, which the rules were fitted to and the ranges are of.
pub(super) const RANGE: [f64; 16] =
    [0.1, 0.15, 0.2, 0.3, 0.41, 0.5, 0.6, 0.7, 0.84, 1.0, 1.25, 1.5, 1.7, 2.0, 2.5, 3.0];

/// A process with its optimal PI.
#[derive(Debug, Clone)]
pub(in super::super) struct Optimum {
    /// `theta/tau`; `None`: the integrator.
    pub(in super::super) r: Option<f64>,
    pub(in super::super) plant: TransferFunction,
    pub(in super::super) pid: PidConfig,
    pub(in super::super) iae: f64,
}

impl Optimum {
    pub(in super::super) fn new(r: Option<f64>) -> Result<Self, Stop> {
        let plant = match r {
            Some(r) => TransferFunction::first_order(1.0, 1.0 / r, 1.0)?,
            None => TransferFunction::integrating(1.0, 1.0)?,
        };
        let design = PiIae::new(&plant)?;
        Ok(Self { r, plant, pid: design.pid, iae: design.iae })
    }

    /// Several, side by side.
    pub(in super::super) fn of(bench: &Bench<'_>, list: &[Option<f64>]) -> Result<Vec<Self>, Stop> {
        let one = |r: &Option<f64>| {
            bench.check()?;
            Self::new(*r)
        };
        list.par_iter().map(one).collect()
    }

    pub(super) fn row(&self) -> String {
        self.r.map_or_else(|| "IPDT".to_owned(), |r| format!("r = {r}"))
    }

    /// Integral time in units of the time constant, of the dead time for the integrator.
    pub(super) fn ti(&self) -> f64 {
        self.pid.kp / self.pid.ki * self.r.unwrap_or(1.0)
    }

    /// The IAE of another PI on this process.
    pub(super) fn iae_of(&self, pid: &PidConfig) -> Result<f64, Stop> {
        Ok(ContinuousResponse::new(&self.plant, pid, None)?.indices(Load::Step)?.iae)
    }
}
