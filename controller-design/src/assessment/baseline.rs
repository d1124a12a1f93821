//! The loop at rest before the step, and the noise.

use core::ops::Range;
use std::vec::Vec;

use super::locate::Parts;
use super::reason::Reason;
use super::record::{Record, mean, median};
use super::smoothing::Signal;

/// Fewest samples before the step.
pub(super) const FEWEST: usize = 10;
/// Largest drift of the measurement in a peak time, in first peaks.
const DRIFT: f64 = 0.03;
/// Largest drift of the output in a peak time, in steps.
const OUTPUT_DRIFT: f64 = 0.2;
/// Largest swing of the smoothed measurement, in first peaks.
const SWING: f64 = 0.06;
/// Largest distance from the set-point, in first peaks.
const AWAY: f64 = 0.1;
/// From the median of the sizes of a Gaussian variable to its standard deviation.
const GAUSSIAN: f64 = 0.6745;

/// The stretch before the step that everything is counted from.
#[derive(Debug, Clone)]
pub(super) struct Baseline {
    pub(super) range: Range<usize>,
    pub(super) pv: f64,
    pub(super) co: f64,
}

impl Baseline {
    /// The samples of the last `length` \[s\] before the step, at least [`FEWEST`].
    pub(super) fn new(record: &Record, parts: &Parts, length: f64) -> Result<Self, Reason> {
        let step = parts.step;
        let since = record.t[step] - length;
        let from = record.t.partition_point(|&t| t < since).min(step.saturating_sub(FEWEST)).max(parts.begin);
        let range = from..step;
        if range.len() < FEWEST {
            return Err(Reason::ShortBefore(range.len()));
        }
        let (pv, co) = (mean(&record.pv[range.clone()]), mean(&record.co[range.clone()]));
        Ok(Self { range, pv, co })
    }

    /// Whether the loop was at rest at its set-point: `p1`, `t1` of the first peak, `sigma` of the noise, `ss` of the
    /// noise after smoothing over `half_width`.
    pub(super) fn check(
        &self,
        record: &Record,
        peak: (f64, f64),
        noise: (f64, f64, f64),
    ) -> Result<(), Reason> {
        let ((p1, t1), (sigma, ss, half_width)) = (peak, noise);
        let range = self.range.clone();
        let t = &record.t[range.clone()];
        let (slope, error) = slope(t, &record.pv[range.clone()]);
        if slope.abs() * t1 > (DRIFT * p1).max(4.0 * error * t1) {
            return Err(Reason::NotSteady);
        }
        let swing = self.smoothed(record, half_width).fold(0.0_f64, |swing, y| swing.max(y.abs()));
        if swing > (SWING * p1).max(4.0 * ss) {
            return Err(Reason::NotSteady);
        }
        let step = (record.co[range.end] - self.co).abs();
        let (slope, error) = self::slope(t, &record.co[range.clone()]);
        if slope.abs() * t1 > (OUTPUT_DRIFT * step).max(4.0 * error * t1) {
            return Err(Reason::NotSteady);
        }
        let away = (self.pv - mean(&record.sp[range.clone()])).abs();
        if record.has_setpoint && away > AWAY * p1 + 4.0 * sigma / libm::sqrt(range.len() as f64) {
            return Err(Reason::NotAtSetpoint(away / p1));
        }
        Ok(())
    }

    /// The smoothed deviations where the window of smoothing is full.
    pub(super) fn smoothed<'a>(
        &'a self,
        record: &'a Record,
        half_width: f64,
    ) -> impl Iterator<Item = f64> + 'a {
        let (t, y) = (&record.t[self.range.clone()], &record.pv[self.range.clone()]);
        let ends = (t[0] + half_width, t[t.len() - 1] - half_width);
        let stride = t.len().div_ceil(1000);
        let inside = t.iter().step_by(stride).filter(move |t| **t >= ends.0 && **t <= ends.1);
        inside.map(move |&centre| Signal { t, y }.fit(centre, half_width).value - self.pv)
    }
}

/// Slope of the least-squares line, and its standard error for independent residuals.
fn slope(t: &[f64], y: &[f64]) -> (f64, f64) {
    let (mid, level) = (mean(t), mean(y));
    let (mut tt, mut ty) = (0.0, 0.0);
    for (t, y) in t.iter().zip(y) {
        tt += (t - mid) * (t - mid);
        ty += (t - mid) * (y - level);
    }
    let slope = ty / tt;
    let rest: f64 = t.iter().zip(y).map(|(t, y)| y - level - slope * (t - mid)).map(|r| r * r).sum();
    (slope, libm::sqrt(rest / tt / (t.len() as f64 - 2.0)))
}

/// Standard deviation of the noise of a sample, and the resolution: the smallest difference of two samples in a row.
///
/// Median of the first differences over 0.954; that of the second ones where it is smaller, because there a response that
/// is sampled coarsely cancels. Never less than the rounding to the resolution makes.
pub(super) fn noise(t: &[f64], y: &[f64]) -> (f64, f64) {
    let mut first: Vec<f64> = y.windows(2).map(|y| (y[1] - y[0]).abs()).collect();
    let finest = first.iter().copied().filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    let resolution = if finest.is_finite() { finest } else { 0.0 };
    let mut second: Vec<f64> = t
        .windows(3)
        .zip(y.windows(3))
        .map(|(t, y)| {
            let w = (t[1] - t[0]) / (t[2] - t[0]);
            let away = y[1] - (y[0] + w * (y[2] - y[0]));
            (away / libm::sqrt(1.0 + w * w + (1.0 - w) * (1.0 - w))).abs()
        })
        .collect();
    let first = median(&mut first) / (GAUSSIAN * core::f64::consts::SQRT_2);
    let second = median(&mut second) / GAUSSIAN;
    (first.min(second).max(resolution / libm::sqrt(12.0)), resolution)
}
