//! The run of one controller, sample by sample.

use super::actuator::Positioner;
use super::control::{Control, Sink};
use super::curve::Curve;
use super::plant_side::PlantSide;
use super::record::Record;
use super::remarks::{Remark, Watch};
use super::run::{ControllerResult, InnerSample, RunError, RunOptions, Sample};
use super::secondary::{Secondary, Timing};
use super::sensor::{Measuring, Replay};
use super::shadowed::{NotBuilt, Shadowed};
use super::stretches::{Stretches, sample_of};
use crate::pil::{Compared, LinkError, Target};
use crate::scenario::{Change, ControllerSpec, Scenario, Signal};
use controller_core::{ConfigErrors, ControllerInput, ControllerOutput, Mode, Quality, Real, Status};

/// Samples between two looks at the control.
const CHECKED_EVERY: u64 = 4096;

/// The loop of one controller, and what the events have made of its inputs.
struct Loop<T: Real> {
    ts: f64,
    law: Shadowed<T>,
    input: ControllerInput<T>,
    output: ControllerOutput<T>,
    secondary: Option<Secondary<T>>,
    plant: PlantSide,
    /// The local and the remote set-point.
    setpoints: [Curve; 2],
    measuring: Measuring,
    replay: Option<Replay>,
    positioner: Positioner,
    read_back: bool,
    /// Bad and lost samples still to come.
    bad: u32,
    lost: u32,
    /// The output that drives the actuator \[u\].
    u: f64,
}

/// What a sample brought.
struct Now {
    r: f64,
    /// The plant's output, or what is replayed instead of it \[y\].
    exact: f64,
    y: f64,
    before: f64,
    applied: f64,
    lost: bool,
    inner: Option<InnerSample>,
}

impl<T: Real> Loop<T> {
    fn new(
        scenario: &Scenario,
        index: usize,
        spec: &ControllerSpec,
        pil: Option<&'static Target>,
    ) -> Result<Self, RunError> {
        let refused = |why| match why {
            NotBuilt::Refused(faults) => RunError::Controller { index, faults },
            NotBuilt::Board(error) => RunError::Board { index, error },
        };
        let (ts, initial) = (scenario.ts, scenario.initial);
        let no_rest = RunError::NoRest { setpoint: initial.setpoint };
        let disturbances = signals(scenario, index, |change| match change {
            Change::Disturbance(signal) => Some(signal),
            _ => None,
        });
        let (latency, substeps) = (scenario.latency, scenario.substeps);
        let (plant, u0) = PlantSide::new(scenario, &disturbances).ok_or_else(|| no_rest.clone())?;
        let secondary = match (&spec.secondary, &scenario.inner_plant) {
            (Some(inner), Some(part)) => {
                let timing = Timing { ts, latency, substeps, pil };
                let built = Secondary::new(inner, part, timing, (initial.disturbance, u0), &disturbances);
                Some(built.map_err(refused)?.ok_or(no_rest)?)
            }
            _ => None,
        };
        let memory = capacity(scenario, index);
        let mut law = Shadowed::<T>::new(spec, ts, latency, memory, pil).map_err(refused)?;
        let own_u0 = secondary.as_ref().map_or(u0, |inner| inner.y0);
        law.settle(spec.mode, initial.setpoint, initial.setpoint, own_u0);

        let r0 = T::from_f64(initial.setpoint);
        let local = signals(scenario, index, |change| match change {
            Change::Setpoint(signal) => Some(signal),
            _ => None,
        });
        let remote = signals(scenario, index, |change| match change {
            Change::RemoteSetpoint(signal) => Some(signal),
            _ => None,
        });
        Ok(Self {
            ts,
            law,
            input: ControllerInput { r: r0, r_remote: r0, mode: spec.mode, ..ControllerInput::default() },
            output: ControllerOutput { mode: spec.mode, ..ControllerOutput::default() },
            secondary,
            plant,
            setpoints: [local, remote].map(|list| Curve::new(initial.setpoint, &list, 0.0, ts)),
            measuring: Measuring::new(scenario.sensor, scenario.noise),
            replay: None,
            positioner: Positioner::new(scenario.actuator, ts, u0),
            read_back: scenario.actuator.read_back,
            bad: 0,
            lost: 0,
            u: u0,
        })
    }

    /// What an event changes; set-points and disturbances have their curves.
    fn apply(&mut self, change: &Change, index: usize, t: f64) -> Result<(), ConfigErrors> {
        let input = &mut self.input;
        match change {
            Change::Setpoint(_) | Change::RemoteSetpoint(_) | Change::Disturbance(_) => {}
            Change::Measurement(recording) => {
                self.replay = recording.as_ref().map(|recording| Replay::new(recording, t, self.ts));
            }
            Change::Mode(mode) => input.mode = *mode,
            Change::Manual(u) => input.manual = Some(T::from_f64(*u)),
            Change::Track(u) => input.track = T::from_f64(*u),
            Change::Offset(u) => input.offset = T::from_f64(*u),
            Change::Compensator(on) => input.compensate = *on,
            Change::BadSamples(n) => self.bad = *n,
            Change::LostSamples(n) => self.lost = *n,
            Change::Acknowledge => input.acknowledge = true,
            Change::Parameters(list) => {
                if let Some((_, spec)) = list.iter().find(|(who, _)| *who == index) {
                    self.law.adopt(spec)?;
                }
            }
        }
        Ok(())
    }

