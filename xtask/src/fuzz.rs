//! Fuzzing: a bounded share in the ladder, the long runs in `soak`.
//!
//! With a nightly compiler the targets run under the address sanitizer. Without one the pinned compiler runs them with
//! coverage only: nothing is lost for the crates that forbid unsafe code, whose faults are panics and wrong values.

use std::path::Path;

use crate::manifest::Manifest;
use crate::setup;
use crate::shell::{Cmd, Outcome};

/// The manifest that lists the targets, below the workspace root.
pub(crate) const MANIFEST: &str = "fuzz/Cargo.toml";

/// Seconds for one target in the ladder ..
const SECONDS_PER_TARGET: u64 = 60;
/// .. as long as all of them together stay within this, so that the ladder keeps its time however many there are.
const SECONDS_AT_MOST: u64 = 480;

/// Whether fuzzing can run.
pub(crate) enum Readiness {
    /// There is no fuzz folder, or it lists no target.
    NoTargets,
    /// cargo-fuzz is not installed.
    NoTool,
    /// These targets can run.
    Ready(Vec<String>),
}

/// Looks for targets and for the tool.
pub(crate) fn readiness(root: &Path) -> Outcome<Readiness> {
    let path = root.join(MANIFEST);
    if !path.is_file() {
        return Ok(Readiness::NoTargets);
    }
    let targets = targets(&Manifest::read(&path)?);
    Ok(if targets.is_empty() {
        Readiness::NoTargets
    } else if !setup::cargo_fuzz(root) {
        Readiness::NoTool
    } else {
        Readiness::Ready(targets)
    })
}

/// Runs every target, `seconds` in all.
pub(crate) fn run_all(root: &Path, targets: &[String], seconds: u64) -> Outcome {
    let nightly = setup::nightly(root);
    let pinned = setup::Toolchain::read(root)?.channel;
    let each = (seconds / targets.len().max(1) as u64).max(1);
    for target in targets {
        println!("fuzz target {target}: {each} s");
        command(root, target, each, (!nightly).then_some(pinned.as_str())).run()?;
    }
    Ok(())
}

/// Seconds in all for the ladder's share.
pub(crate) fn ladder_seconds(targets: usize) -> u64 {
    (targets as u64 * SECONDS_PER_TARGET).min(SECONDS_AT_MOST)
}

/// The command for one target, under nightly or, without it, under the `pinned` compiler.
fn command(root: &Path, target: &str, seconds: u64, pinned: Option<&str>) -> Cmd {
    // `rustup run` and not `cargo +..`: inside `cargo xtask` the cargo found first need not be rustup's.
    let cmd = Cmd::new("rustup", root)
        .args(["run", pinned.unwrap_or("nightly"), "cargo", "fuzz", "run"])
        .args(if pinned.is_some() { &["--sanitizer", "none"][..] } else { &[] });
    // One input that takes over 10 s is a fault as well: steps and parsers are bounded.
    cmd.args([target, "--", &format!("-max_total_time={seconds}"), "-timeout=10"])
}

/// The names of the targets.
fn targets(manifest: &Manifest) -> Vec<String> {
    manifest.tables("bin").filter_map(|bin| bin.string("name")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_the_binaries_of_the_manifest() {
        let text = "[package]\nname = \"x-fuzz\"\n[[bin]]\nname = \"step\"\ntest = false\n[[bin]]\nname = \"parse\"\n";
        assert_eq!(targets(&Manifest::parse(text)), ["step", "parse"]);
    }

    #[test]
    fn the_ladder_keeps_its_time() {
        assert_eq!(ladder_seconds(2), 120);
        assert_eq!(ladder_seconds(100), SECONDS_AT_MOST);
    }

    #[test]
    fn without_nightly_the_pinned_compiler_runs_without_the_sanitizer() {
        let root = Path::new(".");
        assert_eq!(
            command(root, "step", 60, None).to_string(),
            "rustup run nightly cargo fuzz run step -- -max_total_time=60 -timeout=10"
        );
        assert_eq!(
            command(root, "step", 60, Some("1.95.0")).to_string(),
            "rustup run 1.95.0 cargo fuzz run --sanitizer none step -- -max_total_time=60 -timeout=10"
        );
    }
}
