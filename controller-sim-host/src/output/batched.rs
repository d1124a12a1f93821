//! What a study comes to, for people and for programs.

use super::json::text;
use super::table::format_number;
use crate::batch::{COLUMNS, Cause, Group, Kind, Ratio, Row, Summary};
use serde::Serialize;
use serde_json::{Map, Value};
use std::fmt::Write;

/// A study that was done, or a part of one.
#[derive(Debug)]
pub struct Batched<'a> {
    /// What its rows carry.
    pub study: &'a str,
    /// Number of rows, those kept from an earlier run included.
    pub rows: usize,
    /// Rows kept from an earlier run.
    pub kept: usize,
    /// What they come to.
    pub summary: &'a Summary,
    /// The file they are in.
    pub out: Option<&'a str>,
    /// The rows, when they are in no file.
    pub results: Option<&'a [Row]>,
}

/// The study as text: a line for each method, maximum sensitivity and noise ratio, and why rows have no result.
#[must_use]
pub fn batch_table(made: &Batched<'_>) -> String {
    let [ok, refused, failed] = made.summary.counts();
    let mut out = format!("{} rows: {ok} ok, {refused} refused, {failed} failed\n\n", made.rows);
    let mut line = |content: &str| {
        // Writing to a text cannot fail.
        let _ = writeln!(out, "{}", content.trim_end());
    };
    let groups = made.summary.groups();
    let has_ratios = groups.iter().any(|group| group.ratios.is_some());
    let mut head = format!(
        "{:<9}{:>6}{:>7}{:>6}{:>9}{:>8}  {:<16}",
        "method", "Ms0", "noise", "ok", "refused", "failed", "Ms"
    );
    if has_ratios {
        for index in ["IAE", "ISE", "ITAE"] {
            let _ = write!(head, "{index:>7}{:>8}{:>5}", "max", ">1");
        }
    }
    line(&head);
    for Group { method, ms0, noise_ratio, counts: [ok, refused, failed], ms, ratios } in &groups {
        let ms = ms.map_or(String::new(), |[least, largest]| format!("{least:.3} to {largest:.3}"));
        let mut content = format!(
            "{method:<9}{:>6}{:>7}{ok:>6}{refused:>9}{failed:>8}  {ms:<16}",
            or_dash(ms0),
            or_dash(noise_ratio)
        );
        for Ratio { median, largest, above_one } in ratios.iter().flatten() {
            let _ = write!(content, "{:>7}{:>8}{above_one:>5}", ratio(*median), ratio(*largest));
        }
        line(&content);
    }
    if has_ratios {
        line("");
        line(
            "IAE, ISE, ITAE after a load over those of the first method on the same process: median, largest,",
        );
        line("processes above 1; noise: gain with the observer over that of the PI alone");
    }
    let causes = made.summary.causes();
    if !causes.is_empty() {
        line("");
    }
    let mut told = 0;
    for Cause { method, status, reason, process, rows } in causes {
        let more = if *rows > 1 { format!(" and {} more", rows - 1) } else { String::new() };
        line(&format!("{} {method}, {process}{more}: {reason}", status.name()));
        told += rows;
    }
    let left = refused + failed - told.min(refused + failed);
    if left > 0 {
        line(&format!("{left} more rows without a result, each with its reason"));
    }
    if let Some(path) = made.out {
        line("");
        let kept = if made.kept > 0 { format!(", {} of them kept", made.kept) } else { String::new() };
        line(&format!("wrote {path}: {} rows{kept}", made.rows));
    }
    out
}

fn or_dash(text: &str) -> &str {
    if text.is_empty() { "-" } else { text }
}

fn ratio(x: f64) -> String {
    if x < 100.0 { format!("{x:.3}") } else { format_number(x) }
}

/// The study as JSON.
#[must_use]
pub fn batch_json(made: &Batched<'_>) -> String {
    #[derive(Serialize)]
    struct Whole<'a> {
        version: &'static str,
        study: &'a str,
        rows: usize,
        kept: usize,
        counts: Counts,
        groups: Vec<One<'a>>,
        out: Option<&'a str>,
        results: Option<Vec<Map<String, Value>>>,
    }
    #[derive(Serialize)]
    struct Counts {
        ok: usize,
        refused: usize,
        failed: usize,
    }
    #[derive(Serialize)]
    struct One<'a> {
        method: &'a str,
        ms0: Option<f64>,
        noise_ratio: Option<f64>,
        counts: Counts,
        ms_least: Option<f64>,
        ms_largest: Option<f64>,
        iae: Option<Over>,
        ise: Option<Over>,
        itae: Option<Over>,
    }
    #[derive(Serialize)]
    struct Over {
        median: f64,
        largest: f64,
        above_one: usize,
    }
    const fn counts([ok, refused, failed]: [usize; 3]) -> Counts {
        Counts { ok, refused, failed }
    }
    fn one(group: &Group) -> One<'_> {
        let Group { method, ms0, noise_ratio, counts: of, ms, ratios } = group;
        let over = |i: usize| {
            ratios.as_ref().map(|ratios| {
                let Ratio { median, largest, above_one } = ratios[i];
                Over { median, largest, above_one }
            })
        };
        One {
            method,
            ms0: ms0.parse().ok(),
            noise_ratio: noise_ratio.parse().ok(),
            counts: counts(*of),
            ms_least: ms.map(|[least, _]| least),
            ms_largest: ms.map(|[_, largest]| largest),
            iae: over(0),
            ise: over(1),
            itae: over(2),
        }
    }
    let groups = made.summary.groups();
    text(&Whole {
        version: env!("CARGO_PKG_VERSION"),
        study: made.study,
        rows: made.rows,
        kept: made.kept,
        counts: counts(made.summary.counts()),
        groups: groups.iter().map(one).collect(),
        out: made.out,
        results: made.results.map(|rows| rows.iter().map(object).collect()),
    })
}

/// A row with the names of its columns; numbers that are not finite are null, as those that it has not.
fn object(row: &Row) -> Map<String, Value> {
    let cells = COLUMNS.iter().zip(row.cells()).map(|(column, cell)| {
        let value = match column.kind {
            Kind::Text => Value::from(cell.as_str()),
            Kind::Count => Value::from(row.number()),
            Kind::Number => cell.parse::<f64>().ok().map_or(Value::Null, Value::from),
        };
        (column.name.to_string(), value)
    });
    cells.collect()
}
