//! What each rung of the ladder does.

use std::path::{Path, PathBuf};

use crate::board_demo;
use crate::capi;
use crate::checks;
use crate::emulator::{self, REFERENCE};
use crate::fuzz;
use crate::ladder::{Done, Rung};
use crate::manifest::Manifest;
use crate::no_panic;
use crate::pil;
use crate::plc;
use crate::program;
use crate::python;
use crate::report;
use crate::same_bits;
use crate::setup::{self, Part, Toolchain};
use crate::shell::{Cmd, Outcome, in_ci};
use crate::size;
use crate::swap;

/// All rungs, in order.
pub(crate) const RUNGS: [Rung; 22] = [
    Rung { name: "set-up", about: "the pinned toolchain has its components and targets", run: set_up },
    Rung { name: "format", about: "sources are formatted", run: format },
    Rung { name: "clippy", about: "no warning in any target of any crate", run: clippy },
    Rung { name: "test", about: "unit tests, integration tests, doctests", run: test },
    Rung { name: "docs", about: "documentation builds without a warning", run: docs_rung },
    Rung {
        name: "targets",
        about: "the core and its adapters build for every microcontroller target, the closed-form rules for the smallest",
        run: targets,
    },
    Rung { name: "dependencies", about: "the core depends only on what is allowed", run: dependencies },
    Rung {
        name: "no-panic",
        about: "the image links that cannot panic, its broken twin does not",
        run: no_panic::rung,
    },
    Rung {
        name: "same-bits",
        about: "the same bits at every optimisation level and on every board",
        run: same_bits::rung,
    },
    Rung {
        name: "c-abi",
        about: "archives and objects for C: only their own symbols, no panic, the sizes of the table; from C the same bits",
        run: capi::rung,
    },
    Rung { name: "on-target", about: "the tests that run on the microcontroller", run: emulator::on_target },
    Rung { name: "swap", about: "laws replaced under an interrupt: whole, without a bump", run: swap::rung },
    Rung {
        name: "board-demo",
        about: "the demo logs what it should on every board; the guide shows what is compiled",
        run: board_demo::rung,
    },
    Rung {
        name: "size",
        about: "instructions, code, RAM and stack on every board are those of the table",
        run: size::rung,
    },
    Rung { name: "demo", about: "the program without arguments runs its scenario", run: demo },
    Rung { name: "pil", about: "the same bits on every emulated board", run: pil::rung },
    Rung { name: "hal", about: "the component in LinuxCNC's HAL, at 1 kHz, as the reference", run: plc::hal },
    Rung { name: "octave", about: "the C interface against filters that Octave makes", run: plc::octave },
    Rung { name: "examples", about: "the commands of the C interface's examples", run: plc::examples },
    Rung { name: "report", about: "pages are accessible, offline, legible, small", run: report::rung },
    Rung { name: "fuzz", about: "a bounded run of every fuzz target", run: fuzz_rung },
    Rung { name: "hygiene", about: "files are small, well named and finished", run: hygiene },
];

/// The crate that is flashed.
pub(crate) const CORE: &str = "controller-core";

/// The crate that connects it to a board.
const HAL: &str = "controller-hal";

/// The crate whose closed forms a target can tune itself with.
const DESIGN: &str = "controller-design";

/// The target without a floating-point unit: what builds for it builds for the others.
const SMALLEST: &str = "thumbv6m-none-eabi";

/// What the demo must show.
const DEMO_NAMES: [&str; 3] = ["MOMI", "DRMO", "DE-MOMI"];

