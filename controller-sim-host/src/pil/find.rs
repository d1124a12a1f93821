//! The image and the emulator: found, built, or a word on how to get them.

use super::Target;
use super::emulator::QEMU;
use controller_pil::board::Board;
use controller_pil::image;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Why there is nothing to run on: a sentence, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// What is missing.
    pub message: String,
    /// What helps.
    pub help: Option<String>,
}

impl Missing {
    fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { message: message.into(), help: Some(help.into()) }
    }
}

/// The board with the image that `given` names; without one, the workspace's own image, built if it is not up to date.
///
/// # Errors
/// No emulator; an image for another board; outside of the workspace and no image given; an image that does not build.
pub fn find_image(board: &'static Board, given: Option<&Path>) -> Result<Target, Missing> {
    let version = Command::new(QEMU).arg("--version").stdin(Stdio::null()).output();
    if !version.is_ok_and(|output| output.status.success()) {
        let help = "Debian, Ubuntu: apt-get install qemu-system-arm; Fedora: dnf install qemu-system-arm; \
                    macOS: brew install qemu; in the workspace: cargo xtask setup";
        return Err(Missing::new(format!("the emulator {QEMU} is not installed"), help));
    }
    let image = match given {
        Some(path) => path.to_owned(),
        None => build(board)?,
    };
    let name = image.display();
    let bytes = std::fs::read(&image)
        .map_err(|error| Missing { message: format!("cannot read the image {name}: {error}"), help: None })?;
    match image::board_name(&bytes) {
        Some(found) if found == board.name => Ok(Target { board, image }),
        Some(found) => Err(Missing::new(format!("{name} is an image for {found}"), format!("--pil={found}"))),
        None => Err(Missing::new(
            format!("{name} is no image of controller-firmware: it names no board"),
            format!("build one: {}", command(board)),
        )),
    }
}

/// Into less flash \[bytes\] both number types do not fit unless the compiler saves space; the bits are the same.
const SMALL: u32 = 1 << 20;

/// The words of the command that builds the image, without `cargo`, and what it sets in the environment.
fn words(board: &Board) -> Vec<String> {
    let mut words: Vec<String> =
        ["build", "-p", "controller-firmware", "--bin", "pil", "--features", "pil", "--release", "--target"]
            .map(String::from)
            .to_vec();
    words.push(board.target.to_owned());
    if board.flash.length < SMALL {
        words.extend(["--config".to_owned(), "profile.release.opt-level='s'".to_owned()]);
    }
    words
}

/// Where the images of a board go that shares its target with another one: each would replace the other.
fn own_folder(board: &Board) -> Option<(String, PathBuf)> {
    let cpu = board.cpu?;
    let base = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    Some((format!("-Ctarget-cpu={cpu}"), base.join(cpu)))
}

/// The command that builds the image, for a person.
fn command(board: &Board) -> String {
    let mut text = String::new();
    let mut folder = String::new();
    if let Some((flags, own)) = own_folder(board) {
        text = format!("CONTROLLER_BOARD={} RUSTFLAGS={flags} ", board.name);
        folder = format!(" --target-dir {}", own.display());
    }
    let words = words(board).into_iter().map(|word| match word.contains('\'') {
        true => format!("\"{word}\""),
        false => word,
    });
    format!("{text}cargo {}{folder}", words.collect::<Vec<_>>().join(" "))
}

/// Lets cargo build the image, which takes no time when nothing has changed: an old image would be compared with a new law.
fn build(board: &Board) -> Result<PathBuf, Missing> {
    let root = std::env::current_dir().ok().and_then(|here| {
        let found = here.ancestors().find(|folder| folder.join("controller-firmware/Cargo.toml").is_file());
        found.map(Path::to_owned)
    });
    let shown = command(board);
    let Some(root) = root else {
        return Err(Missing::new(
            "no image for the board: outside of the workspace it must be given by --pil-image FILE",
            format!("in the workspace this builds one: {shown}"),
        ));
    };
    let mut cargo = Command::new("cargo");
    cargo.args(words(board)).args(["--quiet", "--message-format=json-render-diagnostics"]);
    // The first board of a target needs no name.
    cargo.current_dir(root).stdin(Stdio::null()).env_remove("CONTROLLER_BOARD");
    if let Some((flags, folder)) = own_folder(board) {
        cargo.env("CONTROLLER_BOARD", board.name).env("RUSTFLAGS", flags).arg("--target-dir").arg(folder);
    }
    let failed =
        |why: &str| Missing::new(format!("the image cannot be built: {why}"), format!("try: {shown}"));
    let output = cargo.output().map_err(|error| failed(&format!("cargo: {error}")))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).trim()));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().find_map(executable).ok_or_else(|| failed("cargo does not say where it is"))
}

/// The image, if this line of cargo's output is about it.
fn executable(line: &str) -> Option<PathBuf> {
    let message: serde_json::Value = serde_json::from_str(line).ok()?;
    if message.pointer("/target/name")?.as_str()? != "pil" {
        return None;
    }
    message.get("executable")?.as_str().map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_pil::board::named;

    #[test]
    fn boards_that_share_a_target_are_built_apart() {
        let [usual, other] = ["mps2-an386", "mps2-an500"].map(|name| command(named(name).expect("a board")));
        assert!(usual.starts_with(
            "cargo build -p controller-firmware --bin pil --features pil --release --target thumbv7em"
        ));
        assert!(
            other.starts_with("CONTROLLER_BOARD=mps2-an500 RUSTFLAGS=-Ctarget-cpu=cortex-m7 cargo build")
        );
        assert!(other.ends_with("cortex-m7") && !usual.contains("--target-dir"));
    }

    #[test]
    fn the_image_is_read_from_what_cargo_says() {
        let line = r#"{"reason":"compiler-artifact","target":{"name":"pil"},"executable":"/a/pil"}"#;
        assert_eq!(executable(line), Some(PathBuf::from("/a/pil")));
        assert_eq!(executable(&line.replace("\"pil\"", "\"core\"")), None);
        assert_eq!(executable(r#"{"reason":"build-finished","success":true}"#), None);
    }
}
