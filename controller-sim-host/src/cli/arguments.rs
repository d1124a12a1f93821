//! The arguments of the program.

use crate::simulate::Precision;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  controller-sim                                  run the built-in scenario
  controller-sim demo --save my.toml              write it to a file, to change it
  controller-sim run my.toml                      run a scenario and compare its controllers
  controller-sim run my.toml --precision f32      as the target computes
  controller-sim run my.toml --json               for a program

In the source tree write `cargo sim` for `controller-sim`.

Exit codes: 0 done, 2 bad input, 3 refused, 1 anything else.";

const RUN_EXAMPLES: &str = "\
Examples:
  controller-sim run my.toml
  controller-sim run my.toml --precision f32 --csv my.csv
  controller-sim run my.toml --csv my.csv --force     replace my.csv
  cat my.toml | controller-sim run - --json";

const DEMO_EXAMPLES: &str = "\
Examples:
  controller-sim demo                         run it
  controller-sim demo --save                  write it to demo.toml, or demo-2.toml, ...
  controller-sim demo --save my.toml --force  write it to my.toml, whatever was there";

/// Runs the controllers that are flashed against an exactly simulated plant.
#[derive(Debug, Parser)]
#[command(name = "controller-sim", version, after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub(super) json: bool,
    #[command(subcommand)]
    pub(super) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Runs a scenario and compares its controllers
    Run(RunArguments),
    /// Runs the built-in scenario, or writes it to a file
    Demo(DemoArguments),
}

#[derive(Debug, Args)]
#[command(after_help = RUN_EXAMPLES)]
pub(super) struct RunArguments {
    /// The scenario, a TOML file; `-` reads it from the standard input
    pub(super) scenario: PathBuf,
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub(super) json: bool,
    /// Write every sample of every controller to this file
    #[arg(long, value_name = "FILE")]
    pub(super) csv: Option<PathBuf>,
    /// Number type of the controllers
    #[arg(long, value_enum, default_value_t)]
    pub(super) precision: Number,
    /// Replace the CSV file if it exists
    #[arg(long, requires = "csv")]
    pub(super) force: bool,
    /// Steps between two samples for the metrics, 1 to 1000; overrides the scenario
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(super) substeps: Option<u16>,
}

#[derive(Debug, Default, Args)]
#[command(after_help = DEMO_EXAMPLES)]
pub(super) struct DemoArguments {
    /// Write the scenario to this file instead of running it; takes the next free name if it exists
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "demo.toml")]
    pub(super) save: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub(super) json: bool,
    /// Number type of the controllers
    #[arg(long, value_enum, default_value_t)]
    pub(super) precision: Number,
    /// Replace the file if it exists
    #[arg(long, requires = "save")]
    pub(super) force: bool,
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
