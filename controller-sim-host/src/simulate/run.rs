//! A run: every controller of a scenario, sample by sample.

use super::closed_loop::{ClosedLoop, level_at};
use super::law::AnyLaw;
use super::metrics::Metrics;
use super::noise::Gaussian;
use crate::scenario::{Change, ControllerSpec, Disturbance, Scenario};
use controller_core::{ConfigErrors, ControllerInput, Mode, Quality, Real, Status};

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RunOptions {
    /// Number type of the controllers.
    pub precision: Precision,
    /// Keep every sample.
    pub trace: bool,
}

/// What began a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The run itself, when no event is at `t = 0`.
    Start,
    /// A set-point change.
    Setpoint,
    /// A disturbance.
    Disturbance,
    /// Anything else, or more than one kind at once.
    Other,
}

/// The time from one event to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// When it began \[s\].
    pub at: f64,
    /// What began it.
    pub kind: EventKind,
    /// Its indices.
    pub metrics: Metrics,
}

/// One sample of one controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time \[s\].
    pub t: f64,
    /// Set-point as asked for \[y\].
    pub r: f64,
    /// Measurement, noise included; what the controller got (not a number while bad) \[y\].
    pub y: f64,
    /// Controller output \[u\].
    pub u: f64,
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
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Controller { index, faults } => write!(f, "controller {}: {faults}", index + 1),
            Self::NoRest { setpoint } => {
                write!(f, "a plant with a zero at s = 0 cannot rest at the set-point {setpoint}")
            }
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
    let one = |index| match options.precision {
        Precision::F32 => run_one::<f32>(scenario, index, options.trace),
        Precision::F64 => run_one::<f64>(scenario, index, options.trace),
    };
    let controllers = (0..scenario.controllers.len()).map(one).collect::<Result<_, _>>()?;
    Ok(RunResult { controllers })
}

/// What the events have made of the controller's inputs.
struct Requests<T> {
    input: ControllerInput<T>,
    bad: u32,
    lost: u32,
}

fn run_one<T: Real>(scenario: &Scenario, index: usize, trace: bool) -> Result<ControllerResult, RunError> {
    let spec = &scenario.controllers[index];
    let refused = |faults| RunError::Controller { index, faults: Box::new(faults) };
    let (ts, initial) = (scenario.ts, scenario.initial);
    let disturbances = disturbances(scenario, index);
    let rest = (initial.setpoint, initial.disturbance);
    let (mut plant, u0) =
        ClosedLoop::new(&scenario.plant, ts, scenario.latency, scenario.substeps, rest, &disturbances)
            .ok_or(RunError::NoRest { setpoint: initial.setpoint })?;
    let capacity = capacity(scenario, index);
    let mut law = AnyLaw::<T>::new(spec, ts, scenario.latency, capacity).map_err(refused)?;
    law.settle(initial.setpoint, initial.setpoint, u0);

    let mut requests = Requests {
        input: ControllerInput {
            r: T::from_f64(initial.setpoint),
            r_remote: T::from_f64(initial.setpoint),
            mode: spec.mode,
            ..ControllerInput::default()
        },
        bad: 0,
        lost: 0,
    };
    let mut noise = scenario.noise.map(|n| (n.std, Gaussian::new(n.seed)));
    let mut stretches = Stretches::new(scenario, index);
    let mut samples = Vec::new();
    let mut next_event = 0;
    let (mut u, mut output) = (u0, None);

    for k in 0..sample_count(scenario.duration, ts) {
        requests.input.acknowledge = false;
        while let Some(event) = scenario.events.get(next_event).filter(|e| sample_of(e.at, ts) <= k) {
            next_event += 1;
            if event.controller.is_none_or(|only| only == index) {
                for change in &event.changes {
                    apply(change, index, &mut requests, &mut law).map_err(refused)?;
                }
            }
        }
        let t = plant.time();
        stretches.enter(k);

        let exact = plant.measure();
        let error_now = requests.input.r.to_f64() - exact;
        let noisy = exact + noise.as_mut().map_or(0.0, |(std, source)| *std * source.sample());
        let before = u;
        if requests.lost > 0 {
            // The task does not run; the output stays.
            requests.lost -= 1;
            law.advance(1);
        } else {
            requests.input.y = T::from_f64(if requests.bad > 0 { f64::NAN } else { noisy });
            requests.input.quality = if requests.bad > 0 { Quality::Bad } else { Quality::Good };
            requests.bad = requests.bad.saturating_sub(1);
            let out = law.step(&requests.input);
            u = out.u.to_f64();
            output = Some(out);
        }
        let applied = u.clamp(scenario.actuator.lo, scenario.actuator.hi);
        if scenario.actuator.read_back {
            requests.input.u_applied = Some(T::from_f64(applied));
        }
        stretches.sample(ts, error_now, before, u);
        if let (true, Some(out)) = (trace, output) {
            samples.push(Sample {
                t,
                r: requests.input.r.to_f64(),
                y: requests.input.y.to_f64(),
                u,
                u_f: out.u_f.to_f64(),
                d_hat: out.d_hat.to_f64(),
                d: level_at(initial.disturbance, &disturbances, t, ts),
                mode: out.mode,
                status: out.status,
            });
        }
        let r = requests.input.r.to_f64();
        plant.hold(applied, |step| stretches.step(step.t0, r - step.y0, step.t1, r - step.y1));
    }
    let (events, total) = stretches.finish();
    Ok(ControllerResult { name: spec.name.clone(), events, total, trace: samples })
}

