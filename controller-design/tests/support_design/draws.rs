//! Choices from bytes.

/// Bytes that are used up by choices; behind their end all are 0.
#[derive(Debug, Clone)]
pub(crate) struct Draws<'a> {
    bytes: &'a [u8],
}

impl<'a> Draws<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        *first
    }

    /// 0 up to below `count`.
    pub(crate) fn below(&mut self, count: u8) -> u8 {
        self.byte() % count
    }

    /// True in one of `count` cases, but not for a byte of 0.
    pub(crate) fn one_in(&mut self, count: u8) -> bool {
        self.byte() % count == count - 1
    }

    /// A number from `low` to `high`.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let fine = u16::from_be_bytes([self.byte(), self.byte()]);
        low + (high - low) * f64::from(fine) / 65_535.0
    }

    /// A number from `10^low` to `10^high`, evenly in its logarithm; short in print.
    pub(crate) fn decades(&mut self, low: f64, high: f64) -> f64 {
        let exact = libm::exp10(self.between(low, high));
        format!("{exact:.3e}").parse().unwrap_or(exact)
    }

    /// Any bits.
    pub(crate) fn any(&mut self) -> f64 {
        f64::from_bits(u64::from_be_bytes([(); 8].map(|()| self.byte())))
    }

    /// Mostly `usual`, now and then anything at all.
    pub(crate) fn mostly(&mut self, usual: f64) -> f64 {
        if self.one_in(24) { self.any() } else { usual }
    }
}
