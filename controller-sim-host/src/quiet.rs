//! How far noise of the measurement moves the output of a controller.

use controller_design::margins::NoiseGains;

/// Share of the output's range that noise, one standard deviation, or one step of the measurement may move it by.
pub const QUIET: f64 = 0.05;

/// Standard deviation of the output \[u\] for white noise with the standard deviation `sigma` \[y\] in the closed loop:
/// `white` is the gain of the whole controller, its disturbance block included.
#[must_use]
pub fn by_noise(white: f64, sigma: f64) -> f64 {
    sigma * white
}

/// How far the output moves \[u\] when the measurement flickers by one `step` of its converter \[y\]: the larger one of the
/// whole controller's jump and its gain at half the Nyquist frequency.
#[must_use]
pub fn by_step(gains: &NoiseGains, step: f64) -> f64 {
    step * gains.controller.max(gains.step)
}

/// The share of the range `lo..hi` that is; `None` where there is none to speak of.
#[must_use]
pub fn share(moved: f64, (lo, hi): (f64, f64)) -> Option<f64> {
    let share = moved / (hi - lo);
    (hi > lo && share.is_finite()).then_some(share)
}
