//! A sum over numbers, to find memory that has been damaged.

use crate::snapshot::Words;

/// Odd, so that a product with it can be undone; its bits have no pattern.
const FACTOR: u32 = 0x9E37_79B1;

/// A sum over words of 32 bits: `s <- mix((s ^ word) * 0x9E37_79B1)` modulo 2^32 with `mix(p) = p ^ (p >> 16)`, from a start that
/// is not 0.
///
/// A change of one word is found for certain, since each word moves the sum one-to-one, and so is one bit in each of two words
/// that are next to each other. Of other damage one case in 2^32 is missed, when it has no pattern. The product carries a
/// change upwards and the shift brings it down again; with a rotation in their place the same bit of two words that are 32 apart
/// would meet itself. It is meant for what wears, tears and slips, and is no protection against intent.
/// Source: own. Cost: besides the load three instructions a word where a machine shifts an operand for nothing, else four.
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
        let product = (self.0 ^ word).wrapping_mul(FACTOR);
        self.0 = product ^ (product >> 16);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Real;

    fn sum(words: &[u32]) -> u32 {
        let mut sum = Checksum::new();
        words.iter().for_each(|&word| sum.word(word));
        sum.value()
    }

    #[test]
    fn is_what_the_equation_says() {
        // By hand: (0x9E3779B9 ^ 1) * 0x9E3779B1 = 0x61C88640_536B2038, and 0x2038 ^ 0x536B = 0x7353.
        assert_eq!(sum(&[1]), 0x536B_7353);
        // (0x536B7353 ^ 0xFFFFFFFF) * 0x9E3779B1 = 0x6AA914C5_EA268EEC, and 0x8EEC ^ 0xEA26 = 0x64CA.
        assert_eq!(sum(&[1, 0xFFFF_FFFF]), 0xEA26_64CA);
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

    const DISTANCE: usize = 128;
    const WORDS: usize = 160;

    /// The low word of a number of 64 bits, or the high one.
    fn half(x: f64, i: u32) -> u32 {
        let [low, high] = x.to_words();
        if i.is_multiple_of(2) { low } else { high }
    }

    /// Contents with patterns: numbers as laws and delay lines hold them.
    fn contents() -> [[u32; WORDS]; 5] {
        let list =
            |word: fn(u32) -> u32| core::array::from_fn(|i| word(u32::try_from(i).unwrap_or_default()));
        [
            [0; WORDS],
            [u32::MAX; WORDS],
            // A delay line of f32 in which a measurement rises slowly.
            list(|i| f32::from_f64(44.0 + f64::from(i) / 128.0).to_bits()),
            // Of f64 that f32 could hold: every other word is 0.
            list(|i| half(f64::from(i & !1) / 8.0, i)),
            // Of f64 with opposite signs in turn.
            list(|i| half(if i % 4 < 2 { 0.1 } else { -0.1 }, i)),
        ]
    }

    #[test]
    fn no_pair_of_bits_is_missed() {
        for words in contents() {
            for (i, &first) in words.iter().enumerate() {
                let mut before = Checksum::new();
                words.iter().take(i).for_each(|&word| before.word(word));
                for bit in 0..32 {
                    let (mut whole, mut changed) = (before, before);
                    whole.word(first);
                    changed.word(first ^ 1 << bit);
                    for (j, &second) in words.iter().enumerate().skip(i + 1).take(DISTANCE) {
                        let mut good = whole;
                        good.word(second);
                        for other in 0..32 {
                            let mut twice = changed;
                            twice.word(second ^ 1 << other);
                            assert_ne!(twice, good, "bit {bit} of word {i}, bit {other} of word {j}");
                        }
                        changed.word(second);
                        whole = good;
                    }
                }
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
