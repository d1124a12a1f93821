//! PI with disturbance observer, the discrete-exact pair as plain recursions in direct form.
//!
//! With the hold equivalent `G_d = z^-(N+1) B/A` and a filter F of unit static gain,
//!
//! - `C_u = g z^-(N+1) B/B(1) F`, fed with the applied output
//! - `C_y = -g A/B(1) F`, fed with the measured output
//! - `F = ((1-p)/(1-p z^-1))^d ((1+z^-1)/2)^e prod((1-c_i)/(1-c_i z^-1))`,
//!   `p = e^{-ts/alpha}`, `c_i = e^{-ts/beta_i}`
//!
//! so that `C_u + G_d C_y = 0`. Source: Tena, Penarrocha-Alos and Sanchis (2022), eqs (18), (26) to (28),
//! sampled such that the identity (28) survives. The gain g is 1 for the observer, `K_FD` for a disturbance
//! estimator (`u_f = -d_f`).
//!
//! The expanded A limits the accuracy: at rest `u_f` is good to about `1e-16 (tau/ts)^n y`, n the order of
//! the plant, and the identity to 1e-14, 5e-13, 7e-11 for n = 1, 2, 3 (time constants of 100 samples, phases
//! from 0.003).

use super::complex::{self, Complex};
use super::hold_polynomials::{HoldPolynomials, evaluate, multiply};
use super::sampled_loop::{LoopResponse, UnitStep, run_unit_step};
use super::sampled_plant::SampledPlant;

/// The filter F of the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverFilter<'a> {
    /// Gain g; 1 cancels a constant disturbance completely.
    pub gain: f64,
    /// Time constant alpha \[s\].
    pub alpha: f64,
    /// Number d of lags alpha.
    pub lags: usize,
    /// Number e of averages `(1 + z^-1)/2`.
    pub averages: usize,
    /// Time constants `beta` \[s\] of plant zeros that become lags of the filter.
    pub zero_lags: &'a [f64],
}

/// `u_f = C_u u + C_y y` in direct form with the common denominator of F.
#[derive(Clone, Debug)]
pub struct Observer {
    /// Denominator, leading 1 left out.
    den: Vec<f64>,
    /// Taps on `u[k-1-N], u[k-2-N], ...`.
    u_taps: Vec<f64>,
    /// Taps on `y[k], y[k-1], ...`.
    y_taps: Vec<f64>,
    dead_steps: usize,
    /// Past values, newest first: `u[k-1], ...`, `y[k], ...`, `u_f[k-1], ...`.
    u: Vec<f64>,
    y: Vec<f64>,
    u_f: Vec<f64>,
}

/// Moves `value` in at the front of a history of fixed length.
fn shift_in(history: &mut [f64], value: f64) {
    history.rotate_right(1);
    if let Some(first) = history.first_mut() {
        *first = value;
    }
}

fn weighted(taps: &[f64], history: &[f64]) -> f64 {
    taps.iter().zip(history).map(|(t, v)| t * v).sum()
}

impl Observer {
    /// Observer for the sampled `plant` with the filter `filter` at the sampling time `ts` \[s\], at rest at
    /// zero.
    pub fn new(plant: &HoldPolynomials, filter: ObserverFilter<'_>, ts: f64) -> Self {
        let mut den = vec![1.0];
        let mut num = vec![filter.gain / plant.numerator_sum];
        for &time in std::iter::repeat_n(&filter.alpha, filter.lags).chain(filter.zero_lags) {
            den = multiply(&den, &[1.0, -(-ts / time).exp()]);
            num[0] *= -(-ts / time).exp_m1();
        }
        assert!(den.len() > 1, "the filter needs a lag");
        for _ in 0..filter.averages {
            num = multiply(&num, &[0.5, 0.5]);
        }
        let u_taps = multiply(&plant.b, &num);
        let y_taps: Vec<f64> = multiply(&plant.a, &num).into_iter().map(|v| -v).collect();
        let (u, y) = (vec![0.0; plant.dead_steps + u_taps.len()], vec![0.0; y_taps.len()]);
        let u_f = vec![0.0; den.len() - 1];
        Self { den: den.split_off(1), u_taps, y_taps, dead_steps: plant.dead_steps, u, y, u_f }
    }

    /// `u_f[k]` from `y[k]` and the applied outputs up to `u[k-1]`.
    pub fn step(&mut self, y: f64) -> f64 {
        shift_in(&mut self.y, y);
        let u_f = weighted(&self.u_taps, &self.u[self.dead_steps..]) + weighted(&self.y_taps, &self.y)
            - weighted(&self.den, &self.u_f);
        shift_in(&mut self.u_f, u_f);
        u_f
    }

