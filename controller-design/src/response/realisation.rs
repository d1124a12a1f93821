//! The loop as a set of linear differential equations driven by the delayed plant input.
//!
//! Time is counted in units that suit the loop, the output in units of the plant's gain. Every state is a deviation
//! from where it ends, so that all of them decay to 0 and the tail of a response keeps its relative accuracy.

use std::vec;
use std::vec::Vec;

use controller_core::PidConfig;
use controller_core::plant_model::Factor;

use super::block::Block;
use super::{Load, Observer};
use crate::Refusal;
use crate::model::{Polynomial, TransferFunction};

/// Numbers beyond this, or below its inverse, are refused: their squares and cubes would not be numbers.
const EXTREME: f64 = 1e60;

/// `1/(g + tau*s)`; an integrator has `g = 0`.
#[derive(Clone, Copy)]
struct Pole {
    g: f64,
    tau: f64,
}

/// A pole by what matters for the resolution: size, and rate of decay (0 if it does not decay).
#[derive(Debug, Clone, Copy)]
pub(super) struct Mode {
    pub(super) size: f64,
    pub(super) decay: f64,
    /// Oscillates for more than a turn or so.
    pub(super) rings: bool,
}

/// `z' = a*z + b*v(t - delay)`, `y = c*z`, `v = k*z`: v is the plant input, load included.
#[derive(Debug, Clone)]
pub(super) struct Realisation {
    pub(super) a: Block,
    pub(super) b: Vec<f64>,
    pub(super) c: Vec<f64>,
    pub(super) k: Vec<f64>,
    pub(super) modes: Vec<Mode>,
    /// 1 with dead time (the unit of time), 0 without.
    pub(super) delay: f64,
    /// Unit of time \[s\].
    pub(super) time: f64,
    /// Unit of the output.
    pub(super) gain: f64,
    integral: usize,
    ki: f64,
    filter: Option<Filter>,
}

/// The observer's filter in units of time of the realisation.
#[derive(Debug, Clone)]
struct Filter {
    alpha: f64,
    first: usize,
    order: usize,
    /// Where `1 - C_u` ends under a unit ramp.
    ramp: f64,
}

/// The real time constants and the complex pairs of the factors.
#[derive(Default)]
struct Split {
    real: Vec<f64>,
    pairs: Vec<Factor>,
}

fn split(factors: &[Polynomial], time: f64) -> Split {
    let mut s = Split::default();
    for f in factors.iter().flat_map(Polynomial::factors) {
        let (a1, a2) = (f.a1 / time, f.a2 / time / time);
        let discriminant = a1 * a1 - 4.0 * a2;
        if a2 == 0.0 {
            s.real.push(a1);
        } else if discriminant >= 0.0 {
            let larger = 0.5 * (a1 + libm::copysign(libm::sqrt(discriminant), a1));
            s.real.extend([larger, a2 / larger]);
        } else {
            s.pairs.push(Factor::second(a1, a2));
        }
    }
    s
}

/// The order of the observer's filter that leaves no pure derivative: poles less zeros in the left half-plane.
pub(super) fn filter_order(plant: &TransferFunction) -> usize {
    let zeros = split(plant.num(), 1.0);
    let left = zeros.real.iter().filter(|b| **b > 0.0).count()
        + 2 * zeros.pairs.iter().filter(|p| p.a1 > 0.0).count();
    plant.order().saturating_sub(left)
}

/// Dead time plus the time constants of the zeros in the right half-plane: what an observer cannot hasten \[s\].
pub(super) fn unavoidable(plant: &TransferFunction) -> f64 {
    let zeros = split(plant.num(), 1.0);
    let real: f64 = zeros.real.iter().map(|b| (-b).max(0.0)).sum();
    let pairs: f64 = zeros.pairs.iter().map(|p| (-p.a1).max(0.0)).sum();
    plant.dead_time() + real + pairs
}

/// The sign that `ki` must have: that of the gain, turned by every real pole in the right half-plane.
pub(super) fn sign_of_ki(plant: &TransferFunction) -> f64 {
    let turned = split(plant.den(), 1.0).real.iter().filter(|t| **t < 0.0).count() % 2 == 1;
    if turned { -plant.gain() } else { plant.gain() }
}

