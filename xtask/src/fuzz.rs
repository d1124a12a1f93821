//! Fuzzing: a bounded share in the ladder, the long runs in `soak`.
//!
//! The targets run under the pinned compiler, with coverage but without the address sanitizer, which would need another
//! compiler. Nothing is lost for crates that forbid unsafe code, whose faults are panics and wrong values.

use std::path::Path;

use crate::manifest::Manifest;
use crate::setup::Toolchain;
use crate::shell::{Cmd, Outcome};

/// The manifest that lists the targets, below the workspace root.
const MANIFEST: &str = "fuzz/Cargo.toml";

/// Seconds for one target in the ladder ..
const SECONDS_PER_TARGET: u64 = 20;
/// .. for so many targets; more of them share the same time, so that the ladder keeps its own.
const FULL_SHARES: u64 = 5;

/// The names of the targets; an error when there are none.
pub(crate) fn targets(root: &Path) -> Outcome<Vec<String>> {
    let path = root.join(MANIFEST);
    if !path.is_file() {
        return Err(format!("{MANIFEST} is missing: the fuzz targets are part of the workspace"));
    }
    let targets = names(&Manifest::read(&path)?);
    if targets.is_empty() { Err(format!("{MANIFEST} lists no target")) } else { Ok(targets) }
}

/// Runs every target, `seconds` in all.
pub(crate) fn run_all(root: &Path, targets: &[String], seconds: u64) -> Outcome {
    let channel = Toolchain::read(root)?.channel;
    let each = (seconds / targets.len().max(1) as u64).max(1);
    for target in targets {
        println!("fuzz target {target}: {each} s");
        command(root, &channel, target, each).run()?;
    }
    Ok(())
}

/// Seconds in all for the ladder's share.
pub(crate) fn ladder_seconds(targets: usize) -> u64 {
    (targets as u64).min(FULL_SHARES) * SECONDS_PER_TARGET
}

/// The command for one target under the pinned compiler.
fn command(root: &Path, channel: &str, target: &str, seconds: u64) -> Cmd {
    // `rustup run` and not `cargo +..`: inside `cargo xtask` the cargo found first need not be rustup's.
    Cmd::new("rustup", root)
        .args(["run", channel, "cargo", "fuzz", "run", "--sanitizer", "none", target, "--"])
        // One input that takes over 10 s is a fault as well: steps and parsers are bounded.
        .args([&format!("-max_total_time={seconds}"), "-timeout=10"])
}

/// The binaries that a manifest lists.
fn names(manifest: &Manifest) -> Vec<String> {
    manifest.tables("bin").filter_map(|bin| bin.string("name")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_the_binaries_of_the_manifest() {
        let text = "[package]\nname = \"x-fuzz\"\n[[bin]]\nname = \"step\"\ntest = false\n[[bin]]\nname = \"parse\"\n";
        assert_eq!(names(&Manifest::parse(text)), ["step", "parse"]);
    }

    #[test]
    fn missing_targets_are_an_error() {
        let message = targets(Path::new("no-such-folder")).unwrap_err();
        assert!(message.contains(MANIFEST), "{message}");
    }

    #[test]
    fn the_ladder_keeps_its_time() {
        assert_eq!(ladder_seconds(4), 4 * SECONDS_PER_TARGET);
        assert_eq!(ladder_seconds(100), ladder_seconds(5));
        assert!(ladder_seconds(100) <= 120, "two minutes of the ladder's forty");
    }

    #[test]
    fn the_pinned_compiler_runs_without_the_sanitizer() {
        assert_eq!(
            command(Path::new("."), "1.95.0", "step", 60).to_string(),
            "rustup run 1.95.0 cargo fuzz run --sanitizer none step -- -max_total_time=60 -timeout=10"
        );
    }
}
