//! A sum over numbers, to find memory that has been damaged.

use crate::snapshot::Words;

/// A sum over words of 32 bits: `s <- rotl(s, 5) + word`, from a start that is not 0.
///
/// A change of one word is found for certain, since each word moves the sum one-to-one; of other damage one case in 2^32 is
/// missed, when it has no pattern. It is meant for what wears, tears and slips, and is no protection against intent.
/// Source: own. Cost: two instructions a word where a machine rotates an operand for nothing.
///
/// ```
/// use controller_core::{Checksum, snapshot::Words};
/// let mut sum = Checksum::new();
/// sum.numbers(&[1.5_f32, -2.0]);
/// let mut other = Checksum::new();
/// other.numbers(&[1.5_f32, -2.0000002]);
/// assert_ne!(sum.value(), other.value());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Checksum(u32);

impl Default for Checksum {
    fn default() -> Self {
        Self::new()
    }
}

impl Checksum {
    /// Of nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self(0x9E37_79B9)
    }

    /// What has come together.
    #[must_use]
    pub const fn value(self) -> u32 {
        self.0
    }
}

impl Words for Checksum {
    #[inline(always)]
    fn word(&mut self, word: u32) {
        self.0 = self.0.rotate_left(5).wrapping_add(word);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(words: &[u32]) -> u32 {
        let mut sum = Checksum::new();
        words.iter().for_each(|&word| sum.word(word));
        sum.value()
    }

    #[test]
    fn is_what_the_equation_says() {
        // By hand: 0x9E3779B9 rotated by 5 is 0xC6EF3733.
        assert_eq!(sum(&[1]), 0xC6EF_3734);
        // 0xC6EF3734 rotated by 5 is 0xDDE6E698.
        assert_eq!(sum(&[1, 0xFFFF_FFFF]), 0xDDE6_E697);
    }

    #[test]
    fn no_change_of_one_word_is_missed() {
        let mut words = [0_u32; 40];
        for (word, i) in words.iter_mut().zip(0_u32..) {
            *word = i.wrapping_mul(0x0123_4567);
        }
        for at in 0..words.len() {
            for bit in 0..32 {
                let mut changed = words;
                if let Some(word) = changed.get_mut(at) {
                    *word ^= 1 << bit;
                }
                assert_ne!(sum(&changed), sum(&words), "bit {bit} of word {at}");
            }
        }
    }

    #[test]
    fn tells_order_and_length() {
        assert_ne!(sum(&[1, 2]), sum(&[2, 1]));
        assert_ne!(sum(&[0]), sum(&[]));
        assert_ne!(sum(&[0, 0]), sum(&[0]));
    }
}
