//! Warnings about how the parts of a run fit together: sensor and set-points, actuator and limits, recordings and the
//! length of the run.

use super::events::Placed;
use super::fault::{Fault, code};
use super::log::Log;
use super::number::show_short;
use super::{Change, Recording, Scenario, Signal};
use std::ops::Range;

/// Where the tables are that a warning may be about.
#[derive(Debug, Default)]
pub(super) struct Tables {
    pub(super) sensor: Option<Range<usize>>,
    pub(super) actuator: Option<Range<usize>>,
}

/// Warns of everything here.
pub(super) fn warn(scenario: &Scenario, events: &[Placed], tables: &Tables, log: &Log<'_>) {
    warn_of_sensor(scenario, events, tables, log);
    warn_of_actuator(scenario, tables, log);
    for (index, placed) in events.iter().enumerate() {
        for (change, span) in placed.event.changes.iter().zip(&placed.spans) {
            let later = events.get(index + 1..).unwrap_or_default();
            warn_of_length(scenario, &placed.event, change, later, span, log);
            warn_of_short_pulse(scenario, change, span, log);
        }
    }
}

/// The lowest and the highest value of a signal that begins at the steady level `level` and goes on for `rest` seconds;
/// none for a random walk, which has no bounds.
pub(super) fn extent(signal: &Signal, level: f64, rest: f64) -> Option<[f64; 2]> {
    let between = |a: f64, b: f64| Some([a.min(b), a.max(b)]);
    match signal {
        Signal::Step(value) => Some([*value; 2]),
        Signal::Ramp { slope, duration } => between(level, level + slope * duration.min(rest)),
        Signal::Pulse { height, .. } => between(level, level + height),
        Signal::Sine { amplitude, .. } => between(level - amplitude, level + amplitude),
        Signal::Walk { .. } => None,
        Signal::Recorded(recording) => {
            let start = [f64::INFINITY, f64::NEG_INFINITY];
            Some(recording.values.iter().fold(start, |[lo, hi], &x| [lo.min(x), hi.max(x)]))
        }
    }
}

/// A set-point that the sensor cannot show is never reached.
fn warn_of_sensor(scenario: &Scenario, events: &[Placed], tables: &Tables, log: &Log<'_>) {
    let [lo, hi] = [scenario.sensor.lo, scenario.sensor.hi];
    let outside =
        |[least, most]: [f64; 2]| if least < lo { Some(least) } else { (most > hi).then_some(most) };
    let range = format!("the range of the sensor, {} to {}", show_short(lo), show_short(hi));
    let mut level = scenario.initial.setpoint;
    if let (Some(value), Some(place)) = (outside([level; 2]), &tables.sensor) {
        let message = format!(
            "the initial set-point {} is outside {range}: the run does not start at rest",
            show_short(value)
        );
        log.warn(Fault::new(code::OUT_OF_MEASUREMENT, place.clone(), message));
    }
    for placed in events {
        let rest = scenario.duration - placed.event.at;
        for (change, span) in placed.event.changes.iter().zip(&placed.spans) {
            let (Change::Setpoint(signal) | Change::RemoteSetpoint(signal)) = change else { continue };
            if let Some(value) = extent(signal, level, rest).and_then(outside) {
                let message = format!(
                    "the set-point {} is outside {range}: the loop never gets there",
                    show_short(value)
                );
                log.warn(Fault::new(code::OUT_OF_MEASUREMENT, span.clone(), message));
            }
            if let (Change::Setpoint(signal), None) = (change, placed.event.controller) {
                level = steady(signal).unwrap_or(level);
            }
        }
    }
}

/// The steady level that a signal leads to.
pub(super) fn steady(signal: &Signal) -> Option<f64> {
    match signal {
        Signal::Step(value) => Some(*value),
        Signal::Recorded(recording) => recording.values.last().copied(),
        _ => None,
    }
}

