//! Polynomials of degree 8 through nine equidistant nodes: the one shape in which every signal is kept.
//!
//! Equidistant nodes because every other node of two neighbouring elements are the nodes of the element of twice
//! the length: elements double without any interpolation.

use std::sync::OnceLock;

use super::block::Block;
use super::map::TERMS;

/// Nodes of an element, both ends included.
pub(super) const NODES: usize = 9;

const CENTRE: f64 = 4.0;

/// Values at the nodes of one element.
pub(super) type Values = [f64; NODES];

/// What follows from the positions of the nodes alone.
pub(super) struct Nodes {
    /// `centred[k][j]`: coefficient of `x^k`, x from -1 to 1, of the polynomial that is 1 at node j.
    centred: [Values; NODES],
    /// `forward[k][j]`: the same for x from 0 to 1.
    pub(super) forward: [Values; NODES],
    /// `halves[0][i][j]`: the polynomial of node j at the nodes of the first half of the element, `halves[1]` of
    /// the second.
    pub(super) halves: [[Values; NODES]; 2],
    /// The same as matrices.
    pub(super) finer: [Block; 2],
    /// `powers[k][i]`: place of node i, from 0 to 1, to the power of k.
    pub(super) powers: [Values; TERMS],
    /// Weights of the integral over an element of length 1 (Newton and Cotes).
    pub(super) weights: Values,
    /// Weights of the derivative at both ends, for an element of length 2.
    ends: [Values; 2],
}

/// The one instance.
pub(super) fn nodes() -> &'static Nodes {
    static NODES_ONCE: OnceLock<Nodes> = OnceLock::new();
    NODES_ONCE.get_or_init(Nodes::new)
}

/// Coefficients in ascending powers of the polynomial that is 1 at node `j`, in `x = (node - offset)/scale`.
fn basis(j: usize, offset: f64, scale: f64) -> Values {
    let mut p = [0.0; NODES];
    p[0] = 1.0;
    for (degree, i) in (0..NODES).filter(|&i| i != j).enumerate() {
        let (root, span) = ((i as f64 - offset) / scale, (j as f64 - i as f64) / scale);
        let mut next = [0.0; NODES];
        for k in 0..=degree {
            next[k + 1] += p[k] / span;
            next[k] -= p[k] * root / span;
        }
        p = next;
    }
    p
}

impl Nodes {
    fn new() -> Self {
        let mut n = Self {
            centred: [[0.0; NODES]; NODES],
            forward: [[0.0; NODES]; NODES],
            halves: [[[0.0; NODES]; NODES]; 2],
            finer: core::array::from_fn(|_| Block::zeros(NODES, NODES)),
            powers: [[1.0; NODES]; TERMS],
            weights: [0.0; NODES],
            ends: [[0.0; NODES]; 2],
        };
        for j in 0..NODES {
            let (centred, forward) = (basis(j, CENTRE, CENTRE), basis(j, 0.0, 8.0));
            for k in 0..NODES {
                n.centred[k][j] = centred[k];
                n.forward[k][j] = forward[k];
                if k % 2 == 0 {
                    n.weights[j] += centred[k] / (k as f64 + 1.0);
                }
                let slope = k as f64 * centred[k];
                n.ends[0][j] += if k % 2 == 0 { -slope } else { slope };
                n.ends[1][j] += slope;
            }
            for i in 0..NODES {
                for half in 0..2 {
                    n.halves[half][i][j] = lagrange(j, CENTRE * half as f64 + 0.5 * i as f64);
                    n.finer[half].set(i, j, n.halves[half][i][j]);
                }
            }
        }
        for k in 1..TERMS {
            for i in 0..NODES {
                n.powers[k][i] = n.powers[k - 1][i] * i as f64 / 8.0;
            }
        }
        n
    }

    /// The polynomial through the values.
    pub(super) fn polynomial(&self, values: &Values) -> Centred {
        Centred { coefficients: core::array::from_fn(|k| dot(&self.centred[k], values)) }
    }

