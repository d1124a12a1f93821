//! The C interface in other people's programs: LinuxCNC's HAL, Octave, the commands of the examples.

use std::path::{Path, PathBuf};

use crate::ladder::Done;
use crate::packages;
use crate::rungs::TempFolder;
use crate::setup::{self, Part};
use crate::shell::{Cmd, Outcome, in_ci, target_dir};

/// Programs that a rung needs and that are large: a plain set-up leaves them out.
struct Tool {
    /// For people.
    name: &'static str,
    /// The packages of Debian that it is in.
    packages: &'static [&'static str],
    /// Commands that succeed when it is there.
    probes: &'static [&'static [&'static str]],
}

const LINUXCNC: Tool = Tool {
    name: "LinuxCNC",
    packages: &["linuxcnc-uspace", "linuxcnc-uspace-dev", "make"],
    probes: &[&["halrun", "-h"], &["halcompile", "--help"], &["make", "--version"]],
};

const OCTAVE: Tool = Tool {
    name: "Octave",
    packages: &["octave", "octave-dev", "octave-control"],
    probes: &[&["mkoctfile", "--version"], &["octave-cli", "--no-init-file", "--eval", "pkg load control"]],
};

/// The compiler for the board of an example, with its C library.
const ARM: Tool = Tool {
    name: "arm-none-eabi-g++",
    packages: &["gcc-arm-none-eabi", "libnewlib-arm-none-eabi"],
    probes: &[&["arm-none-eabi-g++", "--version"]],
};

/// Where HAL looks for its modules, and the program that knows whether it runs.
const MODULES: &str = "/usr/lib/linuxcnc/modules";
const REALTIME: &str = "/usr/lib/linuxcnc/realtime";

const EXAMPLES: &str = "controller-capi/examples/README.md";
const SMALL_BOARD: &str = "thumbv7em-none-eabihf";

/// What a block of the examples needs, by a word of its commands ..
const NEEDS: [(&str, &Tool); 3] =
    [("hal/run.sh", &LINUXCNC), ("mkoctfile", &OCTAVE), ("arm-none-eabi-g++", &ARM)];
/// .. and a part of what it prints at its end.
const PRINTS: [(&str, &str); 4] = [
    ("target/heater\n", " 600 s   60.0"),
    ("target/heater_arduino\n", "\n280 s  180."),
    ("hal/run.sh", "\n59 -0.500000"),
    ("octave-cli", " 5.0 s  y  0.986"),
];

impl Tool {
    fn there(&self, root: &Path) -> bool {
        self.probes.iter().all(|words| Cmd::new(words[0], root).args(&words[1..]).probe().is_some())
    }

    /// Installs it if it is missing and that may be done; else says what is lacking.
    fn ready(&self, root: &Path) -> Option<String> {
        if self.there(root) { None } else { packages::install(root, self.packages, || self.there(root)) }
    }

    /// Why a rung that needs it cannot run here, if it cannot. A person may do without; an automatic build that left it
    /// out would look like one that had run it.
    fn lacking(&self, root: &Path) -> Option<String> {
        if in_ci() {
            self.ready(root)
        } else {
            (!self.there(root)).then(|| format!("{} is missing; run: cargo xtask setup --plc", self.name))
        }
    }
}

/// Installs what is missing of all of them; says what it could not.
pub(crate) fn ready(root: &Path) -> Vec<String> {
    [&LINUXCNC, &OCTAVE, &ARM].iter().filter_map(|tool| tool.ready(root)).collect()
}

fn not_run(message: String) -> Done {
    if in_ci() { Done::Lacking(message) } else { Done::Skipped(message) }
}

/// Why nothing can run in HAL here, although LinuxCNC is there.
fn hal_is_busy(root: &Path) -> Option<String> {
    if Cmd::new(REALTIME, root).arg("status").probe().is_some() {
        return Some("LinuxCNC runs on this machine; end it first".into());
    }
    let writable = Cmd::new("test", root).args(["-w", MODULES]).probe().is_some();
    (!writable).then(|| format!("{MODULES} may only be written by the superuser: run as that one"))
}

/// Builds the archive for this machine; gives its path.
fn archive(root: &Path) -> Outcome<PathBuf> {
    Cmd::cargo(root).args(["build", "-p", "controller-capi-staticlib", "--profile", "embedded"]).run()?;
    Ok(target_dir(root).join("embedded/libctl.a"))
}

