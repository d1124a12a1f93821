//! `batch`: many plants by many rules.

use super::map::MapArguments;
use super::sample::SampleArguments;
use super::{
    EXIT_REFUSED, EXIT_STOPPED, Failure, colours, examples, input, interrupt, print, progress, wish,
};
use crate::batch::list::{self, Format, List, NamedPlant};
use crate::batch::sample::SampleSummary;
use crate::batch::store::{self, Begun, RowFile};
use crate::batch::{About, Layout, Row, Shard, Stopped, Study, Summary, work};
use crate::output::{Batched, Problem, Sampled, Trouble, batch_json, batch_table, is_same_file, render_all};
use crate::scenario::SourceText;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, Subcommand, ValueEnum, ValueHint};
use controller_design::batch134;
use controller_design::design::Method;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Args)]
#[command(
    after_help = examples::BATCH,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    group = ArgGroup::new("plants").required(true)
)]
pub(super) struct BatchArguments {
    #[command(subcommand)]
    command: Option<BatchCommand>,
    /// A list of processes that is built in
    #[arg(long, value_enum, group = "plants")]
    set: Option<Set>,
    /// A list of one's own, CSV (columns name, plant and, if wanted, family) or TOML (tables [[process]] with these keys)
    #[arg(long, value_name = "FILE", group = "plants", value_hint = ValueHint::FilePath)]
    processes: Option<PathBuf>,
    /// Print the processes of the set as CSV, with --json as JSON, and do nothing else
    #[arg(long, requires = "set", conflicts_with_all = ["out", "shard"])]
    list: bool,
    /// The tuning rules, separated by commas; all are compared with the first
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        value_parser = method(),
        default_value = "pi-ms,dob,momi,drmo,de-momi,pi-iae,ah,amigo,simc,adrc"
    )]
    methods: Vec<Method>,
    /// Maximum sensitivities for the rules that are given one
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = wish::sensitivity, default_value = "1.4")]
    ms: Vec<f64>,
    /// Noise gains with the observer over that of the PI alone, above 1 (dob); if not given, the rule chooses one
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = ratio)]
    noise_ratio: Vec<f64>,
    /// Simulate the sampled loop with this period [s]; if not given, margins and indices are of the continuous loop
    #[arg(long, value_name = "S", value_parser = wish::positive)]
    ts: Option<f64>,
    /// Write the rows to this file as they come, .csv or .parquet
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    out: Option<PathBuf>,
    /// Go on with the file where an interrupted run has left it
    #[arg(long, requires = "out", conflicts_with = "force")]
    resume: bool,
    /// Replace the file if it exists
    #[arg(long, requires = "out")]
    force: bool,
    /// Do this part of the study only, such as 2/4; `batch merge` joins the parts
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: Shard,
    /// Threads; all processors if not given. The rows are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// No progress
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum BatchCommand {
    /// Draws plants around that of a scenario and tells how robust its controllers are
    Sample(SampleArguments),
    /// Joins the shards of a study, in any order, to the file that the whole study gives
    #[command(after_help = examples::BATCH_MERGE)]
    Merge(MergeArguments),
    /// Draws what a rule gives on a grid of two parameters, of the plant or of the rule, as contour lines
    Map(Box<MapArguments>),
}

#[derive(Debug, Args)]
struct MergeArguments {
    /// The files of all shards, .csv or .parquet
    #[arg(required = true, value_name = "FILES", value_hint = ValueHint::FilePath)]
    files: Vec<PathBuf>,
    /// The file to write, .csv or .parquet
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    out: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// What is built in.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Set {
    /// The 134 processes of Tena et al. 2022
    Ah134,
}

pub(super) fn method() -> impl TypedValueParser<Value = Method> {
    let words = Method::ALL.map(|method| PossibleValue::new(method.name()).help(method.about()));
    PossibleValuesParser::new(words).try_map(|name| Method::named(&name).ok_or("no such method"))
}

fn ratio(text: &str) -> Result<f64, String> {
    match wish::positive(text) {
        Ok(x) if (1.000_001..=1e9).contains(&x) => Ok(x),
        _ => Err("allowed: 1.000001 to 1e9".to_owned()),
    }
}

