//! One line for everything that is measured, for `cargo xtask size`:
//!
//! ```text
//! count WHAT BLOCK TYPE CLASS LEAST MOST    instructions of a call
//! code  WHAT BLOCK TYPE ADDRESS             where its code begins
//! bytes BLOCK TYPE LAW STATE                what an instance takes
//! ```
//!
//! WHAT is `step`, `adopt` or `new`. A word given to the image chooses the blocks whose names begin with it.

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
    /// `None` when the image was started with words that are not the beginning of the block's name.
    pub(super) fn new<T: Real>(clock: &'a Clock, block: &'static str) -> Option<Self> {
        let number = if T::WORDS == 1 { "f32" } else { "f64" };
        asked(block).then_some(Self { clock, block, number })
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

/// Whether the image was started with no word, or with one that `block` begins with.
fn asked(block: &str) -> bool {
    let Ok(all) = semihosting::experimental::env::args::<256>() else { return true };
    // The first one is the image.
    let mut words = (&all).skip(1).map(Result::unwrap_or_default).peekable();
    words.peek().is_none() || words.any(|word| block.starts_with(word))
}
