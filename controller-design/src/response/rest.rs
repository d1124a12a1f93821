//! Where a plant rests.

use std::vec::Vec;

/// The states `x` and the input `v` of `0 = a*x + b*v` for which the output `c*x` is 1; `None` where there are none: a zero
/// at `s = 0`. Rows are scaled before the elimination, so that time constants that are far apart cost no digits.
pub(super) fn rest(a: &[Vec<f64>], b: &[f64], c: &[f64]) -> Option<(Vec<f64>, f64)> {
    let n = a.len();
    let mut rows: Vec<Vec<f64>> = a
        .iter()
        .zip(b)
        .map(|(row, input)| {
            let mut row = row.clone();
            row.resize(n, 0.0);
            row.extend([*input, 0.0]);
            row
        })
        .collect();
    let mut last = c.to_vec();
    last.resize(n, 0.0);
    last.extend([0.0, 1.0]);
    rows.push(last);
    for row in &mut rows {
        let largest = row[..=n].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        row.iter_mut().for_each(|x| *x /= largest);
    }
    for column in 0..=n {
        let size = |i: &usize| rows[*i][column].abs();
        let pivot = (column..=n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        rows.swap(column, pivot);
        let top = rows[column].clone();
        if top[column].is_nan() || top[column].abs() <= 1e-14 {
            return None;
        }
        for row in &mut rows[column + 1..] {
            let factor = row[column] / top[column];
            if factor != 0.0 {
                row.iter_mut().zip(&top).skip(column).for_each(|(x, t)| *x -= factor * t);
            }
        }
    }
    let mut x = Vec::from_iter(core::iter::repeat_n(0.0, n + 1));
    for i in (0..=n).rev() {
        let known: f64 = (i + 1..=n).map(|j| rows[i][j] * x[j]).sum();
        x[i] = (rows[i][n + 1] - known) / rows[i][i];
    }
    let v = x.pop()?;
    Some((x, v))
}
