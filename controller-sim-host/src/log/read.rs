//! From the text of a log to its numbers.

use super::cells::{Cell, Line, Separator, cells, is_comment, lines, number, separator};
use super::choose::{Role, choose, words};
use super::sign::{Reading, Sign, Signs};
use super::time::{self, Clock, Stamp};
use crate::scenario::{Fault, code, show_short};
use std::ops::Range;

/// Most rows of a log.
const MOST_ROWS: usize = 10_000_000;
/// Most remarks of one kind that are told one by one.
const MOST_REMARKS: usize = 3;
/// A step this much longer than the usual one is a gap.
const GAP: f64 = 5.0;

/// A log that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// Times in s, not falling; of date-times since the first row.
    pub times: Vec<f64>,
    /// The other columns, in the order of their roles; `None` for one that is not there and need not be.
    pub columns: Vec<Option<Vec<f64>>>,
    /// What stands above the columns, the times first; empty without names.
    pub titles: Vec<String>,
    /// The units of the columns, the times first, where a line of units says so.
    pub units: Vec<String>,
    /// The line of each row, from 1.
    pub lines: Vec<usize>,
    /// What a person should know, with places in the text.
    pub remarks: Vec<Fault>,
}

/// Reads the log `text` of the file `file`; the first of `roles` are the times. Without a column of times, where there
/// need not be one, they are the numbers of the rows, from 0.
///
/// # Errors
/// The first fault, with its place in the text: no table, a column that is not there or not clear, a time that goes back,
/// too many rows that cannot be used.
///
/// ```
/// use controller_sim_host::log::{Column, Role, read};
/// let text = "time;heater;T1\n[s];[%];[\u{b0}C]\n0;0;20,9\n0;50;20,9\n1,5;50;21,3\n";
/// let roles = [Role::time(Column::Usual), Role::input(Column::Usual), Role::output(Column::Usual)];
/// let log = read("log.csv", text, &roles).expect("a table");
/// assert_eq!(log.times, [0.0, 0.0, 1.5]);
/// assert_eq!(log.columns[1], Some(vec![20.9, 20.9, 21.3]));
/// assert_eq!(log.units, ["s", "%", "\u{b0}C"]);
/// ```
pub fn read(file: &str, text: &str, roles: &[Role]) -> Result<Log, Fault> {
    let table = Table::find(file, text)?;
    let width = table.rows.iter().take(200).map(|row| row.cells.len()).max().unwrap_or(0);
    let pair = table.date_and_clock();
    let mut chosen = choose(file, &table.names, width, roles, pair.map(|(date, _)| date))
        .map_err(|fault| Fault { span: table.place_of_names(), ..fault })?;
    // Who names the column of the dates means both.
    if let (Some(time), Some((date, clock))) = (chosen.first_mut(), pair)
        && *time == Some(date)
    {
        *time = Some(clock);
    }
    let title = |column: &Option<usize>, list: &[String]| -> String {
        column.and_then(|c| list.get(c)).cloned().unwrap_or_default()
    };
    let mut log = Log {
        columns: chosen.iter().skip(1).map(|c| c.map(|_| Vec::new())).collect(),
        titles: chosen.iter().map(|c| title(c, &table.names)).collect(),
        units: chosen.iter().map(|c| title(c, &table.units)).collect(),
        ..Log::default()
    };
    let time_column = chosen.first().copied().flatten();
    let date_column = pair.filter(|(_, clock)| time_column == Some(*clock)).map(|(date, _)| date);
    let title = log.titles.first().map_or(Vec::new(), |title| words(title));
    let below = log.units.first().map_or(Vec::new(), |unit| words(unit));
    let mut clock = Clock::new(&below, title.get(1..).unwrap_or(&[]));
    if let Some(fault) = chosen.iter().flatten().find_map(|column| table.unclear(*column)) {
        return Err(fault);
    }
    let mut skipped: Vec<Fault> = Vec::new();
    for row in &table.rows {
        let mut values = Vec::with_capacity(chosen.len());
        let time = match time_column {
            Some(column) => table.time(row, column, date_column),
            None => Ok(Stamp::Number(log.times.len() as f64)),
        };
        let found = time.and_then(|t| {
            for column in chosen.iter().skip(1).flatten() {
                values.push(table.value(row, *column)?);
            }
            Ok(t)
        });
        let stamp = match found {
            Ok(found) => found,
            Err(fault) => {
                skipped.push(fault);
                continue;
            }
        };
        let time_column = time_column.unwrap_or(0);
        let t = clock.seconds(stamp).map_err(|why| table.fault(row, time_column, why))?;
        if let Some(last) = log.times.last().filter(|last| t < **last) {
            let message =
                format!("the time {} is before {}, that of the row above", show_short(t), show_short(*last));
            let fault = table.fault(row, time_column, message);
            return Err(fault.help(
                "times must not go back: sort the rows, or name another column by `--time`; \
                 `--log-ts S` reads a log without times",
            ));
        }
        log.times.push(t);
        log.lines.push(row.number);
        for (list, value) in log.columns.iter_mut().flatten().zip(values) {
            list.push(value);
        }
    }
    if log.times.is_empty() || 5 * skipped.len() > table.rows.len() {
        return Err(skipped.into_iter().next().unwrap_or_else(|| table.empty()));
    }
    log.remarks.extend(clock.unit().map(|unit| {
        Fault::new(code::RECORDING, table.place_of_names(), format!("the times are taken to be {unit}"))
    }));
    tell(&mut log.remarks, skipped, "the row is left out: ", "more rows are left out");
    log.remarks.extend(chosen.iter().flatten().filter_map(|column| table.thousands(*column)));
    log.remarks.extend(doubled(&log, &table));
    let gaps = gaps(&log, &table);
    tell(&mut log.remarks, gaps, "", "more gaps");
    Ok(log)
}

