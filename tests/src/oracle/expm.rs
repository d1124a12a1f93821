//! Dense matrix exponential and small linear systems.
//!
//! The exponential is formed as `e^A - I` (Taylor series, scaling and squaring in the variable `E = e^A - I`,
//! `E(2X) = E(X) (2 I + E(X))`). Subtracting the identity afterwards would lose the digits of a slow lag
//! sampled fast, where `1 - e^{-ts/tau}` is of the size of `ts/tau`. A small entry that belongs to a long
//! chain of lags is kept to a relative, not only to a norm-wise accuracy: every term of the series has the
//! structure of the chain.

use super::complex::{self, Complex};

/// Square or rectangular matrix by rows.
pub type Matrix = Vec<Vec<f64>>;

/// Terms of the Taylor series; with a scaled norm of at most 1/2 the rest is below `2^-60` of every entry of
/// a chain of up to eight lags.
const TAYLOR_TERMS: usize = 30;

/// The `rows` by `cols` zero matrix.
pub fn zeros(rows: usize, cols: usize) -> Matrix {
    vec![vec![0.0; cols]; rows]
}

/// Matrix product `a b`.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut c = zeros(a.len(), b[0].len());
    for (row, a_row) in c.iter_mut().zip(a) {
        for (&factor, b_row) in a_row.iter().zip(b) {
            for (entry, &value) in row.iter_mut().zip(b_row) {
                *entry += factor * value;
            }
        }
    }
    c
}

/// Product of a matrix and a column, `a x`.
pub fn apply(a: &Matrix, x: &[f64]) -> Vec<f64> {
    a.iter().map(|row| dot(row, x)).collect()
}

