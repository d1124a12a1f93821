//! The peaks of the response.

use core::ops::Range;
use std::vec::Vec;

use super::baseline::{Baseline, noise};
use super::judge::{MOST_NOISE, Shape};
use super::locate::Parts;
use super::reason::Reason;
use super::record::Record;
use super::smoothing::{Curve, Signal};
use super::{Assessment, Features, Marks, Place};
use crate::warning::Warning;

/// Half width of the smoothing, in peak times.
const HALF_WIDTH: f64 = 0.1;
/// Half width of the first smoothing, before a peak time is known: share of the record after the step.
const FIRST_WIDTH: f64 = 0.005;
/// Part of the record after the step in which the first peak is.
const FIRST_PART: f64 = 0.6;
/// What is looked at after the step, in peak times: the dip and the rise after it, all.
const DIP_WITHIN: f64 = 6.0;
const ALL_WITHIN: f64 = 12.0;
/// Least rise after a dip, in first peaks and in standard deviations of the smoothed noise.
const RISE: f64 = 0.02;
const RISE_NOISE: f64 = 4.0;
/// A dip is marked from this depth on, in standard deviations of a sample.
const VISIBLE: f64 = 2.0;
/// Shortest record after the step, in peak times.
const SHORTEST: f64 = 4.0;
/// Fewest samples until the first peak, and from how many on the times are good.
const FEWEST: usize = 10;
const ENOUGH: usize = 25;
/// Longest gap until the third peak, in peak times.
const GAP: f64 = 0.25;
/// Largest deviation at the return to automatic, in first peaks, and from where on the peak is too high by some percent.
const LATE: f64 = 0.2;
const SOON: f64 = 0.05;
/// A response this much smaller than what was there before is none: squares would overflow.
const LARGEST: f64 = 1e100;
/// A swing counts from this share of the largest one.
const SWING: f64 = 0.3;
/// A measurement is settled within this share of the first peak; the output is back within this share of the step.
const SETTLED: f64 = 0.1;
const BACK: f64 = 0.25;

