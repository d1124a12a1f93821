//! Margins from a followed loop.

use core::f64::consts::PI;

use super::Margins;
use super::continuous::UNSTABLE;
use super::scan::{Point, Scan};
use crate::Refusal;
use crate::frequency::{crossing, maximum};

/// A sample's share of the largest one from which a peak is looked at closely.
const NEAR_PEAK: f64 = 0.85;
/// `|L|` against 1 from which an extreme might still cross 1 between two samples.
const NEAR_ONE: f64 = 0.3;

impl Scan {
    /// The largest sensitivity alone.
    pub(super) fn ms(&self, at: &dyn Fn(f64) -> Point) -> Result<f64, Refusal> {
        let mut margins = Margins::of_peaks(self.peak(at, Point::sensitivity), (0.0, 0.0));
        self.limit(&mut margins)?;
        Ok(margins.ms)
    }

    pub(super) fn margins(&self, at: &dyn Fn(f64) -> Point) -> Result<Margins, Refusal> {
        let mut margins =
            Margins::of_peaks(self.peak(at, Point::sensitivity), self.peak(at, Point::complementary));
        for pair in self.points.windows(2) {
            if let [a, b] = pair {
                self.gain_crossover(at, a, b, &mut margins);
                phase_crossover(at, a, b, &mut margins);
            }
        }
        self.grazing(at, &mut margins);
        self.limit(&mut margins)?;
        Ok(margins)
    }

    /// The largest value of a function of the loop and where it is.
    fn peak(&self, at: &dyn Fn(f64) -> Point, value: impl Fn(&Point) -> f64) -> (f64, f64) {
        let mut best = (0.0, 0.0);
        for point in &self.points {
            let size = value(point);
            if size > best.1 {
                best = (point.omega, size);
            }
        }
        let least = NEAR_PEAK * best.1;
        for triple in self.points.windows(3) {
            if let [a, b, c] = triple
                && value(b) >= least
                && value(b) >= value(a)
                && value(b) >= value(c)
            {
                let (omega, size) = maximum(|omega| value(&at(omega)), a.omega, c.omega, b.omega);
                if size > best.1 {
                    best = (omega, size);
                }
            }
        }
        best
    }

    /// Extremes of `|L|` that touch 1 between two samples.
    fn grazing(&self, at: &dyn Fn(f64) -> Point, margins: &mut Margins) {
        for triple in self.points.windows(3) {
            let [a, b, c] = triple else { continue };
            let [x, y, z] = [a, b, c].map(Point::excess);
            let sign = if y > 0.0 { -1.0 } else { 1.0 };
            let same_side = x * y > 0.0 && y * z > 0.0;
            if same_side && y.abs() < NEAR_ONE && sign * (y - x) >= 0.0 && sign * (y - z) >= 0.0 {
                let (omega, size) = maximum(|omega| sign * at(omega).excess(), a.omega, c.omega, b.omega);
                if size > 0.0 {
                    let extreme = at(omega);
                    self.gain_crossover(at, a, &extreme, margins);
                    self.gain_crossover(at, &extreme, c, margins);
                }
            }
        }
    }

    fn gain_crossover(&self, at: &dyn Fn(f64) -> Point, a: &Point, b: &Point, margins: &mut Margins) {
        if (a.excess() > 0.0) == (b.excess() > 0.0) {
            return;
        }
        let omega = crossing(|omega| at(omega).excess(), a.omega, b.omega);
        let left = (-at(omega).loop_gain()).arg();
        let degrees = left.abs() * 180.0 / PI;
        if degrees < margins.pm_deg {
            (margins.pm_deg, margins.omega_pm) = (degrees, Some(omega));
        }
        let delay = if left < 0.0 { left + 2.0 * PI } else { left } / omega;
        if delay < margins.delay_margin {
            (margins.delay_margin, margins.omega_delay) = (delay, Some(omega));
        }
    }

    /// What dead time and a loop gain that does not fall make of the limit at high frequency: `L` goes round a
    /// circle for ever.
    fn limit(&self, margins: &mut Margins) -> Result<(), Refusal> {
        let Some(last) = self.points.last() else { return Ok(()) };
        let l = last.loop_gain().abs();
        if !self.delayed || l < 1e-3 {
            return Ok(());
        }
        if l >= 1.0 {
            return Err(UNSTABLE);
        }
        if 1.0 / (1.0 - l) > margins.ms {
            (margins.ms, margins.omega_ms) = (1.0 / (1.0 - l), last.omega);
        }
        if l / (1.0 - l) > margins.mt {
            (margins.mt, margins.omega_mt) = (l / (1.0 - l), last.omega);
        }
        if 1.0 / l < margins.gm {
            (margins.gm, margins.omega_gm) = (1.0 / l, Some(last.omega));
        }
        Ok(())
    }
}

/// `Im(L)`, scaled to the size of `L`.
fn slope(point: &Point) -> f64 {
    let l = point.loop_gain();
    l.im / l.abs()
}

fn phase_crossover(at: &dyn Fn(f64) -> Point, a: &Point, b: &Point, margins: &mut Margins) {
    let (x, y) = (a.loop_gain(), b.loop_gain());
    if (x.im > 0.0) == (y.im > 0.0) || (x.re > 0.0 && y.re > 0.0) {
        return;
    }
    let omega = crossing(|omega| slope(&at(omega)), a.omega, b.omega);
    let l = at(omega).loop_gain();
    if l.re >= 0.0 {
        return;
    }
    let factor = -1.0 / l.re;
    if factor >= 1.0 && factor < margins.gm {
        (margins.gm, margins.omega_gm) = (factor, Some(omega));
    }
    if factor < 1.0 && factor > margins.gm_low {
        (margins.gm_low, margins.omega_gm_low) = (factor, Some(omega));
    }
}
