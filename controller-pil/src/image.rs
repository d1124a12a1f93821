//! Which board an image says it is for: the text of one section of its ELF file.

use crate::board::{self, Board};

/// The section in which an image names its board.
pub const SECTION: &[u8] = b".controller.board";

/// The name of the board in `elf`; `None`: not a 32-bit little-endian ELF file, or it names none.
#[must_use]
pub fn board_name(elf: &[u8]) -> Option<&str> {
    let magic = elf.get(..6)?;
    if magic != b"\x7fELF\x01\x01" {
        return None;
    }
    let table = word(elf, 0x20)?;
    let (size, count, names) = (half(elf, 0x2E)?, half(elf, 0x30)?, half(elf, 0x32)?);
    let header = |index: usize| table.checked_add(index.checked_mul(size)?);
    let content = |index: usize| {
        let at = header(index)?;
        let (begin, length) = (word(elf, at.checked_add(16)?)?, word(elf, at.checked_add(20)?)?);
        elf.get(begin..begin.checked_add(length)?)
    };
    let texts = content(names)?;
    let named = |index: usize| {
        let name = texts.get(word(elf, header(index)?)?..)?;
        Some(name.starts_with(SECTION) && name.get(SECTION.len()) == Some(&0))
    };
    let section = (0..count).find(|&index| named(index) == Some(true))?;
    core::str::from_utf8(content(section)?).ok()
}

/// The board in `elf`, when it is a known one.
#[must_use]
pub fn board_of(elf: &[u8]) -> Option<&'static Board> {
    board_name(elf).and_then(board::named)
}

fn half(bytes: &[u8], at: usize) -> Option<usize> {
    let pair = bytes.get(at..)?.first_chunk()?;
    Some(usize::from(u16::from_le_bytes(*pair)))
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let four = bytes.get(at..)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*four)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A file of a header, the names, the board's name, and two section headers.
    fn elf(board: &[u8; 10]) -> [u8; 160] {
        let mut file = [0; 160];
        let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
        put(0, b"\x7fELF\x01\x01");
        put(0x20, &80_u32.to_le_bytes());
        put(0x2E, &[40, 0, 2, 0, 0, 0]);
        put(52, SECTION);
        put(70, board);
        put(80, &[17, 0, 0, 0]);
        put(80 + 16, &[52, 0, 0, 0, 18, 0, 0, 0]);
        put(120 + 16, &[70, 0, 0, 0, 10, 0, 0, 0]);
        file
    }

    #[test]
    fn the_name_is_found() {
        assert_eq!(board_name(&elf(b"mps2-an385")), Some("mps2-an385"));
        assert_eq!(board_of(&elf(b"mps2-an385")).map(|board| board.core), Some("Cortex-M3"));
        assert_eq!(board_of(&elf(b"mps2-an999")), None);
        assert_eq!(board_name(b"#!/bin/sh\n"), None);
    }

    proptest! {
        #[test]
        fn any_file_is_read(mut bytes in prop::array::uniform32(any::<u8>()), at in 6_usize..150, whole: bool) {
            let mut file = elf(b"mps2-an385");
            let end = (at + 8).min(160);
            file[at..end].copy_from_slice(&bytes[..end - at]);
            let _ = board_name(if whole { &file } else { &file[..at] });
            bytes[..6].copy_from_slice(b"\x7fELF\x01\x01");
            let _ = board_name(&bytes);
        }
    }
}
