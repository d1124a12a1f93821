//! The files that a run writes: checked before it, named at its very end.

use super::arguments::Options;
use super::scenarios::Inputs;
use crate::output::{FileTarget, Problem, Written, is_same_file};
use std::path::{Path, PathBuf};

/// Where the results go besides the standard output.
#[derive(Debug, Default)]
pub(super) struct Targets {
    pub(super) report: Option<FileTarget>,
    /// One for each run.
    pub(super) svg: Vec<FileTarget>,
    pub(super) csv: Option<FileTarget>,
    pub(super) parquet: Option<FileTarget>,
}

/// A file that is asked for, and by which option.
type Wanted = (&'static str, PathBuf);

impl Targets {
    /// The files that `options` asks for of `runs` runs of `inputs`.
    pub(super) fn new(options: &Options, inputs: &Inputs, runs: usize) -> Result<Self, Vec<Problem>> {
        let one = |option, path: &Option<PathBuf>| path.clone().map(|path| (option, path));
        let svg = options.svg.iter().flat_map(|path| numbered(path, runs)).map(|path| ("--svg", path));
        let wanted: Vec<Wanted> = one("--report", &options.report)
            .into_iter()
            .chain(svg)
            .chain(one("--csv", &options.csv))
            .chain(one("--parquet", &options.parquet))
            .collect();
        let (mut targets, mut problems) = (Self::default(), Vec::new());
        // Numbered, its name would be that of a file beside the folder.
        if let Some(path) = options.svg.as_ref().filter(|path| runs > 1 && path.is_dir()) {
            let problem = Problem::new("file", format!("`{}` is a directory", path.display()));
            let example = path.join("plot.svg");
            let help = format!("give the name of a file: `--svg {}`", example.display());
            return Err(vec![problem.help(help)]);
        }
        for (i, (option, path)) in wanted.iter().enumerate() {
            let checked = check(option, path, wanted.get(..i).unwrap_or_default(), inputs);
            match checked.and_then(|()| FileTarget::new(path, options.force)) {
                Ok(target) => match *option {
                    "--report" => targets.report = Some(target),
                    "--svg" => targets.svg.push(target),
                    "--csv" => targets.csv = Some(target),
                    _ => targets.parquet = Some(target),
                },
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() { Ok(targets) } else { Err(problems) }
    }

    /// All of them, for the results.
    pub(super) fn written(&self) -> Vec<Written> {
        let file =
            |kind, run, target: &FileTarget| Written { kind, path: target.path().display().to_string(), run };
        let several = self.svg.len() > 1;
        let report = self.report.iter().map(|target| file("report", None, target));
        let svg = self.svg.iter().enumerate().map(|(i, target)| file("svg", several.then_some(i), target));
        let csv = self.csv.iter().map(|target| file("csv", None, target));
        let parquet = self.parquet.iter().map(|target| file("parquet", None, target));
        report.chain(svg).chain(csv).chain(parquet).collect()
    }
}

fn check(option: &str, path: &Path, before: &[Wanted], inputs: &Inputs) -> Result<(), Problem> {
    let (kind, name) = (option.trim_start_matches('-'), path.display());
    if path.as_os_str() == "-" {
        let message = format!("`{option} -` is not possible: the standard output has the table");
        let ending = if kind == "report" { "html" } else { kind };
        return Err(Problem::new("file", message).help(format!("give a file: `{option} my.{ending}`")));
    }
    if let Some((other, _)) = before.iter().find(|(_, other)| is_same_file(other, path)) {
        let message = format!("`{other}` and `{option}` are the same file `{name}`");
        return Err(Problem::new("file", message).help("give one of them another name"));
    }
    if let Some(i) = inputs.files.iter().position(|input| is_same_file(path, input)) {
        let what = if i < inputs.given { "is the scenario itself" } else { "is read by the scenario" };
        let message = format!("`{name}` {what} and is not overwritten");
        return Err(Problem::new("file", message).help(format!("give the file of `{option}` another name")));
    }
    Ok(())
}

/// The name itself for one run, `NAME-1.svg`, `NAME-2.svg`, ... for several.
fn numbered(path: &Path, runs: usize) -> Vec<PathBuf> {
    if runs <= 1 {
        return vec![path.to_owned()];
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().map_or(String::new(), |ending| format!(".{}", ending.to_string_lossy()));
    (1..=runs).map(|n| path.with_file_name(format!("{stem}-{n}{ending}"))).collect()
}
