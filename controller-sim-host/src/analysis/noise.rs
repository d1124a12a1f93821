//! Gains from measurement noise to the controller's output.

use controller_design::margins::{ContinuousLoop, NoiseGains};

/// Gains from measurement noise to the output \[u/y\]; not finite where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// `K_PIDn`: of the PID alone at `w = pi/(2*ts)`.
    pub kpidn: f64,
    /// `K_DEn`: of the disturbance estimator or observer alone at `w = pi/(2*ts)`; 0 without one.
    pub kden: f64,
    /// Of the whole controller at `w = pi/(2*ts)`.
    pub controller: f64,
    /// `A_n`: the limit at high frequency; of the sampled law the jump of `u` for a jump of `y` in the same sample.
    pub an: f64,
    /// `std(u)/std(n)` of the closed loop for white noise of the samples; not finite for the continuous loop.
    pub white: f64,
}

impl Noise {
    pub(super) fn requested(design: &ContinuousLoop, ts: f64) -> Self {
        let omega = core::f64::consts::FRAC_PI_2 / ts;
        Self {
            kpidn: design.controller(omega).abs(),
            kden: design.compensator(omega).1.abs(),
            controller: design.feedback(omega).abs(),
            an: design.noise_gain(),
            white: f64::NAN,
        }
    }

    pub(super) fn sampled(gains: &NoiseGains, stable: bool) -> Self {
        let NoiseGains { kpidn, kden, controller, step, white } = *gains;
        Self { kpidn, kden, controller, an: step, white: if stable { white } else { f64::NAN } }
    }
}
