//! `demo`: the scenarios that are built in.

use super::arguments::DemoArguments;
use super::quoting::quoted;
use super::run::run_inputs;
use super::scenarios::read_built_in;
use super::{Failure, print};
use crate::demo::{self, BuiltIn};
use crate::output::{Problem, list_json, saved_json};
use std::path::Path;

/// `demo`: `command` is what was typed.
pub(super) fn run(arguments: &DemoArguments, json: bool, command: &str) -> Result<(), Failure> {
    if arguments.list {
        return list(json);
    }
    let name = arguments.name.as_deref().unwrap_or(demo::NAME);
    let found = demo::named(name).map_err(|near| unknown(name, near))?;
    if let Some(path) = &arguments.save {
        return save(name, &found, path, arguments.options.force, json);
    }
    run_inputs(&read_built_in(&found, &arguments.options), &arguments.options, None, json, command)?;
    if !json && !arguments.options.quiet && arguments.name.is_none() {
        print(demo::TRY_NEXT)?;
    }
    Ok(())
}

fn unknown(name: &str, near: Option<&str>) -> Failure {
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => "see `controller-sim demo --list`".to_owned(),
    };
    Problem::new("unknown-name", format!("no built-in scenario is called `{name}`")).help(help).into()
}

fn list(json: bool) -> Result<(), Failure> {
    let all = || demo::all().map(|one| (one.name(), one.title()));
    if json {
        return Ok(print(&list_json(all()))?);
    }
    let width = all().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let lines: Vec<String> = all().map(|(name, title)| format!("{name:<width$}  {title}\n")).collect();
    Ok(print(&lines.concat())?)
}

fn save(name: &str, found: &[BuiltIn], path: &Path, force: bool, json: bool) -> Result<(), Failure> {
    let [one] = found else {
        let names: Vec<&str> = found.iter().map(BuiltIn::name).collect();
        let problem =
            Problem::new("usage", format!("`{name}` are {} scenarios; one can be saved", found.len()));
        return Err(problem.help(format!("give one of their names: {}", names.join(", "))).into());
    };
    let saved = demo::save(one, path, force)?;
    let mut saved = saved.iter().map(|path| path.display().to_string());
    let (first, others) = (saved.next().unwrap_or_default(), saved.collect::<Vec<_>>());
    Ok(print(&if json {
        saved_json(&first, &others)
    } else {
        let others: String = others.iter().map(|path| format!("wrote {path}, which it reads\n")).collect();
        format!("wrote {first}; run it with: controller-sim run {}\n{others}", quoted(&first))
    })?)
}
