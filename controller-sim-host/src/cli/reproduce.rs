//! `reproduce`: the tables and figures of the papers, computed again.

use super::arguments::Options;
use super::run::run_inputs;
use super::scenarios::read_built_in;
use super::{Failure, examples, interrupt, print, progress};
use crate::demo;
use crate::output::{
    FileTarget, Problem, Written, drawn_json, figures_json, figures_table, is_same_file, reproduced_json,
    reproduced_table, sheet_csv,
};
use crate::report::{sheet_page, sheet_svg};
use crate::reproduce::{
    DrawError, Figure, Paper, Report, ReproduceError, Selection, Way, count, draw, figure_named, names,
    reproduce_with,
};
use clap::{ArgGroup, Args, ValueEnum, ValueHint};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Args)]
#[command(after_help = examples::REPRODUCE, group = ArgGroup::new("pictures").multiple(true))]
pub(super) struct ReproduceArguments {
    /// The tables of one paper
    #[arg(long, value_enum)]
    paper: Option<PaperName>,
    /// One table: its number in the paper, or its name
    #[arg(long, value_name = "NAME")]
    table: Option<String>,
    /// List every figure of the papers: what draws it, or why nothing can
    #[arg(long, conflicts_with_all = ["paper", "table", "figure", "pictures"])]
    figures: bool,
    /// Draw this figure, such as `dob-10`
    #[arg(long, value_name = "NAME", requires = "pictures", conflicts_with_all = ["paper", "table"])]
    figure: Option<String>,
    /// Write the figure as a page for the browser
    #[arg(long, value_name = "FILE", group = "pictures", requires = "figure", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Write the figure as a picture; of several runs NAME-1.svg, NAME-2.svg, ...
    #[arg(long, value_name = "FILE", group = "pictures", requires = "figure", value_hint = ValueHint::FilePath)]
    svg: Option<PathBuf>,
    /// Write the numbers of the figure to this file
    #[arg(long, value_name = "FILE", group = "pictures", requires = "figure", value_hint = ValueHint::FilePath)]
    csv: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, requires = "figure")]
    force: bool,
    /// No progress
    #[arg(long, short)]
    quiet: bool,
}

/// A paper by its short name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PaperName {
    /// Vrančić & Huba 2021: MOMI, DRMO, disturbance estimator
    De,
    /// Tena et al. 2022: PI with disturbance observer
    Dob,
    /// Airikka 2021: PI for load disturbances
    Pi,
}

impl From<PaperName> for Paper {
    fn from(name: PaperName) -> Self {
        match name {
            PaperName::De => Self::De,
            PaperName::Dob => Self::Dob,
            PaperName::Pi => Self::Pi,
        }
    }
}

/// `reproduce`: `command` is what was typed.
pub(super) fn run(arguments: &ReproduceArguments, json: bool, command: &str) -> Result<(), Failure> {
    if arguments.figures {
        return Ok(print(&if json { figures_json() } else { figures_table() })?);
    }
    if let Some(name) = &arguments.figure {
        return figure(name, arguments, json, command);
    }
    let selection = Selection { paper: arguments.paper.map(Paper::from), table: arguments.table.clone() };
    let (control, done) = (interrupt::control(), AtomicU64::new(0));
    let total = u64::try_from(count(&selection)).unwrap_or(u64::MAX);
    let counted = || done.load(Ordering::Relaxed);
    let report = progress::watch_count("tables", counted, total, arguments.quiet, || {
        reproduce_with(&selection, control, &done)
    });
    let report = report.map_err(|error| match error {
        ReproduceError::NoTable => unknown(&selection).into(),
        ReproduceError::Stopped => Failure::stopped(),
    })?;
    print(&if json { reproduced_json(&report) } else { reproduced_table(&report) })?;
    outcome(&report)
}

