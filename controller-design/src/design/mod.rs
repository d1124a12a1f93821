//! One door to all tuning rules: a plant and a wish in, a controller with what can be said of it out.
//!
//! ```
//! use controller_design::design::{Law, Method, Request, design};
//! use controller_design::model::parse;
//!
//! let plant = parse("exp(-0.2*s)/((1+0.2*s)*(1+s))").expect("a valid plant");
//! let made = design(&plant, &Request::new(Method::DeMomi, 0.01))?;
//! let Law::Pid { pid, estimator: Some(estimator), .. } = &made.law else { panic!("a PID with an estimator") };
//! assert!(pid.ki > 0.0 && estimator.kfd > 0.5);
//! # Ok::<(), controller_design::Refusal>(())
//! ```

mod adrc;
mod build;
mod calmer;
mod designer;
mod finish;
mod method;
mod models;
mod remedy;
mod request;
mod robust;

pub use build::{design, design_with_areas};
pub use designer::{ContinuousDesign, Designer};
pub use method::Method;
pub use remedy::{Remedy, remedies};
pub use request::{AdrcGain, EstimatorFilter, Filter, ObserverFilter, Request};

use crate::Warnings;
use crate::areas::Areas;
use crate::margins::{Margins, NoiseGains};
use crate::model::TransferFunction;
use controller_core::{AdrcConfig, EstimatorConfig, ObserverConfig, PidConfig};

/// What runs: the configuration of the blocks.
#[allow(clippy::large_enum_variant)] // one of a design, never copied in a step
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// A PID, with at most one disturbance block.
    Pid {
        /// The PID.
        pid: PidConfig,
        /// Its disturbance estimator.
        estimator: Option<EstimatorConfig>,
        /// Its disturbance observer.
        observer: Option<ObserverConfig>,
    },
    /// Active disturbance rejection control.
    Adrc(AdrcConfig),
}

/// A controller for a plant, and what can be said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The rule.
    pub method: Method,
    /// Sampling period \[s\].
    pub ts: f64,
    /// From reading `y` to acting `u` \[s\].
    pub latency: f64,
    /// What it was designed for.
    pub plant: TransferFunction,
    /// What runs.
    pub law: Law,
    /// Areas `A_0..A_5` of the plant with the latency, for rules that use them.
    pub areas: Option<Areas>,
    /// The areas with the filter of the PID, eq. (7) of Vrančić & Huba 2021.
    pub filtered_areas: Option<Areas>,
    /// The model that the rule puts in the plant's place, when it is not the plant itself.
    pub model: Option<RuleModel>,
    /// Margins of the continuous loop of plant, latency and law.
    pub robustness: Margins,
    /// Margins and noise gains of the sampled law that will run, with hold and latency.
    pub sampled: Sampled,
    /// Noise gains by their formulas.
    pub noise: Noise,
    /// What the loop will do.
    pub predicted: Predicted,
    /// What a person should know.
    pub warnings: Warnings,
}

/// What holds of the law that will run on the sampled plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampled {
    /// Its margins.
    pub margins: Margins,
    /// How much noise of the measurement reaches the output.
    pub noise: NoiseGains,
}

/// A model that a rule puts in the plant's place:
/// `gain*exp(-dead_time*s)/(s^integrators*(1 + a1*s + a2*s^2))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleModel {
    /// Gain [y/u/s^integrators].
    pub gain: f64,
    /// 0 or 1.
    pub integrators: usize,
    /// Coefficient of `s` \[s\].
    pub a1: f64,
    /// Coefficient of `s^2` [s^2].
    pub a2: f64,
    /// Dead time \[s\], the latency of the request included.
    pub dead_time: f64,
}

/// How much noise of the measurement reaches the output \[u/y\], by the formulas of the papers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// `K_PIDn`: gain of the PID at half the Nyquist frequency, eq. (28) of Vrančić & Huba 2021.
    pub kpidn: Option<f64>,
    /// `K_DEn`: gain of the estimator there, eq. (30).
    pub kden: Option<f64>,
    /// `A_n`: high-frequency gain of PI and observer, eq. (36) of Tena et al. 2022 with the missing `1/K`.
    pub an: Option<f64>,
}

/// What the loop will do, by closed forms or by the rule's own optimum; `None` where neither tells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Predicted {
    /// Integral of the error after a unit step of the set-point: `(1/A_0 + (1-b)*kp)/ki` \[y s\].
    pub ie_setpoint: Option<f64>,
    /// Integral of the error after a unit step of the load at the plant's input: `-1/ki`, with an estimator
    /// `-(1-kfd)/ki`, with an observer 0 \[y s\].
    pub ie_load: Option<f64>,
    /// Integral of the absolute error after a unit step of the load \[y s\].
    pub iae_load: Option<f64>,
}
