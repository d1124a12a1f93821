//! Least-squares fit of lags with dead time to the whole record.
//!
//! `y = offset + K*(1 + b1*s)*exp(-T*s)/prod(1 + a1*s + a2*s^2) * u`, simulated exactly for the held input. `offset`, `K`
//! and `K*b1` enter linearly and are solved for at every trial of the others (Levenberg and Marquardt's method).

use super::moments::{COUNT, Six};
use super::noise;
use super::record::Record;
use super::response::{Chain, Lag};
use super::solve::{MOST, Normal};
use std::vec::Vec;

/// Most parameters that do not enter linearly: the dead time and two quadratics.
pub(super) const MOST_TIMES: usize = 5;
/// Rows that decide between starts, rows of the fit itself, rows of its last polish.
const FEWEST_ROWS: usize = 12;
const FEW_ROWS: usize = 1500;
const SOME_ROWS: usize = 3000;
const MANY_ROWS: usize = 60_000;

/// A structure: number of lags, and whether there is a zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) order: usize,
    pub(super) zero: bool,
}

impl Shape {
    pub(super) const fn times(self) -> usize {
        self.order + 1
    }

    pub(super) const fn linear(self) -> usize {
        2 + self.zero as usize
    }

    pub(super) const fn parameters(self) -> usize {
        self.times() + self.linear()
    }
}

/// `[T, a1, a2, ..]` in the time of the record; unused ones 0.
pub(super) type Times = [f64; MOST_TIMES];

pub(super) fn lags(shape: Shape, times: &Times) -> [Lag; 2] {
    let second = match shape.order {
        3 => Lag { a1: times[3], a2: 0.0 },
        4 => Lag { a1: times[3], a2: times[4] },
        _ => Lag { a1: 0.0, a2: 0.0 },
    };
    [second, Lag { a1: times[1], a2: times[2] }]
}

/// A fit and what is known of its accuracy.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) shape: Shape,
    pub(super) times: Times,
    /// Offset, gain, gain times `b1`.
    pub(super) linear: [f64; 3],
    pub(super) rows: usize,
    pub(super) squares: f64,
    pub(super) rms: f64,
    /// Correlation of the residuals: 1 for white ones.
    pub(super) colour: f64,
    /// Covariance of `[linear.., times..]`.
    pub(super) covariance: [[f64; MOST]; MOST],
}

/// The rows a fit looks at.
struct Rows<'a> {
    record: &'a Record,
    t: Vec<f64>,
    y: Vec<f64>,
}

impl<'a> Rows<'a> {
    fn new(record: &'a Record, most: usize, until: f64) -> Self {
        let end =
            record.t.partition_point(|t| *t <= until).clamp(FEWEST_ROWS.min(record.t.len()), record.t.len());
        let stride = end.div_ceil(most).max(1);
        let pick = |list: &[f64]| list[..end].iter().copied().step_by(stride).collect();
        Self { record, t: pick(&record.t), y: pick(&record.y) }
    }

    /// The linear columns: 1 (not stored), the response, its slope if there is a zero.
    fn columns(&self, shape: Shape, times: &Times) -> (Vec<f64>, Vec<f64>) {
        let mut chain = Chain::new(&lags(shape, times));
        chain.response(&self.t, &self.record.moves, times[0])
    }
}

/// One trial: the linear parameters and the sum of squares.
struct Trial {
    columns: (Vec<f64>, Vec<f64>),
    linear: [f64; 3],
    residuals: Vec<f64>,
    squares: f64,
}

fn attempt(rows: &Rows<'_>, shape: Shape, times: &Times) -> Option<Trial> {
    let columns = rows.columns(shape, times);
    let count = shape.linear();
    let mut normal = Normal::new(count);
    for ((x, slope), y) in columns.0.iter().zip(&columns.1).zip(&rows.y) {
        normal.add(&[1.0, *x, *slope], *y);
    }
    let solution = normal.solve(0.0, &[])?;
    let mut linear = [0.0; 3];
    linear[..count].copy_from_slice(&solution[..count]);
    let residual = |((x, slope), y): ((&f64, &f64), &f64)| y - linear[0] - linear[1] * x - linear[2] * slope;
    let residuals: Vec<f64> = columns.0.iter().zip(&columns.1).zip(&rows.y).map(residual).collect();
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    squares.is_finite().then_some(Trial { columns, linear, residuals, squares })
}

