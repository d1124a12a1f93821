//! `analyze`: margins and noise of the loops of a scenario, or of a plant and a PID from the command line.

use super::arguments::{Number, Options, key_and_value};
use super::card::{read_card, request, save};
use super::execute::Job;
use super::scenarios::{Inputs, read_files, read_text};
use super::{EXIT_REFUSED, Failure, colours, examples, print};
use crate::analysis::{Analysis, analyse};
use crate::card::{Request, loop_card};
use crate::output::{
    Analysed, FileTarget, Problem, Severity, Trouble, Written, analysis_json, analysis_table, card_table,
    check_table, is_same_file, publish, render,
};
use crate::report;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{ArgGroup, Args, ValueHint};
use controller_pil::board::BOARDS;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Arguments of `analyze`.
#[derive(Debug, Args)]
#[command(after_help = examples::ANALYZE, group = ArgGroup::new("written").multiple(true))]
pub(super) struct AnalyzeArguments {
    /// A scenario or design file; `-` reads it from the standard input
    #[arg(required_unless_present = "plant", value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: Option<PathBuf>,
    /// The plant, such as `exp(-s)/(1+s)^2`, in place of a file; needs --ts
    #[arg(
        long,
        value_name = "EXPR",
        conflicts_with_all = ["file", "set"],
        allow_hyphen_values = true,
        help_heading = LOOP
    )]
    plant: Option<String>,
    /// Proportional gain
    #[arg(long, value_name = "G", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    kp: Option<f64>,
    /// Integral gain
    #[arg(long, value_name = "G", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    ki: Option<f64>,
    /// Derivative gain
    #[arg(long, value_name = "G", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    kd: Option<f64>,
    /// Time constant of the filter in seconds
    #[arg(long, value_name = "S", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    tf: Option<f64>,
    /// Sampling period in seconds: the margins are those of the law as it is sampled
    #[arg(long, value_name = "S", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    ts: Option<f64>,
    /// Time from reading y to acting u in seconds
    #[arg(long, value_name = "S", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    latency: Option<f64>,
    /// A disturbance observer with the plant as its model and this filter time constant in seconds
    #[arg(long, value_name = "S", requires = "plant", allow_negative_numbers = true, help_heading = LOOP)]
    alpha: Option<f64>,
    /// Change a value of the file, for example `latency=0.05`; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
    /// Write a page with the loop card, step and load, Bode and Nyquist plots, sensitivities and noise to this file, for
    /// the browser
    #[arg(long, value_name = "FILE", group = "written", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Print the loop card, too: every figure of the law as it is deployed, judged against practice
    #[arg(long, help_heading = CARD)]
    card: bool,
    /// Write the loop card to this file, with bounds for `--check`
    #[arg(long, value_name = "FILE", group = "written", conflicts_with = "check", value_hint = ValueHint::FilePath, help_heading = CARD)]
    save_card: Option<PathBuf>,
    /// Hold the loop against this card: exit code 4 when a figure does not keep its bounds
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = CARD)]
    check: Option<PathBuf>,
    /// The controller of `--save-card`, when the file has several
    #[arg(long, value_name = "NAME", requires = "save_card", help_heading = CARD)]
    controller: Option<String>,
    /// Number type of the deployed law; if not given f32, or that of the card
    #[arg(long, value_enum, help_heading = CARD)]
    precision: Option<Number>,
    /// The board whose published instructions and memory are shown; if not given mps2-an386, or that of the card
    #[arg(
        long,
        value_name = "BOARD",
        help_heading = CARD,
        value_parser = PossibleValuesParser::new(BOARDS.map(|board| PossibleValue::new(board.name).help(board.core)))
    )]
    board: Option<String>,
    /// Replace files that exist
    #[arg(long, requires = "written")]
    force: bool,
}

const LOOP: &str = "Loop without a file";
const CARD: &str = "Loop card";

/// The name of what stands on the command line.
const TYPED: &str = "<command line>";

