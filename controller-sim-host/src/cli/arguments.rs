//! The arguments of the program.

use super::examples;
use super::identify::IdentifyArguments;
use super::reproduce::ReproduceArguments;
use super::wish::Wish;
use crate::simulate::Precision;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum, ValueHint};
use controller_design::design::Method;
use controller_pil::board::BOARDS;
use std::path::PathBuf;

/// Runs the controllers that are flashed against an exactly simulated plant.
#[derive(Debug, Parser)]
#[command(name = "controller-sim", version, after_help = examples::PROGRAM)]
pub(super) struct Arguments {
    /// Print one JSON object instead of tables and texts; `controller-sim schema` describes it
    #[arg(long, global = true)]
    pub(super) json: bool,
    #[command(subcommand)]
    pub(super) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Runs scenarios and compares their controllers
    Run(RunArguments),
    /// Runs a built-in scenario, lists them, or writes one to a file
    Demo(DemoArguments),
    /// Designs a controller for a plant
    Design(DesignArguments),
    /// Tunes a loop from a recorded change between two steady states
    Tune(super::tune::TuneArguments),
    /// Finds areas and a model of the process in a recorded change between two steady states
    Identify(IdentifyArguments),
    /// Gives margins, sensitivity and noise of loops: of the continuous design and of the law that runs
    Analyze(super::analyze::AnalyzeArguments),
    /// Judges from a recorded experiment whether a PI loop is tuned for loads
    Assess(super::assess::AssessArguments),
    /// Writes a designed loop for the target: Rust constants, a C header, Structured Text
    Export(super::export::ExportArguments),
    /// Designs loops for many plants by many rules and compares them
    Batch(super::batch::BatchArguments),
    /// Computes the tables of the papers again: printed, true, ours, verdict; and draws their figures
    Reproduce(ReproduceArguments),
    /// Prints the completions for a shell
    Completions(CompletionsArguments),
    /// Prints the manual page
    Man(ManArguments),
    /// Prints the JSON schema of everything that `--json` prints
    #[command(after_help = examples::SCHEMA)]
    Schema,
}

#[derive(Debug, Args)]
#[command(after_help = examples::RUN, groups = groups())]
pub(super) struct RunArguments {
    /// The scenarios, TOML files; `-` reads one from the standard input
    #[arg(required = true, value_name = "FILES", value_hint = ValueHint::FilePath)]
    pub(super) scenarios: Vec<PathBuf>,
    /// Run the controllers on this emulated board, too, and compare every output bit by bit; mps2-an386 if not named
    #[arg(
        long,
        value_name = "BOARD",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = BOARDS[0].name,
        value_parser = PossibleValuesParser::new(BOARDS.map(|board| PossibleValue::new(board.name).help(board.core)))
    )]
    pub(super) pil: Option<String>,
    /// The image for the board; if not given, the workspace's own is built
    #[arg(long, value_name = "FILE", requires = "pil", value_hint = ValueHint::FilePath)]
    pub(super) pil_image: Option<PathBuf>,
    #[command(flatten)]
    pub(super) options: Options,
}

#[derive(Debug, Default, Args)]
#[command(after_help = examples::DEMO, groups = groups())]
pub(super) struct DemoArguments {
    /// A built-in scenario, or the beginning of several names
    pub(super) name: Option<String>,
    /// Lists the built-in scenarios
    #[arg(long, conflicts_with_all = ["name", "files", "set"])]
    pub(super) list: bool,
    /// Write the scenario to this file instead of running it; takes the next free name if it exists
    #[arg(
        long,
        value_name = "FILE",
        num_args = 0..=1,
        default_missing_value = "demo.toml",
        group = "files",
        conflicts_with_all = ["report", "svg", "csv", "parquet", "set"],
        value_hint = ValueHint::FilePath
    )]
    pub(super) save: Option<PathBuf>,
    #[command(flatten)]
    pub(super) options: Options,
}

