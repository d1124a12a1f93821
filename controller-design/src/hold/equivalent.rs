//! The zero-order-hold equivalent, evaluated on the unit circle.

use std::vec;
use std::vec::Vec;

use super::chain::{Chain, exp_minus_one};
use super::numerator::weights;
use crate::Refusal;
use crate::model::{Complex, TransferFunction};

/// Longest dead time and latency together, in samples.
pub const MAX_DELAY: f64 = 1e7;

/// Shortest and longest sampling period \[s\], as for the laws of `controller_core`.
const TS_RANGE: (f64, f64) = (1e-9, 1e9);

/// How near to a whole number of samples a delay counts as whole: the quotient of two rounded numbers must not make a
/// fraction.
const WHOLE: f64 = 1e-9;

/// The zero-order-hold equivalent `G_d(z)` of a plant with dead time and latency, as a frequency response.
///
/// The plant is a chain of first-order elements (complex ones for complex poles), its exponential is computed entry by
/// entry with small relative error, and `z*x = Phi*x + Gamma` is solved by substitution at each frequency: for chains of
/// equal lags a relative error of some `1e-14` from `ts/tau = 1e-6` to 50. A plant that nearly cancels its own zeros
/// and poles of very different size loses digits accordingly.
///
/// A plant that is not strictly proper passes `u[k-1]` on, as a measurement just before the output changes does.
///
/// Cost: `new` some 10 us to 1 ms by order; [`at`](Self::at) about `order^2/2` complex multiplications.
/// Source: textbook (hold equivalent with fractional delay); the formulation is our own.
///
/// ```
/// use controller_design::hold::HoldEquivalent;
/// use controller_design::model::{Complex, parse};
/// // exp(-0.5 s)/s sampled every second: (0.5 + 0.5 z^-1) z^-1/(1 - z^-1), at z = j.
/// let plant = parse("exp(-0.5*s)/s").expect("a plant");
/// let held = HoldEquivalent::new(&plant, 1.0, 0.0).expect("in range");
/// let j = Complex::new(0.0, 1.0);
/// let expected = (Complex::real(0.5) + Complex::real(0.5) / j) / (j - Complex::ONE);
/// let value = held.at(core::f64::consts::FRAC_PI_2);
/// assert!((value - expected).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HoldEquivalent {
    ts: f64,
    /// Poles of the plant times `ts`, fast before slow, integrators last.
    poles: Vec<Complex>,
    /// `exp(a) - 1` of each.
    falls: Vec<Complex>,
    /// Row `i` of `Phi` without its diagonal.
    coupling: Vec<Vec<Complex>>,
    /// What the output that arrives within the period does to the states by its end.
    arrived: Vec<Complex>,
    /// What the output before it does.
    before: Vec<Complex>,
    weights: Vec<Complex>,
    feedthrough: f64,
    /// Whole samples of delay behind the one that every sampled loop has.
    delay: usize,
}

impl HoldEquivalent {
    /// The hold equivalent of `plant` for the sampling period `ts` \[s\] and `latency` \[s\] from reading `y` to acting
    /// `u`, which adds to the plant's dead time.
    ///
    /// # Errors
    /// `ts` outside 1e-9 to 1e9 s, a negative latency, a delay of more than [`MAX_DELAY`] samples, numbers too large
    /// or too small for double precision on the way.
    pub fn new(plant: &TransferFunction, ts: f64, latency: f64) -> Result<Self, Refusal> {
        let range = |parameter, value: f64, min: f64, max: f64| {
            if value >= min && value <= max {
                Ok(())
            } else {
                Err(Refusal::OutOfRange { parameter, value, min, max })
            }
        };
        range("ts", ts, TS_RANGE.0, TS_RANGE.1)?;
        range("latency", latency, 0.0, MAX_DELAY * ts)?;
        range("dead_time", plant.dead_time(), 0.0, MAX_DELAY * ts)?;

        let mut poles: Vec<Complex> = plant.poles().iter().map(|&p| p * ts).collect();
        // The slowest last: zeros are divided by them first, and a slow zero belongs to a slow pole.
        poles.sort_by(|p, q| q.abs().total_cmp(&p.abs()));
        let (weights, feedthrough) = weights(plant, ts, &poles);

        let (delay, fraction) = whole_and_fraction(plant.dead_time(), latency, ts);
        let mut all = vec![Complex::ZERO];
        all.extend(&poles);
        let chain = Chain { poles: all };
        let whole = chain.exp(1.0);
        let states = 1..=poles.len();
        let input = |row: &[Complex]| row.first().copied().unwrap_or_default();
        let (arrived, before) = if fraction == 0.0 {
            (states.clone().map(|i| input(whole.row(i))).collect(), vec![Complex::ZERO; poles.len()])
        } else {
            let (early, late) = (chain.exp(fraction), chain.exp(1.0 - fraction));
            let carried = |i: usize| {
                let reached = late.row(i).iter().enumerate().skip(1);
                reached.fold(Complex::ZERO, |sum, (j, &x)| sum + x * input(early.row(j)))
            };
            let arrived = states.clone().map(|i| input(late.row(i))).collect();
            (arrived, states.clone().map(carried).collect::<Vec<_>>())
        };
        let coupling: Vec<Vec<Complex>> =
            states.map(|i| whole.row(i).get(1..i).unwrap_or_default().to_vec()).collect();
        let held = Self {
            ts,
            falls: poles.iter().map(|&a| exp_minus_one(a)).collect(),
            poles,
            coupling,
            arrived,
            before,
            weights,
            feedthrough,
            delay,
        };
        let numbers = held.arrived.iter().chain(&held.before).chain(&held.weights).chain(&held.falls);
        if whole.is_finite() && numbers.chain(&held.poles).all(|x| x.is_finite()) && feedthrough.is_finite() {
            Ok(held)
        } else {
            Err(Refusal::Plant {
                must: "be within the range of numbers at this sampling period",
                help: "choose a sampling period nearer to the plant's time constants, or units in which they are nearer to 1",
            })
        }
    }

