//! The frequencies at which a sampled loop is looked at, and what they say about its stability.

use core::f64::consts::PI;
use std::vec::Vec;

use super::sampled::{DiscreteLoop, LoopResponse};
use crate::frequency::maximum;
use crate::model::Complex;

/// Points in each decade before anything is refined.
const PER_DECADE: f64 = 60.0;
/// Most points that long delays get, and most that any loop gets: what has more is not followed, and has no margins.
const MOST_TURNS: usize = 200_000;
const MOST: usize = 400_000;
/// Largest turn of the characteristic function, and largest relative change of a response, between neighbours \[rad\].
const TURN: f64 = 0.4;
/// Largest turn of a delay between neighbours \[rad\], where the loop gain is more than `QUIET`.
const DELAY_TURN: f64 = 0.4;
const QUIET: f64 = 0.02;
/// The last angle below pi: there the responses are not yet real.
const NEARLY_PI: f64 = PI * (1.0 - 1e-7);

/// A loop at the angles that show all its features, ascending, the last one pi.
pub(super) struct Sweep {
    pub(super) points: Vec<LoopResponse>,
    directions: Vec<Complex>,
    /// Whether there was more to follow than points for it.
    pub(super) is_cut: bool,
}

impl Sweep {
    pub(super) fn of(held: &DiscreteLoop) -> Self {
        let (gains, law_delay) = held.law().lags();
        let samples = (held.held().delay().max(law_delay) + 2) as f64;
        let lags = gains.iter().map(|g| 1.0 / g);
        let poles = held.held().scaled_poles();
        let zeros = held.plant().zeros();
        let slow = poles.iter().copied().chain(zeros.iter().map(|&s| s * held.ts()));
        let times = slow.filter(|p| p.abs() > 0.0).map(|p| 1.0 / p.abs());
        let longest: f64 = lags.chain(times).filter(|t| t.is_finite()).sum::<f64>() + samples;
        let low = lowest(held, (1e-4 / longest).max(1e-250));

        let mut angles = Vec::new();
        let ratio = libm::exp(core::f64::consts::LN_10 / PER_DECADE);
        let mut theta = low;
        while theta < NEARLY_PI && angles.len() < MOST {
            angles.push(theta);
            theta *= ratio;
        }
        // Linear near the end, where a decade is wide.
        angles.extend((1..200).map(|k| NEARLY_PI * f64::from(k) / 200.0));
        for pole in poles {
            around_resonance(*pole, low, &mut angles);
        }
        angles.push(NEARLY_PI);
        angles.push(PI);
        angles.sort_by(f64::total_cmp);
        angles.dedup();

        let mut sweep = Self { points: Vec::new(), directions: Vec::new(), is_cut: false };
        let mut turns = 0;
        let mut last: Option<LoopResponse> = None;
        for theta in angles {
            let point = held.at(theta);
            if let Some(before) = last {
                let loud = loudness(&before).max(loudness(&point)) > QUIET;
                let parts = libm::ceil((theta - before.theta) * samples / DELAY_TURN);
                if loud && parts > 1.0 {
                    let step = (theta - before.theta) / parts;
                    let mut k = 1.0;
                    while k < parts {
                        if turns >= MOST_TURNS || sweep.is_cut {
                            sweep.is_cut = true;
                            return sweep;
                        }
                        sweep.reach(held, held.at(before.theta + k * step));
                        k += 1.0;
                        turns += 1;
                    }
                }
            }
            sweep.reach(held, point);
            if sweep.is_cut {
                return sweep;
            }
            last = Some(point);
        }
        sweep
    }

    /// Adds `point`, and others before it while the responses turn too far from the last one to it.
    fn reach(&mut self, held: &DiscreteLoop, point: LoopResponse) {
        let mut waiting = Vec::from([point]);
        while let Some(&next) = waiting.last() {
            let direction = held.characteristic(&next);
            if let (Some(last), Some(&from)) = (self.points.last(), self.directions.last()) {
                let turned = angle(direction, from).abs() > TURN || moved(last, &next);
                let wide = next.theta - last.theta > 1e-9 * last.theta;
                if turned && wide && waiting.len() < 48 {
                    if self.points.len() >= MOST {
                        self.is_cut = true;
                        return;
                    }
                    waiting.push(held.at(0.5 * (last.theta + next.theta)));
                    continue;
                }
            }
            self.points.push(next);
            self.directions.push(direction);
            waiting.pop();
        }
    }

