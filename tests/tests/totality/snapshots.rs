//! Snapshots whose frame is intact and whose contents are anything: what a checksum cannot find.

use super::built::{Block, Built, Checked, OPERATION_BYTES, saved};
use super::draw::Draw;
use controller_core::{ControllerState, Real};

/// CRC-32 of the words' bytes, low byte first, by polynomial division, bit for bit.
fn crc32(words: &[u32]) -> u32 {
    let mut rest = u32::MAX;
    for word in words {
        for i in 0..32 {
            let bit = (rest ^ (word >> i)) & 1;
            rest = (rest >> 1) ^ (0xEDB8_8320 * bit);
        }
    }
    !rest
}

/// Writes the checksum of all words before the last into the last.
pub(crate) fn seal(words: &mut [u32]) {
    if let Some((last, before)) = words.split_last_mut() {
        *last = crc32(before);
    }
}

/// Changes some words of a good snapshot, seals it and restores it. It is refused and changes nothing, or it is taken
/// and the loop runs on from it in its range.
pub(crate) fn overwrite<T: Real, C: Block<T>>(built: &Built<T, C>, bytes: &[u8]) -> Checked {
    let law = &built.law;
    let (first, bytes) = bytes.split_at(bytes.len().min(OPERATION_BYTES));
    let mut state = ControllerState::over(law.compensator().blank());
    law.step(&mut state, &built.input(&mut Draw::new(first)));
    let mut draw = Draw::new(bytes);
    let before = saved(law, &state);
    let mut words = before.clone();
    for _ in 0..=draw.index(8) {
        let at = 2 + usize::from(draw.short()) % (words.len() - 3);
        let number: T = draw.signal(-T::ONE, T::ONE);
        let [low, high] = number.to_words();
        words[at] = low;
        if T::WORDS == 2 && at + 2 < words.len() {
            words[at + 1] = high;
        }
    }
    seal(&mut words);
    if law.restore(&mut state, &words).is_err() {
        return match saved(law, &state) == before {
            true => Ok(()),
            false => Err(format!("a refused snapshot changed the state\n{words:x?}")),
        };
    }
    let (lo, hi) = law.output_range();
    for _ in 0..20 {
        let out = law.step(&mut state, &built.good());
        let finite =
            [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].iter().all(|x| x.is_finite_number());
        if !finite || out.u < lo || out.u > hi {
            return Err(format!("{:?}\nwith {words:x?}\ngave {out:?}", built.case));
        }
    }
    Ok(())
}
