//! The log of a change between two steady states: what `identify` and `tune` read.

use super::wish::positive;
use super::{EXIT_REFUSED, Failure, input};
use crate::log::{self, Column, Log, Role};
use crate::output::{FileTarget, Problem, Trouble, is_same_file};
use crate::scenario::SourceText;
use clap::{Args, ValueHint};
use controller_design::Refusal;
use controller_design::identification::Recording;
use std::path::{Path, PathBuf};

/// Which file, and which columns of it.
#[derive(Debug, Args)]
pub(super) struct StepLog {
    /// The log, a CSV file; `-` reads the standard input
    #[arg(value_name = "DATA", value_hint = ValueHint::FilePath)]
    log: PathBuf,
    /// Column of the times, by its name or its number from 1
    #[arg(long, value_name = "COL")]
    time: Option<String>,
    /// Column of the process input: what the controller or a person sets
    #[arg(long, value_name = "COL")]
    input: Option<String>,
    /// Column of the process output: what is measured
    #[arg(long, value_name = "COL")]
    output: Option<String>,
    /// The rows are this far apart [s]: for a log without times
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "time")]
    log_ts: Option<f64>,
}

impl StepLog {
    /// The file's text and what it says; with `--log-ts` or `rows` they are so far apart [s] and have no times.
    pub(super) fn read(&self, rows: Option<f64>) -> Result<(SourceText, Log), Failure> {
        let (name, text) = input::read_log(&self.log)?;
        let source = SourceText { name, text };
        let rows = self.log_ts.or(rows);
        let column = |text: &Option<String>| text.as_deref().map_or(Column::Usual, Column::from_text);
        let time = match rows {
            Some(_) => Role { required: false, usual: &[], ..Role::time(Column::Usual) },
            None => Role::time(column(&self.time)),
        };
        let roles = [time, Role::input(column(&self.input)), Role::output(column(&self.output))];
        let mut log = log::read(&source.name, &source.text, &roles)
            .map_err(|fault| Failure::input(vec![Trouble::Scenario(source.clone(), vec![fault])]))?;
        if let Some(ts) = rows {
            log.times = (0..log.times.len()).map(|row| row as f64 * ts).collect();
        }
        Ok((source, log))
    }

    /// A file that is written, which must not be the log itself.
    pub(super) fn target(&self, option: &str, path: &Path, force: bool) -> Result<FileTarget, Problem> {
        if path.as_os_str() == "-" {
            let message = format!("`{option} -` is not possible: the standard output has the table");
            let ending = if option == "--save" { "toml" } else { "html" };
            return Err(Problem::new("file", message).help(format!("give a file: `{option} my.{ending}`")));
        }
        if is_same_file(path, &self.log) {
            let message = format!("`{}` is the log itself and is not overwritten", path.display());
            return Err(
                Problem::new("file", message).help(format!("give the file of `{option}` another name"))
            );
        }
        FileTarget::new(path, force)
    }
}

/// The two columns as a recording.
pub(super) fn recording<'a>(source: &SourceText, log: &'a Log) -> Result<Recording<'a>, Failure> {
    match &log.columns[..] {
        [Some(u), Some(y)] => Ok(Recording { t: &log.times, u, y }),
        _ => Err(Problem::new("recording", format!("`{}` lacks a column", source.name)).into()),
    }
}

/// What the log was taken for stands with the reason: a wrong column is the usual one.
pub(super) fn refused(source: &SourceText, log: &Log, refusal: &Refusal) -> Failure {
    let title = |index: usize| log.titles.get(index).filter(|title| !title.is_empty());
    let named = match (title(1), title(2)) {
        (Some(u), Some(y)) => format!(" (input `{u}`, output `{y}`)"),
        _ => String::new(),
    };
    let problem = Problem::new("refused", format!("{}{named}: {refusal}", source.name)).help(refusal.help());
    Failure { troubles: vec![problem.into()], code: EXIT_REFUSED }
}
