//! Maps over two parameters: a line for each panel for people, the values for programs.

use super::Written;
use super::json::text;
use super::table::{format_digits, format_number};
use crate::batch::map::{Axis, MapStudy, MapValues, Panel};
use serde::Serialize;
use std::fmt::Write;

/// A map that was computed, or a part of one.
#[derive(Debug)]
pub struct Mapped<'a> {
    /// What was asked for.
    pub study: &'a MapStudy,
    /// Number of rows, those kept from an earlier run included.
    pub rows: usize,
    /// Rows kept from an earlier run.
    pub kept: usize,
    /// What they come to.
    pub values: &'a MapValues<'a>,
    /// The files that were written.
    pub files: &'a [Written],
}

/// A panel's least and largest values with their places.
fn extremes(study: &MapStudy, panel: &Panel) -> Option<[(f64, f64, f64); 2]> {
    let width = study.x.values.len();
    let places = panel.values.iter().enumerate().filter(|(_, value)| value.is_finite());
    let place = |(i, value): (usize, &f64)| (*value, study.x.values[i % width], study.y.values[i / width]);
    let by = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
    Some([place(places.clone().min_by(by)?), place(places.max_by(by)?)])
}

/// The map as text: the range of each panel, and why there are holes.
#[must_use]
pub fn map_table(made: &Mapped<'_>) -> String {
    let (study, [ok, refused, failed]) = (made.study, made.values.counts());
    let over = study.over.map_or(String::new(), |over| format!(" over {}", over.name()));
    let mut out = format!(
        "{}{over} on {}\n{} x {} points, {} rows: {ok} ok, {refused} refused, {failed} failed\n\n",
        study.method.name(),
        study.plant.text(),
        study.x.values.len(),
        study.y.values.len() * study.each.as_ref().map_or(1, |axis| axis.values.len()),
        made.rows,
    );
    let mut line = |content: &str| {
        // Writing to a text cannot fail.
        let _ = writeln!(out, "{}", content.trim_end());
    };
    let each = study.each.as_ref().map_or(String::new(), |axis| axis.parameter.to_string());
    let at = format!("at {}, {}", study.x.parameter, study.y.parameter);
    line(&format!(
        "{:<15}{each:>8}{:>11}  {at:<22}{:>11}  {at:<22}{:>6}",
        "metric", "least", "largest", "holes"
    ));
    for panel in made.values.panels() {
        let value = panel.each.map_or(String::new(), |value| format_digits(value, 3));
        let mut content = format!("{:<15}{value:>8}", panel.metric.name);
        match extremes(study, &panel) {
            Some(ends) => {
                for (value, x, y) in ends {
                    let place = format!("{}, {}", format_digits(x, 4), format_digits(y, 4));
                    let _ = write!(content, "{:>11}  {place:<22}", format_number(value));
                }
            }
            None => {
                let _ = write!(content, "{:>11}  {:<22}{:>11}  {:<22}", "-", "", "-", "");
            }
        }
        line(&format!("{content}{:>6}", panel.holes()));
    }
    let causes = made.values.causes();
    if !causes.is_empty() {
        line("");
    }
    let mut told = 0;
    for cause in causes {
        let more = if cause.rows > 1 { format!(" and {} more", cause.rows - 1) } else { String::new() };
        line(&format!("{} {}, {}{more}: {}", cause.status.name(), cause.method, cause.process, cause.reason));
        told += cause.rows;
    }
    let left = refused + failed - told.min(refused + failed);
    if left > 0 {
        line(&format!("{left} more rows without a result, each with its reason"));
    }
    if !made.files.is_empty() {
        line("");
    }
    for file in made.files {
        let has_rows = matches!(file.kind, "csv" | "parquet");
        let kept = if made.kept > 0 { format!(", {} of them kept", made.kept) } else { String::new() };
        let rows = if has_rows { format!(": {} rows{kept}", made.rows) } else { String::new() };
        line(&format!("wrote {}{rows}", file.path));
    }
    out
}

/// The map as JSON.
#[must_use]
pub fn map_json(made: &Mapped<'_>) -> String {
    #[derive(Serialize)]
    struct Whole<'a> {
        version: &'static str,
        map: String,
        plant: &'a str,
        method: &'static str,
        over: Option<&'static str>,
        horizon: Option<f64>,
        ts: Option<f64>,
        rows: usize,
        kept: usize,
        counts: Counts,
        x: Side<'a>,
        y: Side<'a>,
        each: Option<Side<'a>>,
        panels: Vec<One>,
        holes: Vec<Hole<'a>>,
        files: &'a [Written],
    }
    #[derive(Serialize)]
    struct Counts {
        ok: usize,
        refused: usize,
        failed: usize,
    }
    #[derive(Serialize)]
    struct Side<'a> {
        parameter: &'a str,
        log: bool,
        values: &'a [f64],
    }
    #[derive(Serialize)]
    struct One {
        metric: &'static str,
        unit: &'static str,
        each: Option<f64>,
        holes: usize,
        values: Vec<Vec<Option<f64>>>,
    }
    #[derive(Serialize)]
    struct Hole<'a> {
        method: &'a str,
        status: &'static str,
        reason: &'a str,
        plant: &'a str,
        rows: usize,
    }
    fn side(axis: &Axis) -> Side<'_> {
        Side { parameter: axis.parameter.name(), log: axis.log, values: &axis.values }
    }
    let study = made.study;
    let [ok, refused, failed] = made.values.counts();
    let width = study.x.values.len();
    let panel = |panel: Panel| One {
        metric: panel.metric.name,
        unit: if study.over.is_some() { "" } else { panel.metric.unit },
        each: panel.each,
        holes: panel.holes(),
        values: panel
            .values
            .chunks(width)
            .map(|row| row.iter().map(|value| value.is_finite().then_some(*value)).collect())
            .collect(),
    };
    text(&Whole {
        version: env!("CARGO_PKG_VERSION"),
        map: study.name(),
        plant: study.plant.text(),
        method: study.method.name(),
        over: study.over.map(|over| over.name()),
        horizon: study.horizon,
        ts: study.ts,
        rows: made.rows,
        kept: made.kept,
        counts: Counts { ok, refused, failed },
        x: side(&study.x),
        y: side(&study.y),
        each: study.each.as_ref().map(side),
        panels: made.values.panels().into_iter().map(panel).collect(),
        holes: made
            .values
            .causes()
            .iter()
            .map(|cause| Hole {
                method: &cause.method,
                status: cause.status.name(),
                reason: &cause.reason,
                plant: &cause.process,
                rows: cause.rows,
            })
            .collect(),
        files: made.files,
    })
}
