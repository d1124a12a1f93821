//! Files that are either written whole or not at all, and never over another one unless asked.

use super::Problem;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
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

    fn folder(&self) -> PathBuf {
        match self.real.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        }
    }

    fn check(&self) -> Result<(), FileError> {
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

    /// Fills the file: `fill` writes to a temporary file in the same folder, which takes the name at the end.
    ///
    /// # Errors
    /// What `fill` or the system reports; the temporary file is then removed and a file that existed is as
    /// before.
    pub fn write(&self, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        let name = self.real.file_name().unwrap_or_default().to_string_lossy();
        let temporary = self.folder().join(format!(".{name}.{}.tmp", std::process::id()));
        let written = self.fill(&temporary, fill);
        if written.is_err() {
            // The first error is the one to report; that the removal fails, too, adds nothing.
            let _ = fs::remove_file(&temporary);
        }
        written
    }

    fn fill(
        &self,
        temporary: &Path,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), FileError> {
        let failed = |error: io::Error| {
            Problem::new("file", format!("cannot write `{}`: {error}", self.path.display()))
        };
        let file = File::create_new(temporary).map_err(failed)?;
        let mut writer = BufWriter::new(file);
        fill(&mut writer).map_err(failed)?;
        let file = writer.into_inner().map_err(|error| failed(error.into_error()))?;
        file.sync_all().map_err(failed)?;
        drop(file);
        // It may have come into being while the run lasted.
        self.check()?;
        fs::rename(temporary, &self.real).map_err(failed)
    }
}

/// Whether two names are those of one file, through links, too.
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
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
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
    fn a_device_is_never_replaced() {
        if Path::new("/dev/null").exists() {
            let error = FileTarget::new(Path::new("/dev/null"), true).expect_err("a device");
            assert!(error.message.contains("regular file"));
        }
    }
}