/// Measures the response. What is known goes into `out`, also when a reason ends it.
pub(super) fn measure(record: &Record, out: &mut Assessment) -> Result<Shape, Reason> {
    let (record, parts) = record.cut(record.parts()?);
    let record = &record;
    let t0 = record.t[parts.step];
    let mut marks = Marks {
        step: t0,
        auto: parts.auto.map(|k| record.t[k]),
        span: (record.t[parts.begin], record.t[parts.end - 1]),
        baseline: record.pv[parts.step - 1],
        inputs: (record.co[parts.step - 1], record.co[parts.step]),
        peak: None,
        dip: None,
        third: None,
        smoothed: Vec::new(),
    };
    out.marks = Some(marks.clone());
    let length = record.t[parts.end - 1] - t0;
    let rough = Baseline::new(record, &parts, 0.05 * length)?;
    (marks.baseline, marks.inputs.0) = (rough.pv, rough.co);
    out.marks = Some(marks.clone());
    let view = View::new(record, &parts, rough.pv).ok_or(Reason::NoResponse)?;
    let (first, oscillates) = view.first_peak();
    let t1 = first.t - t0;
    if t1 <= 0.0 {
        let is_late = view.z[parts.end - 1].abs() > 0.5;
        let short = parts.ended_by.unwrap_or(Reason::RecordShort(1.0));
        return Err(if is_late { short } else { Reason::NoResponse });
    }
    let baseline = Baseline::new(record, &parts, 2.0 * t1)?;
    let view = View::new(record, &parts, baseline.pv).ok_or(Reason::NoResponse)?;
    let half_width = HALF_WIDTH * t1;

    // Everything below is in first peaks, upwards.
    let end = record.t.partition_point(|&t| t <= t0 + ALL_WITHIN * t1).min(parts.end);
    let curve = view.signal().smooth(baseline.range.start..end, half_width);
    let near = curve.index(first.t - half_width)..curve.index(first.t + half_width).max(1);
    let top = extreme(&curve, near, |y| y * first.sign).unwrap_or(0);
    let (t_peak, y_peak) = curve.vertex(top);
    let (t1, y1) = (t_peak - t0, y_peak.abs());
    let p1 = y1 * view.scale;
    let place = |(t, y): (f64, f64)| Place { t, y: view.level + view.scale * y };
    marks.baseline = baseline.pv;
    marks.inputs.0 = baseline.co;
    marks.span = (record.t[baseline.range.start], record.t[end - 1]);
    // Noise can put the top of the smoothed curve before the step.
    let after = t1 > 0.0;
    marks.peak = after.then(|| place((t_peak, y_peak)));
    marks.smoothed = curve.t.iter().zip(&curve.y).map(|(&t, &y)| place((t, y))).collect();
    out.marks = Some(marks.clone());

    let all = baseline.range.start..end;
    let (sigma, resolution) = noise(&record.t[all.clone()], &record.pv[all]);
    let white = sigma * libm::sqrt(view.signal().fit(t_peak, half_width).variance);
    let mut features = Features { p1, t1, dip: None, t_ratio: None, r3: None, sigma };
    out.features = after.then_some(features);
    let last = record.t[parts.end - 1];
    let still = view.signal().fit(last, half_width).value.abs() * view.scale;
    if still > (2.0 * p1).max(RISE_NOISE * white) && !oscillates {
        // It is on its way to its first peak.
        return Err(parts.ended_by.unwrap_or(Reason::RecordShort(1.0)));
    }
    if !after || p1 <= RISE_NOISE * white {
        return Err(Reason::NoResponse);
    }
    if RISE_NOISE * white > MOST_NOISE * p1 {
        return Err(Reason::Noise(RISE_NOISE * white / p1));
    }
    if resolution > MOST_NOISE * p1 {
        return Err(Reason::Resolution(resolution / p1));
    }
    baseline.check(record, (p1, t1), (sigma, white, half_width))?;
    // Noise that is no white noise is seen at rest.
    let ss = white.max(rms(baseline.smoothed(record, half_width)));
    let auto = parts.auto.ok_or(Reason::NeverAuto)?;
    check_samples(record, &parts, (t0, t1), oscillates, out)?;
    check_auto(auto, &view, record, (y1, half_width), out)?;

    let level = |y: f64| y * first.sign / y1;
    let least = RISE.max(RISE_NOISE * ss / p1);
    let dip = find_dip(&curve, top, t0 + DIP_WITHIN * t1, level, least);
    let tail = top..curve.t.len();
    let lowest = extreme(&curve, tail, |y| -level(y)).map_or(0.0, |k| level(curve.y[k]));
    let dip = dip.map(|k| {
        let third = extreme(&curve, k..curve.t.len(), level).unwrap_or(k);
        (curve.vertex(k), curve.vertex(third))
    });
    if let Some((low, high)) = dip {
        // A picture that marks what no eye can see in the recorded points is not believed.
        if (level(high.1) - level(low.1)) * p1 >= VISIBLE * sigma {
            (marks.dip, marks.third) = (Some(place(low)), Some(place(high)));
        }
        out.marks = Some(marks);
        features.dip = Some(level(low.1));
        features.t_ratio = Some((low.0 - t0) / t1);
        features.r3 = Some(level(high.1));
        out.features = Some(features);
    }
    check_back(record, &baseline, auto..end, &curve, (y1, t1))?;
    let dip = dip.map(|(low, high)| (level(low.1), (low.0 - t0) / t1, level(high.1)));
    Ok(Shape { dip, lowest, oscillates, noise: RISE_NOISE * ss / p1 })
}

/// Deviations from the baseline in shares of the largest one.
struct View<'a> {
    record: &'a Record,
    z: Vec<f64>,
    step: usize,
    end: usize,
    level: f64,
    scale: f64,
}

/// The first peak, roughly.
#[derive(Debug, Clone, Copy)]
struct Peak {
    t: f64,
    sign: f64,
}

impl<'a> View<'a> {
    fn new(record: &'a Record, parts: &Parts, level: f64) -> Option<Self> {
        let (step, end) = (parts.step, parts.end);
        let scale = record.pv[step..end].iter().fold(0.0_f64, |scale, pv| scale.max((pv - level).abs()));
        if scale == 0.0 || end - step < 3 {
            return None;
        }
        let z: Vec<f64> = record.pv.iter().map(|pv| (pv - level) / scale).collect();
        if z.iter().any(|z| z.abs() > LARGEST) {
            return None;
        }
        Some(Self { record, z, step, end, level, scale })
    }

    fn signal(&self) -> Signal<'_> {
        Signal { t: &self.record.t, y: &self.z }
    }

    /// The largest deviation in the first part of the record; of a response that swings on and on the first swing. The
    /// smoothing is as wide as the peak time wants, which it is found with.
    fn first_peak(&self) -> (Peak, bool) {
        let t = &self.record.t;
        let (t0, last) = (t[self.step], t[self.end - 1]);
        let mut until = t.partition_point(|&t| t <= t0 + FIRST_PART * (last - t0)).min(self.end);
        let mut half_width = FIRST_WIDTH * (last - t0);
        let curve = self.signal().smooth(self.step..self.end, half_width);
        let lobes = lobes(&curve, curve.index(t[until - 1]));
        let oscillates = lobes.len() >= 3;
        if oscillates {
            until = t.partition_point(|&t| t < lobes[1]).clamp(self.step + 3, self.end);
        }
        let mut peak = Peak { t: t0, sign: 1.0 };
        for _ in 0..8 {
            let curve = self.signal().smooth(self.step..until, half_width);
            let k = extreme(&curve, 0..curve.t.len(), f64::abs).unwrap_or(0);
            let found = Peak { t: curve.vertex(k).0, sign: if curve.y[k] < 0.0 { -1.0 } else { 1.0 } };
            let moved = (found.t - peak.t).abs();
            peak = found;
            half_width = HALF_WIDTH * (peak.t - t0);
            if moved <= 1e-3 * (peak.t - t0) {
                break;
            }
        }
        (peak, oscillates)
    }
}