/// A unit of time for a plant without dead time.
fn own_time(plant: &TransferFunction, ki: f64) -> f64 {
    let lags = split(plant.den(), 1.0);
    let real = lags.real.iter().map(|t| t.abs());
    let slowest = real.chain(lags.pairs.iter().map(|p| libm::sqrt(p.a2))).fold(0.0, f64::max);
    if slowest > 0.0 {
        return slowest;
    }
    let power = -1.0 / (plant.integrators() as f64 + 1.0);
    libm::pow((plant.gain() * ki).abs(), power)
}

impl Realisation {
    pub(super) fn new(
        plant: &TransferFunction,
        pid: &PidConfig,
        observer: Option<Observer>,
    ) -> Result<Self, Refusal> {
        let [kp, ki, kd] = pid.signed_gains();
        let delayed = plant.dead_time() > 0.0;
        let time = if delayed { plant.dead_time() } else { own_time(plant, ki) };
        let gain = plant.gain() * libm::pow(time, plant.integrators() as f64);
        let (poles, zeros) = (split(plant.den(), time), split(plant.num(), time));
        let left_out = Self {
            a: Block::zeros(0, 0),
            b: Vec::new(),
            c: Vec::new(),
            k: Vec::new(),
            modes: modes(&poles),
            delay: if delayed { 1.0 } else { 0.0 },
            time,
            gain,
            integral: plant.order(),
            ki: ki * gain * time,
            filter: None,
        };
        let mut chain = Chain::of_plant(plant.integrators(), &poles, &zeros)?;
        let (y, b_states) = (chain.row.clone(), plant.order());
        // Integral of y.
        chain.state(&y, 0.0, 0.0);
        let mut k = vec![0.0; b_states];
        k.push(-left_out.ki);
        let (kp, kd, tf) = (kp * gain, kd * gain / time, pid.tf / time);
        let mut r = left_out;
        if tf > 0.0 {
            // C(s) = ki/s + ((kp - ki*tf) + kd*s)/(1 + tf*s)
            chain.state(&y.iter().map(|c| c / tf).collect::<Vec<_>>(), 0.0, -1.0 / tf);
            let direct = kd / tf;
            k.push(direct - (kp - r.ki * tf));
            k.iter_mut().zip(&y).for_each(|(k, c)| *k -= direct * c);
            r.modes.push(Mode { size: 1.0 / tf, decay: 1.0 / tf, rings: false });
        } else {
            k.iter_mut().zip(&y).for_each(|(k, c)| *k -= kp * c);
        }
        if let Some(observer) = observer {
            let (alpha, order) = (observer.alpha / time, observer.order);
            let first = chain.a.len();
            for i in 0..order {
                let mut row = vec![0.0; chain.a.len()];
                if i > 0 {
                    row[first + i - 1] = 1.0 / alpha;
                }
                chain.state(&row, 0.0, -1.0 / alpha);
            }
            let mut ramp = r.delay;
            let mut through = vec![0.0; order];
            for (power, c) in numerator(&zeros, alpha).into_iter().enumerate() {
                // c/(1 + alpha*s)^lags
                let lags = order - power;
                through[lags - 1] = -c;
                ramp += c * alpha * lags as f64;
            }
            k.extend(through);
            r.filter = Some(Filter { alpha, first, order, ramp });
            r.modes.push(Mode { size: 1.0 / alpha, decay: 1.0 / alpha, rings: false });
        }
        let n = chain.a.len();
        r.a = Block::zeros(n, n);
        for (i, row) in chain.a.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                r.a.set(i, j, value);
            }
        }
        r.b = chain.b;
        r.c = y;
        r.c.resize(n, 0.0);
        r.k = k;
        let numbers = r.b.iter().chain(&r.c).chain(&r.k).chain([&r.gain, &r.time, &r.ki]);
        let moderate = |x: &f64| *x == 0.0 || (x.abs() > 1.0 / EXTREME && x.abs() < EXTREME);
        let good = numbers.copied().all(|x| moderate(&x)) && r.a.norm() < EXTREME;
        if !good || r.gain == 0.0 || r.ki == 0.0 || r.time <= 0.0 {
            return Err(Refusal::NoSolution {
                why: "the numbers of the loop are too far apart to be computed with",
                help: "write the plant and the gains in units closer to its own time constants",
            });
        }
        Ok(r)
    }

    /// Where the load that is left by the observer ends; `None` if it never ends.
    pub(super) fn end(&self, load: Load) -> Option<f64> {
        match (load, &self.filter) {
            (Load::Step, None) => Some(1.0),
            (Load::Step, Some(_)) => Some(0.0),
            (Load::Ramp, None) => None,
            (Load::Ramp, Some(filter)) => Some(filter.ramp),
        }
    }

    /// The states when the load first reaches the output.
    pub(super) fn start(&self, load: Load) -> Vec<f64> {
        let mut z = vec![0.0; self.a.rows];
        z[self.integral] = -self.end(load).unwrap_or(0.0) / self.ki;
        if let Some(filter) = &self.filter {
            for i in 0..filter.order {
                z[filter.first + i] = match load {
                    Load::Step => -1.0,
                    Load::Ramp => filter.alpha * (i as f64 + 1.0),
                };
            }
        }
        z
    }

    /// Integral of the output from the start to these states, in units of the realisation.
    pub(super) fn integral(&self, load: Load, z: &[f64]) -> f64 {
        z[self.integral] + self.end(load).unwrap_or(0.0) / self.ki
    }
}

