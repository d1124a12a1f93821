//! `tune`: from a log to a loop.

use super::arguments::Rule;
use super::design::refused;
use super::quoting::quoted;
use super::run::OPEN;
use super::step_log::{StepLog, recording, refused as unusable};
use super::wish::{Wish, positive};
use super::{Failure, colours, examples, print};
use crate::advise::advise;
use crate::analysis::analyse;
use crate::design_run::{run_design, troubles};
use crate::log::Log;
use crate::output::is_same_file;
use crate::output::{
    Analysed, FileTarget, Identification, Problem, Severity, Source, Tuning, advice_json, advice_table,
    publish, render, tune_json, tune_table,
};
use crate::report::{self, Chapter};
use crate::scenario::{Units, read};
use crate::simulate::{COLUMNS, Metrics, Precision, RunOptions, View, run as simulate};
use crate::tuning::{Known, Tuned, plant_of, tune};
use clap::{Args, ValueHint};
use controller_design::Refusal;
use controller_design::identification::{IdentifyOptions, identify};
use std::io::{self, Write};
use std::path::PathBuf;

/// Largest maximum sensitivity with a disturbance block when nothing else is asked for.
const MS_MAX: f64 = 2.0;

#[derive(Debug, Args)]
#[command(after_help = examples::TUNE)]
pub(super) struct TuneArguments {
    #[command(flatten)]
    record: StepLog,
    /// The tuning rule
    #[arg(long, value_parser = Rule::parser(), default_value = "de-momi")]
    method: Rule,
    /// Sampling period of the controller [s]; if not given, the usual distance of the log's rows (`--log-ts`)
    #[arg(long, value_name = "S", value_parser = positive)]
    ts: Option<f64>,
    #[command(flatten)]
    wish: Wish,
    /// Write the design file, which `run` and `analyze` read
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    save: Option<PathBuf>,
    /// Write a page with the record, the model, the simulated loop and its margins to this file, for the browser
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

/// `command` is what was typed.
pub(super) fn run(arguments: &TuneArguments, json: bool, command: &str) -> Result<(), Failure> {
    let Some(method) = arguments.method.0 else { return compare(arguments, json) };
    let mut problems = arguments.wish.idle(method);
    let target = |option: &str, path: &Option<PathBuf>, problems: &mut Vec<Problem>| {
        let checked = path.as_ref().map(|path| arguments.record.target(option, path, arguments.force));
        checked.and_then(|checked| checked.map_err(|problem| problems.push(problem)).ok())
    };
    let save = target("--save", &arguments.save, &mut problems);
    let page = target("--report", &arguments.report, &mut problems);
    if let (Some(one), Some(two)) = (&arguments.save, &arguments.report)
        && is_same_file(one, two)
    {
        let message = format!("`--save` and `--report` are the same file `{}`", two.display());
        problems.push(Problem::new("file", message).help("give one of them another name"));
    }
    if !problems.is_empty() {
        return Err(Failure::input(problems.into_iter().map(Into::into).collect()));
    }
    let (source, log) = arguments.record.read(None)?;
    let recording = recording(&source, &log)?;
    let ts = arguments.ts.unwrap_or_else(|| usual_distance(recording.t));
    let units = Units { y: unit(&log, 2), u: unit(&log, 1) };
    let known = Known {
        limits: arguments.wish.limits,
        units,
        name: file_name(&source.name),
        controller: arguments.wish.name.clone(),
        command: command.to_owned(),
    };
    let request = arguments.wish.request(method, ts, Some(MS_MAX).filter(|_| method.has_block()));
    let tuned = tune(&recording, &request, &known).map_err(|refusal| match refusal {
        Refusal::Data { .. } => unusable(&source, &log, &refusal),
        _ => refused(method, &refusal),
    })?;
    let finding = Identification { source: Source::from(&source), log: &log, recording, found: &tuned.found };
    let path =
        |target: &Option<FileTarget>| target.as_ref().map(|target| target.path().display().to_string());
    let (saved, drawn) = (path(&save), path(&page));
    let simulated = Simulated::new(&tuned, saved.as_deref().unwrap_or("loop.toml"))?;
    let mut warnings = tuned.warnings.clone();
    warnings.extend(troubles(&simulated.result.controllers[0], &tuned.file));
    let has_iae = tuned.made.predicted.iae_load.is_some();
    let unit_steps = has_iae.then(|| run_design(&tuned.made, f64::INFINITY)).flatten();
    let tuning = Tuning {
        finding,
        made: &tuned.made,
        warnings: &warnings,
        iae_load: unit_steps.map(|run| run.iae_load),
        events: simulated.events,
        worst_residual: tuned.worst_residual(&recording),
        order: tuned.found.fit.filter(|_| tuned.on_fit).map_or(2, |fit| fit.order),
        range: simulated.range,
    };
    let mut files = Vec::new();
    if let Some(target) = &save {
        files.push(filled(target, &simulated.text)?);
    }
    if let Some(target) = &page {
        files.push(filled(target, &simulated.page(&tuning, command))?);
    }
    publish(files).map_err(Failure::internal)?;
    if json {
        return Ok(print(&tune_json(&tuning, saved.as_deref(), drawn.as_deref()))?);
    }
    let remarks = render(finding.source, &log.remarks, Severity::Warning, colours());
    io::stderr().write_all(remarks.as_bytes())?;
    print(&tune_table(&tuning))?;
    if let Some(path) = saved {
        let path = quoted(&path);
        print(&format!("\nwrote {path}; run it with: controller-sim run {path}\n"))?;
    }
    if let Some(path) = drawn {
        print(&format!("\nwrote {path}: open it by: {OPEN} {}\n", quoted(&path)))?;
    }
    Ok(())
}

/// All rules on the process of the log.
fn compare(arguments: &TuneArguments, json: bool) -> Result<(), Failure> {
    if arguments.save.is_some() || arguments.report.is_some() {
        let problem =
            Problem::new("usage", "`--save` and `--report` need one method; `advise` compares all of them");
        return Err(problem.help("choose one of them, then tune by it").into());
    }
    let (source, log) = arguments.record.read(None)?;
    let recording = recording(&source, &log)?;
    let ts = arguments.ts.unwrap_or_else(|| usual_distance(recording.t));
    let found = identify(&recording, &IdentifyOptions::default());
    let plant = found
        .and_then(|found| plant_of(&recording, &found, ts))
        .map_err(|refusal| unusable(&source, &log, &refusal))?;
    let mut advice = advise(&plant, ts, |method| {
        arguments.wish.compared(method, ts, Some(MS_MAX).filter(|_| method.has_block()))
    });
    advice.options = arguments.wish.given();
    Ok(print(&if json { advice_json(&advice) } else { advice_table(&advice) })?)
}

/// The unit of a column: below its name, or in brackets behind it.
fn unit(log: &Log, index: usize) -> String {
    let of = |list: &[String]| list.get(index).cloned().unwrap_or_default();
    let (unit, title) = (of(&log.units), of(&log.titles));
    let in_brackets =
        title.rsplit_once(['[', '(']).and_then(|(_, rest)| rest.trim_end().strip_suffix([']', ')']));
    let unit = if unit.is_empty() { in_brackets.unwrap_or("").trim().to_owned() } else { unit };
    unit.chars().filter(|c| !c.is_control()).take(20).collect()
}

fn filled(target: &FileTarget, text: &str) -> Result<crate::output::Complete, Failure> {
    let mut draft = target.create().map_err(Failure::internal)?;
    draft.write_all(text.as_bytes()).map_err(|error| Failure::internal(target.failed(&error)))?;
    draft.complete().map_err(Failure::internal)
}

/// The loop of the design file, run.
struct Simulated {
    name: String,
    text: String,
    scenario: crate::scenario::Scenario,
    result: crate::simulate::RunResult,
    events: [Metrics; 2],
    range: (f64, f64),
}

impl Simulated {
    fn new(tuned: &Tuned, name: &str) -> Result<Self, Failure> {
        let text = tuned.file.text();
        let failed =
            |why: String| Failure::refused(Problem::new("refused", format!("the loop cannot be run: {why}")));
        let scenario = read(&text, Precision::F64)
            .map_err(|faults| failed(faults.first().map_or(String::new(), |fault| fault.message.clone())))?
            .scenario;
        let record = Some(View { columns: COLUMNS, ..View::whole(scenario.duration) });
        let options = RunOptions { record, ..RunOptions::default() };
        let result = simulate(&scenario, options).map_err(|error| failed(error.to_string()))?;
        let events = match result.controllers.first().map(|controller| &controller.events[..]) {
            Some([setpoint, load]) => [setpoint.metrics, load.metrics],
            _ => return Err(failed("it has no two events".to_owned())),
        };
        let range = result.controllers.first().and_then(|controller| controller.record.as_ref());
        let range = range.and_then(|record| record.u.range()).unwrap_or((f64::NAN, f64::NAN));
        Ok(Self { name: name.to_owned(), text, scenario, result, events, range })
    }

