//! Recorded signals: `{ csv = "log.csv", column = "temperature" }`.

use super::columns::{self, About, Column, Problem};
use super::fault::{Fault, code};
use super::library::Library;
use super::number::{Allowed, show_short};
use super::table::Table;
use super::value::shortened;
use super::{Between, Recording};
use std::sync::Arc;

/// The keys beside `csv`.
pub(super) const KEYS: [&str; 5] = ["column", "time", "scale", "offset", "between"];

/// Which recording of a file is meant, in a form that can be compared.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Wanted {
    path: String,
    time: Column,
    column: Column,
    /// As bits: numbers that print alike are alike.
    scale: u64,
    offset: u64,
    line: bool,
}

impl Wanted {
    /// Reads the file.
    pub(super) fn load(&self, library: &Library<'_>) -> Result<Recording, Problem> {
        let text = library.text(&self.path).map_err(|problem| {
            let mut parts = problem.splitn(2, "; ");
            let message = Problem::new(About::File, parts.next().unwrap_or(""));
            match parts.next() {
                Some(help) => message.help(help),
                None => message,
            }
        })?;
        let (scale, offset) = (f64::from_bits(self.scale), f64::from_bits(self.offset));
        let convert = |x: f64| match scale * x + offset {
            y if y.abs() <= 1e12 => Ok(y),
            y => Err(format!(
                "the value {} is out of range; allowed: {}",
                show_short(y),
                Allowed::SIGNAL.text()
            )),
        };
        let rows = columns::read(&self.path, &text, &self.time, &self.column, convert)?;
        let column = match &self.column {
            Column::Name(name) => format!("{}: {name}", self.path),
            Column::Number(number) => format!("{}: column {number}", self.path),
            Column::Usual => self.path.clone(),
        };
        let between = if self.line { Between::Line } else { Between::Hold };
        Ok(Recording { name: column, times: rows.times, values: rows.values, between })
    }
}

/// Reads the recording that the keys of `table` name.
pub(super) fn read(table: &Table<'_>, library: &Library<'_>) -> Option<Arc<Recording>> {
    let before = table.log.count();
    let path = table.text("csv");
    let (column, time) = (column(table, "column"), column(table, "time"));
    let scale = match table.span("scale") {
        Some(_) => table.number_in("scale", Allowed::new(-1e15, 1e15, "")).map_or(1.0, |scale| scale.value),
        None => 1.0,
    };
    let offset = table.number_in("offset", Allowed::SIGNAL).map_or(0.0, |offset| offset.value);
    let betweens = [("hold", Between::Hold), ("line", Between::Line)];
    let between = table.choice("between", &betweens).map_or(Between::Hold, |between| between.value);
    let path = path?;
    // A key that is misspelt, which is told later, may be what the file is missing.
    let is_odd = table.written().iter().any(|(key, ..)| *key != "csv" && !KEYS.contains(key));
    if is_odd || table.log.count() > before {
        return None;
    }
    let wanted = Wanted {
        path: path.value.to_owned(),
        time,
        column,
        scale: scale.to_bits(),
        offset: offset.to_bits(),
        line: between == Between::Line,
    };
    match library.recording(&wanted) {
        Ok(recording) => Some(recording),
        Err(problem) => {
            let unreadable = library.text(path.value).is_err();
            let code = match problem.about {
                _ if unreadable => code::FILE,
                About::File => code::RECORDING,
                About::Time | About::Value => code::UNKNOWN_NAME,
            };
            let span = match problem.about {
                About::File => None,
                About::Time => table.span("time"),
                About::Value => table.span("column"),
            };
            let mut fault = Fault::new(code, span.unwrap_or(path.span), problem.message);
            fault.help = problem.help;
            table.log.fault(fault);
            None
        }
    }
}

/// A column by its name or its number.
fn column(table: &Table<'_>, key: &'static str) -> Column {
    if table.span(key).is_none() {
        return Column::Usual;
    }
    if !table.is_text(key) {
        return table
            .integer_in(key, 1, 100_000)
            .map_or(Column::Usual, |number| Column::Number(number.value));
    }
    match table.text(key) {
        Some(name) if !name.value.trim().is_empty() => Column::Name(name.value.trim().to_owned()),
        Some(name) => {
            let message = format!("`{} = \"{}\"` is empty", table.name(key), shortened(name.value));
            table.log.fault(
                Fault::new(code::OUT_OF_RANGE, name.span, message)
                    .help("write the column's name or its number"),
            );
            Column::Usual
        }
        None => Column::Usual,
    }
}