    /// The controllers' part of sample `s`, a whole number.
    #[inline(always)]
    fn sample(&mut self, s: f64) -> Now {
        let [local, remote] = self.setpoints.each_mut().map(|curve| curve.advance_to(s));
        let r = if self.input.mode == Mode::Cascade { remote } else { local };
        let (exact, shown) = match &mut self.replay {
            Some(replay) => {
                let y = replay.value(self.plant.time());
                (y, y)
            }
            None => {
                let exact = self.plant.measure();
                (exact, self.measuring.show(exact))
            }
        };
        let before = self.u;
        let lost = self.lost > 0;
        let bad = self.bad > 0;
        let y = if lost || bad { f64::NAN } else { shown };
        let mut inner = None;
        if lost {
            // The task does not run; the output stays.
            self.lost -= 1;
            self.law.advance(1);
            if let Some(secondary) = &mut self.secondary {
                secondary.lose();
                inner = Some(InnerSample { r: secondary.output.r.to_f64(), y: secondary.plant.measure() });
            }
        } else {
            self.step(local, remote, y, bad);
            self.u = match &mut self.secondary {
                None => self.output.u.to_f64(),
                Some(secondary) => {
                    let y = secondary.step(self.output.u);
                    inner = Some(InnerSample { r: self.output.u.to_f64(), y });
                    secondary.output.u.to_f64()
                }
            };
        }
        let applied = self.positioner.apply(self.u);
        self.tell(applied);
        Now { r, exact, y, before, applied, lost, inner }
    }

    /// Why a board cannot be asked any more.
    #[inline]
    fn failure(&self) -> Option<&LinkError> {
        let inner = self.secondary.as_ref().and_then(|inner| inner.law.failure());
        self.law.failure().or(inner)
    }

    /// How the controllers compare with those on the board: the primary one, then the secondary one.
    fn finish(self) -> Result<Option<Compared>, LinkError> {
        let inner = self.secondary.map(|inner| inner.law.finish()).transpose()?.flatten();
        let own = self.law.finish()?;
        Ok(match (own, inner) {
            (Some(own), Some(inner)) => Some(own.and(inner)),
            (own, _) => own,
        })
    }

    fn step(&mut self, local: f64, remote: f64, y: f64, bad: bool) {
        let input = &mut self.input;
        input.r = T::from_f64(local);
        input.r_remote = T::from_f64(remote);
        input.y = T::from_f64(y);
        input.quality = if bad { Quality::Bad } else { Quality::Good };
        self.bad = self.bad.saturating_sub(1);
        self.law.step_into(&self.input, &mut self.output);
        self.input.acknowledge = false;
    }

    /// What the controllers read back before their next sample.
    fn tell(&mut self, applied: f64) {
        match &mut self.secondary {
            None if self.read_back => self.input.u_applied = Some(T::from_f64(applied)),
            None => {}
            Some(secondary) => {
                if self.read_back {
                    secondary.read_back(applied);
                }
                secondary.report(&mut self.input);
            }
        }
    }

    /// What is to be said of the controller, the secondary one's troubles included: its output acts.
    fn status(&self) -> Status {
        self.secondary.as_ref().map_or(self.output.status, |inner| self.output.status | inner.output.status)
    }

    /// The sample as others see it; `d` is the disturbance \[u\].
    fn seen(&self, t: f64, now: &Now, d: f64) -> Sample {
        let acting = self.secondary.as_ref().map_or(&self.output, |inner| &inner.output);
        let late = if now.lost { Status::OVERRUN } else { Status::default() };
        Sample {
            t,
            r: now.r,
            y: now.y,
            u: self.u,
            applied: now.applied,
            u_f: acting.u_f.to_f64(),
            d_hat: acting.d_hat.to_f64(),
            d,
            mode: self.output.mode,
            status: self.status() | late,
            inner: now.inner,
        }
    }
}

