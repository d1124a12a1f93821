//! The record of a loop: time, set-point, measurement and output from a CSV file.

use super::Failure;
use super::wish::positive;
use crate::log::{Column, Role, read};
use crate::output::{Problem, Trouble};
use crate::scenario::{Fault, SourceText, closest};
use clap::Args;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Longest file, in bytes.
const LONGEST: u64 = 256 << 20;

/// Which column is which, and which controller of several.
#[derive(Debug, Default, Args)]
pub(super) struct Columns {
    /// Column of the times: its name, or its number from 1
    #[arg(long, value_name = "COL")]
    pub(super) time: Option<String>,
    /// Column of the set-point; may be missing
    #[arg(long, value_name = "COL")]
    pub(super) setpoint: Option<String>,
    /// Column of the measurement, the output of the process
    #[arg(long, value_name = "COL")]
    pub(super) output: Option<String>,
    /// Column of the controller's output, the input of the process
    #[arg(long, value_name = "COL")]
    pub(super) input: Option<String>,
    /// The rows are this far apart [s]: for a log without times
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "time")]
    pub(super) log_ts: Option<f64>,
    /// The controller, when a file of `run --csv` has several
    #[arg(long, value_name = "NAME")]
    pub(super) controller: Option<String>,
}

/// A record that was read.
#[derive(Debug)]
pub(super) struct Recorded {
    /// The lines that were read, for messages.
    pub(super) source: SourceText,
    pub(super) t: Vec<f64>,
    /// Empty when there is none.
    pub(super) setpoint: Vec<f64>,
    pub(super) output: Vec<f64>,
    pub(super) input: Vec<f64>,
    /// What stands above measurement and output.
    pub(super) names: (String, String),
    pub(super) remarks: Vec<Fault>,
    controller: Option<String>,
    /// Times and modes, when there is a column of modes.
    modes: Vec<(f64, String)>,
}

impl Recorded {
    pub(super) fn read(path: &Path, columns: &Columns) -> Result<Self, Failure> {
        let (name, text) = load(path)?;
        let run = of_run(&name, &text, columns.controller.as_deref())?;
        let (controller, modes, text) = match run {
            Some(Chosen { controller, modes, lines }) => (Some(controller), modes, lines),
            None => (None, Vec::new(), text),
        };
        let column = |text: &Option<String>| text.as_deref().map_or(Column::Usual, Column::from_text);
        let log_ts = columns.log_ts;
        let time = match log_ts {
            Some(_) => Role { required: false, usual: &[], ..Role::time(Column::Usual) },
            None => Role::time(column(&columns.time)),
        };
        let roles = [
            time,
            Role::input(column(&columns.input)),
            Role::output(column(&columns.output)),
            Role::setpoint(column(&columns.setpoint)),
        ];
        let source = SourceText { name, text };
        let log = match read(&source.name, &source.text, &roles) {
            Ok(log) => log,
            Err(fault) => return Err(Failure::input(vec![Trouble::Scenario(source, vec![fault])])),
        };
        let mut columns = log.columns.into_iter().map(Option::unwrap_or_default);
        let mut next = || columns.next().unwrap_or_default();
        let (input, output, setpoint) = (next(), next(), next());
        let title = |k: usize| log.titles.get(k).cloned().unwrap_or_default();
        let names = (title(2), title(1));
        let t = match log_ts {
            Some(ts) => (0..log.times.len()).map(|row| row as f64 * ts).collect(),
            None => log.times,
        };
        let remarks = log.remarks;
        Ok(Self { source, t, setpoint, output, input, names, remarks, controller, modes })
    }

    /// What the record is called: its file, and which controller of several.
    pub(super) fn name(&self) -> String {
        match &self.controller {
            Some(controller) if !controller.is_empty() => format!("{}, {controller}", self.source.name),
            _ => self.source.name.clone(),
        }
    }

    /// The first sample at `t` or later.
    pub(super) fn sample(&self, option: &str, t: f64) -> Result<usize, Problem> {
        let at = self.t.partition_point(|&own| own < t);
        let (Some(first), Some(last)) = (self.t.first(), self.t.last()) else { return Ok(0) };
        if at >= self.t.len() || t < *first {
            let message = format!("`{option} {t}` is not a time of the record");
            return Err(Problem::new("usage", message).help(format!("it lasts from {first} s to {last} s")));
        }
        Ok(at)
    }

