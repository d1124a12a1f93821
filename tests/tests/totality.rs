//! Totality: whatever the inputs are, a step neither panics nor leaves its range.
//!
//! Random configurations over the documented ranges, random bit patterns of every input, swaps, lost samples,
//! settling and damaged snapshots in between. After each of them every output is finite, the output is in its
//! range and no faster than its rate (the range beats the rate), and the state is finite. The first good sample
//! closes the loop again; with a plant behind it, the loop reaches its set-point.
//!
//! The same cases on every run; with `SOAK=1` in the environment a hundred times as many, different on every run.

#[path = "totality/configs.rs"]
mod configs;
#[path = "totality/draw.rs"]
mod draw;
#[path = "totality/driven.rs"]
mod driven;
#[path = "totality/recovery.rs"]
mod recovery;

use configs::{CONFIG_BYTES, Case};
use controller_core::{NoCompensator, Real};
use driven::{AnyBlock, Block, Built, Checked, OPERATION_BYTES, drive};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestError, TestRng, TestRunner};
use recovery::{LOOP_BYTES, recovers};

/// A runner for a bounded number of cases, or for many when soaking.
fn runner(cases: u32) -> TestRunner {
    let soak = std::env::var_os("SOAK").is_some();
    let config = ProptestConfig {
        cases: if soak { 100 * cases } else { cases },
        failure_persistence: None,
        max_shrink_iters: 20_000,
        ..ProptestConfig::default()
    };
    if soak {
        TestRunner::new(config)
    } else {
        TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
    }
}

fn config_bytes() -> impl Strategy<Value = Vec<u8>> {
    vec(any::<u8>(), CONFIG_BYTES)
}

fn operations() -> impl Strategy<Value = Vec<Vec<u8>>> {
    vec(vec(any::<u8>(), OPERATION_BYTES), 0..60)
}

/// The configurations of one run: three, mostly with one sampling period.
fn cases(bytes: &[Vec<u8>]) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    for bytes in bytes {
        let ts = cases.first().map(|case| case.ts);
        cases.push(Case::draw(bytes, ts));
    }
    cases
}

/// Runs a check on `number` random values.
fn for_all<S: Strategy>(number: u32, strategy: &S, check: impl Fn(S::Value) -> Checked) {
    match runner(number).run(strategy, |value| check(value).map_err(TestCaseError::fail)) {
        Ok(()) => {}
        // The value is bytes; what they mean stands in the reason.
        Err(TestError::Abort(reason) | TestError::Fail(reason, _)) => panic!("{reason}"),
    }
}

fn total<T: Real, C: Block<T>>(number: u32) {
    for_all(number, &(vec(config_bytes(), 1..=3), operations()), |(bytes, operations)| {
        drive::<T, C>(&cases(&bytes), &operations)
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
