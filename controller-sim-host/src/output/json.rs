//! JSON for programs: one object, its keys in a fixed order, numbers finite or null.

use super::table::remarks;
use super::{Problem, Source, precision_name};
use crate::scenario::{Fault, Scenario};
use crate::simulate::{EventKind, Metrics, Precision, RunResult};
use serde::Serialize;
use std::borrow::Cow;

#[derive(Serialize)]
struct Run<'a> {
    scenario: &'a str,
    ts: f64,
    precision: &'static str,
    controllers: Vec<Controller<'a>>,
    warnings: Vec<Place<'a>>,
}

#[derive(Serialize)]
struct Controller<'a> {
    name: &'a str,
    events: Vec<Event>,
    total: Indices,
}

#[derive(Serialize)]
struct Event {
    at: f64,
    kind: &'static str,
    metrics: Indices,
}

/// JSON has no infinity: the serialiser writes null for what is not finite.
#[derive(Serialize)]
struct Indices {
    ie: f64,
    iae: f64,
    ise: f64,
    itae: f64,
    e_max: f64,
    tv: f64,
}

#[derive(Serialize)]
struct Failure<'a> {
    error: Error<'a>,
}

#[derive(Serialize)]
struct Error<'a> {
    code: &'a str,
    message: String,
    help: Option<&'a str>,
    places: Vec<Place<'a>>,
}

#[derive(Serialize)]
struct Place<'a> {
    line: Option<usize>,
    column: Option<usize>,
    length: Option<usize>,
    text: Option<String>,
    code: &'a str,
    message: Cow<'a, str>,
    help: Option<&'a str>,
}

impl From<&Metrics> for Indices {
    fn from(m: &Metrics) -> Self {
        Self { ie: m.ie, iae: m.iae, ise: m.ise, itae: m.itae, e_max: m.e_max, tv: m.tv }
    }
}

/// The word for what began a stretch.
pub(super) fn kind_name(kind: EventKind) -> &'static str {
    match kind {
        EventKind::Start => "start",
        EventKind::Setpoint => "setpoint",
        EventKind::Disturbance => "disturbance",
        EventKind::Other => "other",
    }
}

/// The result of a run as JSON: `scenario` (the name of `source`), `ts`, `precision`, `controllers` and
/// `warnings` (those of the scenario with their places, then the remarks on the run with the code `run` and no place).
#[must_use]
pub fn run_json(
    source: Source<'_>,
    scenario: &Scenario,
    precision: Precision,
    result: &RunResult,
    warnings: &[Fault],
) -> String {
    let controllers = result.controllers.iter().map(|controller| Controller {
        name: &controller.name,
        events: controller
            .events
            .iter()
            .map(|stretch| Event {
                at: stretch.at,
                kind: kind_name(stretch.kind),
                metrics: Indices::from(&stretch.metrics),
            })
            .collect(),
        total: Indices::from(&controller.total),
    });
    // What is said of the run has no place in the scenario.
    let remarks = remarks(result).map(|(name, text)| Place {
        line: None,
        column: None,
        length: None,
        text: None,
        code: "run",
        message: Cow::Owned(format!("{name}: {text}")),
        help: None,
    });
    text(&Run {
        scenario: source.name,
        ts: scenario.ts,
        precision: precision_name(precision),
        controllers: controllers.collect(),
        warnings: places(source.text, warnings).into_iter().chain(remarks).collect(),
    })
}

/// A failure as JSON: `{"error": {"code", "message", "help", "places"}}`. With faults of a scenario the first
/// one gives `code`, `message` and `help`, and `places` has all of them; a problem without a place has no
/// places.
#[must_use]
pub fn error_json(problem: &Problem, text_read: &str, faults: &[Fault]) -> String {
    let error = match faults {
        [] => Error {
            code: problem.code,
            message: problem.message.clone(),
            help: problem.help.as_deref(),
            places: Vec::new(),
        },
        [first, others @ ..] => Error {
            code: first.code,
            message: match others.len() {
                0 => first.message.clone(),
                n => format!("{} (and {n} more)", first.message),
            },
            help: first.help.as_deref(),
            places: places(text_read, faults),
        },
    };
    text(&Failure { error })
}

fn places<'a>(text: &str, faults: &'a [Fault]) -> Vec<Place<'a>> {
    let one = |fault: &'a Fault| {
        let place = fault.place(text);
        Place {
            line: Some(place.line),
            column: Some(place.column),
            length: Some(place.length),
            text: Some(place.text),
            code: fault.code,
            message: Cow::Borrowed(&*fault.message),
            help: fault.help.as_deref(),
        }
    };
    faults.iter().map(one).collect()
}

/// These types have text keys and no maps: they can always be written.
fn text(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_else(|error| {
        format!("{{\"error\": {{\"code\": \"internal\", \"message\": \"{error}\", \"help\": null, \"places\": []}}}}")
    })
}
