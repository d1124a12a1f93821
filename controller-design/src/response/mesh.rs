//! How one dead time is divided into elements.
//!
//! A response to a delayed input has a layer behind every multiple of the dead time, as wide as the fastest lag.
//! Elements therefore start small and grow with the distance from the last multiple; the pattern repeats.

use std::vec::Vec;

use super::realisation::Mode;

/// Doublings of the smallest element up to the dead time.
pub(super) const MAX_LEVELS: u32 = 60;
const MAX_ELEMENTS: usize = 4096;

/// Levels of the elements from left to right; an element of level `l` is `2^-l` dead times long.
///
/// `reach`: how many time constants one element may span. `None` if there would be too many elements.
pub(super) fn mesh(modes: &[Mode], reach: f64) -> Option<Vec<u32>> {
    let mut elements = Vec::new();
    // In units of the smallest element that can be.
    let mut at: u64 = 0;
    let whole = 1_u64 << MAX_LEVELS;
    while at < whole {
        let x = at as f64 / whole as f64;
        let allowed = modes.iter().map(|m| limit(m, x, reach)).fold(1.0, f64::min);
        let mut level = 0;
        while level < MAX_LEVELS && (length(level) > allowed || !at.is_multiple_of(whole >> level)) {
            level += 1;
        }
        if length(level) > allowed || elements.len() == MAX_ELEMENTS {
            return None;
        }
        elements.push(level);
        at += whole >> level;
    }
    Some(elements)
}

/// Length of an element in dead times.
pub(super) fn length(level: u32) -> f64 {
    libm::ldexp(1.0, -(level.min(1000) as i32))
}

fn limit(mode: &Mode, x: f64, reach: f64) -> f64 {
    let own = reach / mode.size;
    let grown = if mode.rings && mode.decay * x < 40.0 { own } else { x * (0.5 * reach).min(1.0) };
    own.max(grown)
}
