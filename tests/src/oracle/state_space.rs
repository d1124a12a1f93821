//! Continuous state space of a plant given by its factors.
//!
//! The plant is realised as a chain of first- and second-order sections, each carrying the zeros that lie
//! nearest to its poles. No polynomial is ever expanded, so a plant with slow and fast lags keeps all its
//! digits, and the exponential of the chain stays block triangular.

use super::complex::{self, Complex};
use super::expm::{Matrix, dot, zeros};
use super::sampled_plant::SampledPlant;

/// A plant by factors: `gain prod(1 + z1 s + z2 s^2) e^{-s dead_time} / (s^integrators prod(1 + tau s)
/// prod(1 + a1 s + a2 s^2))`; times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantFactors<'a> {
    /// Gain of the normalised factors, in units of y/u per second to the number of integrators.
    pub gain: f64,
    /// Number of factors `1/s`.
    pub integrators: usize,
    /// Lags `tau` \[s\]; a negative one is an unstable pole.
    pub lags: &'a [f64],
    /// Second-order denominator factors `(a1, a2)` in \[s\], \[s^2\]; those with real roots are split into
    /// lags.
    pub pairs: &'a [(f64, f64)],
    /// Numerator factors `(z1, z2)` in \[s\], \[s^2\]; `z2 = 0` is a single zero at `-1/z1`.
    pub zeros: &'a [(f64, f64)],
    /// Dead time \[s\].
    pub dead_time: f64,
}

impl PlantFactors<'_> {
    /// The static gain without dynamics: what the other constructors start from.
    pub const UNITY: PlantFactors<'static> =
        PlantFactors { gain: 1.0, integrators: 0, lags: &[], pairs: &[], zeros: &[], dead_time: 0.0 };

    /// Degree of the denominator.
    pub fn order(&self) -> usize {
        self.integrators + self.lags.len() + 2 * self.pairs.len()
    }

    /// Degree of the numerator.
    pub fn zero_count(&self) -> usize {
        self.zeros.iter().map(|&(_, z2)| if z2 == 0.0 { 1 } else { 2 }).sum()
    }

    /// Continuous frequency response at `omega` \[rad/s\], dead time included.
    pub fn response(&self, omega: f64) -> Complex {
        let quadratic = |c1: f64, c2: f64| (1.0 - c2 * omega * omega, c1 * omega);
        let mut value = complex::scale(self.gain, complex::unit(-omega * self.dead_time));
        for &(z1, z2) in self.zeros {
            value = complex::mul(value, quadratic(z1, z2));
        }
        for &tau in self.lags {
            value = complex::div(value, quadratic(tau, 0.0));
        }
        for &(a1, a2) in self.pairs {
            value = complex::div(value, quadratic(a1, a2));
        }
        complex::div(value, complex::pow((0.0, omega), self.integrators))
    }

    /// Zero-order-hold equivalent at the sampling time `ts` \[s\], the dead time included exactly.
    pub fn sampled(&self, ts: f64) -> SampledPlant {
        StateSpace::new(self).sampled(ts, self.dead_time)
    }
}

/// Strictly proper single-input single-output system `dx/dt = a x + b u`, `y = c x`; time in seconds.
#[derive(Clone, Debug)]
pub struct StateSpace {
    /// System matrix \[1/s\].
    pub a: Matrix,
    /// Input column \[1/s\].
    pub b: Vec<f64>,
    /// Output row.
    pub c: Vec<f64>,
}

impl StateSpace {
    /// Chain realisation of the rational part of `plant`; its dead time is given to [`StateSpace::sampled`].
    ///
    /// Panics when the plant is not strictly proper: a static path has no sampled output before the input
    /// acts.
    pub fn new(plant: &PlantFactors<'_>) -> Self {
        assert!(plant.zero_count() < plant.order(), "the plant must be strictly proper: {plant:?}");
        let mut chain = Section { a: zeros(0, 0), b: vec![], c: vec![], d: plant.gain };
        for section in sections(plant) {
            chain = chain.followed_by(&section);
        }
        assert!(chain.d == 0.0, "a chain with fewer zeros than poles has no direct path");
        Self { a: chain.a, b: chain.b, c: chain.c }
    }

    /// Zero-order-hold equivalent at the sampling time `ts` \[s\] with a dead time `delay` \[s\] of any
    /// length.
    pub fn sampled(&self, ts: f64, delay: f64) -> SampledPlant {
        SampledPlant::new(self, ts, delay)
    }
}

/// Section of the chain, with the direct path `d` that a zero per pole brings.
struct Section {
    a: Matrix,
    b: Vec<f64>,
    c: Vec<f64>,
    d: f64,
}

