//! A run: every controller of a scenario, sample by sample.

use super::closed_loop::ClosedLoop;
use super::control::{Control, Sink};
use super::disturbance::Curve;
use super::law::AnyLaw;
use super::metrics::Metrics;
use super::noise::Gaussian;
use super::record::{Record, View};
use super::remarks::{Remark, Watch};
use super::stretches::{Stretch, Stretches, sample_of};
use crate::scenario::{Change, ControllerSpec, Scenario, Signal};
use controller_core::{ConfigErrors, ControllerInput, ControllerOutput, Mode, Quality, Real, Status};

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
    /// Controller output \[u\].
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
    /// What to know before trusting the figures: fallbacks, saturation, an error that does not die out.
    pub remarks: Vec<Remark>,
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
    /// The plant cannot rest at the initial set-point: it has a zero at `s = 0`.
    NoRest {
        /// The set-point asked for \[y\].
        setpoint: f64,
    },
    /// It was stopped from outside.
    Stopped,
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Controller { index, faults } => write!(f, "controller {}: {faults}", index + 1),
            Self::NoRest { setpoint } => {
                write!(f, "a plant with a zero at s = 0 cannot rest at the set-point {setpoint}")
            }
            Self::Stopped => f.write_str("stopped"),
        }
    }
}

impl std::error::Error for RunError {}

/// Runs every controller of `scenario` alone on the plant: settled before `t = 0`, then event by event. The plant
/// moves exactly between the samples; the controllers are the laws of `controller-core` in the number type asked for.
///
/// # Errors
/// A controller whose law cannot be built; a plant that cannot rest at the initial set-point.
pub fn run(scenario: &Scenario, options: RunOptions) -> Result<RunResult, RunError> {
    run_with(scenario, options, &Control::new(), None)
}

/// As [`run`], watched and stopped through `control`; `sink` takes every sample, controllers one after the other.
///
/// # Errors
/// Those of [`run`]; stopped by `control` or by the sink.
pub fn run_with(
    scenario: &Scenario,
    options: RunOptions,
    control: &Control,
    mut sink: Option<&mut dyn Sink>,
) -> Result<RunResult, RunError> {
    let mut controllers = Vec::new();
    for index in 0..scenario.controllers.len() {
        let one = match options.precision {
            Precision::F32 => run_one::<f32>(scenario, index, options, control, &mut sink),
            Precision::F64 => run_one::<f64>(scenario, index, options, control, &mut sink),
        };
        controllers.push(one?);
    }
    Ok(RunResult { controllers })
}

/// Samples between two looks at the control.
const CHECKED_EVERY: u64 = 4096;

/// What the events have made of the controller's inputs.
struct Requests<T> {
    input: ControllerInput<T>,
    r: f64,
    r_remote: f64,
    /// Bad and lost samples still to come.
    bad: u32,
    lost: u32,
}

impl<T> Requests<T> {
    /// The set-point that the requested mode uses, unrounded.
    fn asked(&self) -> f64 {
        if self.input.mode == Mode::Cascade { self.r_remote } else { self.r }
    }
}

