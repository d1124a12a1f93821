//! A frequency sweep from the plant's state space and the law's own answer to a pulse.

use crate::cases::Case;
use controller_core::{ControllerInput, Real};
use controller_tests::oracle::complex::{self, Complex};
use controller_tests::oracle::sampled_plant::SampledPlant;
use controller_tests::oracle::state_space::StateSpace;
use core::f64::consts::PI;

/// The responses of a loop at ascending angles up to pi.
pub(crate) struct Sweep {
    angles: Vec<f64>,
    pub(crate) open: Vec<Complex>,
    /// `-K`, from `y` to `u`.
    law: Vec<Complex>,
}

impl Sweep {
    pub(crate) fn of<T: Real>(case: &Case) -> Self {
        const POINTS: u32 = 3000;
        let system = StateSpace::new(&case.plant);
        let plant = SampledPlant::new(&system, case.ts, case.plant.dead_time + case.latency);
        let pulse = Pulse::of::<T>(case);
        // Four decades, 0.3 % apart: the loops cross over within them.
        let angle = |k: u32| PI * libm::pow(10.0, -4.0 * (1.0 - f64::from(k) / f64::from(POINTS)));
        let angles: Vec<f64> = (0..=POINTS).map(angle).collect();
        let law: Vec<Complex> = angles.iter().map(|&theta| pulse.at(theta)).collect();
        let open = angles
            .iter()
            .zip(&law)
            .map(|(&theta, &k)| complex::mul(plant.frequency_response(theta), k))
            .collect();
        Self { angles, open, law }
    }

    pub(crate) fn one_plus(&self, i: usize) -> Complex {
        complex::add((1.0, 0.0), self.open[i])
    }

    /// The largest of a value of every point, by a parabola through its neighbours.
    pub(crate) fn peak(&self, value: impl Fn(usize) -> f64) -> f64 {
        let values: Vec<f64> = (0..self.angles.len()).map(value).collect();
        let top = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).expect("points");
        if top == 0 || top + 1 == values.len() {
            return values[top];
        }
        let (a, b, c) = (values[top - 1], values[top], values[top + 1]);
        let bend = a - 2.0 * b + c;
        if bend == 0.0 { b } else { b - (a - c) * (a - c) / (8.0 * bend) }
    }

    /// The factors on the gain at which the loop gain passes through -1, with their angles.
    pub(crate) fn factors(&self) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        for i in 1..self.angles.len() {
            let (a, b) = (self.open[i - 1], self.open[i]);
            if (a.1 > 0.0) != (b.1 > 0.0) && a.0 < 0.0 && b.0 < 0.0 {
                let share = a.1 / (a.1 - b.1);
                found.push((-1.0 / (a.0 + share * (b.0 - a.0)), self.angles[i]));
            }
        }
        // At pi the loop gain is real.
        let end = self.open[self.open.len() - 1];
        if end.0 < 0.0 {
            found.push((-1.0 / end.0, PI));
        }
        found
    }

    pub(crate) fn gain_margin(&self) -> (f64, f64) {
        let above = self.factors().into_iter().filter(|(factor, _)| *factor > 1.0);
        above.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, PI))
    }

    /// In degrees.
    pub(crate) fn phase_margin(&self) -> (f64, f64) {
        let mut best = (f64::INFINITY, PI);
        for i in 1..self.angles.len() {
            let (a, b) = (libm::log(complex::abs(self.open[i - 1])), libm::log(complex::abs(self.open[i])));
            if (a > 0.0) != (b > 0.0) {
                let share = a / (a - b);
                let [from, to] = [i - 1, i].map(|i| libm::atan2(-self.open[i].1, -self.open[i].0));
                let phase = (from + share * (to - from)).abs().to_degrees();
                if phase < best.0 {
                    best = (phase, self.angles[i]);
                }
            }
        }
        best
    }

    /// `|u/n|` of the closed loop.
    pub(crate) fn noise(&self, i: usize) -> f64 {
        complex::abs(self.law[i]) / complex::abs(self.one_plus(i))
    }

    /// `|1 - 1/z|`.
    pub(crate) fn increment(&self, i: usize) -> f64 {
        2.0 * libm::sin(0.5 * self.angles[i])
    }

    /// `sqrt(1/pi * integral value^2)`, by trapezoids.
    pub(crate) fn root_mean_square(&self, value: impl Fn(usize) -> f64) -> f64 {
        let square = |i: usize| value(i) * value(i);
        let pieces = (1..self.angles.len())
            .map(|i| 0.5 * (self.angles[i] - self.angles[i - 1]) * (square(i) + square(i - 1)));
        libm::sqrt((self.angles[0] * square(0) + pieces.sum::<f64>()) / PI)
    }

    /// Kao and Lincoln's criterion, with 300 images of the plant on either side.
    pub(crate) fn jitter(&self, case: &Case) -> f64 {
        let gain = self.peak(|i| {
            let size = |k: i32| {
                let omega = (self.angles[i] + 2.0 * PI * f64::from(k)) / case.ts;
                let value = complex::abs(case.plant.response(omega));
                value * value
            };
            self.increment(i) * self.noise(i) * libm::sqrt((-300..=300).map(size).sum::<f64>())
        });
        // J by its definition, in thousandths of a sample, until the product of the gains is 1.
        let loss = |j: f64| {
            let (whole, part) = (j.floor(), j - j.floor());
            libm::sqrt(whole * whole + 2.0 * whole * part + part)
        };
        let (mut low, mut high) = (0.0, 1e6);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if loss(middle) * gain < 1.0 { low = middle } else { high = middle }
        }
        low * case.ts
    }
}

