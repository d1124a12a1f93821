//! Where the observer's poles lie once sampled.

/// `1 - exp(s*ts)` of the three roots of `s^3 + beta1*s^2 + beta2*s + beta3`, as their elementary symmetric functions:
/// the sum, the sum of the products of two, the product. No cancellation, however slow the roots are; a small error
/// of a multiple root, which no method avoids, leaves these functions alone.
///
/// The gains are positive with `beta1*beta2 > beta3`: all roots lie to the left.
pub(super) fn one_minus_q(beta: [f64; 3], ts: f64) -> [f64; 3] {
    let [beta1, beta2, beta3] = beta;
    // With s = -scale*t the polynomial is t^3 - a*t^2 + b*t - 1.
    let scale = libm::cbrt(beta3);
    let (a, b) = (beta1 / scale, beta2 / (scale * scale));
    let root = positive_root(a, b);
    // The other two have the product 1/root; their sum from the coefficient that loses least.
    let product = 1.0 / root;
    let sum = if root <= 1.0 { a - root } else { (b - product) / root };
    let sum = if sum > 0.0 { sum } else { 0.0 };
    let unit = scale * ts;
    let single = -libm::expm1(-root * unit);
    let (pair_sum, pair_product) = pair(0.5 * sum * unit, product * unit * unit);
    [single + pair_sum, single * pair_sum + pair_product, single * pair_product]
}

/// A root of `t^3 - a*t^2 + b*t - 1` between 0, where it is -1, and `a`, where it is `a*b - 1 > 0`: halving the distance
/// in representable numbers, so that 64 steps end at two neighbours whatever the scale.
fn positive_root(a: f64, b: f64) -> f64 {
    let (mut lo, mut hi) = (0_u64, a.to_bits());
    for _ in 0..64 {
        let middle = lo + ((hi - lo) >> 1);
        let t = f64::from_bits(middle);
        if ((t - a) * t + b) * t < 1.0 {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    f64::from_bits(hi)
}

/// Sum and product of `1 - exp(-sigma)` over the two roots of `sigma^2 - 2*half*sigma + product`.
fn pair(half: f64, product: f64) -> (f64, f64) {
    let square = half * half - product;
    if square < 0.0 {
        let size = libm::exp(-half);
        let sine = libm::sin(0.5 * libm::sqrt(-square));
        let turned = 2.0 * size * sine * sine;
        let decayed = -libm::expm1(-half);
        (2.0 * (decayed + turned), decayed * decayed + 2.0 * turned)
    } else {
        let fast = half + libm::sqrt(square);
        let (fast, slow) = (-libm::expm1(-fast), -libm::expm1(-product / fast));
        (fast + slow, fast * slow)
    }
}
