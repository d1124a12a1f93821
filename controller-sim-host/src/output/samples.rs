//! The files that take every sample while the run goes on.

use super::csv::CsvWriter;
use super::draft::{Complete, Draft};
use super::file::{FileError, FileTarget};
use super::parquet::ParquetWriter;
use crate::simulate::{Sample, Sink};
use std::ops::ControlFlow;

/// Signals of a sample, in the order of the columns.
pub(super) const NUMBERS: [&str; 8] = ["t", "r", "y", "u", "applied", "u_f", "d_hat", "d"];
/// Signals of the loop inside of a cascade.
pub(super) const INNER: [&str; 2] = ["inner_r", "inner_y"];

/// The signals of a sample, and those of the loop inside when it has one.
pub(super) fn numbers(s: &Sample) -> ([f64; NUMBERS.len()], Option<[f64; INNER.len()]>) {
    ([s.t, s.r, s.y, s.u, s.applied, s.u_f, s.d_hat, s.d], s.inner.map(|inner| [inner.r, inner.y]))
}

/// Which columns a file has besides those that every file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Columns {
    /// `scenario` and `case`: for several chapters.
    pub chapters: bool,
    /// `inner_r` and `inner_y`: for cascades.
    pub inner: bool,
}

impl Columns {
    /// The names of all columns, in order.
    pub(super) fn names(self) -> impl Iterator<Item = &'static str> {
        let chapters = if self.chapters { &["scenario", "case"][..] } else { &[] };
        let inner = if self.inner { &INNER[..] } else { &[] };
        let list = [chapters, &["controller"], &NUMBERS, inner, &["mode", "status"]];
        list.into_iter().flatten().copied()
    }
}

/// A CSV file, a Parquet file, or both: every sample goes into each. Needs no memory that grows with the run.
#[derive(Debug)]
pub struct SampleFiles<'a> {
    csv: Option<(CsvWriter<Draft>, &'a FileTarget)>,
    parquet: Option<(ParquetWriter<Draft>, &'a FileTarget)>,
    failed: Option<FileError>,
    samples: u64,
}

impl<'a> SampleFiles<'a> {
    /// Begins the files that are given.
    ///
    /// # Errors
    /// A file that cannot be begun.
    pub fn create(
        csv: Option<&'a FileTarget>,
        parquet: Option<&'a FileTarget>,
        columns: Columns,
    ) -> Result<Self, FileError> {
        let csv = match csv {
            Some(target) => {
                let writer = CsvWriter::new(target.create()?, columns).map_err(|e| target.failed(&e))?;
                Some((writer, target))
            }
            None => None,
        };
        let parquet = match parquet {
            Some(target) => {
                let writer = ParquetWriter::new(target.create()?, columns).map_err(|e| target.failed(&e))?;
                Some((writer, target))
            }
            None => None,
        };
        Ok(Self { csv, parquet, failed: None, samples: 0 })
    }

    /// The samples of this scenario and case follow.
    pub fn chapter(&mut self, scenario: &str, case: Option<&str>) {
        if let Some((csv, _)) = &mut self.csv {
            csv.chapter(scenario, case);
        }
        if let Some((parquet, _)) = &mut self.parquet {
            parquet.chapter(scenario, case);
        }
    }

    /// Why the samples could not be written, when that has ended a run.
    #[must_use]
    pub fn failure(&self) -> Option<&FileError> {
        self.failed.as_ref()
    }

    /// Samples written so far.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Brings everything to the disc.
    ///
    /// # Errors
    /// What the system reports.
    pub fn complete(self) -> Result<Vec<Complete>, FileError> {
        let mut files = Vec::new();
        if let Some((csv, _)) = self.csv {
            files.push(csv.into_inner().complete()?);
        }
        if let Some((parquet, target)) = self.parquet {
            files.push(parquet.finish().map_err(|error| target.failed(&error))?.complete()?);
        }
        Ok(files)
    }

    fn write(&mut self, sample: &Sample) -> Result<(), FileError> {
        if let Some((csv, target)) = &mut self.csv {
            csv.sample(sample).map_err(|error| target.failed(&error))?;
        }
        if let Some((parquet, target)) = &mut self.parquet {
            parquet.sample(sample).map_err(|error| target.failed(&error))?;
        }
        Ok(())
    }
}

impl Sink for SampleFiles<'_> {
    fn begin(&mut self, _: usize, name: &str) -> ControlFlow<()> {
        if let Some((csv, _)) = &mut self.csv {
            csv.controller(name);
        }
        if let Some((parquet, _)) = &mut self.parquet {
            parquet.controller(name);
        }
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample) -> ControlFlow<()> {
        match self.write(sample) {
            Ok(()) => {
                self.samples += 1;
                ControlFlow::Continue(())
            }
            Err(failure) => {
                self.failed = Some(failure);
                ControlFlow::Break(())
            }
        }
    }
}
