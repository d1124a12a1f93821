//! A map of a rule over two parameters as a figure.

use super::sheet::{self, Content, Map, Mark, Panel, Scale, Sheet};
use super::words;
use crate::batch::map::{Axis, MapStudy, MapValues, Panel as Values, Parameter};
use crate::batch::{Cause, Status};
use maud::{Markup, html};

/// How a map is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapLook {
    /// What it is; `None`: rule and plant.
    pub title: Option<String>,
    /// What stands beside the axis from left to right; `None`: the parameter.
    pub x_label: Option<String>,
    /// And beside the upright one.
    pub y_label: Option<String>,
    /// Values of the lines; none: round ones.
    pub levels: Vec<f64>,
    /// Points to be marked.
    pub marks: Vec<Mark>,
}

/// The figure of a map.
#[must_use]
pub fn map_sheet(study: &MapStudy, values: &MapValues<'_>, look: &MapLook) -> Sheet {
    let panels = values.panels();
    let columns = match (study.each.as_ref().map_or(1, |axis| axis.values.len()), panels.len()) {
        (_, 1) => 1,
        (each, _) if each % 3 == 0 => 3,
        _ => 2,
    };
    let (x, y) = (scale(&study.x, look.x_label.as_deref()), scale(&study.y, look.y_label.as_deref()));
    let title = look.title.clone().unwrap_or_else(|| {
        let over = study.over.map_or(String::new(), |over| format!(" over {}", over.title()));
        format!("{}{over} on {}", study.method.title(), study.plant.text())
    });
    let panel = |one: &Values| Panel {
        title: heading(study, one),
        x: x.clone(),
        y: y.clone(),
        content: Content::Map(Map {
            x: study.x.values.clone(),
            y: study.y.values.clone(),
            values: one.values.clone(),
            levels: look.levels.clone(),
            is_ratio: study.over.is_some(),
            marks: look.marks.clone(),
        }),
    };
    Sheet { title, text: statement(study), columns, panels: panels.iter().map(panel).collect() }
}

fn scale(axis: &Axis, label: Option<&str>) -> Scale {
    let (name, unit) = match (&axis.parameter, label) {
        (_, Some(label)) => (label.to_owned(), String::new()),
        (Parameter::Option(setting), None) => {
            let (name, unit) = setting.label();
            (name.to_owned(), unit.to_owned())
        }
        (Parameter::Plant(name), None) => (name.clone(), String::new()),
    };
    Scale { name, unit, log: axis.log }
}

fn heading(study: &MapStudy, panel: &Values) -> String {
    let metric = panel.metric;
    let what = match (study.over, metric.unit) {
        (Some(_), _) => format!("ratio of {}", metric.title),
        (None, "") => metric.title.to_owned(),
        (None, unit) => format!("{} [{unit}]", metric.title),
    };
    match (&study.each, panel.each) {
        (Some(axis), Some(value)) => format!("{} = {}: {what}", axis.parameter, words::number(value)),
        _ => what,
    }
}

/// What holds for all of it, in sentences.
fn statement(study: &MapStudy) -> Vec<String> {
    let mut text = vec![match study.over {
        Some(over) => format!(
            "{} over {} on the plant {}: each value divided by that of {} at the same point. The line of 1 is thick, lines above it are dashed.",
            study.method.title(),
            over.title(),
            study.plant.text(),
            over.title(),
        ),
        None => format!("{} on the plant {}.", study.method.title(), study.plant.text()),
    }];
    if !study.at.is_empty() {
        let list: Vec<String> = study
            .at
            .iter()
            .map(|(parameter, value)| format!("{parameter} = {}", words::number(*value)))
            .collect();
        text.push(format!("Everywhere {}.", list.join(", ")));
    }
    text.push(match (study.ts, study.horizon) {
        (Some(ts), _) => format!(
            "Sampled loops with a period of {} s, simulated until they are at rest.",
            words::number(ts)
        ),
        (None, Some(end)) => {
            format!("Continuous loops; indices up to {} s after each unit step.", words::number(end))
        }
        (None, None) => "Continuous loops; indices of unit steps over an infinite horizon.".to_owned(),
    });
    text
}

/// The page of a map; `command` is what made it.
#[must_use]
pub fn map_page(sheet: &Sheet, values: &MapValues<'_>, command: &str) -> String {
    let [ok, refused, failed] = values.counts();
    let remarks: Vec<String> = values.causes().iter().map(cause).collect();
    let left = (refused + failed).saturating_sub(values.causes().iter().map(|cause| cause.rows).sum());
    let more: Markup = html! {
        p { (ok) " loops, " (refused) " refused by the rule, " (failed) " without responses." }
        @if left > 0 { p { (left) " more holes have other reasons, which the rows of the data tell." } }
    };
    sheet::page("Map of a tuning rule", std::slice::from_ref(sheet), &remarks, &more, command)
}

/// Why there are holes.
fn cause(cause: &Cause) -> String {
    let Cause { method, status, reason, process, rows } = cause;
    let what = if *status == Status::Refused { "refused" } else { "no response" };
    let holes = if *rows == 1 { "1 hole".to_owned() } else { format!("{rows} holes") };
    format!("{holes}: {method} {what}, first for {process}: {reason}")
}

/// A page with a figure; `command` is what made it.
#[must_use]
pub fn sheet_page(kind: &str, sheet: &Sheet, command: &str) -> String {
    sheet::page(kind, std::slice::from_ref(sheet), &[], &html! {}, command)
}

/// A figure as an SVG file of its own.
#[must_use]
pub fn sheet_svg(sheet: &Sheet) -> String {
    sheet::svg(sheet)
}
