//! What a person writes for a PID.

use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::real::Real;

/// Shortest and longest sampling period of any law \[s\].
pub(crate) const TS_RANGE: (f64, f64) = (1e-9, 1e9);
/// Largest size of a gain.
const GAIN_LIMIT: f64 = 1e15;
/// Longest time constant \[s\].
const TIME_LIMIT: f64 = 1e12;

/// Which way the output moves when the measurement rises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Action {
    /// PV rises, output falls: the gains are used as they are written (heating, most flow and pressure loops).
    #[default]
    Reverse,
    /// PV rises, output rises: the gains are used with the opposite sign (cooling).
    Direct,
}

/// How the integral term is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum IntegralRule {
    /// `I[k] = I[k-1] + ki*ts*e[k]` (Tena et al. 2022, the discrete form under eq. (10)).
    #[default]
    Backward,
    /// `I[k] = I[k-1] + ki*ts*(e[k] + e[k-1])/2` (Tustin).
    Trapezoid,
}

/// Parameters of a [`Pid`](crate::Pid) in parallel form, SI units.
///
/// Two parameters have defaults that differ from a textbook PID: `c = 0` (no derivative kick when the set-point
/// steps) and `ki = kd = 0`, `kp = 0` (a controller that does nothing until told).
///
/// Other parameter conventions: [`from_standard`](Self::from_standard), [`from_series`](Self::from_series),
/// [`from_proportional_band`](Self::from_proportional_band),
/// [`from_repeats_per_minute`](Self::from_repeats_per_minute).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PidConfig {
    /// Proportional gain [u/y], any sign, size up to 1e15.
    pub kp: f64,
    /// Integral gain [u/y/s], any sign, size up to 1e15. `0`: no integrator, the integral term is a fixed bias.
    pub ki: f64,
    /// Derivative gain [u/y*s], any sign, size up to 1e15; needs `tf > 0`.
    pub kd: f64,
    /// Time constant of the filter over all terms \[s\]: `0`, or at least `ts/2` (below `ts` it filters little).
    pub tf: f64,
    /// Set-point weight of the proportional term, 0 to 2.
    pub b: f64,
    /// Set-point weight of the derivative term, 0 to 2.
    pub c: f64,
    /// Sense of the controller.
    pub action: Action,
    /// Integration rule.
    pub integral_rule: IntegralRule,
}

impl Default for PidConfig {
    fn default() -> Self {
        Self {
            kp: 0.0,
            ki: 0.0,
            kd: 0.0,
            tf: 0.0,
            b: 1.0,
            c: 0.0,
            action: Action::Reverse,
            integral_rule: IntegralRule::Backward,
        }
    }
}

impl PidConfig {
    /// All faults of this configuration for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every parameter that is not finite or outside the range its field names; `kd != 0` with `tf = 0`.
    pub fn validate(&self, ts: f64) -> Result<(), ConfigErrors> {
        let mut check = Checker::default();
        let ts_ok = check.range(Param::Ts, ts, TS_RANGE.0, TS_RANGE.1);
        check.range(Param::Kp, self.kp, -GAIN_LIMIT, GAIN_LIMIT);
        check.range(Param::Ki, self.ki, -GAIN_LIMIT, GAIN_LIMIT);
        check.range(Param::Kd, self.kd, -GAIN_LIMIT, GAIN_LIMIT);
        if self.tf != 0.0 {
            let shortest = if ts_ok { 0.5 * ts } else { 0.0 };
            check.range(Param::Tf, self.tf, shortest, TIME_LIMIT);
        } else if self.kd != 0.0 && self.kd.is_finite() {
            check.fault(Param::Kd, Reason::NeedsFilter, self.kd, 0.0, 0.0);
        }
        check.range(Param::B, self.b, 0.0, 2.0);
        check.range(Param::C, self.c, 0.0, 2.0);
        check.into_result()
    }

    /// The same configuration with every number rounded to `T`: what a front end that runs in `T` sees.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            kp: round(self.kp),
            ki: round(self.ki),
            kd: round(self.kd),
            tf: round(self.tf),
            b: round(self.b),
            c: round(self.c),
            ..*self
        }
    }

    /// `kp`, `ki`, `kd` with the sign that [`Action`] gives them.
    #[must_use]
    pub fn signed_gains(&self) -> [f64; 3] {
        let sign = match self.action {
            Action::Reverse => 1.0,
            Action::Direct => -1.0,
        };
        [sign * self.kp, sign * self.ki, sign * self.kd]
    }

    /// Default of the tracking time constant: `max(kp/ki, tf, ts)` \[s\].
    #[must_use]
    pub fn default_tt(&self, ts: f64) -> f64 {
        let integral_time = if self.ki == 0.0 { 0.0 } else { self.kp / self.ki };
        let longest = if self.tf > ts { self.tf } else { ts };
        if integral_time > longest { integral_time } else { longest }
    }
}
