//! `export`: a designed loop as a file for the target.

use super::arguments::{Number, Options, key_and_value};
use super::execute::Job;
use super::scenarios::read_files;
use super::{Failure, colours, examples, print};
use crate::export::{Export, Format, OpenRange, Refused};
use crate::output::{ExportWarnings, FileTarget, Problem, Severity, exported_json, render};
use crate::scenario::{ControllerSpec, Fault, closest};
use clap::{Args, ValueEnum, ValueHint};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Arguments of `export`.
#[derive(Debug, Args)]
#[command(after_help = examples::EXPORT)]
pub(super) struct ExportArguments {
    /// A scenario or design file; `-` reads it from the standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// What to write
    #[arg(long, value_enum)]
    format: Language,
    /// The controller, when the file has several
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Number type of the target
    #[arg(long, value_enum, default_value = "f32")]
    precision: Number,
    /// Samples of delay memory; as many as the dead time needs if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1 << 20))]
    capacity: Option<u32>,
    /// Write to this file instead of the standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    save: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "save")]
    force: bool,
    /// Change a value of the file, for example `controller."DE-MOMI".pid.kp=2`, in quotes of the shell; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
}

/// The languages of targets.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Language {
    /// A Rust module of constants for controller-core
    Rust,
    /// A function block in plain Structured Text of IEC 61131-3, for PLCs that link nothing
    St,
    /// A program in Structured Text that replays a recorded trace through that block and compares
    StTest,
    /// A header of constants for the C interface (ctl.h)
    C,
}

impl From<Language> for Format {
    fn from(language: Language) -> Self {
        match language {
            Language::Rust => Self::Rust,
            Language::St => Self::StructuredText,
            Language::StTest => Self::StructuredTextTest,
            Language::C => Self::C,
        }
    }
}

pub(super) fn run(arguments: &ExportArguments, json: bool) -> Result<(), Failure> {
    let options = Options { set: arguments.set.clone(), ..Options::default() };
    let inputs = read_files(std::slice::from_ref(&arguments.file), &options);
    let mut troubles = inputs.troubles.clone();
    let target = arguments.save.as_ref().map(|path| FileTarget::new(path, arguments.force)).transpose();
    let target = target.unwrap_or_else(|problem| {
        troubles.push(problem.into());
        None
    });
    if !troubles.is_empty() {
        return Err(Failure::input(troubles));
    }
    let jobs = Job::all(&inputs.list, None);
    let [job] = &*jobs else {
        let problem = Problem::new("usage", "a file with a sweep is many loops");
        return Err(problem
            .help("export one of them: take `[sweep]` out and set its value by `--set`")
            .into());
    };
    let spec = chosen(&job.scenario().controllers, arguments.controller.as_deref())?;
    let capacity = arguments.capacity.map(|n| n as usize);
    let export = Export::new(job.scenario(), spec, arguments.precision.into(), capacity);
    let export = export.map_err(|why| refused(spec, &why))?;
    let origin = job.input.name.as_str();
    let origin = Path::new(origin).file_name().map_or(origin.into(), |name| name.to_string_lossy());
    let text = export.text(arguments.format.into(), &origin).map_err(|why| refused(spec, &why))?;
    if let Some(target) = &target {
        target.write(|file| file.write_all(text.as_bytes())).map_err(Failure::internal)?;
    }
    let saved = target.map(|target| target.path().display().to_string());
    let own = job.scenario().controllers.iter().position(|other| std::ptr::eq(other, spec));
    let concerns = |warning: &&Fault| warning.controller.is_none() || warning.controller == own;
    let remarks: Vec<Fault> = job.input.warnings.iter().filter(concerns).cloned().collect();
    let open = open_ranges(&export, arguments.format);
    if json {
        let warnings = ExportWarnings { source: job.input.source(), remarks: &remarks, own: &open };
        let format = arguments.format.into();
        return Ok(print(&exported_json(&export, format, &text, saved.as_deref(), &warnings))?);
    }
    let mut warnings = render(job.input.source(), &remarks, Severity::Warning, colours());
    for problem in &open {
        warnings.push_str(&format!("{}\n\n", problem.as_warning()));
    }
    io::stderr().write_all(warnings.as_bytes())?;
    Ok(print(&saved.map_or(text, |path| format!("wrote {path}\n")))?)
}

/// A warning for each range that a PLC or a C program would take from nowhere.
fn open_ranges(export: &Export<'_>, language: Language) -> Vec<Problem> {
    if matches!(language, Language::Rust) {
        return Vec::new();
    }
    let warning = |range: &OpenRange| {
        let message = format!("`{}` has no `{}`: {}", export.name(), range.key(), range.meaning());
        Problem::new("open-range", message).help(range.help())
    };
    export.open_ranges().iter().map(warning).collect()
}

/// The only controller, or the one with this name.
pub(super) fn chosen<'a>(
    list: &'a [ControllerSpec],
    name: Option<&str>,
) -> Result<&'a ControllerSpec, Problem> {
    let names: Vec<&str> = list.iter().map(|spec| spec.name.trim()).collect();
    let listed = || names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (name, list) {
        (None, [only]) => Ok(only),
        (None, _) => {
            let problem =
                Problem::new("usage", format!("the file has {} controllers: {}", list.len(), listed()));
            Err(problem.help("choose one by `--controller NAME`"))
        }
        (Some(name), _) => list.iter().find(|spec| spec.name.trim() == name.trim()).ok_or_else(|| {
            let problem = Problem::new("usage", format!("no controller is called `{}`", name.trim()));
            problem.help(match closest(name.trim(), &names) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", listed()),
            })
        }),
    }
}

fn refused(spec: &ControllerSpec, why: &Refused) -> Failure {
    let name = spec.name.trim();
    let problem = match why {
        Refused::Cascade => Problem::new("refused", format!("`{name}` is a cascade: two loops, two laws"))
            .help("write each of the two as a controller of its own, then export both"),
        Refused::Adrc => {
            Problem::new("refused", format!("`{name}` is an ADRC, which only `--format rust` writes"))
                .help("use `--format rust`, or close the loop by a PID with a disturbance observer")
        }
        Refused::Faults(faults) => {
            let list: Vec<String> = faults.as_slice().iter().map(ToString::to_string).collect();
            Problem::new("refused", format!("`{name}` cannot run so: {}", list.join("; ")))
                .help("change `--precision`, `--capacity` or the file")
        }
    };
    Failure::refused(problem)
}