/// The first faults as remarks, the others by their number.
fn tell(remarks: &mut Vec<Fault>, faults: Vec<Fault>, before: &str, more: &str) {
    let (count, last) = (faults.len(), faults.last().map_or(0..0, |fault| fault.span.clone()));
    for mut fault in faults.into_iter().take(MOST_REMARKS) {
        fault.message.insert_str(0, before);
        remarks.push(fault);
    }
    if count > MOST_REMARKS {
        let message = format!("{} {more}; this is the last one", count - MOST_REMARKS);
        remarks.push(Fault::new(code::RECORDING, last, message));
    }
}

/// How long the steps between rows usually are.
fn usual_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

fn gaps(log: &Log, table: &Table<'_>) -> Vec<Fault> {
    let usual = usual_step(&log.times);
    let rows = log.times.windows(2).zip(&log.lines[1..]);
    let long = rows.filter(|(t, _)| usual > 0.0 && t[1] - t[0] > GAP * usual);
    long.map(|(t, line)| {
        let message = format!(
            "a gap of {} s from {} s on, where rows are usually {} s apart; the input counts as held in it",
            show_short(t[1] - t[0]),
            show_short(t[0]),
            show_short(usual)
        );
        Fault::new(code::RECORDING, table.line(*line), message)
    })
    .collect()
}

/// Doubled time stamps: one may be a step, many are a clock that is too coarse.
fn doubled(log: &Log, table: &Table<'_>) -> Option<Fault> {
    let (mut count, mut first) = (0, 0);
    for (times, line) in log.times.windows(2).zip(&log.lines[1..]) {
        if times[0] == times[1] {
            count += 1;
            first = if count == 1 { *line } else { first };
        }
    }
    let message = match count {
        0 => return None,
        1 => "the time stamp is that of the row above: the later row holds".to_owned(),
        n => format!("{n} time stamps are those of the row above, this is the first: the later rows hold"),
    };
    let fault = Fault::new(code::RECORDING, table.line(first), message);
    let many = 4 * count > log.times.len();
    Some(if many { fault.help("record times with more digits: rows are lost") } else { fault })
}

/// The table in a text: where its rows are, and what stands above them.
struct Table<'t> {
    file: &'t str,
    text: &'t str,
    signs: Signs,
    readings: Vec<Reading>,
    spans: Vec<Range<usize>>,
    names: Vec<String>,
    names_at: Option<Range<usize>>,
    units: Vec<String>,
    rows: Vec<Line>,
}

