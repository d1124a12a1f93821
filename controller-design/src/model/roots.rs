//! First approximations of the roots of a polynomial: the simultaneous iteration of Aberth and Ehrlich.
//!
//! The starting points come from the Newton polygon of the coefficients (Bini 1996, "Numerical computation of
//! polynomial zeros by means of Aberth's method"): roots of very different sizes, as time constants are, each
//! start on a circle of about their own radius.

use std::vec::Vec;

use super::complex::Complex;
use super::double_double::{self, Horner};

/// Rounds before the iteration gives up; ten or twenty are usual.
const MAX_ROUNDS: usize = 200;

/// Approximate roots of `sum b[k]*x^k`; the first and the last coefficient must not be zero.
///
/// A root is settled when it no longer moves, or where the polynomial in twice the working precision cannot be
/// told from zero. The latter happens for roots of a high multiplicity only: they are then right one by one but
/// not jointly, which `correction` puts right.
pub(crate) fn approximate_roots(b: &[f64]) -> Vec<Complex> {
    let mut roots = starting_points(b);
    let mut settled: Vec<bool> = roots.iter().map(|_| false).collect();
    for _ in 0..MAX_ROUNDS {
        if settled.iter().all(|&s| s) {
            break;
        }
        for i in 0..roots.len() {
            if settled[i] {
                continue;
            }
            let x = roots[i];
            let Some(newton) = newton_correction(b, x) else {
                settled[i] = true;
                continue;
            };
            let mut repulsion = Complex::ZERO;
            for (j, &other) in roots.iter().enumerate() {
                if j != i && other != x {
                    repulsion = repulsion + Complex::ONE / (x - other);
                }
            }
            let mut step = newton / (Complex::ONE - newton * repulsion);
            if !step.is_finite() {
                // A stationary point: leave it along a direction of no special meaning.
                step = x * Complex::new(0.01, 0.017);
            }
            roots[i] = x - step;
            settled[i] = step.abs() <= 2.0 * f64::EPSILON * x.abs();
        }
    }
    roots
}

/// `p(x)/p'(x)`, or nothing when `p(x)` is not above its own rounding error. Outside the unit circle the reversed
/// polynomial is evaluated at `1/x`: no power of `x` overflows.
fn newton_correction(b: &[f64], x: Complex) -> Option<Complex> {
    let outside = x.abs() > 1.0;
    let y = if outside { Complex::ONE / x } else { x };
    let size = y.abs();
    let (mut horner, mut bound) = (Horner::default(), 0.0);
    let mut take = |&c: &f64| {
        horner.step(y, c);
        bound = bound * size + c.abs();
    };
    if outside {
        b.iter().for_each(&mut take);
    } else {
        b.iter().rev().for_each(&mut take);
    }
    let (p, slope) = (horner.value(), horner.slope());
    let degree = b.len().saturating_sub(1) as f64;
    if p.abs() <= 4.0 * degree * double_double::EPSILON * bound {
        return None;
    }
    Some(if outside {
        // With q(y) = y^n p(1/y): p/p' at x is 1/(n y - y^2 q'/q).
        Complex::ONE / (y * degree - y * y * (slope / p))
    } else {
        p / slope
    })
}

/// For every edge of the Newton polygon from `i` to `j`, `j - i` points on the circle with the radius the edge
/// gives.
fn starting_points(b: &[f64]) -> Vec<Complex> {
    let corners = newton_polygon(b);
    let mut points = Vec::new();
    for (from, to) in corners.iter().zip(corners.iter().skip(1)) {
        let count = to.0 - from.0;
        let radius = libm::exp2((from.1 - to.1) / count as f64);
        for k in 0..count {
            // The offset keeps the points off the real axis and off their conjugates.
            let angle = core::f64::consts::TAU * k as f64 / count as f64 + 0.7 + 0.4 * from.0 as f64;
            points.push(Complex::new(radius * libm::cos(angle), radius * libm::sin(angle)));
        }
    }
    points
}

/// The corners of the upper convex hull of the points `(k, log2 |b[k]|)`.
fn newton_polygon(b: &[f64]) -> Vec<(usize, f64)> {
    let mut corners: Vec<(usize, f64)> = Vec::new();
    for (k, &c) in b.iter().enumerate().filter(|(_, c)| **c != 0.0) {
        let point = (k, libm::log2(c.abs()));
        while let [.., before, last] = *corners {
            let slope_in = (last.1 - before.1) * (point.0 - last.0) as f64;
            let slope_out = (point.1 - last.1) * (last.0 - before.0) as f64;
            if slope_in > slope_out {
                break;
            }
            corners.pop();
        }
        corners.push(point);
    }
    corners
}
