//! Runs of the deployed loop for the pictures of its card.

use super::Trial;
use super::deployed::{Deployed, Point};
use crate::output::table::format_number;
use crate::scenario::{Actuator, Change, Event, Initial, Noise, Scenario, Sensor, Signal};
use crate::simulate::{ControllerResult, Precision, RunOptions, RunResult, View, run};
use controller_core::Real;
use controller_design::margins::Margins;

/// Share of its largest value below which an error counts as over.
pub(super) const OVER: f64 = 0.02;
/// Most samples of a run: their memory stays below 100 MB.
const MOST: f64 = 3e5;
/// Bands of a picture: a page may have several cards.
const COLUMNS: usize = 280;
/// Samples of noise in the picture.
const NOISY: f64 = 280.0;
/// Standard deviation of that noise as a share of the step of the set-point, where the file says none.
const SHARE: f64 = 0.01;

/// The loop alone, from rest at `initial`, without noise.
pub(super) fn scenario<T: Real>(
    deployed: &Deployed<'_, T>,
    initial: Initial,
    duration: f64,
    events: Vec<(f64, &str, Change)>,
) -> Scenario {
    let event = |(at, label, change): (f64, &str, Change)| Event {
        at,
        label: label.to_owned(),
        changes: vec![change],
        controller: None,
    };
    Scenario {
        title: String::new(),
        description: String::new(),
        duration,
        substeps: 4,
        initial,
        events: events.into_iter().map(event).collect(),
        controllers: vec![deployed.spec.clone()],
        noise: None,
        sensor: Sensor::default(),
        ..deployed.scenario.clone()
    }
}

/// Runs it and keeps what a picture needs, and every sample.
pub(super) fn simulate(scenario: &Scenario, precision: Precision) -> Result<RunResult, String> {
    let record = Some(View { columns: COLUMNS, ..View::whole(scenario.duration) });
    let options = RunOptions { precision, record, trace: true, ..RunOptions::default() };
    run(scenario, options).map_err(|error| error.to_string())
}

/// The only controller of a trial.
pub(super) fn only(result: &RunResult) -> Option<&ControllerResult> {
    result.controllers.first()
}

/// A step of the set-point and, when that is over, one of the load; with the time that was waited for each \[s\].
pub(super) fn steps<T: Real>(
    deployed: &Deployed<'_, T>,
    margins: &Margins,
    precision: Precision,
) -> Result<(f64, Trial), String> {
    let Point { y0, d0, setpoint, load, .. } = deployed.point;
    let ts = deployed.scenario.ts;
    let longest = MOST * ts / 2.0;
    let mut window = first_window(deployed, margins).min(longest);
    loop {
        let to = Change::Setpoint(Signal::Step(y0 + setpoint));
        let under = Change::Disturbance(Signal::Step(d0 + load));
        let events = vec![(0.0, "set-point", to), (window, "load", under)];
        let initial = Initial { setpoint: y0, disturbance: d0 };
        let scenario = scenario(deployed, initial, 2.0 * window, events);
        let mut result = simulate(&scenario, precision)?;
        let over = only(&result).is_some_and(|one| {
            let middle = one.trace.len() / 2;
            [&one.trace[..middle], &one.trace[middle..]].iter().all(|part| is_over(part))
        });
        if over || window >= longest {
            forget(&mut result);
            let iae: Vec<String> = only(&result)
                .into_iter()
                .flat_map(|one| &one.events)
                .map(|stretch| format_number(stretch.metrics.iae))
                .collect();
            let end = if over { "" } else { " It is not over in the time shown." };
            let text = format!(
                "The law that is flashed on the plant of the file, without noise: a step of the set-point, then one of the \
                 load at the plant's input; IAE {}.{end}",
                iae.join(" and ")
            );
            return Ok((window, Trial { title: "Step of set-point and load", text, scenario, result }));
        }
        window = (2.0 * window).min(longest);
    }
}

/// Samples are needed for measuring only.
pub(super) fn forget(result: &mut RunResult) {
    for one in &mut result.controllers {
        one.trace = Vec::new();
    }
}

/// A first guess of how long a response takes \[s\], in whole samples.
fn first_window<T: Real>(deployed: &Deployed<'_, T>, margins: &Margins) -> f64 {
    let ts = deployed.scenario.ts;
    let dead = deployed.scenario.plant.dead_time() + deployed.scenario.latency;
    let swing = if margins.omega_ms > 0.0 { 12.0 / margins.omega_ms } else { 0.0 };
    let samples = ((swing + 4.0 * dead) / ts).clamp(50.0, MOST / 8.0).ceil();
    samples * ts
}

/// Whether the error of the last fifth has come to rest: it is small, or moves no more.
fn is_over(part: &[crate::simulate::Sample]) -> bool {
    let size = |s: &crate::simulate::Sample| (s.r - s.y).abs();
    let largest = part.iter().map(size).fold(0.0, f64::max);
    let last = part.get(part.len() * 4 / 5..).unwrap_or_default();
    let end = last.last().map_or(0.0, |s| s.r - s.y);
    last.iter().all(|s| ((s.r - s.y) - end).abs() <= OVER * largest)
        && (end.abs() <= OVER * largest
            || last.first().is_some_and(|s| ((s.r - s.y) - end).abs() <= 1e-3 * largest))
}

/// The loop at rest under the noise of the file, or under some of a hundredth of the set-point's step.
pub(super) fn noise<T: Real>(deployed: &Deployed<'_, T>, precision: Precision) -> Option<Trial> {
    let Point { y0, d0, setpoint, .. } = deployed.point;
    let said = deployed.scenario.noise.filter(|noise| noise.std > 0.0);
    let noise = said.unwrap_or(Noise { std: SHARE * setpoint.abs(), seed: 1 });
    let ts = deployed.scenario.ts;
    let initial = Initial { setpoint: y0, disturbance: d0 };
    let mut scenario = scenario(deployed, initial, NOISY * ts, Vec::new());
    scenario.noise = Some(noise);
    scenario.actuator = Actuator::default();
    let mut result = simulate(&scenario, precision).ok()?;
    forget(&mut result);
    let whose = if said.is_some() {
        "the noise of the file"
    } else {
        "white noise of a hundredth of the set-point's step"
    };
    let text = format!("{NOISY} samples at rest under {whose}.");
    Some(Trial { title: "Noise at rest", text, scenario, result })
}
