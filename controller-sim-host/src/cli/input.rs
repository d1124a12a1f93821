//! Reading the text of a scenario from a file or the standard input.

use crate::output::Problem;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Longest text, in bytes: a scenario is written by a person.
const LONGEST: u64 = 16 << 20;

/// The name and the text of the scenario at `path`; `-` is the standard input.
pub(super) fn read(path: &Path) -> Result<(String, String), Problem> {
    let (name, bytes) = if path.as_os_str() == "-" {
        ("<stdin>".to_owned(), read_all(io::stdin().lock()))
    } else {
        let name = path.display().to_string();
        check_kind(path, &name)?;
        (name, File::open(path).and_then(read_all))
    };
    let bytes = bytes.map_err(|error| {
        let problem = Problem::new("file", format!("cannot read `{name}`: {error}"));
        match error.kind() {
            io::ErrorKind::NotFound => problem.help("write a first scenario by `controller-sim demo --save`"),
            _ => problem,
        }
    })?;
    if bytes.len() as u64 > LONGEST {
        return Err(Problem::new(
            "file",
            format!("`{name}` is longer than {LONGEST} bytes: it is no scenario"),
        ));
    }
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

/// A directory has no text, and opening a pipe waits for a writer that may never come.
fn check_kind(path: &Path, name: &str) -> Result<(), Problem> {
    let Ok(found) = fs::metadata(path) else { return Ok(()) };
    if found.is_dir() {
        let problem = Problem::new("file", format!("`{name}` is a directory"));
        return Err(problem.help("give a scenario file in it"));
    }
    if !found.is_file() {
        let problem = Problem::new("file", format!("`{name}` is not a regular file"));
        return Err(problem.help("to read from a pipe: `controller-sim run -`"));
    }
    Ok(())
}

fn read_all(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(LONGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
