//! The host program that rungs, benchmarks and soaks start.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::shell::{Cmd, Outcome, target_dir};

/// The package, and the program in it.
const PACKAGE: &str = "controller-sim-host";
const PROGRAM: &str = "controller-sim";

/// Whether all tests have passed in this run of the ladder: cargo has then built the program for them.
static TESTED: AtomicBool = AtomicBool::new(false);

/// All tests have passed: the program that they started is up to date.
pub(crate) fn tested() {
    TESTED.store(true, Ordering::Relaxed);
}

/// The path of a program for checks: the one that the tests have started, else the one that is shipped.
///
/// Its bits are the same in every profile (rung `same-bits`), and it has its debug assertions on; the whole program is
/// optimised for minutes otherwise.
pub(crate) fn checked(root: &Path) -> Outcome<PathBuf> {
    let built = built(root, "debug");
    if TESTED.load(Ordering::Relaxed) && built.is_file() { Ok(built) } else { shipped(root) }
}

/// Builds the program as it is shipped; gives its path. It is built in the workspace and started anywhere: outside of
/// the workspace cargo would choose another toolchain.
pub(crate) fn shipped(root: &Path) -> Outcome<PathBuf> {
    Cmd::cargo(root).args(["build", "--release", "-p", PACKAGE]).run()?;
    Ok(built(root, "release"))
}

fn built(root: &Path, profile: &str) -> PathBuf {
    target_dir(root).join(profile).join(format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX))
}
