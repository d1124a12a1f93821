//! Areas straight from the record: the integrals of section "areas from records", with their uncertainty.
//!
//! With `U` and `Y` the transforms of the changes in units of the change of `u`, `s*U = 1 - u_1 s + u_2 s^2 - ..` and
//! `s*Y = A_0 - y_1 s + y_2 s^2 - ..`, so that `G = Y/U` has `A_k = y_k - sum(A_(k-i)*u_i, i = 1..k)`.

/// Number of areas.
pub(super) const COUNT: usize = 6;
/// `A_0..A_5`, or something for each.
pub(super) type Six = [f64; COUNT];

/// The weights by which the output enters: `y_k = sum(weight[k][i]*(y_inf - y[i]))`, `k = 1..5`.
pub(super) struct Weights {
    pub(super) rows: usize,
    pub(super) of: [std::vec::Vec<f64>; COUNT],
}

/// Values of `t^(k-1)/(k-1)!`, its slope, and `t^k/k!`.
fn powers(t: f64, k: usize) -> (f64, f64, f64) {
    let term = |n: usize| (1..=n).fold(1.0, |product, j| product * t / j as f64);
    (term(k - 1), if k > 1 { term(k - 2) } else { 0.0 }, term(k))
}

/// `u_0..u_5` for the held input `u` (0 before, `last` for good from `end` on), the first `rows` samples.
pub(super) fn of_input(t: &[f64], u: &[f64], rows: usize, last: f64) -> Six {
    let mut sums = [0.0; COUNT];
    sums[0] = 1.0;
    for i in 0..rows.saturating_sub(1) {
        let away = 1.0 - u[i] / last;
        if away == 0.0 {
            continue;
        }
        for k in 1..COUNT {
            sums[k] += away * (powers(t[i + 1], k).2 - powers(t[i], k).2);
        }
    }
    sums
}

/// The trapezoid on `w_k(t)*(y_inf - y)` with the end correction of every single step,
/// `h^2/12*(g'(left) - g'(right))`. On a regular grid all but the first slope cancel, and that is `f(0)` in `y_2` and
/// the slope of `f` in `y_1`; on an irregular one what is left follows from the slopes of `y` by differences. At rows
/// where the input jumps the two sides have slopes of their own.
pub(super) fn weights(t: &[f64], u: &[f64], rows: usize) -> Weights {
    let mut of: [std::vec::Vec<f64>; COUNT] = core::array::from_fn(|_| std::vec![0.0; rows]);
    for i in 0..rows.saturating_sub(1) {
        let h = t[i + 1] - t[i];
        let part = h * h / 12.0;
        for k in 1..COUNT {
            let (left, left_slope, _) = powers(t[i], k);
            let (right, right_slope, _) = powers(t[i + 1], k);
            of[k][i] += 0.5 * h * left + part * left_slope;
            of[k][i + 1] += 0.5 * h * right - part * right_slope;
            for (place, weight) in slope(t, u, rows, i, true) {
                of[k][place] += part * left * weight;
            }
            for (place, weight) in slope(t, u, rows, i + 1, false) {
                of[k][place] -= part * right * weight;
            }
        }
    }
    Weights { rows, of }
}

/// The slope at row `i` as a weighted sum of three samples; at a jump of the input, from the samples of the side of
/// the step in question only.
fn slope(t: &[f64], u: &[f64], rows: usize, i: usize, step_is_right: bool) -> [(usize, f64); 3] {
    let jump = i == 0 || (u[i] - u[i - 1]).abs() > 0.05;
    let (a, b, c) = match (jump, step_is_right) {
        (true, true) if i + 2 < rows => (i, i + 1, i + 2),
        (true, false) if i >= 2 => (i - 2, i - 1, i),
        _ if i == 0 => (0, 1, 2.min(rows - 1)),
        _ if i + 1 >= rows => (i.saturating_sub(2), i - 1, i),
        _ => (i - 1, i, i + 1),
    };
    if a == b || b == c {
        return [(i, 0.0); 3];
    }
    let (ta, tb, tc, at) = (t[a], t[b], t[c], t[i]);
    [
        (a, ((at - tb) + (at - tc)) / ((ta - tb) * (ta - tc))),
        (b, ((at - ta) + (at - tc)) / ((tb - ta) * (tb - tc))),
        (c, ((at - ta) + (at - tb)) / ((tc - ta) * (tc - tb))),
    ]
}

/// `y_0..y_5` for an output that ends at `last`; `y_0 = gain`.
pub(super) fn of_output(weights: &Weights, y: &[f64], last: f64, gain: f64) -> Six {
    let mut sums = [0.0; COUNT];
    sums[0] = gain;
    for k in 1..COUNT {
        sums[k] = weights.of[k].iter().zip(y).map(|(w, y)| w * (last - y)).sum();
    }
    sums
}

/// The areas from both; linear in `outputs`.
pub(super) fn areas(outputs: &Six, inputs: &Six) -> Six {
    let mut areas = [0.0; COUNT];
    for k in 0..COUNT {
        areas[k] = outputs[k] - (1..=k).map(|i| areas[k - i] * inputs[i]).sum::<f64>();
    }
    areas
}

/// `t^k/k!`, `k = 0..5`: how an error of the final value grows.
pub(super) fn growth(t: f64) -> Six {
    let mut terms = [1.0; COUNT];
    for k in 1..COUNT {
        terms[k] = terms[k - 1] * t / k as f64;
    }
    terms
}

/// What an exponential with the time constant `tau` leaves from `t` on, per value at `t`, `k = 0..5`.
pub(super) fn remainder(t: f64, tau: f64) -> Six {
    let mut rest = [0.0; COUNT];
    for k in 1..COUNT {
        // Integral of x^(k-1)/(k-1)! exp(-(x-t)/tau), by parts.
        rest[k] = tau * (growth(t)[k - 1] + rest[k - 1]);
    }
    rest
}

/// `L C L'` for the areas, which are linear in what `covariance` is of.
pub(super) fn through(covariance: &[Six; COUNT], inputs: &Six) -> [Six; COUNT] {
    let transpose =
        |m: &[Six; COUNT]| -> [Six; COUNT] { core::array::from_fn(|i| core::array::from_fn(|j| m[j][i])) };
    let rows = core::array::from_fn(|i| areas(&covariance[i], inputs));
    let half: [Six; COUNT] = transpose(&rows);
    core::array::from_fn(|i| areas(&half[i], inputs))
}
