//! `identify`: from a log to areas and a model.

use super::quoting::quoted;
use super::run::OPEN;
use super::step_log::{StepLog, recording, refused};
use super::wish::positive;
use super::{Failure, colours, examples, print};
use crate::output::{
    FileTarget, Identification, Problem, Severity, Source, Written, identify_json, identify_table, render,
};
use crate::report;
use clap::{Args, ValueHint};
use controller_design::identification::{IdentifyOptions, identify};
use std::io::{self, Write};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = examples::IDENTIFY)]
pub(super) struct IdentifyArguments {
    #[command(flatten)]
    record: StepLog,
    /// The same as `--log-ts`
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with_all = ["time", "log_ts"])]
    ts: Option<f64>,
    /// Write a page with the record, the model and the areas to this file, for the browser
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, requires = "report")]
    force: bool,
}

/// `command` is what was typed.
pub(super) fn run(arguments: &IdentifyArguments, json: bool, command: &str) -> Result<(), Failure> {
    let target = target(arguments)?;
    let (source, log) = arguments.record.read(arguments.ts)?;
    let recording = recording(&source, &log)?;
    let found = identify(&recording, &IdentifyOptions::default())
        .map_err(|refusal| refused(&source, &log, &refusal))?;
    let finding = Identification { source: Source::from(&source), log: &log, recording, found: &found };
    let mut written = Vec::new();
    if let Some(target) = &target {
        let page = report::identification(&finding, command);
        target.write(|to| to.write_all(page.as_bytes())).map_err(Failure::internal)?;
        written.push(Written { kind: "report", path: target.path().display().to_string(), run: None });
    }
    if json {
        return Ok(print(&identify_json(&finding, &written))?);
    }
    let remarks = render(finding.source, &log.remarks, Severity::Warning, colours());
    io::stderr().write_all(remarks.as_bytes())?;
    print(&identify_table(&finding))?;
    for file in &written {
        print(&format!("\nwrote {}: open it by: {OPEN} {}\n", file.path, quoted(&file.path)))?;
    }
    Ok(())
}

fn target(arguments: &IdentifyArguments) -> Result<Option<FileTarget>, Problem> {
    let path = arguments.report.as_ref();
    path.map(|path| arguments.record.target("--report", path, arguments.force)).transpose()
}
