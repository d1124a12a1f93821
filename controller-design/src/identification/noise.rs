//! Noise and quantisation of a signal.

use super::record::mean;
use std::vec::Vec;

/// Most blocks into which residuals are averaged.
const MOST_BLOCKS: usize = 2000;

/// Of a signal, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    /// Standard deviation of the white part.
    pub(super) sigma: f64,
    /// Smallest step between two values, 0 when there is none to be seen.
    pub(super) quantisation: f64,
    /// How much longer averages must be than those of white noise of the same size; 1 for white noise.
    pub(super) colour: f64,
}

impl Noise {
    pub(super) fn in_units_of(self, unit: f64) -> Self {
        Self { sigma: self.sigma / unit, quantisation: self.quantisation / unit, ..self }
    }

    /// Standard deviation of what quantisation adds to a mean and does not average out: noise of a third of a step
    /// or more dithers it away.
    pub(super) fn steady_quantisation(&self) -> f64 {
        let (q, sigma) = (self.quantisation, self.sigma);
        if q > 0.0 {
            let ratio = sigma / q;
            q / libm::sqrt(12.0)
                * libm::exp(-2.0 * core::f64::consts::PI * core::f64::consts::PI * ratio * ratio)
        } else {
            0.0
        }
    }

    /// Takes over the size of white residuals of a fit, which are many more than the rows at rest.
    pub(super) fn confirm(&mut self, rms: f64, colour: f64) {
        if colour < 1.1 && (rms - self.sigma).abs() < 0.5 * self.sigma {
            self.sigma = rms;
        }
    }

    /// Variance of the mean of `count` values.
    pub(super) fn of_mean(&self, count: usize) -> f64 {
        let steady = self.steady_quantisation();
        self.sigma * self.sigma * self.colour / count.max(1) as f64 + steady * steady
    }
}

/// The noise of an output from stretches where it is steady.
pub(super) fn estimate(steady: &[&[f64]], all: &[f64]) -> Noise {
    let (mut sum, mut count) = (0.0, 0_usize);
    let (mut spread, mut degrees) = (0.0, 0_usize);
    for stretch in steady {
        for three in stretch.windows(3) {
            let bend = three[0] - 2.0 * three[1] + three[2];
            sum += bend * bend;
            count += 1;
        }
        let middle = mean(stretch);
        spread += stretch.iter().map(|y| (y - middle) * (y - middle)).sum::<f64>();
        degrees += stretch.len().saturating_sub(1);
    }
    let quantisation = quantisation(all);
    let white = if count > 0 { libm::sqrt(sum / (6.0 * count as f64)) } else { 0.0 };
    let total = if degrees > 0 { libm::sqrt(spread / degrees as f64) } else { 0.0 };
    // Slow noise shows in the spread, not in the second differences.
    let colour = if count >= 20 && white > 0.0 { correlation(steady) } else { 1.0 };
    let sigma = if colour > 1.5 { total.max(white) } else { white };
    Noise { sigma, quantisation, colour }
}

/// `1 + 2*sum(rho_k)` over the first positive autocorrelations, at least 1.
fn correlation(stretches: &[&[f64]]) -> f64 {
    let longest = stretches.iter().max_by_key(|s| s.len()).copied().unwrap_or(&[]);
    let middle = mean(longest);
    let centred: Vec<f64> = longest.iter().map(|y| y - middle).collect();
    colour(&centred)
}

/// `1 + 2*sum(rho_k)` of residuals over the first autocorrelations that are clearly positive, at least 1.
///
/// Long records are averaged in blocks first: only slow correlation matters, and the effort stays linear.
pub(super) fn colour(residuals: &[f64]) -> f64 {
    let block = residuals.len().div_ceil(MOST_BLOCKS).max(1);
    let blocks: Vec<f64> = residuals.chunks_exact(block).map(|chunk| chunk.iter().sum::<f64>()).collect();
    let power = |list: &[f64]| list.iter().map(|r| r * r).sum::<f64>() / list.len().max(1) as f64;
    let (single, whole) = (power(residuals), power(&blocks));
    if blocks.len() < 8 || whole.is_nan() || whole <= 0.0 {
        return 1.0;
    }
    // Two standard deviations of an estimated correlation of white noise.
    let count = blocks.len() as f64;
    let clear = 2.0 / libm::sqrt(count);
    let mut factor = 1.0;
    for lag in 1..blocks.len() / 4 {
        let pairs = blocks.iter().zip(&blocks[lag..]);
        let rho = pairs.map(|(a, b)| a * b).sum::<f64>() / (whole * count);
        if rho < clear {
            break;
        }
        factor += 2.0 * rho;
    }
    (factor * whole / (single * block as f64)).max(1.0)
}

/// A typical size of the changes from row to row that go to and fro.
pub(super) fn jitter(list: &[f64]) -> f64 {
    let mut bends: Vec<f64> = list.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).collect();
    let middle = bends.len() / 2;
    if bends.is_empty() {
        return 0.0;
    }
    // The median of a normal distribution's modulus, and the variance of a second difference.
    *bends.select_nth_unstable_by(middle, f64::total_cmp).1 / (0.6745 * libm::sqrt(6.0))
}

/// The step of a signal that takes few values, 0 otherwise.
fn quantisation(all: &[f64]) -> f64 {
    let mut values = all.to_vec();
    values.sort_by(f64::total_cmp);
    let (lo, hi) = (values[0], values[values.len() - 1]);
    let same = 1e-9 * (hi - lo).max(1e-3 * hi.abs().max(lo.abs()));
    values.dedup_by(|a, b| (*a - *b).abs() <= same);
    if values.len() < 4 || 2 * values.len() > all.len() {
        return 0.0;
    }
    let gaps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let smallest = gaps.iter().copied().fold(f64::MAX, f64::min);
    // Printed digits make gaps of one step differ by some per cent.
    let (mut sum, mut steps, mut fits) = (0.0, 0.0, 0_usize);
    for gap in &gaps {
        let ratio = libm::round(gap / smallest);
        fits += usize::from((gap / smallest - ratio).abs() < 0.15);
        sum += gap;
        steps += ratio;
    }
    if 10 * fits >= 9 * gaps.len() { sum / steps } else { 0.0 }
}
