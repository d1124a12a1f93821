//! Saving a state to words and reading it back: versioned, with its shape, checked.
//!
//! Layout: word 0 the format (`0x4354_0000` + version), word 1 the number of words and the number type, then the
//! state, last a CRC-32 (polynomial 0xEDB88320) over all words before it. Numbers are bit patterns, so that a
//! restored loop continues bit for bit.

use crate::delay::{DelayLine, Memory};
use crate::lag::Lag;
use crate::real::Real;
use core::fmt;

/// Version of the layout; a state saved under another version is refused.
pub const VERSION: u32 = 1;
const FORMAT: u32 = 0x4354_0000 | VERSION;
/// Words around a state: format, shape, checksum.
pub(crate) const FRAME: usize = 3;

/// Why a snapshot was not written or not read. The numbers are stable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
#[repr(u8)]
pub enum SnapshotError {
    /// The buffer is too short; see `snapshot_words`.
    TooShort = 1,
    /// Not a snapshot, or one of another version.
    Version = 2,
    /// A snapshot of a controller of another kind or size.
    Shape = 3,
    /// The checksum does not fit the words.
    Checksum = 4,
    /// The words are intact but hold no valid state.
    Invalid = 5,
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooShort => "the buffer is too short for this state",
            Self::Version => "not a snapshot of this version",
            Self::Shape => "the snapshot belongs to a controller of another shape",
            Self::Checksum => "the snapshot is damaged",
            Self::Invalid => "the snapshot holds no valid state",
        })
    }
}

impl core::error::Error for SnapshotError {}

