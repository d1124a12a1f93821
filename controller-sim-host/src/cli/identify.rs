//! `identify`: from a log to areas and a model.

use super::quoting::quoted;
use super::run::OPEN;
use super::{EXIT_REFUSED, Failure, colours, examples, input, print};
use crate::log::{self, Column, Log, Role};
use crate::output::{
    FileTarget, Identification, Problem, Severity, Source, Trouble, Written, identify_json, identify_table,
    is_same_file, render,
};
use crate::report;
use crate::scenario::SourceText;
use clap::{Args, ValueHint};
use controller_design::Refusal;
use controller_design::identification::{IdentifyOptions, Recording, identify};
use std::io::{self, Write};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = examples::IDENTIFY)]
pub(super) struct IdentifyArguments {
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
    /// The rows are this far apart in seconds; the log needs no times then
    #[arg(long, value_name = "S", value_parser = sampling_time, conflicts_with = "time")]
    ts: Option<f64>,
    /// Write a page with the record, the model and the areas to this file, for the browser
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, requires = "report")]
    force: bool,
}

fn sampling_time(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(ts) if ts.is_finite() && ts > 0.0 => Ok(ts),
        _ => Err("write a time in seconds, above 0, for example `0.1`".to_owned()),
    }
}

/// `command` is what was typed.
pub(super) fn run(arguments: &IdentifyArguments, json: bool, command: &str) -> Result<(), Failure> {
    let target = target(arguments)?;
    let (name, text) = input::read_log(&arguments.log)?;
    let source = SourceText { name, text };
    let log = read(arguments, &source)?;
    let [Some(u), Some(y)] = &log.columns[..] else {
        return Err(Problem::new("recording", format!("`{}` lacks a column", source.name)).into());
    };
    let recording = Recording { t: &log.times, u, y };
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
    let Some(path) = &arguments.report else { return Ok(None) };
    if path.as_os_str() == "-" {
        let problem = Problem::new("file", "`--report -` is not possible: the standard output has the table");
        return Err(problem.help("give a file: `--report my.html`"));
    }
    if is_same_file(path, &arguments.log) {
        let message = format!("`{}` is the log itself and is not overwritten", path.display());
        return Err(Problem::new("file", message).help("give the file of `--report` another name"));
    }
    FileTarget::new(path, arguments.force).map(Some)
}

fn read(arguments: &IdentifyArguments, source: &SourceText) -> Result<Log, Failure> {
    let column = |text: &Option<String>| text.as_deref().map_or(Column::Usual, Column::from_text);
    let time = match arguments.ts {
        Some(_) => Role { required: false, usual: &[], ..Role::time(Column::Usual) },
        None => Role::time(column(&arguments.time)),
    };
    let roles = [time, Role::input(column(&arguments.input)), Role::output(column(&arguments.output))];
    let mut log = log::read(&source.name, &source.text, &roles)
        .map_err(|fault| Failure::input(vec![Trouble::Scenario(source.clone(), vec![fault])]))?;
    if let Some(ts) = arguments.ts {
        log.times = (0..log.times.len()).map(|row| row as f64 * ts).collect();
    }
    Ok(log)
}

/// What the log was taken for stands with the reason: a wrong column is the usual one.
fn refused(source: &SourceText, log: &Log, refusal: &Refusal) -> Failure {
    let title = |index: usize| log.titles.get(index).filter(|title| !title.is_empty());
    let named = match (title(1), title(2)) {
        (Some(u), Some(y)) => format!(" (input `{u}`, output `{y}`)"),
        _ => String::new(),
    };
    let problem = Problem::new("refused", format!("{}{named}: {refusal}", source.name)).help(refusal.help());
    Failure { troubles: vec![problem.into()], code: EXIT_REFUSED }
}
