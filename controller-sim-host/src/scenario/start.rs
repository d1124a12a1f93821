//! Warnings about how a run fits the ranges of a controller.

use super::fault::{Fault, code};
use super::log::Log;
use super::number::show_short;
use super::places::Places;
use super::{Change, ControllerSpec, Scenario};
use controller_core::Param;

/// Warns of an output that cannot hold the initial state, and of set-points that the controller clamps.
pub(super) fn warn(scenario: &Scenario, index: usize, spec: &ControllerSpec, places: &Places, log: &Log<'_>) {
    let span = |a: Param, b: Param| {
        places.of(a).or_else(|| places.of(b)).map_or(places.whole.clone(), |setting| setting.span.clone())
    };
    let limits = &spec.config.limits;
    let output = initial_output(scenario);
    if output < limits.lo || output > limits.hi {
        let message = format!(
            "the output {} that holds the initial state is outside `limits` of `{}`, {} to {}: the run does not \
             start at rest",
            show_short(output),
            spec.name,
            show_short(limits.lo),
            show_short(limits.hi)
        );
        log.warn(Fault::new(code::CLAMPED, span(Param::OutputLo, Param::OutputHi), message));
    }
    let range = &spec.config.setpoint;
    let concerned = scenario.events.iter().filter(|event| event.controller.is_none_or(|only| only == index));
    let clamped = concerned.flat_map(|event| &event.changes).find_map(|change| match change {
        Change::Setpoint(r) if *r < range.lo || *r > range.hi => Some(*r),
        _ => None,
    });
    if let Some(r) = clamped {
        let message = format!(
            "the set-point {} is outside `setpoint` of `{}`, {} to {}: the controller clamps it",
            show_short(r),
            spec.name,
            show_short(range.lo),
            show_short(range.hi)
        );
        log.warn(Fault::new(code::CLAMPED, span(Param::SetpointLo, Param::SetpointHi), message));
    }
}

/// The output at rest at the initial set-point \[u\].
fn initial_output(scenario: &Scenario) -> f64 {
    let static_gain = if scenario.plant.integrators() > 0 { f64::INFINITY } else { scenario.plant.gain() };
    scenario.initial.setpoint / static_gain - scenario.initial.disturbance
}
