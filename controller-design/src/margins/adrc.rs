//! Second-order ADRC as two paths in continuous time.

use controller_core::AdrcConfig;

use crate::Refusal;
use crate::frequency::{Features, polynomial};
use crate::model::Complex;

/// `u = C_u*u + C_y*y` of the law of [`AdrcConfig`] for a set-point of 0: the observer `z1' = z2 + beta1*e`,
/// `z2' = z3 + b0*u + beta2*e`, `z3' = beta3*e`, `e = y - z1`, and `u = -(kp*z1 + kd*z2 + z3)/b0`. With
/// `D = s^3 + beta1*s^2 + beta2*s + beta3`
///
/// ```text
/// C_u = (beta3 - kp*s - kd*s*(s + beta1))/D
/// C_y = -(kp*(beta1*s^2 + beta2*s + beta3) + kd*s*(beta2*s + beta3) + beta3*s^2)/(b0*D)
/// ```
#[derive(Debug, Clone, Copy)]
pub(super) struct AdrcPaths {
    config: AdrcConfig,
}

impl AdrcPaths {
    pub(super) fn new(config: &AdrcConfig) -> Result<Self, Refusal> {
        let AdrcConfig { b0, kp, kd, beta1, beta2, beta3 } = *config;
        let positive = [kp, kd, beta1, beta2, beta3].into_iter().all(|x| x > 0.0 && x.is_finite());
        if positive && b0 != 0.0 && b0.is_finite() && beta3 < beta1 * beta2 {
            Ok(Self { config: *config })
        } else {
            Err(Refusal::NoSolution {
                why: "the ADRC has a gain that is not above 0, or an unstable observer",
                help: "give b0 the sign of the plant's gain, and keep beta3 below beta1*beta2",
            })
        }
    }

    /// `(C_u, C_y)` at `s = j*omega`.
    pub(super) fn at(&self, omega: f64) -> (Complex, Complex) {
        let AdrcConfig { b0, kp, kd, beta1, beta2, beta3 } = self.config;
        let below = polynomial(&[beta3, beta2, beta1, 1.0], omega);
        let from_u = polynomial(&[beta3, -(kp + kd * beta1), -kd], omega);
        let from_y =
            polynomial(&[kp * beta3, kp * beta2 + kd * beta3, kp * beta1 + kd * beta2 + beta3], omega);
        (from_u / below, -(from_y / below) * (1.0 / b0))
    }

    pub(super) fn features(&self, features: &mut Features) {
        let AdrcConfig { kp, kd, beta1, beta2, beta3, .. } = self.config;
        for time in [kd / kp, 1.0 / kd, 1.0 / beta1, beta1 / beta2, beta2 / beta3] {
            features.time(time);
        }
    }
}