/// `analyze`: `command` is what was typed.
pub(super) fn run(arguments: &AnalyzeArguments, json: bool, command: &str) -> Result<(), Failure> {
    if arguments.plant.is_some() && arguments.ts.is_none() {
        let message = "`--plant` needs `--ts`: the loop is analysed with the sampled law that runs";
        let help = "give the sampling period in seconds, such as `--ts 0.01`; `design` shows a fitting one for the plant";
        return Err(Problem::new("usage", message).help(help).into());
    }
    let options = Options { set: arguments.set.clone(), ..Options::default() };
    let inputs = match (&arguments.plant, &arguments.file) {
        (Some(plant), _) => read_text(TYPED, typed(arguments, plant), &options),
        (None, Some(file)) => read_files(std::slice::from_ref(file), &options),
        (None, None) => Inputs::default(),
    };
    let mut troubles = inputs.troubles.clone();
    let held = arguments.check.as_ref().map(|path| read_card(path)).transpose();
    let held = held.unwrap_or_else(|trouble| {
        troubles.push(trouble);
        None
    });
    let mut target = |option: &str, path: &Option<PathBuf>| {
        let checked = path.as_ref().map(|path| target(option, path, arguments, &inputs)).transpose();
        checked.unwrap_or_else(|problem| {
            troubles.push(problem.into());
            None
        })
    };
    let page = target("--report", &arguments.report);
    let card = target("--save-card", &arguments.save_card);
    let request = request(arguments.precision, arguments.board.as_deref(), held.as_ref());
    let request = request.unwrap_or_else(|problem| {
        troubles.push(problem.into());
        Request::default()
    });
    if !troubles.is_empty() {
        return Err(Failure::input(troubles));
    }
    let mut analysed: Vec<Analysed<'_>> = Job::all(&inputs.list, None).iter().map(analysed).collect();
    check(&analysed)?;
    if arguments.card || page.is_some() {
        make_cards(&mut analysed, request);
    }
    let mut files = Vec::new();
    if let Some(target) = &card {
        files.push(filled(target, &save(&analysed, arguments.controller.as_deref(), request, command)?)?);
    }
    if let Some(held) = &held {
        held.hold(&mut analysed, request)?;
    }
    if let Some(target) = &page {
        files.push(filled(target, &report::analysis_page(&analysed, command))?);
    }
    publish(files).map_err(Failure::internal)?;
    let file =
        |kind, target: &FileTarget| Written { kind, path: target.path().display().to_string(), run: None };
    let mut written: Vec<Written> = page.iter().map(|target| file("report", target)).collect();
    written.extend(card.iter().map(|target| file("card", target)));
    if json {
        print(&analysis_json(&analysed, &written))?;
    } else {
        tell(&inputs, &analysed, arguments, &written)?;
    }
    let is_worse = |one: &Analysed<'_>| one.checked.as_ref().is_some_and(|checked| !checked.check.holds());
    if analysed.iter().any(is_worse) {
        return Err(Failure::worse());
    }
    let mut cards = analysed.iter().flat_map(|one| &one.cards);
    let has_none = arguments.card && !cards.any(Result::is_ok);
    if has_none { Err(Failure { troubles: Vec::new(), code: EXIT_REFUSED }) } else { Ok(()) }
}

