//! `design`: from a plant to a controller.

use super::arguments::DesignArguments;
use super::quoting::quoted;
use super::wish::{flag, usual_period};
use super::{EXIT_REFUSED, Failure, print};
use crate::advise::advise;
use crate::design_file;
use crate::design_run::run_file;
use crate::output::{self, FileTarget, Problem, Trouble};
use crate::scenario::{Fault, SourceText, code};
use controller_design::Refusal;
use controller_design::design::{Method, ObserverFilter, Remedy, Request, design, remedies};
use controller_design::model::{TransferFunction, parse};

/// `design`: `command` is what was typed.
pub(super) fn run(arguments: &DesignArguments, json: bool, command: &str) -> Result<(), Failure> {
    let plant = plant(&arguments.plant)?;
    let ts = arguments.ts.unwrap_or_else(|| usual_period(&plant));
    let Some(method) = arguments.method.0 else {
        if arguments.save.is_some() {
            let problem = Problem::new("usage", "`--save` needs one method; `advise` compares all of them");
            return Err(problem.help("choose one of them, then save it").into());
        }
        let mut advice = advise(&plant, ts, |method| arguments.wish.compared(method, ts, None));
        advice.options = arguments.wish.given();
        if advice.rows.iter().all(|row| row.outcome.is_err()) {
            let refusals = advice.rows.iter().filter_map(|row| {
                let refusal = row.outcome.as_ref().err()?;
                Some(refused(row.method, refusal).troubles)
            });
            return Err(Failure { troubles: refusals.flatten().collect(), code: EXIT_REFUSED });
        }
        return Ok(print(&if json { output::advice_json(&advice) } else { output::advice_table(&advice) })?);
    };
    let idle = arguments.wish.idle(method);
    if !idle.is_empty() {
        return Err(Failure::input(idle.into_iter().map(Trouble::from).collect()));
    }
    if arguments.save.as_ref().is_some_and(|path| path.as_os_str() == "-") {
        let message = "`--save -` is not possible: the standard output has the table";
        return Err(Problem::new("file", message).help("give a file: `--save loop.toml`").into());
    }
    let target = arguments.save.as_ref().map(|path| FileTarget::new(path, arguments.force)).transpose()?;
    let request = arguments.wish.request(method, ts, None);
    let made = design(&plant, &request).map_err(|refusal| with_remedies(&plant, &request, &refusal))?;
    let mut file = design_file::of(&made, arguments.wish.limits, command);
    if let Some(name) = &arguments.wish.name {
        file.controller.name.clone_from(name);
    }
    if let Some(target) = &target {
        target.write(|to| to.write_all(file.text().as_bytes())).map_err(Failure::internal)?;
    }
    // A file that is kept is tried; the least IAE is that of the continuous loop, and people want that of theirs.
    let is_tried = target.is_some() || made.predicted.iae_load.is_some();
    let tried = is_tried.then(|| run_file(&made, file, f64::INFINITY)).flatten();
    let saved = target.map(|target| target.path().display().to_string());
    if json {
        return Ok(print(&output::design_json(&made, tried.as_ref(), saved.as_deref()))?);
    }
    let next = match saved.map(|path| quoted(&path)) {
        Some(path) => format!("\nwrote {path}; run it with: controller-sim run {path}\n"),
        None => "\nadd `--save loop.toml` for a file that `run` and `analyze` read\n".to_owned(),
    };
    Ok(print(&(output::design_table(&made, tried.as_ref()) + &next))?)
}

/// The plant of the command line.
pub(super) fn plant(text: &str) -> Result<TransferFunction, Failure> {
    parse(text).map_err(|errors| {
        let faults = errors.into_iter().map(|error| {
            let fault = Fault::new(code::EXPRESSION, error.span, error.message);
            Fault { help: error.help, ..fault }
        });
        let source = SourceText { name: "--plant".to_owned(), text: text.to_owned() };
        Failure::input(vec![Trouble::Scenario(source, faults.collect())])
    })
}

/// A number that was typed and cannot be is a mistake of whoever typed it.
fn is_typed(method: Method, refusal: &Refusal) -> bool {
    let Refusal::OutOfRange { parameter, .. } = refusal else { return false };
    matches!(*parameter, "ts" | "latency") || method.options().contains(parameter)
}

/// The same with what does work on the plant, as it is typed.
fn with_remedies(plant: &TransferFunction, request: &Request, refusal: &Refusal) -> Failure {
    let method = request.method;
    if is_typed(method, refusal) {
        return refused(method, refusal);
    }
    let typed = |Remedy { request, option }: Remedy| {
        let option = option.map_or(String::new(), |(name, value)| match request.observer_filter {
            ObserverFilter::Wanted(wish) => format!(" {} {}={value}", flag(name), wish.name()),
            _ => format!(" {} {value}", flag(name)),
        });
        format!("`--method {}{option}`", request.method.name())
    };
    let works: Vec<String> = remedies(plant, request).into_iter().map(typed).collect();
    let help = match &*works {
        [] => refusal.help().to_owned(),
        works => format!("{}; on this plant these work: {}", refusal.help(), works.join(", ")),
    };
    Failure::refused(no_design(method, refusal).help(help))
}

fn no_design(method: Method, refusal: &Refusal) -> Problem {
    Problem::new("refused", format!("no design by {}: {refusal}", method.name()))
}

/// What a rule refuses: well-formed input without a result.
pub(super) fn refused(method: Method, refusal: &Refusal) -> Failure {
    if is_typed(method, refusal) {
        return Problem::new("usage", format!("{}: {refusal}", method.name())).help(refusal.help()).into();
    }
    Failure::refused(no_design(method, refusal).help(refusal.help()))
}
