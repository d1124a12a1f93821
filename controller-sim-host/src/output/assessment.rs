//! What the load-response experiment says: a table for people, one object for programs.

use super::json::{Place, Written, places, text};
use crate::report::{Experiment, advice, lines, verdict_line};
use crate::scenario::{Fault, SourceText};
use controller_design::assessment::{Change, Features, Reason, Verdict};
use serde::Serialize;
use std::fmt::Write;

#[derive(Serialize)]
struct Object<'a> {
    version: &'static str,
    data: &'a str,
    verdict: &'static str,
    reasons: Vec<Why>,
    advice: Advice,
    features: Option<Measured>,
    step_at: Option<f64>,
    auto_at: Option<f64>,
    files: &'a [Written],
    warnings: Vec<Place<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Error>,
}

#[derive(Serialize)]
struct Why {
    code: &'static str,
    message: String,
    help: &'static str,
}

#[derive(Serialize)]
struct Advice {
    kp: Option<&'static str>,
    ti: Option<&'static str>,
}

#[derive(Serialize)]
struct Measured {
    p1: f64,
    t1: f64,
    dip: Option<f64>,
    t_ratio: Option<f64>,
    r3: Option<f64>,
    sigma: f64,
}

/// A verdict that is none ends with the exit code of a refusal and says so like every other one.
#[derive(Serialize)]
struct Error {
    code: &'static str,
    message: String,
    help: &'static str,
    places: [(); 0],
}

impl From<&Reason> for Why {
    fn from(reason: &Reason) -> Self {
        Self { code: reason.code(), message: reason.to_string(), help: reason.help() }
    }
}

impl From<Features> for Measured {
    fn from(features: Features) -> Self {
        let Features { p1, t1, dip, t_ratio, r3, sigma } = features;
        Self { p1, t1, dip, t_ratio, r3, sigma }
    }
}

/// The assessment as JSON; `remarks` are those on the text of the record.
#[must_use]
pub fn assessment_json(
    experiment: &Experiment<'_>,
    remarks: &[Fault],
    source: &SourceText,
    files: &[Written],
) -> String {
    let assessment = experiment.assessment;
    let word = |change: Option<Change>| {
        change.map(|change| match change {
            Change::Raise => "raise",
            Change::Lower => "lower",
        })
    };
    let reasons: Vec<Why> = assessment.reasons.iter().map(Why::from).collect();
    let refused = assessment.verdict == Verdict::Inconclusive;
    let error = assessment.reasons.first().filter(|_| refused).map(|reason| Error {
        code: "inconclusive",
        message: reason.to_string(),
        help: reason.help(),
        places: [],
    });
    let own = assessment.warnings.iter().map(|warning| Place::nowhere("record", warning.to_string(), None));
    let warnings = places(&source.name, &source.text, remarks).chain(own);
    text(&Object {
        version: env!("CARGO_PKG_VERSION"),
        data: experiment.name,
        verdict: assessment.verdict.name(),
        reasons,
        advice: Advice { kp: word(assessment.advice.kp), ti: word(assessment.advice.ti) },
        features: assessment.features.map(Measured::from),
        step_at: assessment.marks.as_ref().map(|marks| marks.step),
        auto_at: assessment.marks.as_ref().and_then(|marks| marks.auto),
        files,
        warnings: warnings.collect(),
        error,
    })
}

/// The assessment for the terminal: verdict, features beside their ranges, reasons, what to change.
#[must_use]
pub fn assessment_table(experiment: &Experiment<'_>) -> String {
    let assessment = experiment.assessment;
    let mut text = format!("{}: {}\n", experiment.name, assessment.verdict.name());
    // Writing to a text cannot fail.
    let _ = writeln!(text, "  {}", verdict_line(assessment.verdict));
    if let Some(features) = &assessment.features {
        let _ = writeln!(text, "\n  {:8} {:>10}  near-optimal", "feature", "value");
        for line in lines(features, &experiment.acceptance) {
            let mark = if line.good == Some(false) { "*" } else { " " };
            let range = if line.range.is_empty() { line.about } else { &line.range };
            let _ = writeln!(text, "{mark} {:8} {:>10}  {range}", line.name, line.value);
        }
    }
    text.push('\n');
    for reason in &assessment.reasons {
        let _ = writeln!(text, "  {reason}\n    = {}", reason.help());
    }
    if let Some(advice) = advice(assessment) {
        let _ = writeln!(text, "\n  what to change: {advice}");
    }
    text
}
