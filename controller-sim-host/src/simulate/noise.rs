//! Seeded measurement noise, the same numbers on every machine.

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// White Gaussian noise of unit standard deviation (Marsaglia's polar method; logarithm and root from `libm`, so that
/// a seed gives the same bits everywhere).
#[derive(Debug, Clone)]
pub struct Gaussian {
    source: Pcg64Mcg,
    spare: Option<f64>,
}

impl Gaussian {
    /// A generator with this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { source: Pcg64Mcg::seed_from_u64(seed), spare: None }
    }

    /// The next number.
    pub fn sample(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (a, b) = (self.uniform(), self.uniform());
            let s = a * a + b * b;
            if s > 0.0 && s < 1.0 {
                let factor = libm::sqrt(-2.0 * libm::log(s) / s);
                self.spare = Some(b * factor);
                return a * factor;
            }
        }
    }

    /// Uniform in -1..1.
    fn uniform(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 * (2.0 / (1_u64 << 53) as f64) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_spread_are_those_of_a_normal_distribution() {
        let mut noise = Gaussian::new(7);
        let n = 200_000;
        let list: Vec<f64> = (0..n).map(|_| noise.sample()).collect();
        let mean = list.iter().sum::<f64>() / n as f64;
        let variance = list.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n as f64;
        let beyond_two = list.iter().filter(|x| x.abs() > 2.0).count() as f64 / n as f64;
        // Four standard errors of each.
        assert!(mean.abs() < 0.009, "{mean}");
        assert!((variance - 1.0).abs() < 0.013, "{variance}");
        assert!((beyond_two - 0.0455).abs() < 0.0019, "{beyond_two}");
    }
}
