//! Warnings about how a run fits the ranges of its controllers, as they are at the time.

use super::events::Placed;
use super::fault::{Fault, code};
use super::log::Log;
use super::number::show_short;
use super::oddities::{extent, steady};
use super::places::Places;
use super::{Change, CompensatorSpec, ControllerSpec, Scenario, Signal};
use controller_core::Param;
use std::ops::Range;

/// Warns of set-points, outputs and measurements of the controller `index` outside its ranges.
pub(super) fn warn(scenario: &Scenario, index: usize, events: &[Placed], places: &Places, log: &Log<'_>) {
    let Some(spec) = scenario.controllers.get(index) else { return };
    let concerned = |placed: &&Placed| placed.event.controller.is_none_or(|only| only == index);
    let events: Vec<&Placed> = events.iter().filter(concerned).collect();
    warn_of_start(scenario, spec, &events, places, log);
    let start = scenario.initial.setpoint;
    let mut now = Now { spec, setpoint: start, remote: start, manual: None, rest: scenario.duration };
    // What happens at one time holds together: a wider range may be written below the value that needs it.
    for group in events.chunk_by(|a, b| a.event.at == b.event.at) {
        let before = now.outside();
        let changes = || group.iter().flat_map(|placed| placed.event.changes.iter().zip(&placed.spans));
        let mut parameters = None;
        for (change, span) in changes() {
            match change {
                Change::Parameters(list) => {
                    if let Some((_, spec)) = list.iter().find(|(who, _)| *who == index) {
                        now.spec = spec;
                        parameters = Some(span);
                    }
                }
                Change::Manual(u) => now.manual = Some(*u),
                _ => {}
            }
        }
        now.rest = scenario.duration - group.first().map_or(0.0, |placed| placed.event.at);
        for (change, span) in changes() {
            now.check(change, span, log);
            match change {
                Change::Setpoint(signal) => now.setpoint = steady(signal).unwrap_or(now.setpoint),
                Change::RemoteSetpoint(signal) => now.remote = steady(signal).unwrap_or(now.remote),
                _ => {}
            }
        }
        // A range that moved away from a value that stays.
        if let Some(span) = parameters {
            let is_new = |what: &str, value: f64| before.iter().all(|(w, v, _)| *w != what || *v != value);
            for (_, _, message) in now.outside().iter().filter(|(what, value, _)| is_new(what, *value)) {
                if !log.has_warning(message) {
                    log.warn(Fault::new(code::CLAMPED, span.clone(), message.clone()));
                }
            }
        }
    }
}

/// Warns of a start that is not at rest, and of outputs of the controller that its limits do not allow.
fn warn_of_start(
    scenario: &Scenario,
    spec: &ControllerSpec,
    events: &[&Placed],
    places: &Places,
    log: &Log<'_>,
) {
    let span_in = |places: &Places, params: [Param; 2]| {
        let setting = params.into_iter().find_map(|param| places.of(param));
        setting.map_or(places.whole.clone(), |setting| setting.span.clone())
    };
    let span = |params| span_in(places, params);
    let (limits, config) = ([spec.config.limits.lo, spec.config.limits.hi], &spec.config);
    let [own, driving] = initial_outputs(scenario, spec);
    let inner = spec.secondary.as_deref().zip(places.inner.as_deref());
    let inner = inner.map(|(spec, places)| (spec, places, driving));
    for (spec, places, output) in [(spec, places, own)].into_iter().chain(inner) {
        let limits = [spec.config.limits.lo, spec.config.limits.hi];
        // What is computed to rest at a limit may be a rounding beyond it.
        let slack = 1e-9 * (limits[1] - limits[0]);
        if is_outside(output, [limits[0] - slack, limits[1] + slack]) {
            let what = format!("the output {} that holds the initial state", show_short(output));
            let message = outside(&what, "limits", spec, limits, "the run does not start at rest");
            let place = span_in(places, [Param::OutputLo, Param::OutputHi]);
            log.warn(Fault::new(code::CLAMPED, place, message));
        }
    }
    let at_start = scenario.initial.setpoint;
    let measurement = [config.measurement_lo, config.measurement_hi];
    if is_outside(at_start, measurement) {
        let what = format!("the initial measurement {}", show_short(at_start));
        let message = outside(&what, "measurement", spec, measurement, "the run starts with bad samples");
        let place = span([Param::MeasurementLo, Param::MeasurementHi]);
        let help = "write where the run starts in `[initial]`";
        log.warn(Fault::new(code::OUT_OF_MEASUREMENT, place, message).help(help));
    }
    let replaced = events.iter().filter(|placed| placed.event.at == 0.0).any(|placed| {
        placed
            .event
            .changes
            .iter()
            .any(|change| matches!(change, Change::Setpoint(_) | Change::Parameters(_)))
    });
    let setpoints = [config.setpoint.lo, config.setpoint.hi];
    if !replaced && is_outside(at_start, setpoints) {
        let what = format!("the initial set-point {}", show_short(at_start));
        let message = outside(&what, "setpoint", spec, setpoints, "the controller clamps it");
        log.warn(Fault::new(code::CLAMPED, span([Param::SetpointLo, Param::SetpointHi]), message));
    }
    let written = places.of(Param::InitialOutput).filter(|_| is_outside(config.initial_output, limits));
    if let Some(setting) = written {
        let what = format!("the initial output {}", show_short(config.initial_output));
        let message = outside(&what, "limits", spec, limits, "the controller clamps it");
        log.warn(Fault::new(code::CLAMPED, setting.span.clone(), message));
    }
}

