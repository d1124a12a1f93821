//! Set-up: what the pinned toolchain must have before the ladder can run.
//!
//! `rust-toolchain.toml` is the one list of components and targets. Rustup adds them by itself only when its automatic
//! installation is on; build machines tend to have it off, so the list is read and compared here. What cannot be added
//! (no network) is no reason to stop: only the rung that needs it fails, with the command to run.

use std::path::Path;

use crate::manifest::Manifest;
use crate::shell::{Cmd, Outcome};

/// The contents of `rust-toolchain.toml`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Toolchain {
    /// The pinned compiler, such as `1.95.0`.
    pub(crate) channel: String,
    /// Components beyond the minimal profile.
    pub(crate) components: Vec<String>,
    /// Targets the core is built for.
    pub(crate) targets: Vec<String>,
}

impl Toolchain {
    /// Reads the file in the workspace root.
    pub(crate) fn read(root: &Path) -> Outcome<Self> {
        let manifest = Manifest::read(&root.join("rust-toolchain.toml"))?;
        Self::from_manifest(&manifest).ok_or_else(|| "rust-toolchain.toml names no channel".into())
    }

    fn from_manifest(manifest: &Manifest) -> Option<Self> {
        let table = manifest.table("toolchain")?;
        Some(Self {
            channel: table.string("channel")?,
            components: table.list("components"),
            targets: table.list("targets"),
        })
    }

    /// The command that installs the bare compiler; components and targets are added one by one, as some may fail.
    fn install(&self, root: &Path) -> Cmd {
        let channel = self.channel.as_str();
        Cmd::new("rustup", root).args([
            "toolchain",
            "install",
            channel,
            "--profile",
            "minimal",
            "--no-self-update",
        ])
    }

    /// The command that adds parts of one kind.
    fn add(&self, root: &Path, part: Part, names: &[&str]) -> Cmd {
        let channel = self.channel.as_str();
        Cmd::new("rustup", root).args([part.word(), "add", "--toolchain", channel]).args(names)
    }

    /// What rustup has installed of one kind; nothing when it does not know the toolchain or is not there.
    fn installed(&self, root: &Path, part: Part) -> Option<String> {
        let channel = self.channel.as_str();
        Cmd::new("rustup", root).args([part.word(), "list", "--installed", "--toolchain", channel]).probe()
    }
}

/// The kinds of parts that a toolchain is put together from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// A tool, such as clippy.
    Component,
    /// The library for another machine.
    Target,
}

impl Part {
    /// The word of rustup for it.
    fn word(self) -> &'static str {
        match self {
            Self::Component => "component",
            Self::Target => "target",
        }
    }
}

/// Makes sure that the pinned toolchain has its components and targets; adds only what is missing.
///
/// Gives a message with the command to run for everything that could not be added. An error means that there is no
/// compiler to go on with.
pub(crate) fn toolchain(root: &Path) -> Outcome<Vec<String>> {
    let pinned = Toolchain::read(root)?;
    let channel = pinned.channel.as_str();
    if Cmd::new("rustup", root).arg("--version").probe().is_none() {
        return Err("rustup is missing: install rustup, then run again".into());
    }
    if pinned.installed(root, Part::Component).is_none() {
        println!("toolchain {channel} is not there yet");
        by_hand(&pinned.install(root))?;
    }
    let mut lacking = Vec::new();
    for (part, wanted) in [(Part::Component, &pinned.components), (Part::Target, &pinned.targets)] {
        let installed = pinned.installed(root, part).unwrap_or_default();
        for name in missing(wanted, &installed) {
            let add = pinned.add(root, part, &[name]);
            if let Err(message) = add.run() {
                println!("{message}");
                lacking.push(lack(part, &[name], &add));
            }
        }
    }
    if lacking.is_empty() {
        let parts: Vec<&str> = pinned.components.iter().chain(&pinned.targets).map(String::as_str).collect();
        println!("toolchain {channel} has {}", parts.join(", "));
    }
    Ok(lacking)
}

/// What of `wanted` the pinned toolchain lacks, with the command that adds it; nothing when all is there.
///
/// Without rustup nobody knows: then the command that needs it says what is wrong.
pub(crate) fn lacking(root: &Path, part: Part, wanted: &[String]) -> Outcome<Option<String>> {
    let pinned = Toolchain::read(root)?;
    let Some(installed) = pinned.installed(root, part) else {
        return Ok(None);
    };
    let names = missing(wanted, &installed);
    Ok((!names.is_empty()).then(|| lack(part, &names, &pinned.add(root, part, &names))))
}

/// The message for parts that are not there, in one line: the summary shows no more.
fn lack(part: Part, names: &[&str], add: &Cmd) -> String {
    format!("{} missing: {}; run: {add}", part.word(), names.join(", "))
}

/// The version of cargo-fuzz that runs the targets.
const CARGO_FUZZ: &str = "0.13.2";

/// Makes sure that the tools for fuzzing are there: a C++ compiler and the pinned cargo-fuzz.
pub(crate) fn fuzzing(root: &Path) -> Outcome {
    if !cpp_compiler(root) {
        return Err(NO_CPP.into());
    }
    if !cargo_fuzz(root) {
        by_hand(&install_cargo_fuzz(root))?;
    }
    println!("fuzzing: cargo-fuzz {CARGO_FUZZ} with the pinned compiler");
    Ok(())
}