    /// Takes the applied output `u[k]`, after [`Observer::step`] of the same sample.
    pub fn push(&mut self, applied: f64) {
        shift_in(&mut self.u, applied);
    }

    /// Transfer functions `(C_u, C_y)` at `z`.
    pub fn responses(&self, z: Complex) -> (Complex, Complex) {
        let backward = complex::div((1.0, 0.0), z);
        let den = complex::add((1.0, 0.0), complex::mul(backward, evaluate(&self.den, z)));
        let delay = complex::pow(backward, self.dead_steps + 1);
        let c_u = complex::div(complex::mul(delay, evaluate(&self.u_taps, z)), den);
        (c_u, complex::div(evaluate(&self.y_taps, z), den))
    }

    /// Rest at the constant output `u0` and measurement `y0`: all histories constant.
    pub fn settle(&mut self, u0: f64, y0: f64) {
        self.u.fill(u0);
        self.y.fill(y0);
        let forcing = u0 * self.u_taps.iter().sum::<f64>() + y0 * self.y_taps.iter().sum::<f64>();
        self.u_f.fill(forcing / (1.0 + self.den.iter().sum::<f64>()));
    }
}

/// What happens to the integral I (in units of u) after a sample whose output was limited, `u != v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AntiWindup {
    /// Nothing.
    Off,
    /// `I += min(1, ts/tt) (u - v)` with the time constant `tt` \[s\].
    BackCalculation {
        /// Time constant \[s\].
        tt: f64,
    },
    /// The increment of that sample is taken back if it has the sign of `v - u`.
    Conditional,
}

/// PI controller with limits and an optional observer.
#[derive(Clone, Debug)]
pub struct PiWithObserver {
    kp: f64,
    ki: f64,
    ts: f64,
    limits: (f64, f64),
    anti_windup: AntiWindup,
    observer: Option<Observer>,
    integral: f64,
    /// `KI ts e[k-1]`
    increment: f64,
    /// `u[k-1] - v[k-1]`
    excess: f64,
}

/// Signals of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Output of the PI part.
    pub u_c: f64,
    /// Output of the observer.
    pub u_f: f64,
    /// Controller output before the limits, `u_c + u_f`.
    pub v: f64,
    /// Limited controller output.
    pub u: f64,
}

impl PiWithObserver {
    /// PI with `kp` \[u/y\], `ki` \[u/(y s)\] at `ts` \[s\], output unlimited, at rest at zero.
    pub fn new(kp: f64, ki: f64, observer: Option<Observer>, ts: f64) -> Self {
        let limits = (f64::NEG_INFINITY, f64::INFINITY);
        let anti_windup = AntiWindup::Off;
        Self { kp, ki, ts, limits, anti_windup, observer, integral: 0.0, increment: 0.0, excess: 0.0 }
    }

    /// The same with the output within `limits` (low, high).
    pub fn with_limits(self, limits: (f64, f64), anti_windup: AntiWindup) -> Self {
        Self { limits, anti_windup, ..self }
    }

    /// Rest at the constant output `u0` and measurement `y0 = r0`: the integral carries `u0 - u_f`.
    pub fn settle(&mut self, u0: f64, y0: f64) {
        let u_f = self.observer.as_mut().map_or(0.0, |observer| {
            observer.settle(u0, y0);
            observer.u_f[0]
        });
        (self.integral, self.increment, self.excess) = (u0 - u_f, 0.0, 0.0);
    }

    /// One sample: anti-windup for the sample before, observer, integral by the backward rule, sum, limits.
    pub fn step(&mut self, r: f64, y: f64) -> Sample {
        match self.anti_windup {
            AntiWindup::BackCalculation { tt } => self.integral += (self.ts / tt).min(1.0) * self.excess,
            AntiWindup::Conditional if self.excess * self.increment < 0.0 => self.integral -= self.increment,
            _ => {}
        }
        let u_f = self.observer.as_mut().map_or(0.0, |observer| observer.step(y));
        let error = r - y;
        self.increment = self.ki * self.ts * error;
        self.integral += self.increment;
        let u_c = self.kp * error + self.integral;
        let v = u_c + u_f;
        let u = v.max(self.limits.0).min(self.limits.1);
        self.excess = if u == v { 0.0 } else { u - v };
        if let Some(observer) = &mut self.observer {
            observer.push(u);
        }
        Sample { u_c, u_f, v, u }
    }

