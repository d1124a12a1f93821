//! Small dense matrices: just what exact simulation needs.
//!
//! Written here rather than taken from a library because the same bits are wanted on every machine: libraries choose
//! fused or vector kernels at run time.

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Matrix {
    size: usize,
    cells: Vec<f64>,
}

impl Matrix {
    pub(crate) fn zero(size: usize) -> Self {
        Self { size, cells: vec![0.0; size * size] }
    }

    fn identity(size: usize) -> Self {
        let mut m = Self::zero(size);
        for i in 0..size {
            *m.at_mut(i, i) = 1.0;
        }
        m
    }

    pub(crate) fn size(&self) -> usize {
        self.size
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.cells[row * self.size + column]
    }

    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.cells[row * self.size + column]
    }

    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.cells[row * self.size..(row + 1) * self.size]
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.cells.iter_mut().for_each(|x| *x *= factor);
        self
    }

    fn add(&mut self, other: &Self) {
        for (x, y) in self.cells.iter_mut().zip(&other.cells) {
            *x += y;
        }
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::zero(self.size);
        for i in 0..self.size {
            for k in 0..self.size {
                let a = self.at(i, k);
                if a != 0.0 {
                    for j in 0..self.size {
                        *product.at_mut(i, j) += a * other.at(k, j);
                    }
                }
            }
        }
        product
    }

    fn norm(&self) -> f64 {
        (0..self.size).map(|i| self.row(i).iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
    }

    /// `exp(self*t)` by a Taylor series on a scaled matrix and squarings. The series is carried until every entry has
    /// stopped changing, so that entries that only high powers reach are as accurate as the others.
    pub(crate) fn exp(&self, t: f64) -> Self {
        let mut scaled = self.clone().scaled(t);
        let mut squarings = 0;
        while scaled.norm() > 0.25 && squarings < 200 {
            scaled = scaled.scaled(0.5);
            squarings += 1;
        }
        let mut term = Self::identity(self.size);
        let mut sum = term.clone();
        for k in 1..=(12 + 2 * self.size) {
            term = term.times(&scaled).scaled(1.0 / k as f64);
            sum.add(&term);
        }
        for _ in 0..squarings {
            sum = sum.times(&sum);
        }
        sum
    }
}

/// Solves `a*x = b` with partial pivoting; `None` when `a` is singular to working precision.
pub(crate) fn solve(mut a: Matrix, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = a.size();
    let largest = a.norm();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a.at(i, k).abs().total_cmp(&a.at(j, k).abs()))?;
        if a.at(pivot, k).abs() <= 1e-300 + 1e-15 * largest * f64::EPSILON {
            return None;
        }
        for j in 0..n {
            let (x, y) = (a.at(k, j), a.at(pivot, j));
            *a.at_mut(k, j) = y;
            *a.at_mut(pivot, j) = x;
        }
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a.at(i, k) / a.at(k, k);
            for j in k..n {
                *a.at_mut(i, j) -= factor * a.at(k, j);
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a.at(k, j) * b[j]).sum();
        b[k] = (b[k] - known) / a.at(k, k);
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_turns() {
        let mut m = Matrix::zero(2);
        *m.at_mut(0, 1) = 1.0;
        *m.at_mut(1, 0) = -1.0;
        let e = m.exp(10.0);
        assert!((e.at(0, 0) - libm::cos(10.0)).abs() < 1e-13);
        assert!((e.at(0, 1) - libm::sin(10.0)).abs() < 1e-13);
    }

    #[test]
    fn a_system_is_solved() {
        let mut m = Matrix::zero(2);
        *m.at_mut(0, 1) = 2.0;
        *m.at_mut(1, 0) = 4.0;
        *m.at_mut(1, 1) = 1.0;
        assert_eq!(solve(m, vec![2.0, 5.0]), Some(vec![1.0, 1.0]));
        assert_eq!(solve(Matrix::zero(2), vec![1.0, 1.0]), None);
    }
}
