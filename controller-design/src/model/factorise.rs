//! Real factors of a polynomial that was written out in full: approximate roots, joined to real factors, corrected
//! together where need be, clusters taken for multiple roots where that explains the coefficients as well.

use std::vec;
use std::vec::Vec;

use controller_core::plant_model::Factor;

use super::clusters::merge_clusters;
use super::complex::Complex;
use super::correction::{Part, correct, explains};
use super::quadratic::{push_roots, real_times};
use super::roots::approximate_roots;

/// Below this damping ratio a computed pair of roots cannot be told from an undamped one.
const LEAST_DAMPING: f64 = 1e-12;

/// Largest binary exponent of a scaled coefficient: sums of products stay finite.
const MAX_SCALED_EXPONENT: i32 = 400;

/// Factors in `x = s/2^exponent`.
pub(crate) struct ScaledFactors {
    pub(crate) factors: Vec<Factor>,
    pub(crate) exponent: i32,
}

impl ScaledFactors {
    /// The factors in `s`.
    pub(crate) fn unscaled(&self) -> Vec<Factor> {
        let a1 = |f: &Factor| libm::scalbn(f.a1, -self.exponent);
        let a2 = |f: &Factor| libm::scalbn(f.a2, -2 * self.exponent);
        self.factors.iter().map(|f| Factor { a1: a1(f), a2: a2(f) }).collect()
    }

    /// The roots of the factors in `s`.
    pub(crate) fn roots(&self) -> Vec<Complex> {
        let mut roots = Vec::new();
        self.factors.iter().for_each(|f| push_roots(*f, &mut roots));
        let unscaled = |x: f64| libm::scalbn(x, self.exponent);
        roots.into_iter().map(|x| Complex::new(unscaled(x.re), unscaled(x.im))).collect()
    }
}

/// The real factors whose product is `sum c[k]/c[0]*s^k`. The first and the last coefficient must not be zero.
///
/// A polynomial of degree 1 or 2 stays as it is. Of a higher degree, real roots give first-order factors and
/// complex pairs second-order ones, slowest first.
pub(crate) fn factorise(c: &[f64]) -> ScaledFactors {
    let (c, exponent) = scaled(c);
    let factors = match *c {
        [] | [_] => Vec::new(),
        [c0, c1] => vec![Factor::first(c1 / c0)],
        [c0, c1, c2] => vec![Factor::second(c1 / c0, c2 / c0)],
        [c0, ..] => higher_order_factors(&c, c0),
    };
    ScaledFactors { factors, exponent }
}

fn higher_order_factors(c: &[f64], c0: f64) -> Vec<Factor> {
    let mut parts = joined(&approximate_roots(c));
    let b: Vec<f64> = c.iter().map(|c| c / c0).collect();
    if !explains(&parts, &b) {
        correct(&mut parts, &b);
    }
    let factors = split(&parts);
    let mut factors = merge_clusters(&factors, &b).unwrap_or(factors);
    for f in &mut factors {
        if f.a2 > 0.0 && f.a1.abs() <= 2.0 * LEAST_DAMPING * libm::sqrt(f.a2) {
            f.a1 = 0.0;
        }
    }
    factors.sort_by(|f, g| time_scale(g).total_cmp(&time_scale(f)));
    factors
}

/// `1/|x|` of the factor's root or roots.
fn time_scale(factor: &Factor) -> f64 {
    if factor.a2 == 0.0 { factor.a1.abs() } else { libm::sqrt(factor.a2.abs()) }
}

/// Coefficients in `x = s/2^exponent`, times a power of two: the first and the last are near 1, and no digit of
/// any is changed.
fn scaled(c: &[f64]) -> (Vec<f64>, i32) {
    let degree = c.len().saturating_sub(1).max(1) as i32;
    let (_, e0) = libm::frexp(c.first().copied().unwrap_or(1.0));
    let (_, en) = libm::frexp(c.last().copied().unwrap_or(1.0));
    let exponent = (e0 - en) / degree;
    let scaled = c.iter().enumerate().map(|(k, &c)| {
        let (mantissa, e) = libm::frexp(c);
        // The bound acts only on coefficients of absurdly different sizes.
        let e = (e - e0 + k as i32 * exponent).clamp(-MAX_SCALED_EXPONENT, MAX_SCALED_EXPONENT);
        libm::scalbn(mantissa, e)
    });
    (scaled.collect(), exponent)
}

/// Joins conjugate roots and neighbouring real roots to quadratics; one real root may be left over.
///
/// A root is real when it is nearer to its own conjugate than any other root is to that.
fn joined(roots: &[Complex]) -> Vec<Part> {
    let mut open: Vec<Complex> = roots.iter().map(|&x| Complex::ONE / x).collect();
    // The clearest complex roots choose their partner first.
    open.sort_by(|u, v| (u.im.abs() / u.abs()).total_cmp(&(v.im.abs() / v.abs())));
    let mut parts = Vec::new();
    let mut real = Vec::new();
    while let Some(u) = open.pop() {
        let distances = open.iter().map(|&v| (v - u.conj()).abs()).enumerate();
        match distances.min_by(|(_, d), (_, e)| d.total_cmp(e)) {
            Some((k, distance)) if distance < 2.0 * u.im.abs() => {
                let mean = (u + open.remove(k).conj()) * 0.5;
                parts.push(Part::pair(mean, mean.conj()));
            }
            _ => real.push(u.re),
        }
    }
    real.sort_by(|u, v| u.abs().total_cmp(&v.abs()));
    let mut real = real.into_iter();
    while let Some(u) = real.next() {
        parts.push(real.next().map_or(Part::single(u), |v| Part::pair(Complex::real(u), Complex::real(v))));
    }
    parts
}

/// The factors one by one, each quadratic with real roots as its two first-order factors.
fn split(parts: &[Part]) -> Vec<Factor> {
    let mut factors = Vec::new();
    for factor in parts.iter().map(|p| p.factor) {
        match real_times(factor) {
            Some((t1, t2)) if factor.a2 != 0.0 => factors.extend([Factor::first(t1), Factor::first(t2)]),
            _ => factors.push(factor),
        }
    }
    factors
}
