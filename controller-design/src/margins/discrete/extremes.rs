//! Peaks of the sensitivities, crossings of the real axis and of the unit circle.

use core::f64::consts::PI;
use std::vec::Vec;

use super::sampled::{DiscreteLoop, LoopResponse};
use super::sweep::Sweep;
use crate::frequency::crossing;
use crate::margins::Margins;

/// All margins but the delay margin, which is left infinite.
pub(super) fn extremes(held: &DiscreteLoop, sweep: &Sweep) -> Margins {
    let per_second = 1.0 / held.ts();
    let in_seconds = |(theta, height): (f64, f64)| (theta * per_second, height);
    let mut margins = Margins::of_peaks(
        in_seconds(sweep.peak(held, |p| p.sensitivity().abs())),
        in_seconds(sweep.peak(held, |p| p.complementary().abs())),
    );
    for (theta, real) in real_axis(held, sweep) {
        let factor = -1.0 / real;
        if factor > 1.0 && factor < margins.gm {
            (margins.gm, margins.omega_gm) = (factor, Some(theta * per_second));
        } else if factor <= 1.0 && factor > margins.gm_low {
            (margins.gm_low, margins.omega_gm_low) = (factor, Some(theta * per_second));
        }
    }
    for theta in unit_circle(held, sweep) {
        let pm_deg = phase_to_limit(&held.at(theta)).abs().to_degrees();
        if pm_deg < margins.pm_deg {
            (margins.pm_deg, margins.omega_pm) = (pm_deg, Some(theta * per_second));
        }
    }
    margins
}

/// The angle from -1 to `L` in rad, `-pi..pi`.
pub(super) fn phase_to_limit(p: &LoopResponse) -> f64 {
    (-p.open()).arg()
}

/// Where `L` meets the negative real axis, and its value there.
fn real_axis(held: &DiscreteLoop, sweep: &Sweep) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    // L is real at both ends of the half circle, unless it integrates.
    for end in [sweep.points.first(), sweep.points.last()].into_iter().flatten() {
        let open = end.open();
        let real = end.theta == PI || (open.im.abs() < 1e-2 * open.re.abs() && open.abs() < 1e3);
        if real && open.re < 0.0 {
            found.push((end.theta, open.re));
        }
    }
    let crossings = sweep.points.iter().zip(sweep.points.iter().skip(1)).filter(|(a, b)| {
        let (from, to) = (a.open(), b.open());
        b.theta < PI && (from.im > 0.0) != (to.im > 0.0) && (from.re < 0.0 || to.re < 0.0)
    });
    for (a, b) in crossings {
        let theta = crossing(|t| held.at(t).open().im, a.theta, b.theta);
        let open = held.at(theta).open();
        if open.re < 0.0 {
            found.push((theta, open.re));
        }
    }
    found
}

/// Where `|L| = 1`.
pub(super) fn unit_circle(held: &DiscreteLoop, sweep: &Sweep) -> Vec<f64> {
    let size = |t: f64| held.at(t).open().abs() - 1.0;
    let pairs = sweep.points.iter().zip(sweep.points.iter().skip(1));
    let crossings = pairs.filter(|(a, b)| (a.open().abs() > 1.0) != (b.open().abs() > 1.0));
    crossings.map(|(a, b)| crossing(size, a.theta, b.theta)).collect()
}
