//! Every table of the three papers, computed again by this library: printed, true, ours, verdict, reason.
//!
//! What is *printed* is what the paper says, digit for digit. What is *true* was computed independently of this
//! library, from the equations with their misprints corrected; the verdict is about the paper and comes with its
//! reason. *Ours* is what the tuning rules, the responses and the simulator of this library give now. Ours may differ
//! from true by the tolerance of the cell and no more; that it differs from what is printed is no fault of it.
//!
//! ```
//! use controller_sim_host::reproduce::{Paper, Selection, reproduce};
//! use controller_sim_host::simulate::Control;
//!
//! let selection = Selection { paper: Some(Paper::De), table: Some("1".to_owned()) };
//! let report = reproduce(&selection, &Control::new()).expect("not stopped");
//! assert_eq!((report.tables.len(), report.differing()), (1, 0));
//! assert_eq!(report.tables[0].cells[2].printed.as_deref(), Some("4.13"));
//! ```

mod bench;
mod cell;
mod data;
mod de;
mod dob;
mod figures;
mod pi;
mod values;

pub use cell::{Cell, Tolerance, Verdict};
pub use figures::{DrawError, Figure, Way, draw, figure_named, figures};

use crate::simulate::Control;
use bench::{Bench, Stop};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use values::Values;

/// One of the papers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// Vrančić & Huba 2021: MOMI, DRMO and the disturbance estimator.
    De,
    /// Tena et al. 2022: PI with disturbance observer.
    Dob,
    /// Airikka 2021: PI for load disturbances.
    Pi,
}

impl Paper {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::De, Self::Dob, Self::Pi];

    /// Its short name: `de`, `dob` or `pi`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::De => "de",
            Self::Dob => "dob",
            Self::Pi => "pi",
        }
    }

    /// Its authors and year.
    #[must_use]
    pub const fn source(self) -> &'static str {
        match self {
            Self::De => "Vrančić & Huba 2021",
            Self::Dob => "Tena et al. 2022",
            Self::Pi => "Airikka 2021",
        }
    }
}

/// Which tables to compute; the default is all of them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selection {
    /// Those of one paper.
    pub paper: Option<Paper>,
    /// Those with this name, such as `5` or `ratios`.
    pub table: Option<String>,
}

/// A table of a paper with everything that is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The paper.
    pub paper: Paper,
    /// Its number in the paper, or what else it is called here.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// Its cells, row by row.
    pub cells: Vec<Cell>,
    /// Why some of its cells have no value of ours.
    pub trouble: Option<String>,
}

/// Tables that were computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// In the order of the papers.
    pub tables: Vec<Table>,
}

impl Report {
    /// Every cell of every table.
    pub fn cells(&self) -> impl Iterator<Item = &Cell> {
        self.tables.iter().flat_map(|table| &table.cells)
    }

    /// The number of cells in which ours differs from true by more than the tolerance.
    #[must_use]
    pub fn differing(&self) -> usize {
        self.cells().filter(|cell| cell.differs()).count()
    }

    /// The number of cells with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.cells().filter(|cell| cell.verdict == verdict).count()
    }
}

/// Why nothing was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReproduceError {
    /// There is no such table.
    NoTable,
    /// It was stopped from outside.
    Stopped,
}

impl std::fmt::Display for ReproduceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoTable => "there is no such table",
            Self::Stopped => "stopped",
        })
    }
}

impl std::error::Error for ReproduceError {}

/// A table before it is computed.
struct Definition {
    paper: Paper,
    name: &'static str,
    title: &'static str,
    /// Its cells as `data` reads them.
    cells: &'static str,
    /// Computes all of ours.
    compute: fn(&Bench<'_>, &mut Values) -> Result<(), Stop>,
}

impl Definition {
    fn is_in(&self, selection: &Selection) -> bool {
        selection.paper.is_none_or(|paper| paper == self.paper)
            && selection.table.as_deref().is_none_or(|name| name.eq_ignore_ascii_case(self.name))
    }

    /// The table, and numbers that have no place in it.
    fn computed(&self, bench: &Bench<'_>) -> Result<(Table, Values), ReproduceError> {
        let mut values = Values::default();
        let trouble = match (self.compute)(bench, &mut values) {
            Ok(()) => None,
            Err(Stop::Stopped) => return Err(ReproduceError::Stopped),
            Err(Stop::Failed(why)) => Some(why),
        };
        let mut cells = data::cells(self.cells);
        for cell in &mut cells {
            cell.ours = values.take(&cell.row, &cell.quantity);
        }
        let Self { paper, name, title, .. } = *self;
        Ok((Table { paper, name, title, cells, trouble }, values))
    }
}

fn definitions() -> impl Iterator<Item = &'static Definition> {
    de::TABLES.iter().chain(&dob::TABLES).chain(&pi::TABLES)
}

/// The names of all tables, with their papers.
pub fn names() -> impl Iterator<Item = (Paper, &'static str)> {
    definitions().map(|one| (one.paper, one.name))
}

/// The number of tables in a selection: how far [`reproduce_with`] counts.
#[must_use]
pub fn count(selection: &Selection) -> usize {
    definitions().filter(|one| one.is_in(selection)).count()
}

/// Computes the tables of `selection` again. The result does not depend on how many threads there are.
///
/// # Errors
/// [`ReproduceError`]. A rule that has no result is no error of this function: its cells have no value of ours, and the
/// table says why.
pub fn reproduce(selection: &Selection, control: &Control) -> Result<Report, ReproduceError> {
    reproduce_with(selection, control, &AtomicU64::new(0))
}

/// [`reproduce`] that counts the tables that are done.
///
/// # Errors
/// As [`reproduce`].
pub fn reproduce_with(
    selection: &Selection,
    control: &Control,
    done: &AtomicU64,
) -> Result<Report, ReproduceError> {
    let chosen: Vec<&Definition> = definitions().filter(|one| one.is_in(selection)).collect();
    if chosen.is_empty() {
        return Err(ReproduceError::NoTable);
    }
    let bench = Bench::new(control);
    let table = |one: &&Definition| {
        let computed = one.computed(&bench);
        done.fetch_add(1, Ordering::Relaxed);
        computed.map(|(table, _)| table)
    };
    Ok(Report { tables: chosen.par_iter().map(table).collect::<Result<_, _>>()? })
}

#[cfg(test)]
mod tests;
