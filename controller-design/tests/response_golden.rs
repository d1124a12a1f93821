//! Indices against a finely sampled simulation of the loop as it is wired (`golden/responses.py`), with plants of all
//! kinds: slow zeros, zeros in the right half-plane, complex poles and zeros, integrators, unstable, no dead time.

use controller_core::PidConfig;
use controller_design::model::parse;
use controller_design::response::{ContinuousResponse, Load};

#[test]
fn indices_of_loops_as_they_are_wired() {
    let mut rows = 0;
    for line in include_str!("golden/responses.csv").lines().skip(1) {
        let (text, numbers) = line.split_once(';').expect("columns");
        let x: Vec<f64> = numbers.split(';').map(|x| x.parse().expect("a number")).collect();
        let pid = PidConfig { kp: x[0], ki: x[1], kd: x[2], tf: x[3], ..PidConfig::default() };
        let g = parse(text).expect("a plant");
        let response = if x[4] > 0.0 {
            ContinuousResponse::with_alpha(&g, &pid, x[4])
        } else {
            ContinuousResponse::new(&g, &pid, None)
        };
        let load = if x[5] > 0.0 { Load::Ramp } else { Load::Step };
        let i = response.and_then(|r| r.indices(load)).unwrap_or_else(|e| panic!("{line}: {e}"));
        let want = &x[6..];
        // The tail beyond the record and the corners of |e| leave a few 1e-6 in the golden values.
        assert!((i.ie - want[0]).abs() < 1e-5 * want[1], "{line}: {i:?}");
        for (ours, golden) in [(i.iae, want[1]), (i.ise, want[2]), (i.itae, want[3]), (i.e_max, want[4])] {
            assert!((ours / golden - 1.0).abs() < 1e-5, "{line}: {i:?}");
        }
        if load == Load::Step {
            assert!((i.tv / want[5] - 1.0).abs() < 1e-4, "{line}: {i:?}");
        }
        rows += 1;
    }
    assert_eq!(rows, 17);
}
