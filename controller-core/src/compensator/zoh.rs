//! The numerator `B` of the plant's exact hold equivalent, normalised to `B(1) = 1`.

use super::matrix::{Column, INPUT, Matrix, SIZE, dot};
use crate::plant_model::{Factor, MAX_ORDER};

/// A denominator factor of the plant, split so that real poles stand alone, in units of one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pole {
    /// `1/s`.
    Integrator,
    /// A real pole; `rate = ts/tau`.
    Real { rate: f64 },
    /// A complex pair `sigma^2 + d1*sigma + d0`, `sigma = s*ts`.
    Pair { d1: f64, d0: f64 },
}

impl Pole {
    pub(super) fn order(self) -> usize {
        match self {
            Self::Pair { .. } => 2,
            _ => 1,
        }
    }

    /// Real and imaginary part of `1 - q` with `q = exp(pole*ts)`, without cancellation.
    pub(super) fn one_minus_q(self) -> (f64, f64) {
        match self {
            Self::Integrator => (0.0, 0.0),
            Self::Real { rate } => (-libm::expm1(-rate), 0.0),
            Self::Pair { d1, d0 } => {
                let decay = 0.5 * d1;
                // A factor that is critically damped but for rounding counts as such.
                let square = d0 - decay * decay;
                let angle = if square > 0.0 { libm::sqrt(square) } else { 0.0 };
                let half = libm::sin(0.5 * angle);
                let size = libm::exp(-decay);
                (-libm::expm1(-decay) + size * 2.0 * half * half, size * libm::sin(angle))
            }
        }
    }

    /// `A(1)` of this pole over the static gain of its continuous section: `(1-q)/rate`, 1 for an integrator.
    fn static_ratio(self) -> f64 {
        let (re, im) = self.one_minus_q();
        match self {
            Self::Integrator => 1.0,
            Self::Real { rate } => re / rate,
            Self::Pair { d0, .. } => (re * re + im * im) / d0,
        }
    }
}

/// A polynomial with room for the largest order, lowest power first.
pub(super) type Poly = [f64; SIZE];

pub(super) fn times_linear(p: &Poly, c0: f64, c1: f64) -> Poly {
    let mut out = [0.0; SIZE];
    let mut below = 0.0;
    for (x, &a) in out.iter_mut().zip(p) {
        *x = c0 * a + c1 * below;
        below = a;
    }
    out
}

fn times_quadratic(p: &Poly, c0: f64, c1: f64, c2: f64) -> Poly {
    let mut out = [0.0; SIZE];
    let (mut below, mut two_below) = (0.0, 0.0);
    for (x, &a) in out.iter_mut().zip(p) {
        *x = c0 * a + c1 * below + c2 * two_below;
        two_below = below;
        below = a;
    }
    out
}

fn one() -> Poly {
    let mut p = [0.0; SIZE];
    p[0] = 1.0;
    p
}

/// The coefficients `b_0..b_n` of `B/B(1)` for the plant `prod(zeros)/prod(poles)` sampled with the fractional
/// delay `m` in `0..1` (whole samples are left to the delay line). `ts` \[s\] scales the zeros.
///
/// Method: the plant is a chain `X_i = c_i/(D_1..D_i)` of its poles with coefficients of order one, its output a
/// combination of the `X_i` (synthetic division of the numerator). The pulse response `h` of the chain follows from
/// matrix exponentials, and `B = A*h`. Since the chain is scaled by the sampling period, nothing of size
/// `(ts/tau)^n` is ever subtracted from one.
pub(super) fn numerator(poles: &[Pole], zeros: &[Factor], ts: f64, m: f64) -> Poly {
    let mut chain = Matrix::ZERO;
    let mut input = INPUT;
    let mut next = 0;
    let mut static_gain = 1.0; // of the scaled chain, times A(1)
    let mut scales = [1.0; MAX_ORDER];
    for (&pole, scale_out) in poles.iter().zip(&mut scales) {
        let scale = match pole {
            Pole::Integrator => 1.0,
            Pole::Real { rate } => {
                let s = if rate > 1.0 { rate } else { 1.0 };
                chain.add_at(next, next, -rate);
                s
            }
            Pole::Pair { d1, d0 } => {
                chain.add_at(next, next, -d1);
                chain.add_at(next, next + 1, -d0);
                chain.add_at(next + 1, next, 1.0);
                if d0 > 1.0 { d0 } else { 1.0 }
            }
        };
        chain.add_at(next, input, scale);
        next += pole.order();
        input = next - 1;
        *scale_out = scale;
        static_gain *= scale * pole.static_ratio();
    }
    let order = next;
    let output = combination(poles, &scales, zeros, ts, order);

    // A pulse of one sample that begins m samples late.
    let late = chain.exp(1.0 - m);
    let whole = chain.exp(1.0);
    let mut pulse = [0.0; SIZE];
    let mut state = late.apply(&whole.input_column());
    for (k, h) in pulse.iter_mut().enumerate().take(order + 1) {
        if k == 0 {
            *h = dot(&output, &late.input_column());
        } else {
            *h = dot(&output, &state);
            state = whole.apply(&state);
        }
    }

    let mut b = pulse;
    for &pole in poles {
        let (re, im) = pole.one_minus_q();
        let q = 1.0 - re;
        b = match pole {
            Pole::Pair { .. } => times_quadratic(&b, 1.0, -2.0 * q, q * q + im * im),
            _ => times_linear(&b, 1.0, -q),
        };
    }
    for (k, x) in b.iter_mut().enumerate() {
        *x = if k > order || (m == 0.0 && k == order) { 0.0 } else { *x / static_gain };
    }
    b
}

