//! Records of all kinds, and their readers.

use controller_design::assessment::{AssessOptions, Experiment, assess};
use controller_design::identification::{IdentifyOptions, Recording, identify};

use super::{Draws, printable};

/// Rows of time, input, output and set-point: something like a step response, with touches of nonsense.
fn rows(draws: &mut Draws<'_>) -> [Vec<f64>; 4] {
    let count = [3, 12, 60, 300, 0, 1, 2, 900][usize::from(draws.below(8))];
    let (wild, touched) = (draws.one_in(8), draws.one_in(2));
    let (step, at) = (draws.decades(-3.0, 3.0), draws.between(0.0, 0.5));
    let (delay, lag) = (draws.between(0.0, 0.2), draws.decades(-2.0, -0.3));
    let (noise, gain) = (draws.decades(-6.0, -0.5), draws.decades(-3.0, 3.0));
    let back = draws.between(0.5, 3.0);
    let mut list = [const { Vec::new() }; 4];
    for k in 0..count {
        let x = f64::from(k) / f64::from(count);
        let t = f64::from(k) * step;
        let u = if x >= at && x < back { 1.0 } else { 0.0 };
        let rise = |from: f64| 1.0 - libm::exp(-(x - from - delay).max(0.0) / lag);
        let y = gain * (rise(at) - rise(back) + noise * draws.between(-1.0, 1.0));
        let row = if wild { [(); 4].map(|()| draws.any()) } else { [t, u, y, 0.0] };
        for (column, value) in list.iter_mut().zip(row) {
            // Behind the end of the bytes a draw is never one.
            let value = if touched && draws.one_in(64) {
                match draws.below(4) {
                    0 => f64::NAN,
                    1 => f64::INFINITY,
                    2 => -value,
                    _ => draws.any(),
                }
            } else {
                value
            };
            column.push(value);
        }
    }
    if draws.one_in(20) {
        list[1].pop();
    }
    list
}

/// What `identify` makes of any record.
///
/// # Panics
/// When that is not sound.
pub(crate) fn identify_any(draws: &mut Draws<'_>) -> bool {
    let tf = draws.one_in(6).then(|| draws.any());
    let change_at = draws.one_in(6).then(|| draws.any());
    let [t, u, y, _] = rows(draws);
    let recording = Recording { t: &t, u: &u, y: &y };
    match identify(&recording, &IdentifyOptions { tf, change_at }) {
        Ok(found) => {
            assert!(found.areas.values().iter().all(|a| a.is_finite()), "{found:?}");
            assert!(found.sigma >= 0.0 && found.kp.is_finite(), "{found:?}");
            if let Some(model) = found.model {
                let all = [model.gain, model.a1, model.a2, model.dead_time];
                assert!(all.iter().all(|x| x.is_finite()) && model.dead_time >= 0.0, "{found:?}");
            }
            let _ = found.simulate(&recording);
            assert!(found.warnings.iter().all(|w| w.to_string().len() > 10));
            true
        }
        Err(refusal) => {
            printable(&refusal);
            false
        }
    }
}

/// What `assess` makes of any record.
///
/// # Panics
/// When that is not sound.
pub(crate) fn assess_any(draws: &mut Draws<'_>) -> bool {
    let step_at = draws.one_in(6).then(|| usize::from(draws.below(200)));
    let auto_at = draws.one_in(6).then(|| usize::from(draws.below(200)));
    let [t, input, output, setpoint] = rows(draws);
    let setpoint = if draws.one_in(4) { &[][..] } else { &setpoint };
    let experiment = Experiment { step_at, auto_at, ..Experiment::new(&t, setpoint, &output, &input) };
    match assess(&experiment, &AssessOptions::default()) {
        Ok(found) => {
            let reasons = &found.reasons;
            assert!(!reasons.is_empty(), "{found:?}");
            assert!(reasons.iter().all(|r| r.to_string().len() > 5 && !r.help().is_empty()), "{reasons:?}");
            if let Some(f) = found.features {
                assert!(f.p1 >= 0.0 && f.t1 >= 0.0 && f.sigma >= 0.0, "{f:?} {reasons:?}");
            }
            true
        }
        Err(refusal) => {
            printable(&refusal);
            false
        }
    }
}
