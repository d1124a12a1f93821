//! The columns of a file of rows, and a row as it stands there.

use super::{row, sample};
use std::borrow::Cow;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A text that every row has.
    Text,
    /// A number that a row may not have.
    Number,
    /// A whole number that every row has.
    Count,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name, in files and in JSON.
    pub name: Cow<'static, str>,
    /// What it holds.
    pub kind: Kind,
}

impl Column {
    pub(super) const fn fixed(name: &'static str, kind: Kind) -> Self {
        Self { name: Cow::Borrowed(name), kind }
    }
}

/// What the rows of a file are about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// One rule on one plant.
    Rules,
    /// One controller on one plant that was drawn.
    Samples,
    /// One rule at one point of a map.
    Points,
}

/// The columns of a file. The first one names the study, the second one numbers the row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    about: About,
    columns: Vec<Column>,
}

impl Layout {
    /// That of [`Row`](super::Row)s.
    #[must_use]
    pub fn rules() -> Self {
        Self { about: About::Rules, columns: row::COLUMNS.to_vec() }
    }

    /// That of the rows of a map: those of [`rules`](Self::rules), then names and values of its parameters, and the horizon.
    #[must_use]
    pub fn points() -> Self {
        Self { about: About::Points, columns: [&row::COLUMNS[..], &row::POINT].concat() }
    }

    pub(super) const fn samples(columns: Vec<Column>) -> Self {
        Self { about: About::Samples, columns }
    }

    /// The layout with these names; `None`: no study writes them.
    pub(super) fn named(names: &[String]) -> Option<Self> {
        let has_them = |layout: &Self| {
            layout.columns.iter().map(|column| &*column.name).eq(names.iter().map(String::as_str))
        };
        if let Some(layout) = [Self::rules(), Self::points()].into_iter().find(has_them) {
            return Some(layout);
        }
        sample::columns_named(names).map(Self::samples)
    }

    /// What the rows are about.
    #[must_use]
    pub const fn about(&self) -> About {
        self.about
    }

    /// The columns, in order.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The place of a column.
    #[must_use]
    pub fn place(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The line with the names of the columns.
    pub(super) fn head(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|column| &*column.name).collect();
        names.join(",")
    }

    /// A row of a file; `None` when it is none of this layout.
    pub(super) fn read(&self, cells: Vec<String>) -> Option<Cells> {
        let fits = |(column, cell): (&Column, &String)| match column.kind {
            Kind::Text => true,
            Kind::Number => cell.is_empty() || cell.parse::<f64>().is_ok(),
            Kind::Count => cell.parse::<u64>().is_ok(),
        };
        let statuses: &[&str] = match self.about {
            About::Rules | About::Points => &row::STATUSES,
            About::Samples => &sample::STATUSES,
        };
        let status = self.place("status").and_then(|at| cells.get(at));
        let is_whole = cells.len() == self.columns.len()
            && self.columns.iter().zip(&cells).all(fits)
            && cells[Cells::NUMBER] != "0"
            && status.is_some_and(|status| statuses.contains(&status.as_str()));
        is_whole.then_some(Cells(cells))
    }
}

/// A row as it stands in a file: its cells are texts, numbers with all their digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cells(pub(super) Vec<String>);

impl Cells {
    /// The place of the row's number.
    pub(super) const NUMBER: usize = 1;

    /// The row `number` (from 1) of `study`, with nothing else in it yet.
    pub(super) fn new(study: &str, number: usize, columns: usize) -> Self {
        let mut cells = vec![String::new(); columns];
        study.clone_into(&mut cells[0]);
        cells[Self::NUMBER] = number.to_string();
        Self(cells)
    }

    /// All cells, in the order of the columns.
    #[must_use]
    pub fn all(&self) -> &[String] {
        &self.0
    }

    /// Which study it is of.
    #[must_use]
    pub fn study(&self) -> &str {
        &self.0[0]
    }

    /// Its number, from 1.
    #[must_use]
    pub fn number(&self) -> usize {
        self.0[Self::NUMBER].parse().unwrap_or(0)
    }

    /// Puts numbers into the cells from `from` on.
    pub(super) fn put(&mut self, from: usize, numbers: impl IntoIterator<Item = Option<f64>>) {
        for (cell, number) in self.0[from..].iter_mut().zip(numbers) {
            *cell = number.map_or(String::new(), show);
        }
    }

    /// Puts the reason why there is no result; a row is a line.
    pub(super) fn put_reason(&mut self, at: usize, reason: &str) {
        self.0[at] = reason.replace(['\n', '\r'], " ");
    }
}

impl AsRef<Cells> for Cells {
    fn as_ref(&self) -> &Cells {
        self
    }
}

/// A number with all its digits, such that reading and writing it again changes nothing.
pub(crate) fn show(x: f64) -> String {
    // With an exponent where that is shorter: 0.01, 1.5, 1e-7, 1e300; whole numbers without `.0`.
    let text = format!("{x:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_were() {
        for x in [0.0, 0.1, 1.2, -3.0, 1e-7, 1e300, 1.0 / 3.0, f64::INFINITY, 123456789.0, 5e-324] {
            assert_eq!(show(x).parse::<f64>().map(show), Ok(show(x)));
            assert_eq!(show(x).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
        }
        assert_eq!([0.0, 2.0, 1.2, 1e-7].map(show), ["0", "2", "1.2", "1e-7"]);
    }
}
