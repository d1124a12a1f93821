//! The six processes of the chapter and what the rules give for them.

use super::super::bench::{Stop, plant};
use controller_core::{EstimatorConfig, PidConfig};
use controller_design::areas::Areas;
use controller_design::model::TransferFunction;
use controller_design::rules::de_momi::DeMomi;
use controller_design::rules::drmo::Drmo;
use controller_design::rules::reduction::Reduced;

/// A process and what is asked of its controllers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Process {
    pub(super) name: &'static str,
    text: &'static str,
    /// Sampling period \[s\].
    pub(super) ts: f64,
    /// Length of each of the two experiments \[s\].
    pub(super) horizon: f64,
    filters: Filters,
}

/// How the filters are chosen.
#[derive(Debug, Clone, Copy)]
enum Filters {
    /// Both time constants are given.
    Given(f64),
    /// Both noise gains are.
    Gain(f64),
}

pub(super) const GP1: Process = Process {
    name: "GP1",
    text: "exp(-0.5*s)/(1+s)^2",
    ts: 0.01,
    horizon: 15.0,
    filters: Filters::Given(0.1),
};
pub(super) const GP2: Process = Process {
    name: "GP2",
    text: "exp(-0.2*s)/(1+s)^3",
    ts: 0.01,
    horizon: 20.0,
    filters: Filters::Given(0.1),
};
pub(super) const GP3: Process = Process {
    name: "GP3",
    text: "exp(-0.2*s)/((1+0.2*s)*(1+s))",
    ts: 0.01,
    horizon: 8.0,
    filters: Filters::Gain(4.0),
};
pub(super) const GP4: Process =
    Process { name: "GP4", text: "exp(-s)/(1+s)^4", ts: 0.01, horizon: 40.0, filters: Filters::Gain(4.0) };
pub(super) const GP5: Process = Process {
    name: "GP5",
    text: "1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))",
    ts: 0.001,
    horizon: 6.0,
    filters: Filters::Gain(20.0),
};
pub(super) const GP6: Process =
    Process { name: "GP6", text: "exp(-5*s)/(1+s)^3", ts: 0.01, horizon: 50.0, filters: Filters::Gain(4.0) };

/// What the rules give.
#[derive(Debug, Clone)]
pub(super) struct Design {
    pub(super) plant: TransferFunction,
    pub(super) areas: Areas,
    pub(super) momi: PidConfig,
    pub(super) drmo: PidConfig,
    pub(super) model: Reduced,
    pub(super) estimator: EstimatorConfig,
}

impl Process {
    pub(super) fn plant(&self) -> Result<TransferFunction, Stop> {
        plant(self.text)
    }

    /// Its areas.
    pub(super) fn areas(&self) -> Result<Areas, Stop> {
        Ok(self.plant()?.areas6()?)
    }

    /// The noise gain that is asked for.
    pub(super) fn noise_gain(&self) -> f64 {
        match self.filters {
            Filters::Gain(gain) => gain,
            Filters::Given(_) => f64::INFINITY,
        }
    }

    pub(super) fn design(&self) -> Result<Design, Stop> {
        let areas = self.areas()?;
        let design = match self.filters {
            Filters::Given(tf) => DeMomi::new(&areas, tf, tf)?,
            Filters::Gain(gain) => DeMomi::with_noise_limits(&areas, gain, gain, self.ts)?,
        };
        let estimator = design.estimator.ok_or_else(|| Stop::Failed("the estimator is off".to_owned()))?;
        Ok(Design {
            plant: self.plant()?,
            areas,
            momi: design.pid,
            // The chapter gives DRMO the filter of MOMI.
            drmo: Drmo::new(&areas, design.pid.tf)?.pid,
            model: design.model,
            estimator,
        })
    }
}
