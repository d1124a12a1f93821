//! What a set-point or a disturbance does from an event on, and recorded measurements.

use super::fault::{Fault, code};
use super::number::{Allowed, show_short};
use super::sections::signal;
use super::table::Table;
use super::trial::Context;
use super::{Change, Signal, recording};

/// Each kind of signal with the keys that belong to it.
const KINDS: [(&str, &[&str]); 6] = [
    ("step", &[]),
    ("ramp", &["duration"]),
    ("pulse", &["duration"]),
    ("sine", &["period", "phase", "duration"]),
    ("walk", &["every", "seed", "duration"]),
    ("csv", &recording::KEYS),
];

/// Keys of the limits of a set-point, which are not a signal.
const OF_LIMITS: [&str; 6] = ["lo", "hi", "rate", "rate_up", "rate_down", "track"];

/// Most steps of a random walk.
const MOST_STEPS: f64 = 1e9;

const WRITE: &str = "write `{ step = 1.0 }`, `{ ramp = 0.1, duration = 5.0 }`, `{ pulse = 1.0, duration = 0.5 }`, \
                     `{ sine = 1.0, period = 10.0 }`, `{ walk = 0.1 }` or `{ csv = \"log.csv\", column = 2 }`";

/// The signal `key` of an event: a number, or a table of one kind.
pub(super) fn read(event: &Table<'_>, key: &'static str, context: &Context<'_>) -> Option<Signal> {
    if !event.is_table(key) {
        return signal(event, key).map(Signal::Step);
    }
    let part = event.table(key, "`{ step = 1.0 }`")?;
    if is_limits(&part) {
        let message = format!("`{key}` of an event is a number or a signal, the new set-point");
        let help = "its range and rate are changed by `setpoint_limits = { ... }`";
        event.log.fault(Fault::new(code::WRONG_TYPE, event.key_span(key)?, message).help(help));
        return None;
    }
    let kind = kind(&part, &KINDS)?;
    let signal = match kind {
        "step" => signal(&part, "step").map(Signal::Step),
        "ramp" => ramp(&part),
        "pulse" => pulse(&part),
        "sine" => sine(&part, context),
        "walk" => walk(&part, context),
        _ => recording::read(&part, context.library).map(Signal::Recorded),
    };
    part.finish();
    signal
}

/// `measurement = { csv = ... }` or `"plant"`.
pub(super) fn measurement(event: &Table<'_>, context: &Context<'_>) -> Option<Change> {
    if event.is_text("measurement") {
        return event.choice("measurement", &[("plant", ())]).map(|_| Change::Measurement(None));
    }
    let part =
        event.table("measurement", "`measurement = { csv = \"log.csv\", column = 2 }` or `\"plant\"`")?;
    if is_limits(&part) {
        let message = "`measurement` of an event is a recording; its range cannot change";
        let help = "the range of valid measurements belongs to the `[[controller]]`";
        event.log.fault(Fault::new(code::WRONG_TYPE, event.key_span("measurement")?, message).help(help));
        return None;
    }
    kind(&part, &KINDS[5..])?;
    let recording = recording::read(&part, context.library);
    part.finish();
    recording.map(|recording| Change::Measurement(Some(recording)))
}

fn is_limits(part: &Table<'_>) -> bool {
    let (mut written, mut limits) = (part.written().into_iter().peekable(), true);
    let any = written.peek().is_some();
    limits &= written.all(|(key, ..)| OF_LIMITS.contains(&key));
    any && limits
}

