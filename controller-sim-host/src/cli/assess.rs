//! `assess`: is the loop tuned for loads? From a record of the load-response experiment.

use super::quoting::quoted;
use super::record::{Columns, Recorded};
use super::{EXIT_REFUSED, Failure, colours, examples, print};
use crate::output::{
    FileTarget, Problem, Severity, Written, assessment_json, assessment_table, is_same_file, publish, render,
};
use crate::report::{self, Signals, assessment_page};
use clap::{Args, ValueHint};
use controller_design::assessment::{AssessOptions, Assessment, Experiment, Verdict, assess};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(after_help = examples::ASSESS)]
pub(super) struct AssessArguments {
    /// The record, a CSV file: of a logger, or of `run --csv`
    #[arg(value_name = "DATA.csv", value_hint = ValueHint::FilePath)]
    pub(super) data: PathBuf,
    #[command(flatten)]
    pub(super) columns: Columns,
    /// The output was stepped by hand at this time of the record [s]; else the largest jump of the output
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = time)]
    pub(super) step_at: Option<f64>,
    /// Back in automatic at this time of the record [s]; else when the output moves again
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = time)]
    pub(super) auto_at: Option<f64>,
    /// Write a page with the picture of the response to this file, for the browser
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) report: Option<PathBuf>,
    /// Replace the report if it exists
    #[arg(long, requires = "report")]
    pub(super) force: bool,
}

fn time(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(t) if t.is_finite() => Ok(t),
        _ => Err("write a time of the record in seconds, for example `12.5`".to_owned()),
    }
}

/// `assess`: `command` is what was typed. A record that does not tell ends with the exit code of a refusal, after all that
/// can be said of it.
pub(super) fn run(arguments: &AssessArguments, json: bool, command: &str) -> Result<(), Failure> {
    let target = arguments.report.as_deref().map(|path| target(path, arguments)).transpose()?;
    let recorded = Recorded::read(&arguments.data, &arguments.columns)?;
    let options = AssessOptions::default();
    let assessment = assessed(&recorded, arguments, &options)?;
    let name = recorded.name();
    let experiment = report::Experiment {
        name: &name,
        signals: Signals {
            t: &recorded.t,
            setpoint: &recorded.setpoint,
            output: &recorded.output,
            input: &recorded.input,
            names: (&recorded.names.0, &recorded.names.1),
        },
        assessment: &assessment,
        acceptance: options.acceptance,
    };
    let mut written = Vec::new();
    if let Some(target) = target {
        let mut draft = target.create().map_err(Failure::internal)?;
        let page = assessment_page(&experiment, command);
        draft.write_all(page.as_bytes()).map_err(|error| Failure::internal(target.failed(&error)))?;
        publish(vec![draft.complete().map_err(Failure::internal)?]).map_err(Failure::internal)?;
        written.push(Written { kind: "report", path: target.path().display().to_string(), run: None });
    }
    let refused = assessment.reasons.first().filter(|_| assessment.verdict == Verdict::Inconclusive);
    if json {
        print(&assessment_json(&experiment, &recorded.remarks, &recorded.source, &written))?;
        // The object has said it.
        return refused.map_or(Ok(()), |_| Err(Failure { troubles: Vec::new(), code: EXIT_REFUSED }));
    }
    let remarks = render((&recorded.source).into(), &recorded.remarks, Severity::Warning, colours());
    io::stderr().write_all(remarks.as_bytes())?;
    for warning in &assessment.warnings {
        writeln!(io::stderr(), "warning: {warning}")?;
    }
    print(&assessment_table(&experiment))?;
    for file in &written {
        print(&format!("\nwrote {}: open it by: {} {}\n", file.path, super::run::OPEN, quoted(&file.path)))?;
    }
    match refused {
        Some(reason) => {
            Err(Failure::refused(Problem::new("inconclusive", reason.to_string()).help(reason.help())))
        }
        None => Ok(()),
    }
}

fn target(path: &Path, arguments: &AssessArguments) -> Result<FileTarget, Problem> {
    if path.as_os_str() == "-" {
        let message = "`--report -` is not possible: the standard output has the verdict";
        return Err(Problem::new("file", message).help("give a file: `--report my.html`"));
    }
    if is_same_file(path, &arguments.data) {
        let message = format!("`{}` is the record itself and is not overwritten", path.display());
        return Err(Problem::new("file", message).help("give the file of `--report` another name"));
    }
    FileTarget::new(path, arguments.force)
}

/// The assessment, with the modes of the record when it has them.
fn assessed(
    recorded: &Recorded,
    arguments: &AssessArguments,
    options: &AssessOptions,
) -> Result<Assessment, Failure> {
    let plain = Experiment::new(&recorded.t, &recorded.setpoint, &recorded.output, &recorded.input);
    let sample = |option, at: Option<f64>| at.map(|t| recorded.sample(option, t)).transpose();
    let said = Experiment {
        step_at: sample("--step-at", arguments.step_at)?,
        auto_at: sample("--auto-at", arguments.auto_at)?,
        ..plain
    };
    let refused = |refusal: controller_design::Refusal| {
        let problem = Problem::new("refused", format!("{}: {refusal}", recorded.name()));
        Failure::refused(problem.help(refusal.help()))
    };
    let found = assess(&said, options).map_err(refused)?;
    let step = found.marks.as_ref().map(|marks| marks.step);
    match step.and_then(|step| recorded.back_in_auto(step)).filter(|_| said.auto_at.is_none()) {
        Some(auto) => assess(&Experiment { auto_at: Some(auto), ..said }, options).map_err(refused),
        None => Ok(found),
    }
}
