//! `batch sample`: plants drawn around that of a scenario.

use super::arguments::{Number, Options, key_and_value};
use super::batch::{Ended, jobs, shard, stopped};
use super::scenarios::{Input, Inputs, read_files};
use super::worst::Folder;
use super::{EXIT_REFUSED, Failure, colours, examples, input, interrupt, print, progress};
use crate::batch::sample::{self, SampleStudy, SampleSummary, Seeded, Spread, check_name, quantities};
use crate::batch::store::{self, Begun};
use crate::batch::{Cells, Shard};
use crate::output::{
    FileTarget, Problem, Sampled, Severity, Trouble, is_same_file, render, sample_json, sample_table,
};
use crate::report;
use crate::scenario::{SourceText, show_short, uncertainty};
use clap::{ArgGroup, Args, ValueHint};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Args)]
#[command(after_help = examples::BATCH_SAMPLE, group = ArgGroup::new("files").multiple(true))]
pub(super) struct SampleArguments {
    /// A scenario or design file; its controllers stay as they are
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// Draw this quantity, for example `gain=+-20%` or `lag1=0.5..2 log`; may be given more than once
    #[arg(long, value_name = "NAME=RANGE", value_parser = vary)]
    vary: Vec<(String, Spread)>,
    /// A file with more of them: TOML, the keys of a section [uncertainty]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    uncertainty: Option<PathBuf>,
    /// Number of samples
    #[arg(long, short = 'n', value_name = "N", default_value = "1000", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    samples: u64,
    /// Samples of another seed have other values
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Number type of the controllers
    #[arg(long, value_enum, default_value_t)]
    precision: Number,
    /// Steps between two samples for the metrics, 1 to 1000; overrides the scenario
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    substeps: Option<u16>,
    /// Change a value of the scenario, for example `noise.std=0.1`; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
    /// Write the rows to this file as they come, .csv or .parquet
    #[arg(long, value_name = "FILE", group = "files", value_hint = ValueHint::FilePath)]
    out: Option<PathBuf>,
    /// Write the worst samples to this folder, each as a scenario that `run` simulates again
    #[arg(long, value_name = "DIR", group = "files", value_hint = ValueHint::DirPath)]
    worst: Option<PathBuf>,
    /// Write a page with the distributions to this file, for the browser
    #[arg(long, value_name = "FILE", group = "files", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Go on with the file of rows where an interrupted run has left it
    #[arg(long, requires = "out")]
    resume: bool,
    /// Replace files that exist; with --resume all but the rows
    #[arg(long, requires = "files")]
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

fn vary(text: &str) -> Result<(String, Spread), String> {
    let (name, range) =
        text.split_once('=').ok_or("write NAME=RANGE, for example `gain=+-20%` or `dead_time=0.5..2`")?;
    let name = name.trim();
    check_name(name)?;
    let spread = Spread::parse(range).map_err(|why| format!("{why}; {}", sample::EXAMPLES))?;
    Ok((name.to_owned(), spread))
}

/// `batch sample`: `command` is what was typed.
pub(super) fn run(arguments: &SampleArguments, json: bool, command: &str) -> Result<(), Failure> {
    let options = Options {
        set: arguments.set.clone(),
        precision: arguments.precision,
        substeps: arguments.substeps,
        ..Options::default()
    };
    let inputs = read_files(std::slice::from_ref(&arguments.file), &options);
    let (Some(input), true) = (inputs.list.first(), inputs.troubles.is_empty()) else {
        return Err(Failure::input(inputs.troubles));
    };
    check(arguments, &inputs)?;
    let (study, warnings) = study(arguments, input)?;
    let layout = study.layout();
    let (name, total) = (study.name(), study.rows());
    let range = arguments.shard.rows(total);
    if range.is_empty() {
        let message = format!("there are {total} rows, and {} parts", arguments.shard.count);
        return Err(Problem::new("usage", message).help("make fewer parts").into());
    }
    let page = arguments.report.as_ref().map(|path| FileTarget::new(path, arguments.force)).transpose()?;
    let folder = match &arguments.worst {
        Some(path) => Some(Folder::new(path, arguments.force, &study, input, &inputs)?),
        None => None,
    };
    if !json {
        let warnings = render(input.source(), &input.warnings, Severity::Warning, colours());
        io::stderr().write_all(warnings.as_bytes())?;
    }
    let mut summary = SampleSummary::new(&layout);
    let begun = match &arguments.out {
        None => None,
        Some(path) if arguments.resume => {
            Some(store::resume(path, (&name, &layout), &range, |row| summary.add(row))?)
        }
        Some(path) => Some(store::create(path, arguments.force, &layout)?),
    };
    let (mut file, kept) = begun.map_or((None, 0), |Begun { file, kept }| (file, kept));
    let control = interrupt::control();
    let done = AtomicU64::new(kept as u64);
    let counted = || done.load(Ordering::Relaxed);
    let result = progress::watch_count("loops", counted, range.len() as u64, arguments.quiet, || {
        let rest = range.start + kept..range.end;
        let take = |made: Vec<Cells>| -> Result<(), Ended> {
            made.iter().for_each(|row| summary.add(row));
            file.as_mut().map_or(Ok(()), |file| file.write(&made).map_err(Ended::Failed))
        };
        sample::work(&study, rest, jobs(arguments.jobs), control, &done, take)
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
    let worst = match &folder {
        Some(folder) => folder.write(&study, &summary)?,
        None => Vec::new(),
    };
    let path = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let (out, report) = (path(&arguments.out), path(&arguments.report));
    let made = Sampled {
        kept,
        of: Some(&study),
        warnings: &warnings,
        out: out.as_deref(),
        worst: &worst,
        report: report.as_deref(),
        ..Sampled::of(&name, range.len(), &summary)
    };
    if let Some(target) = &page {
        let page = report::samples_page(&made, &input.name, command);
        target.write(|file| file.write_all(page.as_bytes())).map_err(Failure::internal)?;
    }
    show(&made, json)
}

/// Prints what it comes to; the exit code says whether rows are without a result.
pub(super) fn show(made: &Sampled<'_>, json: bool) -> Result<(), Failure> {
    print(&if json { sample_json(made) } else { sample_table(made) })?;
    let [_, _, refused, failed] = made.summary.counts();
    if refused + failed == 0 { Ok(()) } else { Err(Failure { troubles: Vec::new(), code: EXIT_REFUSED }) }
}

/// What is wrong with the names of files, all at once.
fn check(arguments: &SampleArguments, inputs: &Inputs) -> Result<(), Failure> {
    let mut troubles: Vec<Trouble> = Vec::new();
    let given = [("--out", &arguments.out), ("--report", &arguments.report), ("--worst", &arguments.worst)];
    let read = inputs.files.iter().chain(&arguments.uncertainty);
    let read: Vec<&PathBuf> = read.collect();
    for (i, (option, path)) in given.iter().enumerate() {
        let Some(path) = path else { continue };
        let other = given[..i]
            .iter()
            .find(|(_, other)| other.as_ref().is_some_and(|other| is_same_file(other, path)));
        let message = if path.as_os_str() == "-" {
            format!("`{option} -` is not possible: the standard output has the table")
        } else if read.iter().any(|input| is_same_file(input, path)) {
            format!("`{}` is read by the study and is not overwritten", path.display())
        } else if let Some((other, _)) = other {
            format!("`{other}` and `{option}` are the same file `{}`", path.display())
        } else {
            continue;
        };
        troubles.push(Problem::new("file", message).help(format!("give `{option}` another name")).into());
    }
    if troubles.is_empty() { Ok(()) } else { Err(Failure::input(troubles)) }
}

/// The study, and what of it is probably not meant.
fn study(arguments: &SampleArguments, input: &Input) -> Result<(SampleStudy, Vec<String>), Failure> {
    let [case] = &*input.cases else {
        let problem = Problem::new("usage", format!("`{}` is a sweep: it has several cases", input.name));
        return Err(problem.help("take the `[sweep]` away; `--set` chooses a value").into());
    };
    let mut wishes = Vec::new();
    let of_file = |path: &Path| -> Result<SourceText, Problem> {
        let (name, text) = input::read_uncertainty(path)?;
        Ok(SourceText { name, text })
    };
    let extra = arguments.uncertainty.as_deref().map(of_file).transpose()?;
    for (source, is_alone) in [(Some(&input.source), false), (extra.as_ref(), true)] {
        let Some(source) = source else { continue };
        let list = uncertainty(&source.text, is_alone)
            .map_err(|faults| Failure::input(vec![Trouble::Scenario(source.clone(), faults)]))?;
        wishes.extend(list.into_iter().map(|uncertain| (uncertain.name, uncertain.spread)));
    }
    wishes.extend(arguments.vary.iter().cloned());
    let quantities = quantities(&case.scenario, &wishes).map_err(|faults| {
        let problem = |(name, why): (String, String)| Problem::new("uncertainty", format!("`{name}`: {why}"));
        Failure::input(faults.into_iter().map(|fault| problem(fault).into()).collect())
    })?;
    if quantities.is_empty() && case.scenario.noise.is_none() {
        let problem = Problem::new("usage", "nothing is drawn: all samples would be the same");
        let help =
            "say what is uncertain: `--vary gain=+-20% --vary lag=+-20%`, or `[uncertainty]` in the file";
        return Err(problem.help(help).into());
    }
    let missed = quantities.iter().filter(|quantity| quantity.spread.misses());
    let warnings = missed.map(|quantity| {
        let (name, [nominal, from, to]) =
            (&quantity.name, [quantity.nominal, quantity.ends.0, quantity.ends.1].map(show_short));
        format!(
            "{name} is drawn from {from} to {to}, its nominal value is {nominal}: numbers without a unit are multiples of that, `s` or `abs` behind them makes them values"
        )
    });
    let warnings = warnings.collect();
    let drawn = Seeded {
        quantities,
        samples: usize::try_from(arguments.samples).unwrap_or(usize::MAX),
        seed: arguments.seed,
        precision: arguments.precision.into(),
    };
    let study = SampleStudy::new(case.scenario.clone(), drawn)
        .map_err(|why| Failure::refused(Problem::new("refused", why)))?;
    Ok((study, warnings))
}
