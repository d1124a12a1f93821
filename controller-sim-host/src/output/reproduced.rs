//! The tables of the papers, for people and for programs.

use super::json::text as json_text;
use super::table::format_digits;
use crate::reproduce::{Cell, Report, Table, Verdict};
use serde::Serialize;

/// Width of a number.
const NUMBER: usize = 12;
/// Width of the whole, verdicts and reasons included.
const LINE: usize = 100;
/// Room for a verdict and the mark of its reason.
const VERDICT: usize = 21;
/// Significant digits of what is true and of ours.
const DIGITS: u8 = 6;

/// The tables with their reasons below, then what it comes to. A number of ours that differs from what is true has a `!`.
#[must_use]
pub fn reproduced_table(report: &Report) -> String {
    let mut text = String::new();
    for table in &report.tables {
        push_table(&mut text, table);
    }
    push_summary(&mut text, report);
    text
}

fn push_table(text: &mut String, table: &Table) {
    let name = if table.name.starts_with(|c: char| c.is_ascii_digit()) { "table " } else { "" };
    text.push_str(&format!("{}, {name}{}: {}\n", table.paper.source(), table.name, table.title));
    let widest = |of: &dyn Fn(&Cell) -> usize, head: &str| {
        table.cells.iter().map(of).max().unwrap_or(0).max(head.len())
    };
    let quantity = widest(&|cell| cell.quantity.chars().count(), "quantity");
    let printed = widest(&|cell| shown(cell).chars().count(), "printed");
    let row = widest(&|cell| cell.row.chars().count(), "row");
    // Long names of rows stand on lines of their own.
    let is_wide = row + quantity + printed + 2 * NUMBER + VERDICT + 9 > LINE;
    let row = if is_wide { 0 } else { row };
    let head = if is_wide { "" } else { "row" };
    text.push_str(&format!(
        "  {head:row$}  {:quantity$}  {:>printed$} {:>NUMBER$} {:>NUMBER$}  verdict\n",
        "quantity", "printed", "true", "ours"
    ));
    let mut reasons: Vec<&str> = Vec::new();
    let mut last = "";
    for cell in &table.cells {
        // A row is named once.
        let name = if cell.row == last { "" } else { &cell.row };
        last = &cell.row;
        if is_wide && !name.is_empty() {
            text.push_str(&format!("  {name}\n"));
        }
        let ours = number(cell.ours) + if cell.differs() { "!" } else { "" };
        let line = format!(
            "  {:row$}  {:quantity$}  {:>printed$} {:>NUMBER$} {ours:>NUMBER$}  {}{}",
            if is_wide { "" } else { name },
            cell.quantity,
            shown(cell),
            number(cell.truth),
            cell.verdict.words(),
            number_of(&mut reasons, &cell.reason),
        );
        text.push_str(line.trim_end());
        text.push('\n');
    }
    for (i, reason) in reasons.iter().enumerate() {
        push_wrapped(text, &format!("  [{}] ", i + 1), reason);
    }
    if let Some(trouble) = &table.trouble {
        push_wrapped(text, "  not computed: ", trouble);
    }
    text.push('\n');
}

/// What is printed, with `-` for nothing.
fn shown(cell: &Cell) -> &str {
    cell.printed.as_deref().unwrap_or("-")
}

/// Counts and other whole numbers have no digits behind the point.
fn number(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(x) if x.abs() < 1e6 && x == libm::trunc(x) => format!("{x:.0}"),
        Some(x) => format_digits(x, DIGITS),
    }
}

/// The mark of a reason; equal ones have one number.
fn number_of<'a>(reasons: &mut Vec<&'a str>, reason: &'a str) -> String {
    if reason.is_empty() {
        return String::new();
    }
    let index = reasons.iter().position(|one| *one == reason).unwrap_or_else(|| {
        reasons.push(reason);
        reasons.len() - 1
    });
    format!(" [{}]", index + 1)
}

/// Text after a lead, broken between words, the lines below indented like the first.
fn push_wrapped(text: &mut String, lead: &str, content: &str) {
    let indent = lead.chars().count();
    let mut width = indent;
    text.push_str(lead);
    for (i, word) in content.split_whitespace().enumerate() {
        let length = word.chars().count();
        if i > 0 && width + 1 + length > LINE {
            text.push('\n');
            text.push_str(&" ".repeat(indent));
            width = indent;
        } else if i > 0 {
            text.push(' ');
            width += 1;
        }
        text.push_str(word);
        width += length;
    }
    text.push('\n');
}

