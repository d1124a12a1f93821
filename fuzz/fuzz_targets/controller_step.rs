//! Loops of any configuration under any input: the checks of the test `totality`, on bytes that coverage chooses.
//!
//! The first byte says which kind of loop, the second how many configurations follow, the rest are operations.

#![no_main]

#[path = "../../tests/tests/totality/built.rs"]
mod built;
#[path = "../../tests/tests/totality/configs.rs"]
mod configs;
#[path = "../../tests/tests/totality/draw.rs"]
mod draw;
#[path = "../../tests/tests/totality/driven.rs"]
mod driven;
#[path = "../../tests/tests/totality/good.rs"]
mod good;

use built::{AnyBlock, OPERATION_BYTES};
use configs::{CONFIG_BYTES, Case};
use controller_core::NoCompensator;
use driven::drive;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let [kind, number, rest @ ..] = bytes else { return };
    let (configs, operations) = rest.split_at(rest.len().min(CONFIG_BYTES * usize::from(1 + number % 3)));
    let mut cases: Vec<Case> = Vec::new();
    for bytes in configs.chunks(CONFIG_BYTES) {
        let ts = cases.first().map(|case| case.ts);
        cases.push(Case::draw(bytes, ts));
    }
    let operations: Vec<Vec<u8>> = operations.chunks(OPERATION_BYTES).map(<[u8]>::to_vec).collect();
    let result = match kind % 4 {
        0 => drive::<f32, NoCompensator>(&cases, &operations),
        1 => drive::<f64, NoCompensator>(&cases, &operations),
        2 => drive::<f32, AnyBlock<f32>>(&cases, &operations),
        _ => drive::<f64, AnyBlock<f64>>(&cases, &operations),
    };
    if let Err(reason) = result {
        panic!("{reason}");
    }
});
