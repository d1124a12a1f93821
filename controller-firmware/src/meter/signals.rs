//! Inputs: small numbers, and any bit pattern.

use controller_core::Real;

/// An integer generator (Knuth's 64-bit congruence); its high bits are what is used.
pub(super) struct Chance(u64);

impl Chance {
    /// The same numbers in every run.
    pub(super) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 32 random bits.
    #[allow(clippy::cast_possible_truncation)] // the high half is what is wanted
    pub(super) fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// Yes once in `n` times.
    pub(super) fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }

    /// A whole number below `n`.
    pub(super) fn below(&mut self, n: u32) -> u32 {
        (self.bits() >> 8) % n
    }

    /// A number of at most `size`, of either sign.
    pub(super) fn number<T: Real>(&mut self, size: f64) -> T {
        let unit = f64::from(self.bits()) / f64::from(u32::MAX);
        T::from_f64(size * (2.0 * unit - 1.0))
    }

    /// Any number, a subnormal one, an infinity or none at all.
    pub(super) fn pattern<T: Real>(&mut self) -> T {
        let words = [self.bits(), self.bits()];
        T::from_words(words)
    }

    /// As [`pattern`](Self::pattern), or one of the numbers that are special.
    pub(super) fn anything<T: Real>(&mut self) -> T {
        const SPECIAL: [f64; 8] = [0.0, -0.0, 1.0, -1e6, 1e6, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        match self.below(3) {
            0 => self.pattern(),
            1 => self.number(20.0),
            _ => {
                let at = self.below(8) as usize;
                T::from_f64(SPECIAL.get(at).copied().unwrap_or_default())
            }
        }
    }
}
