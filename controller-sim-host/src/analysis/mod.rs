//! Margins and noise of the loops of a scenario: of the continuous design and of the sampled law that runs.
//!
//! ```
//! use controller_sim_host::analysis::analyse;
//! use controller_sim_host::demo;
//! use controller_sim_host::scenario::read;
//! use controller_sim_host::simulate::Precision;
//!
//! let demo = read(demo::SCENARIO, Precision::F64).expect("the demo is valid").scenario;
//! let first = analyse(&demo, 0).expect("a loop that can be analysed");
//! assert!(first.discrete.margins.expect("stable").ms > first.continuous.margins.expect("stable").ms);
//! ```

mod noise;
mod warnings;

pub use noise::Noise;

use crate::scenario::{CompensatorSpec, Scenario};
use controller_design::Refusal;
use controller_design::margins::{ContinuousLoop, DiscreteLaw, DiscreteLoop, Margins};

/// Why a controller of a scenario was not analysed, one line.
pub type Reason = String;

/// What is known of one form of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// The margins, or why there are none.
    pub margins: Result<Margins, Refusal>,
    /// The gains from measurement noise to the output.
    pub noise: Noise,
}

/// The analysis of one controller on its plant.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Name of the controller.
    pub name: String,
    /// The continuous design, dead time and latency exact: what was asked for.
    pub continuous: Side,
    /// The sampled law with hold, dead time and latency: what runs.
    pub discrete: Side,
    /// Closed-loop poles of the sampled loop outside the unit circle or on it.
    pub unstable_poles: usize,
    /// What a person should know.
    pub warnings: Vec<String>,
    /// The continuous loop, for its responses.
    pub design: ContinuousLoop,
    /// The sampled loop, for its responses.
    pub sampled: DiscreteLoop,
}

impl Analysis {
    /// Whether the sampled loop is stable.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.unstable_poles == 0
    }
}

/// Analyses the controller `index` of `scenario`, in double precision and without limits.
///
/// # Errors
/// A cascade, whose outer controller does not see the plant alone; a plant, model or law that has no responses.
pub fn analyse(scenario: &Scenario, index: usize) -> Result<Analysis, Reason> {
    let spec = scenario.controllers.get(index).ok_or("there is no such controller")?;
    let (ts, latency, pid) = (scenario.ts, scenario.latency, &spec.config.pid);
    let law = law(scenario, index)?;
    let refused = |refusal: Refusal| refusal.to_string();
    let sampled = DiscreteLoop::new(&scenario.plant, law, latency).map_err(refused)?;
    let design = match &spec.adrc {
        Some(adrc) => ContinuousLoop::of_adrc(&scenario.plant, adrc).map_err(refused)?,
        None => ContinuousLoop::new(&scenario.plant, pid),
    };
    let design = match &spec.compensator {
        CompensatorSpec::None => design,
        CompensatorSpec::Estimator(config) => design.with_estimator(config).map_err(refused)?,
        CompensatorSpec::Observer(config) => design.with_observer(config).map_err(refused)?,
    };
    let design = design.with_latency(latency);
    let unstable_poles = sampled.unstable_poles();
    let mut analysis = Analysis {
        name: spec.name.trim().to_owned(),
        continuous: Side { margins: design.margins(), noise: Noise::requested(&design, ts) },
        discrete: Side {
            margins: sampled.margins(),
            noise: Noise::sampled(&sampled.noise(), unstable_poles == 0),
        },
        unstable_poles,
        warnings: Vec::new(),
        design,
        sampled,
    };
    analysis.warnings = warnings::of(&analysis, pid);
    if let Some(plant) = &scenario.nonlinear {
        let start = scenario.initial.setpoint;
        analysis.warnings.insert(0, format!("the {} is not linear: {}", plant.name(), plant.validity(start)));
    }
    Ok(analysis)
}

/// The sampled law of the controller `index` of `scenario`, in double precision and without limits.
///
/// # Errors
/// A cascade, whose outer controller does not see the plant alone; a law that cannot be built.
pub fn law(scenario: &Scenario, index: usize) -> Result<DiscreteLaw, Reason> {
    let spec = scenario.controllers.get(index).ok_or("there is no such controller")?;
    if spec.secondary.is_some() {
        return Err("a cascade is not analysed: analyse its inner loop as a scenario of its own".to_owned());
    }
    let (ts, pid) = (scenario.ts, &spec.config.pid);
    let law = match (&spec.adrc, spec.compensator_config(scenario.latency)) {
        (Some(adrc), _) => DiscreteLaw::adrc(adrc, ts),
        (None, Some(config)) => DiscreteLaw::with_compensator(pid, &config, ts),
        (None, None) => DiscreteLaw::new(pid, ts),
    };
    law.map_err(|faults| faults.to_string())
}