/// The answer of a law to a unit pulse of the measurement: what decays, and the straight line that remains.
struct Pulse {
    decays: Vec<f64>,
    level: f64,
    slope: f64,
}

impl Pulse {
    fn of<T: Real>(case: &Case) -> Self {
        const LENGTH: usize = 8000;
        let mut law = case.law::<T>();
        let answer: Vec<f64> = (0..LENGTH)
            .map(|k| {
                let y = if k == 0 { T::from_f64(1.0) } else { T::ZERO };
                let input = ControllerInput { y, ..ControllerInput::default() };
                -law.step(&input).u.to_f64()
            })
            .collect();
        let (middle, last) = (LENGTH / 2, LENGTH - 1);
        let slope = (answer[last] - answer[middle]) / (last - middle) as f64;
        let level = answer[last] - slope * last as f64;
        let decays: Vec<f64> = answer.iter().enumerate().map(|(k, u)| u - level - slope * k as f64).collect();
        let largest = answer.iter().map(|u| u.abs()).fold(0.0, f64::max);
        let left = decays[LENGTH * 3 / 4..].iter().map(|d| d.abs()).fold(0.0, f64::max);
        assert!(left <= 1e-5 * largest, "{}: {left:e} of {largest:e} has not decayed", case.name);
        Self { decays, level, slope }
    }

    /// Its response at `z = exp(j*theta)`: the sum of what decays, and the line in closed form.
    fn at(&self, theta: f64) -> Complex {
        let back = complex::unit(-theta);
        let (mut power, mut sum) = ((1.0, 0.0), (0.0, 0.0));
        for (k, &d) in self.decays.iter().enumerate() {
            if k % 256 == 0 {
                power = complex::unit(-theta * k as f64);
            }
            sum = complex::add(sum, complex::scale(d, power));
            power = complex::mul(power, back);
        }
        // 1 - 1/z, without the difference.
        let one_minus = complex::scale(-1.0, complex::unit_minus_one(-theta));
        let step = complex::div((1.0, 0.0), one_minus);
        let ramp = complex::div(complex::mul(back, step), one_minus);
        complex::add(sum, complex::add(complex::scale(self.level, step), complex::scale(self.slope, ramp)))
    }
}
