//! How uncertain the controller gain is that follows from uncertain areas.

use super::moments::{COUNT, Six};
use crate::Refusal;
use crate::areas::Areas;
use crate::rules::momi::Momi;

/// The gain `K_P` of the magnitude optimum for a filter `tf`.
pub(super) fn kp(areas: &Six, tf: f64) -> Result<f64, Refusal> {
    let mean_time = areas[1] / areas[0];
    if mean_time.is_nan() || mean_time <= 0.0 {
        return Err(Refusal::Data {
            why: "the areas have no positive A1/A0",
            help: "the output must rise to its new value without much overshoot; record a step with less noise",
        });
    }
    let gains = Momi::new(&Areas::new(*areas), tf);
    gains.map(|momi| momi.pid.kp).map_err(|_| Refusal::Data {
        why: "no controller follows from the record: the gains have the wrong sign",
        help: "record a larger step, or longer steady states before and after it",
    })
}

/// `d K_P / d A_k`.
pub(super) fn slopes(areas: &Six, tf: f64) -> Option<Six> {
    let mut slopes = [0.0; COUNT];
    for k in 0..COUNT {
        let step = 1e-6 * areas[k].abs();
        let (mut up, mut down) = (*areas, *areas);
        up[k] += step;
        down[k] -= step;
        slopes[k] = if step > 0.0 { (kp(&up, tf).ok()? - kp(&down, tf).ok()?) / (2.0 * step) } else { 0.0 };
    }
    Some(slopes)
}

/// `g' C g`.
pub(super) fn quadratic(slopes: &Six, covariance: &[Six; COUNT]) -> f64 {
    let mut sum = 0.0;
    for i in 0..COUNT {
        for j in 0..COUNT {
            sum += slopes[i] * covariance[i][j] * slopes[j];
        }
    }
    sum.max(0.0)
}
