//! What a scenario says: a plant, events, one or more controllers; and how it is [read] from TOML.
#![doc = include_str!("format.md")]

mod adrc;
mod cases;
mod columns;
mod compensators;
mod controllers;
mod designs;
mod events;
mod explain;
mod expression;
mod fault;
mod files;
mod include;
mod key_path;
mod library;
mod log;
mod models;
mod nonlinear;
mod number;
mod oddities;
mod override_key;
mod pid;
mod places;
mod plants;
mod ranges;
mod read;
mod recording;
mod run;
mod sections;
mod signal;
mod signals;
mod sources;
mod suggest;
mod surroundings;
mod sweep;
mod syntax;
mod table;
mod texts;
mod trial;
mod uncertainty;
mod value;
mod write;

pub use cases::{Case, ReadAll, read_with};
pub(crate) use designs::apply;
pub use fault::{Fault, Place, Related, SourceText, code};
pub use files::{Files, FolderFiles, NoFiles};
pub(crate) use number::{show, show_short};
pub use override_key::override_key;
pub use read::{Read, VERSION, read};
pub use signal::{Between, Recording, Signal};
pub(crate) use suggest::closest;
pub use uncertainty::{Uncertain, uncertainty};
pub(crate) use value::{shortened, to_f64, type_name};
pub use write::DesignFile;

use crate::plant::Nonlinear;
use controller_core::{AdrcConfig, ControllerConfig, EstimatorConfig, Mode, ObserverConfig, PidConfig};
use controller_design::model::TransferFunction;

/// A whole scenario, checked: everything a run needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Heads the report; empty: the name of the file does.
    pub title: String,
    /// What it shows and what to look at, for the report; paragraphs are divided by empty lines.
    pub description: String,
    /// What the signals are measured in.
    pub units: Units,
    /// Sampling period \[s\].
    pub ts: f64,
    /// Length of the run \[s\].
    pub duration: f64,
    /// Time from reading `y` to acting `u` \[s\].
    pub latency: f64,
    /// Steps per sample for the metrics and the trace between samples, 1 or more.
    pub substeps: usize,
    /// The plant that is simulated, from the output of the actuator to the measurement. Of one that is not linear, its linear
    /// model at [`initial`](Self::initial).
    pub plant: TransferFunction,
    /// A plant that is not linear: what is simulated in place of [`plant`](Self::plant).
    pub nonlinear: Option<Nonlinear>,
    /// The part of the plant that the actuator drives first, when it is measured on its own: what the secondary loop
    /// of a cascade controls. [`plant`](Self::plant) is the whole, this part included.
    pub inner_plant: Option<TransferFunction>,
    /// What held before `t = 0`.
    pub initial: Initial,
    /// What happens, in the order of `at`.
    pub events: Vec<Event>,
    /// Who controls; each runs alone on its own copy of the plant.
    pub controllers: Vec<ControllerSpec>,
    /// Noise on the measurement.
    pub noise: Option<Noise>,
    /// What the measurement goes through before the controller gets it.
    pub sensor: Sensor,
    /// What lies between the controller's output and the plant.
    pub actuator: Actuator,
}

/// The steady state before `t = 0`; the plant is at rest at it and the controllers are settled there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Initial {
    /// Set-point and measurement \[y\].
    pub setpoint: f64,
    /// Disturbance at the plant input \[u\].
    pub disturbance: f64,
}

/// White Gaussian noise on the measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation \[y\].
    pub std: f64,
    /// Seed of the generator.
    pub seed: u64,
}

/// What the signals are measured in, for people. Empty: not said.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Units {
    /// Of the measurement and the set-point.
    pub y: String,
    /// Of the controller's output.
    pub u: String,
}

/// A sensor: the noisy measurement is moved into its range, then rounded to its resolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Lowest value it shows \[y\].
    pub lo: f64,
    /// Highest value it shows \[y\].
    pub hi: f64,
    /// Smallest step it shows, counted from 0 \[y\]; 0: every number.
    pub resolution: f64,
}

impl Default for Sensor {
    fn default() -> Self {
        Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY, resolution: 0.0 }
    }
}

/// An actuator. Every sample it takes the controller's output, moved into its range; keeps its position when that
/// differs by no more than the dead band; goes towards it at most as fast as its rate; its stem follows with its stiction;
/// and stands at a multiple of its resolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuator {
    /// Lowest output it accepts \[u\].
    pub lo: f64,
    /// Highest output it accepts \[u\].
    pub hi: f64,
    /// Fastest movement \[u/s\]; infinite: at once.
    pub rate: f64,
    /// Smallest step, counted from 0 \[u\]; 0: every number.
    pub resolution: f64,
    /// Changes up to this size do not move it \[u\].
    pub deadband: f64,
    /// How the stem sticks; `None`: it does not.
    pub stiction: Option<Stiction>,
    /// The controller is told what was accepted.
    pub read_back: bool,
}

