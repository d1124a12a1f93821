//! Frames on a serial line, where bytes get lost: a checksum, and a zero byte that ends every packet.
//!
//! Packet: COBS of (frame, CRC-16 low byte first), then one zero byte, which occurs nowhere else (Cheshire and Baker,
//! "Consistent overhead byte stuffing", 1999). CRC-16: polynomial 0x1021, first value 0xFFFF, nothing reflected (X.25's
//! polynomial, "CCITT-FALSE"). Whatever was lost, the next packet after a zero byte is read again. An emulated board talks
//! through pipes, which lose nothing, and needs none of this.

/// Bytes of the checksum.
const CHECK: usize = 2;

/// Most bytes of the packet of a frame of `frame` bytes: one byte more per 254, the first and the zero.
#[must_use]
pub const fn packet_bytes(frame: usize) -> usize {
    let bytes = frame + CHECK;
    bytes + bytes / 254 + 2
}

/// CRC-16 of `bytes`, continued from `crc` (0xFFFF to begin).
#[must_use]
pub fn crc16(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |mut crc, &byte| {
        crc ^= u16::from(byte) << 8;
        for _ in 0..8 {
            crc = if crc & 0x8000 != 0 { crc << 1 ^ 0x1021 } else { crc << 1 };
        }
        crc
    })
}

/// The packet of `frame`, zero byte included, in `packet`; `None`: it does not fit.
///
/// ```
/// use controller_pil::serial::{Unpacker, pack};
/// let mut packet = [0; 16];
/// let packet = pack(&[0, 7, 0], &mut packet).unwrap();
/// assert_eq!(packet.iter().filter(|&&byte| byte == 0).count(), 1);
/// let mut unpacker = Unpacker::<16>::new();
/// let (last, others) = packet.split_last().unwrap();
/// assert!(others.iter().all(|&byte| unpacker.push(byte).is_none()));
/// assert_eq!(unpacker.push(*last), Some(Ok(&[0, 7, 0][..])));
/// ```
pub fn pack<'a>(frame: &[u8], packet: &'a mut [u8]) -> Option<&'a [u8]> {
    let check = crc16(0xFFFF, frame).to_le_bytes();
    // Where the length of the running block goes, and where the next byte goes.
    let (mut head, mut at) = (0, 1);
    for &byte in frame.iter().chain(&check) {
        if byte != 0 {
            *packet.get_mut(at)? = byte;
            at += 1;
        }
        if byte == 0 || at - head == 0xFF {
            *packet.get_mut(head)? = u8::try_from(at - head).ok()?;
            head = at;
            at += 1;
        }
    }
    *packet.get_mut(head)? = u8::try_from(at - head).ok()?;
    *packet.get_mut(at)? = 0;
    packet.get(..=at)
}

/// A packet that came in damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Damaged;

/// Finds frames of up to `N - 2` bytes in bytes that come one by one.
#[derive(Debug, Clone)]
pub struct Unpacker<const N: usize> {
    bytes: [u8; N],
    /// Bytes that have come out; more than `N`: too many.
    length: usize,
    /// Bytes of the running block still to come.
    left: u8,
    /// A zero stands where the block ends.
    zero: bool,
    /// Something has come since the last zero byte.
    begun: bool,
}

impl<const N: usize> Default for Unpacker<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Unpacker<N> {
    /// Before the first byte.
    #[must_use]
    pub const fn new() -> Self {
        Self { bytes: [0; N], length: 0, left: 0, zero: false, begun: false }
    }

    /// One more byte; gives the frame, or that it was damaged, when a packet ends with it.
    pub fn push(&mut self, byte: u8) -> Option<Result<&[u8], Damaged>> {
        if byte == 0 {
            let whole = self.left == 0 && self.length <= N;
            let (length, begun) = (self.length, self.begun);
            (self.length, self.left, self.zero, self.begun) = (0, 0, false, false);
            return begun.then(|| if whole { self.checked(length) } else { Err(Damaged) });
        }
        self.begun = true;
        if self.left > 0 {
            self.left -= 1;
            self.keep(byte);
        } else {
            if self.zero {
                self.keep(0);
            }
            self.left = byte - 1;
            self.zero = byte != 0xFF;
        }
        None
    }

