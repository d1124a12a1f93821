//! Where the numbers of ours come from: experiments of the simulator, and why there may be none.

use crate::scenario::{Actuator, Change, ControllerSpec, Event, Initial, Scenario, Sensor, Signal, Units};
use crate::simulate::{Control, Metrics, RunError, RunOptions, RunResult, run_with};
use controller_design::Refusal;
use controller_design::model::{ModelError, TransferFunction, parse};

/// A unit step of the set-point.
pub(super) const TRACKING: Change = Change::Setpoint(Signal::Step(1.0));
/// A unit step of the disturbance at the plant input.
pub(super) const REJECTION: Change = Change::Disturbance(Signal::Step(1.0));

/// Why a table has no more numbers.
#[derive(Debug)]
pub(super) enum Stop {
    /// It was stopped from outside.
    Stopped,
    /// Something has no result.
    Failed(String),
}

impl From<Refusal> for Stop {
    fn from(refusal: Refusal) -> Self {
        Self::Failed(refusal.to_string())
    }
}

impl From<ModelError> for Stop {
    fn from(error: ModelError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<RunError> for Stop {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Stopped => Self::Stopped,
            other => Self::Failed(other.to_string()),
        }
    }
}

/// Runs experiments and can be stopped.
#[derive(Debug)]
pub(super) struct Bench<'a> {
    control: &'a Control,
}

/// An experiment from rest: one change at `t = 0`.
#[derive(Debug, Clone)]
pub(super) struct Experiment<'a> {
    pub(super) plant: &'a TransferFunction,
    pub(super) ts: f64,
    pub(super) duration: f64,
    /// Steps between two samples for the indices.
    pub(super) substeps: usize,
    pub(super) change: Change,
}

impl<'a> Bench<'a> {
    pub(super) const fn new(control: &'a Control) -> Self {
        Self { control }
    }

    /// What stops it.
    pub(super) const fn control(&self) -> &'a Control {
        self.control
    }

    /// Ends a long computation when somebody wants it.
    pub(super) fn check(&self) -> Result<(), Stop> {
        if self.control.is_stopped() { Err(Stop::Stopped) } else { Ok(()) }
    }

    /// The indices of each controller over the whole experiment.
    pub(super) fn metrics(
        &self,
        experiment: &Experiment<'_>,
        controllers: Vec<ControllerSpec>,
    ) -> Result<Vec<Metrics>, Stop> {
        let result = self.run(experiment, controllers, RunOptions::default())?;
        Ok(result.controllers.iter().map(|one| one.total).collect())
    }

    /// The whole result.
    pub(super) fn run(
        &self,
        experiment: &Experiment<'_>,
        controllers: Vec<ControllerSpec>,
        options: RunOptions,
    ) -> Result<RunResult, Stop> {
        let event = Event {
            at: 0.0,
            label: String::new(),
            changes: vec![experiment.change.clone()],
            controller: None,
        };
        let scenario = Scenario {
            title: String::new(),
            description: String::new(),
            units: Units::default(),
            ts: experiment.ts,
            duration: experiment.duration,
            latency: 0.0,
            substeps: experiment.substeps,
            plant: experiment.plant.clone(),
            nonlinear: None,
            inner_plant: None,
            initial: Initial::default(),
            events: vec![event],
            controllers,
            noise: None,
            sensor: Sensor::default(),
            actuator: Actuator::default(),
        };
        Ok(run_with(&scenario, options, self.control, None)?)
    }
}

/// A plant of a paper.
pub(super) fn plant(text: &str) -> Result<TransferFunction, Stop> {
    parse(text).map_err(|_| Stop::Failed(format!("`{text}` is no plant")))
}