/// CRC-32 (reflected, polynomial 0xEDB88320) of the words' bytes, low byte first.
fn crc32(words: &[u32]) -> u32 {
    let mut crc = u32::MAX;
    for byte in words.iter().flat_map(|w| w.to_le_bytes()) {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xEDB8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

/// Chain and shared lags are at most 8 and 3; a line longer than 2^24 cells shows in the number of words.
fn shape_mark(chain: usize, shared: usize, cells: usize) -> u32 {
    let low = |n: usize, bits: u32| u32::try_from(n & ((1 << bits) - 1)).unwrap_or(0);
    low(chain, 4) << 28 | low(shared, 4) << 24 | low(cells, 24)
}

fn shape_word<T: Real>(words: usize) -> Option<u32> {
    let count = u32::try_from(words).ok().filter(|&n| n < 1 << 28)?;
    Some(count | u32::try_from(T::WORDS).ok()? << 28)
}

/// Writes a state into `words`; `body` writes exactly `length` words.
pub(crate) fn write<T: Real>(
    words: &mut [u32],
    length: usize,
    body: impl FnOnce(&mut Writer<'_>),
) -> Result<usize, SnapshotError> {
    let total = length + FRAME;
    let shape = shape_word::<T>(total).ok_or(SnapshotError::Shape)?;
    let target = words.get_mut(..total).ok_or(SnapshotError::TooShort)?;
    let mut writer = Writer { words: target, at: 0, fits: true };
    writer.word(FORMAT);
    writer.word(shape);
    body(&mut writer);
    let (at, fits) = (writer.at, writer.fits);
    let sum = crc32(words.get(..total - 1).unwrap_or_default());
    match words.get_mut(total - 1) {
        Some(last) if fits && at == total - 1 => *last = sum,
        _ => return Err(SnapshotError::Shape),
    }
    Ok(total)
}

/// Checks the frame of `words` and hands the state's words to `body`.
pub(crate) fn read<T: Real, V>(
    words: &[u32],
    length: usize,
    body: impl FnOnce(&mut Reader<'_>) -> Option<V>,
) -> Result<V, SnapshotError> {
    let total = length + FRAME;
    if words.first() != Some(&FORMAT) {
        return Err(SnapshotError::Version);
    }
    if words.get(1).copied() != shape_word::<T>(total) {
        return Err(SnapshotError::Shape);
    }
    let checked = words.get(..total - 1).ok_or(SnapshotError::TooShort)?;
    let sum = words.get(total - 1).ok_or(SnapshotError::TooShort)?;
    if crc32(checked) != *sum {
        return Err(SnapshotError::Checksum);
    }
    let mut reader = Reader { words: checked.get(2..).unwrap_or_default() };
    body(&mut reader).ok_or(SnapshotError::Invalid)
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Writer<'_> {}
    impl Sealed for crate::checksum::Checksum {}
}

/// What the words of a law or of a state go to: a snapshot, a [`Checksum`](crate::Checksum). Sealed.
pub trait Words: sealed::Sealed {
    /// One more word.
    fn word(&mut self, word: u32);

    /// The bits of a number: a word of an `f32`, two of an `f64`, the low one first.
    #[inline(always)]
    fn number<T: Real>(&mut self, x: T) {
        let [low, high] = x.to_words();
        self.word(low);
        if T::WORDS == 2 {
            self.word(high);
        }
    }

    /// The bits of numbers.
    #[inline(always)]
    fn numbers<T: Real>(&mut self, list: &[T]) {
        list.iter().for_each(|&x| self.number(x));
    }

    /// The shape of what follows: lags of the chains, shared lags, cells of the line.
    fn shape(&mut self, chain: usize, shared: usize, cells: usize) {
        self.word(shape_mark(chain, shared, cells));
    }

    /// The numbers of lags.
    fn lags<T: Real>(&mut self, lags: &[Lag<T>]) {
        lags.iter().for_each(|lag| self.numbers(&lag.parts()));
    }

    /// The place of a line's newest sample, and its cells.
    fn line<T: Real, M: Memory<T>>(&mut self, line: &DelayLine<M>) {
        let (memory, newest) = line.parts();
        self.word(u32::try_from(newest).unwrap_or(u32::MAX));
        self.numbers(memory.as_ref());
    }
}

/// Writes the words of a state. Blocks of this crate use it.
#[derive(Debug)]
pub struct Writer<'a> {
    words: &'a mut [u32],
    at: usize,
    fits: bool,
}

impl Words for Writer<'_> {
    fn word(&mut self, word: u32) {
        match self.words.get_mut(self.at) {
            Some(cell) => *cell = word,
            None => self.fits = false,
        }
        self.at += 1;
    }
}

/// Reads the words of a state. Blocks of this crate use it; it has no public methods.
#[derive(Debug)]
pub struct Reader<'a> {
    words: &'a [u32],
}

impl Reader<'_> {
    pub(crate) fn word(&mut self) -> Option<u32> {
        let (first, rest) = self.words.split_first()?;
        self.words = rest;
        Some(*first)
    }

    /// The next number; `None` when it is not finite.
    pub(crate) fn number<T: Real>(&mut self) -> Option<T> {
        let low = self.word()?;
        let high = if T::WORDS == 2 { self.word()? } else { 0 };
        Some(T::from_words([low, high])).filter(|x| x.is_finite_number())
    }

    pub(crate) fn numbers<T: Real, const L: usize>(&mut self) -> Option<[T; L]> {
        let mut list = [T::ZERO; L];
        for x in &mut list {
            *x = self.number()?;
        }
        Some(list)
    }

    /// Checks the mark that [`Writer::shape`] left.
    pub(crate) fn shape(&mut self, chain: usize, shared: usize, cells: usize) -> Option<()> {
        (self.word()? == shape_mark(chain, shared, cells)).then_some(())
    }

    pub(crate) fn lags<T: Real>(&mut self, lags: &mut [Lag<T>]) -> Option<()> {
        for lag in lags {
            *lag = Lag::from_parts(self.numbers()?);
        }
        Some(())
    }

    /// The place of a line's newest sample; gives the size of the largest cell, without a step ahead.
    pub(crate) fn line<T: Real, M: Memory<T>>(&mut self, line: &mut DelayLine<M>) -> Option<f64> {
        let newest = usize::try_from(self.word()?).ok()?;
        let (memory, place) = line.parts_mut();
        let cells = memory.as_ref().len();
        if newest >= cells {
            return None;
        }
        *place = newest;
        let mut ahead = Reader { words: self.words };
        let mut largest = 0.0_f64;
        for _ in 0..cells {
            let size = ahead.number::<T>()?.to_f64().abs();
            largest = if size > largest { size } else { largest };
        }
        Some(largest)
    }

    /// A line's cells.
    pub(crate) fn cells<T: Real, M: Memory<T>>(&mut self, memory: &mut M) -> Option<()> {
        for cell in memory.as_mut() {
            *cell = self.number()?;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_usual_crc32() {
        // The check value of CRC-32 is for the nine bytes "123456789"; here eight of them, from an independent table.
        let words = [u32::from_le_bytes(*b"1234"), u32::from_le_bytes(*b"5678")];
        assert_eq!(crc32(&words), 0x9AE0_DAAF);
    }
}