/// A controller that goes on where the actuator has stopped, and is not told.
fn warn_of_actuator(scenario: &Scenario, tables: &Tables, log: &Log<'_>) {
    let (actuator, Some(place)) = (&scenario.actuator, &tables.actuator) else { return };
    if actuator.read_back {
        return;
    }
    for spec in &scenario.controllers {
        let driving = spec.secondary.as_deref().unwrap_or(spec);
        let limits = &driving.config.limits;
        let is_wider = limits.lo < actuator.lo || limits.hi > actuator.hi;
        let effect = match driving.adrc {
            Some(_) => "the observer is misled",
            None => "the integral term winds up",
        };
        if is_wider && (driving.config.pid.ki != 0.0 || driving.adrc.is_some()) {
            let message = format!(
                "`{}` goes from {} to {}, the actuator from {} to {} only: {effect}",
                driving.name,
                show_short(limits.lo),
                show_short(limits.hi),
                show_short(actuator.lo),
                show_short(actuator.hi)
            );
            let help =
                "write `read_back = true` in `[actuator]`, or `limits` of the controller that are no wider";
            log.warn(Fault::new(code::WIND_UP, place.clone(), message).help(help));
            // The others are written alike.
            return;
        }
    }
}

/// A recording that ends long before what it is for, or long after the run.
fn warn_of_length(
    scenario: &Scenario,
    event: &super::Event,
    change: &Change,
    later: &[Placed],
    span: &Range<usize>,
    log: &Log<'_>,
) {
    let recording = match change {
        Change::Setpoint(Signal::Recorded(recording))
        | Change::RemoteSetpoint(Signal::Recorded(recording))
        | Change::Disturbance(Signal::Recorded(recording))
        | Change::Measurement(Some(recording)) => recording,
        _ => return,
    };
    let replaces = |other: &Change| match (change, other) {
        (Change::Setpoint(_), Change::Setpoint(signal))
        | (Change::RemoteSetpoint(_), Change::RemoteSetpoint(signal))
        | (Change::Disturbance(_), Change::Disturbance(signal)) => steady(signal).is_some(),
        (Change::Measurement(_), Change::Measurement(_)) => true,
        _ => false,
    };
    if later.iter().any(|placed| placed.event.changes.iter().any(replaces)) {
        return;
    }
    let Some((last, gap)) = length(recording) else { return };
    let (end, slack) = (event.at + last, 2.0 * gap.max(scenario.ts));
    let message = if end < scenario.duration - slack {
        format!(
            "`{}` ends at {} s, the run at {} s: its last value holds from there",
            recording.name,
            show_short(end),
            show_short(scenario.duration)
        )
    } else if end > scenario.duration + slack {
        format!(
            "`{}` goes on to {} s, the run ends at {} s: the rest is not used",
            recording.name,
            show_short(end),
            show_short(scenario.duration)
        )
    } else {
        return;
    };
    log.warn(Fault::new(code::RECORDING, span.clone(), message).help("change the `duration` of the run"));
}

/// The last time and the mean distance of the rows; none for a single row, which is a constant.
fn length(recording: &Recording) -> Option<(f64, f64)> {
    let last = recording.times.last().copied().filter(|last| *last > 0.0)?;
    #[allow(clippy::cast_precision_loss)] // a mean for a message
    let rows = recording.times.len() as f64;
    Some((last, last / (rows - 1.0)))
}

/// A controller looks at its set-point once a sample.
fn warn_of_short_pulse(scenario: &Scenario, change: &Change, span: &Range<usize>, log: &Log<'_>) {
    let (Change::Setpoint(signal) | Change::RemoteSetpoint(signal)) = change else { return };
    if let Signal::Pulse { duration, .. } = signal
        && *duration < scenario.ts
    {
        let message = format!(
            "a pulse of {} s is shorter than a sample, {} s: no controller may see it",
            show_short(*duration),
            show_short(scenario.ts)
        );
        log.warn(Fault::new(code::ALIASING, span.clone(), message));
    }
}