/// Everything for people: warnings, tables, files.
fn tell(
    inputs: &Inputs,
    analysed: &[Analysed<'_>],
    arguments: &AnalyzeArguments,
    written: &[Written],
) -> Result<(), Failure> {
    for input in &inputs.list {
        let warnings = render(input.source(), &input.warnings, Severity::Warning, colours());
        io::stderr().write_all(warnings.as_bytes())?;
    }
    let mut tables = Vec::new();
    for one in analysed {
        let mut table = analysis_table(one);
        for (card, result) in one.cards.iter().zip(&one.controllers).filter(|_| arguments.card) {
            match (card, result) {
                (Ok(card), _) => table.push_str(&card_table(card)),
                (Err(why), Ok(analysis)) => {
                    table.push_str(&format!("\nno loop card of {}: {why}\n", analysis.name))
                }
                (Err(_), Err(_)) => {}
            }
        }
        table.extend(one.checked.as_ref().map(check_table));
        tables.push(table);
    }
    print(&tables.join("\n"))?;
    for file in written {
        print(&format!("\nwrote {}\n", file.path))?;
    }
    Ok(())
}

fn make_cards(analysed: &mut [Analysed<'_>], request: Request) {
    for one in analysed {
        one.cards = (0..one.controllers.len()).map(|index| loop_card(one.scenario, index, request)).collect();
    }
}

fn filled(target: &FileTarget, text: &str) -> Result<crate::output::Complete, Failure> {
    let mut draft = target.create().map_err(Failure::internal)?;
    draft.write_all(text.as_bytes()).map_err(|error| Failure::internal(target.failed(&error)))?;
    draft.complete().map_err(Failure::internal)
}

/// The options as a scenario: every mistake in them is found and shown as those in a file are.
fn typed(arguments: &AnalyzeArguments, plant: &str) -> String {
    let number = |x: Option<f64>| x.unwrap_or(0.0);
    let ts = number(arguments.ts);
    let text = |x: &str| toml::Value::String(x.to_owned()).to_string();
    let gains = [("kp", arguments.kp), ("ki", arguments.ki), ("kd", arguments.kd), ("tf", arguments.tf)];
    let gains: Vec<String> =
        gains.iter().filter_map(|(name, x)| x.map(|x| format!("{name} = {x:?}"))).collect();
    let observer = arguments.alpha.map_or(String::new(), |alpha| {
        format!("observer = {{ model = {}, alpha = {alpha:?} }}\n", text(plant))
    });
    let name = if arguments.alpha.is_some() { "PID + observer" } else { "PID" };
    let (latency, duration) = (number(arguments.latency), 100.0 * ts);
    format!(
        "version = 1\nts = {ts:?}\nduration = {duration:?}\nlatency = {latency:?}\n\n[plant]\ntf = {}\n\n\
         [[controller]]\nname = \"{name}\"\npid = {{ {} }}\n{observer}",
        text(plant),
        gains.join(", ")
    )
}

fn analysed<'a>(job: &Job<'a>) -> Analysed<'a> {
    let scenario = job.scenario();
    let controllers = scenario.controllers.iter().enumerate();
    let controllers = controllers
        .map(|(i, spec)| analyse(scenario, i).map_err(|why| (spec.name.trim().to_owned(), why)))
        .collect();
    Analysed {
        name: &job.input.name,
        case: job.label(),
        text: &job.input.source.text,
        scenario,
        warnings: &job.input.warnings,
        controllers,
        cards: Vec::new(),
        checked: None,
    }
}

/// Nothing is printed when there is no stable loop at all.
fn check(analysed: &[Analysed<'_>]) -> Result<(), Failure> {
    let all = || analysed.iter().flat_map(|one| &one.controllers);
    if all().any(|result| result.as_ref().is_ok_and(Analysis::is_stable)) {
        return Ok(());
    }
    let problem = |result: &Result<Analysis, (String, String)>| -> Trouble {
        let problem = match result {
            Ok(a) => {
                let poles = if a.unstable_poles == 1 { "pole" } else { "poles" };
                let message = format!(
                    "{}: the sampled loop is unstable: {} {poles} outside the unit circle or on it",
                    a.name, a.unstable_poles
                );
                let help = "lower the gains, sample faster, or check the signs of the gains and of the plant";
                Problem::new("unstable", message).help(help)
            }
            Err((name, why)) => Problem::new("refused", format!("{name}: {why}")),
        };
        problem.into()
    };
    let mut failure = Failure::refused(Problem::new("refused", "there is no controller to analyse"));
    let troubles: Vec<Trouble> = all().map(problem).collect();
    if !troubles.is_empty() {
        failure.troubles = troubles;
    }
    Err(failure)
}

fn target(
    option: &str,
    path: &Path,
    arguments: &AnalyzeArguments,
    inputs: &Inputs,
) -> Result<FileTarget, Problem> {
    let name = path.display();
    let example = if option == "--report" { "my.html" } else { "card.toml" };
    if path.as_os_str() == "-" {
        let message = format!("`{option} -` is not possible: the standard output has the table");
        return Err(Problem::new("file", message).help(format!("give a file: `{option} {example}`")));
    }
    if inputs.files.iter().chain(&arguments.check).any(|input| is_same_file(path, input)) {
        let message = format!("`{name}` is read by the analysis and is not overwritten");
        return Err(Problem::new("file", message).help(format!("give the file of `{option}` another name")));
    }
    if let (Some(page), Some(card)) = (&arguments.report, &arguments.save_card)
        && is_same_file(page, card)
        && option == "--save-card"
    {
        let message = format!("`--report` and `--save-card` are the same file `{name}`");
        return Err(Problem::new("file", message).help("give one of them another name"));
    }
    FileTarget::new(path, arguments.force)
}