fn modes(poles: &Split) -> Vec<Mode> {
    let real =
        poles.real.iter().map(|t| Mode { size: 1.0 / t.abs(), decay: (1.0 / t).max(0.0), rings: *t < 0.0 });
    let pairs = poles.pairs.iter().map(|p| {
        let (size, decay) = (1.0 / libm::sqrt(p.a2), (0.5 * p.a1 / p.a2).max(0.0));
        Mode { size, decay, rings: decay < 0.7 * size }
    });
    real.chain(pairs).collect()
}

/// The part of the plant's numerator that has no stable inverse, as a polynomial in `1 + alpha*s`.
fn numerator(zeros: &Split, alpha: f64) -> Vec<f64> {
    let right = zeros.real.iter().filter(|b| **b < 0.0).map(|&b| Polynomial::new([1.0, b]));
    let pairs = zeros.pairs.iter().filter(|p| p.a1 <= 0.0).map(|p| Polynomial::new([1.0, p.a1, p.a2]));
    let n = right.chain(pairs).fold(Polynomial::constant(1.0), |n, f| &n * &f);
    // s = (x - 1)/alpha, by Horner.
    let s = Polynomial::new([-1.0 / alpha, 1.0 / alpha]);
    let in_x = n
        .coefficients()
        .iter()
        .rev()
        .fold(Polynomial::default(), |sum, &c| &(&sum * &s) + &Polynomial::constant(c));
    in_x.coefficients().to_vec()
}

/// States in the order in which the signal passes them.
struct Chain {
    a: Vec<Vec<f64>>,
    b: Vec<f64>,
    /// The signal behind the last state: this row of the states plus `direct` times the input.
    row: Vec<f64>,
    direct: f64,
}

