//! Reading the text of a scenario or a log from a file or the standard input.

use crate::output::Problem;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Longest text, in bytes: a scenario is written by a person.
const LONGEST: u64 = 16 << 20;

/// Longest list of processes, in bytes.
const LONGEST_LIST: u64 = 256 << 20;

/// Longest log, in bytes.
const LONGEST_LOG: u64 = 512 << 20;

/// A kind of input, for messages.
struct Kind {
    name: &'static str,
    longest: u64,
    missing: &'static str,
    pipe: &'static str,
}

const SCENARIO: Kind = Kind {
    name: "scenario",
    longest: LONGEST,
    missing: "write a first scenario by `controller-sim demo --save`",
    pipe: "to read from a pipe: `controller-sim run -`",
};

const LOG: Kind = Kind {
    name: "log",
    longest: LONGEST_LOG,
    missing: "give the name of a CSV file",
    pipe: "to read from a pipe, give `-`",
};

const PROCESSES: Kind = Kind {
    name: "list of processes",
    longest: LONGEST_LIST,
    missing: "`controller-sim batch --set ah134 --list > my.csv` writes one to begin with",
    pipe: "write it to a file first",
};

const UNCERTAINTY: Kind = Kind {
    name: "file of uncertainties",
    longest: LONGEST,
    missing: "write lines such as `gain = \"+-20 %\"` to it, or use `--vary gain=+-20%`",
    pipe: "write it to a file first",
};

const CARD: Kind = Kind {
    name: "loop card",
    longest: LONGEST,
    missing: "`controller-sim analyze loop.toml --save-card card.toml` writes one",
    pipe: "write it to a file first",
};

/// The name and the text of the scenario at `path`; `-` is the standard input.
pub(super) fn read(path: &Path) -> Result<(String, String), Problem> {
    read_text(path, &SCENARIO)
}

/// The name and the text of the loop card at `path`.
pub(super) fn read_card(path: &Path) -> Result<(String, String), Problem> {
    read_text(path, &CARD)
}

/// The name and the text of the list of processes at `path`.
pub(super) fn read_processes(path: &Path) -> Result<(String, String), Problem> {
    read_text(path, &PROCESSES)
}

/// The name and the text of the file of uncertainties at `path`.
pub(super) fn read_uncertainty(path: &Path) -> Result<(String, String), Problem> {
    read_text(path, &UNCERTAINTY)
}

fn read_text(path: &Path, kind: &Kind) -> Result<(String, String), Problem> {
    let (name, bytes) = load(path, kind)?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok((name, text)),
        Err(error) => {
            let good = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes().iter().take(good).filter(|&&byte| byte == b'\n').count();
            let message = format!("`{name}` is not UTF-8 text: line {line} has a byte that is no character");
            Err(Problem::new("file", message).help("save it as UTF-8"))
        }
    }
}

/// The name and the text of the log at `path`; `-` is the standard input.
pub(super) fn read_log(path: &Path) -> Result<(String, String), Problem> {
    let (name, bytes) = load(path, &LOG)?;
    Ok((name, crate::log::decode(&bytes)))
}

fn load(path: &Path, kind: &Kind) -> Result<(String, Vec<u8>), Problem> {
    let (name, bytes) = if path.as_os_str() == "-" {
        ("<stdin>".to_owned(), read_all(io::stdin().lock(), kind))
    } else {
        let name = path.display().to_string();
        check_kind(path, &name, kind)?;
        (name, File::open(path).and_then(|file| read_all(file, kind)))
    };
    let bytes = bytes.map_err(|error| {
        let problem = Problem::new("file", format!("cannot read `{name}`: {error}"));
        match error.kind() {
            io::ErrorKind::NotFound => problem.help(kind.missing),
            _ => problem,
        }
    })?;
    if bytes.len() as u64 > kind.longest {
        let message = format!("`{name}` is longer than {} bytes: it is no {}", kind.longest, kind.name);
        return Err(Problem::new("file", message));
    }
    Ok((name, bytes))
}

/// A directory has no text, and opening a pipe waits for a writer that may never come.
fn check_kind(path: &Path, name: &str, kind: &Kind) -> Result<(), Problem> {
    let Ok(found) = fs::metadata(path) else { return Ok(()) };
    if found.is_dir() {
        let problem = Problem::new("file", format!("`{name}` is a directory"));
        return Err(problem.help(format!("give a {} file in it", kind.name)));
    }
    if !found.is_file() {
        let problem = Problem::new("file", format!("`{name}` is not a regular file"));
        return Err(problem.help(kind.pipe));
    }
    Ok(())
}

fn read_all(from: impl Read, kind: &Kind) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(kind.longest + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
