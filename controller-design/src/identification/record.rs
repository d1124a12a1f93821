//! What a recording says before any model: when the input moved, what was before, what came after, and the noise.

use super::noise::{self, Noise};
use super::response::Moves;
use super::{IdentifyOptions, Recording, too_few};
use crate::Refusal;
use std::vec::Vec;

/// Fewest rows from the change on.
const FEWEST: usize = 12;
/// Share of the rows after the change that the first look at the end takes.
const END: f64 = 0.1;

/// A recording in the scale of its change: time 0 at the change and 1 at the end, input 0 before and 1 after, output
/// 0 before and 1 after (roughly).
#[derive(Debug, Clone)]
pub(super) struct Record {
    pub(super) change_at: f64,
    /// Seconds, input and output per unit of the scaled record.
    pub(super) time: f64,
    pub(super) input: f64,
    pub(super) output: f64,
    /// The values that are 0 in the scale.
    pub(super) u0: f64,
    pub(super) y0: f64,
    /// All rows, doubled time stamps merged.
    pub(super) t: Vec<f64>,
    pub(super) u: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// The first row of those from the change on.
    pub(super) start: usize,
    /// Number of rows that show the steady state before.
    pub(super) before: usize,
    pub(super) moves: Moves,
    /// Noise of the output, in its scale.
    pub(super) noise: Noise,
}

impl Record {
    pub(super) fn new(recording: &Recording<'_>, options: &IdentifyOptions) -> Result<Self, Refusal> {
        let (time, input, output) = (recording.t, recording.u, recording.y);
        let rows = time.len();
        if input.len() != rows || output.len() != rows {
            return Err(Refusal::Data {
                why: "times, inputs and outputs are not of one length",
                help: "give one input and one output for each time",
            });
        }
        if [time, input, output].iter().any(|list| list.iter().any(|x| x.is_nan() || x.abs() > 1e150)) {
            return Err(Refusal::Data {
                why: "the recording has a value that is not a finite number of usual size",
                help: "take the bad rows out",
            });
        }
        if rows < FEWEST {
            return Err(too_few());
        }
        if time.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err(Refusal::Data { why: "the time goes back", help: "sort the rows by time" });
        }
        let change = match options.change_at {
            None => first_move(input)?,
            Some(at) => {
                time.iter().position(|t| *t >= at).filter(|i| rows - i >= FEWEST).ok_or_else(too_few)?
            }
        };
        let last = time[rows - 1];
        let span = last - time[change];
        let mut merged = Merged::default();
        for i in change..rows {
            merged.push(time[i], input[i], output[i]);
        }
        if merged.t.len() < FEWEST || span <= 0.0 {
            return Err(too_few());
        }
        // The output at the moment of the change has not yet seen it.
        let u0 = mean(&input[..change.max(1)]);
        let y0 = mean(&output[..=change]);
        let tail = tail_rows(&merged.t, END);
        let u1 = mean(&merged.u[merged.u.len() - tail..]);
        let y1 = mean(&merged.y[merged.y.len() - tail..]);
        let range = |list: &[f64]| {
            let (lo, hi) = list.iter().fold((f64::MAX, f64::MIN), |(lo, hi), x| (x.min(lo), x.max(hi)));
            hi - lo
        };
        let (du, swing) = (u1 - u0, range(input));
        if du.abs() <= 1e-3 * swing || du == 0.0 {
            return Err(Refusal::Data {
                why: "the input ends where it began",
                help: "record a change between two different steady states",
            });
        }
        let mut steady = vec![&output[..=change]];
        steady.push(&merged.y[merged.y.len() - tail..]);
        let noise = noise::estimate(&steady, output);
        let dy = y1 - y0;
        let count = |n: usize| n as f64;
        let unsure = libm::sqrt(noise.sigma * noise.sigma * (1.0 / count(change + 1) + 1.0 / count(tail)));
        if dy == 0.0 || dy.abs() <= 4.0 * unsure || dy.abs() <= 1.5 * noise.quantisation {
            return Err(Refusal::Data {
                why: "the output did not move beyond its noise",
                help: "make a larger change of the input, or check which column is the output",
            });
        }
        let mut all = Merged::default();
        for i in 0..change {
            all.push(time[i], input[i], output[i]);
        }
        // A row at the very moment of the change belongs to what follows.
        all.drop_at(time[change]);
        let start = all.t.len();
        all.append(merged);
        let scaled = |list: Vec<f64>, zero: f64, unit: f64| -> Vec<f64> {
            list.into_iter().map(|x| (x - zero) / unit).collect()
        };
        let (t, u, y) = (scaled(all.t, time[change], span), scaled(all.u, u0, du), scaled(all.y, y0, dy));
        let moves = moves(&t[start..], &u[start..]);
        Ok(Self {
            change_at: time[change],
            time: span,
            input: du,
            output: dy,
            u0,
            y0,
            t,
            u,
            y,
            start,
            before: change + 1,
            moves,
            noise: noise.in_units_of(dy.abs()),
        })
    }

    /// Times, inputs and outputs from the change on.
    pub(super) fn after(&self) -> (&[f64], &[f64], &[f64]) {
        (&self.t[self.start..], &self.u[self.start..], &self.y[self.start..])
    }
}

/// Rows with rising times: of a doubled time stamp the later row holds.
#[derive(Default)]
struct Merged {
    t: Vec<f64>,
    u: Vec<f64>,
    y: Vec<f64>,
}

impl Merged {
    fn push(&mut self, t: f64, u: f64, y: f64) {
        self.drop_at(t);
        self.t.push(t);
        self.u.push(u);
        self.y.push(y);
    }

    fn drop_at(&mut self, t: f64) {
        if self.t.last() == Some(&t) {
            self.t.pop();
            self.u.pop();
            self.y.pop();
        }
    }

    fn append(&mut self, other: Self) {
        self.t.extend(other.t);
        self.u.extend(other.u);
        self.y.extend(other.y);
    }
}

/// The first row whose input differs from what was before, beyond the noise of a controller's output.
fn first_move(input: &[f64]) -> Result<usize, Refusal> {
    let span = input.iter().map(|u| (u - input[0]).abs()).fold(0.0, f64::max);
    let tolerance = f64::max(1e-9 * span, 6.0 * noise::jitter(input));
    let mut sum = 0.0;
    for (i, u) in input.iter().enumerate() {
        let before = i as f64;
        if i > 0 && (u * before - sum).abs() > tolerance * before {
            return Ok(i);
        }
        sum += u;
    }
    Err(Refusal::Data {
        why: "the input does not change",
        help: "record from before a step of the input, or check which column is the input",
    })
}

fn moves(t: &[f64], u: &[f64]) -> Moves {
    let mut moves = Moves::default();
    let mut before = 0.0;
    for (t, u) in t.iter().zip(u) {
        if *u != before {
            moves.at.push(*t);
            moves.by.push(u - before);
            before = *u;
        }
    }
    moves
}

/// Number of rows in the last `share` of the time, at least 3.
pub(super) fn tail_rows(t: &[f64], share: f64) -> usize {
    let end = t.last().copied().unwrap_or(0.0);
    let begin = t.first().copied().unwrap_or(0.0);
    let from = end - share * (end - begin);
    let first = t.partition_point(|t| *t < from);
    (t.len() - first).clamp(3.min(t.len()), t.len())
}

pub(super) fn mean(list: &[f64]) -> f64 {
    let Some(first) = list.first() else { return 0.0 };
    // Relative to the first value: a constant keeps its exact value.
    first + list.iter().map(|x| x - first).sum::<f64>() / list.len() as f64
}
