//! Which of point and comma is the decimal sign, and which one parts thousands.

use super::cells::{Cell, Line};
use std::ops::{BitOr, Range};

/// A decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    Point,
    Comma,
}

impl Sign {
    pub(super) const fn char(self) -> char {
        match self {
            Self::Point => '.',
            Self::Comma => ',',
        }
    }

    pub(super) const fn other(self) -> Self {
        match self {
            Self::Point => Self::Comma,
            Self::Comma => Self::Point,
        }
    }

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Comma => "comma",
        }
    }
}

/// What a number says by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Written {
    /// No sign at all.
    Whole,
    /// Only this can be its decimal sign: `0,5`, `12.50`, `1.234,5`, `1,234,567`.
    By(Sign),
    /// `1.098` by this sign: a decimal number, or a thousand and some.
    Unclear(Sign),
}

/// How a number is written; `None`: it is none.
pub(super) fn written(cell: &str) -> Option<Written> {
    let mantissa = cell.split(['e', 'E']).next().unwrap_or("");
    let has_exponent = mantissa.len() < cell.len();
    let digits = mantissa.strip_prefix(['+', '-']).unwrap_or(mantissa);
    let has_digits = digits.bytes().any(|b| b.is_ascii_digit());
    if !has_digits || !digits.bytes().all(|b| b.is_ascii_digit() || b == b'.' || b == b',') {
        return None;
    }
    let count = |sign: Sign| digits.matches(sign.char()).count();
    let (points, commas) = (count(Sign::Point), count(Sign::Comma));
    let signs = match (points, commas) {
        (0, 0) => return Some(Written::Whole),
        (_, 0) => (Sign::Point, points),
        (0, _) => (Sign::Comma, commas),
        _ => {
            let decimal = if digits.rfind('.') > digits.rfind(',') { Sign::Point } else { Sign::Comma };
            let (whole, rest) = digits.split_once(decimal.char())?;
            let is_digits = rest.bytes().all(|b| b.is_ascii_digit());
            return (is_digits && grouped(whole, decimal.other())).then_some(Written::By(decimal));
        }
    };
    match signs {
        (sign, 1) if !has_exponent && grouped(digits, sign) => Some(Written::Unclear(sign)),
        (sign, 1) => Some(Written::By(sign)),
        (sign, _) => grouped(digits, sign).then_some(Written::By(sign.other())),
    }
}

/// Whether `sign` parts the digits into thousands.
fn grouped(digits: &str, sign: Sign) -> bool {
    let mut groups = digits.split(sign.char());
    let is_number = |group: &str| group.bytes().all(|b| b.is_ascii_digit());
    let first = groups.next().unwrap_or("");
    (1..=3).contains(&first.len())
        && is_number(first)
        && !first.starts_with('0')
        && groups.all(|group| group.len() == 3 && is_number(group))
}

/// What the cells of a column say together.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    whole: bool,
    point: bool,
    comma: bool,
    /// First cells that may be read in two ways, by point and by comma: index of the row.
    unclear: [Option<usize>; 2],
}

impl BitOr for Seen {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self { point: self.point | other.point, comma: self.comma | other.comma, ..Self::default() }
    }
}

impl Seen {
    /// The only sign that was seen.
    const fn only(self) -> Option<Sign> {
        match (self.point, self.comma) {
            (true, false) => Some(Sign::Point),
            (false, true) => Some(Sign::Comma),
            _ => None,
        }
    }
}

/// What all cells of a table say.
#[derive(Debug, Default)]
pub(super) struct Signs {
    columns: Vec<Seen>,
    /// Where cells are parted by commas, a point is no thousands sign.
    commas_part: bool,
}

/// How the numbers of a column that may be read in two ways are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// By this decimal sign.
    By(Sign),
    /// Nobody can tell; the row of the first such number.
    Unknown(usize),
}

impl Signs {
    pub(super) fn new(commas_part: bool) -> Self {
        Self { columns: Vec::new(), commas_part }
    }

    /// Looks at the next row.
    pub(super) fn see(&mut self, text: &str, row: &Line, index: usize) {
        if self.columns.len() < row.cells.len() {
            self.columns.resize(row.cells.len(), Seen::default());
        }
        let of = |cell: &Cell| -> &str { &text[Range::clone(&cell.span)] };
        for (seen, cell) in self.columns.iter_mut().zip(&row.cells) {
            match written(of(cell)) {
                Some(Written::Whole) => seen.whole = true,
                Some(Written::By(Sign::Point)) => seen.point = true,
                Some(Written::By(Sign::Comma)) => seen.comma = true,
                Some(Written::Unclear(sign)) => {
                    seen.unclear[usize::from(sign == Sign::Comma)].get_or_insert(index);
                }
                None => {}
            }
        }
    }

    /// How each column is read.
    pub(super) fn readings(&self) -> Vec<Reading> {
        let all = self.columns.iter().fold(Seen::default(), |all, seen| all | *seen);
        self.columns.iter().map(|own| self.of(*own, all)).collect()
    }

    /// How a column is read: by the sign that its own numbers have, else by that of all others; if none has one, three digits
    /// behind the sign in every number are decimals.
    fn of(&self, own: Seen, all: Seen) -> Reading {
        let known = own.only().or_else(|| if own.point { None } else { all.only() });
        match (known, own.unclear) {
            (Some(sign), _) => Reading::By(sign),
            (None, [None, None]) => Reading::By(Sign::Point),
            (None, [Some(_), None]) if self.commas_part => Reading::By(Sign::Point),
            (None, [Some(_), None]) if !own.whole && !own.point => Reading::By(Sign::Point),
            (None, [None, Some(_)]) if !own.whole && !own.point => Reading::By(Sign::Comma),
            (None, [point, comma]) => {
                Reading::Unknown(point.unwrap_or(usize::MAX).min(comma.unwrap_or(usize::MAX)))
            }
        }
    }

    /// The row of the first number of a column in which the other sign than `sign` stands alone and parts thousands.
    pub(super) fn thousands(&self, column: usize, sign: Sign) -> Option<usize> {
        self.columns.get(column)?.unclear[usize::from(sign == Sign::Point)]
    }
}
