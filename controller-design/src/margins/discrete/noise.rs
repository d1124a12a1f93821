//! What the sampled controller makes of measurement noise.

use core::f64::consts::{FRAC_PI_2, PI};

use super::sampled::DiscreteLoop;
use super::sweep::Sweep;

/// Gains from measurement noise to the controller's output, as the sampled laws have them \[u/y\].
///
/// Vrančić & Huba 2021 limit the gain at `w_HF = pi/(2*ts)`, eqs (28)-(31); what a discretisation makes of that is
/// `kpidn` and `kden` here. At that one frequency only: white noise meets the controller at all of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseGains {
    /// `|C|` of the PID alone at `w_HF`.
    pub kpidn: f64,
    /// `|C_y|` of the compensator alone at `w_HF`; 0 without one.
    pub kden: f64,
    /// `|(C - C_y)/(1 - C_u)|` of the whole controller at `w_HF`.
    pub controller: f64,
    /// The jump of the output in the same sample per unit of a jump of the measurement.
    pub step: f64,
    /// `std(u)/std(n)` of the closed loop for white noise `n`; infinite or meaningless when it is unstable.
    pub white: f64,
}

pub(super) fn noise_gains(held: &DiscreteLoop, sweep: &Sweep) -> NoiseGains {
    let law = held.law();
    NoiseGains {
        kpidn: law.pid(FRAC_PI_2).abs(),
        kden: law.compensator(FRAC_PI_2).1.abs(),
        controller: held.at(FRAC_PI_2).controller().abs(),
        step: law.step_gain().abs(),
        white: white(held, sweep),
    }
}

/// `std(u)/std(n)` for white noise.
fn white(held: &DiscreteLoop, sweep: &Sweep) -> f64 {
    root_mean_square(sweep, |theta| held.at(theta).noise().abs())
}

/// `std(u[k] - u[k-1])/std(n)` for white noise.
pub(super) fn increment(held: &DiscreteLoop, sweep: &Sweep) -> f64 {
    root_mean_square(sweep, |theta| 2.0 * libm::sin(0.5 * theta) * held.at(theta).noise().abs())
}

/// `sqrt(1/pi * integral gain^2 dtheta)` from 0 to pi: five Gauss points between the points of the sweep, which already
/// follow every feature of the loop.
fn root_mean_square(sweep: &Sweep, gain: impl Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let power = |theta: f64| {
        let size = gain(theta);
        size * size
    };
    let Some(first) = sweep.points.first() else { return 0.0 };
    let mut sum = first.theta * power(first.theta);
    for (a, b) in sweep.points.iter().zip(sweep.points.iter().skip(1)) {
        let (middle, half) = (0.5 * (a.theta + b.theta), 0.5 * (b.theta - a.theta));
        sum += half * NODES.iter().map(|(x, w)| w * power(middle + half * x)).sum::<f64>();
    }
    libm::sqrt(sum / PI)
}