    /// The first sample that the column of modes has in automatic after the step at `step` [s]; `None` when there are no
    /// modes or the step was not in manual.
    pub(super) fn back_in_auto(&self, step: f64) -> Option<usize> {
        let at = self.modes.partition_point(|(t, _)| *t < step);
        self.modes.get(at).filter(|(_, mode)| mode == "manual")?;
        let auto = self.modes[at..].iter().find(|(_, mode)| mode != "manual")?;
        self.sample("", auto.0).ok()
    }
}

/// Name and text of the file; `-` is the standard input. What is no UTF-8 is taken as Latin-1, as older loggers write it.
fn load(path: &Path) -> Result<(String, String), Problem> {
    let all = |from: &mut dyn Read| -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        from.take(LONGEST + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let (name, bytes) = if path.as_os_str() == "-" {
        ("<stdin>".to_owned(), all(&mut io::stdin().lock()))
    } else {
        let name = path.display().to_string();
        // Opening a pipe waits for a writer that may never come.
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            let problem = Problem::new("file", format!("`{name}` is not a regular file"));
            return Err(problem.help("give a CSV file, or `-` for the standard input"));
        }
        (name, File::open(path).and_then(|mut file| all(&mut file)))
    };
    let bytes = bytes.map_err(|error| Problem::new("file", format!("cannot read `{name}`: {error}")))?;
    if bytes.len() as u64 > LONGEST {
        return Err(Problem::new("file", format!("`{name}` is longer than 256 MiB")));
    }
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| char::from(byte)).collect());
    Ok((name, text))
}

/// What a file of `run --csv` has of one controller.
struct Chosen {
    controller: String,
    modes: Vec<(f64, String)>,
    /// The header and its lines.
    lines: String,
}

/// The lines of one controller of a file of `run --csv`; `None` of any other file.
fn of_run(name: &str, text: &str, wanted: Option<&str>) -> Result<Option<Chosen>, Problem> {
    let bad = |message: String| Problem::new("recording", message);
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let mut record = StringRecord::new();
    let header = match reader.read_record(&mut record) {
        Ok(true) => record.clone(),
        _ => StringRecord::new(),
    };
    let column = |wanted: &str| header.iter().position(|cell| cell == wanted);
    let (Some(controller), Some(time), Some(mode)) = (column("controller"), column("t"), column("mode"))
    else {
        return match wanted {
            Some(_) => Err(bad(format!("`{name}` is no file of `run --csv`: it has no controllers"))
                .help("leave `--controller` out")),
            None => Ok(None),
        };
    };
    if column("scenario").is_some() {
        return Err(bad(format!("`{name}` has several runs")).help("write a CSV file of a single run"));
    }
    let first = text.lines().next().unwrap_or("");
    let mut names: Vec<String> = Vec::new();
    let mut chosen = Chosen { controller: String::new(), modes: Vec::new(), lines: format!("{first}\n") };
    let mut start = reader.position().byte() as usize;
    while reader.read_record(&mut record).is_ok_and(|more| more) {
        let end = reader.position().byte() as usize;
        let line = text.get(start..end).unwrap_or("");
        start = end;
        let Some(own) = record.get(controller) else { continue };
        if names.last().is_none_or(|last| last != own) {
            names.push(own.to_owned());
        }
        if wanted.is_none_or(|wanted| wanted == own) {
            chosen.controller = own.to_owned();
            chosen.lines.push_str(line);
            if let (Some(Ok(t)), Some(mode)) = (record.get(time).map(str::parse), record.get(mode)) {
                chosen.modes.push((t, mode.to_owned()));
            }
        }
    }
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let listing = || known.iter().map(|one| format!("\"{one}\"")).collect::<Vec<_>>().join(", ");
    match wanted {
        None if names.len() > 1 => Err(bad(format!("`{name}` has {} controllers", names.len()))
            .help(format!("choose one by `--controller`: {}", listing()))),
        Some(wanted) if !known.contains(&wanted) => {
            let help = match closest(wanted, &known) {
                Some(meant) => format!("did you mean \"{meant}\"?"),
                None => format!("there are {}", listing()),
            };
            Err(Problem::new("unknown-name", format!("`{name}` has no controller `{wanted}`")).help(help))
        }
        _ => {
            // The name says nothing when there is no other.
            if names.len() == 1 {
                chosen.controller.clear();
            }
            Ok(Some(chosen))
        }
    }
}