/// Where the swings begin that are a comparable part of the largest one before the point `until`, in turn up and down.
fn lobes(curve: &Curve, until: usize) -> Vec<f64> {
    let largest = curve.y[..=until.min(curve.y.len() - 1)].iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    let (mut begins, mut sign) = (Vec::new(), 0.0);
    for (&t, &y) in curve.t.iter().zip(&curve.y) {
        if y.abs() >= SWING * largest && y * sign <= 0.0 && y != 0.0 {
            sign = y;
            begins.push(t);
        }
    }
    begins
}

/// The point where `of` its value is largest; of several the first.
fn extreme(curve: &Curve, range: Range<usize>, of: impl Fn(f64) -> f64) -> Option<usize> {
    let range = range.start..range.end.min(curve.y.len());
    let mut best: Option<(usize, f64)> = None;
    for k in range {
        let value = of(curve.y[k]);
        if best.is_none_or(|(_, most)| value > most) {
            best = Some((k, value));
        }
    }
    best.map(|(k, _)| k)
}

/// The first minimum after the peak that a rise by `least` follows.
fn find_dip(curve: &Curve, top: usize, until: f64, level: impl Fn(f64) -> f64, least: f64) -> Option<usize> {
    let (mut lowest, mut at) = (f64::INFINITY, top);
    for k in top..curve.index(until) {
        let y = level(curve.y[k]);
        if y < lowest {
            (lowest, at) = (y, k);
        } else if y - lowest >= least {
            return Some(at);
        }
    }
    None
}

fn rms(list: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = list.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
    if count > 0.0 { libm::sqrt(sum / count) } else { 0.0 }
}

/// Whether the controller took over before the measurement went away.
fn check_auto(
    auto: usize,
    view: &View<'_>,
    record: &Record,
    (y1, half_width): (f64, f64),
    out: &mut Assessment,
) -> Result<(), Reason> {
    let gone = view.signal().fit(record.t[auto], half_width).value.abs() / y1;
    if gone > LATE {
        return Err(Reason::AutoTooLate(gone));
    }
    if gone > SOON {
        let text = "of the first peak were gone at the return to automatic: the peak is somewhat too high";
        let _ = out.warnings.push(Warning::Value { about: "share", value: gone, text });
    }
    Ok(())
}

/// Whether there are enough samples where they are needed.
fn check_samples(
    record: &Record,
    parts: &Parts,
    (t0, t1): (f64, f64),
    oscillates: bool,
    out: &mut Assessment,
) -> Result<(), Reason> {
    let until = |t: f64| record.t.partition_point(|&own| own <= t).min(parts.end);
    let samples = until(t0 + t1) - parts.step - 1;
    if samples < FEWEST {
        return Err(Reason::CoarseSampling(samples));
    }
    if samples < ENOUGH {
        let text = "so many until the first peak: peaks and times are rough";
        let _ = out.warnings.push(Warning::Value { about: "samples", value: samples as f64, text });
    }
    let length = record.t[parts.end - 1] - t0;
    if length < SHORTEST * t1 && !oscillates {
        return Err(parts.ended_by.unwrap_or(Reason::RecordShort(length / t1)));
    }
    let steps = record.t[parts.step - 1..until(t0 + 3.0 * t1)].windows(2);
    let gap = steps.fold(0.0_f64, |gap, t| gap.max(t[1] - t[0]));
    if gap > GAP * t1 { Err(Reason::Gap(gap / t1)) } else { Ok(()) }
}

/// Whether the output is back where it was, once the measurement has settled.
fn check_back(
    record: &Record,
    baseline: &Baseline,
    range: Range<usize>,
    curve: &Curve,
    (y1, t1): (f64, f64),
) -> Result<(), Reason> {
    let last = record.t[range.end - 1];
    let tail = &curve.y[curve.index(last - t1)..];
    if tail.iter().any(|y| y.abs() > SETTLED * y1) {
        return Ok(());
    }
    let from = record.t.partition_point(|&t| t < last - 0.5 * t1).clamp(range.start, range.end - 1);
    let co = super::record::mean(&record.co[from..range.end]);
    let step = record.co[baseline.range.end] - baseline.co;
    let share = ((co - baseline.co) / step).abs();
    if share > BACK { Err(Reason::OutputNotBack(share)) } else { Ok(()) }
}