/// Scalar product `x . y`.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// `e^A - I`; `a` is square, its unit that of a pure number (a rate times a time).
pub fn exp_m1(a: &Matrix) -> Matrix {
    let n = a.len();
    let norm = a.iter().map(|row| row.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
    assert!(norm.is_finite(), "the exponential of a matrix that is not finite");
    let squarings = if norm > 0.5 { (2.0 * norm).log2().ceil() as i32 } else { 0 };
    let factor = 0.5_f64.powi(squarings);
    let x: Matrix = a.iter().map(|row| row.iter().map(|v| v * factor).collect()).collect();

    // The smallest terms are added first, by Horner's rule: S <- X (I + S) / k.
    let mut e = zeros(n, n);
    for k in (1..=TAYLOR_TERMS).rev() {
        for (i, row) in e.iter_mut().enumerate() {
            row[i] += 1.0;
        }
        e = product(&x, &e);
        for row in &mut e {
            for entry in row.iter_mut() {
                *entry /= k as f64;
            }
        }
    }
    for _ in 0..squarings {
        let square = product(&e, &e);
        for (row, square_row) in e.iter_mut().zip(&square) {
            for (entry, &value) in row.iter_mut().zip(square_row) {
                *entry = 2.0 * *entry + value;
            }
        }
    }
    e
}

/// `e^A`; see [`exp_m1`].
pub fn exp(a: &Matrix) -> Matrix {
    let mut e = exp_m1(a);
    for (i, row) in e.iter_mut().enumerate() {
        row[i] += 1.0;
    }
    e
}

/// Solution `x` of `a x = b` by elimination with row pivoting; `None` for a singular matrix.
pub fn solve(a: &Matrix, b: &[f64]) -> Option<Vec<f64>> {
    let lift = |v: &f64| (*v, 0.0);
    let a: Vec<Vec<Complex>> = a.iter().map(|row| row.iter().map(lift).collect()).collect();
    let b: Vec<Complex> = b.iter().map(lift).collect();
    Some(solve_complex(a, b)?.into_iter().map(|v| v.0).collect())
}

/// Solution `x` of the complex system `a x = b` by elimination with row pivoting; `None` for a singular
/// matrix.
///
/// The pivot is the entry largest relative to its row (scaled pivoting), so that the rows of a chain whose
/// states differ by many decades are compared on one scale.
pub fn solve_complex(mut a: Vec<Vec<Complex>>, mut b: Vec<Complex>) -> Option<Vec<Complex>> {
    let n = b.len();
    let row_size = |row: &Vec<Complex>| row.iter().map(|&v| complex::abs(v)).fold(0.0, f64::max);
    let mut size: Vec<f64> = a.iter().map(row_size).collect();
    for col in 0..n {
        let relative = |row: usize| complex::abs(a[row][col]) / size[row];
        let pivot = (col..n).max_by(|&i, &j| relative(i).total_cmp(&relative(j)))?;
        a.swap(col, pivot);
        b.swap(col, pivot);
        size.swap(col, pivot);
        if complex::abs(a[col][col]) == 0.0 || !complex::abs(a[col][col]).is_finite() {
            return None;
        }
        for row in col + 1..n {
            let factor = complex::div(a[row][col], a[col][col]);
            for k in col..n {
                let term = complex::mul(factor, a[col][k]);
                a[row][k] = complex::sub(a[row][k], term);
            }
            b[row] = complex::sub(b[row], complex::mul(factor, b[col]));
        }
    }
    for row in (0..n).rev() {
        for k in row + 1..n {
            b[row] = complex::sub(b[row], complex::mul(a[row][k], b[k]));
        }
        b[row] = complex::div(b[row], a[row][row]);
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonal_entries_are_scalar_exponentials() {
        for rate in [-40.0, -3.0, -0.4, -1e-9, 0.0, 2.0] {
            let e = exp_m1(&vec![vec![rate]]);
            let exact = f64::exp_m1(rate);
            assert!((e[0][0] - exact).abs() <= 4e-15 * exact.abs(), "rate {rate}: {} {exact}", e[0][0]);
        }
    }

    #[test]
    fn rotation_of_an_undamped_pair() {
        let angle = 7.0_f64;
        let e = exp(&vec![vec![0.0, angle], vec![-angle, 0.0]]);
        assert!((e[0][0] - angle.cos()).abs() < 1e-13);
        assert!((e[0][1] - angle.sin()).abs() < 1e-13);
    }

    #[test]
    fn nilpotent_chain_gives_powers_over_factorials() {
        // Eight integrators in a row: entry (i, j) is h^(i-j)/(i-j)!, down to 1e-33 and still with all
        // digits.
        let h = 1e-4;
        let mut a = zeros(8, 8);
        for i in 1..8 {
            a[i][i - 1] = h;
        }
        let e = exp_m1(&a);
        let mut exact = 1.0;
        for i in 1..8 {
            exact *= h / i as f64;
            assert!((e[i][0] / exact - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn equal_lags_give_the_poisson_weights() {
        // dx1 = -x1, dx2 = x1 - x2, ...: entry (i, 0) of e^{A t} is e^{-t} t^i / i!.
        let t = 3.0_f64;
        let mut a = zeros(6, 6);
        for i in 0..6 {
            a[i][i] = -t;
            if i > 0 {
                a[i][i - 1] = t;
            }
        }
        let e = exp(&a);
        let mut exact = (-t).exp();
        for i in 0..6 {
            assert!((e[i][0] / exact - 1.0).abs() < 1e-13);
            exact *= t / (i + 1) as f64;
        }
    }

    #[test]
    fn solutions_satisfy_their_systems() {
        let a = vec![vec![0.0, 2.0, 1.0], vec![1e-6, 3e-6, 1e-6], vec![4.0, 0.5, -1.0]];
        let x = solve(&a, &[1.0, 2e-6, 3.0]).expect("a regular matrix");
        for (row, b) in a.iter().zip([1.0, 2e-6, 3.0]) {
            assert!((dot(row, &x) - b).abs() < 1e-14 * b.abs().max(row[0].abs()));
        }
        assert!(solve(&vec![vec![1.0, 2.0], vec![2.0, 4.0]], &[1.0, 1.0]).is_none());

        let a = vec![vec![(0.0, 1.0), (2.0, 0.0)], vec![(1.0, 1.0), (0.0, -3.0)]];
        let b = vec![(1.0, 0.0), (0.0, 2.0)];
        let x = solve_complex(a.clone(), b.clone()).expect("a regular matrix");
        for (row, b) in a.iter().zip(b) {
            let lhs = complex::add(complex::mul(row[0], x[0]), complex::mul(row[1], x[1]));
            assert!(complex::abs(complex::sub(lhs, b)) < 1e-14);
        }
    }
}
