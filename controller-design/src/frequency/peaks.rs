//! Extremes and crossings of a function of frequency, once a grid has bracketed them.

/// Where the maximum of `f` in `[a, b]` is, and its value: Brent's method (golden section with parabolas),
/// exact to about 1e-9 of the place, so to rounding in the value. `start` is the best point known.
pub(crate) fn maximum(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, start: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    const STEPS: usize = 80;
    let (mut a, mut b) = (a.min(b), a.max(b));
    let mut x = if start > a && start < b { start } else { a + GOLDEN * (b - a) };
    let mut fx = f(x);
    let (mut w, mut v, mut fw, mut fv) = (x, x, fx, fx);
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        let middle = 0.5 * (a + b);
        let tolerance = 4e-9 * x.abs() + f64::MIN_POSITIVE;
        if (x - middle).abs() <= 2.0 * tolerance - 0.5 * (b - a) {
            break;
        }
        let mut parabola = None;
        if before.abs() > tolerance {
            let r = (x - w) * (fv - fx);
            let q = (x - v) * (fw - fx);
            let p = (x - v) * q - (x - w) * r;
            let q = 2.0 * (q - r);
            let (p, q) = if q > 0.0 { (-p, q) } else { (p, -q) };
            if p.abs() < (0.5 * q * before).abs() && p > q * (a - x) && p < q * (b - x) {
                parabola = Some(p / q);
            }
        }
        before = step;
        step = parabola.unwrap_or_else(|| {
            before = if x < middle { b - x } else { a - x };
            GOLDEN * before
        });
        let u = if step.abs() >= tolerance { x + step } else { x + libm::copysign(tolerance, step) };
        let fu = f(u);
        if fu >= fx {
            if u < x {
                b = x;
            } else {
                a = x;
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                a = u;
            } else {
                b = u;
            }
            if fu >= fw || w == x {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu >= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
    (x, fx)
}

/// Where `f` changes its sign between `a` and `b`: regula falsi with halving (Illinois), to rounding of the place.
/// The signs at the ends must differ.
pub(crate) fn crossing(mut f: impl FnMut(f64) -> f64, a: f64, b: f64) -> f64 {
    let (mut a, mut b) = (a, b);
    let (mut fa, mut fb) = (f(a), f(b));
    for k in 0..200 {
        if fa == 0.0 || (b - a).abs() <= 4.0 * f64::EPSILON * a.abs().max(b.abs()) {
            return a;
        }
        if fb == 0.0 {
            return b;
        }
        let secant = b - fb * (b - a) / (fb - fa);
        let inside = secant.is_finite() && (secant - a) * (secant - b) < 0.0;
        // Every fourth step a bisection: no slow convergence from either side.
        let c = if inside && k % 4 != 3 { secant } else { 0.5 * (a + b) };
        let fc = f(c);
        if (fc > 0.0) == (fb > 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (c, fc);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maximum_is_found_to_half_the_digits() {
        let (x, y) = maximum(|x| 3.0 - (x - 1.25) * (x - 1.25), 0.5, 4.0, 2.0);
        assert!((x - 1.25).abs() < 2e-8 && (y - 3.0).abs() < 1e-15, "{x} {y}");
        let (x, y) = maximum(|x| -(x - 0.3).abs(), 0.0, 1.0, 0.9);
        assert!((x - 0.3).abs() < 1e-8 && y > -1e-8, "{x} {y}");
        // Undefined on a side: minus infinity is never a maximum.
        let (x, _) = maximum(|x| if x < 2.0 { f64::NEG_INFINITY } else { -x }, 1.0, 3.0, 2.5);
        assert!((x - 2.0).abs() < 1e-7, "{x}");
    }

    #[test]
    fn a_crossing_is_found_to_rounding() {
        let x = crossing(|x| x * x - 2.0, 1.0, 2.0);
        assert!((x - libm::sqrt(2.0)).abs() < 4e-16, "{x}");
        let x = crossing(|x| if x < 0.7 { -1e-9 } else { 1e9 }, 0.0, 1.0);
        assert!((x - 0.7).abs() < 1e-12, "{x}");
    }
}
