//! Frames: kinds, codes, header, and numbers as little-endian bytes.
//!
//! | bytes | request | answer |
//! |---|---|---|
//! | 0 | [`Kind`] | the same |
//! | 1 | 0 | [`Code`] |
//! | 2, 3 | length of what follows the header | likewise |
//! | 4 to 7 | number of the request | the same |
//!
//! An `f64` is 8 bytes and an `f32` 4, their bit patterns, low byte first; a number that may be absent is one byte 0 or 1
//! and then the number.

/// Version of the frames; both sides must have the same.
pub const VERSION: u16 = 1;
/// Bytes of a header.
pub const HEADER: usize = 8;
/// Most bytes behind a header.
pub const LONGEST: usize = 1024;
/// Most bytes of a frame.
pub const FRAME: usize = HEADER + LONGEST;

macro_rules! numbered {
    ($(#[$top:meta])* $type:ident { $($(#[$doc:meta])* $name:ident = $number:literal,)* }) => {
        $(#[$top])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum $type { $($(#[$doc])* $name = $number,)* }

        impl $type {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The one with this number.
            #[must_use]
            pub const fn from_number(number: u8) -> Option<Self> {
                match number { $($number => Some(Self::$name),)* _ => None }
            }
        }
    };
}

numbered! {
    /// What a frame asks for.
    Kind {
        /// Versions; the answer names the board and its memory.
        Hello = 1,
        /// Build a controller from its configuration; its state is zeroed.
        Build = 2,
        /// Put it at rest.
        Settle = 3,
        /// One sample.
        Step = 4,
        /// Build a law from another configuration and let it take the state over.
        Adopt = 5,
        /// Samples were lost.
        Advance = 6,
        /// Save the state on the board; the answer has its words and its checksum.
        Save = 7,
        /// Read some of the saved words.
        Fetch = 8,
        /// Replace some of the saved words.
        Store = 9,
        /// Go back to the saved words.
        Restore = 10,
        /// No more requests.
        End = 11,
    }
}

numbered! {
    /// What became of a request.
    Code {
        /// Done.
        Done = 0,
        /// No such kind.
        Unknown = 1,
        /// Shorter or longer than a frame of this kind.
        Length = 2,
        /// A number that stands for nothing: of a mode, of a quality.
        Value = 3,
        /// The other side has another version of the frames.
        Version = 4,
        /// There is no controller yet.
        Empty = 5,
        /// The configuration is refused; how many faults, and the first one, follow.
        Refused = 6,
        /// The controller needs more samples of delay memory than the board has.
        Memory = 7,
        /// The new law is of another kind or another number type: it cannot take the state over.
        Mismatch = 8,
        /// The saved words are not a state of this controller.
        Snapshot = 9,
    }
}

impl Code {
    /// What it means, as the end of a sentence.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Done => "is done",
            Self::Unknown => "is of no known kind",
            Self::Length => "has the wrong length",
            Self::Value => "has a number that stands for nothing",
            Self::Version => "is of another version",
            Self::Empty => "comes before a controller was built",
            Self::Refused => "has a configuration that is refused",
            Self::Memory => "needs more delay memory than the board has",
            Self::Mismatch => "is for a controller of another kind",
            Self::Snapshot => "has words that are no state of this controller",
        }
    }
}

/// The begin of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Number of a [`Kind`].
    pub kind: u8,
    /// Number of a [`Code`]; 0 in requests.
    pub code: u8,
    /// Bytes behind the header.
    pub length: u16,
    /// Which request this is, or answers.
    pub number: u32,
}

impl Header {
    /// The header that `bytes` begin with; `None` while they are too few.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(bytes);
        Some(Self { kind: reader.u8()?, code: reader.u8()?, length: reader.u16()?, number: reader.u32()? })
    }

    /// As bytes.
    #[must_use]
    pub fn bytes(&self) -> [u8; HEADER] {
        let [a, b] = self.length.to_le_bytes();
        let [c, d, e, f] = self.number.to_le_bytes();
        [self.kind, self.code, a, b, c, d, e, f]
    }

    /// Bytes of the whole frame.
    #[must_use]
    pub const fn frame(&self) -> usize {
        HEADER + self.length as usize
    }
}

