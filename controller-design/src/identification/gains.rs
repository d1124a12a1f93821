//! How uncertain the controller gain is that follows from uncertain areas.

use super::moments::{COUNT, Six};
use crate::Refusal;

/// `K_I, K_P, K_D` of the magnitude optimum, eq. (6), for a filter `tf`; none when the equations have no solution.
pub(super) fn momi(areas: &Six, tf: f64) -> Option<[f64; 3]> {
    let mut a = *areas;
    for k in 1..COUNT {
        a[k] += tf * a[k - 1];
    }
    let m = [[-a[1], a[0], 0.0], [-a[3], a[2], -a[1]], [-a[5], a[4], -a[3]]];
    // Cramer's rule for the right-hand side (-1/2, 0, 0).
    let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    let det = m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1);
    let gains = [minor(1, 2), -minor(0, 2), minor(0, 1)].map(|c| -0.5 * c / det);
    gains.iter().all(|g| g.is_finite()).then_some(gains)
}

/// The gain `K_P` of areas from which a controller follows.
pub(super) fn kp(areas: &Six, tf: f64) -> Result<f64, Refusal> {
    let [ki, kp, _] = match momi(areas, tf) {
        Some(gains) if areas[1] / areas[0] > 0.0 => gains,
        _ => {
            return Err(Refusal::Data {
                why: "the areas have no positive A1/A0",
                help: "the output must rise to its new value without much overshoot; record a step with less noise",
            });
        }
    };
    if kp * areas[0] > 0.0 && ki * areas[0] > 0.0 {
        return Ok(kp);
    }
    Err(Refusal::Data {
        why: "the controller gains that follow from the record have the wrong sign",
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
        slopes[k] = if step > 0.0 { (momi(&up, tf)?[1] - momi(&down, tf)?[1]) / (2.0 * step) } else { 0.0 };
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