fn push_summary(text: &mut String, report: &Report) {
    let cells = report.cells().count();
    let counts: Vec<String> = Verdict::ALL
        .iter()
        .map(|verdict| (report.count(*verdict), verdict.words()))
        .filter(|(n, _)| *n > 0)
        .map(|(n, words)| format!("{n} {words}"))
        .collect();
    let tables = match report.tables.len() {
        1 => "1 table".to_owned(),
        n => format!("{n} tables"),
    };
    push_wrapped(text, "", &format!("{tables}, {cells} cells: {}", counts.join(", ")));
    text.push_str(&match report.differing() {
        0 => "ours is true in every cell, within its tolerance\n".to_owned(),
        1 => "ours differs from true in 1 cell, marked `!`\n".to_owned(),
        n => format!("ours differs from true in {n} cells, marked `!`\n"),
    });
}

#[derive(Serialize)]
struct Object<'a> {
    version: &'static str,
    tables: Vec<TableObject<'a>>,
    differing: usize,
}

#[derive(Serialize)]
struct TableObject<'a> {
    paper: &'a str,
    table: &'a str,
    title: &'a str,
    trouble: Option<&'a str>,
    cells: Vec<CellObject<'a>>,
}

#[derive(Serialize)]
struct CellObject<'a> {
    row: &'a str,
    quantity: &'a str,
    printed: Option<&'a str>,
    #[serde(rename = "true")]
    truth: Option<f64>,
    ours: Option<f64>,
    tolerance: Option<f64>,
    verdict: &'a str,
    reason: &'a str,
}

impl<'a> From<&'a Cell> for CellObject<'a> {
    fn from(cell: &'a Cell) -> Self {
        Self {
            row: &cell.row,
            quantity: &cell.quantity,
            printed: cell.printed.as_deref(),
            truth: cell.truth,
            ours: cell.ours,
            tolerance: cell.allowed(),
            verdict: cell.verdict.words(),
            reason: &cell.reason,
        }
    }
}

/// The tables as JSON: `{"version", "tables": [{"paper", "table", "title", "trouble", "cells": [{"row", "quantity", "printed", "true",
/// "ours", "tolerance", "verdict", "reason"}]}], "differing"}`; `tolerance` is the largest difference that is allowed.
#[must_use]
pub fn reproduced_json(report: &Report) -> String {
    let tables = report.tables.iter().map(|table| TableObject {
        paper: table.paper.name(),
        table: table.name,
        title: table.title,
        trouble: table.trouble.as_deref(),
        cells: table.cells.iter().map(CellObject::from).collect(),
    });
    json_text(&Object {
        version: env!("CARGO_PKG_VERSION"),
        tables: tables.collect(),
        differing: report.differing(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::{Paper, Tolerance};

    fn cell(row: &str, quantity: &str, ours: f64, verdict: Verdict, reason: &str) -> Cell {
        Cell {
            row: row.to_owned(),
            quantity: quantity.to_owned(),
            printed: Some("2.25".to_owned()),
            truth: Some(2.246_875),
            tolerance: Some(Tolerance::Relative(1e-3)),
            ours: Some(ours),
            verdict,
            reason: reason.to_owned(),
        }
    }

    fn report(row: &str) -> Report {
        let cells = vec![
            cell(row, "KP", 2.2469, Verdict::AsPrinted, "one reason"),
            cell(row, "KI", 3.0, Verdict::Misprint, "one reason"),
        ];
        let trouble = Some("it is late".to_owned());
        Report { tables: vec![Table { paper: Paper::De, name: "2", title: "gains", cells, trouble }] }
    }

    #[test]
    fn a_table_for_people() {
        let text = reproduced_table(&report("GP1"));
        let expected = "\
Vrančić & Huba 2021, table 2: gains
  row  quantity  printed         true         ours  verdict
  GP1  KP           2.25      2.24688      2.24690  as printed [1]
       KI           2.25      2.24688           3!  misprint [1]
  [1] one reason
  not computed: it is late

1 table, 2 cells: 1 as printed, 1 misprint
ours differs from true in 1 cell, marked `!`
";
        assert_eq!(text, expected);
    }

    #[test]
    fn long_names_have_lines_of_their_own() {
        let name = "a row with a name that is far too long for one column";
        let text = reproduced_table(&report(name));
        assert!(text.contains(&format!("\n  {name}\n")), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= LINE), "{text}");
    }

    #[test]
    fn an_object_for_programs() {
        let value: serde_json::Value = serde_json::from_str(&reproduced_json(&report("GP1"))).expect("JSON");
        assert_eq!(value["differing"], 1);
        let one = &value["tables"][0]["cells"][1];
        assert_eq!((one["printed"].as_str(), one["verdict"].as_str()), (Some("2.25"), Some("misprint")));
        assert_eq!((one["true"].as_f64(), one["ours"].as_f64()), (Some(2.246_875), Some(3.0)));
    }
}
