//! The command line: arguments, exit codes, what goes to which stream.

mod arguments;
mod input;
mod usage;

use crate::demo;
use crate::output::{
    FileTarget, Problem, Severity, Source, error_json, is_same_file, render, run_json, run_table, write_csv,
};
use crate::scenario::{Fault, Read, Scenario, read};
use crate::simulate::{Precision, RunOptions, RunResult, run};
use arguments::{Arguments, Command, DemoArguments, RunArguments};
use clap::Parser;
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

/// Exit code of bad input: arguments, files, scenarios.
pub const EXIT_INPUT: u8 = 2;
/// Exit code of a refusal: the input is well formed, but there is no result.
pub const EXIT_REFUSED: u8 = 3;
/// Exit code of everything else.
pub const EXIT_INTERNAL: u8 = 1;

/// Most samples that are kept for a CSV file: about 2 GB of memory.
const MOST_KEPT: f64 = 2e7;

/// Why the program ends without a result.
enum Failure {
    /// Faults of a scenario: its name, its text, the faults.
    Scenario(String, String, Vec<Fault>),
    /// Anything else, with the exit code.
    Other(Problem, u8),
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Other(problem, EXIT_INPUT)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Other(Problem::new("output", format!("cannot write the result: {error}")), EXIT_INTERNAL)
    }
}

/// Runs the program with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let list: Vec<OsString> = std::env::args_os().collect();
    let arguments = match Arguments::try_parse_from(&list) {
        Ok(arguments) => arguments,
        Err(error) => return wrong(&error, list.iter().any(|a| a == "--json")),
    };
    let json = arguments.json
        || match &arguments.command {
            None => false,
            Some(Command::Run(run)) => run.json,
            Some(Command::Demo(demo)) => demo.json,
        };
    let done = match arguments.command {
        None => run_demo(&DemoArguments { json, ..DemoArguments::default() }),
        Some(Command::Demo(arguments)) => run_demo(&DemoArguments { json, ..arguments }),
        Some(Command::Run(arguments)) => run_file(&RunArguments { json, ..arguments }),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(&failure, json),
    }
}

/// Help and version are no mistakes; everything else is, and goes to where the caller looks for it.
fn wrong(error: &clap::Error, json: bool) -> ExitCode {
    match (usage::better(error), json && error.use_stderr()) {
        (Some(problem), json) => return report(&Failure::Other(problem, EXIT_INPUT), json),
        (None, true) => return report(&Failure::Other(usage::plain(error), EXIT_INPUT), true),
        (None, false) => {}
    }
    // Nothing to be done when even this cannot be printed.
    let _ = error.print();
    if error.use_stderr() { ExitCode::from(EXIT_INPUT) } else { ExitCode::SUCCESS }
}

fn report(failure: &Failure, json: bool) -> ExitCode {
    let none = Problem::new("scenario", "");
    let (problem, text, faults, code) = match failure {
        Failure::Scenario(_, text, faults) => (&none, &**text, &**faults, EXIT_INPUT),
        Failure::Other(problem, code) => (problem, "", &[][..], *code),
    };
    let printed = if json {
        print(&format!("{}\n", error_json(problem, text, faults)))
    } else {
        let message = match failure {
            Failure::Scenario(name, text, faults) => {
                render(Source { name, text }, faults, Severity::Error, colours())
            }
            Failure::Other(problem, _) => format!("{problem}\n"),
        };
        io::stderr().write_all(message.as_bytes())
    };
    // The exit code says it even when the message cannot be delivered.
    drop(printed);
    ExitCode::from(code)
}

/// Colours only for people: on a terminal, and not when `NO_COLOR` is set.
fn colours() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Prints a result. A reader that has gone away (`| head`) wanted no more: no mistake.
fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

