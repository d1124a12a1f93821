//! One number for many bits.

use controller_core::Real;

/// FNV-1a in 64 bits, taken over words of 32 bits in place of bytes: a target without a wide multiplier is to spend its
/// time in the loops. Each step is a bijection, so one word that differs makes another hash for certain.
pub(super) struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }
}

impl Hash {
    pub(super) fn word(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01B3);
    }

    pub(super) fn number<T: Real>(&mut self, x: T) {
        x.to_words().into_iter().take(T::WORDS).for_each(|word| self.word(word));
    }

    pub(super) fn value(&self) -> u64 {
        self.0
    }
}
