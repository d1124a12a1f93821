//! Smoothing by a local quadratic over samples at any times.

use core::ops::Range;
use std::vec::Vec;

/// Fewest samples in a window: below that a quadratic is no smoothing.
const FEWEST: usize = 5;
/// Most places at which a curve is computed.
const MOST: usize = 4000;

/// A signal over rising times.
#[derive(Debug, Clone, Copy)]
pub(super) struct Signal<'a> {
    pub(super) t: &'a [f64],
    pub(super) y: &'a [f64],
}

/// A curve of smoothed values.
#[derive(Debug, Clone, Default)]
pub(super) struct Curve {
    pub(super) t: Vec<f64>,
    pub(super) y: Vec<f64>,
}

/// The quadratic at the middle of its window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub(super) value: f64,
    /// Variance of `value` for a variance of 1 of every sample.
    pub(super) variance: f64,
}

impl Signal<'_> {
    /// The curve over the samples in `range`; every so many of them when there are more than a picture can show.
    pub(super) fn smooth(&self, range: Range<usize>, half_width: f64) -> Curve {
        let stride = range.len().div_ceil(MOST).max(1);
        let mut curve = Curve::default();
        for k in range.step_by(stride) {
            curve.t.push(self.t[k]);
            curve.y.push(self.fit(self.t[k], half_width).value);
        }
        curve
    }

    /// The least-squares quadratic over the samples at most `half_width` \[s\] from `centre`, at `centre`. In polynomials
    /// that are orthogonal over the samples nothing cancels, however they lie.
    pub(super) fn fit(&self, centre: f64, half_width: f64) -> Fit {
        let window = self.window(centre, half_width);
        let (t, y) = (&self.t[window.clone()], &self.y[window]);
        let n = t.len() as f64;
        let far = t.iter().fold(0.0_f64, |far, t| far.max((t - centre).abs()));
        let scale = if far > 0.0 { far } else { 1.0 };
        let x = |t: f64| (t - centre) / scale;
        let mean = t.iter().map(|&t| x(t)).sum::<f64>() / n;
        let (mut s2, mut s3, mut b0, mut b1) = (0.0, 0.0, 0.0, 0.0);
        for (&t, &y) in t.iter().zip(y) {
            let p = x(t) - mean;
            s2 += p * p;
            s3 += p * p * p;
            b0 += y;
            b1 += y * p;
        }
        let mut fit = Fit { value: b0 / n, variance: 1.0 / n };
        if s2 < 1e-12 * n {
            return fit;
        }
        fit.value += b1 / s2 * -mean;
        fit.variance += mean * mean / s2;
        let (alpha, beta) = (s3 / s2, s2 / n);
        let (mut s4, mut b2) = (0.0, 0.0);
        let second = |p: f64| p * p - alpha * p - beta;
        for (&t, &y) in t.iter().zip(y) {
            let q = second(x(t) - mean);
            s4 += q * q;
            b2 += y * q;
        }
        if s4 > 1e-12 * n {
            let q = second(-mean);
            fit.value += b2 / s4 * q;
            fit.variance += q * q / s4;
        }
        fit
    }

    /// The samples of a window, and its nearest neighbours when they are too few.
    fn window(&self, centre: f64, half_width: f64) -> Range<usize> {
        let mut from = self.t.partition_point(|&t| t < centre - half_width);
        let mut to = self.t.partition_point(|&t| t <= centre + half_width).max(from);
        while to - from < FEWEST {
            let before = from.checked_sub(1).map(|k| centre - self.t[k]);
            let after = self.t.get(to).map(|t| t - centre);
            match (before, after) {
                (Some(b), Some(a)) if b <= a => from -= 1,
                (_, Some(_)) => to += 1,
                (Some(_), None) => from -= 1,
                (None, None) => break,
            }
        }
        from..to
    }
}

impl Curve {
    /// The vertex of the parabola through the point `k` and its neighbours: a peak between the samples.
    pub(super) fn vertex(&self, k: usize) -> (f64, f64) {
        let (t, y) = (&self.t, &self.y);
        let here = (t[k], y[k]);
        let (Some(before), true) = (k.checked_sub(1), k + 1 < t.len()) else { return here };
        let (a, b) = (t[before] - t[k], t[k + 1] - t[k]);
        let (slope_a, slope_b) = ((y[before] - y[k]) / a, (y[k + 1] - y[k]) / b);
        let curvature = (slope_b - slope_a) / (b - a);
        let slope = slope_a - curvature * a;
        let x = -slope / (2.0 * curvature);
        if x.is_finite() && (a..=b).contains(&x) { (t[k] + x, y[k] + 0.5 * slope * x) } else { here }
    }

    /// The first point at or after `t`.
    pub(super) fn index(&self, t: f64) -> usize {
        self.t.partition_point(|&own| own < t)
    }
}
