//! Wrong arguments, and what was probably meant by them.

use super::quoting::quoted;
use crate::output::Problem;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::path::Path;

/// What is to be said of a wrong argument instead of the parser's own words, when there is something better.
pub(super) fn better(error: &clap::Error) -> Option<Problem> {
    let unknown = match error.kind() {
        ErrorKind::InvalidSubcommand => ContextKind::InvalidSubcommand,
        ErrorKind::UnknownArgument => ContextKind::InvalidArg,
        _ => return None,
    };
    let Some(ContextValue::String(word)) = error.get(unknown) else { return None };
    let is_scenario = word == "-" || word.ends_with(".toml") || Path::new(word).is_file();
    is_scenario.then(|| {
        let message = format!("`{word}` is no command");
        Problem::new("usage", message).help(format!("to run a scenario: controller-sim run {}", quoted(word)))
    })
}

/// The parser's own words in one line.
pub(super) fn plain(error: &clap::Error) -> Problem {
    let text = error.to_string();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let first = lines.next().unwrap_or("wrong arguments").trim_start_matches("error: ");
    // What is missing stands on the lines below.
    let listed: Vec<&str> = lines.take_while(|line| line.starts_with(['<', '-', '['])).collect();
    let problem = Problem::new("usage", format!("{first} {}", listed.join(" ")).trim());
    let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: "));
    problem.help(tip.unwrap_or("see `controller-sim --help`"))
}