pub(super) fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').map(|(index, count)| (index.trim().parse(), count.trim().parse()));
    match parts {
        Some((Ok(index), Ok(count))) if 1 <= index && index <= count => Ok(Shard { index, count }),
        _ => Err("write the part and the number of parts, for example `2/4`".to_owned()),
    }
}

/// `batch`: `command` is what was typed.
pub(super) fn run(arguments: &BatchArguments, json: bool, command: &str) -> Result<(), Failure> {
    match &arguments.command {
        Some(BatchCommand::Sample(sample)) => return super::sample::run(sample, json, command),
        Some(BatchCommand::Merge(merge)) => return join(merge, json),
        Some(BatchCommand::Map(map)) => return super::map::run(map, json, command),
        None => {}
    }
    if arguments.list {
        return Ok(print(&if json { batch134::json() } else { batch134::csv() })?);
    }
    check(arguments)?;
    let study = Study {
        plants: plants(arguments)?,
        methods: arguments.methods.clone(),
        ms: arguments.ms.clone(),
        noise_ratios: arguments.noise_ratio.clone(),
        ts: arguments.ts,
    };
    let (name, total) = (study.name(), study.rows());
    let range = arguments.shard.rows(total);
    if range.is_empty() {
        let message = format!("there are {total} rows, and {} parts", arguments.shard.count);
        return Err(Problem::new("usage", message).help("make fewer parts").into());
    }
    let layout = Layout::rules();
    let mut summary = Summary::new(study.methods[0].name());
    let mut rows: Vec<Row> = Vec::new();
    let begun = match &arguments.out {
        None => None,
        Some(path) if arguments.resume => Some(store::resume(path, (&name, &layout), &range, |row| {
            summary.add(&Row::from(row.clone()));
        })?),
        Some(path) => Some(store::create(path, arguments.force, &layout)?),
    };
    let (mut file, kept) = begun.map_or((None, 0), |Begun { file, kept }| (file, kept));
    let control = interrupt::control();
    let done = AtomicU64::new(kept as u64);
    let jobs = jobs(arguments.jobs);
    let counted = || done.load(Ordering::Relaxed);
    let result = progress::watch_count("rows", counted, range.len() as u64, arguments.quiet, || {
        work(&study, range.start + kept..range.end, jobs, control, &done, |made| -> Result<(), Ended> {
            made.iter().for_each(|row| summary.add(row));
            match &mut file {
                Some(file) => file.write(&made).map_err(Ended::Failed),
                None => {
                    rows.extend(made);
                    Ok(())
                }
            }
        })
    });
    match result {
        Err(Ended::Stopped) => {
            return Err(stopped(file.as_ref(), summary.counts().iter().sum(), range.len()));
        }
        Err(Ended::Failed(problem)) => return Err(Failure::internal(problem)),
        Ok(()) => {}
    }
    if let Some(file) = file {
        file.finish().map_err(Failure::internal)?;
    }
    let out = arguments.out.as_ref().map(|path| path.display().to_string());
    let results = arguments.out.is_none().then_some(&*rows);
    show(
        &Batched { study: &name, rows: range.len(), kept, summary: &summary, out: out.as_deref(), results },
        json,
    )
}

/// The number of threads: all processors if it is not given.
pub(super) fn jobs(wanted: Option<u16>) -> usize {
    let all = || std::thread::available_parallelism().ok().map(usize::from);
    wanted.map(usize::from).or_else(all).unwrap_or(1)
}

/// Why the rows ended early.
pub(super) enum Ended {
    Stopped,
    Failed(Problem),
}

