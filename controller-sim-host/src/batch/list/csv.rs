//! A list of processes as CSV.

use super::{Cell, Entry};
use crate::scenario::{Fault, code};
use std::ops::Range;

/// The columns, in any order and writing.
const COLUMNS: [&str; 3] = ["name", "plant", "family"];

/// The entries of the lines that have all they need.
pub(super) fn entries(text: &str, faults: &mut Vec<Fault>) -> Vec<Entry> {
    // Spreadsheets begin a file with a mark.
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut lines = lines(text, start).filter(|line| !text[line.clone()].trim().is_empty());
    let Some(head) = lines.next() else { return Vec::new() };
    let separator = [';', '\t', ','].into_iter().find(|s| text[head.clone()].contains(*s)).unwrap_or(',');
    let names = cells(text, head.clone(), separator);
    let mut places = [None; COLUMNS.len()];
    for (i, cell) in names.iter().enumerate() {
        match COLUMNS.iter().position(|column| names_column(&cell.value, column)) {
            Some(k) if places[k].is_some() => {
                let message = format!("the column `{}` is there twice", COLUMNS[k]);
                faults.push(Fault::new(code::DUPLICATE, cell.span.clone(), message));
            }
            Some(k) => places[k] = Some(i),
            // Columns for people, such as a remark.
            None => {}
        }
    }
    for k in [0, 1] {
        if places[k].is_none() {
            let message = format!("the first line names no column `{}`", COLUMNS[k]);
            let help = "the first line is `name,plant` or `name,plant,family`";
            faults.push(Fault::new(code::MISSING_KEY, head.clone(), message).help(help));
        }
    }
    let [Some(name), Some(plant), family] = places else { return Vec::new() };
    let mut entries = Vec::new();
    for line in lines {
        let cells = cells(text, line.clone(), separator);
        if cells.len() != names.len() {
            let message = format!("this line has {} fields, the first line {}", cells.len(), names.len());
            let help = "put a field that contains the separator in quotes";
            faults.push(Fault::new(code::SYNTAX, line, message).help(help));
            continue;
        }
        let family = family.map(|i: usize| cells[i].clone());
        entries.push(Entry { name: cells[name].clone(), plant: cells[plant].clone(), family });
    }
    entries
}

/// Whether a heading names a column; the published list calls the plants expressions.
fn names_column(heading: &str, column: &str) -> bool {
    heading.eq_ignore_ascii_case(column) || (column == "plant" && heading.eq_ignore_ascii_case("expression"))
}

/// The places of the lines from `start` on, without their ends.
fn lines(text: &str, start: usize) -> impl Iterator<Item = Range<usize>> {
    let mut from = start;
    text[start..].split_inclusive('\n').map(move |line| {
        let begin = from;
        from += line.len();
        begin..begin + line.trim_end_matches(['\n', '\r']).len()
    })
}

fn cells(text: &str, line: Range<usize>, separator: char) -> Vec<Cell> {
    let mut list = Vec::new();
    let (mut begin, mut is_quoted) = (line.start, false);
    for (i, c) in text[line.clone()].char_indices() {
        if c == '"' {
            is_quoted = !is_quoted;
        } else if c == separator && !is_quoted {
            list.push(cell(text, begin..line.start + i));
            begin = line.start + i + c.len_utf8();
        }
    }
    list.push(cell(text, begin..line.end));
    list
}

fn cell(text: &str, place: Range<usize>) -> Cell {
    let raw = &text[place.clone()];
    let lead = raw.len() - raw.trim_start().len();
    let (mut start, mut value) = (place.start + lead, raw.trim());
    let span = start..start + value.len();
    if let Some(inner) = value.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        (start, value) = (start + 1, inner);
    }
    let inside = (!value.contains('"')).then_some(start);
    Cell { value: value.replace("\"\"", "\""), span, inside }
}