    /// Runs the loop from rest over `horizon` \[s\]; see [`run_unit_step`] for the plant's grid.
    pub fn respond(mut self, plant: SampledPlant, step: UnitStep, horizon: f64) -> LoopResponse {
        run_unit_step(self.ts, plant, step, horizon, |r, y| self.step(r, y).u)
    }
}

#[cfg(test)]
mod tests {
    use super::super::dob_cases::{CASES, PLANT_2};
    use super::super::state_space::PlantFactors;
    use super::super::structure_a::{self, PidGains, StructureA};
    use super::super::{de_cases, hold_polynomials};
    use super::*;

    const fn filter(alpha: f64, lags: usize) -> ObserverFilter<'static> {
        ObserverFilter { gain: 1.0, alpha, lags, averages: 0, zero_lags: &[] }
    }

    /// Plants of order 1 to 3 with their filters and sampling times.
    const PLANTS: [(PlantFactors<'static>, ObserverFilter<'static>, f64); 5] = [
        (PLANT_2, filter(10.0, 1), 0.7),
        (
            PlantFactors { integrators: 1, lags: &[0.9], dead_time: 0.1, ..PlantFactors::UNITY },
            filter(0.3, 2),
            0.02,
        ),
        (
            PlantFactors { gain: 4.0, pairs: &[(0.4, 1.0)], zeros: &[(-0.5, 0.0)], ..PlantFactors::UNITY },
            filter(0.2, 2),
            0.05,
        ),
        (
            PlantFactors {
                lags: &[3.0, 1.0, 0.5],
                zeros: &[(2.0, 0.0)],
                dead_time: 0.33,
                ..PlantFactors::UNITY
            },
            ObserverFilter { averages: 1, zero_lags: &[2.0], ..filter(0.3, 2) },
            0.05,
        ),
        (
            PlantFactors { lags: &[1.0, 1.0, 1.0], dead_time: 0.2, ..PlantFactors::UNITY },
            filter(0.1, 3),
            0.01,
        ),
    ];

    /// The plant here is the state space, not the taps the observer is made of. Measured: 1e-14 for order 1,
    /// 5e-13 for order 2, 7e-11 for the three equal lags of 100 samples, whose A is expanded.
    #[test]
    fn the_observer_cancels_the_model_path() {
        for (plant, filter, ts) in PLANTS {
            let observer = Observer::new(&HoldPolynomials::new(&plant, ts), filter, ts);
            let sampled = plant.sampled(ts);
            for phase in [0.003, 0.03, 0.3, 1.0, 3.0] {
                let (c_u, c_y) = observer.responses(complex::unit(phase));
                let residual = complex::add(c_u, complex::mul(sampled.frequency_response(phase), c_y));
                assert!(complex::abs(residual) < 1e-9 * complex::abs(c_u), "{plant:?} at {phase}");
            }
        }
    }

    #[test]
    fn a_perfect_model_leaves_the_reference_response_untouched() {
        for (plant, filter, ts) in PLANTS {
            // Slow enough for all five: an integral action of a hundredth of the fastest time per second.
            let (kp, ki) = (0.05, 0.002);
            let run = |observer| {
                PiWithObserver::new(kp, ki, observer, ts).respond(
                    plant.sampled(ts),
                    UnitStep::Reference,
                    4000.0 * ts,
                )
            };
            let with = run(Some(Observer::new(&HoldPolynomials::new(&plant, ts), filter, ts)));
            let without = run(None);
            let largest = without.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            for (a, b) in with.u.iter().zip(&without.u) {
                assert!((a - b).abs() < 1e-9 * largest, "{plant:?}: {a} {b}");
            }
        }
    }

    #[test]
    fn integral_of_the_error_after_a_load_step() {
        for case in &CASES {
            let ts = case.plant.dead_time / 20.0;
            let run = |observer| {
                let pi = PiWithObserver::new(case.kp, case.ki, observer, ts);
                pi.respond(case.plant.sampled(ts), UnitStep::InputDisturbance, 50.0 / case.ki + 1000.0).ie
            };
            let observer = Observer::new(&HoldPolynomials::new(&case.plant, ts), filter(10.0, 1), ts);
            assert!((run(None) * case.ki + 1.0).abs() < 1e-9);
            assert!(run(Some(observer)).abs() * case.ki < 1e-9);
        }
    }

    #[test]
    fn a_settled_loop_stays() {
        for (plant, filter, ts) in PLANTS.into_iter().filter(|(plant, ..)| plant.integrators == 0) {
            let observer = Observer::new(&HoldPolynomials::new(&plant, ts), filter, ts);
            let mut pi = PiWithObserver::new(0.05, 0.002, Some(observer), ts);
            let mut sampled = plant.sampled(ts);
            // An input bias of 3 beside the controller's 7.
            sampled.settle(10.0);
            let y0 = sampled.output();
            pi.settle(7.0, y0);
            for _ in 0..2000 {
                let y = sampled.output();
                let sample = pi.step(y0, y);
                assert!(
                    (sample.u - 7.0).abs() < 1e-8 && (sample.u_f + 3.0).abs() < 1e-8,
                    "{plant:?}: {sample:?}"
                );
                sampled.step(sample.u, 3.0);
            }
        }
    }

    /// Load of 1 for 600 s on plant 2 with the output within 0.6: IAE over the pulse and the return.
    #[test]
    fn limits_and_anti_windup() {
        let case = &CASES[1];
        let ts = 0.4;
        let iae = |with_observer: bool, anti_windup| {
            let polynomials = HoldPolynomials::new(&case.plant, ts);
            let observer = with_observer.then(|| Observer::new(&polynomials, filter(10.0, 1), ts));
            let mut pi =
                PiWithObserver::new(case.kp, case.ki, observer, ts).with_limits((-0.6, 0.6), anti_windup);
            let mut plant = case.plant.sampled(ts);
            let samples = 0..(3000.0 / ts) as usize;
            samples.fold(0.0, |sum, k| {
                let d = if (k as f64) * ts < 600.0 { 1.0 } else { 0.0 };
                let u = pi.step(0.0, plant.output()).u;
                sum + ts * plant.step(u, d).abs()
            })
        };
        assert!((iae(false, AntiWindup::Conditional) - 284.0).abs() < 1.0);
        assert!((iae(true, AntiWindup::Conditional) - 235.0).abs() < 1.0);
        assert!((iae(true, AntiWindup::Off) - 462.0).abs() < 1.0);
        assert!((iae(false, AntiWindup::BackCalculation { tt: ts }) - 284.5).abs() < 1.0);
    }

    /// The estimator of structure A and the exact pair with d = 3, e = 1 are the same law but for the rule
    /// that samples the filter: poles `(2T - ts)/(2T + ts)` against `e^{-ts/T}`, apart by `(ts/T)^3/12`.
    #[test]
    fn the_pair_is_the_estimator_of_structure_a() {
        for case in [&de_cases::CASES[0], &de_cases::CASES[2]] {
            let estimator = case.estimator;
            let off = PidGains { kp: 0.0, ki: 0.0, kd: 0.0, tf: 1.0, b: 1.0, c: 1.0 };
            let controller = StructureA::new(off, Some(estimator), (-10.0, 10.0), case.ts);
            let step = UnitStep::InputDisturbance;
            let a =
                structure_a::respond(controller, case.plant.sampled(case.ts), step, case.horizon).measures;

            let filter = ObserverFilter { gain: estimator.kfd, averages: 1, ..filter(estimator.tfd, 3) };
            let observer = Observer::new(&HoldPolynomials::new(&case.plant, case.ts), filter, case.ts);
            let pair = PiWithObserver::new(0.0, 0.0, Some(observer), case.ts);
            let b = pair.respond(case.plant.sampled(case.ts), step, case.horizon);
            // Three poles apart by (ts/T)^3/12 over the T/ts samples of the response: (ts/T)^2/4, at most.
            let allowed = 0.25 * (case.ts / estimator.tfd).powi(2);
            for (u_a, u_b) in a.u.iter().zip(&b.u) {
                assert!((u_a - u_b).abs() < allowed, "{}: {u_a} {u_b}", case.name);
            }
        }
    }

    #[test]
    fn a_filter_without_delay_of_its_own_repeats_the_taps() {
        let polynomials = hold_polynomials::HoldPolynomials::first_order(2.0, 5.0, 0.0, 1.0);
        let mut observer = Observer::new(&polynomials, filter(1e-3, 1), 1.0);
        // alpha << ts: F = 1, so u_f = u[k-1] - (y[k] - q y[k-1])/B(1).
        let q = (-0.2_f64).exp();
        assert!((observer.step(3.0) + 3.0 / (2.0 * (1.0 - q))).abs() < 1e-12);
        observer.push(0.5);
        assert!((observer.step(1.0) - (0.5 - (1.0 - 3.0 * q) / (2.0 * (1.0 - q)))).abs() < 1e-12);
    }
}