    fn keep(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        } else {
            self.length = N + 1;
        }
    }

    fn checked(&self, length: usize) -> Result<&[u8], Damaged> {
        let (frame, check) = self.bytes.get(..length).and_then(<[u8]>::split_last_chunk).ok_or(Damaged)?;
        if crc16(0xFFFF, frame) == u16::from_le_bytes(*check) { Ok(frame) } else { Err(Damaged) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn packed(frame: &[u8]) -> Vec<u8> {
        let mut packet = [0; packet_bytes(1024)];
        pack(frame, &mut packet).expect("fits").to_vec()
    }

    /// Everything that comes out of `bytes`.
    fn unpacked(bytes: &[u8]) -> Vec<Result<Vec<u8>, Damaged>> {
        let mut unpacker = Unpacker::<1026>::new();
        bytes.iter().filter_map(|&b| unpacker.push(b).map(|r| r.map(<[u8]>::to_vec))).collect()
    }

    #[test]
    fn the_checksum_has_its_published_check_value() {
        assert_eq!(crc16(0xFFFF, b"123456789"), 0x29B1);
        assert_eq!(crc16(crc16(0xFFFF, b"1234"), b"56789"), 0x29B1);
    }

    #[test]
    fn stuffing_is_as_published() {
        // An example of the article, 11 22 00 33 -> 03 11 22 02 33, with two bytes more in the last block: the checksum.
        assert_eq!(packed(&[0x11, 0x22, 0, 0x33])[..5], [3, 0x11, 0x22, 4, 0x33]);
        // 254 bytes without a zero: one full block, then a new one.
        let long: Vec<u8> = (1..=254).collect();
        let packet = packed(&long);
        assert_eq!((packet[0], &packet[1..255]), (0xFF, &long[..]));
    }

    #[test]
    fn a_frame_too_long_for_the_buffer_is_damaged_and_the_next_one_is_read() {
        let mut unpacker = Unpacker::<8>::new();
        let mut bytes = packed(&[1; 7]);
        bytes.extend(packed(&[5, 0, 6]));
        let out: Vec<_> =
            bytes.iter().filter_map(|&b| unpacker.push(b).map(|r| r.map(<[u8]>::to_vec))).collect();
        assert_eq!(out, [Err(Damaged), Ok([5, 0, 6].to_vec())]);
    }

    proptest! {
        #[test]
        fn frames_come_back(frames in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..1024), 1..4)) {
            let mut line = Vec::new();
            for frame in &frames {
                let packet = packed(frame);
                prop_assert!(packet.len() <= packet_bytes(frame.len()));
                prop_assert_eq!(packet.iter().position(|&b| b == 0), Some(packet.len() - 1));
                line.extend(packet);
            }
            let wanted: Vec<_> = frames.into_iter().map(Ok).collect();
            prop_assert_eq!(unpacked(&line), wanted);
        }

        #[test]
        fn runs_without_a_zero_come_back(length in 250_usize..770, zero_at in 0_usize..770) {
            let mut frame: Vec<u8> = (0..length).map(|i| (i % 255) as u8 + 1).collect();
            if let Some(byte) = frame.get_mut(zero_at) {
                *byte = 0;
            }
            prop_assert_eq!(unpacked(&packed(&frame)), [Ok(frame)]);
        }

        #[test]
        fn one_wrong_bit_is_seen_and_the_next_frame_is_read(
            frame in prop::collection::vec(any::<u8>(), 0..64), at: prop::sample::Index, bit in 0..8_u32
        ) {
            let mut line = packed(&frame);
            let place = at.index(line.len());
            line[place] ^= 1_u8 << bit;
            line.push(0);
            line.extend(packed(&[1, 2]));
            let out = unpacked(&line);
            prop_assert_eq!(out.last(), Some(&Ok([1, 2].to_vec())));
            prop_assert!(!out[..out.len() - 1].contains(&Ok(frame)));
        }

        #[test]
        fn any_bytes_are_taken(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let mut line = bytes;
            line.push(0);
            line.extend(packed(&[9]));
            let out = unpacked(&line);
            prop_assert_eq!(out.last(), Some(&Ok([9].to_vec())));
        }
    }
}
