//! Second-order ADRC for a plant: its gain `b0`, and the largest bandwidth within a maximum sensitivity.

use core::cell::Cell;

use super::build::Job;
use super::models::NOT_INTEGRATING;
use super::{AdrcGain, Law, RuleModel};
use crate::margins::{ContinuousLoop, TOO_LONG};
use crate::model::{HalfRule, Keep, TransferFunction, half_rule};
use crate::rules::adrc::AdrcDesign;
use crate::rules::reduction::Reduced;
use crate::{Refusal, Warning};
use controller_core::AdrcConfig;

/// Default maximum sensitivity of an ADRC.
const ADRC_MS: f64 = 1.6;
/// Bandwidths that are tried, from this share of the plant's own speed on.
const SLOWEST: f64 = 0.05;
const STEP: f64 = 1.1;
const STEPS: usize = 90;
/// Frequencies of all the loops tried from which the search would take many seconds.
const MOST_POINTS: usize = 2_000_000;
/// Largest bandwidth in rad per sample: the observer is four times as fast.
const FASTEST: f64 = 0.2;
/// Steps of the search for `b0`, and how many of them it goes up and down at most.
const GAIN_STEP: f64 = 1.5;
const GAIN_STEPS: i32 = 24;
/// Halvings of the last step of the bandwidth in that search: to 0.3 %.
const HALVINGS: usize = 5;
/// The search for `b0` is over when the integral gain has fallen to this share of the best.
const PASSED: f64 = 0.7;

/// The fastest loop for one `b0`.
struct Fastest {
    config: AdrcConfig,
    omega: f64,
    /// The sampling period holds it back, not the sensitivity.
    is_held: bool,
}

impl Fastest {
    /// In units that are the same for all `b0`: the integral gain is `64/73*omega_c^3/b0` for `omega_o = 4*omega_c`.
    fn integral_gain(&self) -> f64 {
        self.omega * (self.omega * (self.omega / self.config.b0.abs()))
    }
}

/// Loops of bandwidths that are tried.
struct Trials<'a> {
    plant: &'a TransferFunction,
    most: f64,
    ts: f64,
    points: Cell<usize>,
}

impl Trials<'_> {
    fn within(&self, b0: f64, omega: f64) -> Option<AdrcConfig> {
        let config = config(b0, omega).ok()?;
        let found = ContinuousLoop::of_adrc(self.plant, &config).ok()?.ms();
        // A faster one is no easier to follow.
        self.points.set(if found == Err(TOO_LONG) { usize::MAX } else { self.points.get() });
        let (ms, many) = found.ok()?;
        self.points.set(self.points.get().saturating_add(many));
        (ms <= self.most).then_some(config)
    }

    /// The fastest loop for `b0` of bandwidths from `omega` on.
    fn fastest(&self, b0: f64, mut omega: f64) -> Result<Option<Fastest>, Refusal> {
        let mut best: Option<Fastest> = None;
        for _ in 0..STEPS {
            // A law whose poles are beyond the sampling is none.
            if omega * self.ts > FASTEST {
                if let Some(best) = &mut best {
                    best.is_held = true;
                }
                break;
            }
            match self.within(b0, omega) {
                Some(config) => best = Some(Fastest { config, omega, is_held: false }),
                // The first bandwidths may be too slow for a plant that integrates or is far from the model.
                None if best.is_none() => {}
                None => break,
            }
            if self.points.get() > MOST_POINTS {
                return Err(Refusal::NoSolution {
                    why: "the dead time is too long against the lags to search for a bandwidth",
                    help: "use a rule that models the dead time",
                });
            }
            omega *= STEP;
        }
        Ok(best)
    }

    /// The same with the last step halved, so that loops of several `b0` can be compared.
    fn finest(&self, b0: f64, omega: f64) -> Result<Option<Fastest>, Refusal> {
        let Some(mut best) = self.fastest(b0, omega)? else { return Ok(None) };
        let (mut low, mut high) = (best.omega, best.omega * STEP);
        for _ in 0..HALVINGS {
            if best.is_held {
                break;
            }
            let middle = 0.5 * (low + high);
            match self.within(b0, middle) {
                Some(config) => {
                    best = Fastest { config, omega: middle, is_held: false };
                    low = middle;
                }
                None => high = middle,
            }
        }
        Ok(Some(best))
    }

    /// The `b0` around `first` whose fastest loop has the largest integral gain.
    fn best_gain(&self, first: f64, omega: f64) -> Result<Option<Fastest>, Refusal> {
        let mut best: Option<Fastest> = None;
        for step in [GAIN_STEP, 1.0 / GAIN_STEP] {
            let mut b0 = if step > 1.0 { first } else { step * first };
            // A larger b0 makes the loop slower: what was fast enough before is where to begin.
            let mut from = omega;
            for _ in 0..GAIN_STEPS {
                let found = self.finest(b0, from)?;
                b0 *= step;
                let Some(found) = found else {
                    if best.is_some() {
                        break;
                    }
                    continue;
                };
                from = if step > 1.0 { found.omega } else { omega };
                let gain = found.integral_gain();
                let most = best.as_ref().map_or(0.0, Fastest::integral_gain);
                let is_held = found.is_held;
                if gain > most {
                    best = Some(found);
                }
                // Held back by the sampling, a larger b0 only takes gain away.
                if gain < PASSED * most || (is_held && step > 1.0) {
                    break;
                }
            }
        }
        Ok(best)
    }
}