fn run_demo(arguments: &DemoArguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.save {
        let saved = demo::save(path, arguments.force)?;
        let name = saved.display();
        return Ok(print(&if arguments.json {
            format!("{}\n", serde_json::json!({ "saved": name.to_string() }))
        } else {
            format!("wrote {name}; run it with: controller-sim run {name}\n")
        })?);
    }
    let source = Source { name: demo::NAME, text: demo::SCENARIO };
    let precision = arguments.precision.into();
    let Read { scenario, warnings } = read_scenario(source, precision)?;
    let result = simulate(&scenario, RunOptions { precision, trace: false, ..RunOptions::default() })?;
    show(source, &scenario, precision, &result, &warnings, arguments.json)?;
    if !arguments.json {
        print(demo::TRY_NEXT)?;
    }
    Ok(())
}

fn run_file(arguments: &RunArguments) -> Result<(), Failure> {
    let precision: Precision = arguments.precision.into();
    let (name, text) = input::read(&arguments.scenario)?;
    let source = Source { name: &name, text: &text };
    let Read { mut scenario, warnings } = read_scenario(source, precision)?;
    if let Some(substeps) = arguments.substeps {
        scenario.substeps = usize::from(substeps);
    }
    let csv = match &arguments.csv {
        Some(path) => Some(csv_target(path, arguments, &scenario)?),
        None => None,
    };
    let result =
        simulate(&scenario, RunOptions { precision, trace: csv.is_some(), ..RunOptions::default() })?;
    if let Some(csv) = &csv {
        csv.write(|to| write_csv(&result, to)).map_err(|problem| Failure::Other(problem, EXIT_INTERNAL))?;
    }
    show(source, &scenario, precision, &result, &warnings, arguments.json)?;
    if let (Some(csv), false) = (&csv, arguments.json) {
        let samples: usize = result.controllers.iter().map(|c| c.trace.len()).sum();
        print(&format!("\nwrote {}: {samples} samples\n", csv.path().display()))?;
    }
    Ok(())
}

/// Everything that can be wrong with the CSV file is found before the run, not after it.
fn csv_target(path: &Path, arguments: &RunArguments, scenario: &Scenario) -> Result<FileTarget, Failure> {
    if path.as_os_str() == "-" {
        let problem = Problem::new("file", "`--csv -` is not possible: the standard output has the table");
        return Err(problem.help("give a file: `--csv my.csv`").into());
    }
    let from =
        if arguments.scenario.as_os_str() == "-" { Path::new("/dev/stdin") } else { &arguments.scenario };
    if is_same_file(path, from) {
        let message = format!("`{}` is the scenario itself and is not overwritten", path.display());
        return Err(Problem::new("file", message).help("give the CSV file another name").into());
    }
    #[allow(clippy::cast_precision_loss)] // a bound
    let samples = scenario.duration / scenario.ts * scenario.controllers.len() as f64;
    if samples > MOST_KEPT {
        let message =
            format!("{samples:.3e} samples are too many for a CSV file; allowed: at most {MOST_KEPT:e}");
        let problem = Problem::new("too-large", message);
        return Err(problem.help("shorten the run, or leave `--csv` out: the metrics need no memory").into());
    }
    Ok(FileTarget::new(path, arguments.force)?)
}

fn read_scenario(source: Source<'_>, precision: Precision) -> Result<Read, Failure> {
    read(source.text, precision)
        .map_err(|faults| Failure::Scenario(source.name.to_owned(), source.text.to_owned(), faults))
}

fn simulate(scenario: &Scenario, options: RunOptions) -> Result<RunResult, Failure> {
    run(scenario, options)
        .map_err(|error| Failure::Other(Problem::new("refused", error.to_string()), EXIT_REFUSED))
}

fn show(
    source: Source<'_>,
    scenario: &Scenario,
    precision: Precision,
    result: &RunResult,
    warnings: &[Fault],
    json: bool,
) -> Result<(), Failure> {
    if json {
        return Ok(print(&format!("{}\n", run_json(source, scenario, precision, result, warnings)))?);
    }
    io::stderr().write_all(render(source, warnings, Severity::Warning, colours()).as_bytes())?;
    Ok(print(&run_table(scenario, precision, result))?)
}
