//! A chain of first-order elements and its matrix exponential, complex poles as they are.

use std::vec;
use std::vec::Vec;

use crate::model::Complex;

/// Every diagonal element of the scaled matrix is at most this in size, so that no term of a Taylor series outweighs
/// the first one of its entry.
const SCALED_POLE: f64 = 0.25;

/// Terms of the Taylor series behind the first one that reaches an entry: `0.25^14` is below `1e-8`, its factorials do
/// the rest.
const TERMS: usize = 16;

/// The time-scaled chain `x_i' = a_i*x_i + b_i*x_(i-1)`, `x_0` the held input: `a_0 = 0`, `b_i = -a_i` for a lag of
/// unit static gain and 1 for an integrator.
pub(super) struct Chain {
    /// The poles times the sampling period, `a_0 = 0` first.
    pub(super) poles: Vec<Complex>,
}

/// A lower triangular matrix, row by row.
pub(super) struct Triangle {
    rows: Vec<Vec<Complex>>,
}

impl Triangle {
    /// The entries of row `i`, the diagonal last.
    pub(super) fn row(&self, i: usize) -> &[Complex] {
        self.rows.get(i).map_or(&[], Vec::as_slice)
    }

    /// Whether every entry is finite.
    pub(super) fn is_finite(&self) -> bool {
        self.rows.iter().flatten().all(|x| x.is_finite())
    }

    fn square(&mut self) {
        // From the last row and the first column on, so that what is still needed is still there.
        for i in (0..self.rows.len()).rev() {
            for j in 0..i {
                let mut sum = Complex::ZERO;
                for k in j..=i {
                    sum = sum + self.at(i, k) * self.at(k, j);
                }
                self.set(i, j, sum);
            }
            let diagonal = self.at(i, i);
            self.set(i, i, diagonal * diagonal);
        }
    }

    fn at(&self, i: usize, j: usize) -> Complex {
        self.row(i).get(j).copied().unwrap_or_default()
    }

    fn set(&mut self, i: usize, j: usize, value: Complex) {
        if let Some(cell) = self.rows.get_mut(i).and_then(|row| row.get_mut(j)) {
            *cell = value;
        }
    }
}

impl Chain {
    fn feed(pole: Complex) -> Complex {
        if pole == Complex::ZERO { Complex::ONE } else { -pole }
    }

    /// `exp(M*t)`, `t` in samples, by a Taylor series and squarings.
    ///
    /// The diagonal is set to `exp(a_i*t)` after each squaring. A relative error of an off-diagonal entry then grows by
    /// a rounding error per squaring and is not doubled: for lags every entry keeps its relative accuracy, however far
    /// apart they are (all entries are sums of products of one sign).
    pub(super) fn exp(&self, t: f64) -> Triangle {
        let largest = self.poles.iter().fold(1.0, |most: f64, a| most.max(a.abs())) * t;
        let mut squarings = 0;
        let mut part = t;
        while largest * part > SCALED_POLE * t && squarings < 1100 {
            part *= 0.5;
            squarings += 1;
        }
        let size = self.poles.len();
        let mut term: Vec<Vec<Complex>> = (0..size).map(|i| vec![Complex::ZERO; i + 1]).collect();
        for (i, row) in term.iter_mut().enumerate() {
            row[i] = Complex::ONE;
        }
        let mut sum = Triangle { rows: term.clone() };
        for k in 1..size + TERMS {
            let scale = part / k as f64;
            let mut next = Vec::with_capacity(size);
            for (i, (row, &pole)) in term.iter().zip(&self.poles).enumerate() {
                let above: &[Complex] = if i == 0 { &[] } else { &term[i - 1] };
                let (own, fed) = (pole * scale, Self::feed(pole) * scale);
                let from_above = |j: usize| above.get(j).map_or(Complex::ZERO, |&x| fed * x);
                next.push(row.iter().enumerate().map(|(j, &x)| own * x + from_above(j)).collect::<Vec<_>>());
            }
            term = next;
            for (into, from) in sum.rows.iter_mut().flatten().zip(term.iter().flatten()) {
                *into = *into + *from;
            }
        }
        self.set_diagonal(&mut sum, part);
        for _ in 0..squarings {
            sum.square();
            part *= 2.0;
            self.set_diagonal(&mut sum, part);
        }
        sum
    }

    fn set_diagonal(&self, matrix: &mut Triangle, t: f64) {
        for (i, &pole) in self.poles.iter().enumerate() {
            matrix.set(i, i, (pole * t).exp());
        }
    }
}

/// `exp(x) - 1` without cancellation near 0.
pub(super) fn exp_minus_one(x: Complex) -> Complex {
    let half_sine = libm::sin(0.5 * x.im);
    let growth = libm::expm1(x.re);
    let re = growth * libm::cos(x.im) - 2.0 * half_sine * half_sine;
    Complex::new(re, if x.im == 0.0 { 0.0 } else { (growth + 1.0) * libm::sin(x.im) })
}
