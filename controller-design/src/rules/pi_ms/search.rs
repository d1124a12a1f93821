//! The top of the allowed gains.

use std::vec::Vec;

use super::region::{Ellipse, Region};
use crate::Refusal;
use crate::frequency::maximum;

/// Proportional gains of the scan, evenly spaced, and below the first of them by ratio.
const EVEN: u32 = 240;
const RATIO: u32 = 60;
/// Decades that the latter span.
const DECADES: f64 = 4.0;
/// A value's distance from the best one, relative, up to which it is looked at closely.
const CLOSE: f64 = 0.05;
/// Excess of the peak over the wish, relative, that is rounding.
const EXACT: f64 = 1e-10;
/// Most rounds of adding the frequencies of peaks that the grid missed.
const ROUNDS: usize = 16;

pub(super) const NONE: Refusal = Refusal::NoSolution {
    why: "no gains with this ms were found",
    help: "check the plant; a resonance or a zero near the axis may leave no room for integral action",
};

/// Gains for the plant without its gain, and their peak.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub(super) kp: f64,
    pub(super) ki: f64,
    pub(super) ms: f64,
    pub(super) omega: f64,
}

/// The best gains. The grid of frequencies is an outer approximation: while the peak of the best gains exceeds the
/// wish somewhere, that frequency joins the grid.
pub(super) fn search(region: &mut Region<'_>) -> Result<Found, Refusal> {
    let mut last = None;
    for _ in 0..ROUNDS {
        let (kp, ki) = best(region).ok_or(super::UNBOUNDED)?;
        if !(ki > 0.0 && ki.is_finite()) {
            break;
        }
        if region.follow(kp, ki) {
            continue;
        }
        let peaks = peaks(region, kp, ki);
        let Some(&(omega, ms)) = peaks.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        last = Some(Found { kp, ki, ms, omega });
        if ms <= region.ms() * (1.0 + EXACT) {
            return Ok(Found { kp, ki, ms, omega });
        }
        let more: Vec<f64> = peaks.iter().filter(|p| p.1 > region.ms()).map(|p| p.0).collect();
        region.add(&more);
    }
    match last {
        Some(found) if (found.ms / region.ms() - 1.0).abs() < 1e-8 => Ok(found),
        _ => Err(NONE),
    }
}

/// The largest `ki` on a coarse scan: an estimate of the size of `ki`.
pub(super) fn rough_ki(region: &Region<'_>) -> f64 {
    let mut best = 0.0_f64;
    for k in 0..40 {
        let ki = coarse(region, region.kp_hi() * f64::from(k) / 40.0);
        if ki.is_finite() {
            best = best.max(ki);
        }
    }
    best
}

/// `(kp, ki)` at the top; `None` if some gain has no limit at all.
fn best(region: &Region<'_>) -> Option<(f64, f64)> {
    let step = region.kp_hi() / f64::from(EVEN);
    let ratio = libm::exp(-core::f64::consts::LN_10 * DECADES / f64::from(RATIO));
    let mut gains: Vec<f64> = (1..=EVEN).rev().map(|k| step * f64::from(k)).collect();
    let mut kp = step;
    for _ in 0..RATIO {
        kp *= ratio;
        gains.push(kp);
    }
    gains.push(0.0);
    gains.reverse();
    let values: Vec<f64> = gains.iter().map(|&kp| coarse(region, kp)).collect();
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if top == f64::INFINITY {
        return None;
    }
    let value = |k: usize| values.get(k).copied().unwrap_or(f64::NEG_INFINITY);
    let gain = |k: usize| gains.get(k).copied().unwrap_or(region.kp_hi());
    let mut found = (0.0, f64::NEG_INFINITY);
    for k in 0..gains.len() {
        let is_top = value(k) >= value(k.saturating_sub(1)) && value(k) >= value(k + 1);
        if is_top && value(k) >= top - CLOSE * top.abs() {
            // The top is flat: between the points of the grid it can be some steps away.
            let (mut at, mut here) = (k, exact(region, gain(k)));
            let higher = |at: usize, than: f64| {
                let ki = if at < gains.len() { exact(region, gain(at)) } else { f64::NEG_INFINITY };
                (ki > than).then_some((at, ki))
            };
            while let Some(next) = higher(at + 1, here) {
                (at, here) = next;
            }
            while let Some(next) = higher(at.wrapping_sub(1), here) {
                (at, here) = next;
            }
            let (low, high) = (gain(at.saturating_sub(1)), gain(at + 1));
            let (kp, ki) = maximum(|kp| exact(region, kp), low, high, gain(at));
            if ki > found.1 {
                found = (kp, ki);
            }
        }
    }
    Some(found)
}

/// `ki_max(kp)` on the grid.
fn coarse(region: &Region<'_>, kp: f64) -> f64 {
    region.near().iter().filter_map(|e| e.lower_edge(kp)).fold(f64::INFINITY, f64::min)
}

/// `ki_max(kp)` between the points of the grid as well.
fn exact(region: &Region<'_>, kp: f64) -> f64 {
    let near = region.near();
    let edges: Vec<f64> = near.iter().map(|e| e.lower_edge(kp).unwrap_or(f64::INFINITY)).collect();
    let least = edges.iter().copied().fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return least;
    }
    let limit = least + CLOSE * least.abs();
    let mut result = least;
    for (k, &edge) in edges.iter().enumerate().filter(|(_, edge)| **edge <= limit) {
        let neighbour = |k: usize| (near.get(k), edges.get(k).copied().unwrap_or(f64::INFINITY));
        let (before, low) = neighbour(k.wrapping_sub(1));
        let (after, high) = neighbour(k + 1);
        if edge <= low && edge <= high {
            let here = near.get(k).map_or(0.0, |e| e.omega);
            let [from, to] = [before, after].map(|e| e.map_or(here, |e| e.omega));
            let ki = |omega: f64| region.at(omega).and_then(|e| e.lower_edge(kp));
            let (_, top) = maximum(|omega| ki(omega).map_or(f64::NEG_INFINITY, |k| -k), from, to, here);
            result = result.min(-top);
        }
    }
    result
}

/// Frequencies and heights of the peaks of `|S|` near the wish or above.
fn peaks(region: &Region<'_>, kp: f64, ki: f64) -> Vec<(f64, f64)> {
    let ms = region.ms();
    let mut peaks = Vec::new();
    for list in [region.near(), region.all()] {
        let size = |e: &Ellipse| e.sensitivity(ms, kp, ki);
        for triple in list.windows(3) {
            if let [a, b, c] = triple {
                let height = size(b);
                if height >= 0.9 * ms && height >= size(a) && height >= size(c) {
                    let at = |omega: f64| region.at(omega).map_or(0.0, |e| size(&e));
                    peaks.push(maximum(at, a.omega, c.omega, b.omega));
                }
            }
        }
    }
    peaks
}
