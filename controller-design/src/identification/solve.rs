//! Normal equations of a small least-squares problem.

/// Most unknowns.
pub(super) const MOST: usize = 8;

/// `J'J` and `J'r`, gathered row by row.
#[derive(Debug, Clone)]
pub(super) struct Normal {
    count: usize,
    matrix: [[f64; MOST]; MOST],
    right: [f64; MOST],
}

impl Normal {
    pub(super) fn new(count: usize) -> Self {
        Self { count: count.min(MOST), matrix: [[0.0; MOST]; MOST], right: [0.0; MOST] }
    }

    /// Adds the equation `row * x = value`.
    pub(super) fn add(&mut self, row: &[f64], value: f64) {
        for i in 0..self.count {
            for j in 0..=i {
                self.matrix[i][j] += row[i] * row[j];
            }
            self.right[i] += row[i] * value;
        }
    }

    pub(super) fn solve(&self, damping: f64, fixed: &[bool]) -> Option<[f64; MOST]> {
        let mut held = [false; MOST];
        for (place, fixed) in held.iter_mut().zip(fixed) {
            *place = *fixed;
        }
        self.solve_with(damping, 0, &held)
    }

    /// The solution with the diagonal from the unknown `from` on larger by `damping`; `fixed` unknowns stay 0.
    pub(super) fn solve_with(&self, damping: f64, from: usize, fixed: &[bool; MOST]) -> Option<[f64; MOST]> {
        let factor = self.factor(damping, from, fixed)?;
        let mut x = [0.0; MOST];
        for i in 0..self.count {
            x[i] = if factor.used[i] { self.right[i] * factor.scale[i] } else { 0.0 };
        }
        factor.substitute(&mut x, self.count);
        for i in 0..self.count {
            x[i] *= factor.scale[i];
        }
        x[..self.count].iter().all(|x| x.is_finite()).then_some(x)
    }

    /// `variance` times the inverse; rows of unknowns on which nothing depends are 0.
    pub(super) fn inverse(&self, variance: f64) -> Option<[[f64; MOST]; MOST]> {
        let factor = self.factor(1e-13, 0, &[false; MOST])?;
        let mut inverse = [[0.0; MOST]; MOST];
        for j in 0..self.count {
            if !factor.used[j] {
                continue;
            }
            let mut x = [0.0; MOST];
            x[j] = factor.scale[j];
            factor.substitute(&mut x, self.count);
            for i in 0..self.count {
                inverse[i][j] = variance * x[i] * factor.scale[i];
            }
        }
        inverse.iter().flatten().all(|x| x.is_finite()).then_some(inverse)
    }

    /// Cholesky's factor of the matrix with unit diagonal.
    fn factor(&self, damping: f64, from: usize, fixed: &[bool; MOST]) -> Option<Factor> {
        let n = self.count;
        let mut factor = Factor { lower: [[0.0; MOST]; MOST], scale: [0.0; MOST], used: [false; MOST] };
        for i in 0..n {
            let diagonal = self.matrix[i][i];
            factor.used[i] = diagonal > 0.0 && diagonal.is_finite() && !fixed[i];
            factor.scale[i] = if factor.used[i] { 1.0 / root(diagonal) } else { 0.0 };
        }
        for i in 0..n {
            for j in 0..=i {
                let mut sum = if i == j {
                    if factor.used[i] { 1.0 + if i >= from { damping } else { 0.0 } } else { 1.0 }
                } else {
                    self.matrix[i][j] * factor.scale[i] * factor.scale[j]
                };
                for k in 0..j {
                    sum -= factor.lower[i][k] * factor.lower[j][k];
                }
                if i == j {
                    if sum.is_nan() || sum <= 1e-15 {
                        return None;
                    }
                    factor.lower[i][i] = root(sum);
                } else {
                    factor.lower[i][j] = sum / factor.lower[j][j];
                }
            }
        }
        Some(factor)
    }
}

struct Factor {
    lower: [[f64; MOST]; MOST],
    scale: [f64; MOST],
    used: [bool; MOST],
}

impl Factor {
    fn substitute(&self, x: &mut [f64; MOST], n: usize) {
        for i in 0..n {
            for k in 0..i {
                x[i] -= self.lower[i][k] * x[k];
            }
            x[i] /= self.lower[i][i];
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[i] -= self.lower[k][i] * x[k];
            }
            x[i] /= self.lower[i][i];
        }
    }
}

pub(super) fn root(x: f64) -> f64 {
    libm::sqrt(x.max(0.0))
}
