//! `batch map`: one rule on a grid of two parameters.

use super::batch::{Ended, jobs, method, shard, stopped};
use super::{EXIT_REFUSED, Failure, examples, interrupt, print, progress, wish};
use crate::batch::map::{Axis, MapFault, MapStudy, MapValues, Metric, Parameter, Template};
use crate::batch::store::{self, Begun};
use crate::batch::{Layout, Row, Shard};
use crate::output::{FileTarget, Mapped, Problem, Trouble, Written, is_same_file, map_json, map_table};
use crate::report::{self, MapLook};
use crate::scenario::{Fault, SourceText, code};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, ValueHint};
use controller_design::design::Method;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// The plant when none is given: first order with dead time, `L` its normalised dead time, as in Tena et al. 2022.
const PLANT: &str = "exp(-L*s)/(1+(1-L)*s)";
/// Most points of a map.
const MOST: usize = 1_000_000;

#[derive(Debug, Args)]
#[command(after_help = examples::BATCH_MAP, group = ArgGroup::new("written").multiple(true))]
pub(super) struct MapArguments {
    /// The plant, an expression in s in which letters may stand for numbers; that of the default has the normalised dead time L
    #[arg(long, value_name = "EXPR", default_value = PLANT, allow_hyphen_values = true)]
    plant: String,
    /// The tuning rule
    #[arg(long, value_name = "NAME", value_parser = method(), default_value = "dob")]
    method: Method,
    /// Show ratios: each value over that of this rule at the same point
    #[arg(long, value_name = "NAME", value_parser = method())]
    over: Option<Method>,
    /// The axis from left to right: a letter of the plant or an option of the rule, NAME=FROM:TO:COUNT, `:log` for equal
    /// ratios, or a list NAME=1,2,5
    #[arg(long, value_name = "AXIS", value_parser = Axis::read)]
    x: Axis,
    /// The upright axis
    #[arg(long, value_name = "AXIS", value_parser = Axis::read)]
    y: Axis,
    /// A map for each of these values of a third one
    #[arg(long, value_name = "AXIS", value_parser = Axis::read)]
    each: Option<Axis>,
    /// What is the same everywhere; may be given more than once
    #[arg(long, value_name = "NAME=VALUE", value_parser = value, allow_hyphen_values = true)]
    at: Vec<(Parameter, f64)>,
    /// What is drawn, columns of the rows, separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = metric(), default_value = "load_iae")]
    metric: Vec<Metric>,
    /// Simulate the sampled loop with this period \[s\]; if not given, margins and indices are of the continuous loop
    #[arg(long, value_name = "S", value_parser = wish::positive)]
    ts: Option<f64>,
    /// Indices up to this time after each step \[s\]; if not given, over an infinite horizon
    #[arg(long, value_name = "S", value_parser = wish::positive)]
    horizon: Option<f64>,
    /// Write the maps to this file as a picture
    #[arg(long, value_name = "FILE", group = "written", value_hint = ValueHint::FilePath)]
    svg: Option<PathBuf>,
    /// Write a page with the maps to this file, for the browser
    #[arg(long, value_name = "FILE", group = "written", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Values of the contour lines; if not given, round ones
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = level, allow_hyphen_values = true)]
    levels: Vec<f64>,
    /// What stands beside the axis from left to right, with its unit
    #[arg(long, value_name = "TEXT", value_parser = label)]
    x_label: Option<String>,
    /// What stands beside the upright axis
    #[arg(long, value_name = "TEXT", value_parser = label)]
    y_label: Option<String>,
    /// Write the rows to this file as they come, .csv or .parquet
    #[arg(long, value_name = "FILE", group = "written", value_hint = ValueHint::FilePath)]
    out: Option<PathBuf>,
    /// Go on with the file where an interrupted run has left it; of a complete one draw the maps
    #[arg(long, requires = "out")]
    resume: bool,
    /// Replace files that exist
    #[arg(long, requires = "written")]
    force: bool,
    /// Do this part of the rows only, such as 2/4; `batch merge` joins the parts
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: Shard,
    /// Threads; all processors if not given. The rows are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// No progress
    #[arg(long, short)]
    quiet: bool,
}

