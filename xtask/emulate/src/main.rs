//! Runs an image on its emulated board: `emulate IMAGE [WORDS for the image..]`.
//!
//! Cargo calls it for images (`runner` in `.cargo/config.toml`), `cargo xtask` calls it for the rungs of the ladder. The
//! image itself says which board it is for; it is checked to be linked where that board has its memories. What the image
//! prints is passed on; if it logs through defmt, its stream is decoded. The exit code is the image's own, 124 if the
//! time limit (`EMULATE_SECONDS`, 60) ends it, 125 if it cannot be run.

mod image;
mod log;
mod machine;

use std::process::ExitCode;

/// Exit code when an image cannot be run.
const CANNOT_RUN: u8 = 125;

fn main() -> ExitCode {
    let mut words = std::env::args().skip(1);
    let Some(path) = words.next().filter(|word| !word.starts_with('-')) else {
        eprintln!("usage: emulate IMAGE [WORDS for the image..]");
        return ExitCode::from(CANNOT_RUN);
    };
    match run(&path, &words.collect::<Vec<_>>()) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {path}: {error:#}");
            ExitCode::from(CANNOT_RUN)
        }
    }
}

fn run(path: &str, words: &[String]) -> anyhow::Result<u8> {
    let elf = std::fs::read(path)?;
    let board = image::board_of(&elf)?;
    let log = log::Log::of(&elf)?;
    machine::run(board, path, words, log)
}
