//! Roots of polynomials with known roots, within what the rounding of the coefficients allows.

use controller_design::model::{Complex, Polynomial};
use proptest::collection::vec;
use proptest::prelude::*;

/// `prod(1 - s/z)` over the real `z` and the pairs.
fn expanded(real: &[f64], pairs: &[(f64, f64)]) -> Polynomial {
    let mut p = Polynomial::constant(1.0);
    for &z in real {
        p = &p * &Polynomial::new([1.0, -1.0 / z]);
    }
    for &(re, im) in pairs {
        let square = re * re + im * im;
        p = &p * &Polynomial::new([1.0, -2.0 * re / square, 1.0 / square]);
    }
    p
}

fn all(real: &[f64], pairs: &[(f64, f64)]) -> Vec<Complex> {
    let upper = pairs.iter().map(|&(re, im)| Complex::new(re, im));
    real.iter().map(|&z| Complex::real(z)).chain(upper.clone()).chain(upper.map(Complex::conj)).collect()
}

/// The radius around `z` within which a polynomial whose coefficients differ from `p`'s by `errors` eps (relative)
/// has a root: the least over `m` of `(C(n,m) |p(z)| / |p^(m)(z)/m!|)^(1/m)`.
fn radius(p: &Polynomial, z: Complex, errors: f64) -> f64 {
    let n = p.degree();
    let size: f64 = p.coefficients().iter().rev().fold(0.0, |sum, c| sum * z.abs() + c.abs());
    let value = errors * f64::EPSILON * size;
    let mut least = f64::INFINITY;
    let mut derivative = p.coefficients().to_vec();
    let mut choose = 1.0;
    for m in 1..=n {
        choose *= (n + 1 - m) as f64 / m as f64;
        // p^(m)/m! from p^(m-1)/(m-1)!
        derivative = derivative.iter().enumerate().skip(1).map(|(k, c)| c * k as f64 / m as f64).collect();
        let slope = Polynomial::new(derivative.clone()).at(z).abs();
        least = least.min((choose * value / slope).powf(1.0 / m as f64));
    }
    least
}

/// Every known root has a computed one within its radius, and every computed one makes the polynomial vanish within
/// rounding.
fn assert_recovered(p: &Polynomial, known: &[Complex]) -> Result<(), TestCaseError> {
    let found = p.roots();
    prop_assert_eq!(found.len(), known.len());
    // Expanding rounds each coefficient some 2n times, the factors are corrected to a few eps each.
    let errors = 8.0 * known.len() as f64;
    for &z in known {
        let nearest = found.iter().map(|&w| (w - z).abs()).fold(f64::INFINITY, f64::min);
        prop_assert!(nearest <= radius(p, z, errors), "{z} of {p}: {found:?}");
    }
    for &w in &found {
        let size: f64 = p.coefficients().iter().rev().fold(0.0, |sum, c| sum * w.abs() + c.abs());
        prop_assert!(p.at(w).abs() <= errors * f64::EPSILON * size, "{w} of {p}");
        prop_assert!(w.im == 0.0 || found.contains(&w.conj()), "{w} of {p} has no conjugate");
    }
    Ok(())
}

/// The computed roots together: their product, written out in this file, is the polynomial again.
fn assert_product(p: &Polynomial) -> Result<(), TestCaseError> {
    let roots = p.roots();
    let mut product = vec![Complex::ONE];
    let mut size = vec![1.0];
    for &z in &roots {
        let u = -(Complex::ONE / z);
        product.push(Complex::ZERO);
        size.push(0.0);
        for k in (1..product.len()).rev() {
            product[k] = product[k] + product[k - 1] * u;
            size[k] += size[k - 1] * u.abs();
        }
    }
    for (k, (c, s)) in product.iter().zip(&size).enumerate() {
        let error = (*c - Complex::real(p.coefficient(k) / p.coefficient(0))).abs();
        // Accumulating complex products: some 6 roundings a factor.
        prop_assert!(
            error <= 6.0 * roots.len() as f64 * f64::EPSILON * s,
            "s^{k} of {p}: {error:e} of {s:e}"
        );
    }
    Ok(())
}