/// What fuzzing lacks on this machine, in one line; nothing when it can run.
pub(crate) fn lacking_for_fuzzing(root: &Path) -> Option<String> {
    if !cpp_compiler(root) {
        Some(NO_CPP.into())
    } else if !cargo_fuzz(root) {
        Some(format!("cargo-fuzz {CARGO_FUZZ} is missing; run: cargo xtask setup --fuzz"))
    } else {
        None
    }
}

/// Nothing here installs a system compiler: every system has its own way.
const NO_CPP: &str = "no C++ compiler: libFuzzer is written in C++, and `c++ --version` does not run; \
                      install a C++ compiler (or name it in CXX), then run again";

/// Whether there is a C++ compiler, where the build of libFuzzer looks for it.
fn cpp_compiler(root: &Path) -> bool {
    let program = std::env::var_os("CXX").filter(|name| !name.is_empty()).unwrap_or_else(|| "c++".into());
    Cmd::new(program, root).arg("--version").probe().is_some()
}

/// Whether the pinned cargo-fuzz is installed.
fn cargo_fuzz(root: &Path) -> bool {
    Cmd::cargo(root).args(["fuzz", "--version"]).probe().is_some_and(|text| is_pinned_cargo_fuzz(&text))
}

/// Reads the answer of `cargo fuzz --version`, which is `cargo-fuzz 0.13.2`.
fn is_pinned_cargo_fuzz(answer: &str) -> bool {
    answer.split_whitespace().nth(1) == Some(CARGO_FUZZ)
}

/// The command that installs it, in the place of another version if there is one.
fn install_cargo_fuzz(root: &Path) -> Cmd {
    Cmd::cargo(root).args(["install", "cargo-fuzz", "--version", CARGO_FUZZ, "--locked"])
}

/// Runs a command that changes the machine; when it fails, says exactly what the person must run.
fn by_hand(cmd: &Cmd) -> Outcome {
    cmd.run().map_err(|message| format!("{message}\nset-up cannot go on; run by hand:\n  {cmd}"))
}

/// What of `wanted` is not among the lines of `installed`.
///
/// Rustup lists components with the host behind them (`clippy-x86_64-unknown-linux-gnu`), targets as they are.
fn missing<'a>(wanted: &'a [String], installed: &str) -> Vec<&'a str> {
    let has = |name: &str| {
        installed
            .lines()
            .map(str::trim)
            .any(|line| line.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('-')))
    };
    wanted.iter().map(String::as_str).filter(|name| !has(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(list: &[&str]) -> Vec<String> {
        list.iter().map(|s| (*s).to_string()).collect()
    }

    #[test]
    fn toolchain_file_is_read() {
        let text = "[toolchain]\nchannel = \"1.95.0\"\ncomponents = [\"rustfmt\", \"clippy\"]\n\
                    targets = [\n  \"thumbv6m-none-eabi\", # M0\n  \"thumbv7em-none-eabihf\",\n]\nprofile = \"minimal\"\n";
        let toolchain = Toolchain::from_manifest(&Manifest::parse(text)).unwrap();
        assert_eq!(toolchain.channel, "1.95.0");
        assert_eq!(toolchain.components, ["rustfmt", "clippy"]);
        assert_eq!(toolchain.targets, ["thumbv6m-none-eabi", "thumbv7em-none-eabihf"]);
        assert_eq!(Toolchain::from_manifest(&Manifest::parse("[toolchain]\n")), None);
        assert_eq!(Toolchain::from_manifest(&Manifest::parse("")), None);
    }

    #[test]
    fn the_commands_to_run_by_hand_name_everything() {
        let toolchain = Toolchain {
            channel: "1.95.0".into(),
            components: strings(&["clippy"]),
            targets: strings(&["thumbv6m-none-eabi"]),
        };
        let root = Path::new(".");
        assert_eq!(
            toolchain.install(root).to_string(),
            "rustup toolchain install 1.95.0 --profile minimal --no-self-update"
        );
        let names = ["thumbv6m-none-eabi", "thumbv7em-none-eabihf"];
        let add = toolchain.add(root, Part::Target, &names);
        assert_eq!(
            lack(Part::Target, &names, &add),
            "target missing: thumbv6m-none-eabi, thumbv7em-none-eabihf; \
             run: rustup target add --toolchain 1.95.0 thumbv6m-none-eabi thumbv7em-none-eabihf"
        );
        assert_eq!(
            toolchain.add(root, Part::Component, &["clippy"]).to_string(),
            "rustup component add --toolchain 1.95.0 clippy"
        );
        assert_eq!(
            install_cargo_fuzz(root).to_string(),
            format!("cargo install cargo-fuzz --version {CARGO_FUZZ} --locked")
        );
    }

    #[test]
    fn another_cargo_fuzz_is_not_the_pinned_one() {
        assert!(is_pinned_cargo_fuzz(&format!("cargo-fuzz {CARGO_FUZZ}\n")));
        assert!(!is_pinned_cargo_fuzz("cargo-fuzz 0.12.0\n"));
        assert!(!is_pinned_cargo_fuzz(""));
    }

    #[test]
    fn only_what_is_missing_is_added() {
        let installed = "cargo-x86_64-unknown-linux-gnu\nclippy-x86_64-unknown-linux-gnu\n";
        assert_eq!(missing(&strings(&["rustfmt", "clippy"]), installed), ["rustfmt"]);
        let targets = "thumbv7em-none-eabihf\nx86_64-unknown-linux-gnu\n";
        assert_eq!(missing(&strings(&["thumbv7em-none-eabi"]), targets), ["thumbv7em-none-eabi"]);
        assert!(missing(&strings(&["thumbv7em-none-eabihf"]), targets).is_empty());
    }
}
