//! A design as JSON; the names are those of the files and of the papers.

use super::json::text;
use crate::design_run::DesignRun;
use controller_core::{AdrcConfig, EstimatorConfig, ObserverConfig, PidConfig};
use controller_design::design::{Design, Law, RuleModel};
use controller_design::margins::{Margins, NoiseGains};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Designed<'a> {
    version: &'static str,
    method: &'static str,
    source: &'static str,
    plant: String,
    ts: f64,
    latency: f64,
    areas: Option<[f64; 6]>,
    filtered_areas: Option<[f64; 6]>,
    pid: Option<Pid>,
    model: Option<Model>,
    estimator: Option<Estimator>,
    observer: Option<Observer>,
    adrc: Option<Adrc>,
    robustness: Robustness,
    noise: Noise,
    discrete: Discrete,
    predicted: Predicted,
    warnings: Vec<String>,
    saved: Option<&'a str>,
}

#[derive(Serialize)]
pub(super) struct Pid {
    kp: f64,
    ki: f64,
    kd: f64,
    tf: f64,
    b: f64,
    c: f64,
}

#[derive(Serialize)]
struct Model {
    gain: f64,
    a1: f64,
    a2: f64,
    dead_time: f64,
    integrators: usize,
}

#[derive(Serialize)]
pub(super) struct Estimator {
    gain: f64,
    a1: f64,
    a2: f64,
    dead_time: f64,
    kfd: f64,
    tfd: f64,
}

#[derive(Serialize)]
pub(super) struct Observer {
    alpha: f64,
    order: Option<usize>,
}

#[derive(Serialize)]
pub(super) struct Adrc {
    b0: f64,
    kp: f64,
    kd: f64,
    beta1: f64,
    beta2: f64,
    beta3: f64,
}

/// Null where a margin cannot be used up.
#[derive(Serialize)]
pub(super) struct Robustness {
    ms: f64,
    mt: f64,
    gm: f64,
    pm_deg: f64,
    delay_margin: f64,
}

/// Of the law that runs.
#[derive(Serialize)]
struct Discrete {
    robustness: Robustness,
    noise: SampledNoise,
}

#[derive(Serialize)]
struct Noise {
    kpidn: Option<f64>,
    kden: Option<f64>,
    an: Option<f64>,
}

#[derive(Serialize)]
pub(super) struct SampledNoise {
    kpidn: f64,
    kden: f64,
    an: f64,
    white: f64,
}

#[derive(Serialize)]
struct Predicted {
    ie_setpoint: Option<f64>,
    ie_load: Option<f64>,
    iae_load: Option<f64>,
    iae_load_continuous: Option<f64>,
}

impl From<&PidConfig> for Pid {
    fn from(pid: &PidConfig) -> Self {
        let [kp, ki, kd] = pid.signed_gains();
        Self { kp, ki, kd, tf: pid.tf, b: pid.b, c: pid.c }
    }
}

impl From<&EstimatorConfig> for Estimator {
    fn from(e: &EstimatorConfig) -> Self {
        Self { gain: e.gain, a1: e.a1, a2: e.a2, dead_time: e.dead_time, kfd: e.kfd, tfd: e.tfd }
    }
}

impl From<&ObserverConfig> for Observer {
    fn from(o: &ObserverConfig) -> Self {
        Self { alpha: o.alpha, order: o.order }
    }
}

impl From<&AdrcConfig> for Adrc {
    fn from(a: &AdrcConfig) -> Self {
        Self { b0: a.b0, kp: a.kp, kd: a.kd, beta1: a.beta1, beta2: a.beta2, beta3: a.beta3 }
    }
}

impl From<&Margins> for Robustness {
    fn from(m: &Margins) -> Self {
        Self { ms: m.ms, mt: m.mt, gm: m.gm, pm_deg: m.pm_deg, delay_margin: m.delay_margin }
    }
}

impl From<&NoiseGains> for SampledNoise {
    fn from(n: &NoiseGains) -> Self {
        Self { kpidn: n.kpidn, kden: n.kden, an: n.step, white: n.white }
    }
}

impl<'a> Designed<'a> {
    /// `iae_load` is of the sampled loop, `more` what its run is to be warned of.
    pub(super) fn new(
        made: &'a Design,
        iae_load: Option<f64>,
        more: &[String],
        saved: Option<&'a str>,
    ) -> Self {
        let (pid, estimator, observer, adrc) = match &made.law {
            Law::Pid { pid, estimator, observer } => (Some(pid), estimator.as_ref(), observer.as_ref(), None),
            Law::Adrc(adrc) => (None, None, None, Some(adrc)),
        };
        Self {
            version: env!("CARGO_PKG_VERSION"),
            method: made.method.name(),
            source: made.method.source(),
            plant: made.plant.to_string(),
            ts: made.ts,
            latency: made.latency,
            areas: made.areas.map(|areas| areas.values()),
            filtered_areas: made.filtered_areas.map(|areas| areas.values()),
            pid: pid.map(Into::into),
            model: made.model.map(|RuleModel { gain, integrators, a1, a2, dead_time }| Model {
                gain,
                a1,
                a2,
                dead_time,
                integrators,
            }),
            estimator: estimator.map(Into::into),
            observer: observer.map(Into::into),
            adrc: adrc.map(Into::into),
            robustness: (&made.robustness).into(),
            noise: Noise { kpidn: made.noise.kpidn, kden: made.noise.kden, an: made.noise.an },
            discrete: Discrete {
                robustness: (&made.sampled.margins).into(),
                noise: (&made.sampled.noise).into(),
            },
            predicted: Predicted {
                ie_setpoint: made.predicted.ie_setpoint,
                ie_load: made.predicted.ie_load,
                iae_load: made.predicted.iae_load.and(iae_load),
                iae_load_continuous: made.predicted.iae_load,
            },
            warnings: made.warnings.iter().map(ToString::to_string).chain(more.iter().cloned()).collect(),
            saved,
        }
    }
}

/// A design, and its run where there was one: see `schema.json`.
#[must_use]
pub fn design_json(made: &Design, run: Option<&DesignRun>, saved: Option<&str>) -> String {
    let more = run.map_or(Vec::new(), DesignRun::notes);
    text(&Designed::new(made, run.map(|run| run.iae_load), &more, saved))
}
