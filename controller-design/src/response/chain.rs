//! The plant as states in the order in which the signal passes them.

use std::vec;
use std::vec::Vec;

use controller_core::plant_model::Factor;

use crate::Refusal;
use crate::model::Polynomial;

/// `1/(g + tau*s)`; an integrator has `g = 0`.
#[derive(Clone, Copy)]
struct Pole {
    g: f64,
    tau: f64,
}

/// The real time constants and the complex pairs of the factors.
#[derive(Default)]
pub(super) struct Split {
    pub(super) real: Vec<f64>,
    pub(super) pairs: Vec<Factor>,
}

pub(super) fn split(factors: &[Polynomial], time: f64) -> Split {
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

/// States in the order in which the signal passes them.
pub(super) struct Chain {
    pub(super) a: Vec<Vec<f64>>,
    pub(super) b: Vec<f64>,
    /// The signal behind the last state: this row of the states plus `direct` times the input.
    pub(super) row: Vec<f64>,
    direct: f64,
}

impl Chain {
    pub(super) fn of_plant(integrators: usize, poles: &Split, zeros: &Split) -> Result<Self, Refusal> {
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
    pub(super) fn state(&mut self, row: &[f64], input: f64, own: f64) {
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
