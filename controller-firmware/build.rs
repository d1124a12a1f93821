//! Chooses the board and tells the linker where its memories are.
//!
//! The board is named by `CONTROLLER_BOARD`; without it, it is the first one of the target. With `CONTROLLER_RAM_SIZE` \[bytes\]
//! an image is linked for less RAM than the board has, as a smaller chip of the family would have it. The numbers go to the linker
//! as symbols that the `memory.x` in the workspace root asks for: a map of our own could not win over that file.

use controller_pil::board::{self, Board};

/// The least RAM that is worth linking for \[bytes\].
const LEAST_RAM: u32 = 4 << 10;
/// With less flash \[bytes\] than this, images leave out what is large.
const SMALL: u32 = 1 << 20;

fn main() {
    println!("cargo:rustc-check-cfg=cfg(small_flash)");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../memory.x");
    println!("cargo:rerun-if-env-changed=CONTROLLER_BOARD");
    println!("cargo:rerun-if-env-changed=CONTROLLER_RAM_SIZE");
    let target = std::env::var("TARGET").expect("cargo names the target");
    // On the host the images are empty programs.
    let Some(usual) = board::of_target(&target) else {
        println!("cargo:rustc-env=CONTROLLER_BOARD={}", std::env::consts::ARCH);
        return;
    };
    let chosen = chosen(usual, &target).and_then(|board| Ok((board, ram_size(board)?)));
    let (board, ram_size) = chosen.unwrap_or_else(|message| {
        println!("cargo::error={message}");
        std::process::exit(1)
    });
    println!("cargo:rustc-env=CONTROLLER_BOARD={}", board.name);
    println!("cargo:rustc-env=CONTROLLER_CLOCK={}", board.clock);
    if board.flash.length < SMALL {
        println!("cargo:rustc-cfg=small_flash");
    }
    let numbers = [
        ("board_flash", board.flash.origin),
        ("board_flash_size", board.flash.length),
        ("board_ram", board.ram.origin),
        ("board_ram_size", ram_size),
    ];
    for (symbol, value) in numbers {
        println!("cargo:rustc-link-arg=--defsym={symbol}={value:#x}");
    }
    println!("cargo:rustc-link-arg=-Tlink.x");
    // Every image can format through defmt, those that do not log as well: its names need a place that is not loaded.
    println!("cargo:rustc-link-arg=-Tdefmt.x");
}

/// The board that was asked for.
fn chosen(usual: &'static Board, target: &str) -> Result<&'static Board, String> {
    let board = match asked("CONTROLLER_BOARD") {
        None => usual,
        Some(name) => board::named(&name).ok_or_else(|| {
            let known: Vec<_> = board::BOARDS.iter().map(|b| b.name).collect();
            format!("CONTROLLER_BOARD={name}: no such board; there are {}", known.join(", "))
        })?,
    };
    if board.target == target {
        Ok(board)
    } else {
        Err(format!("the board {} needs --target {}, not {target}", board.name, board.target))
    }
}

/// The RAM to link for \[bytes\].
fn ram_size(board: &Board) -> Result<u32, String> {
    let most = board.ram.length;
    let Some(text) = asked("CONTROLLER_RAM_SIZE") else { return Ok(most) };
    // The stack begins at its end, at a multiple of 8.
    let possible = |size: &u32| (LEAST_RAM..=most).contains(size) && size.is_multiple_of(8);
    text.parse().ok().filter(possible).ok_or_else(|| {
        format!("CONTROLLER_RAM_SIZE={text}: {} takes multiples of 8 from {LEAST_RAM} to {most}", board.name)
    })
}

/// A variable that is set, and not to nothing.
fn asked(variable: &str) -> Option<String> {
    std::env::var(variable).ok().filter(|text| !text.is_empty())
}
