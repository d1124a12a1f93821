//! `analyze`: margins and noise of the loops of a scenario, or of a plant and a PID from the command line.

use super::arguments::{Options, key_and_value};
use super::execute::Job;
use super::scenarios::{Inputs, read_files, read_text};
use super::{Failure, colours, examples, print};
use crate::analysis::{Analysis, analyse};
use crate::output::{
    Analysed, FileTarget, Problem, Severity, Trouble, Written, analysis_json, analysis_table, is_same_file,
    render,
};
use crate::report;
use clap::{Args, ValueHint};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Arguments of `analyze`.
#[derive(Debug, Args)]
#[command(after_help = examples::ANALYZE)]
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
    /// Write a page with Bode and Nyquist plots, sensitivities and noise to this file, for the browser
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "report")]
    force: bool,
}

const LOOP: &str = "Loop without a file";

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
    let target = arguments.report.as_ref().map(|path| target(path, arguments.force, &inputs)).transpose();
    let target = target.unwrap_or_else(|problem| {
        troubles.push(problem.into());
        None
    });
    if !troubles.is_empty() {
        return Err(Failure::input(troubles));
    }
    let analysed: Vec<Analysed<'_>> = Job::all(&inputs.list, None).iter().map(analysed).collect();
    check(&analysed)?;
    if let Some(target) = &target {
        let page = report::analysis_page(&analysed, command);
        target.write(|file| file.write_all(page.as_bytes())).map_err(Failure::internal)?;
    }
    let file = |target: &FileTarget| Written {
        kind: "report",
        path: target.path().display().to_string(),
        run: None,
    };
    let written: Vec<Written> = target.iter().map(file).collect();
    if json {
        return Ok(print(&analysis_json(&analysed, &written))?);
    }
    for input in &inputs.list {
        let warnings = render(input.source(), &input.warnings, Severity::Warning, colours());
        io::stderr().write_all(warnings.as_bytes())?;
    }
    print(&analysed.iter().map(analysis_table).collect::<Vec<_>>().join("\n"))?;
    for file in &written {
        print(&format!("\nwrote {}\n", file.path))?;
    }
    Ok(())
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

fn target(path: &Path, force: bool, inputs: &Inputs) -> Result<FileTarget, Problem> {
    let name = path.display();
    if path.as_os_str() == "-" {
        let message = "`--report -` is not possible: the standard output has the table";
        return Err(Problem::new("file", message).help("give a file: `--report my.html`"));
    }
    if inputs.files.iter().any(|input| is_same_file(path, input)) {
        let message = format!("`{name}` is read by the analysis and is not overwritten");
        return Err(Problem::new("file", message).help("give the file of `--report` another name"));
    }
    FileTarget::new(path, force)
}
