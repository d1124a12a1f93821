//! How the files that a scenario names are found.

use super::suggest::closest;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Longest included scenario, in bytes: it is written by a person.
const LONGEST_SCENARIO: u64 = 16 << 20;

/// Longest recording, in bytes.
const LONGEST_RECORDING: u64 = 256 << 20;

/// Where the files come from that a scenario names: included scenarios and recordings.
pub trait Files {
    /// The text of the file `path`, which is relative to the folder of the scenario.
    ///
    /// # Errors
    /// Why there is none: one line for people, without a full stop.
    fn load(&self, path: &str) -> Result<String, String>;
}

/// No files at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn load(&self, path: &str) -> Result<String, String> {
        Err(format!("`{path}` is not read: a scenario cannot name files here"))
    }
}

/// The files of a folder, up to 256 MiB each (`.toml`: 16 MiB).
///
/// ```
/// use controller_sim_host::scenario::{Files, FolderFiles};
/// let files = FolderFiles::beside("scenarios/first.toml".as_ref());
/// assert!(files.load("no such file.csv").expect_err("it is not there").contains("`no such file.csv`"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FolderFiles {
    folder: PathBuf,
}

impl FolderFiles {
    /// The files below `folder`; empty: the working directory.
    #[must_use]
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The files beside the scenario at `path`.
    #[must_use]
    pub fn beside(path: &Path) -> Self {
        Self::new(path.parent().unwrap_or(Path::new("")))
    }

    /// A file of nearly that name in the same folder.
    fn near(full: &Path) -> Option<String> {
        let folder = full.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let wanted = full.file_name()?.to_str()?;
        let mut names: Vec<String> = fs::read_dir(folder)
            .ok()?
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .collect();
        // The order of a directory is that of the file system.
        names.sort_unstable();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        closest(wanted, &names).map(str::to_owned)
    }
}

impl Files for FolderFiles {
    fn load(&self, path: &str) -> Result<String, String> {
        if path.trim().is_empty() {
            return Err("the name of the file is empty".to_owned());
        }
        let full = self.folder.join(path);
        let found = fs::metadata(&full).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                let near =
                    Self::near(&full).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                format!("there is no file `{path}` in the scenario's folder{near}")
            }
            _ => format!("cannot read `{path}`: {error}"),
        })?;
        // Opening a pipe would wait for a writer that may never come.
        if !found.is_file() {
            let what = if found.is_dir() { "a directory" } else { "not a regular file" };
            return Err(format!("`{path}` is {what}"));
        }
        let is_scenario = full.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
        let longest = if is_scenario { LONGEST_SCENARIO } else { LONGEST_RECORDING };
        let too_long = || format!("`{path}` is longer than {} MiB", longest >> 20);
        if found.len() > longest {
            return Err(too_long());
        }
        let mut bytes = Vec::new();
        File::open(&full)
            .and_then(|file| file.take(longest + 1).read_to_end(&mut bytes))
            .map_err(|error| format!("cannot read `{path}`: {error}"))?;
        // A file may grow while it is read.
        if bytes.len() as u64 > longest {
            return Err(too_long());
        }
        String::from_utf8(bytes).map_err(|error| {
            let good = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes().iter().take(good).filter(|&&byte| byte == b'\n').count();
            format!(
                "`{path}` is not UTF-8 text: line {line} has a byte that is no character; save it as UTF-8"
            )
        })
    }
}
