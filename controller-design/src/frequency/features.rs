//! Where a frequency response has features: from time constants, resonances and dead time to a grid.

use std::vec::Vec;

use crate::model::{Complex, TransferFunction};

/// Damping ratio below which a pair of roots gets points of its own.
const LIGHT: f64 = 0.5;
/// Least damping ratio a cluster of points resolves.
const LEAST_DAMPING: f64 = 1e-7;
/// Points on either side of a resonance.
const SIDE: i32 = 24;
/// Most points of one list.
pub(crate) const MAX_POINTS: usize = 60_000;

/// The times and resonances of everything in a loop.
#[derive(Debug, Clone, Default)]
pub(crate) struct Features {
    shortest: Option<f64>,
    sum: f64,
    delay: f64,
    /// Frequency in rad/s and damping ratio.
    resonances: Vec<(f64, f64)>,
}

impl Features {
    pub(crate) fn of(plant: &TransferFunction) -> Self {
        let mut features = Self::default();
        for root in plant.poles().into_iter().chain(plant.zeros()) {
            features.root(root);
        }
        features.delay(plant.dead_time());
        features
    }

    /// A time constant in s; what is not a positive finite number is no feature.
    pub(crate) fn time(&mut self, time: f64) {
        if time > 0.0 && time.is_finite() && (1.0 / time).is_finite() {
            self.shortest = Some(self.shortest.map_or(time, |shortest| shortest.min(time)));
            self.sum += time;
        }
    }

    /// A pole or zero in rad/s.
    pub(crate) fn root(&mut self, root: Complex) {
        let size = root.abs();
        self.time(1.0 / size);
        if root.im > 0.0 && root.re.abs() < LIGHT * size && size.is_finite() {
            self.resonances.push((size, (root.re / size).abs().max(LEAST_DAMPING)));
        }
    }

    /// A dead time in s; the longest one says how fast phases turn.
    pub(crate) fn delay(&mut self, time: f64) {
        self.time(time);
        self.delay = self.delay.max(time);
    }

    /// The longest dead time in s.
    pub(crate) fn longest_delay(&self) -> f64 {
        self.delay
    }

    /// From well below the slowest to well above the fastest feature, in rad/s; `None` without any.
    pub(crate) fn range(&self) -> Option<(f64, f64)> {
        let (low, high) = (1e-4 / self.sum, 300.0 / self.shortest?);
        (low > 0.0 && high.is_finite()).then_some((low, high))
    }

    /// Logarithmic points from `low` to `high`, `per_decade` of them in each decade, and clusters around the
    /// resonances; ascending, without doubles.
    pub(crate) fn logarithmic(&self, low: f64, high: f64, per_decade: u32) -> Vec<f64> {
        let mut points = Vec::new();
        let ratio = libm::exp(core::f64::consts::LN_10 / f64::from(per_decade.max(1)));
        let mut omega = low;
        while omega < high && points.len() < MAX_POINTS {
            points.push(omega);
            omega *= ratio;
        }
        points.push(high);
        for &(center, damping) in &self.resonances {
            for k in -SIDE..=SIDE {
                // Dense at the resonance, out to 30 half-widths.
                let offset = libm::sinh(f64::from(k) * (4.1 / f64::from(SIDE)));
                let omega = center * (1.0 + damping * offset);
                if omega > low && omega < high {
                    points.push(omega);
                }
            }
        }
        ascending(points)
    }

    /// Points at which the phase of the longest dead time has turned by another `step` rad, strictly between
    /// `low` and `high`; at most [`MAX_POINTS`].
    pub(crate) fn turning(&self, low: f64, high: f64, step: f64) -> Vec<f64> {
        let width = step / self.delay;
        let mut points = Vec::new();
        if !(self.delay > 0.0 && width > 0.0 && width.is_finite()) {
            return points;
        }
        let mut k = libm::floor(low / width) + 1.0;
        while k * width < high && points.len() < MAX_POINTS {
            points.push(k * width);
            k += 1.0;
        }
        points
    }
}

/// Sorted, each point once.
pub(crate) fn ascending(mut points: Vec<f64>) -> Vec<f64> {
    points.sort_by(f64::total_cmp);
    points.dedup();
    points
}
