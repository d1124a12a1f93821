//! Exact zero-order-hold equivalent of a linear plant with a dead time of any length.
//!
//! With the dead time `delay = (steps + f) ts`, `0 <= f < 1`, the input that acts at the plant over
//! `[k ts, (k+1) ts)` is `u[k-steps-1]` for the first `f ts` and `u[k-steps]` for the rest. Hence
//!
//! `x[k+1] = x[k] + E x[k] + early u[k-steps-1] + late u[k-steps]`, `y[k] = c x[k]`,
//!
//! with `E = e^{a ts} - I`, `late = int_0^{(1-f) ts} e^{a t} dt b` and
//! `early = e^{a (1-f) ts} int_0^{f ts} e^{a t} dt b`. All of it is positive for a chain of lags: nothing
//! cancels.

use super::complex::{self, Complex};
use super::expm::{Matrix, apply, dot, exp_m1, solve, solve_complex, zeros};
use super::state_space::StateSpace;

/// A plant sampled with a zero-order hold at its input.
#[derive(Clone, Debug)]
pub struct SampledPlant {
    /// Sampling time \[s\].
    ts: f64,
    /// State increment over a sample for no input, `e^{a ts} - I`.
    increment: Matrix,
    /// Effect of `u[k-steps-1]` on `x[k+1]`.
    early: Vec<f64>,
    /// Effect of `u[k-steps]` on `x[k+1]`.
    late: Vec<f64>,
    /// Output row.
    c: Vec<f64>,
    /// State at the sample instant.
    x: Vec<f64>,
    /// Past inputs, `line[(position + i) % len]` being `u[k-len+i]`.
    line: Vec<f64>,
    /// Oldest cell of the line.
    position: usize,
    /// Whole samples of the dead time.
    steps: usize,
}

/// `e^{a t} - I` and `int_0^t e^{a s} ds b` in one exponential of the matrix with the input as a constant
/// state.
fn hold_over(system: &StateSpace, time: f64) -> (Matrix, Vec<f64>) {
    let n = system.b.len();
    let mut augmented = zeros(n + 1, n + 1);
    for i in 0..n {
        for j in 0..n {
            augmented[i][j] = system.a[i][j] * time;
        }
        augmented[i][n] = system.b[i] * time;
    }
    let e = exp_m1(&augmented);
    ((0..n).map(|i| e[i][..n].to_vec()).collect(), (0..n).map(|i| e[i][n]).collect())
}

impl SampledPlant {
    /// Samples `system` at `ts` \[s\] behind a dead time `delay` \[s\]. A delay that is a whole number of
    /// samples but for the rounding of `delay / ts` is taken as whole.
    pub fn new(system: &StateSpace, ts: f64, delay: f64) -> Self {
        assert!(ts > 0.0 && delay >= 0.0, "ts = {ts}, delay = {delay}");
        let samples = delay / ts;
        let whole = samples.round();
        let is_whole = (samples - whole).abs() <= 4.0 * f64::EPSILON * samples;
        let steps = if is_whole { whole } else { samples.floor() };
        let fraction = if is_whole { 0.0 } else { samples - steps };

        let (increment, _) = hold_over(system, ts);
        let (transition, late) = hold_over(system, (1.0 - fraction) * ts);
        let (_, entered) = hold_over(system, fraction * ts);
        let early = apply(&transition, &entered).iter().zip(&entered).map(|(e, x)| e + x).collect();
        let steps = steps as usize;
        let x = vec![0.0; system.b.len()];
        Self {
            ts,
            increment,
            early,
            late,
            c: system.c.clone(),
            x,
            line: vec![0.0; steps + 1],
            position: 0,
            steps,
        }
    }

    /// Sampling time \[s\].
    pub fn ts(&self) -> f64 {
        self.ts
    }

    /// Whole samples `N` of the dead time; the pulse response starts at the sample `N + 1`.
    pub fn dead_steps(&self) -> usize {
        self.steps
    }

