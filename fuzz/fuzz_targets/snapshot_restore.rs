//! Restoring any words, and sealed snapshots with any contents: never a panic, refused or harmless.
//!
//! The first byte says which kind of loop, then follows its configuration; the rest are the words.

#![no_main]

#[path = "../../tests/tests/totality/built.rs"]
mod built;
#[path = "../../tests/tests/totality/configs.rs"]
mod configs;
#[path = "../../tests/tests/totality/draw.rs"]
mod draw;
#[path = "../../tests/tests/totality/good.rs"]
mod good;
#[path = "../../tests/tests/totality/snapshots.rs"]
mod snapshots;

use built::{AnyBlock, Block, Built, Checked, accepted, saved};
use configs::{CONFIG_BYTES, Case};
use controller_core::{ControllerState, NoCompensator, Real};
use libfuzzer_sys::fuzz_target;
use snapshots::{overwrite, seal};

/// Words that are the snapshot of nothing, as they are and sealed.
fn restore<T: Real, C: Block<T>>(built: &Built<T, C>, bytes: &[u8]) -> Checked {
    let words: Vec<u32> = bytes
        .chunks(4)
        .map(|chunk| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)))
        .collect();
    let mut sealed = words.clone();
    seal(&mut sealed);
    for words in [words, sealed] {
        let mut state = ControllerState::over(built.law.compensator().blank());
        let before = saved(&built.law, &state);
        if built.law.restore(&mut state, &words).is_err() && saved(&built.law, &state) != before {
            return Err(format!("refused, and yet the state changed: {words:x?}"));
        }
    }
    Ok(())
}

fn check<T: Real, C: Block<T>>(config: &[u8], rest: &[u8]) -> Checked {
    for built in accepted::<T, C>(&[Case::draw(config, None)]) {
        restore(&built, rest)?;
        overwrite(&built, rest)?;
    }
    Ok(())
}

fuzz_target!(|bytes: &[u8]| {
    let [kind, rest @ ..] = bytes else { return };
    let (config, rest) = rest.split_at(rest.len().min(CONFIG_BYTES));
    let result = match kind % 4 {
        0 => check::<f32, NoCompensator>(config, rest),
        1 => check::<f64, NoCompensator>(config, rest),
        2 => check::<f32, AnyBlock<f32>>(config, rest),
        _ => check::<f64, AnyBlock<f64>>(config, rest),
    };
    if let Err(reason) = result {
        panic!("{reason}");
    }
});