impl Section {
    /// `1/(1 + tau s)` or, with `tau` as the scale only, `1/s`.
    fn first_order(pole: Pole) -> Self {
        let (rate, output) = match pole {
            Pole::Lag(tau) => (-1.0 / tau, 1.0),
            Pole::Integrator(scale) => (0.0, scale),
        };
        Self { a: vec![vec![rate]], b: vec![1.0 / pole.time()], c: vec![output], d: 0.0 }
    }

    /// `1/(1 + a1 s + a2 s^2)` with states of equal size: the output, and its rate times `sqrt(a2)`.
    fn second_order(a1: f64, a2: f64) -> Self {
        let period = a2.sqrt();
        let a = vec![vec![0.0, 1.0 / period], vec![-1.0 / period, -a1 / a2]];
        Self { a, b: vec![0.0, 1.0 / period], c: vec![1.0, 0.0], d: 0.0 }
    }

    /// The section with its output multiplied by `1 + z1 s + z2 s^2`: `s x = a x + b u` put into `c x`.
    fn with_zero(mut self, (z1, z2): (f64, f64)) -> Self {
        let n = self.b.len();
        let row_times_a =
            |row: &[f64]| (0..n).map(|j| (0..n).map(|i| row[i] * self.a[i][j]).sum()).collect::<Vec<f64>>();
        let first = row_times_a(&self.c);
        let second = row_times_a(&first);
        self.d = z1 * dot(&self.c, &self.b) + z2 * dot(&first, &self.b);
        for j in 0..n {
            self.c[j] += z1 * first[j] + z2 * second[j];
        }
        self
    }

    /// Series connection: this section drives `next`.
    fn followed_by(&self, next: &Section) -> Section {
        let (n, m) = (self.b.len(), next.b.len());
        let mut a = zeros(n + m, n + m);
        for i in 0..n {
            a[i][..n].copy_from_slice(&self.a[i]);
        }
        for i in 0..m {
            for j in 0..n {
                a[n + i][j] = next.b[i] * self.c[j];
            }
            a[n + i][n..].copy_from_slice(&next.a[i]);
        }
        let b = self.b.iter().copied().chain(next.b.iter().map(|b| b * self.d)).collect();
        let c = self.c.iter().map(|c| next.d * c).chain(next.c.iter().copied()).collect();
        Section { a, b, c, d: next.d * self.d }
    }
}

/// A first-order denominator factor.
#[derive(Clone, Copy, PartialEq)]
enum Pole {
    /// `1 + tau s`
    Lag(f64),
    /// `s`, with the time that scales its state
    Integrator(f64),
}

impl Pole {
    fn time(self) -> f64 {
        match self {
            Pole::Lag(time) | Pole::Integrator(time) => time,
        }
    }
}

/// Splits `1 + c1 s + c2 s^2` into `(1 + t1 s)(1 + t2 s)` when the roots are real, without cancellation.
fn real_factors((c1, c2): (f64, f64)) -> Option<(f64, f64)> {
    if c2 == 0.0 {
        return None;
    }
    let root = (0.25 * c1 * c1 - c2).sqrt();
    let larger = 0.5 * c1 + root.copysign(c1);
    (root >= 0.0).then_some((larger, c2 / larger))
}

/// Removes and gives the item whose time is nearest to `time` on a logarithmic scale.
fn take_nearest<T>(items: &mut Vec<T>, time: f64, time_of: impl Fn(&T) -> f64) -> Option<T> {
    let distance = |item: &T| (time_of(item) / time).abs().ln().abs();
    let nearest = (0..items.len()).min_by(|&i, &j| distance(&items[i]).total_cmp(&distance(&items[j])))?;
    Some(items.swap_remove(nearest))
}