/// The component for LinuxCNC's HAL, in HAL.
pub(crate) fn hal(root: &Path) -> Outcome<Done> {
    if let Some(message) = LINUXCNC.lacking(root).or_else(|| hal_is_busy(root)) {
        return Ok(not_run(message));
    }
    let archive = archive(root)?;
    Cmd::cargo(root)
        .env("CTL_ARCHIVE", &archive.to_string_lossy())
        .args(["test", "-p", "controller-tests", "--test", "hal"])
        .run()?;
    Ok(Done::Passed("three loops as the reference, one as HAL's own pid".into()))
}

/// The C interface in Octave, against filters that Octave makes of the continuous laws.
pub(crate) fn octave(root: &Path) -> Outcome<Done> {
    if let Some(message) = OCTAVE.lacking(root) {
        return Ok(not_run(message));
    }
    let archive = archive(root)?;
    let folder = TempFolder::new("octave")?;
    Cmd::new("mkoctfile", root)
        .args(["--mex", "-Icontroller-capi/include", "controller-capi/octave/ctl_loop_mex.c"])
        .arg(&archive)
        .arg("-o")
        .arg(folder.0.join("ctl_loop_mex.mex"))
        .run()?;
    let printed = Cmd::new("octave-cli", root)
        .args(["--no-init-file", "--path"])
        .arg(&folder.0)
        .arg("tests/octave/check.m")
        .capture()?;
    print!("{printed}");
    if !printed.ends_with("all agree\n") {
        return Err("tests/octave/check.m did not reach its end".into());
    }
    let comparisons = printed.lines().filter(|line| line.contains("e-")).count();
    Ok(Done::Passed(format!("{comparisons} comparisons")))
}

/// The commands of the examples' README.
pub(crate) fn examples(root: &Path) -> Outcome<Done> {
    if let Some(message) = setup::lacking(root, Part::Target, &[SMALL_BOARD.into()])? {
        return Ok(Done::Lacking(message));
    }
    let page = std::fs::read_to_string(root.join(EXAMPLES)).map_err(|e| format!("{EXAMPLES}: {e}"))?;
    let target = target_dir(root);
    std::fs::create_dir_all(&target).map_err(|e| format!("cannot create {}: {e}", target.display()))?;
    let (mut ran, mut left_out) = (0, Vec::new());
    for block in blocks(&page) {
        let needed = NEEDS.iter().filter(|(word, _)| block.contains(word)).map(|(_, tool)| *tool);
        let mut lacking: Vec<String> = needed.filter_map(|tool| tool.lacking(root)).collect();
        if lacking.is_empty() && block.contains("hal/run.sh") {
            lacking.extend(hal_is_busy(root));
        }
        if lacking.is_empty() {
            run_block(root, &target, block)?;
            ran += 1;
        } else {
            left_out.extend(lacking);
        }
    }
    if ran == 0 {
        return Err(format!("{EXAMPLES} has no commands"));
    }
    Ok(match left_out.is_empty() {
        true => Done::Passed(format!("{ran} blocks of commands")),
        false => not_run(format!("{ran} blocks of commands ran; the others not: {}", left_out.join("; "))),
    })
}

/// The blocks of commands of a page.
fn blocks(page: &str) -> impl Iterator<Item = &str> {
    page.split("```sh\n").skip(1).filter_map(|behind| behind.split_once("```").map(|(block, _)| block))
}

fn run_block(root: &Path, target: &Path, block: &str) -> Outcome {
    // What cargo builds may be elsewhere than the page says.
    let commands = block.replace(" target/", &format!(" {}/", target.display()));
    let commands = commands.replace("\ntarget/", &format!("\n{}/", target.display()));
    let printed = Cmd::new("sh", root)
        .env("ARCHIVE", &target.join("embedded/libctl.a").to_string_lossy())
        .env("BUILD", &target.join("hal").to_string_lossy())
        .args(["-euc", &commands])
        .capture()?;
    for (_, wanted) in PRINTS.iter().filter(|(word, _)| block.contains(word)) {
        if !printed.contains(wanted) {
            return Err(format!("the example does not print `{}`:\n{printed}", wanted.trim()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_commands_are_found() {
        let page = "a\n```sh\none\n```\n```text\nnot this\n```\n```sh\ntwo\nthree\n```\n";
        assert_eq!(blocks(page).collect::<Vec<_>>(), ["one\n", "two\nthree\n"]);
    }

    #[test]
    fn every_expected_text_belongs_to_a_block_of_the_page() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let page = std::fs::read_to_string(root.join(EXAMPLES)).unwrap();
        let words = PRINTS.iter().map(|(word, _)| *word).chain(NEEDS.iter().map(|(word, _)| *word));
        for word in words {
            assert!(blocks(&page).any(|block| block.contains(word)), "{word}");
        }
    }
}