/// Warns of a switch for a compensator that is not there.
pub(super) fn warn_of_compensators(scenario: &Scenario, events: &[Placed], log: &Log<'_>) {
    let has_one = |spec: &ControllerSpec| spec.compensator != CompensatorSpec::None;
    for Placed { event, spans } in events {
        let message = match event.controller.and_then(|index| scenario.controllers.get(index)) {
            Some(spec) if !has_one(spec) => {
                format!("controller `{}` has no compensator to switch", spec.name)
            }
            None if !scenario.controllers.iter().any(has_one) => {
                "no controller has a compensator to switch".to_owned()
            }
            _ => continue,
        };
        for (_, span) in event.changes.iter().zip(spans).filter(|(c, _)| matches!(c, Change::Compensator(_)))
        {
            let help = "an `estimator` or an `observer` of the controller is its compensator";
            let warning = Fault::new(code::NO_EFFECT, span.clone(), message.clone()).help(help);
            log.warn(Fault { controller: event.controller, ..warning });
        }
    }
}

/// A controller and its inputs at a time of the run.
struct Now<'a> {
    spec: &'a ControllerSpec,
    /// The steady levels of the set-points.
    setpoint: f64,
    remote: f64,
    manual: Option<f64>,
    /// Seconds to the end of the run.
    rest: f64,
}

impl Now<'_> {
    /// Warns of one change.
    fn check(&self, change: &Change, span: &Range<usize>, log: &Log<'_>) {
        let warn = |code, message| log.warn(Fault::new(code, span.clone(), message));
        let config = &self.spec.config;
        let clamped = |what: &str, value: f64, key: &str, range: [f64; 2]| {
            let what = format!("the {what} {}", show_short(value));
            is_outside(value, range)
                .then(|| outside(&what, key, self.spec, range, "the controller clamps it"))
        };
        let limits = [config.limits.lo, config.limits.hi];
        let message = match change {
            Change::Setpoint(signal) => self.check_setpoint("set-point", signal, self.setpoint, span, log),
            Change::RemoteSetpoint(signal) => {
                self.check_setpoint("remote set-point", signal, self.remote, span, log)
            }
            Change::Manual(u) => clamped("manual output", *u, "limits", limits),
            Change::Track(u) => clamped("track output", *u, "limits", limits),
            Change::Offset(u) => clamped("offset", *u, "offset", [config.offset_lo, config.offset_hi]),
            _ => None,
        };
        if let Some(message) = message {
            warn(code::CLAMPED, message);
        }
    }

    /// Warns of a set-point outside the valid measurements; the message when it is outside its own range.
    fn check_setpoint(
        &self,
        name: &str,
        signal: &Signal,
        level: f64,
        span: &Range<usize>,
        log: &Log<'_>,
    ) -> Option<String> {
        let config = &self.spec.config;
        let [least, most] = extent(signal, level, self.rest)?;
        let is_step = matches!(signal, Signal::Step(_));
        let say = |key: &str, range: [f64; 2], effect: &str| {
            let far = [least, most].into_iter().find(|value| is_outside(*value, range))?;
            let shown = show_short(far);
            let what = if is_step {
                format!("the {name} {shown}")
            } else {
                format!("the {name}, which reaches {shown},")
            };
            Some(outside(&what, key, self.spec, range, effect))
        };
        let own = say("setpoint", [config.setpoint.lo, config.setpoint.hi], "the controller clamps it");
        let measurement = [config.measurement_lo, config.measurement_hi];
        if own.is_none()
            && let Some(message) = say("measurement", measurement, "a measurement there is bad")
        {
            log.warn(Fault::new(code::OUT_OF_MEASUREMENT, span.clone(), message));
        }
        own
    }

    /// What is outside its range now: which, its value, and how to say it.
    fn outside(&self) -> Vec<(&'static str, f64, String)> {
        let config = &self.spec.config;
        let limits = [config.limits.lo, config.limits.hi];
        let setpoints = [config.setpoint.lo, config.setpoint.hi];
        let all = [
            ("the set-point", Some(self.setpoint), "setpoint", setpoints),
            ("the manual output", self.manual, "limits", limits),
        ];
        all.into_iter()
            .filter_map(|(what, value, key, range)| {
                let value = value.filter(|value| is_outside(*value, range))?;
                let shown = format!("{what} {}", show_short(value));
                Some((what, value, outside(&shown, key, self.spec, range, "the controller clamps it")))
            })
            .collect()
    }
}

fn is_outside(value: f64, [lo, hi]: [f64; 2]) -> bool {
    value < lo || value > hi
}

/// "WHAT is outside `KEY` of `NAME`, LO to HI: EFFECT".
fn outside(what: &str, key: &str, spec: &ControllerSpec, [lo, hi]: [f64; 2], effect: &str) -> String {
    format!(
        "{what} is outside `{key}` of `{}`, {} to {}: {effect}",
        spec.name,
        show_short(lo),
        show_short(hi)
    )
}

/// The outputs at rest at the initial set-point: of the controller itself, and of the one that drives the actuator \[u\].
fn initial_outputs(scenario: &Scenario, spec: &ControllerSpec) -> [f64; 2] {
    let at_rest = |integrators: usize, gain: f64| {
        if integrators > 0 { 0.0 } else { scenario.initial.setpoint / gain }
    };
    let plant = &scenario.plant;
    if let Some(nonlinear) = &scenario.nonlinear {
        let rest = nonlinear.rest(scenario.initial.setpoint, scenario.initial.disturbance);
        return [rest.map_or(0.0, |(_, u0)| u0); 2];
    }
    let driving = at_rest(plant.integrators(), plant.gain()) - scenario.initial.disturbance;
    match &scenario.inner_plant {
        Some(inner) if spec.secondary.is_some() => {
            let outer = plant.integrators().saturating_sub(inner.integrators());
            [at_rest(outer, plant.gain() / inner.gain()), driving]
        }
        _ => [driving; 2],
    }
}
