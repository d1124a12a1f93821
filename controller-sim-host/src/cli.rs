//! The command line: arguments, exit codes, what goes to which stream.

mod analyze;
mod arguments;
mod assess;
mod batch;
mod card;
mod design;
mod examples;
mod execute;
mod export;
mod gallery;
mod identify;
mod input;
mod interrupt;
mod map;
mod outputs;
mod pages;
mod progress;
mod quoting;
mod record;
mod reproduce;
mod run;
mod sample;
mod scenarios;
mod step_log;
mod tune;
mod usage;
mod wish;
mod worst;

use crate::output::{Problem, Trouble, error_json, render_all};
use arguments::{Arguments, Command, DemoArguments};
use clap::Parser;
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// Exit code of bad input: arguments, files, scenarios.
pub const EXIT_INPUT: u8 = 2;
/// Exit code of a refusal: the input is well formed, but there is no result.
pub const EXIT_REFUSED: u8 = 3;
/// Exit code of everything else.
pub const EXIT_INTERNAL: u8 = 1;
/// Exit code of a check that failed: a figure does not keep the bounds of a loop card.
pub const EXIT_WORSE: u8 = 4;
/// Exit code of a run that was stopped from outside: that of a shell for Ctrl-C.
pub const EXIT_STOPPED: u8 = 130;

/// Why the program ends without a result.
struct Failure {
    troubles: Vec<Trouble>,
    code: u8,
}

impl Failure {
    /// Mistakes of whoever called the program.
    fn input(troubles: Vec<Trouble>) -> Self {
        Self { troubles, code: EXIT_INPUT }
    }

    /// A well-formed input without a result.
    fn refused(problem: Problem) -> Self {
        Self { troubles: vec![problem.into()], code: EXIT_REFUSED }
    }

    /// Something that is in nobody's hand, such as a disc that is full.
    fn internal(problem: Problem) -> Self {
        Self { troubles: vec![problem.into()], code: EXIT_INTERNAL }
    }

    /// A result that was printed, and is not as it must be.
    fn differs() -> Self {
        Self { troubles: Vec::new(), code: EXIT_INTERNAL }
    }

    /// A loop that does not keep its card, which was printed.
    fn worse() -> Self {
        Self { troubles: Vec::new(), code: EXIT_WORSE }
    }

    /// Somebody wanted it to end.
    fn stopped() -> Self {
        Self {
            troubles: vec![Problem::new("stopped", "stopped; nothing was written").into()],
            code: EXIT_STOPPED,
        }
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::input(vec![problem.into()])
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::internal(Problem::new("output", format!("cannot write the result: {error}")))
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
    let (json, command) = (arguments.json, quoting::command_line(&list));
    let done = match arguments.command {
        None => gallery::run(&DemoArguments::default(), json, &command),
        Some(Command::Demo(arguments)) => gallery::run(&arguments, json, &command),
        Some(Command::Analyze(arguments)) => analyze::run(&arguments, json, &command),
        Some(Command::Run(arguments)) => run::run(&arguments, json, &command),
        Some(Command::Tune(arguments)) => tune::run(&arguments, json, &command),
        Some(Command::Design(arguments)) => design::run(&arguments, json, &command),
        Some(Command::Assess(arguments)) => assess::run(&arguments, json, &command),
        Some(Command::Identify(arguments)) => identify::run(&arguments, json, &command),
        Some(Command::Export(arguments)) => export::run(&arguments, json),
        Some(Command::Batch(arguments)) => batch::run(&arguments, json, &command),
        Some(Command::Reproduce(arguments)) => reproduce::run(&arguments, json, &command),
        Some(Command::Completions(arguments)) => pages::completions(&arguments, json),
        Some(Command::Man(arguments)) => pages::man(&arguments, json),
        Some(Command::Schema) => pages::schema(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(&failure, json),
    }
}

/// Help and version are no mistakes; everything else is, and goes to where the caller looks for it.
fn wrong(error: &clap::Error, json: bool) -> ExitCode {
    match (usage::better(error), json && error.use_stderr()) {
        (Some(problem), json) => return report(&problem.into(), json),
        (None, true) => return report(&usage::plain(error).into(), true),
        (None, false) => {}
    }
    // Nothing to be done when even this cannot be printed.
    let _ = error.print();
    if error.use_stderr() { ExitCode::from(EXIT_INPUT) } else { ExitCode::SUCCESS }
}

fn report(failure: &Failure, json: bool) -> ExitCode {
    let printed = if failure.troubles.is_empty() {
        // It was said with the result.
        Ok(())
    } else if json {
        print(&error_json(&failure.troubles))
    } else {
        let message = match (failure.code, &*failure.troubles) {
            // No mistake of anybody.
            (EXIT_STOPPED, [Trouble::Problem(problem)]) => format!("{}\n", problem.message),
            (_, troubles) => render_all(troubles, colours()),
        };
        io::stderr().write_all(message.as_bytes())
    };
    // The exit code says it even when the message cannot be delivered.
    drop(printed);
    ExitCode::from(failure.code)
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
