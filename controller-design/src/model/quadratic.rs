//! Factors `1 + a1*x + a2*x^2` in closed form, in the scaled variable of `factorise`: `(a1/2)^2` does not overflow.

use std::vec::Vec;

use controller_core::plant_model::Factor;

use super::complex::Complex;

/// `(t1, t2)` with `(1 + t1*x)*(1 + t2*x)` equal to the factor and `|t1| >= |t2|`, when its roots are real.
///
/// With `h = a1/2` the times are `h +- sqrt(h^2 - a2)`. The larger comes from the sum without cancellation, the
/// smaller from `t1*t2 = a2`.
pub(crate) fn real_times(factor: Factor) -> Option<(f64, f64)> {
    let half = 0.5 * factor.a1;
    let discriminant = half * half - factor.a2;
    if discriminant < 0.0 {
        return None;
    }
    let d = libm::sqrt(discriminant);
    let larger = if half < 0.0 { half - d } else { half + d };
    Some((larger, if larger == 0.0 { 0.0 } else { factor.a2 / larger }))
}

/// Appends the roots of the factor: one or two, the slower real one first, the upper complex one first.
pub(crate) fn push_roots(factor: Factor, roots: &mut Vec<Complex>) {
    if factor.a2 == 0.0 {
        roots.push(Complex::real(-1.0 / factor.a1));
    } else if let Some((t1, t2)) = real_times(factor) {
        roots.push(Complex::real(-1.0 / t1));
        roots.push(Complex::real(-1.0 / t2));
    } else {
        // x = (-h +- j*sqrt(a2 - h^2))/a2; 0 - h, so that no root on the axis has a real part of -0.
        let half = 0.5 * factor.a1;
        let im = libm::sqrt(factor.a2 - half * half);
        let root = Complex::new((0.0 - half) / factor.a2, im / factor.a2);
        roots.push(root);
        roots.push(root.conj());
    }
}