/// The normal equations of all parameters at a trial: linear ones first.
///
/// `a2` is varied by `share` of its scale: near 0 it acts like dead time, and only a share that is as large as its own
/// uncertainty tells the two apart.
fn linearised(rows: &Rows<'_>, shape: Shape, times: &Times, trial: &Trial, share: f64) -> Normal {
    let scale = times[1].max(times[0]).max(libm::sqrt(times[2])).max(1e-6);
    let slopes: Vec<Vec<f64>> = (0..shape.times())
        .map(|j| {
            // The quadratic's a2 is a time squared.
            let step = if j == 2 || j == 4 { share * scale * scale } else { 1e-5 * scale };
            let mut up = *times;
            up[j] += step;
            let moved = rows.columns(shape, &up);
            let [_, gain, lead] = trial.linear;
            let (x, d) = &trial.columns;
            let change = |i: usize| gain * (moved.0[i] - x[i]) + lead * (moved.1[i] - d[i]);
            (0..rows.t.len()).map(|i| change(i) / step).collect()
        })
        .collect();
    let linear = shape.linear();
    let mut normal = Normal::new(shape.parameters());
    for i in 0..rows.t.len() {
        let mut row = [0.0; MOST];
        let known = [1.0, trial.columns.0[i], trial.columns.1[i]];
        row[..linear].copy_from_slice(&known[..linear]);
        for (place, slope) in row[linear..].iter_mut().zip(&slopes) {
            *place = slope[i];
        }
        normal.add(&row, trial.residuals[i]);
    }
    normal
}

/// Levenberg and Marquardt from `start`; the times, the trial there.
fn descend(rows: &Rows<'_>, shape: Shape, start: &Times, passes: usize) -> Option<(Times, Trial)> {
    let mut times = *start;
    let mut best = attempt(rows, shape, &times)?;
    let mut damping = 1e-3;
    let linear = shape.linear();
    let floor = 1e-20 * rows.t.len() as f64;
    for _ in 0..passes {
        let normal = linearised(rows, shape, &times, &best, 1e-5);
        let mut gained = None;
        // Parameters at 0 that want to be less stay there.
        let mut fixed = [false; MOST];
        for _ in 0..8 {
            let Some(step) = normal.solve_with(damping, linear, &fixed) else {
                damping *= 10.0;
                continue;
            };
            let mut next = times;
            let mut again = false;
            for j in 0..shape.times() {
                next[j] = (times[j] + step[linear + j]).max(0.0);
                if times[j] == 0.0 && step[linear + j] < 0.0 && !fixed[linear + j] {
                    fixed[linear + j] = true;
                    again = true;
                }
            }
            if again {
                continue;
            }
            match attempt(rows, shape, &next) {
                Some(trial) if trial.squares < best.squares => {
                    gained = Some((next, trial));
                    damping = (damping * 0.1).max(1e-12);
                    break;
                }
                _ => damping *= 10.0,
            }
            if damping > 1e12 {
                break;
            }
        }
        let Some((next, trial)) = gained else { break };
        let small = best.squares - trial.squares <= 1e-9 * best.squares;
        times = next;
        best = trial;
        if small || best.squares <= floor {
            break;
        }
    }
    Some((times, best))
}

/// The best fit of a structure from several starts, which are compared on the record up to `until`.
pub(super) fn fit(record: &Record, shape: Shape, starts: &[Times], until: f64) -> Option<Fitted> {
    let few = Rows::new(record, FEW_ROWS, until);
    let mut tried: Vec<(Times, f64)> = starts
        .iter()
        .filter_map(|start| descend(&few, shape, start, 8))
        .map(|(times, trial)| (times, trial.squares))
        .collect();
    tried.sort_by(|a, b| a.1.total_cmp(&b.1));
    // What the starts agree on is brought to rest on some rows of the whole record, then on all of them.
    let some = Rows::new(record, SOME_ROWS, f64::INFINITY);
    let promising = tried.iter().take(2).filter(|(_, squares)| *squares <= 4.0 * tried[0].1);
    let (times, _) = promising
        .filter_map(|(start, _)| descend(&some, shape, start, 40))
        .min_by(|a, b| a.1.squares.total_cmp(&b.1.squares))?;
    let rows = Rows::new(record, MANY_ROWS, f64::INFINITY);
    let (times, best) = descend(&rows, shape, &times, if rows.t.len() > some.t.len() { 6 } else { 1 })?;
    let count = rows.t.len();
    let degrees = count.checked_sub(shape.parameters()).filter(|n| *n > 2)?;
    let colour = noise::colour(&best.residuals);
    let variance = best.squares / degrees as f64 * colour;
    let normal = linearised(&rows, shape, &times, &best, 1e-2);
    // A time at its bound is known there no better than elsewhere; only what the record says nothing about is left out.
    let mut covariance = normal.inverse(variance)?;
    // Rows at rest all have the same error of a coarse converter: what it does to every parameter.
    let rest = Trial { residuals: at_rest(&rows, &best), ..best };
    let moved = linearised(&rows, shape, &times, &rest, 1e-2).solve(1e-9, &[]).unwrap_or([0.0; MOST]);
    let best = rest;
    for (row, a) in covariance.iter_mut().zip(moved) {
        for (place, b) in row.iter_mut().zip(moved) {
            *place += a * b;
        }
    }
    let rms = libm::sqrt(best.squares / count as f64);
    Some(Fitted {
        shape,
        times,
        linear: best.linear,
        rows: count,
        squares: best.squares,
        rms,
        colour,
        covariance,
    })
}