impl<'t> Table<'t> {
    fn find(file: &'t str, text: &'t str) -> Result<Self, Fault> {
        let separator = separator(text);
        let mut table = Self {
            file,
            text,
            signs: Signs::new(separator == Separator::Char(',')),
            readings: Vec::new(),
            spans: Vec::new(),
            names: Vec::new(),
            names_at: None,
            units: Vec::new(),
            rows: Vec::new(),
        };
        let mut above: Vec<(Line, Range<usize>)> = Vec::new();
        let mut comment = None;
        for (number, span) in lines(text) {
            table.spans.push(span.clone());
            let line = &text[span.clone()];
            if is_comment(line) {
                comment = if table.rows.is_empty() { Some(span) } else { comment };
                continue;
            }
            let cells = cells(text, &span, separator);
            // A line of separators only is an empty line of a spreadsheet.
            if cells.iter().all(|cell| cell.span.is_empty()) {
                continue;
            }
            let row = Line { number, cells };
            let numbers = row.cells.iter().filter(|cell| table.is_number(cell)).count();
            if table.rows.is_empty() && (numbers == 0 || numbers < 2 && row.cells.len() > 2) {
                above.push((row, span));
                continue;
            }
            if table.rows.len() == MOST_ROWS {
                let message = format!("`{file}` has more than {MOST_ROWS} rows");
                return Err(Fault::new(code::RECORDING, span, message));
            }
            table.signs.see(text, &row, table.rows.len());
            table.rows.push(row);
        }
        table.readings = table.signs.readings();
        let Some(width) = table.rows.first().map(|row| row.cells.len()) else { return Err(table.empty()) };
        table.head(above, comment, width, separator);
        Ok(table)
    }

    /// Names and units from the lines above the rows.
    fn head(
        &mut self,
        mut above: Vec<(Line, Range<usize>)>,
        comment: Option<Range<usize>>,
        width: usize,
        separator: Separator,
    ) {
        above.retain(|(line, _)| line.cells.len() >= width);
        let texts = |cells: &[Cell]| -> Vec<String> {
            cells.iter().map(|cell| self.text[cell.span.clone()].to_owned()).collect()
        };
        let last = above.pop();
        let before = above.pop();
        let (names, units) = match (before, last) {
            (Some(before), Some(last)) if are_units(&texts(&last.0.cells)) => (Some(before), Some(last)),
            (_, last) => (last, None),
        };
        let units = units.map_or(Vec::new(), |(line, _)| texts(&line.cells));
        let (names, at) = match (names, comment) {
            (Some((line, span)), _) => (texts(&line.cells), Some(span)),
            (None, Some(span)) => {
                let start = self.text[span.clone()].find(|c: char| !"#%/ \t".contains(c));
                let inner = span.start + start.unwrap_or(0)..span.end;
                let cells = cells(self.text, &inner, separator);
                let names = texts(&cells);
                let fits = cells.len() == width && cells.iter().all(|cell| !self.is_number(cell));
                if fits { (names, Some(span)) } else { (Vec::new(), None) }
            }
            (None, None) => (Vec::new(), None),
        };
        let bare = |unit: String| unit.trim_matches(['[', ']', '(', ')', ' ']).to_owned();
        let units = units.into_iter().map(bare).collect();
        (self.names, self.names_at, self.units) = (names, at, units);
    }

    fn is_number(&self, cell: &Cell) -> bool {
        time::parse(&self.text[cell.span.clone()], None).is_some()
    }

    fn empty(&self) -> Fault {
        Fault::new(code::RECORDING, 0..0, format!("`{}` has no rows of numbers", self.file))
    }

    fn line(&self, number: usize) -> Range<usize> {
        number.checked_sub(1).and_then(|index| self.spans.get(index)).cloned().unwrap_or(0..0)
    }

    fn place_of_names(&self) -> Range<usize> {
        let first = || self.rows.first().map_or(0..0, |row| self.line(row.number));
        self.names_at.clone().unwrap_or_else(first)
    }

    /// A fault of a cell, or of the end of a row that is too short.
    fn fault(&self, row: &Line, column: usize, why: impl Into<String>) -> Fault {
        let end = self.line(row.number).end;
        let span = row.cells.get(column).map_or(end..end, |cell| cell.span.clone());
        let title = self.names.get(column).filter(|name| !name.is_empty());
        let title = title
            .map_or(format!("column {}", column + 1), |name| format!("column {} (`{name}`)", column + 1));
        Fault::new(code::RECORDING, span, format!("{title}: {}", why.into()))
    }