impl From<Stopped> for Ended {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

pub(super) fn stopped(file: Option<&RowFile>, done: usize, total: usize) -> Failure {
    let Some(file) = file else { return Failure::stopped() };
    let path = file.journal().display();
    let message = format!("stopped; {done} of {total} rows are in {path}; `--resume` goes on");
    Failure { troubles: vec![Problem::new("stopped", message).into()], code: EXIT_STOPPED }
}

/// Prints what it comes to; the exit code says whether rows are without a result.
fn show(made: &Batched<'_>, json: bool) -> Result<(), Failure> {
    print(&if json { batch_json(made) } else { batch_table(made) })?;
    let [_, refused, failed] = made.summary.counts();
    if refused + failed == 0 { Ok(()) } else { Err(Failure { troubles: Vec::new(), code: EXIT_REFUSED }) }
}

/// What is wrong with the lists, all at once.
fn check(arguments: &BatchArguments) -> Result<(), Failure> {
    let mut troubles: Vec<Trouble> = Vec::new();
    let mut twice = |option: &str, names: Vec<String>| {
        for (i, name) in names.iter().enumerate().filter(|(i, name)| names[..*i].contains(name)) {
            let problem = Problem::new(
                "usage",
                format!("`{option}` has {name} twice, first at place {}", 1 + position(&names, i)),
            );
            troubles.push(problem.help("give each once").into());
        }
    };
    twice("--methods", arguments.methods.iter().map(|method| method.name().to_owned()).collect());
    twice("--ms", arguments.ms.iter().map(f64::to_string).collect());
    twice("--noise-ratio", arguments.noise_ratio.iter().map(f64::to_string).collect());
    let looks_at = |option: &str| arguments.methods.iter().any(|method| method.options().contains(&option));
    if !arguments.noise_ratio.is_empty() && !looks_at("noise_ratio") {
        let problem = Problem::new("usage", "`--noise-ratio` means nothing to these methods");
        troubles.push(problem.help("it belongs to dob").into());
    }
    if let Some(out) = &arguments.out {
        if out.as_os_str() == "-" {
            let problem =
                Problem::new("file", "`--out -` is not possible: the standard output has the table");
            troubles.push(problem.help("give a file: `--out rows.csv`").into());
        }
        if arguments.processes.as_ref().is_some_and(|list| is_same_file(list, out)) {
            let message = format!("`{}` is the list itself and is not overwritten", out.display());
            troubles.push(Problem::new("file", message).help("give the file of `--out` another name").into());
        }
    }
    if troubles.is_empty() { Ok(()) } else { Err(Failure::input(troubles)) }
}

fn position(names: &[String], of: usize) -> usize {
    names.iter().position(|name| *name == names[of]).unwrap_or(of)
}

fn plants(arguments: &BatchArguments) -> Result<Vec<NamedPlant>, Failure> {
    let Some(path) = &arguments.processes else { return Ok(list::ah134()) };
    let format = format(path)?;
    let (name, text) = input::read_processes(path)?;
    let read = list::read(&text, format);
    let trouble = |faults| vec![Trouble::Scenario(SourceText { name, text }, faults)];
    match read {
        Err(faults) => Err(Failure::input(trouble(faults))),
        Ok(List { plants, faults }) => {
            if !faults.is_empty() {
                eprintln!("{}", render_all(&trouble(faults), colours()));
            }
            Ok(plants)
        }
    }
}

fn format(path: &Path) -> Result<Format, Problem> {
    let ending = path.extension().map(OsStr::to_ascii_lowercase);
    match ending.as_deref().and_then(OsStr::to_str) {
        Some("csv") => Ok(Format::Csv),
        Some("toml") => Ok(Format::Toml),
        _ => {
            let message = format!("`{}` must end with .csv or .toml", path.display());
            Err(Problem::new("file", message).help("the ending tells how the list is written"))
        }
    }
}

/// `batch merge`.
fn join(arguments: &MergeArguments, json: bool) -> Result<(), Failure> {
    let (mut rules, mut samples): (Option<Summary>, Option<SampleSummary>) = (None, None);
    let merged =
        store::merge(&arguments.files, &arguments.out, arguments.force, |layout, cells| {
            match layout.about() {
                About::Rules | About::Points => {
                    let row = Row::from(cells.clone());
                    rules.get_or_insert_with(|| Summary::new(row.point()[0])).add(&row);
                }
                About::Samples => samples.get_or_insert_with(|| SampleSummary::new(layout)).add(cells),
            }
        });
    let (study, rows) =
        merged.map_err(|problems| Failure::input(problems.into_iter().map(Trouble::from).collect()))?;
    let (study, out) = (&*study, arguments.out.display().to_string());
    if let Some(summary) = &samples {
        return super::sample::show(&Sampled { out: Some(&out), ..Sampled::of(study, rows, summary) }, json);
    }
    let summary = &rules.unwrap_or_default();
    show(&Batched { study, rows, kept: 0, summary, out: Some(&out), results: None }, json)
}