    /// Whether the values rise or fall from end to end without a turn.
    pub(super) fn is_monotonic(&self, values: &Values) -> bool {
        let rise = values[8] - values[0];
        let steps = values.windows(2).all(|w| (w[1] - w[0]) * rise > 0.0);
        steps && self.ends.iter().all(|end| dot(end, values) * rise > 0.0)
    }
}

/// The polynomial that is 1 at node `j`, at `x` counted in nodes.
fn lagrange(j: usize, x: f64) -> f64 {
    (0..NODES).filter(|&i| i != j).fold(1.0, |p, i| p * (x - i as f64) / (j as f64 - i as f64))
}

pub(super) fn dot(a: &Values, b: &Values) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Largest size of the values.
pub(super) fn size(values: &Values) -> f64 {
    values.iter().fold(0.0, |m, v| if v.abs() > m { v.abs() } else { m })
}

/// A polynomial over an element, `x` from -1 to 1.
pub(super) struct Centred {
    coefficients: Values,
}

/// Position of node `i`.
pub(super) fn position(i: usize) -> f64 {
    (i as f64 - CENTRE) / CENTRE
}

impl Centred {
    pub(super) fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    /// The derivative by `x`.
    pub(super) fn slope(&self) -> Self {
        Self {
            coefficients: core::array::from_fn(|k| {
                self.coefficients.get(k + 1).map_or(0.0, |c| c * (k as f64 + 1.0))
            }),
        }
    }

    /// Integral from -1 to `x`.
    pub(super) fn integral(&self, x: f64) -> f64 {
        let primitive = |x: f64| {
            let terms = self.coefficients.iter().enumerate().rev();
            x * terms.fold(0.0, |sum, (k, c)| sum * x + c / (k as f64 + 1.0))
        };
        primitive(x) - primitive(-1.0)
    }

    /// Integral of `x` times the polynomial, from -1 to `x`.
    pub(super) fn moment(&self, x: f64) -> f64 {
        let primitive = |x: f64| {
            let terms = self.coefficients.iter().enumerate().rev();
            x * x * terms.fold(0.0, |sum, (k, c)| sum * x + c / (k as f64 + 2.0))
        };
        primitive(x) - primitive(-1.0)
    }

    /// The root between two positions with values of different sign.
    pub(super) fn root(&self, mut lo: f64, mut hi: f64) -> f64 {
        let (mut f_lo, mut f_hi) = (self.at(lo), self.at(hi));
        let mut last = lo;
        for _ in 0..60 {
            // Illinois: the end that stays loses half its weight.
            let mut x = (lo * f_hi - hi * f_lo) / (f_hi - f_lo);
            if !(x > lo && x < hi) {
                x = 0.5 * (lo + hi);
            }
            let f = self.at(x);
            if f == 0.0 || (x - last).abs() < 1e-15 {
                return x;
            }
            last = x;
            if (f > 0.0) == (f_hi > 0.0) {
                (hi, f_hi) = (x, f);
                f_lo *= 0.5;
            } else {
                (lo, f_lo) = (x, f);
                f_hi *= 0.5;
            }
        }
        0.5 * (lo + hi)
    }
}

/// How far the values of two neighbouring elements are from the one polynomial through every other of them.
pub(super) fn misfit(first: &Values, second: &Values) -> f64 {
    let pair = [first, second];
    let coarse: Values = core::array::from_fn(|i| if i <= 4 { first[2 * i] } else { second[2 * i - 8] });
    let mut worst: f64 = 0.0;
    for (half, fine) in pair.into_iter().enumerate() {
        for i in (1..NODES).step_by(2) {
            worst = worst.max((dot(&nodes().halves[half][i], &coarse) - fine[i]).abs());
        }
    }
    worst
}

/// Size of the last Chebyshev coefficient: how well the element resolves the signal.
pub(super) fn tail(values: &Values) -> f64 {
    const DIFFERENCES: Values = [1.0, -8.0, 28.0, -56.0, 70.0, -56.0, 28.0, -8.0, 1.0];
    // 8th difference -> coefficient of x^8 (4^8/8!) -> Chebyshev (1/2^7).
    dot(&DIFFERENCES, values).abs() * (65536.0 / 40320.0 / 128.0)
}
