//! Rules that are written for a simple model, and the model that each is given.

use super::build::Job;
use super::{Filter, Law, RuleModel};
use crate::margins::{ContinuousLoop, TOO_LONG};
use crate::model::{Fopdt, HalfRule, Ipdt, Keep, TransferFunction, half_rule};
use crate::rules::ah::{AhMs, AhPid, LOOP_GAIN};
use crate::rules::amigo::Amigo;
use crate::rules::noise_limit::filter_time;
use crate::rules::simc::Simc;
use crate::{Refusal, Warning};
use controller_core::PidConfig;

/// How far the kappa-tau rule may be from its `Ms`. On plants like those it was fitted to, several lags, with or without
/// dead time or a zero in the right half-plane, it is within 10 % for 1.4 and within 45 % for 2.
const FIT: f64 = 1.5;

impl Job<'_> {
    pub(super) fn kappa_tau(&mut self) -> Result<Law, Refusal> {
        let ms = match self.request.ms {
            None => AhMs::Ms14,
            Some(ms) if (ms - 1.4).abs() < 1e-9 => AhMs::Ms14,
            Some(ms) if (ms - 2.0).abs() < 1e-9 => AhMs::Ms20,
            Some(ms) => return Err(Refusal::OutOfRange { parameter: "ms", value: ms, min: 1.4, max: 2.0 }),
        };
        let made = AhPid::of_plant(&self.delayed, ms)?;
        let wanted = if ms == AhMs::Ms14 { 1.4 } else { 2.0 };
        let found = ContinuousLoop::new(&self.delayed, &made.pid).ms();
        if found.is_err_and(|refusal| refusal == TOO_LONG) {
            return Err(TOO_LONG);
        }
        if found.is_ok_and(|(ms, _)| ms <= FIT * wanted) {
            // What the rule says of plants it cannot see is known better here.
            let told =
                |warning: &&Warning| !matches!(warning, Warning::OutsideValidity { about: LOOP_GAIN, .. });
            made.warnings.iter().filter(told).for_each(|warning| self.warn(*warning));
        } else {
            // A time until the output turns that is as long as the lags is beyond the plants of the fit.
            if self.delayed.zeros().iter().any(|zero| zero.re > 0.0) {
                return Err(Refusal::NoSolution {
                    why: "the kappa-tau rule misses the Ms it is made for by more than half: the zero in the right half-plane is too slow for it",
                    help: "use a rule that takes the plant as it is",
                });
            }
            return Err(Refusal::NoSolution {
                why: "the kappa-tau rule misses the Ms it is made for by more than half: the plant is too much like a single lag with a short dead time, or swings",
                help: "use a rule that takes the plant as it is",
            });
        }
        self.filtered(made.pid)
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
        self.filtered(made.pid)
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
                // Two equal ones differ by a rounding error, in either direction.
                Simc::pid(gain, slow, fast.min(slow), dead_time, tau_c)
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
        self.filtered(made.pid)
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
    fn filtered(&mut self, mut pid: PidConfig) -> Result<Law, Refusal> {
        let ts = self.request.ts;
        match self.request.filter {
            Filter::Time(tf) => pid.tf = tf,
            Filter::NoiseGain(kpidn) => pid.tf = filter_time(&pid, kpidn, ts)?,
            Filter::Default if pid.kd != 0.0 && pid.tf < ts => {
                pid.tf = ts;
                let text = "raised to the sampling period: the rule's filter is faster than that";
                self.warn(Warning::Value { about: "tf", value: ts, text });
            }
            Filter::Default => {}
        }
        Ok(super::build::plain(pid))
    }
}

pub(super) const NOT_INTEGRATING: Refusal = Refusal::Plant {
    must: "be close to an integrator with at most one lag",
    help: "use a rule that takes the plant as it is",
};

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
