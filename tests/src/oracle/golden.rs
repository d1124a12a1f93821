//! Reader of `golden/zoh_taps.csv`: hold equivalents of sixty plants from 150-digit arithmetic.
//!
//! The generator `golden/make_golden.py` stands beside the file and says how it was computed and checked.

use super::complex::Complex;
use super::state_space::PlantFactors;

/// Frequencies of the tabulated responses \[rad/sample\].
pub const PHASES: [f64; 5] = [0.01, 0.1, 0.5, 1.0, 3.0];

const TABLE: &str = include_str!("../../golden/zoh_taps.csv");

/// One plant with its hold equivalent `G_d = z^-(steps+1) B(z^-1)/A(z^-1)`, `A = prod(1 - q_i z^-1)`.
#[derive(Clone, Debug)]
pub struct GoldenPlant {
    /// Name of the row.
    pub name: &'static str,
    /// Gain of the normalised factors.
    pub gain: f64,
    /// Number of factors `1/s`.
    pub integrators: usize,
    /// First-order denominator factors `tau` \[s\].
    pub lags: Vec<f64>,
    /// Second-order denominator factors `(a1, a2)` in \[s\], \[s^2\].
    pub pairs: Vec<(f64, f64)>,
    /// Numerator factors `(z1, z2)` in \[s\], \[s^2\].
    pub zeros: Vec<(f64, f64)>,
    /// Dead time \[s\].
    pub dead_time: f64,
    /// Sampling time \[s\].
    pub ts: f64,
    /// Whole samples of the dead time.
    pub steps: usize,
    /// `B(1) = gain ts^integrators prod(1 - q_i)`.
    pub numerator_sum: f64,
    /// Normalised taps `b_j / B(1)`, order + 1 of them; the last is 0 for a whole number of dead samples.
    pub taps: Vec<f64>,
    /// `G_d(e^{j phase})` at [`PHASES`].
    pub responses: Vec<Complex>,
}

impl GoldenPlant {
    /// The plant as the factors the other oracles take.
    pub fn factors(&self) -> PlantFactors<'_> {
        PlantFactors {
            gain: self.gain,
            integrators: self.integrators,
            lags: &self.lags,
            pairs: &self.pairs,
            zeros: &self.zeros,
            dead_time: self.dead_time,
        }
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("not a number: {text:?}"))
}

fn pair(text: &str) -> (f64, f64) {
    let (first, second) = text.split_once(':').expect("two numbers with a colon between");
    (number(first), number(second))
}

fn list<T>(text: &str, item: impl Fn(&str) -> T) -> Vec<T> {
    if text.is_empty() { vec![] } else { text.split(';').map(item).collect() }
}

fn parse(line: &'static str) -> GoldenPlant {
    let mut fields = line.split(',');
    let mut next = || fields.next().expect("a field for every column");
    let (name, gain, integrators) = (next(), number(next()), number(next()) as usize);
    let poles = list(next(), pair);
    let (real, complex): (Vec<_>, Vec<_>) = poles.into_iter().partition(|&(_, a2)| a2 == 0.0);
    GoldenPlant {
        name,
        gain,
        integrators,
        lags: real.into_iter().map(|(tau, _)| tau).collect(),
        pairs: complex,
        zeros: list(next(), pair),
        dead_time: number(next()),
        ts: number(next()),
        steps: number(next()) as usize,
        numerator_sum: number(next()),
        taps: list(next(), number),
        responses: PHASES.iter().map(|_| pair(next())).collect(),
    }
}

/// All plants of the table, in its order.
pub fn plants() -> Vec<GoldenPlant> {
    TABLE.lines().filter(|line| line.starts_with('p')).map(parse).collect()
}

#[cfg(test)]
mod tests {
    use super::super::complex;
    use super::*;

    #[test]
    fn the_table_is_complete_and_consistent() {
        let plants = plants();
        assert_eq!(plants.len(), 60);
        for order in 1..=8 {
            assert!(plants.iter().any(|plant| plant.factors().order() == order));
        }
        for plant in &plants {
            let order = plant.factors().order();
            assert_eq!(plant.taps.len(), order + 1, "{}", plant.name);
            let largest = plant.taps.iter().fold(0.0_f64, |m, tap| m.max(tap.abs()));
            let sum: f64 = plant.taps.iter().sum();
            assert!((sum - 1.0).abs() <= 1e-15 * largest * order as f64 + 1e-15, "{}: {sum}", plant.name);
        }
    }

    /// Relative error of the double-precision state space over all rows and phases; measured: 6.4e-15 for
    /// orders 1 to 4, 5.9e-15 for orders 5 to 8, with time constants of 1 to 10^4 samples.
    #[test]
    fn state_space_meets_the_table() {
        let mut worst = [0.0_f64; 2];
        for plant in plants() {
            let sampled = plant.factors().sampled(plant.ts);
            assert_eq!(sampled.dead_steps(), plant.steps, "{}", plant.name);
            for (&phase, &exact) in PHASES.iter().zip(&plant.responses) {
                let difference = complex::sub(sampled.frequency_response(phase), exact);
                let error = complex::abs(difference) / complex::abs(exact);
                let group = &mut worst[usize::from(sampled.order() > 4)];
                *group = group.max(error);
                let general = complex::sub(sampled.response(complex::unit(phase)), exact);
                // The rounding of z is seen in z - 1 and, at the worst, in each of the poles near it.
                let allowed = 1e-13 + 4e-16 * sampled.order() as f64 / phase;
                assert!(complex::abs(general) <= allowed * complex::abs(exact), "{}", plant.name);
            }
        }
        assert!(worst[0] < 2e-14 && worst[1] < 2e-14, "orders to 4 and to 8: {worst:?}");
    }
}
