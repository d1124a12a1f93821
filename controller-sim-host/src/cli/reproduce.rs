//! `reproduce`: the tables of the papers, computed again.

use super::{Failure, examples, interrupt, print, progress};
use crate::output::{Problem, reproduced_json, reproduced_table};
use crate::reproduce::{Paper, Report, ReproduceError, Selection, count, names, reproduce_with};
use clap::{Args, ValueEnum};
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Args)]
#[command(after_help = examples::REPRODUCE)]
pub(super) struct ReproduceArguments {
    /// The tables of one paper
    #[arg(long, value_enum)]
    paper: Option<PaperName>,
    /// One table: its number in the paper, or its name
    #[arg(long, value_name = "NAME")]
    table: Option<String>,
    /// No progress
    #[arg(long, short)]
    quiet: bool,
}

/// A paper by its short name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PaperName {
    /// Vrančić & Huba 2021: MOMI, DRMO, disturbance estimator
    De,
    /// Tena et al. 2022: PI with disturbance observer
    Dob,
    /// Airikka 2021: PI for load disturbances
    Pi,
}

impl From<PaperName> for Paper {
    fn from(name: PaperName) -> Self {
        match name {
            PaperName::De => Self::De,
            PaperName::Dob => Self::Dob,
            PaperName::Pi => Self::Pi,
        }
    }
}

/// `reproduce`.
pub(super) fn run(arguments: &ReproduceArguments, json: bool) -> Result<(), Failure> {
    let selection = Selection { paper: arguments.paper.map(Paper::from), table: arguments.table.clone() };
    let (control, done) = (interrupt::control(), AtomicU64::new(0));
    let total = u64::try_from(count(&selection)).unwrap_or(u64::MAX);
    let counted = || done.load(Ordering::Relaxed);
    let report = progress::watch_count("tables", counted, total, arguments.quiet, || {
        reproduce_with(&selection, control, &done)
    });
    let report = report.map_err(|error| match error {
        ReproduceError::NoTable => unknown(&selection).into(),
        ReproduceError::Stopped => Failure::stopped(),
    })?;
    print(&if json { reproduced_json(&report) } else { reproduced_table(&report) })?;
    outcome(&report)
}

/// What differs was printed; only the exit code is left to tell it.
fn outcome(report: &Report) -> Result<(), Failure> {
    if report.differing() > 0 { Err(Failure::differs()) } else { Ok(()) }
}

fn unknown(selection: &Selection) -> Problem {
    let name = selection.table.as_deref().unwrap_or_default();
    let of = selection.paper.map_or(String::new(), |paper| format!(" of {}", paper.source()));
    let mut known: Vec<&str> = Vec::new();
    for (paper, name) in names() {
        if selection.paper.is_none_or(|wanted| wanted == paper) && !known.contains(&name) {
            known.push(name);
        }
    }
    Problem::new("unknown-name", format!("there is no table `{name}`{of}"))
        .help(format!("there are {}", known.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::reproduce;
    use crate::simulate::Control;

    #[test]
    fn a_number_that_is_not_true_ends_with_code_1() {
        let selection = Selection { paper: Some(Paper::De), table: Some("7".to_owned()) };
        let mut report = reproduce(&selection, &Control::new()).expect("not stopped");
        assert!(outcome(&report).is_ok());
        report.tables[0].cells[1].truth = Some(101.0);
        let failure = outcome(&report).expect_err("a difference");
        assert_eq!((failure.code, failure.troubles.len()), (1, 0));
    }
}