/// Runs the controller `index` of `scenario`.
pub(super) fn run_one<T: Real>(
    scenario: &Scenario,
    index: usize,
    options: RunOptions,
    control: &Control,
    sink: &mut Option<&mut dyn Sink>,
) -> Result<ControllerResult, RunError> {
    let spec = &scenario.controllers[index];
    let ts = scenario.ts;
    let mut control_loop = Loop::<T>::new(scenario, index, spec, options.pil)?;
    let mut disturbance = Curve::new(
        scenario.initial.disturbance,
        &signals(scenario, index, |change| match change {
            Change::Disturbance(signal) => Some(signal),
            _ => None,
        }),
        0.0,
        ts,
    );
    let count = sample_of(scenario.duration, ts);
    let mut stretches = Stretches::new(scenario);
    let mut watch = Watch::new(count);
    let mut samples = Vec::new();
    let mut record = options.record.map(|view| Record::new(view, ts, count));
    let mut inner_record = control_loop.secondary.as_ref().and(record.clone());
    if sink.as_deref_mut().is_some_and(|sink| sink.begin(index, &spec.name).is_break()) {
        return Err(RunError::Stopped);
    }
    let watched = options.trace || record.is_some() || sink.is_some();
    let mut events = scenario.events.iter().map(|event| (sample_of(event.at, ts), event)).peekable();
    // The next sample with an event or a look at the control.
    let mut pause = 0;

    for k in 0..count {
        let t = control_loop.plant.time();
        if k >= pause {
            if k % CHECKED_EVERY == 0 && k > 0 {
                control.add(CHECKED_EVERY);
                if control.is_stopped() {
                    return Err(RunError::Stopped);
                }
                if let Some(t) = control_loop.plant.stuck() {
                    return Err(RunError::Stuck { t });
                }
            }
            while let Some((_, event)) = events.next_if(|(due, _)| *due <= k) {
                if event.controller.is_none_or(|only| only == index) {
                    for change in &event.changes {
                        let changed = control_loop.apply(change, index, t);
                        changed.map_err(|faults| RunError::Controller { index, faults: Box::new(faults) })?;
                    }
                }
            }
            let look = (k / CHECKED_EVERY + 1) * CHECKED_EVERY;
            pause = events.peek().map_or(look, |(due, _)| look.min(*due));
        }
        let now = control_loop.sample(k as f64);
        if let Some(error) = control_loop.failure() {
            return Err(RunError::Board { index, error: error.clone() });
        }
        let e = now.r - now.exact;
        let automatic = control_loop.output.mode.is_automatic();
        stretches.sample(t, ts, e, now.before, control_loop.u);
        watch.sample(t, k, e, control_loop.status(), automatic);
        let band = record.as_ref().map_or(0, |record| record.band(k));
        if watched {
            let sample = control_loop.seen(t, &now, disturbance.advance_to(k as f64));
            if let Some(record) = &mut record {
                record.sample(band, &sample);
                record.output(band, now.exact);
            }
            if let (Some(record), Some(inner), Some(secondary)) =
                (&mut inner_record, now.inner, &control_loop.secondary)
            {
                let (mode, status) = (secondary.output.mode, secondary.output.status);
                record.sample(band, &Sample { r: inner.r, y: inner.y, mode, status, ..sample });
                record.output(band, inner.y);
            }
            if sink.as_deref_mut().is_some_and(|sink| sink.sample(&sample).is_break()) {
                return Err(RunError::Stopped);
            }
            if options.trace {
                samples.push(sample);
            }
        }
        let (r, replayed) = (now.r, control_loop.replay.is_some());
        control_loop.plant.hold(now.applied, |step| {
            // What is replayed has no course between the samples.
            let (y0, y1) = if replayed { (now.exact, now.exact) } else { (step.y0, step.y1) };
            stretches.step((step.t0, r - y0), (step.t1, r - y1));
            if let Some(record) = &mut record {
                record.output(band, y1);
            }
        });
        if let Some(secondary) = &mut control_loop.secondary {
            secondary.plant.hold(now.applied, |step| {
                if let Some(record) = &mut inner_record {
                    record.output(band, step.y1);
                }
            });
        }
    }
    control.add(count % CHECKED_EVERY);
    let (events, total) = stretches.finish();
    if let Some(t) = control_loop.plant.stuck() {
        return Err(RunError::Stuck { t });
    }
    let mut remarks = watch.finish(scenario.noise.map_or(0.0, |n| n.std));
    remarks.extend(control_loop.plant.remarks().into_iter().map(|text| Remark { text }));
    let name = spec.name.clone();
    let pil = control_loop.finish().map_err(|error| RunError::Board { index, error })?;
    Ok(ControllerResult { name, events, total, trace: samples, record, inner: inner_record, remarks, pil })
}

/// The signals of one kind that concern a controller, with their times, in order.
fn signals<'a>(
    scenario: &'a Scenario,
    index: usize,
    of_kind: impl Fn(&'a Change) -> Option<&'a Signal>,
) -> Vec<(f64, Signal)> {
    let concerned = scenario.events.iter().filter(|e| e.controller.is_none_or(|only| only == index));
    let changes = concerned.flat_map(|e| e.changes.iter().map(move |c| (e.at, c)));
    changes.filter_map(|(at, change)| of_kind(change).map(|signal| (at, signal.clone()))).collect()
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