/// How the output of the plant is combined from the chain's states: the numerator divided by the denominator
/// factors from the last one on, each remainder belonging to the states of one section.
fn combination(poles: &[Pole], scales: &[f64], zeros: &[Factor], ts: f64, order: usize) -> Column {
    let mut numerator = one();
    for zero in zeros {
        numerator = times_quadratic(&numerator, 1.0, zero.a1 / ts, zero.a2 / (ts * ts));
    }
    let mut output = [0.0; SIZE];
    let mut end = order;
    let mut later_scales = 1.0;
    for (&pole, &scale) in poles.iter().zip(scales).rev() {
        let first = end - pole.order();
        let (quotient, remainder) = match pole {
            Pole::Integrator => divide(&numerator, 0.0, 0.0, 1),
            Pole::Real { rate } => divide(&numerator, rate, 0.0, 1),
            Pole::Pair { d1, d0 } => divide(&numerator, d0, d1, 2),
        };
        // The states of a pair are (sigma*X, X), the state of a single pole is X.
        if let Some(cell) = output.get_mut(end - 1) {
            *cell = remainder.0 * later_scales;
        }
        if pole.order() == 2
            && let Some(cell) = output.get_mut(first)
        {
            *cell = remainder.1 * later_scales;
        }
        numerator = quotient;
        later_scales *= scale;
        end = first;
    }
    output
}

/// Quotient and remainder of `p/(sigma + d0)` (`degree` 1) or `p/(sigma^2 + d1*sigma + d0)` (`degree` 2); the
/// remainder is `r0 + r1*sigma`.
fn divide(p: &Poly, d0: f64, d1: f64, degree: usize) -> (Poly, (f64, f64)) {
    let mut work = *p;
    let mut quotient = [0.0; SIZE];
    for k in (degree..SIZE).rev() {
        let lead = work.get(k).copied().unwrap_or(0.0);
        if let Some(q) = quotient.get_mut(k - degree) {
            *q = lead;
        }
        if degree == 2
            && let Some(x) = work.get_mut(k - 1)
        {
            *x -= lead * d1;
        }
        if let Some(x) = work.get_mut(k - degree) {
            *x -= lead * d0;
        }
    }
    let [r0, r1, ..] = work;
    (quotient, (r0, if degree == 2 { r1 } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(b: &Poly, expected: &[f64], tol: f64) {
        for (i, (x, y)) in b.iter().zip(expected).enumerate() {
            assert!((x - y).abs() < tol, "b[{i}] = {x}, expected {y}");
        }
        assert!(b.iter().skip(expected.len()).all(|&x| x == 0.0));
    }

    #[test]
    fn a_first_order_lag_has_one_tap_without_and_two_with_a_fraction() {
        let pole = [Pole::Real { rate: 0.3 }];
        close(&numerator(&pole, &[], 1.0, 0.0), &[1.0], 1e-15);
        // Closed form: b0 = (1-exp(-r(1-m)))/(1-exp(-r)), b1 the rest.
        let b0 = -libm::expm1(-0.3 * 0.6) / -libm::expm1(-0.3);
        close(&numerator(&pole, &[], 1.0, 0.4), &[b0, 1.0 - b0], 1e-15);
    }

    #[test]
    fn integrator_chains_give_euler_numbers() {
        let poles = [Pole::Integrator; 4];
        close(&numerator(&poles, &[], 0.1, 0.0), &[1.0 / 24.0, 11.0 / 24.0, 11.0 / 24.0, 1.0 / 24.0], 1e-13);
        let slow = [Pole::Real { rate: 1e-7 }; 4];
        close(&numerator(&slow, &[], 0.1, 0.0), &[1.0 / 24.0, 11.0 / 24.0, 11.0 / 24.0, 1.0 / 24.0], 1e-7);
    }

    #[test]
    fn a_zero_that_equals_a_pole_cancels_it() {
        // (1+2s)/((1+2s)(1+s)) sampled at 0.5 s: B = (1-q z^-1)/(1-q) with q of the cancelled pole.
        let poles = [Pole::Real { rate: 0.25 }, Pole::Real { rate: 0.5 }];
        let q = libm::exp(-0.25);
        close(&numerator(&poles, &[Factor::first(2.0)], 0.5, 0.0), &[1.0 / (1.0 - q), -q / (1.0 - q)], 1e-13);
    }

    #[test]
    fn an_undamped_pair_matches_the_closed_form() {
        // 1/(sigma^2 + w^2): B is symmetric, (1/2, 1/2).
        let w: f64 = 0.7;
        let b = numerator(&[Pole::Pair { d1: 0.0, d0: w * w }], &[], 1.0, 0.0);
        close(&b, &[0.5, 0.5], 1e-14);
    }
}
