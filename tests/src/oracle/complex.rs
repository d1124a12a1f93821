//! Complex arithmetic on `(re, im)` pairs: the few operations a frequency response needs.

/// A complex number as `(real part, imaginary part)`.
pub type Complex = (f64, f64);

/// Sum `a + b`.
pub fn add(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}

/// Difference `a - b`.
pub fn sub(a: Complex, b: Complex) -> Complex {
    (a.0 - b.0, a.1 - b.1)
}

/// Product `a b`.
pub fn mul(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// Product with a real factor, `k a`.
pub fn scale(k: f64, a: Complex) -> Complex {
    (k * a.0, k * a.1)
}

/// Quotient `a / b` by Smith's method, which does not overflow for large `b`.
pub fn div(a: Complex, b: Complex) -> Complex {
    if b.0.abs() >= b.1.abs() {
        let ratio = b.1 / b.0;
        let den = b.0 + b.1 * ratio;
        ((a.0 + a.1 * ratio) / den, (a.1 - a.0 * ratio) / den)
    } else {
        let ratio = b.0 / b.1;
        let den = b.0 * ratio + b.1;
        ((a.0 * ratio + a.1) / den, (a.1 * ratio - a.0) / den)
    }
}

/// Modulus `|a|`.
pub fn abs(a: Complex) -> f64 {
    a.0.hypot(a.1)
}

/// Point of the unit circle `e^{j phase}`; `phase` in radians.
pub fn unit(phase: f64) -> Complex {
    let (sin, cos) = phase.sin_cos();
    (cos, sin)
}

/// `e^{j phase} - 1` without cancellation for small phases; `phase` in radians.
pub fn unit_minus_one(phase: f64) -> Complex {
    let (sin, cos) = (0.5 * phase).sin_cos();
    (-2.0 * sin * sin, 2.0 * sin * cos)
}

/// Integer power `a^n` by repeated squaring.
pub fn pow(a: Complex, n: usize) -> Complex {
    let (mut result, mut square, mut rest) = ((1.0, 0.0), a, n);
    while rest > 0 {
        if rest & 1 == 1 {
            result = mul(result, square);
        }
        square = mul(square, square);
        rest >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Complex, b: Complex) -> bool {
        abs(sub(a, b)) <= 1e-14 * (1.0 + abs(b))
    }

    #[test]
    fn quotient_undoes_product() {
        for (a, b) in [((1.0, 2.0), (3.0, -4.0)), ((-0.3, 7.0), (1e-3, 5.0)), ((2.0, 0.0), (0.0, -1.0))] {
            assert!(close(div(mul(a, b), b), a));
        }
    }

    #[test]
    fn power_is_repeated_product() {
        let z = (0.9, -0.4);
        assert!(close(pow(z, 5), mul(z, mul(mul(z, z), mul(z, z)))));
        assert!(close(pow(z, 0), (1.0, 0.0)));
    }

    #[test]
    fn small_rotation_keeps_its_digits() {
        let (re, im) = unit_minus_one(1e-9);
        assert!((re / -5e-19 - 1.0).abs() < 1e-15);
        assert!((im / 1e-9 - 1.0).abs() < 1e-15);
        assert!(close(add(unit_minus_one(2.0), (1.0, 0.0)), unit(2.0)));
        assert!(close(scale(2.0, unit(0.5)), (2.0 * 0.5_f64.cos(), 2.0 * 0.5_f64.sin())));
    }
}