fn size() -> impl Strategy<Value = f64> {
    (-3.0..3.0_f64).prop_map(|x| 10f64.powf(x))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn spread_roots_are_recovered(
        real in vec((size(), any::<bool>()).prop_map(|(r, plus)| if plus { r } else { -r }), 0..11),
        pairs in vec((size(), 0.01..3.13_f64).prop_map(|(r, a)| (r * a.cos(), r * a.sin())), 0..6),
    ) {
        let p = expanded(&real, &pairs);
        assert_recovered(&p, &all(&real, &pairs))?;
        assert_product(&p)?;
    }

    #[test]
    fn stable_plants_are_recovered(times in vec(size(), 1..13), damped in vec((size(), 0.05..1.0_f64), 0..5)) {
        let real: Vec<f64> = times.iter().map(|t| -1.0 / t).collect();
        let pairs: Vec<_> = damped.iter().map(|&(r, d)| (-r * d, r * (1.0 - d * d).sqrt())).collect();
        let p = expanded(&real, &pairs);
        assert_recovered(&p, &all(&real, &pairs))?;
        assert_product(&p)?;
    }

    #[test]
    fn clusters_are_recovered(
        centre in size(), spread in (-9.0..-1.0_f64).prop_map(|x| 10f64.powf(x)),
        offsets in vec(-1.0..1.0_f64, 2..7), other in vec(size(), 0..4),
    ) {
        let near = offsets.iter().map(|o| -centre * (1.0 + spread * o));
        let real: Vec<f64> = near.chain(other.iter().map(|r| -r)).collect();
        let p = expanded(&real, &[]);
        assert_recovered(&p, &all(&real, &[]))?;
        assert_product(&p)?;
    }

    #[test]
    fn multiple_roots_are_recovered(
        z in size(), m in 1..9_usize, w in size(), n in 0..4_usize, pair in (size(), 0.1..3.0_f64), k in 0..4_usize,
    ) {
        let real: Vec<f64> = std::iter::repeat_n(-z, m).chain(std::iter::repeat_n(-w, n)).collect();
        let pairs = vec![(pair.0 * pair.1.cos(), pair.0 * pair.1.sin()); k];
        let p = expanded(&real, &pairs);
        assert_recovered(&p, &all(&real, &pairs))?;
        assert_product(&p)?;
    }

    #[test]
    fn no_polynomial_makes_the_search_fail(
        coefficients in vec(prop_oneof![any::<f64>(), -10.0..10.0, Just(0.0)], 0..22)
    ) {
        let p = Polynomial::new(coefficients);
        let count = if p.is_finite() { p.degree() } else { 0 };
        prop_assert_eq!(p.roots().len(), count);
    }
}

/// Multiplicities are recognised: the roots come out as accurate as simple ones.
#[test]
fn a_multiple_root_written_out_is_one_root() {
    for m in 3..=20 {
        for time in [1.0, 0.1, 80.3] {
            let p = expanded(&vec![-1.0 / time; m], &[]);
            for root in p.roots() {
                let error = (root - Complex::real(-1.0 / time)).abs() * time;
                assert!(error <= 4.0 * m as f64 * f64::EPSILON, "{m} times {time}: {root}");
            }
        }
    }
}

/// The roots 1, 2, .. 20 of Wilkinson's polynomial, whose coefficients (up to 20! = 2.4e18) are not all exact.
#[test]
fn wilkinsons_polynomial() {
    let mut p = Polynomial::constant(1.0);
    for k in 1..=20 {
        p = &p * &Polynomial::new([-f64::from(k), 1.0]);
    }
    let known: Vec<Complex> = (1..=20).map(|k| Complex::real(f64::from(k))).collect();
    assert_recovered(&p, &known).expect("within conditioning");
    // Condition numbers of the two smallest roots (Wilkinson 1963): 420 and 4.4e4.
    for (z, condition) in [(1.0, 420.0), (2.0, 4.4e4)] {
        let nearest = p.roots().iter().map(|r| (*r - Complex::real(z)).abs()).fold(1.0, f64::min);
        assert!(nearest < f64::EPSILON * condition * z, "{z}: {nearest:e}");
    }
}

#[test]
fn roots_of_unity() {
    for n in 3..=20_usize {
        let mut coefficients = vec![0.0; n + 1];
        (coefficients[0], coefficients[n]) = (-1.0, 1.0);
        let roots = Polynomial::new(coefficients).roots();
        for k in 0..n {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            let known = Complex::new(angle.cos(), angle.sin());
            assert!(roots.iter().any(|r| (*r - known).abs() < 1e-14), "{n}, {k}: {roots:?}");
        }
    }
}

#[test]
fn quadratics_do_not_cancel_or_overflow() {
    // 1 + 1e8 s + s^2: roots -1e-8 and -1e8, each to the last digits.
    let roots = Polynomial::new([1.0, 1e8, 1.0]).roots();
    assert!((roots[0].re * 1e8 + 1.0).abs() < 1e-15 && (roots[1].re * 1e-8 + 1.0).abs() < 1e-15);
    // 1 + 2e200 s + 1e400 s^2 would be double; 1 + 3e200 s + 1e300 s^2 has -1/3e200 and -3e-100.
    let roots = Polynomial::new([1.0, 3e200, 1e300]).roots();
    assert!((roots[0].re * 3e200 + 1.0).abs() < 1e-15 && (roots[1].re / 3e-100 + 1.0).abs() < 1e-15);
    assert_eq!(Polynomial::new([1.0, 0.0, -4.0]).roots(), [Complex::real(-0.5), Complex::real(0.5)]);
    assert_eq!(Polynomial::new([0.0, 0.0, 3.0]).roots(), [Complex::ZERO; 2]);
    assert!(Polynomial::default().roots().is_empty() && Polynomial::constant(2.0).roots().is_empty());
}
