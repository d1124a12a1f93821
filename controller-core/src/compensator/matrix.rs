//! The small matrix exponential that the exact hold equivalent needs. Used in `new` only.

use crate::plant_model::MAX_ORDER;

/// States of the largest plant plus one for the held input.
pub(super) const SIZE: usize = MAX_ORDER + 1;
/// Index of the held input among the states.
pub(super) const INPUT: usize = MAX_ORDER;

/// A square matrix of fixed size; rows and columns that are not used stay zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Matrix([[f64; SIZE]; SIZE]);

/// A column of the same size.
pub(super) type Column = [f64; SIZE];

impl Matrix {
    pub(super) const ZERO: Self = Self([[0.0; SIZE]; SIZE]);

    fn identity() -> Self {
        let mut m = Self::ZERO;
        for (i, row) in m.0.iter_mut().enumerate() {
            if let Some(cell) = row.get_mut(i) {
                *cell = 1.0;
            }
        }
        m
    }

    pub(super) fn add_at(&mut self, row: usize, column: usize, value: f64) {
        if let Some(cell) = self.0.get_mut(row).and_then(|r| r.get_mut(column)) {
            *cell += value;
        }
    }

    /// The column of the held input, without the input's own row.
    pub(super) fn input_column(&self) -> Column {
        let mut column = [0.0; SIZE];
        for (cell, row) in column.iter_mut().zip(&self.0) {
            *cell = row.get(INPUT).copied().unwrap_or(0.0);
        }
        if let Some(last) = column.get_mut(INPUT) {
            *last = 0.0;
        }
        column
    }

    fn scaled(&self, factor: f64) -> Self {
        let mut m = *self;
        m.0.iter_mut().flatten().for_each(|x| *x *= factor);
        m
    }

    fn plus(&self, other: &Self) -> Self {
        let mut m = *self;
        for (x, y) in m.0.iter_mut().flatten().zip(other.0.iter().flatten()) {
            *x += y;
        }
        m
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for (out, row) in product.0.iter_mut().zip(&self.0) {
            for (a, other_row) in row.iter().zip(&other.0) {
                for (x, b) in out.iter_mut().zip(other_row) {
                    *x += a * b;
                }
            }
        }
        product
    }

    pub(super) fn apply(&self, v: &Column) -> Column {
        let mut out = [0.0; SIZE];
        for (x, row) in out.iter_mut().zip(&self.0) {
            *x = dot(row, v);
        }
        out
    }

    fn norm(&self) -> f64 {
        let row_sum = |row: &[f64; SIZE]| row.iter().map(|x| x.abs()).sum::<f64>();
        self.0.iter().map(row_sum).fold(0.0, |a, b| if b > a { b } else { a })
    }

    /// `exp(self*t)`: Taylor series on a scaled matrix, then squarings.
    ///
    /// The chains that are handed in have non-negative couplings, so that the squarings add numbers of one sign
    /// and every entry keeps its relative accuracy (up to the oscillating pairs).
    pub(super) fn exp(&self, t: f64) -> Self {
        let mut scaled = self.scaled(t);
        let mut squarings = 0;
        while scaled.norm() > 0.25 && squarings < 64 {
            scaled = scaled.scaled(0.5);
            squarings += 1;
        }
        // 0.25^k/k! is below 1e-17 of the first term at k = 12; a few more for entries that start late in the
        // series (a chain of 8 lags couples its ends only from the 8th power on).
        let mut term = Self::identity();
        let mut sum = term;
        for k in 1..=22_u8 {
            term = term.times(&scaled).scaled(1.0 / f64::from(k));
            sum = sum.plus(&term);
        }
        for _ in 0..squarings {
            sum = sum.times(&sum);
        }
        sum
    }
}

pub(super) fn dot(a: &Column, b: &Column) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_integrators_gives_powers_over_factorials() {
        let mut m = Matrix::ZERO;
        m.add_at(0, INPUT, 1.0);
        for i in 1..MAX_ORDER {
            m.add_at(i, i - 1, 1.0);
        }
        let t = 0.75_f64;
        let column = m.exp(t).input_column();
        let mut expected = 1.0;
        for (value, power) in column.iter().take(MAX_ORDER).zip(1..=8_u8) {
            expected *= t / f64::from(power);
            assert!((value / expected - 1.0).abs() < 1e-14, "{power}: {value} {expected}");
        }
    }

    #[test]
    fn a_fast_lag_settles() {
        let mut m = Matrix::ZERO;
        m.add_at(0, 0, -1000.0);
        m.add_at(0, INPUT, 1000.0);
        assert!((m.exp(1.0).input_column()[0] - 1.0).abs() < 1e-13);
    }
}
