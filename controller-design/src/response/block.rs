//! Small dense matrices, stored by columns so that a product with a vector adds whole columns.

use std::vec;
use std::vec::Vec;

#[derive(Debug, Clone)]
pub(super) struct Block {
    pub(super) rows: usize,
    pub(super) cols: usize,
    data: Vec<f64>,
}

impl Block {
    pub(super) fn zeros(rows: usize, cols: usize) -> Self {
        Self { rows, cols, data: vec![0.0; rows * cols] }
    }

    pub(super) fn get(&self, row: usize, col: usize) -> f64 {
        self.data[col * self.rows + row]
    }

    pub(super) fn set(&mut self, row: usize, col: usize, value: f64) {
        self.data[col * self.rows + row] = value;
    }

    pub(super) fn col(&self, col: usize) -> &[f64] {
        &self.data[col * self.rows..(col + 1) * self.rows]
    }

    pub(super) fn col_mut(&mut self, col: usize) -> &mut [f64] {
        &mut self.data[col * self.rows..(col + 1) * self.rows]
    }

    /// `out = self * x`.
    pub(super) fn apply(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (column, &x) in self.data.chunks_exact(self.rows).zip(x) {
            for (out, &a) in out.iter_mut().zip(column) {
                *out += a * x;
            }
        }
    }

    /// `self * other`.
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.rows, other.cols);
        for j in 0..other.cols {
            self.apply(other.col(j), product.col_mut(j));
        }
        product
    }

    /// The rows in this order.
    pub(super) fn select(&self, rows: impl Iterator<Item = usize> + Clone) -> Self {
        let mut chosen = Self::zeros(rows.clone().count(), self.cols);
        for j in 0..self.cols {
            let (from, to) = (self.col(j), chosen.col_mut(j));
            for (to, row) in to.iter_mut().zip(rows.clone()) {
                *to = from[row];
            }
        }
        chosen
    }

    /// The columns in this range.
    pub(super) fn columns(&self, range: core::ops::Range<usize>) -> Self {
        Self {
            rows: self.rows,
            cols: range.len(),
            data: self.data[range.start * self.rows..range.end * self.rows].to_vec(),
        }
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.data.iter_mut().for_each(|a| *a *= factor);
    }

    /// Largest size of any entry.
    pub(super) fn largest(&self) -> f64 {
        self.data.iter().fold(0.0, |m, a| if a.abs() > m { a.abs() } else { m })
    }

    /// Largest sum of sizes over a row.
    pub(super) fn norm(&self) -> f64 {
        let row = |i| (0..self.cols).map(|j| self.get(i, j).abs()).sum::<f64>();
        (0..self.rows).map(row).fold(0.0, |m: f64, r| if r > m || r.is_nan() { r } else { m })
    }

    pub(super) fn is_finite(&self) -> bool {
        self.data.iter().all(|a| a.is_finite())
    }
}
