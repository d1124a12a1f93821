//! A law is replaced under a running interrupt: never torn, never with a bump, interrupts off for a known time.

use std::path::Path;

use crate::emulator::{self, REFERENCE};
use crate::ladder::Done;
use crate::shell::Outcome;

/// The image.
const SWAP: &str = "swap";

/// It has a critical section of its own.
const FEATURES: [&str; 3] = ["--no-default-features", "--features", "timed-lock"];

/// Swaps in the ladder, and in the soak.
const SWAPS: u32 = 100_000;
const SOAK: u32 = 1_000_000;

/// Swaps done wrongly: enough for a fault to be seen.
const WRONG: &str = "2000";

/// Instructions with interrupts off, at most, while a law of 220 bytes is handed over, by the pinned compiler.
pub(crate) const INTERRUPTS_OFF: u32 = 237;

/// The guide that says so.
const GUIDE: &str = "controller-firmware/README.md";

/// Seconds that the image may take for the ladder's share.
const SECONDS: u32 = 600;

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    match emulator::lacking(root)? {
        Some(end) => Ok(end),
        None => swapped(root, SWAPS).map(Done::Passed),
    }
}

/// The long run.
pub(crate) fn soak(root: &Path) -> Outcome {
    swapped(root, SOAK).map(|remark| println!("{remark}"))
}

fn swapped(root: &Path, swaps: u32) -> Outcome<String> {
    let image = emulator::image(root, REFERENCE, SWAP, &FEATURES)?;
    let seconds = SECONDS * (swaps / SWAPS).max(1);
    let text = emulator::emulated(root, &image, &[&swaps.to_string()], seconds).capture()?;
    print!("{text}");
    let off = number_before(&text, "instructions").ok_or("the image says nothing of interrupts")?;
    if off != INTERRUPTS_OFF {
        return Err(format!(
            "interrupts are off for at most {off} instructions, it was {INTERRUPTS_OFF}: see xtask/src/swap.rs, {GUIDE} and \
             cargo xtask size --update"
        ));
    }
    let guide = std::fs::read_to_string(root.join(GUIDE)).map_err(|e| format!("{GUIDE}: {e}"))?;
    if !guide.contains(&format!("{off} instructions for 220 bytes")) {
        return Err(format!(
            "{GUIDE} does not say that interrupts are off for {off} instructions for 220 bytes"
        ));
    }
    // Checks that cannot fail would say nothing: laws without a lock, laws that are not adopted.
    for (way, count) in [("torn", "torn laws"), ("bare", "bumps")] {
        let (well, text) = emulator::emulated(root, &image, &[WRONG, way], SECONDS).attempt()?;
        if well || number_before(&text, count).is_none_or(|found| found == 0) {
            return Err(format!("{text}\nswaps done wrongly ({way}) went unnoticed"));
        }
    }
    Ok(format!("{swaps} swaps, none torn, no bump; interrupts off for at most {off} instructions"))
}

/// The number in front of the first `word` of a text.
fn number_before(text: &str, word: &str) -> Option<u32> {
    text.split_once(word)?.0.split_whitespace().next_back()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_sentences() {
        let text = "9 torn laws\n0 bumps; the largest 1 u\ninterrupts off for at most 235 instructions\n";
        assert_eq!(number_before(text, "instructions"), Some(235));
        assert_eq!(number_before(text, "torn laws"), Some(9));
        assert_eq!(number_before(text, "bumps"), Some(0));
        assert_eq!(number_before(text, "swaps"), None);
    }
}
