//! The output of the chain: the numerator in terms of its elements.

use std::vec;
use std::vec::Vec;

use crate::model::{Complex, TransferFunction};

/// The weights `c_i` of the states and the feedthrough `d`: `G(s) = d + sum_i c_i/(D_1*...*D_i)`, in the time unit `ts`,
/// without dead time. `poles` are those of the chain, in its order and without the held input.
///
/// By dividing the numerator by `D_n`, the quotient by `D_(n-1)`, and so on; only as many elements as there are zeros
/// are met, so nothing is expanded but the numerator.
pub(super) fn weights(plant: &TransferFunction, ts: f64, poles: &[Complex]) -> (Vec<Complex>, f64) {
    let mut rest = vec![Complex::real(plant.gain())];
    for _ in 0..plant.integrators() {
        scale(&mut rest, ts);
    }
    for _ in 0..plant.differentiators() {
        scale(&mut rest, 1.0 / ts);
        rest.insert(0, Complex::ZERO);
    }
    for factor in plant.num() {
        let mut power = 1.0;
        let scaled: Vec<f64> = factor
            .coefficients()
            .iter()
            .map(|c| {
                let x = c * power;
                power /= ts;
                x
            })
            .collect();
        rest = times(&rest, &scaled);
    }
    let mut weights = vec![Complex::ZERO; poles.len()];
    for (weight, &pole) in weights.iter_mut().zip(poles).rev() {
        *weight = divide(&mut rest, pole);
    }
    // What is left has no denominator any more: a constant, real but for rounding.
    (weights, rest.first().map_or(0.0, |d| d.re))
}

fn scale(p: &mut [Complex], factor: f64) {
    p.iter_mut().for_each(|x| *x = *x * factor);
}

fn times(p: &[Complex], q: &[f64]) -> Vec<Complex> {
    let mut product = vec![Complex::ZERO; (p.len() + q.len()).saturating_sub(1)];
    for (i, a) in p.iter().enumerate() {
        for (sum, b) in product.iter_mut().skip(i).zip(q) {
            *sum = *sum + *a * *b;
        }
    }
    product
}

/// Divides `p` by `1 - s/pole` (by `s` for a pole at 0) and returns the remainder, by Horner's rule.
fn divide(p: &mut Vec<Complex>, pole: Complex) -> Complex {
    if p.is_empty() {
        return Complex::ZERO;
    }
    let integrator = pole == Complex::ZERO;
    // With `p_k = q_k - q_(k-1)/pole` from the highest power down: `q_(k-1) = pole*(q_k - p_k)`.
    let mut above = Complex::ZERO;
    for x in p.iter_mut().skip(1).rev() {
        let quotient = if integrator { *x } else { pole * (above - *x) };
        *x = quotient;
        above = quotient;
    }
    let constant = p.remove(0);
    if integrator { constant } else { constant - above }
}
