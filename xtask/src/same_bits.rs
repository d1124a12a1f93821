//! The same bits on every machine: the loops of `controller_firmware::trace` on the host and in images.

use std::path::Path;

use crate::checks;
use crate::emulator;
use crate::ladder::Done;
use crate::shell::{Cmd, Outcome, target_dir};

/// The image, and the program of the host with the same name.
const TRACE: &str = "trace";

/// Samples of each loop in every build for the host.
const SAMPLES: u32 = 100_000;

/// The hash over all loops in both number types with [`SAMPLES`] samples each. It changes when a law or a loop does; then
/// outputs change in their last bits, which the CHANGELOG must say.
const HASH: &str = "449818d80f9822b5";

/// A way to build for the host.
struct Variant {
    /// Name in messages, and of the folder it is built in.
    name: &'static str,
    /// What is different from the plain build.
    args: &'static [&'static str],
    /// A flag for the compiler, or none; one word, see [`on_host`].
    rustflag: &'static str,
}

/// The builds whose traces must agree. No debug information: nobody debugs them and they build faster.
const VARIANTS: [Variant; 5] = [
    Variant { name: "opt-0", args: &["--config=profile.dev.opt-level=0", NO_DEBUG], rustflag: "" },
    Variant { name: "opt-1", args: &["--config=profile.dev.opt-level=1", NO_DEBUG], rustflag: "" },
    Variant { name: "opt-3", args: &["--config=profile.dev.opt-level=3", NO_DEBUG], rustflag: "" },
    // All instructions of this machine, fused multiply-add among them: the compiler must not use it on its own.
    Variant {
        name: "native",
        args: &["--config=profile.dev.opt-level=3", NO_DEBUG],
        rustflag: "-Ctarget-cpu=native",
    },
    // The profile that is shipped: optimised across crates, overflow checks off.
    Variant { name: "release", args: &["--release"], rustflag: "" },
];

/// See [`VARIANTS`].
const NO_DEBUG: &str = "--config=profile.dev.debug=false";

/// Runs in images.
struct Share {
    board: &'static str,
    types: &'static str,
    /// Samples of each loop.
    samples: u32,
}

/// What images run in the ladder. Where numbers are computed in software, a sample takes ten times as long.
const SHARES: [Share; 7] = [
    Share { board: "mps2-an386", types: "f32", samples: 1_000_000 },
    Share { board: "mps2-an386", types: "f64", samples: 20_000 },
    Share { board: "mps2-an500", types: "both", samples: 50_000 },
    Share { board: "mps2-an505", types: "f32", samples: 100_000 },
    Share { board: "mps2-an505", types: "f64", samples: 10_000 },
    Share { board: "mps2-an385", types: "f32", samples: 20_000 },
    Share { board: "microbit", types: "f32", samples: 20_000 },
];

/// What the soak runs, in multiples of [`SHARES`].
const SOAK: u32 = 10;

/// Seconds that one image may take in the ladder.
const SECONDS: u32 = 900;

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    let (outputs, lines) = on_hosts(root, SAMPLES)?;
    check_hash(&outputs[0].1, HASH)?;
    let remark = format!("{HASH} in {} builds for this machine ({lines} traces)", outputs.len());
    Ok(match emulator::lacking(root)? {
        None => Done::Passed(format!("{remark}; {}", in_images(root, 1)?)),
        Some(Done::Skipped(reason)) => Done::Passed(format!("{remark}; no images: {reason}")),
        Some(end) => end,
    })
}

/// The long runs.
pub(crate) fn soak(root: &Path) -> Outcome {
    let (outputs, lines) = on_hosts(root, SOAK * SAMPLES)?;
    println!(
        "{} builds for this machine agree in {lines} traces of {} samples",
        outputs.len(),
        SOAK * SAMPLES
    );
    match emulator::lacking(root)? {
        None => in_images(root, SOAK).map(|remark| println!("{remark}")),
        Some(Done::Lacking(message) | Done::Skipped(message) | Done::Passed(message)) => Err(message),
    }
}

/// What every build for the host prints, and of how many traces each.
fn on_hosts(root: &Path, samples: u32) -> Outcome<(Vec<(&'static str, String)>, usize)> {
    let mut outputs = Vec::new();
    for variant in &VARIANTS {
        outputs.push((variant.name, on_host(root, variant, samples, "both")?));
    }
    let lines = checks::same_output(&outputs)?;
    Ok((outputs, lines))
}

/// What one build for the host prints.
fn on_host(root: &Path, variant: &Variant, samples: u32, types: &str) -> Outcome<String> {
    // A folder of its own for each: a binary left by another variant must never be run by mistake.
    let folder = target_dir(root).join("same-bits").join(variant.name);
    Cmd::cargo(root)
        // Always set, if only to nothing: of all the places flags can come from, this one shuts out the others, so
        // that no flag of the caller makes two variants the same build. Words in it are not parted by blanks.
        .env("CARGO_ENCODED_RUSTFLAGS", variant.rustflag)
        .args(["run", "--quiet", "-p", emulator::FIRMWARE, "--bin", TRACE, "--target-dir"])
        .arg(folder)
        .args(variant.args)
        .args(["--", &samples.to_string(), types])
        .capture()
}

/// Compares every image with the host; `times` as many samples as the ladder has.
fn in_images(root: &Path, times: u32) -> Outcome<String> {
    let [.., release] = &VARIANTS;
    let mut remarks = Vec::new();
    for Share { board, types, samples } in SHARES {
        let samples = samples * times;
        let board = emulator::board(board)?;
        let image = emulator::image(root, board, TRACE, &[])?;
        let words = [&samples.to_string(), types];
        let there = emulator::emulated(root, &image, &words, SECONDS * times).capture()?;
        let here = on_host(root, release, samples, types)?;
        checks::same_output(&[(release.name, here), (board.name, there)])?;
        remarks.push(format!("{} {types} {samples}", board.core));
    }
    Ok(format!("images with samples of each loop: {}", remarks.join(", ")))
}

/// Checks the last line of an output.
fn check_hash(output: &str, hash: &str) -> Outcome {
    let found = output.split_whitespace().next_back().unwrap_or_default();
    if found == hash {
        Ok(())
    } else {
        Err(format!(
            "the bits of the loops have changed: {found}, it was {hash}; if they should, put the new hash into \
             xtask/src/same_bits.rs and say so in the CHANGELOG"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_have_folders_of_their_own() {
        let mut names: Vec<_> = VARIANTS.iter().map(|variant| variant.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), VARIANTS.len());
    }

    #[test]
    fn flags_of_variants_are_one_word() {
        assert!(VARIANTS.iter().all(|variant| !variant.rustflag.contains(char::is_whitespace)));
    }

    #[test]
    fn every_board_has_a_share() {
        for board in &controller_pil::board::BOARDS {
            assert!(SHARES.iter().any(|share| share.board == board.name), "{}", board.name);
        }
        assert!(SHARES.iter().all(|share| share.samples.checked_mul(SOAK).is_some()));
    }

    #[test]
    fn another_hash_is_found() {
        assert!(check_hash("pid f32 10 00\nall 10 12ab\n", "12ab").is_ok());
        let message = check_hash("all 10 12ac\n", "12ab").unwrap_err();
        assert!(message.contains("12ac, it was 12ab"), "{message}");
        assert!(check_hash("", "12ab").is_err());
    }
}
