//! Whether and when the output has come to rest.

use super::record::{Record, mean, tail_rows};
use super::structures::Fits;
use crate::{Refusal, Warning, Warnings};

/// Share of the change that may still be to come at the end, and the share from which that is said.
const MOST_UNSETTLED: f64 = 0.05;
const UNSETTLED: f64 = 0.01;
/// Of an output that keeps its rate: largest relative change of the rate from the third to the last quarter of the record.
/// A lag changes it by more unless it is more than twice as long as the record.
const SAME_RATE: f64 = 0.1;
/// Largest uncertainty of that change, three standard deviations, relative to the rate.
const UNSURE: f64 = 0.3;
/// And least share of the whole change, 1 in the scale of the record, that it makes in half the time at that rate.
const STILL_MOVES: f64 = 0.3;

/// When the output has come to rest, and what is still to come at the end.
pub(super) struct Settling {
    /// In the time of the record.
    pub(super) at: f64,
    /// The row, among those after the change.
    pub(super) row: usize,
    left: f64,
    /// The output goes on at a constant rate.
    is_ramp: bool,
}

impl Settling {
    pub(super) fn new(record: &Record, fits: Option<&Fits>) -> Self {
        let (t, u, y) = record.after();
        let tail = tail_rows(t, 0.1);
        let from = t.len() - tail;
        // Two halves of the end: what an output that creeps on, or an input, still does.
        let earlier = from.saturating_sub(tail);
        let drift = |list: &[f64]| {
            let (a, b) = (mean(&list[earlier..from]), mean(&list[from..]));
            ((b - a).abs() - 4.0 * libm::sqrt(2.0 * record.noise.of_mean(tail)), b)
        };
        let ((y_drift, y_end), (u_drift, _)) = (drift(y), drift(u));
        let mut left = y_drift.max(u_drift).max(0.0) / 1.5;
        let simulated = fits.map(|fits| {
            let best = &fits.best;
            let mut instants = t.to_vec();
            instants.push(1.0 + best.times[0] + 60.0 * best.slowest());
            let mut all = best.simulate(record, &instants);
            let rest = all.pop().unwrap_or(y_end);
            left = left.max((rest - all[all.len() - 1]).abs() / (rest - best.linear[0]).abs());
            (all, rest)
        });
        let (values, rest) = simulated.unwrap_or_else(|| (y.to_vec(), y_end));
        let band = 0.02 * rest.abs().max(1e-300);
        let row = values.iter().rposition(|y| (y - rest).abs() > band).map_or(0, |last| last + 1);
        let row = row.min(t.len() - 1);
        Self { at: t[row], row, left: if left.is_finite() { left } else { 1.0 }, is_ramp: is_ramp(record) }
    }

    pub(super) fn check(&self, warnings: &mut Warnings) -> Result<(), Refusal> {
        if self.is_ramp {
            return Err(Refusal::Data {
                why: "the output keeps moving at a constant rate after the change of the input: the process integrates, or \
                      the record is far too short",
                help: "of an integrating process read the rate K (change of the slope per unit of input) and the dead time L \
                       off the record and design for the plant \"K*exp(-L*s)/s\"; of a slow one record several times longer",
            });
        }
        if self.left > MOST_UNSETTLED {
            return Err(Refusal::Data {
                why: "the record ends before the output is at rest",
                help: "record longer: until input and output have stayed where they end for a while",
            });
        }
        if self.left > UNSETTLED {
            let value = 100.0 * self.left;
            let text = "per cent of the change are still to come at the end of the record";
            let _ = warnings.push(Warning::Value { about: "settled", value, text });
        }
        Ok(())
    }
}

/// Whether the output of the second half goes on at one rate while the input stands still.
fn is_ramp(record: &Record) -> bool {
    let (t, u, y) = record.after();
    let (middle, late) = (t.partition_point(|t| *t < 0.5), t.partition_point(|t| *t < 0.75));
    let still = u[middle..].iter().all(|u| (u - 1.0).abs() <= 0.02);
    if !still || late - middle < 5 || t.len() - late < 5 {
        return false;
    }
    let (third, last) = (line(&t[middle..late], &y[middle..late]), line(&t[late..], &y[late..]));
    let (size, apart) = (third.slope.abs().max(last.slope.abs()), (third.slope - last.slope).abs());
    let unsure =
        3.0 * record.noise.sigma * libm::sqrt(record.noise.colour * (third.variance + last.variance));
    third.slope * last.slope > 0.0
        && apart <= SAME_RATE * size + unsure
        && unsure <= UNSURE * size
        && 0.5 * size >= STILL_MOVES
}

/// The least-squares line.
struct Line {
    slope: f64,
    /// Of the slope, for a variance of 1 of each row.
    variance: f64,
}

fn line(t: &[f64], y: &[f64]) -> Line {
    let (mid, level) = (mean(t), mean(y));
    let spread: f64 = t.iter().map(|t| (t - mid) * (t - mid)).sum();
    let product: f64 = t.iter().zip(y).map(|(t, y)| (t - mid) * (y - level)).sum();
    Line { slope: product / spread, variance: 1.0 / spread }
}