/// The one kind of signal that `part` is of; keys of other kinds are refused.
fn kind(part: &Table<'_>, kinds: &[(&'static str, &'static [&'static str])]) -> Option<&'static str> {
    let name = part.whole_name();
    let given: Vec<_> = kinds.iter().filter(|(kind, _)| part.span(kind).is_some()).collect();
    let list = |names: &[&str], word: &str| match names {
        [one] => format!("`{one}`"),
        [before @ .., last] => format!("`{}` {word} `{last}`", before.join("`, `")),
        [] => String::new(),
    };
    let all: Vec<&str> = kinds.iter().map(|(kind, _)| *kind).collect();
    let [(kind, keys)] = given[..] else {
        let (code, message) = if given.is_empty() {
            let none = if all.len() == 1 { "has no" } else { "has none of" };
            (code::MISSING_KEY, format!("`{name}` {none} {}", list(&all, "and")))
        } else {
            let given: Vec<&str> = given.iter().map(|(kind, _)| *kind).collect();
            (code::CONFLICT, format!("`{name}` has {}; one of them is allowed", list(&given, "and")))
        };
        let fault = Fault::new(code, part.place.clone(), message);
        let fault = if all.len() == 1 {
            fault.help("write `{ csv = \"log.csv\", column = 2 }`")
        } else {
            fault.help(WRITE)
        };
        // A misspelt kind is said to be one, and that is enough.
        part.missing_fault(&all, fault);
        for key in kinds.iter().flat_map(|(_, keys)| *keys) {
            let _ = part.span(key);
        }
        part.finish_here();
        return None;
    };
    let foreign = kinds.iter().flat_map(|(_, others)| *others).filter(|key| !keys.contains(key));
    let mut told: Vec<&str> = Vec::new();
    for &key in foreign {
        let Some(span) = part.key_span(key).filter(|_| !told.contains(&key)) else { continue };
        told.push(key);
        let of: Vec<&str> =
            kinds.iter().filter(|(_, keys)| keys.contains(&key)).map(|(kind, _)| *kind).collect();
        let noun = if *kind == "csv" { "recording" } else { kind };
        let message = format!("a {noun} has no `{key}`");
        let help = match (*kind, key) {
            ("step", "duration") => "a step that ends is a `pulse`".to_owned(),
            _ => format!("`{key}` belongs to {}", list(&of, "and")),
        };
        part.log.fault(Fault::new(code::CONFLICT, span, message).help(help));
    }
    Some(kind)
}

/// `duration`, to the end when it is not written; none when it is wrong.
fn duration(part: &Table<'_>) -> Option<f64> {
    match part.span("duration") {
        Some(_) => part.number_in("duration", Allowed::TIME).map(|length| length.value),
        None => Some(f64::INFINITY),
    }
}

fn ramp(part: &Table<'_>) -> Option<Signal> {
    let slope = part.number_in("ramp", Allowed::new(-1e12, 1e12, "per second"));
    let duration = duration(part);
    Some(Signal::Ramp { slope: slope?.value, duration: duration? })
}

fn pulse(part: &Table<'_>) -> Option<Signal> {
    let height = signal(part, "pulse");
    let duration = duration(part)?;
    if duration.is_infinite() {
        let message = format!("`{}` is missing: a pulse has an end", part.name("duration"));
        let fault = Fault::new(code::MISSING_KEY, part.place.clone(), message);
        part.missing_fault(&["duration"], fault.help("write `{ pulse = 1.0, duration = 0.5 }`"));
        return None;
    }
    Some(Signal::Pulse { height: height?, duration })
}

fn sine(part: &Table<'_>, context: &Context<'_>) -> Option<Signal> {
    let amplitude = signal(part, "sine");
    if part.span("period").is_none() {
        part.missing("period", "the period in seconds: `period = 10.0`");
    }
    let period = part.number_in("period", Allowed::TIME);
    let phase = match part.span("phase") {
        Some(_) => part.number_in("phase", Allowed::new(-1e6, 1e6, "rad")).map(|phase| phase.value),
        None => Some(0.0),
    };
    let duration = duration(part);
    let period = period?;
    if let Some(ts) = context.ts
        && period.value < 2.0 * ts
    {
        let message = format!(
            "`{} = {}` is less than two samples of {} s: the controller sees another, slower sine",
            part.name("period"),
            part.log.slice(&period.span),
            show_short(ts)
        );
        part.log.warn(
            Fault::new(code::ALIASING, period.span, message)
                .help("choose a longer period, or a shorter `ts`"),
        );
    }
    Some(Signal::Sine { amplitude: amplitude?, period: period.value, phase: phase?, duration: duration? })
}

fn walk(part: &Table<'_>, context: &Context<'_>) -> Option<Signal> {
    let std = part.number_in("walk", Allowed::new(0.0, 1e12, ""));
    let every = match part.span("every") {
        Some(_) => part.number_in("every", Allowed::TIME).map(|every| every.value),
        None => Some(context.ts.unwrap_or(1.0)),
    };
    let seed = match part.span("seed") {
        Some(_) => part.integer_in("seed", 0, u64::MAX).map(|seed| seed.value),
        // Not that of the noise, which would then be the same numbers.
        None => Some(2),
    };
    let duration = duration(part);
    let (std, every, seed, duration) = (std?.value, every?, seed?, duration?);
    let steps = duration.min(context.duration.unwrap_or(0.0)) / every;
    if let (true, Some(span)) = (steps > MOST_STEPS, part.span("every")) {
        let message = format!(
            "`{} = {}` makes {} steps; allowed: at most {MOST_STEPS:e}",
            part.name("every"),
            part.log.slice(&span),
            show_short(steps)
        );
        part.log
            .fault(Fault::new(code::TOO_LARGE, span, message).help("leave it out for a step each sample"));
        return None;
    }
    Some(Signal::Walk { std, every, seed, duration })
}