    /// Number of states without the line.
    pub fn order(&self) -> usize {
        self.x.len()
    }

    /// `e^{a ts} - I`, whose eigenvalues are `q_i - 1`.
    pub fn increment(&self) -> &Matrix {
        &self.increment
    }

    /// Output `y[k]` at the present sample instant. It does not depend on `u[k]`: the plant is strictly
    /// proper.
    pub fn output(&self) -> f64 {
        dot(&self.c, &self.x)
    }

    /// Gives `y[k]`, the output at the sample instant `k` **before** `u[k]` acts, then holds `u[k] + d[k]` at
    /// the input over `[k ts, (k+1) ts)` and moves on to the sample instant `k + 1`.
    ///
    /// `d` is a disturbance at the plant input, before the dead time. Both are in units of u.
    pub fn step(&mut self, u: f64, d: f64) -> f64 {
        let y = self.output();
        let newest = u + d;
        let cells = self.line.len();
        let oldest = self.line[self.position];
        let late_input = if self.steps == 0 { newest } else { self.line[(self.position + 1) % cells] };
        let free = apply(&self.increment, &self.x);
        for (i, x) in self.x.iter_mut().enumerate() {
            *x += free[i] + self.early[i] * oldest + self.late[i] * late_input;
        }
        self.line[self.position] = newest;
        self.position = (self.position + 1) % cells;
        y
    }

    /// Puts the plant, line included, at rest for the constant input `u0`. Panics for an integrating plant,
    /// whose rest depends on more than the input.
    pub fn settle(&mut self, u0: f64) {
        let forcing: Vec<f64> = self.early.iter().zip(&self.late).map(|(e, l)| -(e + l) * u0).collect();
        self.x =
            solve(&self.increment, &forcing).expect("an integrating plant has no rest for a given input");
        self.line.fill(u0);
    }

    /// Frequency response of the sampled plant at `phase = omega ts` \[rad/sample\], exact to rounding also
    /// for small phases: `c ((z-1) I - E)^-1 (late + early z^-1) z^-steps`, `z = e^{j phase}`.
    pub fn frequency_response(&self, phase: f64) -> Complex {
        let delay = complex::unit(-phase * self.steps as f64);
        self.evaluate(complex::unit_minus_one(phase), complex::unit(-phase), delay)
    }

    /// Transfer function of the sampled plant at any point `z` that is not a pole. Near `z = 1` prefer
    /// [`SampledPlant::frequency_response`]: the rounding of `z` itself is then visible in `z - 1`.
    pub fn response(&self, z: Complex) -> Complex {
        let backward = complex::div((1.0, 0.0), z);
        self.evaluate((z.0 - 1.0, z.1), backward, complex::pow(backward, self.steps))
    }

    /// Pulse response: the outputs at the samples `N + 1, N + 2, ...` after a unit pulse `u[0] = 1`, from
    /// rest.
    pub fn pulse_response(&self, samples: usize) -> Vec<f64> {
        let mut plant = self.clone();
        plant.x.fill(0.0);
        plant.line.fill(0.0);
        for k in 0..=self.steps {
            plant.step(if k == 0 { 1.0 } else { 0.0 }, 0.0);
        }
        (0..samples).map(|_| plant.step(0.0, 0.0)).collect()
    }

    fn evaluate(&self, z_minus_one: Complex, backward: Complex, delay: Complex) -> Complex {
        let n = self.x.len();
        let entry = |i: usize, j: usize| {
            let diagonal = if i == j { z_minus_one } else { (0.0, 0.0) };
            (diagonal.0 - self.increment[i][j], diagonal.1)
        };
        let matrix = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        let forcing = (0..n)
            .map(|i| complex::add((self.late[i], 0.0), complex::scale(self.early[i], backward)))
            .collect();
        let states = solve_complex(matrix, forcing).expect("the point is not a pole");
        let sum = states
            .iter()
            .zip(&self.c)
            .fold((0.0, 0.0), |sum, (&x, &c)| complex::add(sum, complex::scale(c, x)));
        complex::mul(sum, delay)
    }
}

