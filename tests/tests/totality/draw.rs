//! Choices made from bytes. The property tests and the fuzzer read the same bytes the same way, so that what one of
//! them finds, the other can repeat. Bytes that are used up read as zero, and zeros mean the plain choice.

use controller_core::Real;

/// A reader of choices.
pub(crate) struct Draw<'a> {
    bytes: &'a [u8],
}

impl<'a> Draw<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    pub(crate) fn byte(&mut self) -> u8 {
        match self.bytes.split_first() {
            Some((first, rest)) => {
                self.bytes = rest;
                *first
            }
            None => 0,
        }
    }

    pub(crate) fn short(&mut self) -> u16 {
        u16::from_le_bytes([self.byte(), self.byte()])
    }

    pub(crate) fn word(&mut self) -> u32 {
        u32::from(self.short()) | u32::from(self.short()) << 16
    }

    /// One of `0..n`.
    pub(crate) fn index(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    pub(crate) fn pick<V: Copy>(&mut self, list: &[V]) -> V {
        list[self.index(list.len())]
    }

    pub(crate) fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// True once in `n` times.
    pub(crate) fn rarely(&mut self, n: u8) -> bool {
        self.byte() % n == n - 1
    }

    /// A number in `0..=1`.
    pub(crate) fn share(&mut self) -> f64 {
        f64::from(self.short()) / f64::from(u16::MAX)
    }

    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        let share = self.share();
        (lo * (1.0 - share) + hi * share).clamp(lo, hi)
    }

    /// A power of ten with an exponent in `lo..=hi`; 1 for zeros when that is inside.
    pub(crate) fn decades(&mut self, lo: f64, hi: f64) -> f64 {
        let share = self.share();
        if share == 0.0 && lo <= 0.0 && hi >= 0.0 {
            return 1.0;
        }
        10.0_f64.powf(lo + share * (hi - lo))
    }

    /// As [`decades`](Self::decades), with either sign.
    pub(crate) fn signed_decades(&mut self, lo: f64, hi: f64) -> f64 {
        let size = self.decades(lo, hi);
        if self.flag() { -size } else { size }
    }

    /// Any bit pattern of `T`.
    pub(crate) fn pattern<T: Real>(&mut self) -> T {
        let words = [self.word(), self.word()];
        T::from_words(words)
    }

    /// A number of `T` for a signal with the range `lo..=hi`: inside, on its edges, just or far outside, or one of
    /// the bit patterns that arithmetic is worst at.
    pub(crate) fn signal<T: Real>(&mut self, lo: T, hi: T) -> T {
        let two = T::ONE + T::ONE;
        match self.index(8) {
            0 => T::ZERO.clamp_to(lo, hi),
            1 | 2 => T::from_f64(self.between(lo.to_f64(), hi.to_f64())).clamp_to(lo, hi),
            3 => self.pick(&[lo, hi]),
            4 => self.pick(&[lo * two - hi, hi * two - lo, lo + lo, hi + hi]),
            5 => self.special(),
            _ => self.pattern(),
        }
    }

    /// Zeros, subnormals, the largest numbers, infinities, NaNs of both signs with several payloads.
    fn special<T: Real>(&mut self) -> T {
        let quiet_or_not = self.word();
        let (exponent, low) = if T::WORDS == 1 { (0x7F80_0000, 0) } else { (0x7FF0_0000, u32::MAX) };
        let of = |top: u32, low: u32| T::from_words(if T::WORDS == 1 { [top, 0] } else { [low, top] });
        let sign = u32::from(self.flag()) << 31;
        match self.index(8) {
            0 => of(sign, 0),
            1 => of(sign, 1),
            2 => of(sign | 1, low),
            3 => of(sign | (exponent - 1), low),
            4 => of(sign | exponent, 0),
            5 => of(sign | exponent | 1, 1),
            6 => of(sign | exponent | quiet_or_not, quiet_or_not),
            _ => of(sign | u32::MAX >> 1, low),
        }
    }
}