fn set_up(root: &Path) -> Outcome<Done> {
    let lacking = setup::toolchain(root)?;
    let version = Cmd::new("rustc", root).arg("--version").capture()?;
    let channel = Toolchain::read(root)?.channel;
    // `cargo +other xtask test` would check with another compiler than the one that is pinned.
    if version.split_whitespace().nth(1) != Some(channel.as_str()) {
        return Err(format!(
            "the compiler in use is {}, pinned is {channel}: call cargo without `+..`",
            version.trim()
        ));
    }
    // The rungs that need what is missing fail for it, and no other.
    let remarks: Vec<&str> =
        std::iter::once(version.trim()).chain(lacking.iter().map(String::as_str)).collect();
    Ok(Done::Passed(remarks.join("; ")))
}

fn format(root: &Path) -> Outcome<Done> {
    if let Some(message) = setup::lacking(root, Part::Component, &["rustfmt".into()])? {
        return Ok(Done::Lacking(message));
    }
    Cmd::cargo(root).args(["fmt", "--all", "--check"]).run()?;
    Done::passed()
}

fn clippy(root: &Path) -> Outcome<Done> {
    if let Some(message) = setup::lacking(root, Part::Component, &["clippy".into()])? {
        return Ok(Done::Lacking(message));
    }
    Cmd::cargo(root).args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]).run()?;
    // On this machine the images are empty programs.
    let target = REFERENCE.target;
    if let Some(message) = setup::lacking(root, Part::Target, &[target.into()])? {
        return Ok(Done::Lacking(message));
    }
    Cmd::cargo(root)
        .args([
            "clippy",
            "-p",
            emulator::FIRMWARE,
            "--lib",
            "--bins",
            "--test",
            "on_target",
            "--features",
            "pil",
            "--target",
            target,
        ])
        .args(["--", "-D", "warnings"])
        .run()?;
    Done::passed()
}

fn test(root: &Path) -> Outcome<Done> {
    // Tests whose tools are missing say that they did not run: an automatic build gets them first.
    let mut lacking = Vec::new();
    if in_ci() {
        lacking.extend(capi::ready(root));
        lacking.extend(python::structured_text(root));
    }
    Cmd::cargo(root).args(["test", "--workspace"]).run()?;
    program::tested();
    if !lacking.is_empty() {
        return Ok(Done::Lacking(lacking.join("; ")));
    }
    capi::tested(root);
    Done::passed()
}

/// Builds the documentation; warnings are errors.
pub(crate) fn docs(root: &Path) -> Outcome {
    Cmd::cargo(root).env("RUSTDOCFLAGS", "-D warnings").args(["doc", "--workspace", "--no-deps"]).run()
}

fn docs_rung(root: &Path) -> Outcome<Done> {
    docs(root)?;
    Done::passed()
}

fn targets(root: &Path) -> Outcome<Done> {
    let targets = Toolchain::read(root)?.targets;
    if let Some(message) = setup::lacking(root, Part::Target, &targets)? {
        return Ok(Done::Lacking(message));
    }
    let mut builds = 0;
    for package in [CORE, HAL] {
        let forms = feature_forms(&Manifest::read(&root.join(package).join("Cargo.toml"))?);
        builds += forms.len();
        for target in &targets {
            for form in &forms {
                Cmd::cargo(root)
                    .args(["build", "-p", package, "--release", "--target", target])
                    .args(form)
                    .run()?;
            }
        }
    }
    Cmd::cargo(root)
        .args(["build", "-p", DESIGN, "--release", "--target", SMALLEST, "--no-default-features"])
        .run()?;
    Ok(Done::Passed(format!("{} targets, sets of features: {builds}", targets.len())))
}

/// The arguments that choose features: the default set, each feature alone, all together, and none at all if that differs.
fn feature_forms(manifest: &Manifest) -> Vec<Vec<String>> {
    let mut forms = vec![Vec::new()];
    if let Some(features) = manifest.table("features") {
        if !features.list("default").is_empty() {
            forms.push(vec!["--no-default-features".into()]);
        }
        // `std` cannot build where there is none.
        let each: Vec<&str> = features.keys().filter(|key| !["default", "std"].contains(key)).collect();
        let with = |list: &str| vec!["--no-default-features".into(), "--features".into(), list.into()];
        forms.extend(each.iter().map(|feature| with(feature)));
        if each.len() > 1 {
            forms.push(with(&each.join(",")));
        }
    }
    forms
}

