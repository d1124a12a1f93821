//! No plant, no request and no record, however wild, makes the crate panic or give what cannot run: a bounded share of the
//! fuzz target `design`.

mod support_design;

use controller_design::design::Method;
use controller_design::model::parse;
use proptest::prelude::*;
use support_design::{Draws, assess_any, design_any, expression, identify_any, request};

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_220_905),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn bytes(most: usize) -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..most)
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn designs_are_sound_or_refused(bytes in bytes(120), method in prop::sample::select(&Method::ALL[..])) {
        let mut draws = Draws::new(&bytes);
        let (text, scale) = expression(&mut draws);
        if let Ok(plant) = parse(&text) {
            design_any(&plant, &request(&mut draws, method, scale));
        }
    }

    #[test]
    fn records_are_read_or_refused(bytes in bytes(1200)) {
        identify_any(&mut Draws::new(&bytes));
        assess_any(&mut Draws::new(&bytes));
    }
}

/// The generator is of use: designs come out of it, and records are understood.
#[test]
fn something_comes_out() {
    let mut state = 1_u64;
    let mut byte = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state.to_be_bytes()[0]
    };
    let mut counts = [0; 3];
    for _ in 0..60 {
        let bytes: Vec<u8> = (0..1000).map(|_| byte()).collect();
        let mut draws = Draws::new(&bytes);
        let (text, scale) = expression(&mut draws);
        let Ok(plant) = parse(&text) else { continue };
        let found = [
            design_any(&plant, &request(&mut draws, Method::Amigo, scale)),
            identify_any(&mut Draws::new(&bytes)),
            assess_any(&mut Draws::new(&bytes)),
        ];
        for (count, found) in counts.iter_mut().zip(found) {
            *count += usize::from(found);
        }
    }
    assert!(counts.iter().all(|count| *count > 3), "{counts:?}");
}