/// For each row the error of the converter that it shares with all rows at the end, 0 for those that still move.
fn at_rest(rows: &Rows<'_>, trial: &Trial) -> Vec<f64> {
    let noise = &rows.record.noise;
    let x = &trial.columns.0;
    let end = x.last().copied().unwrap_or(1.0);
    let still = |x: &f64| ((end - x) * trial.linear[1]).abs() < 0.5 * noise.quantisation;
    let from = x.iter().rposition(|x| !still(x)).map_or(0, |last| last + 1);
    let error = noise.steady_quantisation();
    (0..x.len()).map(|i| if i >= from { error } else { 0.0 }).collect()
}

impl Fitted {
    /// All parameters, the linear ones first.
    fn parameters(&self) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        let linear = self.shape.linear();
        all[..linear].copy_from_slice(&self.linear[..linear]);
        all[linear..self.shape.parameters()].copy_from_slice(&self.times[..self.shape.times()]);
        all
    }

    /// Eq. (5) for the fitted function, in the scale of the record.
    pub(super) fn areas(&self) -> Six {
        areas_of(self.shape, &self.parameters())
    }

    /// The covariance of the areas.
    pub(super) fn area_covariance(&self) -> [Six; COUNT] {
        let at = self.parameters();
        let count = self.shape.parameters();
        let scale = at[self.shape.linear()] + at[self.shape.linear() + 1] + 1e-6;
        let slopes: Vec<Six> = (0..count)
            .map(|j| {
                let squared = j >= self.shape.linear() && matches!(j - self.shape.linear(), 2 | 4);
                let unit = if j < self.shape.linear() { at[1].abs() } else { scale };
                let step = 1e-5 * if squared { unit * unit } else { unit };
                let (mut up, mut down) = (at, at);
                up[j] += step;
                down[j] -= step;
                let (a, b) = (areas_of(self.shape, &up), areas_of(self.shape, &down));
                core::array::from_fn(|k| (a[k] - b[k]) / (2.0 * step))
            })
            .collect();
        core::array::from_fn(|k| {
            core::array::from_fn(|l| {
                let mut sum = 0.0;
                for i in 0..count {
                    for j in 0..count {
                        sum += slopes[i][k] * self.covariance[i][j] * slopes[j][l];
                    }
                }
                sum
            })
        })
    }

    /// Coefficients of the expanded denominator, from `s` on.
    pub(super) fn denominator(&self) -> [f64; 4] {
        let [a, b] = lags(self.shape, &self.times);
        [a.a1 + b.a1, a.a2 + b.a2 + a.a1 * b.a1, a.a1 * b.a2 + a.a2 * b.a1, a.a2 * b.a2]
    }

    /// The slowest time constant.
    pub(super) fn slowest(&self) -> f64 {
        let of = |lag: &Lag| {
            let square = lag.a1 * lag.a1 - 4.0 * lag.a2;
            if square >= 0.0 { 0.5 * (lag.a1 + libm::sqrt(square)) } else { 2.0 * lag.a2 / lag.a1.max(1e-12) }
        };
        lags(self.shape, &self.times).iter().map(of).fold(0.0, f64::max)
    }

    /// The fitted output and the share of the change that is still to come, at the instants `times` of the record.
    pub(super) fn simulate(&self, record: &Record, times: &[f64]) -> Vec<f64> {
        let mut chain = Chain::new(&lags(self.shape, &self.times));
        let (x, slope) = chain.response(times, &record.moves, self.times[0]);
        let [offset, gain, lead] = self.linear;
        x.iter().zip(slope).map(|(x, d)| offset + gain * x + lead * d).collect()
    }
}

fn areas_of(shape: Shape, at: &[f64; MOST]) -> Six {
    let linear = shape.linear();
    let (gain, lead) = (at[1], if shape.zero { at[2] } else { 0.0 });
    let mut times = [0.0; MOST_TIMES];
    times[..shape.times()].copy_from_slice(&at[linear..shape.parameters()]);
    // Series of G(-s): signs as in the areas.
    let mut series = [0.0; COUNT];
    let mut term = 1.0;
    for (k, place) in series.iter_mut().enumerate() {
        let next = if k == 0 { 1.0 } else { term * times[0] / k as f64 };
        *place = gain * next - if k == 0 { 0.0 } else { lead * term };
        term = next;
    }
    for lag in lags(shape, &times) {
        for k in 1..COUNT {
            series[k] += lag.a1 * series[k - 1] - if k > 1 { lag.a2 * series[k - 2] } else { 0.0 };
        }
    }
    series
}
