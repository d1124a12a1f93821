//! Hold equivalent as a ratio of expanded polynomials, `G_d = z^-(N+1) B(z^-1)/A(z^-1)`.
//!
//! `A = prod(1 - q_i z^-1)` comes from the poles, `B` from the product of `A` and the pulse response of the
//! state space, which ends after order + 1 taps. `B(1)` is not summed but known: `G_d` and the plant have the
//! same gain (velocity gain, ...) at `z = 1`, so `B(1) = gain ts^k prod(1 - q_i)` over the poles other than
//! the k integrators.

use super::complex::{self, Complex};
use super::state_space::PlantFactors;

/// Polynomials in `z^-1` of a sampled plant, coefficients from `z^0` on.
#[derive(Clone, Debug, PartialEq)]
pub struct HoldPolynomials {
    /// Denominator, `a[0] = 1`.
    pub a: Vec<f64>,
    /// Numerator behind the dead time, order + 1 taps; the last is 0 for a whole number of dead samples.
    pub b: Vec<f64>,
    /// `B(1)`.
    pub numerator_sum: f64,
    /// Whole samples N of the dead time.
    pub dead_steps: usize,
}

/// Product of two polynomials.
pub fn multiply(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; p.len() + q.len() - 1];
    for (i, &x) in p.iter().enumerate() {
        for (j, &y) in q.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

/// Value of a polynomial in `z^-1` at `z`.
pub fn evaluate(p: &[f64], z: Complex) -> Complex {
    let backward = complex::div((1.0, 0.0), z);
    p.iter().rev().fold((0.0, 0.0), |sum, &v| complex::add(complex::mul(sum, backward), (v, 0.0)))
}

/// Factor of A and of `A(1)` for the pole pair of `1 + a1 s + a2 s^2`.
fn pair_factor(a1: f64, a2: f64, ts: f64) -> (Vec<f64>, f64) {
    let discriminant = 0.25 * a1 * a1 - a2;
    let decay = 0.5 * a1 / a2 * ts;
    let spread = discriminant.abs().sqrt() / a2 * ts;
    if discriminant >= 0.0 {
        let (slow, fast) = (spread - decay, -spread - decay);
        let factor = multiply(&[1.0, -slow.exp()], &[1.0, -fast.exp()]);
        (factor, slow.exp_m1() * fast.exp_m1())
    } else {
        let radius = (-decay).exp();
        let half = (0.5 * spread).sin();
        let at_one = (-decay).exp_m1().powi(2) + 4.0 * radius * half * half;
        (vec![1.0, -2.0 * radius * spread.cos(), radius * radius], at_one)
    }
}

impl HoldPolynomials {
    /// Polynomials of any plant; the expanded forms are good to about `1e-16 (tau/ts)^order` near `z = 1`, so
    /// this is meant for low orders.
    pub fn new(plant: &PlantFactors<'_>, ts: f64) -> Self {
        let mut a = vec![1.0];
        let mut numerator_sum = plant.gain * ts.powi(plant.integrators as i32);
        for _ in 0..plant.integrators {
            a = multiply(&a, &[1.0, -1.0]);
        }
        for &tau in plant.lags {
            a = multiply(&a, &[1.0, -(-ts / tau).exp()]);
            numerator_sum *= -(-ts / tau).exp_m1();
        }
        for &(a1, a2) in plant.pairs {
            let (factor, at_one) = pair_factor(a1, a2, ts);
            a = multiply(&a, &factor);
            numerator_sum *= at_one;
        }
        let sampled = plant.sampled(ts);
        let mut b = multiply(&a, &sampled.pulse_response(plant.order() + 1));
        b.truncate(plant.order() + 1);
        Self { a, b, numerator_sum, dead_steps: sampled.dead_steps() }
    }

    /// `gain e^{-s dead_time}/(1 + tau s)` in closed form: with the fraction f of a sample in the dead time,
    /// `b0 = gain (1 - e^{-(1-f) ts/tau})`, `b1 = gain (e^{-(1-f) ts/tau} - e^{-ts/tau})`.
    pub fn first_order(gain: f64, tau: f64, dead_time: f64, ts: f64) -> Self {
        let samples = dead_time / ts;
        let whole = samples.round();
        let steps =
            if (samples - whole).abs() <= 4.0 * f64::EPSILON * samples { whole } else { samples.floor() };
        let fraction = (samples - steps).max(0.0);
        let rest = -(1.0 - fraction) * ts / tau;
        let b = vec![-gain * rest.exp_m1(), -gain * rest.exp() * (-fraction * ts / tau).exp_m1()];
        let a = vec![1.0, -(-ts / tau).exp()];
        Self { a, b, numerator_sum: -gain * (-ts / tau).exp_m1(), dead_steps: steps as usize }
    }

    /// `G_d` at `z`.
    pub fn response(&self, z: Complex) -> Complex {
        let delay = complex::pow(complex::div((1.0, 0.0), z), self.dead_steps + 1);
        complex::div(complex::mul(delay, evaluate(&self.b, z)), evaluate(&self.a, z))
    }
}

#[cfg(test)]
mod tests {
    use super::super::golden;
    use super::*;

    /// Error of the taps relative to the largest one; measured: 1.7e-15 up to order 3, 2.2e-12 up to order 8.
    #[test]
    fn taps_meet_the_table() {
        for plant in golden::plants() {
            let polynomials = HoldPolynomials::new(&plant.factors(), plant.ts);
            assert_eq!(polynomials.dead_steps, plant.steps);
            assert!((polynomials.numerator_sum / plant.numerator_sum - 1.0).abs() < 2e-15, "{}", plant.name);
            let largest = plant.taps.iter().fold(0.0_f64, |m, tap| m.max(tap.abs()));
            let allowed = if plant.factors().order() <= 3 { 5e-15 } else { 1e-11 } * largest;
            for (&b, &tap) in polynomials.b.iter().zip(&plant.taps) {
                assert!((b / plant.numerator_sum - tap).abs() <= allowed, "{}: {b}, {tap}", plant.name);
            }
        }
    }

    #[test]
    fn first_order_in_closed_form() {
        for (dead_time, ts) in [(5.0, 0.5), (5.0, 0.37), (0.0, 2.0), (90.0, 1.8), (0.01, 1.0)] {
            let plant = PlantFactors { gain: -1.98, lags: &[80.3], dead_time, ..PlantFactors::UNITY };
            let (general, closed) =
                (HoldPolynomials::new(&plant, ts), HoldPolynomials::first_order(-1.98, 80.3, dead_time, ts));
            assert_eq!(general.dead_steps, closed.dead_steps);
            assert!((general.numerator_sum / closed.numerator_sum - 1.0).abs() < 1e-15);
            for (x, y) in general.b.iter().zip(&closed.b).chain(general.a.iter().zip(&closed.a)) {
                assert!((x - y).abs() <= 1e-15 * y.abs().max(closed.numerator_sum.abs()), "{x} {y}");
            }
        }
    }

    #[test]
    fn ratio_of_polynomials_is_the_state_space() {
        let plant = PlantFactors {
            integrators: 1,
            lags: &[2.0],
            pairs: &[(0.8, 1.0)],
            zeros: &[(-0.6, 0.0)],
            dead_time: 0.33,
            ..PlantFactors::UNITY
        };
        let (polynomials, sampled) = (HoldPolynomials::new(&plant, 0.2), plant.sampled(0.2));
        for phase in [0.3, 1.0, 2.0, 3.1] {
            let exact = sampled.frequency_response(phase);
            let error = complex::abs(complex::sub(polynomials.response(complex::unit(phase)), exact));
            assert!(error < 1e-12 * complex::abs(exact), "{phase}: {error:e}");
        }
    }
}
