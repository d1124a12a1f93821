//! Temporary files that take their names at the very end.

use super::file::{FileError, FileTarget};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The temporary files there are: whoever ends the program early removes them.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A list of paths is whole after every step: a panic elsewhere does no harm to it.
fn temporary() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file, for a program that ends at once.
pub fn remove_drafts() {
    for path in temporary().drain(..) {
        // What cannot be removed cannot be helped.
        let _ = fs::remove_file(path);
    }
}

/// A temporary file; it is removed when it is dropped.
#[derive(Debug)]
struct Temporary(PathBuf);

impl Temporary {
    fn create(path: PathBuf) -> io::Result<(Self, File)> {
        // Listed first: a signal between the two lines finds it.
        temporary().push(path.clone());
        let listed = Self(path);
        match File::create_new(&listed.0) {
            Ok(file) => Ok((listed, file)),
            Err(error) => {
                // It is not ours.
                listed.forget();
                Err(error)
            }
        }
    }

    fn unlist(&self) {
        temporary().retain(|path| *path != self.0);
    }

    fn forget(self) {
        self.unlist();
        std::mem::forget(self);
    }

    fn rename(self, to: &Path) -> io::Result<()> {
        fs::rename(&self.0, to)?;
        self.forget();
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // The failure that led here is the one to report.
        let _ = fs::remove_file(&self.0);
        self.unlist();
    }
}

/// A file that is being written under a temporary name; dropped, it leaves nothing behind.
#[derive(Debug)]
pub struct Draft {
    target: FileTarget,
    writer: BufWriter<File>,
    temporary: Temporary,
}

/// A file that is written whole and has yet to take its name; dropped, it leaves nothing behind.
#[derive(Debug)]
pub struct Complete {
    target: FileTarget,
    temporary: Temporary,
}

impl Draft {
    pub(super) fn create(target: &FileTarget) -> Result<Self, FileError> {
        let name = target.real().file_name().unwrap_or_default().to_string_lossy();
        let path = target.folder().join(format!(".{name}.{}.tmp", std::process::id()));
        let (temporary, file) = Temporary::create(path).map_err(|error| target.failed(&error))?;
        Ok(Self { target: target.clone(), writer: BufWriter::with_capacity(1 << 16, file), temporary })
    }

    /// Brings everything to the disc.
    ///
    /// # Errors
    /// What the system reports.
    pub fn complete(self) -> Result<Complete, FileError> {
        let Self { target, writer, temporary } = self;
        let file = writer.into_inner().map_err(|error| target.failed(error.error()))?;
        file.sync_all().map_err(|error| target.failed(&error))?;
        Ok(Complete { target, temporary })
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.writer.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Gives all files their names, or none: each is checked once more before the first is touched, and if the system refuses
/// one after all, those that are new are removed again.
///
/// # Errors
/// A file that came into being meanwhile; what the system reports.
pub fn publish(files: Vec<Complete>) -> Result<(), FileError> {
    for file in &files {
        file.target.check()?;
    }
    let mut made: Vec<PathBuf> = Vec::new();
    for Complete { target, temporary } in files {
        let is_new = !target.real().exists();
        if let Err(error) = temporary.rename(target.real()) {
            for path in made {
                // The refusal is what is reported.
                let _ = fs::remove_file(path);
            }
            return Err(target.failed(&error));
        }
        made.extend(is_new.then(|| target.real().to_owned()));
    }
    Ok(())
}
