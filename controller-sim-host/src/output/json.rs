//! JSON for programs: one object, its keys in a fixed order, numbers finite or null.

use super::table::{plant_text, remarks};
use super::{Chapter, Problem, Trouble, precision_name};
use crate::pil::{Compared, Difference};
use crate::scenario::Fault;
use crate::simulate::{EventKind, Metrics, RunResult};
use serde::Serialize;
use std::borrow::Cow;

/// The JSON Schema (draft 2020-12) of everything that these functions give.
pub const SCHEMA: &str = include_str!("schema.json");

#[derive(Serialize)]
struct Runs<'a> {
    runs: Vec<Run<'a>>,
}

#[derive(Serialize)]
struct Run<'a> {
    version: &'static str,
    scenario: &'a str,
    title: &'a str,
    case: Option<&'a str>,
    plant: String,
    ts: f64,
    duration: f64,
    latency: f64,
    substeps: usize,
    precision: &'static str,
    files: Vec<&'a Written>,
    controllers: Vec<Controller<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pil: Option<Pil<'a>>,
    warnings: Vec<Place<'a>>,
}

/// How the controllers compare with those on a board. Bits are texts: not every reader has integers of 64 bits.
#[derive(Serialize)]
struct Pil<'a> {
    board: &'static str,
    samples: u64,
    differing_samples: u64,
    first_difference: Option<FirstDifference<'a>>,
    host_hash: String,
    board_hash: String,
}

#[derive(Serialize)]
struct FirstDifference<'a> {
    controller: &'a str,
    k: u64,
    field: &'static str,
    host: String,
    board: String,
}

fn pil(result: &RunResult) -> Option<Pil<'_>> {
    let (all, name) = Compared::all(result)?;
    let first = |d: Difference| FirstDifference {
        controller: name.unwrap_or_default(),
        k: d.k,
        field: d.field,
        host: format!("{:#x}", d.host),
        board: format!("{:#x}", d.board),
    };
    Some(Pil {
        board: all.on.name,
        samples: all.samples,
        differing_samples: all.differing,
        first_difference: all.first.map(first),
        host_hash: format!("{:016x}", all.host_hash),
        board_hash: format!("{:016x}", all.board_hash),
    })
}

/// A file that a run has written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Written {
    /// `report`, `card`, `svg`, `csv` or `parquet`.
    pub kind: &'static str,
    /// Its path, as it was given.
    pub path: String,
    /// Which run it is about; `None`: all of them.
    #[serde(skip)]
    pub run: Option<usize>,
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
pub(super) struct Place<'a> {
    file: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
    length: Option<usize>,
    text: Option<String>,
    code: &'a str,
    message: Cow<'a, str>,
    help: Option<&'a str>,
}

