//! From a request to a design, rule by rule.

use super::calmer::{Judged, calmer};
use super::finish::finish;
use super::robust::within;
use super::{Design, EstimatorFilter, Filter, Law, Method, Noise, ObserverFilter, Request, RuleModel};
use crate::areas::Areas;
use crate::margins::{DiscreteLaw, DiscreteLoop, Margins};
use crate::model::{Sopdt, TransferFunction};
use crate::rules::noise_limit::{self, PidRule, least_kpidn};
use crate::rules::reduction::Reduced;
use crate::rules::{
    PiIae, alpha_for, de_momi::DeMomi, drmo::Drmo, momi::Momi, observer::Choice, observer::ObserverDesign,
    pi_ms::PiMs,
};
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};
use controller_core::{EstimatorConfig, ObserverConfig, PidConfig};
use core::cell::RefCell;

/// Default maximum sensitivity of rules that are given one.
const DEFAULT_MS: f64 = 1.4;
/// Default noise gain in units of `1/|K|`.
const DEFAULT_NOISE_GAIN: f64 = 4.0;
/// How far above the least attainable noise gain the default stays.
const ABOVE_LEAST: f64 = 1.05;
/// Default limit of the noise ratio of an observer.
const DEFAULT_NOISE_RATIO: f64 = 4.0;
/// Default limit of the maximum sensitivity with an observer whose noise ratio is chosen.
const DEFAULT_MS_MAX: f64 = 2.0;

/// Noise ratio below which an observer hardly does anything.
const IDLE_RATIO: f64 = 1.05;

/// Steps by which an observer's filter is slowed down.
const SLOWER: f64 = 1.05;
const SLOWER_STEPS: usize = 120;

/// Designs a controller for `plant`.
///
/// The rules see the plant with the latency of the request as additional dead time; the models of compensators do not
/// contain it: the blocks add it themselves.
///
/// # Errors
/// What the rule refuses; a parameter of the request out of its range; a loop that is not stable.
pub fn design(plant: &TransferFunction, request: &Request) -> Result<Design, Refusal> {
    design_with_areas(plant, None, request)
}

/// [`design`] with areas that were measured: rules that use areas take these instead of those of `plant`, which stays
/// the model for everything else.
///
/// # Errors
/// As for [`design`].
pub fn design_with_areas(
    plant: &TransferFunction,
    measured: Option<&Areas>,
    request: &Request,
) -> Result<Design, Refusal> {
    Setting { plant, measured, shared: &Shared::default() }.design(request)
}

/// A PI of `pi-ms`, or why there is none, by latency and `Ms`.
type KnownPi = ([f64; 2], Result<PiMs, Refusal>);

/// What designs for one plant have in common.
#[derive(Debug, Default)]
pub(super) struct Shared {
    pis: RefCell<Vec<KnownPi>>,
}

/// For what is designed.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) plant: &'a TransferFunction,
    pub(super) measured: Option<&'a Areas>,
    pub(super) shared: &'a Shared,
}

impl Setting<'_> {
    /// The design with everything that is said of it.
    pub(super) fn design(self, request: &Request) -> Result<Design, Refusal> {
        self.within_reason(request, |delayed, request, law, made| {
            finish(self.plant, delayed, request, law, made)
        })
    }

    /// By the request as it is, or calmer; `finish` judges the loop behind the latency.
    pub(super) fn within_reason<T: Judged>(
        self,
        request: &Request,
        finish: impl Fn(&TransferFunction, &Request, Law, Made) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        check("ts", request.ts, f64::MIN_POSITIVE, 1e9)?;
        check("latency", request.latency, 0.0, 1e12)?;
        let usual = DEFAULT_NOISE_GAIN / self.measured.map_or(self.plant.gain(), |areas| areas.of(0)).abs();
        let once = |request: &Request| {
            let delayed = late(self.plant, request.latency)?;
            let mut job = Job { setting: self, delayed, request, made: Made::default() };
            let law = job.law()?;
            let Job { delayed, made, .. } = job;
            finish(&delayed, request, law, made)
        };
        once(request).or_else(|refusal| calmer(request, usual, &refusal, once).ok_or(refusal))
    }
}

