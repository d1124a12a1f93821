//! Rows in files: written as they come, taken up again, joined.
//!
//! A table (CSV) grows row by row under its own name, so that an interrupted study leaves what it has. A Parquet file cannot
//! be read before its end is written: its rows go to a table beside it, `NAME.rows.csv`, from which it is made at the end.

mod columns;
mod merge;
mod table;

pub use merge::merge;

use super::layout::{Cells, Layout};
use super::reader::RowReader;
use crate::output::{FileTarget, Problem, publish};
use columns::ColumnWriter;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use table::push_line;

/// How the rows are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A table.
    Csv,
    /// A Parquet file.
    Parquet,
}

impl Format {
    /// By the ending of the name.
    ///
    /// # Errors
    /// Another ending.
    pub fn of(path: &Path) -> Result<Self, Problem> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_deref().and_then(|ending| ending.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("parquet") => Ok(Self::Parquet),
            _ => {
                let message = format!("`{}` must end with .csv or .parquet", path.display());
                Err(Problem::new("file", message).help("the ending tells how the rows are kept"))
            }
        }
    }
}

/// `csv` or `parquet`, by the ending of a name that was accepted.
#[must_use]
pub fn kind(path: &Path) -> &'static str {
    if Format::of(path) == Ok(Format::Parquet) { "parquet" } else { "csv" }
}

/// A file that takes rows.
#[derive(Debug)]
pub struct RowFile {
    target: FileTarget,
    format: Format,
    journal: PathBuf,
    to: BufWriter<File>,
    line: String,
}

/// What a study begins with.
#[derive(Debug)]
pub struct Begun {
    /// Where the rows go; `None`: they are all there.
    pub file: Option<RowFile>,
    /// Rows that are there already.
    pub kept: usize,
}

/// The table in which the rows of `path` are until it is complete.
fn journal(path: &Path, format: Format) -> PathBuf {
    match format {
        Format::Csv => path.to_owned(),
        Format::Parquet => {
            let mut name = path.as_os_str().to_owned();
            name.push(".rows.csv");
            PathBuf::from(name)
        }
    }
}

/// Begins the file of a study; `force` allows to replace one that exists.
///
/// # Errors
/// A file that exists and may not be replaced; what the system reports.
pub fn create(path: &Path, force: bool, layout: &Layout) -> Result<Begun, Problem> {
    let format = Format::of(path)?;
    let target = FileTarget::new(path, force)?;
    let journal = journal(path, format);
    if journal != path && journal.exists() && !force {
        let message = format!("`{}` has the rows of an interrupted study", journal.display());
        return Err(Problem::new("file-exists", message).help("go on with `--resume`, or add `--force`"));
    }
    let file = File::create(&journal).map_err(|error| target.failed(&error))?;
    let mut to = BufWriter::new(file);
    writeln!(to, "{}", layout.head()).and_then(|()| to.flush()).map_err(|error| target.failed(&error))?;
    Ok(Begun { file: Some(RowFile { target, format, journal, to, line: String::new() }), kept: 0 })
}

/// Takes up the file of the rows in `range` (from 0) of `study` where it was left; begins it when there is none. A last row
/// that was cut off is dropped; `keep` sees the others.
///
/// # Errors
/// A file of another study or shard, or of something else; what the system reports.
pub fn resume(
    path: &Path,
    (study, layout): (&str, &Layout),
    range: &Range<usize>,
    mut keep: impl FnMut(&Cells),
) -> Result<Begun, Problem> {
    let format = Format::of(path)?;
    let target = FileTarget::new(path, true)?;
    let journal = journal(path, format);
    let begun: &Path = if journal.exists() { &journal } else { path };
    if !begun.exists() {
        return create(path, false, layout);
    }
    let wrong = |why: String| {
        let problem = Problem::new("file", format!("cannot go on with `{}`: {why}", begun.display()));
        problem.help("give another file, or `--force` instead of `--resume` to begin anew")
    };
    let mut reader = RowReader::open(begun).map_err(wrong)?;
    let other = "it is of another study: plants, methods, options or the program differ";
    if reader.layout().is_some_and(|found| found != layout) {
        return Err(wrong(other.to_owned()));
    }
    let mut kept = 0;
    while let Some(row) = reader.next_row().map_err(wrong)? {
        if row.study() != study {
            return Err(wrong(other.to_owned()));
        }
        if kept == range.len() || row.number() != range.start + kept + 1 {
            return Err(wrong("it has the rows of another shard".to_owned()));
        }
        keep(&row);
        kept += 1;
    }
    if *begun != *journal {
        // A Parquet file was complete when it got its name.
        return if kept == range.len() {
            Ok(Begun { file: None, kept })
        } else {
            Err(wrong("it has the rows of another shard".to_owned()))
        };
    }
    let failed = |error: std::io::Error| target.failed(&error);
    let mut file = OpenOptions::new().write(true).open(&journal).map_err(failed)?;
    file.set_len(reader.complete()).map_err(failed)?;
    file.seek(SeekFrom::End(0)).map_err(failed)?;
    let mut to = BufWriter::new(file);
    if reader.complete() == 0 {
        writeln!(to, "{}", layout.head()).map_err(failed)?;
    }
    Ok(Begun { file: Some(RowFile { target, format, journal, to, line: String::new() }), kept })
}

impl RowFile {
    /// Where the rows are until the file is complete.
    #[must_use]
    pub fn journal(&self) -> &Path {
        &self.journal
    }

    /// Writes rows; they are in the file when this returns.
    ///
    /// # Errors
    /// What the system reports.
    pub fn write(&mut self, rows: &[impl AsRef<Cells>]) -> Result<(), Problem> {
        self.line.clear();
        rows.iter().for_each(|row| push_line(&mut self.line, row.as_ref()));
        let written = self.to.write_all(self.line.as_bytes()).and_then(|()| self.to.flush());
        written.map_err(|error| self.target.failed(&error))
    }

    /// Ends the file: a Parquet file is made now.
    ///
    /// # Errors
    /// What the system reports.
    pub fn finish(mut self) -> Result<(), Problem> {
        self.to.flush().map_err(|error| self.target.failed(&error))?;
        if self.format == Format::Csv {
            return Ok(());
        }
        let target = self.target.clone();
        let mut reader = RowReader::open(&self.journal).map_err(|why| target.failed(&why))?;
        let failed = |error: parquet::errors::ParquetError| target.failed(&error);
        let layout = reader.layout().cloned().ok_or_else(|| target.failed(&"its rows are gone"))?;
        let mut writer = ColumnWriter::new(target.create()?, &layout).map_err(failed)?;
        while let Some(row) = reader.next_row().map_err(|why| target.failed(&why))? {
            writer.write(&row).map_err(failed)?;
        }
        publish(vec![writer.finish().map_err(failed)?.complete()?])?;
        fs::remove_file(&self.journal).map_err(|error| target.failed(&error))
    }
}
