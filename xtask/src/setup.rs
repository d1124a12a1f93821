//! Set-up: what the pinned toolchain must have before the ladder can run.
//!
//! `rust-toolchain.toml` is the one list of components and targets. Rustup adds them by itself only when its automatic
//! installation is on; build machines tend to have it off, so the list is read and compared here.

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

    /// The command that installs all of it at once.
    fn install(&self, root: &Path) -> Cmd {
        let mut cmd = Cmd::new("rustup", root).args([
            "toolchain",
            "install",
            self.channel.as_str(),
            "--profile",
            "minimal",
            "--no-self-update",
        ]);
        for component in &self.components {
            cmd = cmd.args(["--component", component.as_str()]);
        }
        for target in &self.targets {
            cmd = cmd.args(["--target", target.as_str()]);
        }
        cmd
    }
}

/// Makes sure that the pinned toolchain has its components and targets; adds only what is missing.
pub(crate) fn toolchain(root: &Path) -> Outcome {
    let pinned = Toolchain::read(root)?;
    let channel = pinned.channel.as_str();
    let rustup = || Cmd::new("rustup", root);
    if rustup().arg("--version").probe().is_none() {
        return Err(format!(
            "rustup is missing; install it from https://rustup.rs and run:\n  {}",
            pinned.install(root)
        ));
    }
    let installed = |kind: &str| rustup().args([kind, "list", "--installed", "--toolchain", channel]).probe();
    let (Some(components), Some(targets)) = (installed("component"), installed("target")) else {
        println!("toolchain {channel} is not there yet");
        return by_hand(&pinned.install(root));
    };
    let missing_components = missing(&pinned.components, &components);
    let missing_targets = missing(&pinned.targets, &targets);
    if !missing_components.is_empty() {
        by_hand(&rustup().args(["component", "add", "--toolchain", channel]).args(missing_components))?;
    }
    if !missing_targets.is_empty() {
        by_hand(&rustup().args(["target", "add", "--toolchain", channel]).args(missing_targets))?;
    }
    println!(
        "toolchain {channel}: {} with {}",
        pinned.components.join(", "),
        if pinned.targets.is_empty() { "no further target".into() } else { pinned.targets.join(", ") }
    );
    Ok(())
}

/// Makes sure that cargo-fuzz is there, and a nightly compiler if one can be had.
pub(crate) fn fuzzing(root: &Path) -> Outcome {
    if !nightly(root) {
        let install = ["toolchain", "install", "nightly", "--profile", "minimal", "--no-self-update"];
        if let Err(message) = Cmd::new("rustup", root).args(install).run() {
            // Not an error: the pinned compiler can fuzz as well, only without the address sanitizer.
            println!(
                "{message}\nno nightly compiler: fuzzing will use the pinned one, without the address sanitizer"
            );
        }
    }
    if !cargo_fuzz(root) {
        by_hand(&Cmd::cargo(root).args(["install", "cargo-fuzz", "--locked"]))?;
    }
    println!("fuzzing: cargo-fuzz with the {} compiler", if nightly(root) { "nightly" } else { "pinned" });
    Ok(())
}

/// Whether a nightly compiler is installed.
pub(crate) fn nightly(root: &Path) -> bool {
    // The question must not install one by the way.
    Cmd::new("rustup", root)
        .env("RUSTUP_AUTO_INSTALL", "0")
        .args(["run", "nightly", "rustc", "--version"])
        .probe()
        .is_some()
}

/// Whether cargo-fuzz is installed.
pub(crate) fn cargo_fuzz(root: &Path) -> bool {
    Cmd::cargo(root).args(["fuzz", "--version"]).probe().is_some()
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
    fn the_command_for_a_bare_machine_names_everything() {
        let toolchain = Toolchain {
            channel: "1.95.0".into(),
            components: strings(&["clippy"]),
            targets: strings(&["thumbv6m-none-eabi"]),
        };
        assert_eq!(
            toolchain.install(Path::new(".")).to_string(),
            "rustup toolchain install 1.95.0 --profile minimal --no-self-update \
             --component clippy --target thumbv6m-none-eabi"
        );
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
