//! What only single precision cannot do.

use super::{Case, LIMITS, PLANT, WIDE, edited, faults, found};
use controller_sim_host::simulate::Precision;

/// What only single precision cannot do is found before the run.
#[test]
fn faults_of_single_precision() {
    #[rustfmt::skip]
    let cases: &[Case] = &[
        (&[(LIMITS, "limits = { lo = 1.0, hi = 1.00000001 }")], &[("conflict", 19, 17, "`limits.lo = 1.0` must be below `limits.hi = 1.00000001`, in single precision", "f64")]),
        (&[("ts = 0.01", "ts = 1e-9"), ("duration = 20.0", "duration = 0.5"), ("at = 10.0", "at = 0.1"), (PLANT, "1/(1+s)"),
            (PLANT, "1/(1+s)"), ("dead_time = 0.2", "dead_time = 0.0"), ("alpha = 0.1", "alpha = 0.2"), ("tfd = 0.06", "tfd = 0.07")],
            &[("out-of-range", 2, 6, "`ts = 1e-9` is out of range", "f64")]),
        (&[(LIMITS, "limits = { rate = 1e-60 }")], &[("out-of-range", 19, 19, "`limits.rate = 1e-60` is out of range; allowed: above 0", "f64")]),
        (&[(LIMITS, WIDE), ("kp = 2.35", "kp = 1e15"), ("kd = 0.48, tf = 0.119", "kd = 1e15, tf = 1e-6"), ("ts = 0.01", "ts = 1e-6"), ("duration = 20.0", "duration = 11.0")],
            &[("too-large", 18, 14, "the gains times the ranges", "f64")]),
    ];
    for (edits, expected) in cases {
        let text = edited(edits);
        assert!(found(&text, Precision::F64).is_ok(), "{edits:?} is good in double precision");
        let list = faults(&text, Precision::F32);
        assert_eq!(list.len(), expected.len(), "{edits:?}: {list:?}");
        for (fault, (code, line, column, message, help)) in list.iter().zip(*expected) {
            let place = fault.place(&text);
            assert_eq!((fault.code, place.line, place.column), (*code, *line, *column), "{list:?}");
            assert!(
                fault.message.contains(message) && fault.message.ends_with("single precision"),
                "{list:?}"
            );
            assert!(fault.help.as_deref().unwrap_or("").contains(help), "{list:?}");
        }
    }
}
