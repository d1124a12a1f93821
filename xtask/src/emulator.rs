//! Images on emulated boards: the emulator, building them, running them.

use std::path::{Path, PathBuf};

use controller_pil::board::{BOARDS, Board};

use crate::failing;
use crate::ladder::Done;
use crate::packages;
use crate::setup::{self, Part};
use crate::shell::{Cmd, Outcome, in_ci, target_dir};

/// The emulator's program ..
const QEMU: &str = "qemu-system-arm";
/// .. and the package of Debian that it is in.
const PACKAGE: &str = "qemu-system-arm";

/// The package with the images.
pub(crate) const FIRMWARE: &str = "controller-firmware";

/// The reference board.
pub(crate) const REFERENCE: &Board = &BOARDS[0];

/// Installs the emulator if it is missing and that may be done; or else says what is lacking.
pub(crate) fn ready(root: &Path) -> Option<String> {
    if there(root) { None } else { packages::install(root, &[PACKAGE], || there(root)) }
}

fn there(root: &Path) -> bool {
    Cmd::new(QEMU, root).arg("--version").probe().is_some()
}

/// Why a rung that runs images cannot run here, if it cannot.
///
/// A person may do without an emulator; an automatic build that left it out would look like one that had run the images.
pub(crate) fn lacking(root: &Path) -> Outcome<Option<Done>> {
    let mut targets: Vec<String> = BOARDS.iter().map(|board| board.target.into()).collect();
    targets.dedup();
    if let Some(message) = setup::lacking(root, Part::Target, &targets)? {
        return Ok(Some(Done::Lacking(message)));
    }
    let message = if in_ci() {
        ready(root)
    } else {
        (!there(root)).then(|| format!("{QEMU} is missing; run: cargo xtask setup"))
    };
    Ok(message.map(|message| if in_ci() { Done::Lacking(message) } else { Done::Skipped(message) }))
}

/// The board with this name.
pub(crate) fn board(name: &str) -> Outcome<&'static Board> {
    controller_pil::board::named(name).ok_or_else(|| format!("no board is named {name}"))
}

/// Adds what a command of cargo needs to build for a board.
pub(crate) fn for_board(cmd: Cmd, root: &Path, board: &Board) -> Cmd {
    let cmd = cmd.env("CONTROLLER_BOARD", board.name).args(["--release", "--target", board.target]);
    match board.cpu {
        None => cmd,
        Some(cpu) => {
            // Of this target alone: what runs the image is built for the host, and inherits the variable.
            let variable =
                format!("CARGO_TARGET_{}_RUSTFLAGS", board.target.to_uppercase().replace(['-', '.'], "_"));
            cmd.env(&variable, &format!("-Ctarget-cpu={cpu}")).arg("--target-dir").arg(folder(root, board))
        }
    }
}

/// Where images for a board are built: boards of one target with different processors must not share a folder.
fn folder(root: &Path, board: &Board) -> PathBuf {
    let base = target_dir(root);
    board.cpu.map_or_else(|| base.clone(), |cpu| base.join(cpu))
}

/// Builds an image of [`FIRMWARE`] for a board; gives its path.
pub(crate) fn image(root: &Path, board: &Board, name: &str, args: &[&str]) -> Outcome<PathBuf> {
    let cmd = Cmd::cargo(root).args(["build", "-p", FIRMWARE, "--bin", name]);
    for_board(cmd, root, board).args(args).run()?;
    Ok(folder(root, board).join(board.target).join("release").join(name))
}

/// The command that runs an image for at most `seconds`, as cargo's runner does.
pub(crate) fn emulated(root: &Path, image: &Path, words: &[&str], seconds: u32) -> Cmd {
    Cmd::cargo(root)
        .env("EMULATE_SECONDS", &seconds.to_string())
        .args(["run", "--quiet", "--target", "host-tuple", "--package", "controller-emulate", "--"])
        .arg(image)
        .args(words)
}

/// The tests that run on the microcontroller, on every board.
pub(crate) fn on_target(root: &Path) -> Outcome<Done> {
    if let Some(end) = lacking(root)? {
        return Ok(end);
    }
    for board in &BOARDS {
        println!("{} ({})", board.name, board.core);
        let cmd = Cmd::cargo(root).args(["test", "-p", FIRMWARE]);
        for_board(cmd, root, board).run()?;
    }
    let failing = failing::check(root)?;
    let cores: Vec<&str> = BOARDS.iter().map(|board| board.core).collect();
    Ok(Done::Passed(format!("{}; {failing}", cores.join(", "))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_told_to_its_target_alone_and_in_a_folder_of_its_own() {
        let root = Path::new("root");
        let text = for_board(Cmd::cargo(root), root, board("mps2-an500").unwrap()).to_string();
        assert!(text.starts_with(
            "CONTROLLER_BOARD=mps2-an500 CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS=-Ctarget-cpu=cortex-m7 cargo"
        ));
        assert!(text.ends_with("cortex-m7"), "{text}");
        let text = for_board(Cmd::cargo(root), root, REFERENCE).to_string();
        assert!(!text.contains("RUSTFLAGS") && !text.contains("--target-dir"), "{text}");
        assert!(board("mps3").is_err());
    }
}
