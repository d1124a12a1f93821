//! The loop as a set of linear differential equations driven by the delayed plant input.
//!
//! Time is counted in units that suit the loop, the output in units of the plant's gain. Every state is a deviation
//! from where it ends, so that all of them decay to 0 and the tail of a response keeps its relative accuracy.

use std::vec;
use std::vec::Vec;

use controller_core::PidConfig;

use super::block::Block;
use super::chain::{Chain, Split, split};
use super::rest::rest;
use super::{Drive, Shape};
use crate::Refusal;
use crate::model::{Polynomial, TransferFunction};

/// Numbers beyond this, or below its inverse, are refused: their squares and cubes would not be numbers.
const EXTREME: f64 = 1e60;

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
    reference: Reference,
}

/// What a step of the set-point needs, for an output that ends at 1.
#[derive(Debug, Clone, Default)]
struct Reference {
    /// Where the plant's states end.
    plant: Vec<f64>,
    /// Where the plant input ends: 0 with an integrator.
    v: f64,
    /// `(1 - b)*kp`.
    held_back: f64,
    /// The state of the controller's filter that the weights b and c of the set-point need, when they are not 1.
    filter: Option<usize>,
    /// The controller output right after the step.
    kick: f64,
}

/// The observer's filter in units of time of the realisation.
#[derive(Debug, Clone)]
struct Filter {
    alpha: f64,
    first: usize,
    order: usize,
    /// `C_u` at `s = 0`: 1 of an observer, less of an estimator.
    gain: f64,
    /// Where `1 - C_u` ends under a unit ramp.
    ramp: f64,
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
        shape: Option<Shape>,
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
            reference: Reference::default(),
        };
        let mut chain = Chain::of_plant(plant.integrators(), &poles, &zeros)?;
        let (y, b_states) = (chain.row.clone(), plant.order());
        // Integral of y.
        chain.state(&y, 0.0, 0.0);
        let mut k = vec![0.0; b_states];
        k.push(-left_out.ki);
        let (kp, kd, tf) = (kp * gain, kd * gain / time, pid.tf / time);
        let mut r = left_out;
        let (plant_states, v) = rest(&chain.a[..b_states], &chain.b[..b_states], &y).ok_or(FAR_APART)?;
        // The weights of the set-point are those of the law that runs: b, and c of its derivative.
        r.reference =
            Reference { plant: plant_states, v, held_back: (1.0 - pid.b) * kp, ..Reference::default() };
        r.reference.kick = if tf > 0.0 { pid.c * kd / tf } else { pid.b * kp };
        if tf > 0.0 {
            // C(s) = ki/s + ((kp - ki*tf) + kd*s)/(1 + tf*s)
            chain.state(&y.iter().map(|c| c / tf).collect::<Vec<_>>(), 0.0, -1.0 / tf);
            let direct = kd / tf;
            k.push(direct - (kp - r.ki * tf));
            k.iter_mut().zip(&y).for_each(|(k, c)| *k -= direct * c);
            r.modes.push(Mode { size: 1.0 / tf, decay: 1.0 / tf, rings: false });
            let weighted = (pid.b - 1.0) * kp - (pid.c - 1.0) * direct;
            if weighted != 0.0 {
                r.reference.filter = Some(chain.a.len());
                chain.state(&[], 0.0, -1.0 / tf);
                k.push(weighted);
            }
        } else {
            k.iter_mut().zip(&y).for_each(|(k, c)| *k -= kp * c);
        }
        if let Some(Shape { alpha, order, gain }) = shape {
            let alpha = alpha / time;
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
                through[lags - 1] = -gain * c;
                ramp += c * alpha * lags as f64;
            }
            k.extend(through);
            r.filter = Some(Filter { alpha, first, order, gain, ramp });
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
            return Err(FAR_APART);
        }
        Ok(r)
    }

    /// Where the load that is left by the observer ends; `None` if it never ends.
    pub(super) fn end(&self, drive: Drive) -> Option<f64> {
        match (drive, &self.filter) {
            (Drive::Setpoint, _) => Some(0.0),
            (Drive::Step, None) => Some(1.0),
            (Drive::Step, Some(filter)) => Some(1.0 - filter.gain),
            (Drive::Ramp, Some(filter)) if filter.gain == 1.0 => Some(filter.ramp),
            (Drive::Ramp, _) => None,
        }
    }

    /// The states when the load first reaches the output; for a set-point, right after its step.
    pub(super) fn start(&self, drive: Drive) -> Vec<f64> {
        let mut z = vec![0.0; self.a.rows];
        z[self.integral] = self.integral_at_start(drive);
        if drive == Drive::Setpoint {
            z.iter_mut().zip(&self.reference.plant).for_each(|(z, end)| *z = -end);
            if let Some(filter) = self.reference.filter {
                z[filter] = -1.0;
            }
            return z;
        }
        if let Some(filter) = &self.filter {
            for i in 0..filter.order {
                z[filter.first + i] = match drive {
                    Drive::Ramp => filter.alpha * (i as f64 + 1.0),
                    _ => -1.0,
                };
            }
        }
        z
    }

    fn integral_at_start(&self, drive: Drive) -> f64 {
        match drive {
            Drive::Setpoint => (self.reference.v + self.reference.held_back) / self.ki,
            _ => -self.end(drive).unwrap_or(0.0) / self.ki,
        }
    }

    /// Integral of the output, less its end, from the start to these states, in units of the realisation.
    pub(super) fn integral(&self, drive: Drive, z: &[f64]) -> f64 {
        z[self.integral] - self.integral_at_start(drive)
    }

    /// The plant input before a step of the set-point, less its end.
    pub(super) fn before_setpoint(&self) -> f64 {
        -self.reference.v
    }

    /// The jump of the controller output with a step of the set-point.
    pub(super) fn kick(&self) -> f64 {
        self.reference.kick
    }
}

const FAR_APART: Refusal = Refusal::NoSolution {
    why: "the numbers of the loop are too far apart to be computed with",
    help: "write the plant and the gains in units closer to its own time constants",
};

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