    /// Zeros of the characteristic function outside the unit circle or on it: minus the turns of its values there.
    pub(super) fn unstable_poles(&self) -> usize {
        if self.is_cut {
            return 1;
        }
        let turned: f64 =
            self.directions.iter().zip(self.directions.iter().skip(1)).map(|(&a, &b)| angle(b, a)).sum();
        if !turned.is_finite() {
            return 1;
        }
        // The lower half circle mirrors the upper one: a half turn here is a whole one.
        let turns = -turned / PI;
        let whole = libm::round(turns);
        if (turns - whole).abs() > 0.25 {
            return libm::ceil(turns).max(1.0) as usize;
        }
        whole.max(0.0) as usize
    }

    /// Where `value` is largest, and how large.
    pub(super) fn peak(&self, held: &DiscreteLoop, value: impl Fn(&LoopResponse) -> f64) -> (f64, f64) {
        let values: Vec<f64> = self.points.iter().map(&value).collect();
        let theta = |i: usize| self.points.get(i).map_or(PI, |p| p.theta);
        let at = |i: usize| values.get(i).copied().unwrap_or(f64::NEG_INFINITY);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut best = (theta(0), at(0));
        for i in 0..values.len() {
            if at(i) > best.1 {
                best = (theta(i), at(i));
            }
            let inside = i > 0 && i + 1 < values.len();
            // Between points 0.4 rad apart a peak is at most some per cent above them.
            if inside && at(i) >= at(i - 1) && at(i) >= at(i + 1) && at(i) > 0.8 * largest {
                let found = maximum(|t| value(&held.at(t)), theta(i - 1), theta(i + 1), theta(i));
                if found.1 > best.1 {
                    best = found;
                }
            }
        }
        best
    }
}

/// How much the feedback could do at most at this frequency.
fn loudness(p: &LoopResponse) -> f64 {
    (p.plant * p.feedback).abs() + (Complex::ONE - p.own).abs()
}

/// Whether sensitivity or loop gain changed by too much for a straight line between them.
fn moved(a: &LoopResponse, b: &LoopResponse) -> bool {
    let far = |x: Complex, y: Complex| (x - y).abs() > TURN * x.abs().max(y.abs());
    let counts = loudness(a).max(loudness(b)) > QUIET;
    counts && (far(a.denominator(), b.denominator()) || far(a.open(), b.open()))
}

/// The angle from `b` to `a`.
pub(super) fn angle(a: Complex, b: Complex) -> f64 {
    (a * b.conj()).arg()
}

/// Down from `low` until the loop gain is large, or constant.
fn lowest(held: &DiscreteLoop, low: f64) -> f64 {
    let mut theta = low;
    for _ in 0..200 {
        let (here, below) = (held.at(theta).open(), held.at(0.1 * theta).open());
        let settled = (here - below).abs() <= 1e-6 * here.abs();
        if here.abs() > 1e4 || settled || !here.is_finite() || theta < 1e-250 {
            break;
        }
        theta *= 0.1;
    }
    theta
}

/// Points around a lightly damped pole, dense at its frequency, which may be folded down by sampling.
fn around_resonance(pole: Complex, low: f64, angles: &mut Vec<f64>) {
    if !(pole.im > 0.0 && pole.re.abs() < 0.5 * pole.abs()) {
        return;
    }
    let turns = libm::floor(pole.im / (2.0 * PI) + 0.5);
    let center = (pole.im - 2.0 * PI * turns).abs();
    let half_width = pole.re.abs().max(1e-7 * center);
    for k in -24..=24 {
        let theta = center + half_width * libm::sinh(f64::from(k) * (4.1 / 24.0));
        if theta > low && theta < NEARLY_PI {
            angles.push(theta);
        }
    }
}
