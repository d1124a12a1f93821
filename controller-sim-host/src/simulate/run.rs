//! A run: every controller of a scenario, sample by sample.

use super::control::{Control, Sink};
use super::metrics::Metrics;
use super::record::{Record, View};
use super::remarks::Remark;
use super::single::run_one;
use super::stretches::Stretch;
use crate::pil::{Compared, LinkError, Target};
use crate::scenario::Scenario;
use controller_core::{ConfigErrors, Mode, Status};
use rayon::prelude::*;

/// The number type the controllers run in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Single precision: what most targets run.
    F32,
    /// Double precision.
    #[default]
    F64,
}

/// What a run keeps besides the metrics.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunOptions {
    /// Number type of the controllers.
    pub precision: Precision,
    /// Keep every sample.
    pub trace: bool,
    /// Record this part, for a picture.
    pub record: Option<View>,
    /// Run the controllers on this board, too, and compare.
    pub pil: Option<&'static Target>,
}

/// One sample of one controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time \[s\].
    pub t: f64,
    /// Set-point as asked for: the local one, in Cascade the remote one \[y\].
    pub r: f64,
    /// Measurement, noise included; what the controller got (not a number while bad or lost) \[y\].
    pub y: f64,
    /// Output of the controller that drives the actuator \[u\].
    pub u: f64,
    /// What the actuator applies of it \[u\].
    pub applied: f64,
    /// Compensator output \[u\].
    pub u_f: f64,
    /// Estimated disturbance \[u\].
    pub d_hat: f64,
    /// Disturbance at the plant input \[u\].
    pub d: f64,
    /// Mode in force.
    pub mode: Mode,
    /// Status bits.
    pub status: Status,
    /// The loop inside of a cascade.
    pub inner: Option<InnerSample>,
}

/// The loop inside of a cascade in one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerSample {
    /// Its set-point: the output of the primary controller \[y of the inner part\].
    pub r: f64,
    /// Its measurement.
    pub y: f64,
}

/// The result of one controller.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerResult {
    /// Its name.
    pub name: String,
    /// Indices from event to event.
    pub events: Vec<Stretch>,
    /// Indices of the whole run (ITAE: the sum of the stretches').
    pub total: Metrics,
    /// Every sample, when asked for.
    pub trace: Vec<Sample>,
    /// The signals for a picture, when asked for.
    pub record: Option<Record>,
    /// Those of the loop inside of a cascade: set-point, measurement and output of the secondary controller, its modes
    /// and status.
    pub inner: Option<Record>,
    /// What to know before trusting the figures: fallbacks, saturation, an error that does not die out.
    pub remarks: Vec<Remark>,
    /// How it compares with the same controller on the board, when it ran there, too.
    pub pil: Option<Compared>,
}

/// The result of a run, controllers in the order of the scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// One entry per controller.
    pub controllers: Vec<ControllerResult>,
}

/// Why a scenario could not be run.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    /// A controller's configuration is refused.
    Controller {
        /// Its index.
        index: usize,
        /// Every fault.
        faults: Box<ConfigErrors>,
    },
    /// The plant cannot rest at the initial set-point: it has a zero at `s = 0`, or nothing holds it there.
    NoRest {
        /// The set-point asked for \[y\].
        setpoint: f64,
    },
    /// The board that a controller runs on cannot be asked.
    Board {
        /// The controller's index.
        index: usize,
        /// What is wrong with it.
        error: LinkError,
    },
    /// A plant that is not linear moves too fast for the integrator.
    Stuck {
        /// From when on \[s\].
        t: f64,
    },
    /// It was stopped from outside.
    Stopped,
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Controller { index, faults } => write!(f, "controller {}: {faults}", index + 1),
            Self::NoRest { setpoint } => {
                write!(f, "the plant cannot rest at the set-point {setpoint}")
            }
            Self::Stuck { t } => {
                write!(
                    f,
                    "the plant moves too fast for the integrator from {t} s on: choose a shorter `ts` or more `substeps`"
                )
            }
            Self::Board { index, error } => write!(f, "controller {}: {error}", index + 1),
            Self::Stopped => f.write_str("stopped"),
        }
    }
}

impl std::error::Error for RunError {}

/// Runs every controller of `scenario` alone on the plant: settled before `t = 0`, then event by event. The plant
/// moves exactly between the samples; the controllers are the laws of `controller-core` in the number type asked for.
///
/// # Errors
/// A controller whose law cannot be built; a plant that cannot rest at the initial set-point, or cannot be integrated.
pub fn run(scenario: &Scenario, options: RunOptions) -> Result<RunResult, RunError> {
    run_with(scenario, options, &Control::new(), None)
}

/// As [`run`], watched and stopped through `control`; `sink` takes every sample, controllers one after the other. Without
/// a sink the controllers run in parallel, on the threads of the pool this is called in; the result is the same.
///
/// # Errors
/// Those of [`run`]; stopped by `control` or by the sink.
pub fn run_with(
    scenario: &Scenario,
    options: RunOptions,
    control: &Control,
    mut sink: Option<&mut dyn Sink>,
) -> Result<RunResult, RunError> {
    let count = scenario.controllers.len();
    let one = |index, sink: &mut Option<&mut dyn Sink>| match options.precision {
        Precision::F32 => run_one::<f32>(scenario, index, options, control, sink),
        Precision::F64 => run_one::<f64>(scenario, index, options, control, sink),
    };
    let list: Vec<Result<ControllerResult, RunError>> = if sink.is_some() {
        (0..count).map(|index| one(index, &mut sink)).collect()
    } else {
        // Each has everything of its own: the order in which threads take them changes nothing.
        (0..count).into_par_iter().map(|index| one(index, &mut None)).collect()
    };
    // Of several errors the first controller's is the one that is told.
    Ok(RunResult { controllers: list.into_iter().collect::<Result<_, _>>()? })
}

/// The run of one controller, as [`run`] makes it, on this thread.
///
/// # Errors
/// Those of [`run`]; stopped by `control`.
pub fn run_controller(
    scenario: &Scenario,
    index: usize,
    precision: Precision,
    control: &Control,
) -> Result<ControllerResult, RunError> {
    let options = RunOptions { precision, ..RunOptions::default() };
    match precision {
        Precision::F32 => run_one::<f32>(scenario, index, options, control, &mut None),
        Precision::F64 => run_one::<f64>(scenario, index, options, control, &mut None),
    }
}