    fn cell(&self, row: &Line, column: usize) -> Result<&'t str, Fault> {
        match row.cells.get(column) {
            Some(cell) if !cell.span.is_empty() => Ok(&self.text[cell.span.clone()]),
            Some(_) => Err(self.fault(row, column, "the cell is empty")),
            None => Err(self.fault(row, column, format!("the row ends after column {}", row.cells.len()))),
        }
    }

    /// The decimal sign of a column.
    fn sign(&self, column: usize) -> Option<Sign> {
        match self.readings.get(column) {
            Some(Reading::By(sign)) => Some(*sign),
            _ => None,
        }
    }

    /// That the numbers of a column are decimal ones or thousands, and nobody can tell.
    fn unclear(&self, column: usize) -> Option<Fault> {
        let Some(Reading::Unknown(row)) = self.readings.get(column) else { return None };
        let row = self.rows.get(*row)?;
        let text = self.cell(row, column).ok()?;
        let why = format!("`{text}` may be a decimal number or thousands");
        Some(self.fault(row, column, why).help(
            "write numbers without a sign between thousands, or all of a column with the same number of decimals",
        ))
    }

    /// That a single sign is taken to part thousands.
    fn thousands(&self, column: usize) -> Option<Fault> {
        let sign = self.sign(column)?;
        let row = self.signs.thousands(column, sign)?;
        let row = self.rows.get(row)?;
        let text = self.cell(row, column).ok()?;
        let value = number(text, Some(sign))?;
        let why = format!("`{text}` is taken for {value}: a {} is the decimal sign here", sign.name());
        Some(self.fault(row, column, why))
    }

    /// The two columns next to each other in which dates and clock times are.
    fn date_and_clock(&self) -> Option<(usize, usize)> {
        let is = |row: &Line, column: usize, kind: fn(&str) -> bool| {
            row.cells.get(column).is_some_and(|cell| kind(&self.text[cell.span.clone()]))
        };
        let of_row = |row: &Line| {
            (1..row.cells.len())
                .flat_map(|at| [(at - 1, at), (at, at - 1)])
                .find(|(date, clock)| is(row, *date, time::is_date) && is(row, *clock, time::is_clock))
        };
        self.rows.iter().take(5).find_map(of_row)
    }

    fn time(&self, row: &Line, column: usize, date: Option<usize>) -> Result<Stamp, Fault> {
        let text = self.cell(row, column)?;
        let (wrong, parsed) = match date {
            Some(date) => (date, time::joined(self.cell(row, date)?, text)),
            None => (column, time::parse(text, self.sign(column))),
        };
        parsed.filter(|stamp| !matches!(stamp, Stamp::Number(t) if t.abs() > 1e15)).ok_or_else(|| {
            let help = match time::is_unclear(text) {
                true => "day or month first? write dates as `2024-03-01` or, the day first, `01.03.2024`",
                false => {
                    "times are seconds, `12:30:05.5`, `2024-03-01T12:30:05.5Z` or `01.03.2024 12:30:05,5`"
                }
            };
            self.fault(row, wrong, "this is no time").help(help)
        })
    }

    fn value(&self, row: &Line, column: usize) -> Result<f64, Fault> {
        let text = self.cell(row, column)?;
        match number(text, self.sign(column)) {
            Some(x) if x.abs() <= 1e15 => Ok(x),
            Some(_) => Err(self.fault(row, column, "the number is larger than 1e15")),
            None => Err(self.fault(row, column, "this is no number")),
        }
    }
}

/// Whether the cells of a line are units, not names.
fn are_units(cells: &[String]) -> bool {
    const KNOWN: [&str; 36] = [
        "s", "sec", "ms", "min", "h", "hh:mm:ss", "%", "\u{b0}c", "degc", "c", "k", "\u{b0}f", "degf", "v",
        "mv", "a", "ma", "w", "kw", "bar", "mbar", "pa", "kpa", "mpa", "psi", "m", "mm", "cm", "l/min",
        "l/s", "m3/h", "rpm", "1/min", "hz", "-", "",
    ];
    let is_unit = |cell: &String| {
        let bracketed = cell.starts_with(['[', '(']) && cell.ends_with([']', ')']);
        bracketed || KNOWN.contains(&&*cell.to_lowercase())
    };
    cells.iter().any(|cell| !cell.is_empty())
        && 2 * cells.iter().filter(|cell| is_unit(cell)).count() > cells.len()
}