fn metric() -> impl TypedValueParser<Value = Metric> {
    let words = Metric::ALL.map(|metric| PossibleValue::new(metric.name).help(metric.title));
    PossibleValuesParser::new(words).try_map(|name| Metric::named(&name).ok_or("no such column"))
}

fn value(text: &str) -> Result<(Parameter, f64), String> {
    let axis = Axis::read(text).map_err(|why| match text.split_once('=') {
        Some((_, number)) if !number.contains([':', ',']) => why,
        _ => "write NAME=VALUE, for example `ms=1.4`".to_owned(),
    })?;
    match *axis.values {
        [value] => Ok((axis.parameter, value)),
        _ => Err("one value is the same everywhere; for several give an axis".to_owned()),
    }
}

fn level(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err("write numbers, for example `0.5,1,2`".to_owned()),
    }
}

fn label(text: &str) -> Result<String, String> {
    if (1..=80).contains(&text.trim().chars().count()) && !text.contains(char::is_control) {
        Ok(text.trim().to_owned())
    } else {
        Err("write 1 to 80 characters on one line".to_owned())
    }
}

/// `batch map`: `command` is what was typed.
pub(super) fn run(arguments: &MapArguments, json: bool, command: &str) -> Result<(), Failure> {
    let study = MapStudy {
        plant: Template::new(&arguments.plant),
        method: arguments.method,
        over: arguments.over,
        x: arguments.x.clone(),
        y: arguments.y.clone(),
        each: arguments.each.clone(),
        at: arguments.at.clone(),
        ts: arguments.ts,
        horizon: arguments.horizon,
    };
    let pictures = check(arguments, &study)?;
    let (name, total) = (study.name(), study.rows());
    let range = arguments.shard.rows(total);
    if range.is_empty() {
        let message = format!("there are {total} rows, and {} parts", arguments.shard.count);
        return Err(Problem::new("usage", message).help("make fewer parts").into());
    }
    let layout = Layout::points();
    let mut values = MapValues::new(&study, &arguments.metric);
    let begun = match &arguments.out {
        None => None,
        Some(path) if arguments.resume => {
            Some(store::resume(path, (&name, &layout), &range, |row| values.add(&Row::from(row.clone())))?)
        }
        Some(path) => Some(store::create(path, arguments.force, &layout)?),
    };
    let (mut file, kept) = begun.map_or((None, 0), |Begun { file, kept }| (file, kept));
    let (control, done) = (interrupt::control(), AtomicU64::new(kept as u64));
    let counted = || done.load(Ordering::Relaxed);
    let result = progress::watch_count("rows", counted, range.len() as u64, arguments.quiet, || {
        let todo = range.start + kept..range.end;
        study.work(todo, jobs(arguments.jobs), control, &done, |made| -> Result<(), Ended> {
            made.iter().for_each(|row| values.add(row));
            match &mut file {
                Some(file) => file.write(&made).map_err(Ended::Failed),
                None => Ok(()),
            }
        })
    });
    match result {
        Err(Ended::Stopped) => {
            return Err(stopped(file.as_ref(), values.counts().iter().sum(), range.len()));
        }
        Err(Ended::Failed(problem)) => return Err(Failure::internal(problem)),
        Ok(()) => {}
    }
    if let Some(file) = file {
        file.finish().map_err(Failure::internal)?;
    }
    let look = MapLook {
        x_label: arguments.x_label.clone().or_else(|| known_label(arguments, &study.x)),
        y_label: arguments.y_label.clone().or_else(|| known_label(arguments, &study.y)),
        levels: arguments.levels.clone(),
        ..MapLook::default()
    };
    let sheet = report::map_sheet(&study, &values, &look);
    for (kind, target) in &pictures {
        let text = match *kind {
            "svg" => report::sheet_svg(&sheet),
            _ => report::map_page(&sheet, &values, command),
        };
        target.write(|file| file.write_all(text.as_bytes())).map_err(Failure::internal)?;
    }
    let rows = arguments.out.iter().map(|path| (store::kind(path), path.display().to_string()));
    let drawn = pictures.iter().map(|(kind, target)| (*kind, target.path().display().to_string()));
    let files: Vec<Written> =
        rows.chain(drawn).map(|(kind, path)| Written { kind, path, run: None }).collect();
    let made = Mapped { study: &study, rows: range.len(), kept, values: &values, files: &files };
    print(&if json { map_json(&made) } else { map_table(&made) })?;
    let [_, refused, failed] = values.counts();
    if refused + failed == 0 { Ok(()) } else { Err(Failure { troubles: Vec::new(), code: EXIT_REFUSED }) }
}

