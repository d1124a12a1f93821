//! Two columns of a table in CSV: times and values.
//!
//! Tables come from data loggers and spreadsheets: with or without a header and a line of units, with commas,
//! semicolons or tabs between the cells, with decimal commas where the comma is free.

use super::number::show;
use super::suggest::closest;
use super::value::shortened;
use csv::{ReaderBuilder, StringRecord, Trim};

/// Most rows of a recording.
const MOST_ROWS: usize = 10_000_000;

/// Units of time other than seconds, in small letters.
const OTHER_UNITS: [&str; 16] = [
    "ns",
    "us",
    "\u{b5}s",
    "\u{3bc}s",
    "ms",
    "msec",
    "milliseconds",
    "min",
    "minute",
    "minutes",
    "h",
    "hour",
    "hours",
    "d",
    "day",
    "days",
];

/// A column, as a person names it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Column {
    /// Not said.
    Usual,
    /// Its number, from 1.
    Number(u64),
    /// What is written above it.
    Name(String),
}

/// What a problem is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum About {
    /// The file and what is in it.
    File,
    /// Which column has the times.
    Time,
    /// Which column has the values.
    Value,
}

/// What is wrong with a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) about: About,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl Problem {
    pub(super) fn new(about: About, message: impl Into<String>) -> Self {
        Self { about, message: message.into(), help: None }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Times from 0 on, rising, with as many values.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Rows {
    pub(super) times: Vec<f64>,
    pub(super) values: Vec<f64>,
}

/// Reads two columns of the table `text` of the file `name`; `convert` is what becomes of a value, or why it cannot be
/// used.
pub(super) fn read(
    name: &str,
    text: &str,
    time: &Column,
    value: &Column,
    convert: impl Fn(f64) -> Result<f64, String>,
) -> Result<Rows, Problem> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let table = Table { name, separator: separator(text) };
    let mut reader = ReaderBuilder::new()
        .delimiter(table.separator)
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut record = StringRecord::new();
    let mut next = |record: &mut StringRecord| -> Result<bool, Problem> {
        loop {
            match reader.read_record(record) {
                Ok(false) => return Ok(false),
                // A line of separators only is an empty line of a spreadsheet.
                Ok(true) if record.iter().all(str::is_empty) => {}
                Ok(true) => return Ok(true),
                Err(error) => {
                    return Err(Problem::new(About::File, format!("`{name}` cannot be read: {error}")));
                }
            }
        }
    };
    if !next(&mut record)? {
        return Err(table.empty());
    }
    let width = record.len();
    let mut has_row = true;
    let header: Option<Vec<String>> = if table.is_header(&record) {
        let names = record.iter().map(str::to_owned).collect();
        has_row = next(&mut record)?;
        Some(names)
    } else {
        table.header_in_comment(text, width)
    };
    let [time, value] = table.columns(header.as_deref(), width, time, value)?;
    if let Some(unit) = header.as_ref().and_then(|names| in_brackets(names.get(time)?)) {
        table.check_seconds(unit, time, header.as_deref())?;
    }
    let chosen = |record: &StringRecord| [time, value].map(|column| record.get(column).map(str::to_owned));
    if has_row && header.is_some() {
        // Not a single number where numbers have to be: what they are measured in.
        let no_number =
            |cell: Option<String>| cell.is_none_or(|cell| table.number(&cell).is_none() && !cell.is_empty());
        if record.position().is_some_and(|at| at.record() > 0) && chosen(&record).into_iter().all(no_number) {
            table.check_seconds(record.get(time).unwrap_or(""), time, header.as_deref())?;
            has_row = next(&mut record)?;
        }
    }
    let mut rows = Rows::default();
    let mut first = 0.0;
    let mut last = f64::NEG_INFINITY;
    while has_row {
        let line = record.position().map_or(0, csv::Position::line);
        let place = |column: usize| {
            let title = header.as_ref().and_then(|names| names.get(column));
            let title = title.map_or(String::new(), |title| format!(" (`{}`)", shortened(title)));
            format!("`{name}`, line {line}, column {}{title}", column + 1)
        };
        let cell = |column: usize| table.cell(&record, column, || place(column));
        let (t, y) = (cell(time)?, cell(value)?);
        if t < last {
            let message = format!(
                "{}: the time {} is before {}, that of the row above",
                place(time),
                show(t),
                show(last)
            );
            let help = "times must rise; sort the rows, or name another column by `time`";
            return Err(Problem::new(About::File, message).help(help));
        }
        let y = convert(y).map_err(|why| Problem::new(About::File, format!("{}: {why}", place(value))))?;
        if rows.times.is_empty() {
            first = t;
        }
        // A doubled time stamp: what was written last holds.
        if t == last {
            rows.times.pop();
            rows.values.pop();
        }
        rows.times.push(t - first);
        rows.values.push(y);
        last = t;
        if rows.times.len() > MOST_ROWS {
            return Err(Problem::new(About::File, format!("`{name}` has more than {MOST_ROWS} rows")));
        }
        has_row = next(&mut record)?;
    }
    if rows.times.is_empty() { Err(table.empty()) } else { Ok(rows) }
}

