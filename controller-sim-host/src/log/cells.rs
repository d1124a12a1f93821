//! Lines and cells of a table, with their places.

use std::ops::Range;

/// A cell: its place in the text, without spaces and quotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) span: Range<usize>,
    pub(super) quoted: bool,
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
        list.push(Cell { span: start..start + length, quoted });
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

/// The number in a cell, infinite ones and NaN included.
pub(super) fn number(cell: &str, comma_is_decimal: bool) -> Option<f64> {
    let signs = |c: char| c.is_ascii_digit() || "+-.eE,".contains(c);
    if cell.is_empty() || !cell.chars().all(signs) {
        return None;
    }
    if cell.contains(',') {
        let decimal = comma_is_decimal && !cell.contains('.') && cell.matches(',').count() == 1;
        return if decimal { cell.replace(',', ".").parse().ok() } else { None };
    }
    cell.parse().ok()
}
