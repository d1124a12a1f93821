//! What the loop does when its output comes to its limits.

use super::Trial;
use super::deployed::Deployed;
use super::trials::{forget, only, scenario, simulate};
use crate::scenario::{Actuator, Change, Initial, Scenario, Signal};
use crate::simulate::{Precision, RunResult, Sample};
use controller_core::{LimitConfig, Real, Status};

/// How far beyond reach the set-point goes, and where it comes back to, as shares of what the output can reach.
const BEYOND: f64 = 1.2;
const BACK: f64 = 0.5;
/// Half the width of assumed limits, in times of what the output moves by with the set-point's step.
const ASSUMED: f64 = 1.5;
/// Error that counts as recovered, as a share of the step back.
pub(super) const BAND: f64 = 0.05;
/// Samples in a row that the output must be at its limit.
const HELD: usize = 5;
/// The least part of the window that the output of an integrating plant must be there.
const LONG: f64 = 0.05;
/// Most times that the step of an integrating plant is doubled.
const DOUBLINGS: usize = 24;

/// What was found.
#[derive(Debug, Clone)]
pub(super) struct AtLimits {
    /// Until the error stays within [`BAND`] of the step \[s\].
    pub(super) recovery: f64,
    /// Beyond the set-point, as a share of the step, in per cent.
    pub(super) overshoot: f64,
    /// The same two of the same step without limits.
    pub(super) free: (f64, f64),
    /// The range of the output \[u\].
    pub(super) range: (f64, f64),
    /// Whether the file says that range.
    pub(super) said: bool,
    pub(super) trial: Trial,
}

/// Drives the output to its limit and lets it come back. A plant that comes to rest is asked for more than the output can
/// reach, for the time `window` \[s\] that its steps take, and then for half of what it can; an integrating one gets a step
/// that is large enough.
///
/// # Errors
/// Why there is nothing to be measured.
pub(super) fn at_limits<T: Real>(
    deployed: &Deployed<'_, T>,
    window: f64,
    precision: Precision,
) -> Result<AtLimits, String> {
    if deployed.scenario.plant.poles().iter().any(|pole| pole.re > 0.0) {
        return Err("an unstable plant runs away while its input is at a limit".to_owned());
    }
    let (range, said) = range(deployed)?;
    match deployed.static_gain() {
        Some(gain) => beyond_reach(deployed, (range, said), gain, window, precision),
        None => large_step(deployed, (range, said), window, precision),
    }
}

/// The limits of the file, or assumed ones.
fn range<T: Real>(deployed: &Deployed<'_, T>) -> Result<((f64, f64), bool), String> {
    let (range, said) = deployed.range();
    if said {
        return Ok((range, true));
    }
    let point = &deployed.point;
    let kick = deployed.sampled.law().step_gain() * point.setpoint;
    let moved = deployed.static_gain().map_or(0.5 * kick, |gain| point.setpoint / gain).abs();
    if !(moved.is_finite() && moved > 0.0) {
        return Err("the file has no limits of the output, and none can be assumed".to_owned());
    }
    Ok(((point.u0 - ASSUMED * moved, point.u0 + ASSUMED * moved), false))
}

/// The loop with `range` as the limits of its output, whoever has them in the file.
fn limited(mut scenario: Scenario, (range, said): ((f64, f64), bool)) -> Scenario {
    if !said {
        scenario.actuator = Actuator::default();
        for spec in &mut scenario.controllers {
            spec.config.limits = LimitConfig { lo: range.0, hi: range.1, ..spec.config.limits };
        }
    }
    scenario
}

/// The loop without limits of its output.
fn free(mut scenario: Scenario) -> Scenario {
    const WIDE: f64 = 1e12;
    scenario.actuator = Actuator::default();
    for spec in &mut scenario.controllers {
        spec.config.limits = LimitConfig { lo: -WIDE, hi: WIDE, ..spec.config.limits };
    }
    scenario
}

