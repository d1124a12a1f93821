//! As much of the Thumb instruction set as tells calls and stack frames.

/// What an instruction does, as far as it matters here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Does {
    /// Calls a function and comes back.
    Calls(u32),
    /// Jumps: inside the function, or to another one instead of calling it at the end.
    Jumps(u32),
    /// Calls what a register holds.
    CallsRegister,
    /// Takes so many bytes of stack.
    Takes(u32),
    /// Anything else.
    Other,
}

/// The instruction at `address`, and its length in bytes.
pub(crate) fn decode(address: u32, first: u16, second: u16) -> (Does, u32) {
    let wide = first >> 11 >= 0b11101;
    if wide {
        (decode_wide(address, u32::from(first), u32::from(second)), 4)
    } else {
        (decode_narrow(address, u32::from(first)), 2)
    }
}

fn decode_narrow(address: u32, word: u32) -> Does {
    let target = |offset: i32| Does::Jumps(address.wrapping_add(4).wrapping_add_signed(offset));
    match word >> 8 {
        // b<cond>; the last two conditions are other instructions.
        0xD0..=0xDD => target(signed(word & 0xFF, 8) * 2),
        0xE0..=0xE7 => target(signed(word & 0x7FF, 11) * 2),
        // cbz, cbnz: forward inside the function.
        // push
        0xB4 | 0xB5 => Does::Takes(4 * (word & 0x1FF).count_ones()),
        // sub sp
        0xB0 if word & 0x80 != 0 => Does::Takes(4 * (word & 0x7F)),
        // blx register
        0x47 if word & 0x80 != 0 => Does::CallsRegister,
        _ => Does::Other,
    }
}

fn decode_wide(address: u32, first: u32, second: u32) -> Does {
    let from = |offset: i32| address.wrapping_add(4).wrapping_add_signed(offset);
    if first >> 11 == 0b11110 && second & 0x8000 != 0 {
        let sign = (first >> 10) & 1;
        let (j1, j2) = ((second >> 13) & 1, (second >> 11) & 1);
        let long = || {
            let (i1, i2) = (1 ^ j1 ^ sign, 1 ^ j2 ^ sign);
            let offset = (sign << 23) | (i1 << 22) | (i2 << 21) | ((first & 0x3FF) << 11) | (second & 0x7FF);
            signed(offset, 24) * 2
        };
        return match (second >> 12) & 0b101 {
            0b101 => Does::Calls(from(long())),
            0b001 => Does::Jumps(from(long())),
            // A condition, but for the codes that are system instructions.
            0b000 if (first >> 7) & 0b111 != 0b111 => {
                let offset =
                    (sign << 19) | (j2 << 18) | (j1 << 17) | ((first & 0x3F) << 11) | (second & 0x7FF);
                Does::Jumps(from(signed(offset, 20) * 2))
            }
            _ => Does::Other,
        };
    }
    match first {
        // stmdb sp!
        0xE92D => Does::Takes(4 * second.count_ones()),
        // str to below the stack pointer, which moves there
        0xF84D if second & 0x0F00 == 0x0D00 => Does::Takes(second & 0xFF),
        // vpush of single and of double registers
        0xED2D | 0xED6D => Does::Takes(4 * (second & 0xFF)),
        // sub sp, sp, immediate
        0xF1AD | 0xF5AD if second & 0x0F00 == 0x0D00 => Does::Takes(expanded(first, second)),
        0xF2AD if second & 0x0F00 == 0x0D00 => Does::Takes(immediate(first, second)),
        _ => Does::Other,
    }
}

/// The low `bits` of a number as a signed one.
fn signed(value: u32, bits: u32) -> i32 {
    (value << (32 - bits)).cast_signed() >> (32 - bits)
}

/// The twelve bits of an immediate.
fn immediate(first: u32, second: u32) -> u32 {
    ((first >> 10) & 1) << 11 | ((second >> 12) & 7) << 8 | second & 0xFF
}

/// An immediate that stands for a rotated byte.
fn expanded(first: u32, second: u32) -> u32 {
    let bits = immediate(first, second);
    let byte = bits & 0xFF;
    match bits >> 8 {
        0 => byte,
        1 => byte | byte << 16,
        2 => byte << 8 | byte << 24,
        3 => byte * 0x0101_0101,
        _ => (0x80 | bits & 0x7F).rotate_right(bits >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_and_jumps_say_where_to() {
        // From an assembler: at 0x100 `bl 0x200`, `bl 0x0`, `b.w 0x200`, `beq.w 0x200`, `b 0x100`, `beq 0x110`.
        assert_eq!(decode(0x100, 0xF000, 0xF87E), (Does::Calls(0x200), 4));
        assert_eq!(decode(0x100, 0xF7FF, 0xFF7E), (Does::Calls(0), 4));
        assert_eq!(decode(0x100, 0xF000, 0xB87E), (Does::Jumps(0x200), 4));
        assert_eq!(decode(0x100, 0xF000, 0x807E), (Does::Jumps(0x200), 4));
        assert_eq!(decode(0x100, 0xE7FE, 0), (Does::Jumps(0x100), 2));
        assert_eq!(decode(0x100, 0xD006, 0), (Does::Jumps(0x110), 2));
        assert_eq!(decode(0x100, 0x4798, 0), (Does::CallsRegister, 2));
        // bx lr
        assert_eq!(decode(0x100, 0x4770, 0), (Does::Other, 2));
    }

    #[test]
    fn frames_are_seen() {
        // push {r7, lr}; push.w {r4-r11, lr}; sub sp, #16; sub.w sp, sp, #512; vpush {d8-d10}
        assert_eq!(decode(0, 0xB580, 0).0, Does::Takes(8));
        assert_eq!(decode(0, 0xE92D, 0x4FF0).0, Does::Takes(36));
        assert_eq!(decode(0, 0xB084, 0).0, Does::Takes(16));
        assert_eq!(decode(0, 0xF5AD, 0x7D00).0, Does::Takes(512));
        assert_eq!(decode(0, 0xED2D, 0x8B06).0, Does::Takes(24));
    }
}
