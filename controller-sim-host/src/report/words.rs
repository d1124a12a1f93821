//! What is said of a scenario in words: events, numbers, modes.

use crate::scenario::{Change, Event, Scenario, Signal, show_short};
use controller_core::Mode;

/// Longest unit that is written out.
const LONGEST_UNIT: usize = 20;

/// A number of a scenario, with at most six digits and true minus signs.
pub(super) fn number(x: f64) -> String {
    show_short(x).replace('-', "\u{2212}")
}

/// `text` with at most `most` characters.
pub(super) fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['\u{2026}']).collect()
}

/// A unit for an axis.
pub(super) fn unit(unit: &str) -> String {
    cut(unit.trim(), LONGEST_UNIT)
}

/// The word for a mode.
pub(super) fn mode(mode: Mode) -> &'static str {
    match mode {
        Mode::Off => "Off",
        Mode::Manual => "Manual",
        Mode::Auto => "Auto",
        Mode::Cascade => "Cascade",
        Mode::Track => "Track",
        Mode::Hold => "Hold",
        Mode::Fallback => "Fallback",
    }
}

/// What an event is called in a picture.
pub(super) fn event(scenario: &Scenario, event: &Event) -> String {
    if event.label.trim().is_empty() { changes(scenario, event) } else { event.label.trim().to_owned() }
}

/// What an event changes.
pub(super) fn changes(scenario: &Scenario, event: &Event) -> String {
    let list: Vec<String> = event.changes.iter().map(|c| change(scenario, c)).collect();
    list.join(", ")
}

fn change(scenario: &Scenario, change: &Change) -> String {
    let (y, u) = (&*scenario.units.y, &*scenario.units.u);
    let valued = |name: &str, x: f64, unit: &str| match unit {
        "" => format!("{name} = {}", number(x)),
        unit => format!("{name} = {} {unit}", number(x)),
    };
    match change {
        Change::Setpoint(s) => signal("r", s, y),
        Change::RemoteSetpoint(s) => signal("remote r", s, y),
        Change::Disturbance(s) => signal("d", s, u),
        Change::Measurement(Some(recording)) => format!("y from {}", recording.name),
        Change::Measurement(None) => "y from the plant".to_owned(),
        Change::Mode(m) => format!("mode {}", mode(*m)),
        Change::Manual(x) => valued("manual output", *x, u),
        Change::Track(x) => valued("track output", *x, u),
        Change::Offset(x) => valued("offset", *x, u),
        Change::Compensator(true) => "disturbance block on".to_owned(),
        Change::Compensator(false) => "disturbance block off".to_owned(),
        Change::BadSamples(n) => count(*n, "bad sample"),
        Change::LostSamples(n) => count(*n, "lost sample"),
        Change::Acknowledge => "acknowledged".to_owned(),
        Change::Parameters(list) => match &**list {
            [(index, _)] if scenario.controllers.len() > 1 => match scenario.controllers.get(*index) {
                Some(one) => format!("new parameters of {}", one.name),
                None => "new parameters".to_owned(),
            },
            _ => "new parameters".to_owned(),
        },
    }
}

fn count(n: u32, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

fn signal(name: &str, signal: &Signal, unit: &str) -> String {
    let with = |unit: &str| if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let per_second = if unit.is_empty() { " per s".to_owned() } else { format!(" {unit}/s") };
    let during = |duration: f64| {
        if duration.is_finite() { format!(" for {} s", number(duration)) } else { String::new() }
    };
    match signal {
        Signal::Step(x) => format!("{name} = {}{}", number(*x), with(unit)),
        Signal::Ramp { slope, duration } => {
            format!("{name} ramps by {}{per_second}{}", number(*slope), during(*duration))
        }
        Signal::Pulse { height, duration } => {
            format!("{name}: pulse of {}{}{}", number(*height), with(unit), during(*duration))
        }
        Signal::Sine { amplitude, period, duration, .. } => format!(
            "{name}: sine of {}{}, period {} s{}",
            number(*amplitude),
            with(unit),
            number(*period),
            during(*duration).replace(" for", ","),
        ),
        Signal::Walk { std, every, duration, .. } => format!(
            "{name}: random walk, {}{} every {} s{}",
            number(*std),
            with(unit),
            number(*every),
            during(*duration).replace(" for", ","),
        ),
        Signal::Recorded(recording) => format!("{name} from {}", recording.name),
    }
}