fn apply<T: Real>(
    change: &Change,
    index: usize,
    requests: &mut Requests<T>,
    law: &mut AnyLaw<T>,
) -> Result<(), ConfigErrors> {
    let input = &mut requests.input;
    match change {
        Change::Setpoint(r) => input.r = T::from_f64(*r),
        Change::RemoteSetpoint(r) => input.r_remote = T::from_f64(*r),
        Change::Disturbance(_) => {}
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
fn disturbances(scenario: &Scenario, index: usize) -> Vec<(f64, Disturbance)> {
    let concerned = scenario.events.iter().filter(|e| e.controller.is_none_or(|only| only == index));
    let changes = concerned.flat_map(|e| e.changes.iter().map(move |c| (e.at, c)));
    changes.filter_map(|(at, c)| if let Change::Disturbance(d) = c { Some((at, *d)) } else { None }).collect()
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

/// The first sample at or after the time `at`.
fn sample_of(at: f64, ts: f64) -> u64 {
    let s = at / ts;
    let near = s.round();
    (if (s - near).abs() < 1e-9 * (1.0 + near.abs()) { near } else { s.ceil() }) as u64
}

/// Samples in a run of `duration` seconds.
fn sample_count(duration: f64, ts: f64) -> u64 {
    sample_of(duration, ts)
}

/// Divides a run at its events and collects the indices of each stretch.
struct Stretches {
    list: Vec<(u64, Stretch)>,
    current: usize,
}

impl Stretches {
    fn new(scenario: &Scenario, index: usize) -> Self {
        let mut list: Vec<(u64, Stretch)> = Vec::new();
        let begin = |at: f64, kind| Stretch { at, kind, metrics: Metrics::default() };
        for event in &scenario.events {
            if event.controller.is_some_and(|only| only != index) {
                continue;
            }
            let start = sample_of(event.at, scenario.ts);
            for change in &event.changes {
                let kind = match change {
                    Change::Setpoint(_) | Change::RemoteSetpoint(_) => EventKind::Setpoint,
                    Change::Disturbance(_) => EventKind::Disturbance,
                    _ => EventKind::Other,
                };
                match list.last_mut() {
                    Some((sample, last)) if *sample == start => {
                        if last.kind != kind {
                            last.kind = EventKind::Other;
                        }
                    }
                    _ => list.push((start, begin(event.at, kind))),
                }
            }
        }
        if list.first().is_none_or(|(sample, _)| *sample > 0) {
            list.insert(0, (0, begin(0.0, EventKind::Start)));
        }
        Self { list, current: 0 }
    }

    fn enter(&mut self, k: u64) {
        while self.list.get(self.current + 1).is_some_and(|(start, _)| *start <= k) {
            self.current += 1;
        }
    }

    fn now(&mut self) -> &mut Stretch {
        &mut self.list[self.current].1
    }

    fn sample(&mut self, ts: f64, e: f64, u_before: f64, u: f64) {
        self.now().metrics.add_sample(ts, e, u_before, u);
    }

    fn step(&mut self, t0: f64, e0: f64, t1: f64, e1: f64) {
        let stretch = self.now();
        let at = stretch.at;
        stretch.metrics.add_step((t0 - at, e0), (t1 - at, e1));
    }

    fn finish(self) -> (Vec<Stretch>, Metrics) {
        // An event behind the last sample begins nothing.
        let entered = self.list.into_iter().take(self.current + 1);
        let list: Vec<Stretch> = entered.map(|(_, stretch)| stretch).collect();
        let total = list.iter().fold(Metrics::default(), |sum, s| sum.plus(&s.metrics));
        (list, total)
    }
}