/// The sections of a plant: complex zeros take a complex pair or two first-order poles, real zeros the pole
/// nearest to them, and what is left over stands without zeros.
fn sections(plant: &PlantFactors<'_>) -> Vec<Section> {
    let mut lags = plant.lags.to_vec();
    let mut pairs = vec![];
    for &pair in plant.pairs {
        match real_factors(pair) {
            Some((t1, t2)) => lags.extend([t1, t2]),
            None => pairs.push(pair),
        }
    }
    let longest =
        lags.iter().map(|tau| tau.abs()).chain(pairs.iter().map(|p| p.1.sqrt())).fold(0.0, f64::max);
    let scale = if longest > 0.0 { longest } else { 1.0 };
    let mut poles: Vec<Pole> = lags.into_iter().map(Pole::Lag).collect();
    poles.extend(vec![Pole::Integrator(scale); plant.integrators]);

    let mut complex_zeros = vec![];
    let mut real_zeros = vec![];
    for &zero in plant.zeros {
        match real_factors(zero) {
            Some((t1, t2)) => real_zeros.extend([t1, t2]),
            None if zero.1 == 0.0 => real_zeros.push(zero.0),
            None => complex_zeros.push(zero),
        }
    }

    let mut done = vec![];
    for zero in complex_zeros {
        let time = zero.1.sqrt();
        let section = match take_nearest(&mut pairs, time, |p| p.1.sqrt()) {
            Some((a1, a2)) => Section::second_order(a1, a2),
            None => {
                let mut next =
                    || take_nearest(&mut poles, time, |p| p.time()).expect("a pole for every zero");
                let first = Section::first_order(next());
                first.followed_by(&Section::first_order(next()))
            }
        };
        done.push(section.with_zero(zero));
    }
    while let Some(zero) = real_zeros.pop() {
        match take_nearest(&mut poles, zero, |p| p.time()) {
            Some(pole) => done.push(Section::first_order(pole).with_zero((zero, 0.0))),
            None => {
                let (a1, a2) = take_nearest(&mut pairs, zero, |p| p.1.sqrt()).expect("a pole for every zero");
                let second = real_zeros.pop().unwrap_or(0.0);
                done.push(Section::second_order(a1, a2).with_zero((zero + second, zero * second)));
            }
        }
    }
    done.extend(pairs.into_iter().map(|(a1, a2)| Section::second_order(a1, a2)));
    done.extend(poles.into_iter().map(Section::first_order));
    done
}

/// Continuous frequency response `c (j omega I - a)^-1 b` of the realisation itself, for tests of the chain.
#[cfg(test)]
fn realised_response(system: &StateSpace, omega: f64) -> Complex {
    let n = system.b.len();
    let matrix = (0..n)
        .map(|i| (0..n).map(|j| (-system.a[i][j], if i == j { omega } else { 0.0 })).collect())
        .collect();
    let x = super::expm::solve_complex(matrix, system.b.iter().map(|&b| (b, 0.0)).collect());
    let states = x.expect("no pole on the imaginary axis at this frequency");
    states.iter().zip(&system.c).fold((0.0, 0.0), |sum, (&x, &c)| complex::add(sum, complex::scale(c, x)))
}

#[cfg(test)]
mod tests {
    use super::super::expm::{apply, solve};
    use super::*;

    fn assert_realises(plant: &PlantFactors<'_>) {
        let system = StateSpace::new(plant);
        assert_eq!(system.b.len(), plant.order());
        for omega in [0.01, 0.3, 1.0, 2.7, 40.0] {
            let exact = PlantFactors { dead_time: 0.0, ..*plant }.response(omega);
            let error = complex::abs(complex::sub(realised_response(&system, omega), exact));
            assert!(error <= 1e-12 * complex::abs(exact), "{plant:?} at {omega}: {error:e}");
        }
    }

    #[test]
    fn chains_realise_their_factors() {
        let one = PlantFactors::UNITY;
        assert_realises(&PlantFactors { gain: -2.5, lags: &[3.0], ..one });
        assert_realises(&PlantFactors { lags: &[1.0, 1.0, 0.2, 0.04], zeros: &[(-0.3, 0.0)], ..one });
        assert_realises(&PlantFactors { integrators: 2, lags: &[0.9], zeros: &[(2.0, 0.0)], ..one });
        assert_realises(&PlantFactors { integrators: 1, lags: &[0.9, 3.0], zeros: &[(0.2, 0.5)], ..one });
        assert_realises(&PlantFactors { pairs: &[(0.4, 1.0), (2.6, 0.4)], zeros: &[(0.1, 0.3)], ..one });
        assert_realises(&PlantFactors { pairs: &[(0.4, 1.0)], zeros: &[(-0.7, 0.0)], ..one });
        let mixed = [(0.4, 1.0), (0.9, 4.0)];
        assert_realises(&PlantFactors {
            lags: &[0.5],
            pairs: &mixed,
            zeros: &[(0.5, 2.0), (1.0, -6.0)],
            ..one
        });
        assert_realises(&PlantFactors { pairs: &mixed, zeros: &[(0.5, 0.0), (0.3, 0.0), (0.1, 0.0)], ..one });
    }

    #[test]
    fn static_gain_is_the_sum_of_the_chain() {
        let plant = PlantFactors { gain: 1.98, lags: &[80.3, 2.0], ..PlantFactors::UNITY };
        let system = StateSpace::new(&plant);
        let x = solve(&system.a, &system.b).expect("no integrator");
        assert!((dot(&system.c, &x) + 1.98).abs() < 1e-14);
        let residual = apply(&system.a, &x);
        assert!(residual.iter().zip(&system.b).all(|(r, b)| (r - b).abs() < 1e-15));
    }

    #[test]
    #[should_panic(expected = "strictly proper")]
    fn a_direct_path_is_refused() {
        StateSpace::new(&PlantFactors { lags: &[1.0], zeros: &[(0.5, 0.0)], ..PlantFactors::UNITY });
    }
}