fn run_one<T: Real>(
    scenario: &Scenario,
    index: usize,
    options: RunOptions,
    control: &Control,
    sink: &mut Option<&mut dyn Sink>,
) -> Result<ControllerResult, RunError> {
    let spec = &scenario.controllers[index];
    let refused = |faults| RunError::Controller { index, faults: Box::new(faults) };
    let (ts, initial) = (scenario.ts, scenario.initial);
    let disturbances = disturbances(scenario, index);
    let rest = (initial.setpoint, initial.disturbance);
    let (mut plant, u0) =
        ClosedLoop::new(&scenario.plant, ts, scenario.latency, scenario.substeps, rest, &disturbances)
            .ok_or(RunError::NoRest { setpoint: initial.setpoint })?;
    let mut disturbance = Curve::new(initial.disturbance, &disturbances, 0.0, ts);
    let mut law = AnyLaw::<T>::new(spec, ts, scenario.latency, capacity(scenario, index)).map_err(refused)?;
    law.settle(initial.setpoint, initial.setpoint, u0);

    let r0 = T::from_f64(initial.setpoint);
    let mut requests = Requests {
        input: ControllerInput { r: r0, r_remote: r0, mode: spec.mode, ..ControllerInput::default() },
        r: initial.setpoint,
        r_remote: initial.setpoint,
        bad: 0,
        lost: 0,
    };
    let mut noise = scenario.noise.map(|n| (n.std, Gaussian::new(n.seed)));
    let mut stretches = Stretches::new(scenario);
    let mut watch = Watch::default();
    let mut samples = Vec::new();
    let mut next_event = 0;
    let count = sample_of(scenario.duration, ts);
    let mut record = options.record.map(|view| Record::new(view, ts, count));
    if sink.as_deref_mut().is_some_and(|sink| sink.begin(index, &spec.name).is_break()) {
        return Err(RunError::Stopped);
    }
    let watched = options.trace || record.is_some() || sink.is_some();
    let (mut u, mut output) = (u0, ControllerOutput { mode: spec.mode, ..ControllerOutput::default() });

    for k in 0..count {
        if k % CHECKED_EVERY == 0 && k > 0 {
            control.add(CHECKED_EVERY);
            if control.is_stopped() {
                return Err(RunError::Stopped);
            }
        }
        while let Some(event) = scenario.events.get(next_event).filter(|e| sample_of(e.at, ts) <= k) {
            next_event += 1;
            if event.controller.is_none_or(|only| only == index) {
                for change in &event.changes {
                    apply(change, index, &mut requests, &mut law).map_err(refused)?;
                }
            }
        }
        let (t, r) = (plant.time(), requests.asked());
        let exact = plant.measure();
        let noisy = exact + noise.as_mut().map_or(0.0, |(std, source)| *std * source.sample());
        let before = u;
        let lost = requests.lost > 0;
        let y = if lost || requests.bad > 0 { f64::NAN } else { noisy };
        if lost {
            // The task does not run; the output stays.
            requests.lost -= 1;
            law.advance(1);
        } else {
            requests.input.y = T::from_f64(y);
            requests.input.quality = if requests.bad > 0 { Quality::Bad } else { Quality::Good };
            requests.bad = requests.bad.saturating_sub(1);
            output = law.step(&requests.input);
            requests.input.acknowledge = false;
            u = output.u.to_f64();
        }
        let applied = u.clamp(scenario.actuator.lo, scenario.actuator.hi);
        if scenario.actuator.read_back {
            requests.input.u_applied = Some(T::from_f64(applied));
        }
        stretches.sample(t, ts, r - exact, before, u);
        let automatic = output.mode.is_automatic();
        watch.sample(t, k as f64 / count as f64, r - exact, output.status, automatic);
        let band = record.as_ref().map_or(0, |record| record.band(k));
        if watched {
            let d = disturbance.advance_to(k as f64);
            let (u_f, d_hat) = (output.u_f.to_f64(), output.d_hat.to_f64());
            let status = if lost { output.status | Status::OVERRUN } else { output.status };
            let sample = Sample { t, r, y, u, applied, u_f, d_hat, d, mode: output.mode, status };
            if let Some(record) = &mut record {
                record.sample(band, &sample);
                record.output(band, exact);
            }
            if sink.as_deref_mut().is_some_and(|sink| sink.sample(&sample).is_break()) {
                return Err(RunError::Stopped);
            }
            if options.trace {
                samples.push(sample);
            }
        }
        plant.hold(applied, |step| {
            stretches.step((step.t0, r - step.y0), (step.t1, r - step.y1));
            if let Some(record) = &mut record {
                record.output(band, step.y1);
            }
        });
    }
    control.add(count % CHECKED_EVERY);
    let (events, total) = stretches.finish();
    let remarks = watch.finish(scenario.noise.map_or(0.0, |n| n.std));
    Ok(ControllerResult { name: spec.name.clone(), events, total, trace: samples, record, remarks })
}

fn apply<T: Real>(
    change: &Change,
    index: usize,
    requests: &mut Requests<T>,
    law: &mut AnyLaw<T>,
) -> Result<(), ConfigErrors> {
    let input = &mut requests.input;
    match change {
        Change::Setpoint(Signal::Step(r)) => (requests.r, input.r) = (*r, T::from_f64(*r)),
        Change::RemoteSetpoint(Signal::Step(r)) => {
            (requests.r_remote, input.r_remote) = (*r, T::from_f64(*r))
        }
        Change::Disturbance(_) | Change::Setpoint(_) | Change::RemoteSetpoint(_) | Change::Measurement(_) => {
        }
        Change::Mode(mode) => input.mode = *mode,
        Change::Manual(u) => input.manual = Some(T::from_f64(*u)),
        Change::Track(u) => input.track = T::from_f64(*u),
        Change::Offset(u) => input.offset = T::from_f64(*u),
        Change::Compensator(on) => input.compensate = *on,
        Change::BadSamples(n) => requests.bad = *n,
        Change::LostSamples(n) => requests.lost = *n,
        Change::Acknowledge => input.acknowledge = true,
        Change::Parameters(list) => {
            if let Some((_, spec)) = list.iter().find(|(who, _)| *who == index) {
                law.adopt(spec)?;
            }
        }
    }
    Ok(())
}

/// The disturbances that reach one controller's plant, with their times, in order.
fn disturbances(scenario: &Scenario, index: usize) -> Vec<(f64, Signal)> {
    let concerned = scenario.events.iter().filter(|e| e.controller.is_none_or(|only| only == index));
    let changes = concerned.flat_map(|e| e.changes.iter().map(move |c| (e.at, c)));
    changes
        .filter_map(|(at, c)| if let Change::Disturbance(d) = c { Some((at, d.clone())) } else { None })
        .collect()
}

/// Delay memory that every parameter set of a controller fits in.
fn capacity(scenario: &Scenario, index: usize) -> usize {
    let later = scenario.events.iter().flat_map(|e| &e.changes).filter_map(|c| match c {
        Change::Parameters(list) => list.iter().find(|(who, _)| *who == index).map(|(_, spec)| spec),
        _ => None,
    });
    let need = |spec: &ControllerSpec| spec.needed_capacity(scenario.ts, scenario.latency);
    later.chain(scenario.controllers.get(index)).map(need).max().unwrap_or(1)
}
