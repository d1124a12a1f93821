//! Inputs that are the same on every machine.

use controller_core::Real;

/// An integer generator (Knuth's 64-bit congruence); its high bits are what is used.
pub(super) struct Chance(u64);

impl Chance {
    /// All runs begin with this number.
    pub(super) fn new() -> Self {
        Self(20_210_331)
    }

    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// A whole number in `0..n`.
    pub(super) fn below(&mut self, n: u32) -> u32 {
        // The high word of a product: a division costs a small target a hundred instructions.
        ((u64::from(self.bits()) * u64::from(n)) >> 32) as u32
    }

    /// True once in `n` times.
    pub(super) fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }

    /// A multiple of 1/4096 in `-size..size`, exact in both number types.
    pub(super) fn number<T: Real>(&mut self, size: u16) -> T {
        let half = 4096 * i32::from(size);
        let units = self.below(2 * half.unsigned_abs()).cast_signed() - half;
        T::from_f64(f64::from(units)) * T::from_f64(1.0 / 4096.0)
    }
}
