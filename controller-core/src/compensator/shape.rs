//! What a model means for the size of a compensator: whole samples of delay, zeros that move, smallest filter order.

use crate::plant_model::{MAX_ORDER, PlantModel};
use crate::real::Real;
use heapless::Vec;

/// How near to a whole number of samples a delay counts as whole, for numbers given in `T`: the quotient of two rounded
/// numbers such as 0.2 and 0.01 must not make a fraction.
pub(super) fn nearness<T: Real>() -> f64 {
    let quotient = 4.0 * T::EPS;
    if quotient > 1e-9 { quotient } else { 1e-9 }
}

/// A delay as whole samples and a fraction in `0..1`; within `nearness` (relative) of a sample it counts as whole.
pub(super) fn whole_samples(delay: f64, ts: f64, nearness: f64) -> (usize, f64) {
    let samples = delay / ts;
    let nearest = libm::round(samples);
    let near = (samples - nearest).abs() <= nearness * (1.0 + nearest);
    let whole = if near { nearest } else { libm::floor(samples) };
    let fraction = if near { 0.0 } else { samples - whole };
    (f64_to_index(whole), fraction)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates, and is checked against the capacity
fn f64_to_index(x: f64) -> usize {
    x as usize
}

/// Time constants of the zeros that move into the `y` path: real, left half plane, not faster than a sample.
pub(super) fn moved_zeros(model: &PlantModel, ts: f64) -> Vec<f64, MAX_ORDER> {
    let mut moved: Vec<f64, MAX_ORDER> = Vec::new();
    for zero in &model.zeros {
        if let Some((slow, fast)) = zero.real_time_constants() {
            for beta in [slow, fast] {
                if beta >= ts {
                    let _ = moved.push(beta);
                }
            }
        }
    }
    moved
}

/// The smallest filter order: poles less moved zeros.
pub(super) fn least_order(model: &PlantModel, ts: f64) -> usize {
    model.order() - moved_zeros(model, ts).len()
}