impl<'a> Place<'a> {
    /// What has no place in a text.
    pub(super) fn nowhere(code: &'a str, message: impl Into<Cow<'a, str>>, help: Option<&'a str>) -> Self {
        Self {
            file: None,
            line: None,
            column: None,
            length: None,
            text: None,
            code,
            message: message.into(),
            help,
        }
    }
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

/// The results as JSON: of one chapter its object, of several `{"runs": [...]}`. Warnings are those of the scenario with
/// their places, then the remarks on the run with the code `run` and no place.
#[must_use]
pub fn run_json(chapters: &[Chapter<'_>], files: &[Written]) -> String {
    match chapters {
        [only] => text(&run(only, 0, files)),
        several => {
            text(&Runs { runs: several.iter().enumerate().map(|(i, one)| run(one, i, files)).collect() })
        }
    }
}

fn run<'a>(chapter: &Chapter<'a>, index: usize, files: &'a [Written]) -> Run<'a> {
    let scenario = chapter.scenario;
    let controllers = chapter.result.controllers.iter().map(|controller| Controller {
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
    let remarks =
        remarks(chapter.result).map(|(name, text)| Place::nowhere("run", format!("{name}: {text}"), None));
    Run {
        version: env!("CARGO_PKG_VERSION"),
        scenario: chapter.name,
        title: &scenario.title,
        case: chapter.case,
        plant: plant_text(scenario),
        ts: scenario.ts,
        duration: scenario.duration,
        latency: scenario.latency,
        substeps: scenario.substeps,
        precision: precision_name(chapter.precision),
        files: files.iter().filter(|file| file.run.is_none_or(|run| run == index)).collect(),
        controllers: controllers.collect(),
        pil: pil(chapter.result),
        warnings: places(chapter.name, chapter.text, chapter.warnings).chain(remarks).collect(),
    }
}

/// What is wrong as JSON: `{"error": {"code", "message", "help", "places"}}`. The first fault gives `code`, `message` and
/// `help`, and `places` has all of them; a problem without a place that comes alone has no places.
#[must_use]
pub fn error_json(troubles: &[Trouble]) -> String {
    let all: Vec<Place<'_>> = troubles.iter().flat_map(trouble_places).collect();
    let (code, message, help) = match all.first() {
        Some(first) => (first.code, &*first.message, first.help),
        None => ("internal", "", None),
    };
    let message = match all.len() {
        0 | 1 => message.to_owned(),
        n => format!("{message} (and {} more)", n - 1),
    };
    let lonely = matches!(troubles, [Trouble::Problem(_)]);
    text(&Failure { error: Error { code, message, help, places: if lonely { Vec::new() } else { all } } })
}

fn trouble_places(trouble: &Trouble) -> Vec<Place<'_>> {
    match trouble {
        Trouble::Problem(Problem { code, message, help }) => {
            vec![Place::nowhere(code, message.as_str(), help.as_deref())]
        }
        Trouble::Scenario(source, faults) => places(&source.name, &source.text, faults).collect(),
    }
}

pub(super) fn places<'a>(
    name: &'a str,
    text: &'a str,
    faults: &'a [Fault],
) -> impl Iterator<Item = Place<'a>> {
    faults.iter().map(move |fault| {
        let place = fault.place(text);
        Place {
            file: Some(fault.source.as_ref().map_or(name, |source| &source.name)),
            line: Some(place.line),
            column: Some(place.column),
            length: Some(place.length),
            text: Some(place.text),
            code: fault.code,
            message: Cow::Borrowed(&*fault.message),
            help: fault.help.as_deref(),
        }
    })
}

/// That a built-in scenario was saved, with the files it reads: `{"saved": PATH, "files": [PATH, ...]}`.
#[must_use]
pub fn saved_json(path: &str, files: &[String]) -> String {
    #[derive(Serialize)]
    struct Saved<'a> {
        saved: &'a str,
        files: &'a [String],
    }
    text(&Saved { saved: path, files })
}

/// What is built in, names and titles: `{"scenarios": [{"name", "title"}]}`.
#[must_use]
pub fn list_json<'a>(scenarios: impl Iterator<Item = (&'a str, String)>) -> String {
    #[derive(Serialize)]
    struct Item<'a> {
        name: &'a str,
        title: String,
    }
    #[derive(Serialize)]
    struct List<'a> {
        scenarios: Vec<Item<'a>>,
    }
    text(&List { scenarios: scenarios.map(|(name, title)| Item { name, title }).collect() })
}

/// A text that a command prints, completions or a manual page: `{"text": TEXT}`.
#[must_use]
pub fn text_json(content: &str) -> String {
    #[derive(Serialize)]
    struct Content<'a> {
        text: &'a str,
    }
    text(&Content { text: content })
}

/// Files that a command has written: `{"written": [PATH, ...]}`.
#[must_use]
pub fn written_json(paths: &[String]) -> String {
    #[derive(Serialize)]
    struct List<'a> {
        written: &'a [String],
    }
    text(&List { written: paths })
}

/// These types have text keys and no maps: they can always be written.
pub(super) fn text(value: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(value).unwrap_or_else(|error| {
        format!("{{\"error\": {{\"code\": \"internal\", \"message\": \"{error}\", \"help\": null, \"places\": []}}}}")
    });
    text + "\n"
}
