//! Figure 9 as the chapter goes through it: gains for a filter, then a filter for these gains, some times over.
//!
//! The rules of this library solve for both together. The passes only show where printed figures come from.

use super::super::bench::Stop;
use controller_core::PidConfig;
use controller_design::areas::Areas;
use controller_design::rules::momi::Momi;
use controller_design::rules::noise_limit::high_frequency;

/// Where the chapter begins \[s\].
pub(super) const START: f64 = 0.1;

/// A pass: the gains, and the filter that follows from them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pass {
    /// Gains, with the filter they were computed for.
    pub(super) pid: PidConfig,
    /// The next filter time constant, eq. (29) \[s\].
    pub(super) next: f64,
}

/// Pass number `n`, 1 or more.
pub(super) fn pass(areas: &Areas, kpidn: f64, ts: f64, n: usize) -> Result<Pass, Stop> {
    let mut tf = START;
    for _ in 1..n {
        tf = once(areas, kpidn, ts, tf)?.next;
    }
    once(areas, kpidn, ts, tf)
}

/// The number of passes after which the filter stays within `part` of `solution`; at most 100.
pub(super) fn until(areas: &Areas, kpidn: f64, ts: f64, solution: f64, part: f64) -> Result<usize, Stop> {
    let (mut tf, mut needed) = (START, 0);
    for n in 1..=100 {
        tf = once(areas, kpidn, ts, tf)?.next;
        if (tf / solution - 1.0).abs() > part {
            needed = n;
        }
    }
    Ok(needed + 1)
}

fn once(areas: &Areas, kpidn: f64, ts: f64, tf: f64) -> Result<Pass, Stop> {
    let pid = Momi::new(areas, tf)?.pid;
    let (w, PidConfig { kp, ki, kd, .. }) = (high_frequency(ts), pid);
    let square = w * w;
    let radicand = square * square * kd * kd + square * (kp * kp - 2.0 * ki * kd - kpidn * kpidn) + ki * ki;
    Ok(Pass { pid, next: libm::sqrt(radicand.max(0.0)) / (square * kpidn) })
}