#[cfg(test)]
mod tests {
    use super::super::state_space::PlantFactors;
    use super::*;

    const LAG: PlantFactors<'static> = PlantFactors { gain: 2.0, lags: &[10.0], ..PlantFactors::UNITY };

    /// Step response of `2 e^{-s T}/(1 + 10 s)` at the time `t`.
    fn lag_step(t: f64, dead_time: f64) -> f64 {
        -2.0 * (-(t - dead_time).max(0.0) / 10.0).exp_m1()
    }

    #[test]
    fn first_order_step_response_at_the_samples() {
        for dead_time in [0.0, 0.3, 1.0, 2.75, 4.0] {
            let mut plant = PlantFactors { dead_time, ..LAG }.sampled(1.0);
            for k in 0..60 {
                let y = plant.step(0.25, 0.75);
                assert!(
                    (y - lag_step(k as f64, dead_time)).abs() < 1e-14,
                    "dead time {dead_time}, sample {k}"
                );
            }
        }
    }

    #[test]
    fn the_output_precedes_the_input_of_its_sample() {
        let mut plant = LAG.sampled(1.0);
        assert_eq!(plant.step(1.0, 0.0), 0.0);
        assert_eq!(plant.dead_steps(), 0);
        assert!(plant.output() > 0.19);
    }

    #[test]
    fn integrators_give_powers_of_time() {
        let plant = PlantFactors { gain: 3.0, integrators: 2, ..PlantFactors::UNITY };
        let mut sampled = plant.sampled(0.5);
        for k in 0..50 {
            let t = 0.5 * k as f64;
            let y = sampled.step(1.0, 0.0);
            assert!((y - 1.5 * t * t).abs() <= 1e-13 * (1.0 + y));
        }
    }

    #[test]
    fn finer_sampling_passes_through_the_same_points() {
        let plant = PlantFactors {
            gain: 0.7,
            lags: &[3.0, 0.4],
            pairs: &[(0.6, 1.5)],
            zeros: &[(-0.5, 0.0), (0.3, 0.8)],
            dead_time: 0.37,
            ..PlantFactors::UNITY
        };
        let (mut coarse, mut fine) = (plant.sampled(0.2), plant.sampled(0.02));
        for k in 0..200 {
            let u = ((k * k) as f64 * 0.37).sin();
            assert!((coarse.output() - fine.output()).abs() < 1e-13);
            coarse.step(u, 0.0);
            (0..10).for_each(|_| {
                fine.step(u, 0.0);
            });
        }
    }

    #[test]
    fn transfer_function_is_the_sum_of_the_pulse_response() {
        let plant =
            PlantFactors { pairs: &[(0.5, 1.0)], lags: &[0.3], dead_time: 0.73, ..PlantFactors::UNITY };
        let sampled = plant.sampled(0.25);
        let taps = sampled.pulse_response(800);
        for phase in [0.0, 0.2, 1.0, 3.0] {
            let delayed = |k: usize| complex::unit(-phase * (k + 1 + sampled.dead_steps()) as f64);
            let sum = (0..taps.len())
                .fold((0.0, 0.0), |sum, k| complex::add(sum, complex::scale(taps[k], delayed(k))));
            for value in [sampled.frequency_response(phase), sampled.response(complex::unit(phase))] {
                assert!(complex::abs(complex::sub(sum, value)) < 1e-13, "phase {phase}");
            }
        }
    }

    #[test]
    fn a_settled_plant_stays() {
        let mut plant = PlantFactors { lags: &[5.0, 0.1], dead_time: 1.3, ..LAG }.sampled(0.2);
        plant.settle(4.0);
        for _ in 0..100 {
            assert!((plant.step(3.0, 1.0) - 8.0).abs() < 1e-13);
        }
    }
}
