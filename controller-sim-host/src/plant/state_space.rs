//! From a transfer function to a well-scaled state space.

use super::dense::{Matrix, solve};
use controller_design::model::{Polynomial, TransferFunction};

/// `x' = A*x + b*w`, `y = c*x + d*w` for the rational part of a plant, time in units of `scale` seconds.
///
/// Each denominator factor `D_i` is one block of a chain, in companion form: `X_i = X_(i-1)/D_i`. The output combines
/// the states; its coefficients come from dividing the numerator by the factors, last one first. Multiple poles are
/// never expanded or searched for.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpace {
    pub(super) a: Matrix,
    pub(super) b: Vec<f64>,
    pub(super) c: Vec<f64>,
    pub(super) d: f64,
    pub(super) scale: f64,
    integrators: usize,
    gain: f64,
    differentiators: usize,
}

impl StateSpace {
    /// The state space of `plant` without its dead time, for time steps around `scale` seconds.
    #[must_use]
    pub fn new(plant: &TransferFunction, scale: f64) -> Self {
        let in_scale = |p: &Polynomial| -> Vec<f64> {
            let powers = std::iter::successors(Some(1.0), |x| Some(x / scale));
            p.coefficients().iter().zip(powers).map(|(c, s)| c * s).collect()
        };
        let mut blocks: Vec<Vec<f64>> = vec![vec![0.0, 1.0 / scale]; plant.integrators()];
        blocks.extend(plant.den().iter().map(in_scale));
        let mut numerator = vec![plant.gain()];
        for _ in 0..plant.differentiators() {
            numerator = times(&numerator, &[0.0, 1.0 / scale]);
        }
        for zero in plant.num() {
            numerator = times(&numerator, &in_scale(zero));
        }

        let size: usize = blocks.iter().map(|block| block.len() - 1).sum();
        let mut a = Matrix::zero(size);
        let mut b = vec![0.0; size];
        let mut inputs = Vec::new();
        let mut start = 0;
        for block in &mut blocks {
            let degree = block.len() - 1;
            let lead = block[degree];
            block.iter_mut().for_each(|x| *x /= lead);
            // A fast block is scaled to static gain 1, a slow one to gain 1 at the time step.
            let gain = block[0].abs().max(1.0);
            for j in 0..degree {
                *a.at_mut(start + degree - 1, start + j) = -block[j];
                if j + 1 < degree {
                    *a.at_mut(start + j, start + j + 1) = 1.0;
                }
            }
            if start == 0 {
                b[degree - 1] = gain;
            } else {
                let source: usize =
                    inputs.iter().map(|&(d, _, _)| d).sum::<usize>() - inputs[inputs.len() - 1].0;
                *a.at_mut(start + degree - 1, source) = gain;
            }
            inputs.push((degree, gain, lead));
            start += degree;
        }

        // y = N/(D_1..D_n)*w: divide by the last block, the remainder belongs to its states.
        let mut c = vec![0.0; size];
        let mut end = size;
        let mut weight = 1.0 / inputs.iter().map(|&(_, gain, lead)| gain * lead).product::<f64>();
        for (block, &(degree, gain, lead)) in blocks.iter().zip(&inputs).rev() {
            let (quotient, remainder) = divide(&numerator, block);
            for (j, r) in remainder.iter().enumerate() {
                c[end - degree + j] = r * weight;
            }
            // What is left is divided by one block less; its coefficients still carry this block's lead.
            numerator = quotient.iter().map(|q| q / lead).collect();
            weight *= gain * lead;
            end -= degree;
        }
        let d = numerator.first().copied().unwrap_or(0.0);
        Self {
            a,
            b,
            c,
            d,
            scale,
            integrators: plant.integrators(),
            gain: plant.gain(),
            differentiators: plant.differentiators(),
        }
    }

    /// Order of the plant.
    #[must_use]
    pub fn order(&self) -> usize {
        self.b.len()
    }

    /// The states and the constant input for which the plant rests at the output `y0`; an integrating plant rests
    /// with input 0. `None` when there is no such input (a plant with a zero at `s = 0` and `y0` not 0).
    #[must_use]
    pub fn rest(&self, y0: f64) -> Option<(Vec<f64>, f64)> {
        let n = self.order();
        if self.differentiators > 0 {
            return (y0 == 0.0).then(|| (vec![0.0; n], 0.0));
        }
        let w0 = if self.integrators > 0 { 0.0 } else { y0 / self.gain };
        if n == 0 {
            return Some((Vec::new(), w0));
        }
        if self.integrators == 0 {
            let right = self.b.iter().map(|b| -b * w0).collect();
            return solve(self.a.clone(), right).map(|x| (x, w0));
        }
        // At rest every integrator but the last holds 0, and the blocks behind are driven by its constant state.
        let held = self.integrators - 1;
        let mut x = vec![0.0; n];
        x[held] = 1.0;
        let behind = n - self.integrators;
        if behind > 0 {
            let mut a = Matrix::zero(behind);
            let mut right = vec![0.0; behind];
            for i in 0..behind {
                for j in 0..behind {
                    *a.at_mut(i, j) = self.a.at(held + 1 + i, held + 1 + j);
                }
                right[i] = -self.a.at(held + 1 + i, held);
            }
            x[held + 1..].copy_from_slice(&solve(a, right)?);
        }
        let y: f64 = self.c.iter().zip(&x).map(|(c, x)| c * x).sum();
        x.iter_mut().for_each(|x| *x *= y0 / y);
        Some((x, w0))
    }
}

fn times(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; p.len() + q.len() - 1];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// Quotient and remainder of `p/q`, `q` monic, lowest power first.
fn divide(p: &[f64], q: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let degree = q.len() - 1;
    let mut rest = p.to_vec();
    let mut quotient = vec![0.0; p.len().saturating_sub(degree)];
    for k in (degree..p.len()).rev() {
        let lead = rest[k];
        quotient[k - degree] = lead;
        for j in 0..degree {
            rest[k - degree + j] -= lead * q[j];
        }
    }
    rest.truncate(degree);
    (quotient, rest)
}
