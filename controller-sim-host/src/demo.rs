//! The built-in scenario: what the program shows when it is started without arguments.

use crate::output::{FileError, FileTarget};
use std::path::{Path, PathBuf};

/// The text of the built-in scenario, `scenarios/demo.toml`.
pub const SCENARIO: &str = include_str!("../scenarios/demo.toml");

/// What it is called in messages and results.
pub const NAME: &str = "demo";

/// What to do after the demo.
pub const TRY_NEXT: &str = "
Try next (in the source tree write `cargo sim` for `controller-sim`):
  controller-sim demo --save my.toml          write this scenario to a file, to change it
  controller-sim run my.toml --csv my.csv     run it and keep every sample
  controller-sim run --help                   everything else, with examples
";

/// Writes the built-in scenario to `path`, or to the next free name when that exists and `force` is not
/// given. Gives the path that was written.
///
/// # Errors
/// A file that cannot be written; a path that is no file.
pub fn save(path: &Path, force: bool) -> Result<PathBuf, FileError> {
    let target = FileTarget::next_free(path, force)?;
    target.write(|to| to.write_all(SCENARIO.as_bytes()))?;
    Ok(target.path().to_owned())
}
