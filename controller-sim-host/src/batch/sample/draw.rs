//! Random numbers that are counted, not run through: each depends on the seed, the sample and the name of the quantity alone.

use crate::simulate::Gaussian;

/// One draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source(u64);

impl Source {
    /// The draw of the quantity `name` in a sample.
    pub(super) fn new(seed: u64, sample: u64, name: &str) -> Self {
        // FNV-1a of the name: another quantity beside it changes nothing.
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let name = name.bytes().fold(0xcbf2_9ce4_8422_2325, fold);
        Self(mix(mix(mix(seed).wrapping_add(sample)).wrapping_add(name)))
    }

    /// Uniform in 0..1, neither of them.
    pub(super) fn uniform(self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
        ((self.0 >> 12) as f64 + 0.5) * STEP
    }

    /// Normal with mean 0 and standard deviation 1, no farther from 0 than `cut`.
    pub(super) fn normal(self, cut: f64) -> f64 {
        let mut source = Gaussian::new(self.0);
        loop {
            let x = source.sample();
            if x.abs() <= cut {
                return x;
            }
        }
    }

    /// A seed that a double and a TOML integer hold.
    pub(super) fn seed(self) -> u64 {
        self.0 >> 11
    }
}

/// A permutation of 64 bits in which each bit of the input changes half of the output: a step of the generator SplitMix64
/// (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
fn mix(x: u64) -> u64 {
    let z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published outputs of SplitMix64 from the state 0.
    #[test]
    fn the_permutation_is_the_published_one() {
        let golden = 0x9e37_79b9_7f4a_7c15_u64;
        let list = [0, golden, golden.wrapping_mul(2)].map(mix);
        assert_eq!(list, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }

    /// Kolmogorov's statistic of `n` numbers against their distribution.
    fn distance(mut list: Vec<f64>, cumulative: impl Fn(f64) -> f64) -> f64 {
        list.sort_by(f64::total_cmp);
        let n = list.len() as f64;
        let gap = |(i, x): (usize, &f64)| {
            let f = cumulative(*x);
            (f - i as f64 / n).abs().max((f - (i + 1) as f64 / n).abs())
        };
        list.iter().enumerate().map(gap).fold(0.0, f64::max)
    }

    /// Beyond 1.95/sqrt(n) the statistic is once in a thousand sets; the seeds are fixed.
    #[test]
    fn draws_have_their_distributions() {
        const N: u64 = 20_000;
        let limit = 1.95 / (N as f64).sqrt();
        let draw = |name: &str| (0..N).map(|i| Source::new(3, i, name)).collect::<Vec<_>>();
        for name in ["gain", "lag1", "lag2"] {
            let uniform: Vec<f64> = draw(name).iter().map(|source| source.uniform()).collect();
            assert!(distance(uniform, |x| x) < limit, "{name}");
        }
        let phi = |x: f64| 0.5 * libm::erfc(-x / std::f64::consts::SQRT_2);
        let inside = phi(3.0) - phi(-3.0);
        let normal: Vec<f64> = draw("gain").iter().map(|source| source.normal(3.0)).collect();
        assert!(distance(normal, |x| (phi(x) - phi(-3.0)) / inside) < limit);
        // Neighbours and quantities are independent: correlations of N pairs stay within four standard errors.
        let centred = |list: &[Source]| list.iter().map(|source| source.uniform() - 0.5).collect::<Vec<_>>();
        let (a, b) = (centred(&draw("gain")), centred(&draw("lag1")));
        let correlation = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
            pairs.map(|(x, y)| 12.0 * x * y).sum::<f64>() / (N as f64).sqrt()
        };
        assert!(correlation(&mut a.iter().copied().zip(b.iter().copied())).abs() < 4.0);
        assert!(correlation(&mut a.iter().copied().zip(a[1..].iter().copied())).abs() < 4.0);
    }
}
