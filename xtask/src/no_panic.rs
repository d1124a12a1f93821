//! Nothing in the runtime can panic: an image that links only then, and its twin that must not link.

use std::path::{Path, PathBuf};

use controller_pil::board::{BOARDS, Board, of_target};

use crate::emulator::REFERENCE;
use crate::ladder::Done;
use crate::manifest::Manifest;
use crate::rungs::CORE;
use crate::setup::{self, Part};
use crate::shell::{Cmd, Outcome, target_dir};

/// The package of the image ..
const PACKAGE: &str = "controller-no-panic";
/// .. and the image.
const IMAGE: &str = "unfailing";

/// The feature that puts an unchecked index into the image.
const BROKEN: &str = "unchecked-index";

/// What the linker says then.
const SIGN: &str = "panic-never";

/// What no symbol of the image may contain: ways to panic, and the formatting that comes with them.
const WORDS: [&str; 2] = ["panic", "fmt"];

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    let boards = one_of_each_target();
    let targets: Vec<String> = boards.iter().map(|board| board.target.into()).collect();
    if let Some(message) = setup::lacking(root, Part::Target, &targets)? {
        return Ok(Done::Lacking(message));
    }
    let features = core_features(&Manifest::read(&root.join(CORE).join("Cargo.toml"))?);
    for &board in &boards {
        let image = linked(root, board, &features)?;
        without_symbols(root, &image)?;
    }
    // A check that cannot fail says nothing.
    let (linked, text) = command(root, REFERENCE, &[BROKEN.into()]).attempt()?;
    if linked || !text.contains(SIGN) {
        return Err(format!("{text}\nthe image with an unchecked index must not link, and say {SIGN}"));
    }
    let cores: Vec<&str> = boards.iter().map(|board| board.core).collect();
    Ok(Done::Passed(format!("links for {}, without alloc; its broken twin does not", cores.join(", "))))
}

/// The first board of each target. One has no atomic compare-and-swap: what links for it needs none.
fn one_of_each_target() -> Vec<&'static Board> {
    BOARDS.iter().filter(|&board| of_target(board.target) == Some(board)).collect()
}

/// Every feature of the core, as features of a package that depends on it.
fn core_features(manifest: &Manifest) -> Vec<String> {
    let Some(features) = manifest.table("features") else {
        return Vec::new();
    };
    features
        .keys()
        .filter(|key| !["default", "std"].contains(key))
        .map(|key| format!("{CORE}/{key}"))
        .collect()
}

/// Links the image with these features; gives its path. An allocating crate below the core would fail here, too: nobody
/// brings an allocator.
fn linked(root: &Path, board: &Board, features: &[String]) -> Outcome<PathBuf> {
    command(root, board, features).run()?;
    Ok(folder(root).join(board.target).join("release").join(IMAGE))
}

fn folder(root: &Path) -> PathBuf {
    target_dir(root).join("no-panic")
}

fn command(root: &Path, board: &Board, features: &[String]) -> Cmd {
    let cmd = Cmd::cargo(root)
        .args(["build", "--release", "-p", PACKAGE, "--target", board.target, "--target-dir"])
        .arg(folder(root))
        // Nobody looks at its lines, and their names would be among the symbols.
        .arg("--config=profile.release.debug=false");
    if features.is_empty() { cmd } else { cmd.arg("--features").arg(features.join(",")) }
}

/// Looks through the names of all symbols.
fn without_symbols(root: &Path, image: &Path) -> Outcome {
    let names = Cmd::cargo(root)
        .args([
            "run",
            "--quiet",
            "--target",
            "host-tuple",
            "-p",
            "controller-emulate",
            "--bin",
            "symbols",
            "--",
        ])
        .arg(image)
        .capture()?;
    // An image without symbols would pass in any case.
    if !names.lines().any(|name| name == "main") {
        return Err(format!("{} has no symbol `main`: was it stripped?", image.display()));
    }
    let found = faults(&names);
    if found.is_empty() {
        Ok(())
    } else {
        Err(format!("symbols in {}:\n{}", image.display(), found.join("\n")))
    }
}

fn faults(names: &str) -> Vec<&str> {
    // The logger's own name is no formatting.
    let bad = |name: &str| WORDS.iter().any(|word| name.replace("defmt", "").contains(word));
    names.lines().filter(|name| bad(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_to_panic_are_found_in_mangled_names() {
        let names = "main\n_ZN4core9panicking9panic_fmt17h0\n_RNvNtCs0_4core3fmt5write\nReset\n";
        assert_eq!(faults(names).len(), 2);
        assert!(faults("main\nReset\n_defmt_timestamp\n").is_empty());
    }

    #[test]
    fn every_target_has_its_image() {
        let cores: Vec<&str> = one_of_each_target().iter().map(|board| board.core).collect();
        assert_eq!(cores, ["Cortex-M4F", "Cortex-M0", "Cortex-M3", "Cortex-M33"]);
    }

    #[test]
    fn all_features_of_the_core_are_in_the_image() {
        let manifest = Manifest::parse("[features]\ndefault = [\"a\"]\na = []\nstd = []\nb = []\n");
        assert_eq!(core_features(&manifest), ["controller-core/a", "controller-core/b"]);
        assert!(core_features(&Manifest::parse("")).is_empty());
    }
}