impl Job<'_> {
    /// Second-order ADRC for the plant's second-order model: `b0` is the gain of that at high frequencies unless the request
    /// says otherwise, the bandwidth the largest whose loop keeps the maximum sensitivity.
    pub(super) fn adrc(&mut self) -> Result<Law, Refusal> {
        let most = self.request.ms.unwrap_or(ADRC_MS);
        if !(most > 1.0 && most <= 100.0) {
            return Err(Refusal::OutOfRange { parameter: "ms", value: most, min: 1.0, max: 100.0 });
        }
        let (model, speed) = self.high_frequency_gain()?;
        let plant = self.delayed.clone();
        let trials = Trials { plant: &plant, most, ts: self.request.ts, points: Cell::new(0) };
        let slowest = SLOWEST * speed;
        let best = match self.request.b0 {
            AdrcGain::Model => trials.fastest(model, slowest)?,
            AdrcGain::Value(b0) => {
                if !(b0.is_finite() && b0 * model > 0.0) {
                    let (min, max) =
                        if model > 0.0 { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, 0.0) };
                    return Err(Refusal::OutOfRange { parameter: "b0", value: b0, min, max });
                }
                trials.fastest(b0, slowest)?
            }
            AdrcGain::Search => trials.best_gain(model, slowest)?,
        };
        let Some(best) = best else {
            return Err(Refusal::NoSolution {
                why: "no bandwidth of an ADRC keeps the maximum sensitivity on this plant",
                help: "allow a larger ms or another b0, or use a rule that takes the plant as it is",
            });
        };
        if best.is_held {
            let text = "held back by the sampling period";
            self.warn(Warning::Value { about: "omega_c", value: best.omega, text });
        }
        Ok(Law::Adrc(best.config))
    }

    /// The gain `b0` of a second-order model, and about how fast that is in rad/s.
    fn high_frequency_gain(&mut self) -> Result<(f64, f64), Refusal> {
        if self.delayed.integrators() > 0 {
            let model = half_rule(&self.delayed, Keep::Two, 0.0)?;
            let (model, tau) = match model {
                HalfRule::IntegratingLag(model, tau) => (model, tau),
                HalfRule::Integrating(model) => (model, model.dead_time),
                _ => return Err(NOT_INTEGRATING),
            };
            let (gain, dead_time) = (model.gain, model.dead_time);
            if tau <= 0.0 {
                return Err(FIRST_ORDER);
            }
            self.made.model = Some(RuleModel { gain, integrators: 1, a1: tau, a2: 0.0, dead_time });
            return Ok((gain / tau, 1.0 / (tau + dead_time)));
        }
        let areas = self.areas()?;
        let model = Reduced::new(&areas)?;
        model.warnings.iter().for_each(|warning| self.warn(*warning));
        let Reduced { gain, a1, a2, dead_time, .. } = model;
        self.made.model = Some(RuleModel { gain, integrators: 0, a1, a2, dead_time });
        // A dead time is the second lag of a plant that has one.
        let square = if a2 > 0.0 { a2 } else { a1 * dead_time };
        if square <= 0.0 {
            return Err(FIRST_ORDER);
        }
        Ok((gain / square, 1.0 / (a1 + dead_time)))
    }
}

const FIRST_ORDER: Refusal = Refusal::Plant {
    must: "have a model with two lags, or with one and a dead time, to take b0 from",
    help: "use a rule that needs no such model: for a single lag a PI is enough",
};

fn config(b0: f64, omega_c: f64) -> Result<AdrcConfig, Refusal> {
    let AdrcDesign { b0, kp, kd, beta1, beta2, beta3, .. } = AdrcDesign::new(b0, omega_c, 4.0 * omega_c)?;
    Ok(AdrcConfig { b0, kp, kd, beta1, beta2, beta3 })
}
