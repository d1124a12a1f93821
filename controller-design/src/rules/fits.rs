//! Fits to the PI controllers with the least IAE after a load step.

use controller_core::PidConfig;

use super::checks;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// A PI for load disturbances by one of the fits of Airikka 2021, for a first-order or integrating plant with dead
/// time. `b = 1`, `tf = 0`.
///
/// The loops are fast and not robust: `Ms` from 2 (`dead_time = 3*tau`) to 3.4 (`dead_time = 0.1*tau`), 3.7 for the
/// integrating plant. The exact optimum, for any ratio, is found by optimisation.
#[derive(Debug, Clone, PartialEq)]
pub struct AirikkaPi {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// What to know about it.
    pub warnings: Warnings,
}

impl AirikkaPi {
    /// Eq. (7), for `gain*exp(-s*dead_time)/(1 + tau*s)`, times in seconds, `r = dead_time/tau`:
    /// `kp = 1.1*r^-0.88/gain`, `ti = 1.41*tau*r^0.53`.
    ///
    /// Compared with the true optimum the IAE is up to 5 % larger for `r` from 0.15 to 0.6, and 25 % at `r = 3`:
    /// a warning tells of `r` outside. [`linear`](Self::linear) is the better fit.
    ///
    /// ```
    /// use controller_design::rules::fits::AirikkaPi;
    /// let pid = AirikkaPi::power(2.0, 10.0, 10.0).expect("a PI").pid;
    /// assert!((pid.kp - 0.55).abs() < 1e-15 && (pid.kp / pid.ki - 14.1).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a `tau` or `dead_time` that is not above 0.
    pub fn power(gain: f64, tau: f64, dead_time: f64) -> Result<Self, Refusal> {
        let r = ratio(gain, tau, dead_time)?;
        Self::pi(1.1 * libm::pow(r, -0.88) / gain, 1.41 * tau * libm::pow(r, 0.53), Some((r, 0.6)))
    }

    /// Eq. (8), corrected, for `gain*exp(-s*dead_time)/(1 + tau*s)`, times in seconds, `r = dead_time/tau`:
    /// `kp = (0.19*r + 0.86)/(gain*r)`, `ti = 1.38*tau*sqrt(r)`.
    ///
    /// The printed formula has `tau` in place of `r` in the denominator: it does not even have the unit of a gain.
    /// Compared with the true optimum the IAE is up to 4 % larger for `r` from 0.2 to 3; a warning tells of `r` below
    /// 0.15 (20 % at 0.1, 60 % at 0.05) and above 3, for which there is no fit.
    ///
    /// ```
    /// use controller_design::rules::fits::AirikkaPi;
    /// let pid = AirikkaPi::linear(2.0, 10.0, 10.0).expect("a PI").pid;
    /// assert!((pid.kp - 0.525).abs() < 1e-15 && (pid.kp / pid.ki - 13.8).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// As for [`power`](Self::power).
    pub fn linear(gain: f64, tau: f64, dead_time: f64) -> Result<Self, Refusal> {
        let r = ratio(gain, tau, dead_time)?;
        Self::pi((0.19 + 0.86 / r) / gain, 1.38 * tau * libm::sqrt(r), Some((r, 3.0)))
    }

    /// Eq. (9), for `gain*exp(-s*dead_time)/s`, `gain` in `[y/u/s]`, `dead_time` in seconds:
    /// `kp = 0.92/(gain*dead_time)`, `ti = 4.1*dead_time`. The IAE is 0.04 % above the optimum.
    ///
    /// ```
    /// use controller_design::rules::fits::AirikkaPi;
    /// let pid = AirikkaPi::integrating(-0.5, 2.0).expect("a PI").pid;
    /// assert!((pid.kp + 0.92).abs() < 1e-15 && (pid.kp / pid.ki - 8.2).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a `dead_time` that is not above 0.
    pub fn integrating(gain: f64, dead_time: f64) -> Result<Self, Refusal> {
        checks::gain(gain)?;
        checks::some_dead_time(dead_time)?;
        Self::pi(0.92 / gain / dead_time, 4.1 * dead_time, None)
    }

    fn pi(kp: f64, ti: f64, ratio: Option<(f64, f64)>) -> Result<Self, Refusal> {
        let mut warnings = Warnings::new();
        if let Some((value, max)) = ratio
            && !(LEAST_RATIO..=max).contains(&value)
        {
            let text = "the fit is poor there: IAE 5 % and more above the optimum, that of pi-iae";
            let about = "dead_time/tau";
            warn(&mut warnings, Warning::OutsideValidity { about, value, min: LEAST_RATIO, max, text });
        }
        Ok(Self { pid: checks::in_range(PidConfig { kp, ki: kp / ti, ..PidConfig::default() })?, warnings })
    }
}

/// Below it both fits make the integral time far too long.
const LEAST_RATIO: f64 = 0.15;

fn ratio(gain: f64, tau: f64, dead_time: f64) -> Result<f64, Refusal> {
    checks::gain(gain)?;
    checks::positive("tau", tau)?;
    checks::some_dead_time(dead_time)?;
    Ok(dead_time / tau)
}
