//! What is made of the description of the arguments: completions and manual pages.

use super::arguments::{Arguments, CompletionsArguments, ManArguments};
use super::{Failure, print};
use crate::output::{FileTarget, Problem, SCHEMA, publish, text_json, written_json};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use std::io::Write;
use std::path::Path;

/// `completions`.
pub(super) fn completions(arguments: &CompletionsArguments, json: bool) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "controller-sim", &mut text);
    show(&text, json)
}

/// `man`.
pub(super) fn man(arguments: &ManArguments, json: bool) -> Result<(), Failure> {
    let command = Arguments::command();
    match &arguments.dir {
        Some(folder) => write_pages(command, folder, arguments.force, json),
        None => show(&page(command)?, json),
    }
}

/// `schema`.
pub(super) fn schema() -> Result<(), Failure> {
    Ok(print(SCHEMA)?)
}

fn show(text: &[u8], json: bool) -> Result<(), Failure> {
    let text = String::from_utf8_lossy(text);
    Ok(print(&if json { text_json(&text) } else { text.into_owned() })?)
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text)?;
    Ok(text)
}

/// A page for the program and one for each of its commands: all or none.
fn write_pages(mut command: Command, folder: &Path, force: bool, json: bool) -> Result<(), Failure> {
    command.build();
    let mut pages = vec![("controller-sim.1".to_owned(), page(command.clone())?)];
    for one in command.get_subcommands().filter(|one| one.get_name() != "help") {
        let name = format!("controller-sim-{}", one.get_name());
        let heading = one.get_display_name().map_or_else(|| name.clone(), str::to_owned);
        pages.push((format!("{name}.1"), page(one.clone().display_name(heading))?));
    }
    if !folder.is_dir() {
        let problem = Problem::new("file", format!("there is no folder `{}`", folder.display()));
        return Err(problem
            .help(format!("create it: mkdir -p {}", super::quoting::quoted(&folder.display().to_string())))
            .into());
    }
    let (mut targets, mut problems) = (Vec::new(), Vec::new());
    for (name, text) in pages {
        match FileTarget::new(&folder.join(name), force) {
            Ok(target) => targets.push((target, text)),
            Err(problem) => problems.push(problem.into()),
        }
    }
    if !problems.is_empty() {
        return Err(Failure::input(problems));
    }
    let mut complete = Vec::new();
    for (target, text) in &targets {
        let mut draft = target.create().map_err(Failure::internal)?;
        draft.write_all(text).map_err(|error| Failure::internal(target.failed(&error)))?;
        complete.push(draft.complete().map_err(Failure::internal)?);
    }
    publish(complete).map_err(Failure::internal)?;
    let paths: Vec<String> = targets.iter().map(|(target, _)| target.path().display().to_string()).collect();
    Ok(print(&if json {
        written_json(&paths)
    } else {
        paths.iter().map(|path| format!("wrote {path}\n")).collect()
    })?)
}