/// What stands in brackets at the end of a name.
fn in_brackets(name: &str) -> Option<&str> {
    let [open, close] = if name.ends_with(']') { ['[', ']'] } else { ['(', ')'] };
    name.strip_suffix(close)?.rsplit_once(open).map(|(_, unit)| unit)
}

/// The character between the cells, as the first line with any shows it.
fn separator(text: &str) -> u8 {
    let line = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or("");
    [';', '\t'].into_iter().find(|&c| line.contains(c)).map_or(b',', |c| if c == ';' { b';' } else { b'\t' })
}

struct Table<'t> {
    name: &'t str,
    separator: u8,
}

impl Table<'_> {
    fn empty(&self) -> Problem {
        Problem::new(About::File, format!("`{}` has no rows", self.name))
    }

    /// Times in another unit than seconds would be taken for seconds: a unit of time that is written must be that.
    fn check_seconds(&self, unit: &str, time: usize, header: Option<&[String]>) -> Result<(), Problem> {
        let plain = unit.trim_matches(|c: char| c.is_whitespace() || "[]()".contains(c)).to_lowercase();
        if !OTHER_UNITS.contains(&&*plain) {
            return Ok(());
        }
        let title = header.and_then(|names| names.get(time)).map_or("", |name| name);
        let message = format!(
            "`{}`, column {} (`{}`): the times are in `{}`; seconds are needed",
            self.name,
            time + 1,
            shortened(title),
            shortened(unit.trim())
        );
        Err(Problem::new(About::File, message).help("convert them, or name a column in seconds by `time`"))
    }

    /// A number, infinite ones and NaN included.
    fn number(&self, cell: &str) -> Option<f64> {
        let comma = self.separator != b',' && !cell.contains('.') && cell.matches(',').count() == 1;
        if comma { cell.replace(',', ".").parse().ok() } else { cell.parse().ok() }
    }

    /// Whether the first line names the columns.
    fn is_header(&self, record: &StringRecord) -> bool {
        let mut filled = record.iter().filter(|cell| !cell.is_empty());
        let begins_with_word = record
            .iter()
            .next()
            .is_some_and(|cell| self.number(cell).is_none() && cell.starts_with(char::is_alphabetic));
        begins_with_word || filled.all(|cell| self.number(cell).is_none())
    }

    /// The names in the comment above the first row, when it has as many cells.
    fn header_in_comment(&self, text: &str, width: usize) -> Option<Vec<String>> {
        let above = text.lines().take_while(|line| line.trim().is_empty() || line.starts_with('#'));
        let line = above.filter(|line| line.starts_with('#')).last()?.trim_start_matches('#');
        let names: Vec<String> =
            line.split(char::from(self.separator)).map(|cell| cell.trim().to_owned()).collect();
        let is_header = names.len() == width && names.iter().all(|name| self.number(name).is_none());
        is_header.then_some(names)
    }

    /// The indices of the columns of times and values.
    fn columns(
        &self,
        header: Option<&[String]>,
        width: usize,
        time: &Column,
        value: &Column,
    ) -> Result<[usize; 2], Problem> {
        let time = match time {
            Column::Usual => 0,
            other => self.column(header, width, other, About::Time)?,
        };
        if *value == Column::Usual && width != 2 {
            let names = header.map_or(String::new(), |names| format!(": {}", list(names)));
            let message = format!("`{}` has {width} columns{names}; `column` says which one", self.name);
            return Err(
                Problem::new(About::Value, message).help("write its name or its number, `column = 2`")
            );
        }
        let value = match value {
            Column::Usual => 1 - time.min(1),
            other => self.column(header, width, other, About::Value)?,
        };
        if time == value {
            let message = format!("column {} of `{}` is that of the times", time + 1, self.name);
            return Err(Problem::new(About::Value, message).help("name the column of the values by `column`"));
        }
        Ok([time, value])
    }

    fn column(
        &self,
        header: Option<&[String]>,
        width: usize,
        column: &Column,
        about: About,
    ) -> Result<usize, Problem> {
        let name = match column {
            Column::Name(name) => name,
            Column::Number(number) => {
                let index =
                    usize::try_from(*number).ok().and_then(|n| n.checked_sub(1)).filter(|n| *n < width);
                let message = || format!("`{}` has no column {number}; there are {width}", self.name);
                return index
                    .ok_or_else(|| Problem::new(about, message()).help("columns are counted from 1"));
            }
            Column::Usual => return Ok(0),
        };
        let Some(names) = header else {
            let message =
                format!("`{}` has no line with names; there is no column `{}`", self.name, shortened(name));
            return Err(Problem::new(about, message).help("give its number, from 1"));
        };
        let mut found = names.iter().enumerate().filter(|(_, other)| *other == name).map(|(index, _)| index);
        match (found.next(), found.next()) {
            (Some(index), None) => Ok(index),
            (Some(first), Some(second)) => {
                let message = format!("`{}` has two columns `{}`", self.name, shortened(name));
                let help = format!("give the number: {} or {}", first + 1, second + 1);
                Err(Problem::new(about, message).help(help))
            }
            _ => {
                let known: Vec<&str> = names.iter().map(String::as_str).collect();
                let help = match closest(name, &known) {
                    Some(meant) => format!("did you mean \"{}\"?", shortened(meant)),
                    None => format!("there are {}", list(names)),
                };
                Err(Problem::new(about, format!("`{}` has no column `{}`", self.name, shortened(name)))
                    .help(help))
            }
        }
    }

    /// The number in a cell; `place` says where it is.
    fn cell(&self, record: &StringRecord, column: usize, place: impl Fn() -> String) -> Result<f64, Problem> {
        let Some(cell) = record.get(column) else {
            let message = format!("{}: the row ends after column {}", place(), record.len());
            return Err(Problem::new(About::File, message));
        };
        match self.number(cell) {
            Some(number) if number.is_finite() && number.abs() <= 1e15 => Ok(number),
            Some(_) => Err(Problem::new(
                About::File,
                format!("{}: `{}` is no finite number up to 1e15", place(), shortened(cell)),
            )),
            None if cell.is_empty() => {
                let problem = Problem::new(About::File, format!("{}: the cell is empty", place()));
                Err(problem.help("fill it, or take the row away: rows may be missing"))
            }
            None => {
                let problem =
                    Problem::new(About::File, format!("{}: `{}` is no number", place(), shortened(cell)));
                Err(match cell.chars().filter(|c| matches!(c, ':' | '-' | '/')).count() {
                    2.. => problem.help("times are numbers, in seconds"),
                    _ if cell.contains(',') => {
                        problem.help("with decimal commas, separate the columns by `;`")
                    }
                    _ => problem.help("numbers are written as `0.5`, `-3` or `1e-3`"),
                })
            }
        }
    }
}

/// At most a few names, in quotes.
fn list(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(12).map(|name| format!("\"{}\"", shortened(name))).collect();
    let more = if names.len() > shown.len() { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}