    fn page(&self, tuning: &Tuning<'_>, command: &str) -> String {
        let chapter = Chapter {
            name: &self.name,
            case: None,
            text: &self.text,
            scenario: &self.scenario,
            precision: Precision::F64,
            result: &self.result,
            warnings: &[],
        };
        let loop_ =
            analyse(&self.scenario, 0).map_err(|why| (self.scenario.controllers[0].name.clone(), why));
        let analysed = Analysed {
            name: &self.name,
            case: None,
            text: &self.text,
            scenario: &self.scenario,
            warnings: &[],
            controllers: vec![loop_],
            cards: Vec::new(),
            checked: None,
        };
        report::tuning(tuning, &chapter, &analysed, command)
    }
}

/// The log's name without its folders, for a title.
fn file_name(path: &str) -> String {
    let name = std::path::Path::new(path).file_name().map_or(path.into(), |name| name.to_string_lossy());
    name.chars().filter(|c| !c.is_control()).take(60).collect()
}

/// The median distance of two rows with different times.
fn usual_distance(times: &[f64]) -> f64 {
    let mut distances: Vec<f64> =
        times.windows(2).map(|pair| pair[1] - pair[0]).filter(|distance| *distance > 0.0).collect();
    distances.sort_by(f64::total_cmp);
    let median = distances.get(distances.len() / 2).copied().unwrap_or(1.0);
    // Stamps are rounded; nobody means 0.9999999 s.
    format!("{median:.3e}").parse().unwrap_or(median)
}
