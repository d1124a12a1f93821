//! Totality: whatever the inputs are, a step neither panics nor leaves its range.
//!
//! Random configurations over the documented ranges, random bit patterns of every input, swaps, lost samples,
//! settling and damaged snapshots in between. After each of them every output is finite, the output is in its
//! range and no faster than its rate (the range beats the rate), and the state is finite. The first good sample
//! closes the loop again; with a plant behind it, the loop reaches its set-point.
//!
//! The same cases on every run; with `SOAK=1` in the environment a hundred times as many, different on every run.

#[path = "totality/built.rs"]
mod built;
#[path = "totality/configs.rs"]
mod configs;
#[path = "totality/draw.rs"]
mod draw;
#[path = "totality/driven.rs"]
mod driven;
#[path = "totality/good.rs"]
mod good;
#[path = "totality/pinned.rs"]
mod pinned;
#[path = "totality/recovery.rs"]
mod recovery;
#[path = "totality/runner.rs"]
mod runner;
#[path = "totality/snapshots.rs"]
mod snapshots;

use built::{AnyBlock, Block, Built, OPERATION_BYTES};
use configs::Case;
use controller_core::{NoCompensator, Real};
use driven::drive;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use recovery::{LOOP_BYTES, recovers};
use runner::{config_bytes, for_all, operations, runner, swappable};
use snapshots::overwrite;

fn total<T: Real, C: Block<T>>(number: u32) {
    for_all(number, &(vec(config_bytes(), 1..=3), operations()), |(bytes, operations)| {
        drive::<T, C>(&swappable(&bytes), &operations)
    });
}

#[test]
fn ordinary_loops_come_back_in_single_precision() {
    let strategy = (vec(any::<u8>(), LOOP_BYTES), operations());
    for_all(300, &strategy, |(bytes, operations)| recovers::<f32>(&bytes, &operations));
}

#[test]
fn ordinary_loops_come_back_in_double_precision() {
    let strategy = (vec(any::<u8>(), LOOP_BYTES), operations());
    for_all(300, &strategy, |(bytes, operations)| recovers::<f64>(&bytes, &operations));
}

#[test]
fn single_precision_loops_without_a_compensator() {
    total::<f32, NoCompensator>(3000);
}

#[test]
fn double_precision_loops_without_a_compensator() {
    total::<f64, NoCompensator>(3000);
}

#[test]
fn single_precision_loops_with_any_compensator() {
    total::<f32, AnyBlock<f32>>(3000);
}

#[test]
fn double_precision_loops_with_any_compensator() {
    total::<f64, AnyBlock<f64>>(3000);
}

fn intact<T: Real, C: Block<T>>() {
    for_all(3000, &(config_bytes(), vec(any::<u8>(), OPERATION_BYTES + 64)), |(config, bytes)| {
        Built::<T, C>::new(&Case::draw(&config, None)).map_or(Ok(()), |built| overwrite(&built, &bytes))
    });
}

#[test]
fn intact_snapshots_of_anything_are_refused_or_harmless() {
    intact::<f32, NoCompensator>();
    intact::<f64, NoCompensator>();
    intact::<f32, AnyBlock<f32>>();
    intact::<f64, AnyBlock<f64>>();
}

/// A test of what is refused would show nothing: most configurations are loops that can be built.
fn share_accepted<T: Real, C: Block<T>>() -> f64 {
    let mut runner = runner(1);
    let number = 4000;
    let accepted = (0..number)
        .filter(|_| {
            let bytes = config_bytes().new_tree(&mut runner).expect("no filter").current();
            Built::<T, C>::new(&Case::draw(&bytes, None)).is_ok()
        })
        .count();
    accepted as f64 / f64::from(number)
}

#[test]
fn most_of_the_configurations_are_loops() {
    let shares = [
        ("f32", share_accepted::<f32, NoCompensator>()),
        ("f64", share_accepted::<f64, NoCompensator>()),
        ("f32 with a compensator", share_accepted::<f32, AnyBlock<f32>>()),
        ("f64 with a compensator", share_accepted::<f64, AnyBlock<f64>>()),
    ];
    for (name, share) in shares {
        println!("{name}: {:.1} % accepted", 100.0 * share);
        assert!(share >= 0.5, "{name}: only {:.1} %", 100.0 * share);
    }
}
