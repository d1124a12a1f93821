//! What a count says of a share.

/// How sure the interval of a share is.
pub const CONFIDENCE: f64 = 0.95;

/// The interval of Clopper and Pearson for the probability of which `hits` of `count` were seen: it has the true one with a
/// probability of at least [`CONFIDENCE`], whatever that is. Without any count it is all, 0 to 1.
///
/// Source: C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404-413: the bounds are those of which `hits` or more, and `hits`
/// or fewer, would have come with half of the rest. Cost: about 60 evaluations of the incomplete beta function for each bound.
///
/// ```
/// use controller_sim_host::batch::sample::clopper_pearson;
/// // Nothing in n: 1 - 0.025^(1/n).
/// let (lo, hi) = clopper_pearson(0, 100);
/// assert!(lo == 0.0 && (hi - 0.036216693).abs() < 1e-8);
/// ```
#[must_use]
pub fn clopper_pearson(hits: u64, count: u64) -> (f64, f64) {
    let tail = 0.5 * (1.0 - CONFIDENCE);
    let (k, n) = (hits as f64, count as f64);
    let lo = if hits == 0 { 0.0 } else { crossing(|p| incomplete_beta(k, n - k + 1.0, p) >= tail) };
    let hi = if hits >= count { 1.0 } else { crossing(|p| incomplete_beta(k + 1.0, n - k, p) >= 1.0 - tail) };
    (lo, hi)
}

/// Where `reached` begins to hold between 0 and 1.
fn crossing(reached: impl Fn(f64) -> bool) -> f64 {
    let (mut lo, mut hi) = (0.0_f64, 1.0_f64);
    for _ in 0..200 {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi || hi - lo <= 1e-15 * hi {
            break;
        }
        if reached(middle) { hi = middle } else { lo = middle }
    }
    hi
}

/// The regularised incomplete beta function `I_x(a, b)`, both above 0, by its continued fraction (Abramowitz and Stegun
/// 26.5.8, evaluated from the front as Lentz did).
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges fast on this side of the mean only.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let log =
        a * libm::log(x) + b * libm::log1p(-x) + libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b);
    let away = |y: f64| if y.abs() < 1e-300 { 1e-300 } else { y };
    // 1 + t1/(1 + t2/(1 + ...))
    let (mut value, mut c, mut d) = (1.0, 1.0, 0.0);
    for j in 1..200_000_u32 {
        let m = f64::from(j / 2);
        let term = if j % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        d = 1.0 / away(1.0 + term * d);
        c = away(1.0 + term / c);
        value *= c * d;
        if (c * d - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    libm::exp(log) / (a * value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// scipy 1.17.1: `beta.ppf(0.025, k, n-k+1)`, `beta.ppf(0.975, k+1, n-k)`.
    const SCIPY: [(u64, u64, f64, f64); 9] = [
        (0, 10, 0.0, 0.3084971078187607),
        (1, 10, 0.0025285785444617848, 0.4450161170281954),
        (5, 10, 0.18708602844739855, 0.8129139715526015),
        (10, 10, 0.6915028921812392, 1.0),
        (0, 10_000, 0.0, 0.0003688199146187622),
        (25, 10_000, 0.0016185014555470552, 0.003688295991068797),
        (5000, 10_000, 0.4901513805899805, 0.5098486194100196),
        (9999, 10_000, 0.9994429630020529, 0.9999974682224065),
        (3, 1_000_000, 6.186725501906401e-07, 8.767247788067677e-06),
    ];

    /// Logarithms of factorials of a million have an absolute error of 1e7 times that of a double, which is the relative one
    /// of the bounds.
    #[test]
    fn intervals_are_those_of_scipy() {
        for (hits, count, lo, hi) in SCIPY {
            let (a, b) = clopper_pearson(hits, count);
            let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * y;
            assert!(near(a, lo) && near(b, hi), "{hits} of {count}: {a} {b}");
        }
        assert_eq!(clopper_pearson(0, 0), (0.0, 1.0));
    }

    /// The definition itself, by the sum of binomial probabilities.
    #[test]
    fn bounds_leave_half_of_the_rest_on_each_side() {
        let at_least = |k: u64, n: u64, p: f64| -> f64 {
            let term = |i: u64| {
                let choose = (1..=i).map(|j| libm::log((n - i + j) as f64 / j as f64)).sum::<f64>();
                libm::exp(choose + i as f64 * libm::log(p) + (n - i) as f64 * libm::log1p(-p))
            };
            (k..=n).map(term).sum()
        };
        for (hits, count) in [(1, 5), (3, 40), (20, 40), (39, 40)] {
            let (lo, hi) = clopper_pearson(hits, count);
            assert!((at_least(hits, count, lo) - 0.025).abs() < 1e-12);
            assert!((1.0 - at_least(hits + 1, count, hi) - 0.025).abs() < 1e-12);
        }
    }
}
