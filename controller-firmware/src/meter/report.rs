//! One line for everything that is measured, for `cargo xtask size`:
//!
//! ```text
//! count WHAT BLOCK TYPE CLASS LEAST MOST    instructions of a call
//! code  WHAT BLOCK TYPE ADDRESS             where its code begins
//! bytes BLOCK TYPE LAW STATE                what an instance takes
//! ```
//!
//! WHAT is `step`, `adopt` or `new`. Words given to the image choose blocks by the beginning of their name, and a type.

use super::clock::Clock;
use super::range::Range;
use controller_core::Real;
use semihosting::println;

/// A block in one number type.
pub(super) struct Report<'a> {
    pub(super) clock: &'a Clock,
    block: &'static str,
    number: &'static str,
}

impl<'a> Report<'a> {
    /// `None` when the image was started with words and none of them is the block or the type.
    pub(super) fn new<T: Real>(clock: &'a Clock, block: &'static str) -> Option<Self> {
        let number = if T::WORDS == 1 { "f32" } else { "f64" };
        let wanted = |words: &[&str]| words.iter().all(|word| block.starts_with(word) || *word == number);
        asked(wanted).then_some(Self { clock, block, number })
    }

    /// A range of instructions; nothing if nothing was counted.
    pub(super) fn count(&self, what: &str, class: &str, range: Range) {
        if range.least <= range.most {
            let (block, number, Range { least, most }) = (self.block, self.number, range);
            println!("count {what} {block} {number} {class} {least} {most}");
        }
    }

    /// Where a function is.
    pub(super) fn code(&self, what: &str, address: usize) {
        // The lowest bit only says that it is Thumb code.
        println!("code {what} {} {} {:#x}", self.block, self.number, address & !1);
    }

    /// What a law and its state take.
    pub(super) fn bytes<L, S>(&self) {
        println!("bytes {} {} {} {}", self.block, self.number, size_of::<L>(), size_of::<S>());
    }
}

/// What `wanted` says of the words that the image was started with, at most eight.
fn asked(wanted: impl Fn(&[&str]) -> bool) -> bool {
    let Ok(all) = semihosting::experimental::env::args::<256>() else { return true };
    let mut words = [""; 8];
    let mut count = 0;
    // The first one is the image.
    for (place, word) in words.iter_mut().zip((&all).skip(1)) {
        *place = word.unwrap_or_default();
        count += 1;
    }
    wanted(words.get(..count).unwrap_or_default())
}
