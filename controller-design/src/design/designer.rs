//! Many designs for one plant.

use super::build::{Setting, Shared};
use super::finish::finish_continuous;
use super::{Design, Law, Method, Noise, Request};
use crate::margins::Margins;
use crate::model::TransferFunction;
use crate::{Refusal, Warnings};

/// Designs controllers for one plant; what several requests have in common is computed once: the PI of `pi-ms` is the one
/// inside of every `dob` of the same `ms`.
///
/// ```
/// use controller_design::design::{Designer, Method, ObserverFilter, Request, design};
/// use controller_design::model::parse;
///
/// let plant = parse("exp(-s)/(1+2*s)").expect("a valid plant");
/// let designer = Designer::new(&plant);
/// let pi = Request { ms: Some(1.2), ..Request::new(Method::PiMs, 0.01) };
/// let observed = Request { observer_filter: ObserverFilter::NoiseRatio(2.0), method: Method::Dob, ..pi };
/// assert_eq!(designer.continuous(&pi)?.robustness, design(&plant, &pi)?.robustness);
/// assert_eq!(designer.continuous(&observed)?.law, design(&plant, &observed)?.law);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
#[derive(Debug)]
pub struct Designer<'a> {
    plant: &'a TransferFunction,
    shared: Shared,
}

/// A controller for a plant, judged as the continuous loop of both: what [`Design`] says less everything about the sampled
/// law.
#[derive(Debug, Clone, PartialEq)]
pub struct ContinuousDesign {
    /// The rule.
    pub method: Method,
    /// What runs.
    pub law: Law,
    /// Margins of the continuous loop of plant, latency and law.
    pub robustness: Margins,
    /// Noise gains by their formulas.
    pub noise: Noise,
    /// What a person should know of the law.
    pub warnings: Warnings,
}

impl<'a> Designer<'a> {
    /// For `plant`.
    #[must_use]
    pub fn new(plant: &'a TransferFunction) -> Self {
        Self { plant, shared: Shared::default() }
    }

    fn setting(&self) -> Setting<'_> {
        Setting { plant: self.plant, measured: None, shared: &self.shared }
    }

    /// As [`design`](super::design).
    ///
    /// # Errors
    /// As for [`design`](super::design).
    pub fn design(&self, request: &Request) -> Result<Design, Refusal> {
        self.setting().design(request)
    }

    /// The same law without a look at the sampled loop, a third to a half of the time: `ts` is that of the noise gains only,
    /// and a law is not refused for a period that would be too long for it.
    ///
    /// # Errors
    /// What the rule refuses; a parameter of the request out of its range; a continuous loop that is not stable.
    pub fn continuous(&self, request: &Request) -> Result<ContinuousDesign, Refusal> {
        self.setting()
            .within_reason(request, |_, request, law, made| finish_continuous(self.plant, request, law, made))
    }
}
