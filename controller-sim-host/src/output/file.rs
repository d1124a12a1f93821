//! Files that are either written whole or not at all, and never over another one unless asked.

use super::Problem;
use super::draft::{Draft, publish};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Why a file could not be written.
pub type FileError = Problem;

/// A file that may be written: checked before the work that fills it begins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileTarget {
    /// As it was given: for messages.
    path: PathBuf,
    /// Without links: a link stays a link, what it points at is replaced.
    real: PathBuf,
    force: bool,
}

impl FileTarget {
    /// The file `path`; `force` allows to replace a file that exists.
    ///
    /// # Errors
    /// The file exists and `force` is not given; it is a directory or a device; its folder does not exist.
    pub fn new(path: &Path, force: bool) -> Result<Self, FileError> {
        let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let target = Self { path: path.to_owned(), real, force };
        target.check()?;
        let folder = target.folder();
        if target.real.file_name().is_none() {
            return Err(Problem::new("file", format!("`{}` is not a file name", target.path.display())));
        }
        if !folder.is_dir() {
            let message = format!("the folder of `{}` does not exist", target.path.display());
            return Err(
                Problem::new("file", message).help(format!("create it: mkdir -p {}", folder.display()))
            );
        }
        Ok(target)
    }

    /// The first of `demo.toml`, `demo-2.toml`, `demo-3.toml`, ... that does not exist; with `force` the
    /// first one.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn next_free(path: &Path, force: bool) -> Result<Self, FileError> {
        if force || fs::symlink_metadata(path).is_err() {
            return Self::new(path, force);
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let extension = path.extension().map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
        let free = (2..10_000)
            .map(|n| path.with_file_name(format!("{stem}-{n}{extension}")))
            .find(|candidate| fs::symlink_metadata(candidate).is_err());
        match free {
            Some(free) => Self::new(&free, false),
            None => Self::new(path, false),
        }
    }

    /// The file's path, as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder it is in.
    pub(super) fn folder(&self) -> PathBuf {
        match self.real.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        }
    }

    /// Whether it may be written, now.
    pub(super) fn check(&self) -> Result<(), FileError> {
        let Ok(found) = fs::metadata(&self.real) else { return Ok(()) };
        let name = self.path.display();
        if !found.is_file() {
            let message = format!("`{name}` is not a regular file");
            return Err(Problem::new("file", message).help("give the name of a file"));
        }
        if !self.force {
            let message = format!("`{name}` exists and is not overwritten");
            return Err(Problem::new("file-exists", message).help("choose another name, or add `--force`"));
        }
        Ok(())
    }

    /// Begins the file: what is written goes to a temporary file in the same folder until it is [published](super::publish).
    ///
    /// # Errors
    /// What the system reports.
    pub fn create(&self) -> Result<Draft, FileError> {
        Draft::create(self)
    }

    /// Fills the file at once.
    ///
    /// # Errors
    /// What `fill` or the system reports; nothing is left behind then, and a file that existed is as before.
    pub fn write(&self, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        let mut draft = self.create()?;
        fill(&mut draft).map_err(|error| self.failed(&error))?;
        publish(vec![draft.complete()?])
    }

    /// That the file cannot be written.
    #[must_use]
    pub fn failed(&self, error: &dyn std::fmt::Display) -> FileError {
        Problem::new("file", format!("cannot write `{}`: {error}", self.path.display()))
    }

    /// What is replaced or made, without links.
    pub(super) fn real(&self) -> &Path {
        &self.real
    }
}

/// Whether two names are those of one file, through links, too; also of one that does not exist yet.
#[must_use]
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let identity = |path: &Path| fs::metadata(path).ok().map(|found| (found.dev(), found.ino()));
        if let (Some(a), Some(b)) = (identity(a), identity(b)) {
            return a == b;
        }
    }
    matches!((absolute(a), absolute(b)), (Some(a), Some(b)) if a == b)
}

/// A name without links, whether the file exists or is yet to be made.
fn absolute(path: &Path) -> Option<PathBuf> {
    let through = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    };
    path.canonicalize().ok().or_else(|| through(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("controller-sim-file-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a temporary folder");
        folder
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = folder("failed");
        let target = FileTarget::new(&folder.join("a.csv"), false).expect("free");
        let failure = target.write(|to| {
            to.write_all(b"half")?;
            Err(io::Error::other("the disc is full"))
        });
        assert!(failure.expect_err("an error").message.contains("the disc is full"));
        assert_eq!(fs::read_dir(&folder).expect("readable").count(), 0);
        fs::remove_dir_all(&folder).expect("removable");
    }

    #[test]
    fn two_names_of_a_file_that_is_yet_to_be_made() {
        let folder = folder("same");
        let (a, b) = (
            folder.join("new.csv"),
            folder.join("..").join(folder.file_name().expect("a name")).join("new.csv"),
        );
        assert!(is_same_file(&a, &b));
        assert!(!is_same_file(&a, &folder.join("other.csv")));
        fs::remove_dir_all(&folder).expect("removable");
    }

    /// The second file cannot take its name any more: the first one does not appear either.
    #[test]
    fn files_are_published_together_or_not_at_all() {
        let folder = folder("together");
        let targets = ["a", "b"].map(|name| FileTarget::new(&folder.join(name), false).expect("free"));
        let complete = targets.iter().map(|target| {
            let mut draft = target.create().expect("a temporary file");
            draft.write_all(b"new").expect("writable");
            draft.complete().expect("complete")
        });
        let complete = complete.collect();
        fs::write(folder.join("b"), "mine").expect("writable");
        let error = publish(complete).expect_err("it exists now");
        assert_eq!(error.code, "file-exists");
        assert_eq!(fs::read_dir(&folder).expect("readable").count(), 1);
        assert_eq!(fs::read_to_string(folder.join("b")).expect("readable"), "mine");
        fs::remove_dir_all(&folder).expect("removable");
    }

    #[test]
    fn a_device_is_never_replaced() {
        if Path::new("/dev/null").exists() {
            let error = FileTarget::new(Path::new("/dev/null"), true).expect_err("a device");
            assert!(error.message.contains("regular file"));
        }
    }
}
