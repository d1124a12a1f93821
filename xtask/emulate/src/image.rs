//! What an image says about itself.

use anyhow::{Context as _, bail, ensure};
use controller_pil::board::{self, Board};
use object::{Object as _, ObjectSection as _};

/// The section in which an image names its board.
const NAME: &str = ".controller.board";
/// The section at which a Cortex-M starts: the first stack pointer, then the address of the first instruction.
const VECTORS: &str = ".vector_table";

/// The board of an image that is linked where that board has its memories.
///
/// # Errors
/// When the image names no board, or one that is not known, or lies where that board has nothing.
pub(crate) fn board_of(elf: &[u8]) -> anyhow::Result<&'static Board> {
    let file = object::File::parse(elf).context("not an ELF file")?;
    let name =
        file.section_by_name(NAME).context("names no board: is it an image of controller-firmware?")?;
    let name = std::str::from_utf8(name.data()?).context("the name of its board is not text")?;
    let board = board::named(name).with_context(|| format!("its board `{name}` is not known here"))?;
    let vectors = file.section_by_name(VECTORS).context("has no vector table")?;
    let origin = vectors.address();
    ensure!(
        origin == u64::from(board.flash.origin),
        "linked for flash at {origin:#010x}, {name} has it at {:#010x}: which memory.x was used?",
        board.flash.origin
    );
    let [stack, reset] = first_words(vectors.data()?)?;
    // The first push is below it.
    ensure!(
        board.ram.contains(stack.wrapping_sub(4)),
        "its stack begins at {stack:#010x}, outside the RAM of {name}"
    );
    ensure!(board.flash.contains(reset), "starts at {reset:#010x}, outside the flash of {name}");
    Ok(board)
}

fn first_words(table: &[u8]) -> anyhow::Result<[u32; 2]> {
    let [a, b, c, d, e, f, g, h, ..] = *table else { bail!("its vector table is too short") };
    Ok([u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])])
}
