//! Correction of all factors of a polynomial together.
//!
//! Computed roots that are right one by one need not be right jointly: the product of the factors of a multiple
//! root is off by as much as the roots are apart. Here the coefficients of all factors move together until their
//! product is the polynomial again, each coefficient within rounding. The unknowns are coefficients of real
//! quadratics, not roots, because they stay smooth where two real roots meet and turn complex. A factor may count
//! several times: with the multiplicities given, a multiple root is as well determined as a simple one (Zeng 2005,
//! "Computing multiple roots of inexact polynomials").

use std::vec;
use std::vec::Vec;

use controller_core::plant_model::Factor;

use super::complex::Complex;

/// Most corrections; an unrecognised cluster of roots halves its error with each.
const MAX_CORRECTIONS: usize = 60;

/// A factor, how often it occurs, and the sizes its coefficients would have if nothing cancelled in them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    pub(crate) factor: Factor,
    pub(crate) count: usize,
    size: Factor,
}

impl Part {
    /// `(1 - u*x)(1 - v*x)`; `v` is `u`'s conjugate or real like `u`.
    pub(crate) fn pair(u: Complex, v: Complex) -> Self {
        let factor = Factor::second(-(u.re + v.re), (u * v).re);
        Self { factor, count: 1, size: Factor::second(u.abs() + v.abs(), u.abs() * v.abs()) }
    }

    /// `1 - u*x`, `u` real.
    pub(crate) fn single(u: f64) -> Self {
        Self { factor: Factor::first(-u), count: 1, size: Factor::first(u.abs()) }
    }

    /// The same factor `count` times.
    pub(crate) const fn times(self, count: usize) -> Self {
        Self { factor: self.factor, count, size: self.size }
    }
}

/// The product of the factors, ascending, each to its power.
fn product(factors: impl IntoIterator<Item = (Factor, usize)>) -> Vec<f64> {
    let mut product = vec![1.0];
    for (f, count) in factors {
        for _ in 0..count {
            let old = product.len();
            product.resize(old + f.order(), 0.0);
            for k in (1..product.len()).rev() {
                let below = k.checked_sub(2).map_or(0.0, |k| f.a2 * product[k]);
                product[k] += f.a1 * product[k - 1] + below;
            }
        }
    }
    product
}

/// Whether the product of the parts is `b`, each coefficient within the rounding errors of a written-out product
/// of that degree.
pub(crate) fn explains(parts: &[Part], b: &[f64]) -> bool {
    let allowed = 2.0 * b.len() as f64 * f64::EPSILON;
    let sizes = sizes(parts);
    sizes.len() == b.len() && relative_errors(parts, &sizes, b).iter().all(|e| e.abs() <= allowed)
}

/// Corrects the factors until their product is `b` within rounding, by steps of Levenberg and Marquardt.
pub(crate) fn correct(parts: &mut Vec<Part>, b: &[f64]) {
    let sizes = sizes(parts);
    if sizes.len() != b.len() {
        return;
    }
    let mut errors = relative_errors(parts, &sizes, b);
    let mut cost = square_sum(&errors);
    let mut damping = 1e-8;
    let mut corrections = 0;
    // The damping grows with every step refused, so the loop ends either way.
    while cost.is_finite() && corrections < MAX_CORRECTIONS && damping < 1e4 {
        if errors.iter().all(|e| e.abs() <= 0.5 * f64::EPSILON) {
            break;
        }
        let step = least_squares(jacobian(parts, &sizes), &errors, damping);
        let trial = moved(parts, &step);
        let trial_errors = relative_errors(&trial, &sizes, b);
        let trial_cost = square_sum(&trial_errors);
        if trial_cost < cost {
            *parts = trial;
            (errors, cost) = (trial_errors, trial_cost);
            damping = (damping * 0.01).max(1e-30);
            corrections += 1;
        } else {
            damping *= 100.0;
        }
    }
}

/// The sizes of what is summed up in each coefficient of the product.
fn sizes(parts: &[Part]) -> Vec<f64> {
    product(parts.iter().map(|p| (p.size, p.count)))
}

/// The error of each coefficient of the product but the constant one, over its size.
fn relative_errors(parts: &[Part], sizes: &[f64], b: &[f64]) -> Vec<f64> {
    let product = product(parts.iter().map(|p| (p.factor, p.count)));
    (1..b.len()).map(|k| (b[k] - product.get(k).copied().unwrap_or(0.0)) / sizes[k]).collect()
}

fn square_sum(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum()
}

/// The parts with their coefficients changed by `step`, which is relative to their sizes.
fn moved(parts: &[Part], step: &[f64]) -> Vec<Part> {
    let mut step = step.iter().copied();
    let mut next = || step.next().unwrap_or(0.0);
    let moved = parts.iter().map(|p| {
        let a1 = p.factor.a1 + p.size.a1 * next();
        let a2 = if p.size.a2 == 0.0 { 0.0 } else { p.factor.a2 + p.size.a2 * next() };
        Part { factor: Factor { a1, a2 }, ..*p }
    });
    moved.collect()
}

/// Columns of the derivatives of the product's coefficients (from `k = 1`, relative to their sizes) with respect
/// to each factor's coefficients (relative to theirs).
fn jacobian(parts: &[Part], sizes: &[f64]) -> Vec<Vec<f64>> {
    let mut columns = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let others = parts.iter().enumerate().map(|(j, p)| (p.factor, p.count - usize::from(j == i)));
        let cofactor = product(others);
        for (power, size) in [(1, part.size.a1), (2, part.size.a2)] {
            if size != 0.0 {
                let scale = size * part.count as f64;
                let entry =
                    |k: usize| k.checked_sub(power).and_then(|k| cofactor.get(k)).map_or(0.0, |c| c * scale);
                columns.push((1..sizes.len()).map(|k| entry(k) / sizes[k]).collect());
            }
        }
    }
    columns
}

/// The `x` that minimises `|A x - r|^2 + damping*|x|^2`, `A` given by columns: modified Gram-Schmidt on `A` with
/// `sqrt(damping)` times the unit matrix below it.
fn least_squares(mut columns: Vec<Vec<f64>>, r: &[f64], damping: f64) -> Vec<f64> {
    let n = columns.len();
    for (i, column) in columns.iter_mut().enumerate() {
        column.extend((0..n).map(|k| if k == i { libm::sqrt(damping) } else { 0.0 }));
    }
    let mut right = r.to_vec();
    right.resize(r.len() + n, 0.0);
    let mut triangle = vec![vec![0.0; n]; n];
    let mut x = vec![0.0; n];
    for i in 0..n {
        let (done, rest) = columns.split_at_mut(i + 1);
        let unit = &mut done[i];
        let norm = libm::sqrt(square_sum(unit));
        triangle[i][i] = norm;
        unit.iter_mut().for_each(|v| *v /= norm);
        for (column, j) in rest.iter_mut().zip(i + 1..) {
            triangle[i][j] = remove_projection(column, unit);
        }
        x[i] = remove_projection(&mut right, unit);
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| triangle[i][j] * x[j]).sum();
        x[i] = (x[i] - known) / triangle[i][i];
    }
    x
}

/// Makes `vector` orthogonal to `unit`; returns the length of what was removed.
fn remove_projection(vector: &mut [f64], unit: &[f64]) -> f64 {
    let length: f64 = vector.iter().zip(unit).map(|(v, u)| v * u).sum();
    vector.iter_mut().zip(unit).for_each(|(v, u)| *v -= length * u);
    length
}
