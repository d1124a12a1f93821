//! Rules that are written for a simple model, and the model that each is given.

use core::cell::Cell;

use super::build::Job;
use super::{Filter, Law, RuleModel};
use crate::margins::{ContinuousLoop, TOO_LONG};
use crate::model::{Fopdt, HalfRule, Ipdt, Keep, TransferFunction, half_rule};
use crate::rules::adrc::AdrcDesign;
use crate::rules::ah::{AhMs, AhPid};
use crate::rules::amigo::Amigo;
use crate::rules::reduction::Reduced;
use crate::rules::simc::Simc;
use crate::{Refusal, Warning};
use controller_core::{AdrcConfig, PidConfig};

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

impl Job<'_> {
    pub(super) fn kappa_tau(&mut self) -> Result<Law, Refusal> {
        let ms = match self.request.ms {
            None => AhMs::Ms14,
            Some(ms) if (ms - 1.4).abs() < 1e-9 => AhMs::Ms14,
            Some(ms) if (ms - 2.0).abs() < 1e-9 => AhMs::Ms20,
            Some(ms) => return Err(Refusal::OutOfRange { parameter: "ms", value: ms, min: 1.4, max: 2.0 }),
        };
        let made = AhPid::of_plant(&self.delayed, ms)?;
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        Ok(self.filtered(made.pid))
    }

    pub(super) fn amigo(&mut self) -> Result<Law, Refusal> {
        let made = if self.delayed.integrators() > 0 {
            match half_rule(&self.delayed, Keep::One, 0.0)? {
                HalfRule::Integrating(model) => {
                    self.integrating(&model);
                    Amigo::integrating_pid(model.gain, model.dead_time)?
                }
                _ => return Err(NOT_INTEGRATING),
            }
        } else {
            let model = Fopdt::from_areas(&self.delayed)?;
            self.first_order(&model);
            Amigo::pid(model.gain, model.tau, model.dead_time)?
        };
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        Ok(self.filtered(made.pid))
    }

    pub(super) fn simc(&mut self) -> Result<Law, Refusal> {
        let model = half_rule(&self.delayed, Keep::Two, 0.0)?;
        let tau_c = self.request.tau_c;
        let dead_time = match model {
            HalfRule::First(model) => model.dead_time,
            HalfRule::Second(model) => model.dead_time,
            HalfRule::Integrating(model) | HalfRule::IntegratingLag(model, _) => model.dead_time,
        };
        if tau_c.is_none() && dead_time == 0.0 {
            return Err(Refusal::Plant {
                must: "have a dead time, which is the rule's choice for the time constant tau_c of the closed loop",
                help: "give tau_c, the time constant that the closed loop shall have",
            });
        }
        let made = match model {
            HalfRule::First(model) => {
                self.first_order(&model);
                Simc::pi(model.gain, model.tau, model.dead_time, tau_c)
            }
            HalfRule::Second(model) => {
                let (gain, dead_time) = (model.gain, model.dead_time);
                self.made.model =
                    Some(RuleModel { gain, integrators: 0, a1: model.a1, a2: model.a2, dead_time });
                // The half rule keeps real lags.
                let (slow, fast) = model.time_constants().unwrap_or((model.a1, 0.0));
                Simc::pid(gain, slow, fast, dead_time, tau_c)
            }
            HalfRule::Integrating(model) => {
                self.integrating(&model);
                Simc::integrating_pi(model.gain, model.dead_time, tau_c)
            }
            HalfRule::IntegratingLag(model, tau) => {
                let (gain, dead_time) = (model.gain, model.dead_time);
                self.made.model = Some(RuleModel { gain, integrators: 1, a1: tau, a2: 0.0, dead_time });
                Simc::integrating_pid(gain, tau, dead_time, tau_c)
            }
        }?;
        made.warnings.iter().for_each(|warning| self.warn(*warning));
        Ok(self.filtered(made.pid))
    }

    /// Second-order ADRC for the plant's second-order model: `b0` is the gain of that at high frequencies, the bandwidth
    /// the largest whose loop keeps the maximum sensitivity.
    pub(super) fn adrc(&mut self) -> Result<Law, Refusal> {
        let (b0, speed) = self.high_frequency_gain()?;
        let most = self.request.ms.unwrap_or(ADRC_MS);
        if !(most > 1.0 && most <= 100.0) {
            return Err(Refusal::OutOfRange { parameter: "ms", value: most, min: 1.0, max: 100.0 });
        }
        let points = Cell::new(0);
        let within = |omega: f64| {
            let config = config(b0, omega).ok()?;
            let found = ContinuousLoop::of_adrc(&self.delayed, &config).ok()?.ms();
            // A faster one is no easier to follow.
            points.set(if found == Err(TOO_LONG) { usize::MAX } else { points.get() });
            let (ms, many) = found.ok()?;
            points.set(points.get().saturating_add(many));
            (ms <= most).then_some(config)
        };
        let mut best = None;
        let mut omega = SLOWEST * speed;
        for _ in 0..STEPS {
            // A law whose poles are beyond the sampling is none.
            if omega * self.request.ts > FASTEST {
                let text = "held back by the sampling period";
                self.warn(Warning::Value { about: "omega_c", value: omega, text });
                break;
            }
            match within(omega) {
                Some(faster) => best = Some(faster),
                // The first bandwidths may be too slow for a plant that integrates or is far from the model.
                None if best.is_none() => {}
                None => break,
            }
            if points.get() > MOST_POINTS {
                return Err(Refusal::NoSolution {
                    why: "the dead time is too long against the lags to search for a bandwidth",
                    help: "use a rule that models the dead time: momi, de-momi, pi-ms",
                });
            }
            omega *= STEP;
        }
        let Some(best) = best else {
            return Err(Refusal::NoSolution {
                why: "no bandwidth of an ADRC keeps the maximum sensitivity on this plant",
                help: "raise ms, or use a rule that models the dead time: momi, de-momi, pi-ms",
            });
        };
        Ok(Law::Adrc(best))
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

    fn first_order(&mut self, model: &Fopdt) {
        let Fopdt { gain, tau, dead_time } = *model;
        self.made.model = Some(RuleModel { gain, integrators: 0, a1: tau, a2: 0.0, dead_time });
    }

    fn integrating(&mut self, model: &Ipdt) {
        let Ipdt { gain, dead_time } = *model;
        self.made.model = Some(RuleModel { gain, integrators: 1, a1: 0.0, a2: 0.0, dead_time });
    }

    /// The PID with the filter that was asked for, or at least one that can be sampled.
    fn filtered(&mut self, mut pid: PidConfig) -> Law {
        if let Filter::Time(tf) = self.request.filter {
            pid.tf = tf;
        } else if pid.kd != 0.0 && pid.tf < self.request.ts {
            pid.tf = self.request.ts;
            let text = "raised to the sampling period: the rule's filter is faster than that";
            self.warn(Warning::Value { about: "tf", value: pid.tf, text });
        }
        super::build::plain(pid)
    }
}

