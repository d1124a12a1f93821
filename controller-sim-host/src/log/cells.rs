//! Lines and cells of a table, with their places.

use super::sign::{Sign, Written, written};
use std::ops::Range;

/// A cell: its place in the text, without spaces and quotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) span: Range<usize>,
}

/// A line that is neither empty nor a comment.
#[derive(Debug, Clone)]
pub(super) struct Line {
    /// Counted from 1.
    pub(super) number: usize,
    pub(super) cells: Vec<Cell>,
}

/// What is between the cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Char(char),
    Spaces,
}

/// A text cut into lines with their places: first those that are comments, then all others.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, Range<usize>)> {
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut at = start;
    text[start..].split_inclusive('\n').enumerate().map(move |(index, line)| {
        let from = at;
        at += line.len();
        (index + 1, from..from + line.trim_end_matches(['\n', '\r']).len())
    })
}

pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    ["#", "%", "//"].iter().any(|sign| line.starts_with(sign))
}

/// The separator of the table: the one that the lines that look like rows of numbers have.
pub(super) fn separator(text: &str) -> Separator {
    let rows = || {
        let shown = lines(text).map(|(_, span)| &text[span]).filter(|line| !is_comment(line));
        let with_digits = move |line: &&str| line.chars().any(|c| c.is_ascii_digit());
        shown.filter(with_digits).take(50)
    };
    let count = rows().count();
    for sign in [';', '\t', ','] {
        if 2 * rows().filter(|line| line.contains(sign)).count() > count {
            return Separator::Char(sign);
        }
    }
    if 2 * rows().filter(|line| line.split_whitespace().count() > 1).count() > count {
        return Separator::Spaces;
    }
    Separator::Char(',')
}

/// The cells of the line at `span`.
pub(super) fn cells(text: &str, span: &Range<usize>, separator: Separator) -> Vec<Cell> {
    let line = &text[span.clone()];
    let mut list = Vec::new();
    let mut push = |from: usize, to: usize| {
        let raw = &line[from..to];
        let trimmed = raw.trim();
        let mut start = span.start + from + (raw.len() - raw.trim_start().len());
        let mut length = trimmed.len();
        let quoted = length >= 2 && trimmed.starts_with('"') && trimmed.ends_with('"');
        if quoted {
            let inner = &trimmed[1..length - 1];
            start += 1 + (inner.len() - inner.trim_start().len());
            length = inner.trim().len();
        }
        list.push(Cell { span: start..start + length });
    };
    let (mut from, mut in_quotes) = (0, false);
    match separator {
        Separator::Char(sign) => {
            for (at, c) in line.char_indices() {
                if c == '"' {
                    in_quotes = !in_quotes;
                } else if c == sign && !in_quotes {
                    push(from, at);
                    from = at + c.len_utf8();
                }
            }
            push(from, line.len());
        }
        Separator::Spaces => {
            for word in line.split_whitespace() {
                let at = word.as_ptr() as usize - line.as_ptr() as usize;
                push(at, at + word.len());
            }
        }
    }
    list
}

/// The number in a cell, infinite ones and NaN included; `sign` is that of its column.
pub(super) fn number(cell: &str, sign: Option<Sign>) -> Option<f64> {
    let written = written(cell)?;
    let sign = match written {
        Written::Whole => return cell.parse().ok(),
        Written::By(own) => own,
        // Without a sign of the column, whatever it is: who asks only wants to know whether it is a number.
        Written::Unclear(own) => sign.unwrap_or(own),
    };
    if sign == Sign::Point && !cell.contains(',') {
        return cell.parse().ok();
    }
    let group = sign.other().char();
    cell.replace(group, "").replace(sign.char(), ".").parse().ok()
}
