//! How many random cases run, and where they come from.

use super::built::{Checked, OPERATION_BYTES};
use super::configs::{CONFIG_BYTES, Case};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestError, TestRng, TestRunner};

/// A runner for a bounded number of cases, or for many when soaking.
pub(crate) fn runner(cases: u32) -> TestRunner {
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

/// Runs a check on `number` random values.
pub(crate) fn for_all<S: Strategy>(number: u32, strategy: &S, check: impl Fn(S::Value) -> Checked) {
    match runner(number).run(strategy, |value| check(value).map_err(TestCaseError::fail)) {
        Ok(()) => {}
        // The value is bytes; what they mean stands in the reason.
        Err(TestError::Abort(reason) | TestError::Fail(reason, _)) => panic!("{reason}"),
    }
}

pub(crate) fn config_bytes() -> impl Strategy<Value = Vec<u8>> {
    vec(any::<u8>(), CONFIG_BYTES)
}

pub(crate) fn operations() -> impl Strategy<Value = Vec<Vec<u8>>> {
    vec(vec(any::<u8>(), OPERATION_BYTES), 0..60)
}

/// Configurations that follow each other in one loop, mostly with one sampling period.
pub(crate) fn swappable(bytes: &[Vec<u8>]) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    for bytes in bytes {
        let ts = cases.first().map(|case| case.ts);
        cases.push(Case::draw(bytes, ts));
    }
    cases
}
