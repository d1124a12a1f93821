//! Reading, running, writing: what `run` and `demo` have in common.

use super::arguments::{Options, RunArguments};
use super::execute::{Job, Outcome, execute};
use super::outputs::Targets;
use super::scenarios::{Inputs, read_files};
use super::{Failure, colours, interrupt, print};
use crate::output::{Complete, FileTarget, Problem, Severity, Trouble, publish, render, run_json, run_table};
use crate::pil::{Compared, Missing, Target, find_image};
use crate::report::{self, Chapter};
use crate::simulate::RunResult;
use controller_pil::board;
use std::io::{self, Write};
use std::path::Path;
use std::sync::OnceLock;

/// `run`: `command` is what was typed.
pub(super) fn run(arguments: &RunArguments, json: bool, command: &str) -> Result<(), Failure> {
    let inputs = read_files(&arguments.scenarios, &arguments.options);
    let pil = match &arguments.pil {
        // What is wrong with the scenarios is told first, without building anything.
        Some(board) if inputs.troubles.is_empty() => Some(target(board, arguments.pil_image.as_deref())?),
        _ => None,
    };
    run_inputs(&inputs, &arguments.options, pil, json, command)
}

/// The board that the controllers run on, too. There is one in the life of the program.
fn target(board: &str, image: Option<&Path>) -> Result<&'static Target, Failure> {
    static TARGET: OnceLock<Target> = OnceLock::new();
    let unknown = || Problem::new("usage", format!("no board `{board}`"));
    let board = board::named(board).ok_or_else(unknown)?;
    let found = find_image(board, image).map_err(|Missing { message, help }| {
        let problem = Problem::new("pil", message);
        help.map_or(problem.clone(), |help| problem.help(help))
    })?;
    Ok(TARGET.get_or_init(|| found))
}

/// Runs what was read. Nothing is run and no file is touched when anything is wrong.
pub(super) fn run_inputs(
    inputs: &Inputs,
    options: &Options,
    pil: Option<&'static Target>,
    json: bool,
    command: &str,
) -> Result<(), Failure> {
    let jobs = Job::all(&inputs.list, pil);
    let mut troubles = inputs.troubles.clone();
    // Without the scenarios it is not known how many files there will be; the other mistakes are told at once.
    let runs = if troubles.is_empty() { jobs.len() } else { 1 };
    troubles.extend(jobs.iter().filter_map(|job| job.check_view(options).err()).map(Trouble::from));
    let targets = Targets::new(options, inputs, runs).unwrap_or_else(|problems| {
        troubles.extend(problems.into_iter().map(Trouble::from));
        Targets::default()
    });
    if !troubles.is_empty() {
        return Err(Failure::input(troubles));
    }
    let control = interrupt::control();
    let outcome = execute(&jobs, options, &targets, control)?;
    let chapters: Vec<Chapter<'_>> =
        jobs.iter().zip(&outcome.results).map(|(job, result)| chapter(job, options, result)).collect();
    let drawn = draw(&chapters, &targets, command)?;
    let Outcome { mut files, samples, .. } = outcome;
    files.extend(drawn);
    if control.is_stopped() {
        return Err(Failure::stopped());
    }
    publish(files).map_err(Failure::internal)?;
    let written = targets.written();
    let same = outcome_is_same(&chapters);
    if json {
        print(&run_json(&chapters, &written))?;
        return same;
    }
    for input in &inputs.list {
        let warnings = render(input.source(), &input.warnings, Severity::Warning, colours());
        io::stderr().write_all(warnings.as_bytes())?;
    }
    print(&tables(&chapters))?;
    if !options.quiet && !written.is_empty() {
        print("\n")?;
        for file in &written {
            let more = match file.kind {
                "csv" | "parquet" => format!("{samples} samples"),
                _ => format!("open it by: {} {}", OPEN, super::quoting::quoted(&file.path)),
            };
            print(&format!("wrote {}: {more}\n", file.path))?;
        }
    }
    same
}

/// A failure when an output was not the same on the board; the tables say which.
fn outcome_is_same(chapters: &[Chapter<'_>]) -> Result<(), Failure> {
    let mut boards = chapters.iter().filter_map(|chapter| Compared::all(chapter.result));
    if boards.any(|(all, _)| all.first.is_some()) { Err(Failure::differs()) } else { Ok(()) }
}

/// What opens a file with the program made for it.
pub(super) const OPEN: &str = if cfg!(target_os = "macos") {
    "open"
} else if cfg!(windows) {
    "start"
} else {
    "xdg-open"
};

fn chapter<'a>(job: &Job<'a>, options: &Options, result: &'a RunResult) -> Chapter<'a> {
    Chapter {
        name: &job.input.name,
        case: job.label(),
        text: &job.input.source.text,
        scenario: job.scenario(),
        precision: options.precision.into(),
        result,
        warnings: &job.input.warnings,
    }
}

/// The page and the pictures.
fn draw(chapters: &[Chapter<'_>], targets: &Targets, command: &str) -> Result<Vec<Complete>, Failure> {
    let write = |target: &FileTarget, text: &str| {
        let mut draft = target.create()?;
        draft.write_all(text.as_bytes()).map_err(|error| target.failed(&error))?;
        draft.complete()
    };
    let mut files = Vec::new();
    if let Some(target) = &targets.report {
        files.push(write(target, &report::page(chapters, command)).map_err(Failure::internal)?);
    }
    for (target, chapter) in targets.svg.iter().zip(chapters) {
        files.push(write(target, &report::figure(chapter)).map_err(Failure::internal)?);
    }
    Ok(files)
}

/// The tables, with headings when there are several.
fn tables(chapters: &[Chapter<'_>]) -> String {
    if let [only] = chapters {
        return run_table(only);
    }
    let table = |chapter: &Chapter<'_>| {
        let case = chapter.case.map_or(String::new(), |case| format!(", {case}"));
        format!("== {}{case}\n{}", chapter.name, run_table(chapter))
    };
    chapters.iter().map(table).collect::<Vec<_>>().join("\n")
}