/// What the letter of the plant that is there without being given stands for.
fn known_label(arguments: &MapArguments, axis: &Axis) -> Option<String> {
    let is_known = arguments.plant == PLANT && axis.parameter == Parameter::Plant("L".to_owned());
    is_known.then(|| "normalised dead time T/(T+\u{3c4})".to_owned())
}

/// What is wrong with what is asked for, all at once; where the pictures go.
fn check(arguments: &MapArguments, study: &MapStudy) -> Result<Vec<(&'static str, FileTarget)>, Failure> {
    let mut troubles: Vec<Trouble> = Vec::new();
    for fault in study.faults() {
        troubles.push(match fault {
            MapFault::Usage(message, help) => Problem::new("usage", message).help(help).into(),
            MapFault::Plant(text, errors) => {
                let fault = |error: &controller_design::model::ExpressionError| Fault {
                    help: error.help.clone(),
                    ..Fault::new(code::EXPRESSION, error.span.start..error.span.end, error.message.clone())
                };
                let name = "<plant with the first values>".to_owned();
                Trouble::Scenario(SourceText { name, text }, errors.iter().map(fault).collect())
            }
        });
    }
    if study.points() > MOST {
        let message = format!("the map has {} points; at most {MOST} are allowed", study.points());
        troubles.push(Problem::new("too-large", message).help("give fewer values").into());
    }
    for (i, metric) in arguments.metric.iter().enumerate() {
        if arguments.metric[..i].contains(metric) {
            let problem = Problem::new("usage", format!("`--metric` has {} twice", metric.name));
            troubles.push(problem.help("give each once").into());
        }
    }
    let mut pictures = Vec::new();
    let wanted = [("svg", &arguments.svg), ("report", &arguments.report)];
    let mut before: Vec<&PathBuf> = arguments.out.iter().collect();
    for (kind, path) in wanted.into_iter().filter_map(|(kind, path)| Some((kind, path.as_ref()?))) {
        if arguments.shard != Shard::WHOLE {
            let problem =
                Problem::new("usage", format!("`--{kind}` needs all rows, and this is a part of them"));
            troubles.push(problem.help("join the parts, then draw them with `--resume`").into());
        } else if let Some(other) = before.iter().find(|other| is_same_file(other, path)) {
            let message = format!("`{}` is asked for twice", other.display());
            troubles.push(Problem::new("file", message).help("give one of them another name").into());
        } else if path.as_os_str() == "-" {
            let problem = Problem::new(
                "file",
                format!("`--{kind} -` is not possible: the standard output has the table"),
            );
            troubles.push(problem.help("give a file").into());
        } else {
            match FileTarget::new(path, arguments.force) {
                Ok(target) => pictures.push((kind, target)),
                Err(problem) => troubles.push(problem.into()),
            }
        }
        before.push(path);
    }
    if arguments.out.as_ref().is_some_and(|out| out.as_os_str() == "-") {
        let problem = Problem::new("file", "`--out -` is not possible: the standard output has the table");
        troubles.push(problem.help("give a file: `--out rows.csv`").into());
    }
    if troubles.is_empty() { Ok(pictures) } else { Err(Failure::input(troubles)) }
}