fn beyond_reach<T: Real>(
    deployed: &Deployed<'_, T>,
    range: ((f64, f64), bool),
    gain: f64,
    window: f64,
    precision: Precision,
) -> Result<AtLimits, String> {
    let point = &deployed.point;
    let (lo, hi) = range.0;
    if !(lo..=hi).contains(&point.u0) {
        return Err("the output at rest is not within its limits".to_owned());
    }
    let limit = if hi - point.u0 >= point.u0 - lo { hi } else { lo };
    let reach = gain * (limit - point.u0);
    let config = &deployed.spec.config;
    let [top, far, back] = [1.0, BEYOND, BACK].map(|share| point.y0 + share * reach);
    if !(config.setpoint.lo..=config.setpoint.hi).contains(&far) {
        return Err("the range of the set-point keeps the output off its limits".to_owned());
    }
    if !(config.measurement_lo..=config.measurement_hi).contains(&top) {
        return Err("at its limit the output takes the measurement out of its range".to_owned());
    }
    let at = Initial { setpoint: point.y0, disturbance: point.d0 };
    let events = vec![
        (0.0, "out of reach", Change::Setpoint(Signal::Step(far))),
        (window, "within reach", Change::Setpoint(Signal::Step(back))),
    ];
    let tried = limited(scenario(deployed, at, 3.0 * window, events), range);
    let mut result = simulate(&tried, precision)?;
    let from = samples(&tried, window);
    let trace = only(&result).map_or(&[][..], |one| &one.trace);
    let held = trace
        .get(from.saturating_sub(HELD)..from)
        .is_some_and(|part| part.iter().all(|s| is_limited(s, range.0)));
    if !held {
        return Err(
            "the output does not come to its limit: nothing integrates, or a deadband holds it".to_owned()
        );
    }
    let step = back - top;
    let (recovery, overshoot) = settled(trace.get(from..).unwrap_or_default(), (back, step), tried.ts);
    let start = Initial { setpoint: top, disturbance: point.d0 };
    let alone = vec![(0.0, "within reach", Change::Setpoint(Signal::Step(back)))];
    let alone = simulate(&free(scenario(deployed, start, 2.0 * window, alone)), precision)?;
    let free = only(&alone).map_or((f64::NAN, f64::NAN), |one| settled(&one.trace, (back, step), tried.ts));
    forget(&mut result);
    let text =
        "The set-point goes where the output cannot follow and comes back to half of what it can reach.";
    Ok(found((recovery, overshoot), free, range, text, tried, result))
}

fn large_step<T: Real>(
    deployed: &Deployed<'_, T>,
    range: ((f64, f64), bool),
    window: f64,
    precision: Precision,
) -> Result<AtLimits, String> {
    let point = &deployed.point;
    let config = &deployed.spec.config;
    let at = Initial { setpoint: point.y0, disturbance: point.d0 };
    let mut step = point.setpoint;
    for _ in 0..DOUBLINGS {
        let to = point.y0 + step;
        if !(config.setpoint.lo..=config.setpoint.hi).contains(&to) {
            break;
        }
        let events = || vec![(0.0, "large step", Change::Setpoint(Signal::Step(to)))];
        let tried = limited(scenario(deployed, at, 3.0 * window, events()), range);
        let mut result = simulate(&tried, precision)?;
        let trace = only(&result).map_or(&[][..], |one| &one.trace);
        let Some(first) = held_from(trace, range.0, HELD.max(samples(&tried, LONG * window))) else {
            step *= 2.0;
            continue;
        };
        let left = trace.iter().skip(first).position(|s| !is_limited(s, range.0)).map(|more| first + more);
        let Some(left) = left else {
            return Err("the output does not leave its limit again in the time of the trial".to_owned());
        };
        let (recovery, overshoot) = settled(trace.get(left..).unwrap_or_default(), (to, step), tried.ts);
        let alone = simulate(&free(scenario(deployed, at, 3.0 * window, events())), precision)?;
        let free = only(&alone).map_or((f64::NAN, f64::NAN), |one| settled(&one.trace, (to, step), tried.ts));
        forget(&mut result);
        let text = "A step of the set-point that takes the output to its limit; the recovery is counted from when the output leaves it.";
        return Ok(found((recovery, overshoot), free, range, text, tried, result));
    }
    Err("no step within the range of the set-point takes the output to its limit".to_owned())
}

fn found(
    (recovery, overshoot): (f64, f64),
    free: (f64, f64),
    (range, said): ((f64, f64), bool),
    text: &str,
    scenario: Scenario,
    result: RunResult,
) -> AtLimits {
    let trial = Trial { title: "At the limits of the output", text: text.to_owned(), scenario, result };
    AtLimits { recovery, overshoot, free, range, said, trial }
}

/// Where the first stretch of `count` samples at a limit begins.
fn held_from(trace: &[Sample], range: (f64, f64), count: usize) -> Option<usize> {
    let mut held = 0;
    let end = trace.iter().position(|s| {
        held = if is_limited(s, range) { held + 1 } else { 0 };
        held >= count
    })?;
    Some(end + 1 - count)
}

fn samples(scenario: &Scenario, time: f64) -> usize {
    (time / scenario.ts).round() as usize
}

fn is_limited(s: &Sample, (lo, hi): (f64, f64)) -> bool {
    s.status.has(Status::LIMITED_HIGH)
        || s.status.has(Status::LIMITED_LOW)
        || s.applied >= hi
        || s.applied <= lo
}

/// How long the error of a step takes to stay within the band \[s\], infinite if it does not; by how much the output goes
/// beyond the set-point, in per cent of the step.
fn settled(part: &[Sample], (to, step): (f64, f64), ts: f64) -> (f64, f64) {
    let outside = part.iter().rposition(|s| (s.y - to).abs() > BAND * step.abs());
    let time = match outside {
        None => 0.0,
        Some(last) if last + 1 >= part.len() => f64::INFINITY,
        Some(last) => (last + 1) as f64 * ts,
    };
    let beyond = part.iter().map(|s| (s.y - to) / step).fold(0.0, f64::max);
    (time, 100.0 * beyond)
}