const NOT_INTEGRATING: Refusal = Refusal::Plant {
    must: "be close to an integrator with at most one lag",
    help: "use a rule that takes the plant as it is, such as pi-ms",
};

const FIRST_ORDER: Refusal = Refusal::Plant {
    must: "be of second order at least, or have a dead time",
    help: "a PI is enough for a first-order plant: choose its kp = tau/(gain*t), ki = 1/(gain*t) for a response time t",
};

fn config(b0: f64, omega_c: f64) -> Result<AdrcConfig, Refusal> {
    let AdrcDesign { b0, kp, kd, beta1, beta2, beta3, .. } = AdrcDesign::new(b0, omega_c, 4.0 * omega_c)?;
    Ok(AdrcConfig { b0, kp, kd, beta1, beta2, beta3 })
}

/// The model of a rule as a transfer function.
impl RuleModel {
    /// `gain*exp(-dead_time*s)/(s^integrators*(1 + a1*s + a2*s^2))`; `None` for one that is out of range.
    #[must_use]
    pub fn transfer_function(&self) -> Option<TransferFunction> {
        let Self { gain, integrators, a1, a2, dead_time } = *self;
        let den = match integrators {
            0 => crate::model::Polynomial::new([1.0, a1, a2]),
            _ => crate::model::Polynomial::new([0.0, 1.0, a1, a2]),
        };
        TransferFunction::from_polynomials(&crate::model::Polynomial::constant(gain), &den, dead_time).ok()
    }
}
