//! The extra dead time that brings a sampled loop to its limit.

use core::f64::consts::PI;
use std::vec::Vec;

use super::extremes::{phase_to_limit, unit_circle};
use super::sampled::DiscreteLoop;
use super::sweep::Sweep;
use crate::frequency::crossing;

/// The delay margin in s and the frequency of the oscillation in rad/s.
///
/// A dead time of a fraction of a sample does more than turn `L`: what is held between the samples changes. So each gain
/// crossover gives a first guess, which is corrected with the loop of that dead time until its phase is -180 deg.
pub(super) fn delay_margin(held: &DiscreteLoop, sweep: &Sweep) -> (f64, Option<f64>) {
    let ts = held.ts();
    let mut guesses: Vec<(f64, f64)> = unit_circle(held, sweep)
        .into_iter()
        .map(|theta| {
            let phase = phase_to_limit(&held.at(theta));
            let turn = if phase > 0.0 { phase } else { phase + 2.0 * PI };
            (turn / theta * ts, theta)
        })
        .filter(|(delay, _)| delay.is_finite())
        .collect();
    guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = (f64::INFINITY, None);
    for (delay, theta) in guesses {
        // Corrections are less than a sample.
        if delay > best.0 + ts {
            break;
        }
        let (delay, theta) = refined(held, delay, theta);
        if delay < best.0 {
            best = (delay, Some(theta / ts));
        }
    }
    if best.0.is_finite() { confirmed(held, best) } else { best }
}

/// The dead time at which the crossover near `theta` has the phase -180 deg: Newton's steps, kept within what is known.
///
/// Without dynamics slower than a sample the phase falls in steps, one for each whole sample of dead time.
fn refined(held: &DiscreteLoop, guess: f64, theta: f64) -> (f64, f64) {
    let ts = held.ts();
    let (mut delay, mut theta) = (guess, theta);
    let (mut low, mut high) = (0.0_f64, f64::INFINITY);
    for k in 0..80 {
        let Some(later) = held.later(delay).ok() else { break };
        let Some(crossover) = near(&later, theta) else { break };
        theta = crossover;
        let correction = (phase_to_limit(&later.at(theta)) / theta * ts).clamp(-ts, ts);
        if correction.abs() <= 1e-12 * (delay + ts) {
            break;
        }
        if correction > 0.0 {
            low = low.max(delay);
        } else {
            high = high.min(delay);
        }
        let next = delay + correction;
        let halve = high.is_finite() && (k > 10 || next <= low || next >= high);
        delay = if halve { 0.5 * (low + high) } else { next.max(0.0) };
        if high - low <= 1e-12 * (delay + ts) {
            break;
        }
    }
    (delay, theta)
}

/// The gain crossover nearest to `theta`.
fn near(held: &DiscreteLoop, theta: f64) -> Option<f64> {
    let size = |t: f64| held.at(t).open().abs() - 1.0;
    let above = size(theta) > 0.0;
    let mut width = 1e-3;
    while width < 0.7 {
        let (low, high) = (theta * (1.0 - width), (theta * (1.0 + width)).min(PI));
        for end in [low, high] {
            if (size(end) > 0.0) != above {
                return Some(crossing(size, theta, end));
            }
        }
        width *= 1.5;
    }
    None
}

/// `found`, if the loop is stable just before it; else the dead time below it at which the loop stops being stable.
fn confirmed(held: &DiscreteLoop, found: (f64, Option<f64>)) -> (f64, Option<f64>) {
    let stable = |delay: f64| {
        // What cannot be followed is not refuted.
        held.later(delay).is_ok_and(|later| {
            let sweep = Sweep::of(&later);
            sweep.is_cut || sweep.unstable_poles() == 0
        })
    };
    if stable(found.0 * 0.998) {
        return found;
    }
    let (mut low, mut high) = (0.0, found.0);
    while high - low > 1e-6 * found.0 {
        let middle = 0.5 * (low + high);
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, found.1)
}