/// Writes a frame into `buffer`: `body` writes what follows the header. `None`: it does not fit.
///
/// ```
/// use controller_pil::frame::{Header, Kind, write};
/// let mut buffer = [0; 32];
/// let frame = write(&mut buffer, Kind::Advance as u8, 0, 7, |to| to.u32(3)).unwrap();
/// assert_eq!(frame, [6, 0, 4, 0, 7, 0, 0, 0, 3, 0, 0, 0]);
/// assert_eq!(Header::read(frame).unwrap().frame(), frame.len());
/// ```
pub fn write(
    buffer: &mut [u8],
    kind: u8,
    code: u8,
    number: u32,
    body: impl FnOnce(&mut Writer<'_>),
) -> Option<&[u8]> {
    let (head, rest) = buffer.split_at_mut_checked(HEADER)?;
    let mut writer = Writer::new(rest);
    body(&mut writer);
    let length = writer.length()?;
    let short = u16::try_from(length).ok()?;
    head.copy_from_slice(&Header { kind, code, length: short, number }.bytes());
    buffer.get(..HEADER + length)
}

/// Reads numbers off the front of bytes; `None` at their end.
#[derive(Debug, Clone)]
pub struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Of all of `bytes`.
    #[must_use]
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The next `N` bytes.
    pub fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.bytes.split_first_chunk()?;
        self.bytes = rest;
        Some(*first)
    }

    /// The next byte.
    pub fn u8(&mut self) -> Option<u8> {
        self.take().map(u8::from_le_bytes)
    }

    /// The next two bytes.
    pub fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    /// The next four bytes.
    pub fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    /// The next eight bytes as a number.
    pub fn f64(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    /// A byte that is 0 or 1; `None` also for any other.
    pub fn flag(&mut self) -> Option<bool> {
        match self.u8()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    /// A number that may be absent.
    pub fn optional(&mut self) -> Option<Option<f64>> {
        let there = self.flag()?;
        let number = self.f64()?;
        Some(there.then_some(number))
    }

    /// `Some` when nothing is left.
    pub fn end(&self) -> Option<()> {
        self.bytes.is_empty().then_some(())
    }
}

/// Writes numbers one behind the other.
#[derive(Debug)]
pub struct Writer<'a> {
    bytes: &'a mut [u8],
    at: usize,
    fits: bool,
}

impl<'a> Writer<'a> {
    /// Into `bytes`.
    pub const fn new(bytes: &'a mut [u8]) -> Self {
        Self { bytes, at: 0, fits: true }
    }

    /// How many bytes were written; `None`: they did not fit.
    #[must_use]
    pub fn length(&self) -> Option<usize> {
        self.fits.then_some(self.at)
    }

    /// These bytes.
    pub fn put(&mut self, bytes: &[u8]) {
        match self.bytes.get_mut(self.at..).and_then(|rest| rest.get_mut(..bytes.len())) {
            Some(place) => {
                place.copy_from_slice(bytes);
                self.at += bytes.len();
            }
            None => self.fits = false,
        }
    }

    /// One byte.
    pub fn u8(&mut self, x: u8) {
        self.put(&[x]);
    }

    /// Two bytes.
    pub fn u16(&mut self, x: u16) {
        self.put(&x.to_le_bytes());
    }

    /// Four bytes.
    pub fn u32(&mut self, x: u32) {
        self.put(&x.to_le_bytes());
    }

    /// Eight bytes.
    pub fn f64(&mut self, x: f64) {
        self.put(&x.to_le_bytes());
    }

    /// A number that may be absent.
    pub fn optional(&mut self, x: Option<f64>) {
        self.u8(u8::from(x.is_some()));
        self.f64(x.unwrap_or(0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_of_kinds_and_codes_lead_back() {
        assert!(Kind::ALL.iter().all(|&kind| Kind::from_number(kind as u8) == Some(kind)));
        assert!(Code::ALL.iter().all(|&code| Code::from_number(code as u8) == Some(code)));
        assert_eq!((Kind::from_number(0), Kind::from_number(12), Code::from_number(10)), (None, None, None));
    }

    #[test]
    fn what_does_not_fit_is_not_written() {
        let mut buffer = [0; 11];
        assert_eq!(write(&mut buffer, 1, 0, 0, |to| to.u32(1)), None);
        assert!(write(&mut buffer, 1, 0, 0, |to| to.u16(1)).is_some());
        assert_eq!(write(&mut buffer[..7], 1, 0, 0, |_| ()), None);
    }

    proptest! {
        #[test]
        fn a_header_comes_back(kind: u8, code: u8, length: u16, number: u32, more: [u8; 3]) {
            let header = Header { kind, code, length, number };
            let bytes: [u8; HEADER + 3] = core::array::from_fn(|i| {
                header.bytes().get(i).copied().unwrap_or_else(|| more[i - HEADER])
            });
            prop_assert_eq!(Header::read(&bytes), Some(header));
            prop_assert_eq!(Header::read(&bytes[..HEADER - 1]), None);
        }

        #[test]
        fn numbers_come_back_bit_for_bit(bits: u64, short: u16, word: u32, there: bool) {
            let mut buffer = [0; 64];
            let number = f64::from_bits(bits);
            let frame = write(&mut buffer, 1, 0, 0, |to| {
                to.u16(short);
                to.optional(there.then_some(number));
                to.u32(word);
                to.f64(number);
            });
            let mut reader = Reader::new(&frame.unwrap()[HEADER..]);
            prop_assert_eq!(reader.u16(), Some(short));
            prop_assert_eq!(reader.optional().unwrap().map(f64::to_bits), there.then_some(bits));
            prop_assert_eq!(reader.u32(), Some(word));
            prop_assert_eq!(reader.end(), None);
            prop_assert_eq!(reader.f64().map(f64::to_bits), Some(bits));
            prop_assert_eq!(reader.end(), Some(()));
            prop_assert_eq!(reader.u8(), None);
        }
    }
}