impl Default for Actuator {
    fn default() -> Self {
        let (lo, hi) = (f64::NEG_INFINITY, f64::INFINITY);
        Self { lo, hi, rate: f64::INFINITY, resolution: 0.0, deadband: 0.0, stiction: None, read_back: false }
    }
}

/// A valve that sticks: the model of He, Wang, Pottmann and Qin (2007) with two parameters, here the stick band and the
/// slip jump of Choudhury, Thornhill and Shah (2005). The static friction of the former is `(band + jump)/2`, its kinetic
/// friction `(band - jump)/2`.
///
/// The stem stays while the signal is no further from it than the static friction; then it slips to the kinetic friction
/// from the signal. After a turn, the signal goes through the whole band before the stem moves, and the stem then jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiction {
    /// What the signal has to go through after a turn before the stem moves (dead band and stick band) \[u\].
    pub band: f64,
    /// How far the stem jumps when it comes loose, at most `band`; 0: pure play (backlash) \[u\].
    pub jump: f64,
}

/// Something that happens at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// When \[s\]. Disturbances begin exactly then, everything else with the next sample.
    pub at: f64,
    /// What it is called in the report; empty: after what it changes.
    pub label: String,
    /// What happens, in the order it was written.
    pub changes: Vec<Change>,
    /// Index of the one controller it is about; `None`: all.
    pub controller: Option<usize>,
}

/// What an event changes.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// The local set-point \[y\].
    Setpoint(Signal),
    /// The remote set-point \[y\].
    RemoteSetpoint(Signal),
    /// The disturbance at the plant input \[u\].
    Disturbance(Signal),
    /// The controller gets a recorded measurement \[y\] from now on; `None`: the plant's again.
    Measurement(Option<std::sync::Arc<Recording>>),
    /// The requested mode becomes this.
    Mode(Mode),
    /// The manual output becomes this \[u\].
    Manual(f64),
    /// The track output becomes this \[u\].
    Track(f64),
    /// The offset becomes this \[u\].
    Offset(f64),
    /// The compensator is used or not.
    Compensator(bool),
    /// The next measurements are bad.
    BadSamples(u32),
    /// The next samples are lost: the task does not run.
    LostSamples(u32),
    /// A latched fallback is acknowledged.
    Acknowledge,
    /// The controllers concerned get these parameters, bumplessly: the list names the controller and what it
    /// is from now on.
    Parameters(Vec<(usize, ControllerSpec)>),
}

/// A controller of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerSpec {
    /// Its name.
    pub name: String,
    /// PID, limits, set-point, anti-windup, fallback, alarms.
    pub config: ControllerConfig,
    /// The ADRC that closes the loop in place of the PID of `config`, whose gains are then 0.
    pub adrc: Option<AdrcConfig>,
    /// Disturbance block.
    pub compensator: CompensatorSpec,
    /// Requested mode at the start.
    pub mode: Mode,
    /// The loop inside of a cascade, on [`Scenario::inner_plant`]: this controller's output is its remote set-point.
    pub secondary: Option<Box<ControllerSpec>>,
}

/// The disturbance block of a controller.
#[allow(clippy::large_enum_variant)] // a handful in a run, never copied in one
#[derive(Debug, Clone, PartialEq, Default)]
pub enum CompensatorSpec {
    /// None.
    #[default]
    None,
    /// Disturbance estimator (DE).
    Estimator(EstimatorConfig),
    /// Disturbance observer (DOB).
    Observer(ObserverConfig),
}

impl ControllerSpec {
    /// A plain PID with defaults for everything else, in mode Auto.
    #[must_use]
    pub fn pid(name: &str, pid: PidConfig) -> Self {
        Self {
            name: name.to_owned(),
            config: ControllerConfig { pid, ..ControllerConfig::default() },
            adrc: None,
            compensator: CompensatorSpec::None,
            mode: Mode::Auto,
            secondary: None,
        }
    }

    /// An ADRC with defaults for everything else, in mode Auto.
    #[must_use]
    pub fn adrc(name: &str, adrc: AdrcConfig) -> Self {
        Self { adrc: Some(adrc), ..Self::pid(name, PidConfig::default()) }
    }

    /// The same controller with a disturbance estimator.
    #[must_use]
    pub fn with_estimator(mut self, estimator: EstimatorConfig) -> Self {
        self.compensator = CompensatorSpec::Estimator(estimator);
        self
    }

    /// The same controller with a disturbance observer.
    #[must_use]
    pub fn with_observer(mut self, observer: ObserverConfig) -> Self {
        self.compensator = CompensatorSpec::Observer(observer);
        self
    }
}