    /// `G_d(exp(j*theta))`, `theta = w*ts` in rad, above 0 and up to pi (the Nyquist frequency).
    #[must_use]
    pub fn at(&self, theta: f64) -> Complex {
        let z_minus_one = minus_one(theta);
        let back = Complex::new(0.0, -theta).exp();
        let mut states: Vec<Complex> = Vec::with_capacity(self.poles.len());
        let mut y = back * self.feedthrough;
        let inputs = self.arrived.iter().zip(&self.before);
        let rows = self.coupling.iter().zip(&self.falls).zip(&self.weights);
        for ((&arrived, &before), ((row, &fall), &weight)) in inputs.zip(rows) {
            let driven = row.iter().zip(&states).fold(arrived + before * back, |sum, (&p, &x)| sum + p * x);
            let x = driven / (z_minus_one - fall);
            y = y + weight * x;
            states.push(x);
        }
        if self.delay == 0 { y } else { y * delay_by(theta, self.delay) }
    }

    /// The sampling period \[s\].
    #[must_use]
    pub fn ts(&self) -> f64 {
        self.ts
    }

    /// Whole samples of dead time and latency, behind the one sample that every sampled loop has.
    #[must_use]
    pub fn delay(&self) -> usize {
        self.delay
    }

    /// `exp(p*ts) - 1` of the plant's poles `p`.
    pub(crate) fn falls(&self) -> &[Complex] {
        &self.falls
    }

    /// The plant's poles times `ts`: the poles of `G_d` are `exp` of these, those of the delay at 0.
    #[must_use]
    pub fn scaled_poles(&self) -> &[Complex] {
        &self.poles
    }
}

/// `exp(j*theta) - 1` without cancellation.
pub(crate) fn minus_one(theta: f64) -> Complex {
    let half = 0.5 * theta;
    let chord = 2.0 * libm::sin(half);
    Complex::new(-chord * libm::sin(half), chord * libm::cos(half))
}

/// The delay as whole samples and a fraction of one, the fraction exact even for many samples.
fn whole_and_fraction(dead_time: f64, latency: f64, ts: f64) -> (usize, f64) {
    let samples = (dead_time + latency) / ts;
    let nearest = libm::round(samples);
    let fraction_from = |whole: f64| (libm::fma(-whole, ts, dead_time) + latency) / ts;
    let near = fraction_from(nearest).abs() < WHOLE;
    let whole = if near { nearest } else { libm::floor(samples) };
    let fraction = if near { 0.0 } else { fraction_from(whole).clamp(0.0, 1.0) };
    // At most 2*MAX_DELAY, and not negative.
    (whole as usize, fraction)
}

/// `exp(-j*theta*n)`, the product kept exact: a long delay turns the phase many times.
pub(crate) fn delay_by(theta: f64, n: usize) -> Complex {
    let n = n as f64;
    let angle = theta * n;
    let rest = libm::fma(theta, n, -angle);
    Complex::new(0.0, -angle).exp() * Complex::new(0.0, -rest).exp()
}