/// Draws a figure.
fn figure(name: &str, arguments: &ReproduceArguments, json: bool, command: &str) -> Result<(), Failure> {
    let Some(figure) = figure_named(name) else {
        let problem = Problem::new("unknown-name", format!("there is no figure `{name}`"));
        return Err(problem
            .help("see `controller-sim reproduce --figures`; names are such as `dob-10`")
            .into());
    };
    match figure.way() {
        Way::Not(why) => {
            let message = format!("{} cannot be drawn: {why}", figure.name());
            Err(Failure::refused(
                Problem::new("refused", message).help("see `controller-sim reproduce --figures`"),
            ))
        }
        Way::Run(scenario) => {
            let options = Options {
                report: arguments.report.clone(),
                svg: arguments.svg.clone(),
                csv: arguments.csv.clone(),
                force: arguments.force,
                quiet: arguments.quiet,
                ..Options::default()
            };
            let found = demo::named(scenario).unwrap_or_default();
            run_inputs(&read_built_in(&found, &options), &options, None, json, command)
        }
        Way::Draw => drawn(figure, arguments, json, command),
    }
}

fn drawn(figure: &Figure, arguments: &ReproduceArguments, json: bool, command: &str) -> Result<(), Failure> {
    let wanted = [("report", &arguments.report), ("svg", &arguments.svg), ("csv", &arguments.csv)];
    let wanted: Vec<(&str, &PathBuf)> =
        wanted.into_iter().filter_map(|(kind, path)| Some((kind, path.as_ref()?))).collect();
    let (mut targets, mut troubles) = (Vec::new(), Vec::new());
    for (i, (kind, path)) in wanted.iter().enumerate() {
        if wanted[..i].iter().any(|(_, other)| is_same_file(other, path)) {
            let message = format!("`{}` is asked for twice", path.display());
            troubles.push(Problem::new("file", message).help("give one of them another name").into());
        } else if path.as_os_str() == "-" {
            let problem = Problem::new("file", format!("`--{kind} -` is not possible"));
            troubles.push(problem.help("give a file").into());
        } else {
            match FileTarget::new(path, arguments.force) {
                Ok(target) => targets.push((*kind, target)),
                Err(error) => troubles.push(error.into()),
            }
        }
    }
    if !troubles.is_empty() {
        return Err(Failure::input(troubles));
    }
    let sheet = draw(figure, interrupt::control()).map_err(|error| match error {
        DrawError::Stopped => Failure::stopped(),
        DrawError::Failed(why) => Failure::internal(Problem::new("refused", why)),
    })?;
    let mut files = Vec::new();
    for (kind, target) in &targets {
        let text = match *kind {
            "report" => sheet_page("Figure of a paper, computed again", &sheet, command),
            "svg" => sheet_svg(&sheet),
            _ => sheet_csv(&sheet),
        };
        target.write(|file| file.write_all(text.as_bytes())).map_err(Failure::internal)?;
        files.push(Written { kind, path: target.path().display().to_string(), run: None });
    }
    if json {
        return Ok(print(&drawn_json(figure, &sheet, &files))?);
    }
    let mut shown = format!("{}\n", sheet.title);
    files.iter().for_each(|file| shown.push_str(&format!("wrote {}\n", file.path)));
    Ok(print(&shown)?)
}

/// What differs was printed; only the exit code is left to tell it.
fn outcome(report: &Report) -> Result<(), Failure> {
    if report.differing() > 0 { Err(Failure::differs()) } else { Ok(()) }
}

fn unknown(selection: &Selection) -> Problem {
    let name = selection.table.as_deref().unwrap_or_default();
    let of = selection.paper.map_or(String::new(), |paper| format!(" of {}", paper.source()));
    let mut known: Vec<&str> = Vec::new();
    for (paper, name) in names() {
        if selection.paper.is_none_or(|wanted| wanted == paper) && !known.contains(&name) {
            known.push(name);
        }
    }
    Problem::new("unknown-name", format!("there is no table `{name}`{of}"))
        .help(format!("there are {}", known.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::reproduce;
    use crate::simulate::Control;

    #[test]
    fn a_number_that_is_not_true_ends_with_code_1() {
        let selection = Selection { paper: Some(Paper::De), table: Some("7".to_owned()) };
        let mut report = reproduce(&selection, &Control::new()).expect("not stopped");
        assert!(outcome(&report).is_ok());
        report.tables[0].cells[1].truth = Some(101.0);
        let failure = outcome(&report).expect_err("a difference");
        assert_eq!((failure.code, failure.troubles.len()), (1, 0));
    }
}
