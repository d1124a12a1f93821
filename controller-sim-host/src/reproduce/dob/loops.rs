//! The loops of the paper: plants, PI controllers, observers, and what they give.

use super::super::bench::{Stop, plant};
use controller_core::{ObserverConfig, PidConfig};
use controller_design::margins::ContinuousLoop;
use controller_design::model::TransferFunction;
use controller_design::response::{ContinuousResponse, Indices, Load};
use controller_design::rules::PiMs;

/// The three plants of section 4 with their names in tables 3 and 4.
pub(in super::super) const PLANTS: [(&str, &str); 3] =
    [("0.05", "exp(-5*s)/(1+95*s)"), ("0.2", "exp(-20*s)/(1+80*s)"), ("0.9", "exp(-90*s)/(1+10*s)")];
/// `T + tau` of all of them \[s\].
pub(in super::super) const SUM: f64 = 100.0;
/// The tank, eq. (48).
pub(in super::super) const TANK: &str = "1.98*exp(-3.2*s)/(1+80.3*s)";
/// `alpha/(T + tau)` of every experiment.
pub(in super::super) const PARTS: [f64; 3] = [1.0, 0.1, 0.01];

/// A PI as the paper writes it.
pub(in super::super) fn pi(kp: f64, ti: f64) -> PidConfig {
    PidConfig { kp, ki: kp / ti, ..PidConfig::default() }
}

/// A plant with a PI.
#[derive(Debug, Clone)]
pub(in super::super) struct Loop {
    pub(in super::super) plant: TransferFunction,
    pub(in super::super) pid: PidConfig,
}

/// Indices with an observer over those without.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Ratios {
    pub(in super::super) iae: f64,
    pub(in super::super) ise: f64,
    pub(in super::super) itae: f64,
    pub(in super::super) e_max: f64,
    pub(in super::super) tv: f64,
}

impl Loop {
    pub(in super::super) fn new(text: &str, pid: PidConfig) -> Result<Self, Stop> {
        Ok(Self { plant: plant(text)?, pid })
    }

    /// With the largest `ki` at a sensitivity peak.
    pub(in super::super) fn optimal(text: &str, ms: f64) -> Result<Self, Stop> {
        Self::of_plant(plant(text)?, ms)
    }

    /// The same for a plant that was read already.
    pub(in super::super) fn of_plant(plant: TransferFunction, ms: f64) -> Result<Self, Stop> {
        let pid = PiMs::new(&plant, ms)?.pid;
        Ok(Self { plant, pid })
    }

    /// With the largest `ki` at a sensitivity peak for a given `kp`.
    pub(in super::super) fn on_curve(text: &str, kp: f64, ms: f64) -> Result<Self, Stop> {
        let mut one = Self::optimal(text, ms)?;
        let (mut lo, mut hi) = (0.0, 2.0 * one.pid.ki);
        for _ in 0..50 {
            let ki = 0.5 * (lo + hi);
            let pid = PidConfig { kp, ki, ..one.pid };
            // A loop that is not stable is beyond every peak.
            let peak = ContinuousLoop::new(&one.plant, &pid).margins().map_or(f64::INFINITY, |m| m.ms);
            if peak <= ms { lo = ki } else { hi = ki }
        }
        one.pid = PidConfig { kp, ki: lo, ..one.pid };
        Ok(one)
    }

    /// Indices of a unit step of the load.
    pub(in super::super) fn indices(&self, alpha: Option<f64>) -> Result<Indices, Stop> {
        let response = match alpha {
            Some(alpha) => ContinuousResponse::with_alpha(&self.plant, &self.pid, alpha)?,
            None => ContinuousResponse::new(&self.plant, &self.pid, None)?,
        };
        Ok(response.indices(Load::Step)?)
    }

    pub(in super::super) fn ratios(&self, alpha: f64) -> Result<Ratios, Stop> {
        self.ratios_to(&self.indices(None)?, alpha)
    }

    /// The ratios to indices that are known already.
    pub(in super::super) fn ratios_to(&self, base: &Indices, alpha: f64) -> Result<Ratios, Stop> {
        let with = self.indices(Some(alpha))?;
        Ok(Ratios {
            iae: with.iae / base.iae,
            ise: with.ise / base.ise,
            itae: with.itae / base.itae,
            e_max: with.e_max / base.e_max,
            tv: with.tv / base.tv,
        })
    }

    /// The loop in frequency.
    pub(in super::super) fn frequency(&self, alpha: Option<f64>) -> Result<ContinuousLoop, Stop> {
        let one = ContinuousLoop::new(&self.plant, &self.pid);
        Ok(match alpha {
            Some(alpha) => one.with_observer(&self.observer(alpha)?)?,
            None => one,
        })
    }

    /// An observer for the plant itself.
    pub(in super::super) fn observer(&self, alpha: f64) -> Result<ObserverConfig, Stop> {
        Ok(ObserverConfig { model: self.plant.to_plant_model()?, alpha, order: None })
    }

    /// The sensitivity peak.
    pub(in super::super) fn ms(&self, alpha: Option<f64>) -> Result<f64, Stop> {
        Ok(self.frequency(alpha)?.margins()?.ms)
    }

    /// The gain for fast noise over that without observer.
    pub(in super::super) fn noise_ratio(&self, alpha: f64) -> Result<f64, Stop> {
        Ok(self.frequency(Some(alpha))?.noise_gain() / self.frequency(None)?.noise_gain())
    }
}