/// What is common to everything that runs.
#[derive(Debug, Default, Args)]
pub(super) struct Options {
    /// Write a page with plots, tables and parameters to this file, for the browser
    #[arg(long, value_name = "FILE", groups = ["files", "pictures"], value_hint = ValueHint::FilePath)]
    pub(super) report: Option<PathBuf>,
    /// Write the plots to this file; NAME-1.svg, NAME-2.svg, ... when there are several runs
    #[arg(long, value_name = "FILE", groups = ["files", "pictures"], value_hint = ValueHint::FilePath)]
    pub(super) svg: Option<PathBuf>,
    /// Write every sample of every controller to this file
    #[arg(long, value_name = "FILE", group = "files", value_hint = ValueHint::FilePath)]
    pub(super) csv: Option<PathBuf>,
    /// Write every sample of every controller to this Parquet file
    #[arg(long, value_name = "FILE", group = "files", value_hint = ValueHint::FilePath)]
    pub(super) parquet: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, requires = "files")]
    pub(super) force: bool,
    /// Number type of the controllers
    #[arg(long, value_enum, default_value_t)]
    pub(super) precision: Number,
    /// Steps between two samples for the metrics, 1 to 1000; overrides the scenario
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(super) substeps: Option<u16>,
    /// Change a value of the scenario, for example `noise.std=0.1`; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(super) set: Vec<(String, String)>,
    /// The plots begin at this time in seconds
    #[arg(long, value_name = "T", value_parser = time, requires = "pictures")]
    pub(super) from: Option<f64>,
    /// The plots end at this time in seconds
    #[arg(long, value_name = "T", value_parser = time, requires = "pictures")]
    pub(super) to: Option<f64>,
    /// Runs at a time; all processors if not given. The results are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// No progress, and no line about the files that were written
    #[arg(long, short)]
    pub(super) quiet: bool,
}

#[derive(Debug, Args)]
#[command(after_help = examples::DESIGN)]
pub(super) struct DesignArguments {
    /// The plant, an expression in s such as `2*exp(-0.5*s)/(1+3*s)`
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub(super) plant: String,
    /// The tuning rule; `advise` compares all of them on the plant
    #[arg(long, value_parser = Rule::parser())]
    pub(super) method: Rule,
    /// Sampling period [s]; if not given, a round one about 200 times shorter than the plant's response
    #[arg(long, value_name = "S", value_parser = super::wish::positive)]
    pub(super) ts: Option<f64>,
    #[command(flatten)]
    pub(super) wish: Wish,
    /// Write the design file, which `run` and `analyze` read
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) save: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "save")]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
#[command(after_help = examples::COMPLETIONS)]
pub(super) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub(super) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
#[command(after_help = examples::MAN)]
pub(super) struct ManArguments {
    /// Write one page for each command to this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(super) dir: Option<PathBuf>,
    /// Replace pages that exist
    #[arg(long, requires = "dir")]
    pub(super) force: bool,
}

/// The options that write files, of which `--force` needs one, and those of them that draw: any number of each.
fn groups() -> [ArgGroup; 2] {
    ["files", "pictures"].map(|name| ArgGroup::new(name).multiple(true))
}

pub(super) fn key_and_value(text: &str) -> Result<(String, String), String> {
    // A `=` in quotes belongs to a name.
    let mut quote = None;
    let split = text.find(|c| {
        match quote {
            None if c == '=' => return true,
            None if matches!(c, '"' | '\'') => quote = Some(c),
            Some(open) if c == open => quote = None,
            _ => {}
        }
        false
    });
    let parts =
        split.and_then(|at| text.split_at_checked(at)).map(|(key, value)| (key.trim(), value[1..].trim()));
    match parts {
        Some((key, value)) if !key.is_empty() && !value.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("write KEY=VALUE, for example `noise.std=0.1`".to_owned()),
    }
}

fn time(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(t) if t.is_finite() && t >= 0.0 => Ok(t),
        _ => Err("write a time in seconds, 0 or above, for example `2.5`".to_owned()),
    }
}

/// A tuning rule; none: a comparison of all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rule(pub(super) Option<Method>);

/// The word for the comparison.
const ADVISE: &str = "advise";

impl Rule {
    /// The names of all rules, with what each is.
    fn words() -> Vec<PossibleValue> {
        let rules =
            Method::ALL.into_iter().map(|method| PossibleValue::new(method.name()).help(method.about()));
        rules.chain([PossibleValue::new(ADVISE).help("compares all of them on the plant")]).collect()
    }

    /// Reads a name; clap tells what is wrong with it and what was meant.
    pub(super) fn parser() -> impl TypedValueParser<Value = Self> {
        PossibleValuesParser::new(Self::words()).map(|name| Self(Method::named(&name)))
    }
}

/// A number type by its Rust name.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(super) enum Number {
    /// Single precision: what most targets run
    F32,
    /// Double precision
    #[default]
    F64,
}

impl From<Number> for Precision {
    fn from(number: Number) -> Self {
        match number {
            Number::F32 => Self::F32,
            Number::F64 => Self::F64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_do_not_contradict_each_other() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_key_ends_at_the_first_sign_outside_quotes() {
        let pair = |key: &str, value: &str| Ok((key.to_owned(), value.to_owned()));
        assert_eq!(key_and_value(" noise.std = 1 "), pair("noise.std", "1"));
        assert_eq!(key_and_value("controller.\"a=b\".pid.kp=2"), pair("controller.\"a=b\".pid.kp", "2"));
        assert_eq!(key_and_value("title='a=b'"), pair("title", "'a=b'"));
        for wrong in ["", "a", "=1", "a=", " = "] {
            assert!(key_and_value(wrong).is_err(), "{wrong}");
        }
    }
}
