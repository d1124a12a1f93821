//! Chooses the board and tells the linker where its memories are.
//!
//! The board is named by `CONTROLLER_BOARD`; without it, it is the first one of the target. The numbers go to the linker
//! as symbols that the `memory.x` in the workspace root asks for: a map of our own could not win over that file.

use controller_pil::board;

/// With less flash \[bytes\] than this, images leave out what is large.
const SMALL: u32 = 1 << 20;

fn main() {
    println!("cargo:rustc-check-cfg=cfg(small_flash)");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../memory.x");
    println!("cargo:rerun-if-env-changed=CONTROLLER_BOARD");
    let target = std::env::var("TARGET").expect("cargo names the target");
    // On the host the images are empty programs.
    let Some(usual) = board::of_target(&target) else {
        println!("cargo:rustc-env=CONTROLLER_BOARD={}", std::env::consts::ARCH);
        return;
    };
    let board = match std::env::var("CONTROLLER_BOARD") {
        Ok(name) if !name.is_empty() => board::named(&name).unwrap_or_else(|| {
            let known: Vec<_> = board::BOARDS.iter().map(|b| b.name).collect();
            panic!("CONTROLLER_BOARD={name}: no such board; there are {}", known.join(", "))
        }),
        _ => usual,
    };
    assert_eq!(board.target, target, "the board {} needs --target {}", board.name, board.target);
    println!("cargo:rustc-env=CONTROLLER_BOARD={}", board.name);
    println!("cargo:rustc-env=CONTROLLER_CLOCK={}", board.clock);
    if board.flash.length < SMALL {
        println!("cargo:rustc-cfg=small_flash");
    }
    let numbers = [
        ("board_flash", board.flash.origin),
        ("board_flash_size", board.flash.length),
        ("board_ram", board.ram.origin),
        ("board_ram_size", board.ram.length),
    ];
    for (symbol, value) in numbers {
        println!("cargo:rustc-link-arg=--defsym={symbol}={value:#x}");
    }
    println!("cargo:rustc-link-arg=-Tlink.x");
    // Every image can format through defmt, those that do not log as well: its names need a place that is not loaded.
    println!("cargo:rustc-link-arg=-Tdefmt.x");
}