fn dependencies(root: &Path) -> Outcome<Done> {
    // All targets: a dependency that only one microcontroller pulls in counts as well. Macros run in the compiler.
    let count = |features: &[&str]| {
        let tree = Cmd::cargo(root)
            .args(["tree", "-p", CORE, "-e", "normal,no-proc-macro", "--target", "all", "--prefix", "none"])
            .args(features)
            .capture()?;
        checks::allowed_dependencies(&tree, !features.is_empty())
    };
    let (plain, all) = (count(&[])?, count(&["--all-features"])?);
    Ok(Done::Passed(format!("{plain} crates, all allowed; {all} with all features")))
}

fn demo(root: &Path) -> Outcome<Done> {
    let program = program::checked(root)?;
    let folder = TempFolder::new("demo")?;
    let output = Cmd::new(&program, &folder.0).env("NO_COLOR", "1").capture()?;
    print!("{output}");
    checks::mentions(&output, &DEMO_NAMES)?;
    Done::passed()
}

fn fuzz_rung(root: &Path) -> Outcome<Done> {
    let targets = fuzz::targets(root)?;
    if setup::lacking_for_fuzzing(root).is_some()
        && in_ci()
        && let Err(message) = setup::fuzzing(root)
    {
        println!("{message}");
    }
    if let Some(message) = setup::lacking_for_fuzzing(root) {
        // A person may do without; an automatic build that left it out would look like one that fuzzed.
        return Ok(if in_ci() { Done::Lacking(message) } else { Done::Skipped(message) });
    }
    fuzz::run_all(root, &targets, fuzz::ladder_seconds(targets.len()))?;
    Ok(Done::Passed(targets.join(", ")))
}

fn hygiene(root: &Path) -> Outcome<Done> {
    checks::hygiene(root).map(|count| Done::Passed(format!("{count} files")))
}

/// An empty folder that goes away with this value.
pub(crate) struct TempFolder(pub(crate) PathBuf);

impl TempFolder {
    /// The purpose is part of its name.
    pub(crate) fn new(purpose: &str) -> Outcome<Self> {
        let path = std::env::temp_dir().join(format!("controller-xtask-{purpose}-{}", std::process::id()));
        std::fs::create_dir(&path).map_err(|e| format!("cannot create {}: {e}", path.display()))?;
        Ok(Self(path))
    }
}

impl Drop for TempFolder {
    fn drop(&mut self) {
        // Best effort: a folder left behind in the temporary folder harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_without_features_is_built_once() {
        assert_eq!(feature_forms(&Manifest::parse("[package]\n")), [Vec::<String>::new()]);
    }

    #[test]
    fn each_feature_is_built_alone_and_all_together_but_std() {
        let manifest =
            Manifest::parse("[features]\ndefault = [\"trace\"]\nstd = []\ntrace = []\ndefmt = []\n");
        let forms: Vec<String> = feature_forms(&manifest).iter().map(|form| form.join(" ")).collect();
        let alone = |feature: &str| format!("--no-default-features --features {feature}");
        let none = "--no-default-features".into();
        let expected = [String::new(), none, alone("trace"), alone("defmt"), alone("trace,defmt")];
        assert_eq!(forms, expected);
    }

    #[test]
    fn missing_parts_of_the_product_fail_their_rungs() {
        let nowhere = Path::new("no-such-folder");
        assert!(fuzz_rung(nowhere).unwrap_err().contains("fuzz/Cargo.toml"));
    }

    #[test]
    fn temporary_folders_go_away() {
        let folder = TempFolder::new("unit-test").unwrap();
        let path = folder.0.clone();
        assert!(path.is_dir());
        drop(folder);
        assert!(!path.exists());
    }
}
