//! Outputs of pyadrc 0.6.1 and observer poles in 50 digits: `golden/make_adrc.py` wrote them.

use controller_core::{Adrc, AdrcConfig, AdrcInput, AdrcState};
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("../../golden/adrc.json")).expect("the golden file")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// 1e-12 of the largest output, limits of range and rate included.
#[test]
fn the_outputs_are_those_of_pyadrc() {
    let golden = golden();
    let mut limited = 0;
    for case in golden["loops"].as_array().expect("loops") {
        let of = |key: &str| number(&case[key]);
        let config = AdrcConfig::from_bandwidths(of("b0"), of("omega_c"), of("omega_o"));
        let law = Adrc::<f64>::new(&config, of("ts")).expect("valid");
        let mut state = AdrcState::default();
        let samples = case["samples"].as_array().expect("samples");
        let rows: Vec<[f64; 4]> = samples.iter().map(|row| [0, 1, 2, 3].map(|i| number(&row[i]))).collect();
        let largest = rows.iter().fold(0.0_f64, |largest, row| largest.max(row[3].abs()));
        limited += rows.windows(2).filter(|pair| pair[1][2] != pair[0][3]).count();
        for (k, [r, y, u, expected]) in rows.into_iter().enumerate() {
            let ours = law.step(&mut state, AdrcInput { r, y, u }).u();
            assert!((ours - expected).abs() <= 1e-12 * largest, "sample {k}: {ours} against {expected}");
        }
    }
    assert!((20..200).contains(&limited), "{limited} of 270 samples");
}

/// The law's response to one measurement gives its three observer gains; the poles follow from them.
#[test]
fn the_observer_has_the_sampled_poles() {
    let golden = golden();
    for case in golden["poles"].as_array().expect("poles") {
        let [beta1, beta2, beta3] = [0, 1, 2].map(|i| number(&case["beta"][i]));
        let [e1, e2, e3] = [0, 1, 2].map(|i| number(&case["one_minus_q"][i]));
        let ts = number(&case["ts"]);
        let config = AdrcConfig { b0: 2.0, kp: 1e-4 / ts, kd: 1e-2 / ts, beta1, beta2, beta3 };
        let config = AdrcConfig { kp: config.kp.min(config.kd / ts), ..config };
        let law = Adrc::<f64>::new(&config, ts).expect("valid");
        let mut state = AdrcState::default();
        let _ = law.step(&mut state, AdrcInput { r: 0.0, y: 1.0, u: 0.0 });
        let close = |what: &str, ours: f64, expected: f64| {
            assert!(
                (ours / expected - 1.0).abs() <= 1e-11,
                "{beta1} {beta2} {beta3}, {what}: {ours} against {expected}"
            );
        };
        close("z1", state.output(), e1 - e2 + e3);
        close("w", state.slope(), e2 - 1.5 * e3);
        close("d", state.disturbance() * 2.0 * ts * ts, e3);
    }
}
