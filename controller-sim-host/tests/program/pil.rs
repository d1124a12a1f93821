//! Processor in the loop: what is missing is said with what helps. That the bits are the same is a rung of the ladder.

use crate::folder::{Folder, json};

const LOOP: &str = "version = 1\nts = 0.1\nduration = 1.0\nplant.tf = \"1/(1+s)\"\n\
                    [[controller]]\nname = \"PI\"\npid = { kp = 1.0, ki = 1.0 }\n";

/// The head of an image, as far as it is read here: it names the reference board.
fn image() -> Vec<u8> {
    let mut file = vec![0; 160];
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, b"\x7fELF\x01\x01");
    put(0x20, &80_u32.to_le_bytes());
    put(0x2E, &[40, 0, 2, 0, 0, 0]);
    put(52, b".controller.board");
    put(70, b"mps2-an386");
    put(80, &[17, 0, 0, 0]);
    put(80 + 16, &[52, 0, 0, 0, 18, 0, 0, 0]);
    put(120 + 16, &[70, 0, 0, 0, 10, 0, 0, 0]);
    file
}

/// A folder with the loop, an image, and a program in the place of the emulator that does `what`.
#[cfg(unix)]
fn folder(name: &str, what: &str) -> Folder {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new(name);
    folder.write("loop.toml", LOOP);
    folder.write("qemu-system-arm", &format!("#!/bin/sh\n[ \"$1\" = --version ] && exit 0\n{what}\n"));
    std::fs::write(folder.0.join("pil"), image()).expect("writable");
    let program = folder.0.join("qemu-system-arm");
    std::fs::set_permissions(program, std::fs::Permissions::from_mode(0o755)).expect("executable");
    folder
}

/// Runs with that program found first, and temporary files in the folder.
#[cfg(unix)]
fn run(folder: &Folder, arguments: &[&str]) -> std::process::Output {
    let path = format!("{}:/usr/bin:/bin", folder.0.display());
    let mut command = folder.command(arguments);
    command.env("PATH", path).env("TMPDIR", &folder.0).output().expect("the program starts")
}

#[test]
fn an_unknown_board_and_an_image_without_a_board_are_refused() {
    let folder = Folder::new("pil-usage");
    folder.write("loop.toml", LOOP);
    assert!(folder.refused(&["run", "loop.toml", "--pil=mps2"]).contains("mps2-an386"));
    assert!(folder.refused(&["run", "loop.toml", "--pil-image", "x"]).contains("--pil"));
}

#[test]
fn without_the_emulator_it_is_said_how_to_get_it() {
    let folder = Folder::new("pil-nothing");
    folder.write("loop.toml", LOOP);
    let output = folder.command(&["run", "loop.toml", "--pil", "--json"]).env("PATH", "").output();
    let output = output.expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    let error = &json(&output)["error"];
    assert_eq!(error["code"], "pil");
    assert!(error["help"].as_str().expect("help").contains("apt-get install qemu-system-arm"));
}

#[cfg(unix)]
#[test]
fn an_image_is_asked_for_and_looked_at() {
    let folder = folder("pil-image", "exit 0");
    let shown = |arguments: &[&str]| {
        let output = run(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(
        shown(&["run", "loop.toml", "--pil", "--pil-image", "none"]).contains("cannot read the image none")
    );
    let other = shown(&["run", "loop.toml", "--pil=microbit", "--pil-image", "pil"]);
    assert!(other.contains("pil is an image for mps2-an386"), "{other}");
    let text = shown(&["run", "loop.toml", "--pil", "--pil-image", "loop.toml"]);
    assert!(text.contains("no image of controller-firmware") && text.contains("cargo build"), "{text}");
}

#[cfg(unix)]
#[test]
fn an_emulator_that_ends_is_told_with_what_it_said_and_leaves_nothing() {
    let folder = folder("pil-ends", "echo 'hard fault at 0x00000008'; exit 102");
    let before = folder.names();
    let output = run(&folder, &["run", "loop.toml", "--pil", "--pil-image", "pil", "--csv", "out.csv"]);
    let shown = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{shown}");
    assert!(shown.contains("the emulator ended") && shown.contains("hard fault at 0x00000008"), "{shown}");
    assert_eq!(folder.names(), before);
}
