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

/// The first `L` of `items`. The list's own `collect` panics when there are more.
pub(super) fn list_of<X, const L: usize>(items: impl IntoIterator<Item = X>) -> Vec<X, L> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
}

/// Sorts a few items by a number, the smallest first. The standard library's sort can panic when numbers have no order.
pub(super) fn sort_by_number<X>(items: &mut [X], number: impl Fn(&X) -> f64) {
    for end in 1..items.len() {
        for at in (1..=end).rev() {
            match items.get_mut(at - 1..=at) {
                Some([before, after]) if number(after) < number(before) => core::mem::swap(before, after),
                _ => break,
            }
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_ends_where_its_room_does() {
        assert_eq!(list_of::<_, 4>(0..3).as_slice(), [0, 1, 2]);
        assert_eq!(list_of::<_, 2>(0..3).as_slice(), [0, 1]);
    }

    #[test]
    fn numbers_are_sorted_and_what_has_no_order_does_no_harm() {
        for seed in 0..1000_u32 {
            // Of seven values, so that some come twice.
            let mut items: Vec<f64, 7> =
                list_of((1..=7).map(|k| libm::floor(4.0 * libm::sin(f64::from(seed * k)))));
            let mut expected = items.clone();
            expected.sort_by(f64::total_cmp);
            sort_by_number(&mut items, |&x| x);
            assert_eq!(items, expected);
        }
        let mut items = [2.0, f64::NAN, 1.0];
        sort_by_number(&mut items, |&x| x);
        sort_by_number::<f64>(&mut [], |&x| x);
        assert_eq!(items.iter().filter(|x| x.is_nan()).count(), 1);
    }
}