impl Chain {
    fn of_plant(integrators: usize, poles: &Split, zeros: &Split) -> Result<Self, Refusal> {
        let mut pairs: Vec<(Factor, [f64; 2])> = poles.pairs.iter().map(|&p| (p, [0.0; 2])).collect();
        let mut single: Vec<Pole> = poles.real.iter().map(|&tau| Pole { g: 1.0, tau }).collect();
        single.extend(vec![Pole { g: 0.0, tau: 1.0 }; integrators]);
        let mut twos = Vec::new();
        let mut free_pairs = 0..pairs.len();
        let unplaced = Refusal::Plant {
            must: "have more poles than zeros",
            help: "add the lag of the actuator or of the sensor to the plant",
        };
        for zero in &zeros.pairs {
            if let Some(i) = free_pairs.next() {
                pairs[i].1 = [zero.a1, zero.a2];
            } else if single.len() > 1 {
                twos.push((single.remove(0), single.remove(0), [zero.a1, zero.a2]));
            } else {
                return Err(unplaced);
            }
        }
        let mut ones = Vec::new();
        let mut rest = zeros.real.iter();
        for &zero in rest.by_ref().take(single.len()) {
            let distance =
                |p: &Pole| (libm::log(p.tau.abs()) - libm::log(zero.abs())).abs() + 50.0 * (1.0 - p.g);
            let near = |i: &usize, j: &usize| distance(&single[*i]).total_cmp(&distance(&single[*j]));
            let Some(i) = (0..single.len()).min_by(near) else { return Err(unplaced) };
            ones.push((single.remove(i), zero));
        }
        while let Some(first) = rest.next() {
            let Some(i) = free_pairs.next() else { return Err(unplaced) };
            let second = rest.next().copied().unwrap_or(0.0);
            pairs[i].1 = [first + second, first * second];
        }
        let mut chain = Self { a: Vec::new(), b: Vec::new(), row: Vec::new(), direct: 1.0 };
        single.into_iter().for_each(|p| chain.one(p, 0.0));
        let (last, first): (Vec<_>, Vec<_>) = pairs.into_iter().partition(|p| p.1[1] != 0.0);
        first.into_iter().chain(last).for_each(|(p, [b1, b2])| chain.pair(p, b1, b2));
        ones.into_iter().for_each(|(p, zero)| chain.one(p, zero));
        twos.into_iter().for_each(|(p, q, [b1, b2])| chain.two(p, q, b1, b2));
        if chain.direct == 0.0 { Ok(chain) } else { Err(unplaced) }
    }

    /// Adds `x' = row*states + input*v + own*x`.
    fn state(&mut self, row: &[f64], input: f64, own: f64) {
        let mut a = row.to_vec();
        a.resize(self.a.len(), 0.0);
        a.push(own);
        self.a.push(a);
        self.b.push(input);
        self.row.push(0.0);
    }

    fn scaled(&self, factor: f64) -> (Vec<f64>, f64) {
        (self.row.iter().map(|c| c * factor).collect(), self.direct * factor)
    }

    /// One first-order pole; its state is the last.
    fn lag(&mut self, pole: Pole) {
        let (row, direct) = self.scaled(1.0 / pole.tau);
        self.state(&row, direct, -pole.g / pole.tau);
    }

    /// `(1 + zero*s)/(g + tau*s)`.
    fn one(&mut self, pole: Pole, zero: f64) {
        let c0 = zero / pole.tau;
        let (mut row, direct) = self.scaled(c0);
        self.lag(pole);
        row.push(1.0 - c0 * pole.g);
        (self.row, self.direct) = (row, direct);
    }

    /// `(1 + b1*s + b2*s^2)` over two first-order poles.
    fn two(&mut self, p: Pole, q: Pole, b1: f64, b2: f64) {
        let c0 = b2 / (p.tau * q.tau);
        let c1 = (b1 - c0 * (p.g * q.tau + q.g * p.tau)) / q.tau;
        let c2 = 1.0 - c0 * p.g * q.g - c1 * q.g;
        let (mut row, direct) = self.scaled(c0);
        self.one(p, 0.0);
        self.one(q, 0.0);
        row.extend([c1, c2]);
        (self.row, self.direct) = (row, direct);
    }

    /// `(1 + b1*s + b2*s^2)/(1 + a1*s + a2*s^2)` with complex poles.
    fn pair(&mut self, p: Factor, b1: f64, b2: f64) {
        let w = 1.0 / libm::sqrt(p.a2);
        let damping = p.a1 * w * w;
        let (mut row, direct) = self.scaled(b2 * w * w);
        let (mut drive, input) = self.scaled(w);
        self.state(&[], 0.0, 0.0);
        let x1 = self.a.len() - 1;
        drive.push(-w);
        self.state(&drive, input, -damping);
        // x1' = w*x2
        self.a[x1].push(w);
        row.extend([1.0 - b2 * w * w, w * (b1 - b2 * damping)]);
        (self.row, self.direct) = (row, direct);
    }
}