/// What a rule leaves behind besides the law.
#[derive(Default)]
pub(super) struct Made {
    pub(super) areas: Option<Areas>,
    pub(super) model: Option<RuleModel>,
    pub(super) noise: Noise,
    pub(super) iae_load: Option<f64>,
    /// Margins of the continuous loop, when the rule has them already.
    pub(super) margins: Option<Margins>,
    pub(super) warnings: Warnings,
}

impl Made {
    pub(super) fn note(&mut self, warning: Warning) {
        warn(&mut self.warnings, warning);
    }
}

pub(super) struct Job<'a> {
    setting: Setting<'a>,
    /// The plant behind the latency.
    pub(super) delayed: TransferFunction,
    pub(super) request: &'a Request,
    pub(super) made: Made,
}

impl Job<'_> {
    fn law(&mut self) -> Result<Law, Refusal> {
        match self.request.method {
            Method::Momi => self.by_areas(PidRule::Momi),
            Method::Drmo => self.by_areas(PidRule::Drmo),
            Method::DeMomi => self.with_estimator(),
            Method::PiMs => self.within_ms().map(plain),
            Method::Dob => self.with_observer(),
            Method::PiIae => self.least_iae(),
            Method::Ah => self.kappa_tau(),
            Method::Adrc => self.adrc(),
            Method::Amigo => self.amigo(),
            Method::Simc => self.simc(),
        }
    }

    /// The areas that the rules use.
    pub(super) fn areas(&mut self) -> Result<Areas, Refusal> {
        let areas = match self.setting.measured {
            // A delay in front of the process is one in front of its response.
            Some(areas) => areas.delayed(self.request.latency),
            None => self.delayed.areas6()?,
        };
        self.made.areas = Some(areas);
        Ok(areas)
    }

    /// The noise gain that the PID's filter is chosen for; `None`: the filter is given.
    fn noise_gain(&mut self, areas: &Areas, rule: PidRule) -> Option<f64> {
        match self.request.filter {
            Filter::Time(_) => None,
            Filter::NoiseGain(gain) => Some(gain),
            Filter::Default => {
                let usual = DEFAULT_NOISE_GAIN / areas.of(0).abs();
                let least = ABOVE_LEAST * least_kpidn(areas, rule, self.request.ts);
                if least > usual && least.is_finite() {
                    let text = "raised to what is attainable; the usual limit is 4/|K|";
                    self.warn(Warning::Value { about: "kpidn", value: least, text });
                    return Some(least);
                }
                Some(usual)
            }
        }
    }

    fn filter_time(&self) -> f64 {
        if let Filter::Time(tf) = self.request.filter { tf } else { 0.0 }
    }

    fn by_areas(&mut self, rule: PidRule) -> Result<Law, Refusal> {
        let areas = self.areas()?;
        let gain = self.noise_gain(&areas, rule);
        let (tf, ts) = (self.filter_time(), self.request.ts);
        let (pid, warnings) = match (rule, gain) {
            (PidRule::Momi, None) => Momi::new(&areas, tf).map(|m| (m.pid, m.warnings)),
            (PidRule::Momi, Some(k)) => Momi::with_noise_limit(&areas, k, ts).map(|m| (m.pid, m.warnings)),
            (PidRule::Drmo, None) => Drmo::new(&areas, tf).map(|d| (d.pid, d.warnings)),
            (PidRule::Drmo, Some(k)) => Drmo::with_noise_limit(&areas, k, ts).map(|d| (d.pid, d.warnings)),
        }?;
        warnings.into_iter().for_each(|warning| self.warn(warning));
        Ok(plain(pid))
    }

    fn with_estimator(&mut self) -> Result<Law, Refusal> {
        let areas = self.areas()?;
        let ts = self.request.ts;
        let gain = self.noise_gain(&areas, PidRule::Momi);
        let kden = match self.request.estimator_filter {
            EstimatorFilter::Time(_) => None,
            EstimatorFilter::NoiseGain(kden) => Some(kden),
            EstimatorFilter::Default => Some(gain.unwrap_or(DEFAULT_NOISE_GAIN / areas.of(0).abs())),
        };
        let made = match (gain, kden, self.request.estimator_filter) {
            (Some(gain), Some(kden), _) => DeMomi::with_noise_limits(&areas, gain, kden, ts),
            (None, Some(kden), _) => DeMomi::with_estimator_limit(&areas, self.filter_time(), kden, ts),
            (Some(gain), None, EstimatorFilter::Time(tfd)) => {
                DeMomi::new(&areas, Momi::with_noise_limit(&areas, gain, ts)?.pid.tf, tfd)
            }
            (None, None, EstimatorFilter::Time(tfd)) => DeMomi::new(&areas, self.filter_time(), tfd),
            // Without a time constant there is a gain.
            (_, None, _) => {
                return Err(Refusal::OutOfRange {
                    parameter: "kden",
                    value: f64::NAN,
                    min: 0.0,
                    max: f64::MAX,
                });
            }
        }?;
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        let model = &made.model;
        let Reduced { gain, a1, a2, dead_time, .. } = *model;
        self.made.model = Some(RuleModel { gain, integrators: 0, a1, a2, dead_time });
        let Some(mut estimator) = made.estimator else { return Ok(plain(made.pid)) };
        let EstimatorConfig { gain, a1, a2, dead_time, .. } = estimator;
        let slow = Sopdt { gain, a1, a2, dead_time }.without_fast_lag(ts);
        (estimator.a1, estimator.a2, estimator.dead_time) = (slow.a1, slow.a2, slow.dead_time);
        if let Some(most) = self.request.ms_max {
            within(&self.delayed, &made.pid, &mut estimator, model, (most, ts), &mut self.made.warnings)?;
        }
        self.made.noise.kden = Some(noise_limit::kden(model, estimator.kfd, estimator.tfd, ts));
        // The block adds the latency itself.
        if estimator.dead_time >= self.request.latency {
            estimator.dead_time -= self.request.latency;
        } else {
            let text = "longer than the dead time of the model, which it is part of";
            self.warn(Warning::Value { about: "latency", value: self.request.latency, text });
            estimator.dead_time = 0.0;
        }
        Ok(Law::Pid { pid: made.pid, estimator: Some(estimator), observer: None })
    }

    fn within_ms(&mut self) -> Result<PidConfig, Refusal> {
        let key = [self.request.latency, self.request.ms.unwrap_or(DEFAULT_MS)];
        let known = self
            .setting
            .shared
            .pis
            .borrow()
            .iter()
            .find(|(other, _)| *other == key)
            .map(|(_, pi)| pi.clone());
        let made = known.unwrap_or_else(|| {
            let made = PiMs::new(&self.delayed, key[1]);
            self.setting.shared.pis.borrow_mut().push((key, made.clone()));
            made
        })?;
        self.made.margins = Some(made.margins);
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        Ok(made.pid)
    }

    fn with_observer(&mut self) -> Result<Law, Refusal> {
        let pid = self.within_ms()?;
        let most = self.request.ms_max;
        let made = match (self.request.observer_filter, most) {
            (ObserverFilter::Time(alpha), _) => {
                ObserverDesign::beside(&self.delayed, &pid, Choice::Time(alpha))
            }
            (ObserverFilter::Wanted(wish), _) => {
                let alpha = alpha_for(&self.delayed, &pid, wish)?;
                ObserverDesign::beside(&self.delayed, &pid, Choice::Time(alpha))
            }
            (ObserverFilter::NoiseRatio(ratio), None) => {
                ObserverDesign::beside(&self.delayed, &pid, Choice::NoiseRatio(ratio))
            }
            (ObserverFilter::NoiseRatio(ratio), Some(most)) => {
                ObserverDesign::within_ms(&self.delayed, &pid, ratio, most)
            }
            (ObserverFilter::Default, most) => {
                let most = most.unwrap_or(DEFAULT_MS_MAX);
                ObserverDesign::within_ms(&self.delayed, &pid, DEFAULT_NOISE_RATIO, most)
            }
        }?;
        let limit = match self.request.observer_filter {
            ObserverFilter::Default => Some(most.unwrap_or(DEFAULT_MS_MAX)),
            _ => most,
        };
        let alpha = made.observer.alpha;
        let mut told: Warnings = made.warnings.clone();
        let made = match limit {
            Some(limit) => self.slowed(made, &pid, limit)?,
            None => made,
        };
        let ratio = made.an / pid.kp.abs();
        if made.observer.alpha > alpha {
            told = made.warnings.clone();
            let text = "lowered to keep ms_max in the sampled loop, too";
            warn(&mut told, Warning::Value { about: "noise_ratio", value: ratio, text });
            let text = "raised to keep ms_max in the sampled loop, too";
            warn(&mut told, Warning::Value { about: "alpha", value: made.observer.alpha, text });
        }
        if ratio < IDLE_RATIO {
            let text = match self.request.observer_filter {
                ObserverFilter::Time(_) => "the observer hardly does anything: choose a shorter alpha",
                ObserverFilter::NoiseRatio(_) | ObserverFilter::Wanted(_) if limit.is_none() => {
                    "the observer hardly does anything: ask for more of it"
                }
                _ => {
                    "the observer hardly does anything: a smaller ms of the PI or a larger ms_max leaves it room"
                }
            };
            warn(&mut told, Warning::Value { about: "noise_ratio", value: ratio, text });
        }
        told.iter().for_each(|warning| self.warn(*warning));
        self.made.noise.an = Some(made.an);
        self.made.margins = Some(made.margins);
        let mut observer: ObserverConfig = made.observer;
        // The block adds the latency itself.
        observer.model.dead_time = self.setting.plant.dead_time();
        Ok(Law::Pid { pid, estimator: None, observer: Some(observer) })
    }

    /// The observer with the filter slowed down until the sampled loop, too, is within `most`; a filter that was asked for is
    /// kept or refused.
    fn slowed(
        &self,
        mut made: ObserverDesign,
        pid: &PidConfig,
        most: f64,
    ) -> Result<ObserverDesign, Refusal> {
        let sampled = |made: &ObserverDesign| {
            let law = DiscreteLaw::with_compensator(pid, &made.observer.to_compensator(0.0), self.request.ts)
                .ok()?;
            Some(DiscreteLoop::new(&self.delayed, law, 0.0).ok()?.margins().ok()?.ms)
        };
        let ms = |made: &ObserverDesign| made.ms.max(sampled(made).unwrap_or(f64::INFINITY));
        let is_fixed =
            matches!(self.request.observer_filter, ObserverFilter::Time(_) | ObserverFilter::Wanted(_));
        for _ in 0..SLOWER_STEPS {
            let reached = ms(&made);
            if reached <= most {
                return Ok(made);
            }
            if is_fixed {
                return Err(Refusal::Unattainable {
                    what: "ms_max with this filter",
                    asked: most,
                    least: reached,
                });
            }
            made = ObserverDesign::beside(&self.delayed, pid, Choice::Time(SLOWER * made.observer.alpha))?;
        }
        Err(Refusal::Unattainable { what: "ms_max", asked: most, least: ms(&made) })
    }

    fn least_iae(&mut self) -> Result<Law, Refusal> {
        let made = PiIae::new(&self.delayed)?;
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        self.made.iae_load = Some(made.iae);
        Ok(plain(made.pid))
    }

    pub(super) fn warn(&mut self, warning: Warning) {
        self.made.note(warning);
    }
}

/// A PID alone.
pub(super) fn plain(pid: PidConfig) -> Law {
    Law::Pid { pid, estimator: None, observer: None }
}

/// The plant behind a latency.
fn late(plant: &TransferFunction, latency: f64) -> Result<TransferFunction, Refusal> {
    if latency == 0.0 {
        return Ok(plant.clone());
    }
    plant.with_dead_time(plant.dead_time() + latency).map_err(|_| Refusal::OutOfRange {
        parameter: "latency",
        value: latency,
        min: 0.0,
        max: 1e12,
    })
}

fn check(parameter: &'static str, value: f64, min: f64, max: f64) -> Result<(), Refusal> {
    if (min..=max).contains(&value) {
        Ok(())
    } else {
        Err(Refusal::OutOfRange { parameter, value, min, max })
    }
}
