//! AMIGO: robust PI and PID for first-order and integrating plants with dead time.

use controller_core::PidConfig;

use super::checks;
use crate::{Refusal, Warnings};

/// The AMIGO rules of Åström & Hägglund (Journal of Process Control 14, 2004, and "Advanced PID Control", 2006): PI and
/// PID with `Ms` and `Mt` near 1.4, for plants whose step response rises without swinging.
///
/// Set-point weight as they recommend for the PID, taken for the PI as well: `b = 0` where the dead time is at most half
/// of the total, and 1 above. `c = 0`.
/// The rules say nothing about the filter: here `tf = td/10` for the PID, 0 for the PI. They are cautious for
/// plants with little dead time.
#[derive(Debug, Clone, PartialEq)]
pub struct Amigo {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// What to know about it.
    pub warnings: Warnings,
}

/// Share of the filter in the derivative time.
const FILTER: f64 = 0.1;

impl Amigo {
    /// The PI for `gain*exp(-s*L)/(1 + T*s)`, `T = tau` (0 or more) and `L = dead_time` in seconds:
    /// `kp = (0.15 + (0.35 - L*T/(L+T)^2)*T/L)/gain`, `ti = 0.35*L + 13*L*T^2/(T^2 + 12*L*T + 7*L^2)`.
    ///
    /// ```
    /// use controller_design::rules::amigo::Amigo;
    /// let pid = Amigo::pi(1.0, 1.0, 1.0).expect("a PI").pid;
    /// assert!((pid.kp - 0.25).abs() < 1e-15 && (pid.kp / pid.ki - 1.0).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a negative `tau`, a `dead_time` that is not above 0.
    pub fn pi(gain: f64, tau: f64, dead_time: f64) -> Result<Self, Refusal> {
        check(gain, tau, dead_time)?;
        // x = T/(L+T), y = L/(L+T): no square of a time leaves the range.
        let (x, y) = (tau / (tau + dead_time), dead_time / (tau + dead_time));
        let kp = (0.15 + (0.35 - x * y) * (tau / dead_time)) / gain;
        let ti = dead_time * (0.35 + 13.0 * x * x / (x * x + 12.0 * x * y + 7.0 * y * y));
        Self::with(kp, ti, 0.0, y)
    }

    /// The PID for the same plant: `kp = (0.2 + 0.45*T/L)/gain`, `ti = L*(0.4*L + 0.8*T)/(L + 0.1*T)`,
    /// `td = 0.5*L*T/(0.3*L + T)`.
    ///
    /// ```
    /// use controller_design::rules::amigo::Amigo;
    /// let pid = Amigo::pid(1.0, 1.0, 1.0).expect("a PID").pid;
    /// assert!((pid.kp - 0.65).abs() < 1e-15 && (pid.kp / pid.ki - 1.2 / 1.1).abs() < 1e-12);
    /// assert!((pid.kd / pid.kp - 0.5 / 1.3).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi).
    pub fn pid(gain: f64, tau: f64, dead_time: f64) -> Result<Self, Refusal> {
        check(gain, tau, dead_time)?;
        let (x, y) = (tau / (tau + dead_time), dead_time / (tau + dead_time));
        let kp = (0.2 + 0.45 * (tau / dead_time)) / gain;
        let ti = dead_time * (0.4 * y + 0.8 * x) / (y + 0.1 * x);
        let td = 0.5 * dead_time * x / (0.3 * y + x);
        Self::with(kp, ti, td, y)
    }

    /// The PI for `gain*exp(-s*L)/s`, `gain` in `[y/u/s]`: `kp = 0.35/(gain*L)`, `ti = 13.4*L`.
    ///
    /// ```
    /// use controller_design::rules::amigo::Amigo;
    /// let pid = Amigo::integrating_pi(-0.5, 2.0).expect("a PI").pid;
    /// assert!((pid.kp + 0.35).abs() < 1e-15 && (pid.kp / pid.ki - 26.8).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi).
    pub fn integrating_pi(gain: f64, dead_time: f64) -> Result<Self, Refusal> {
        check(gain, 0.0, dead_time)?;
        Self::with(0.35 / gain / dead_time, 13.4 * dead_time, 0.0, 0.0)
    }

    /// The PID for `gain*exp(-s*L)/s`: `kp = 0.45/(gain*L)`, `ti = 8*L`, `td = L/2`.
    ///
    /// ```
    /// use controller_design::rules::amigo::Amigo;
    /// let pid = Amigo::integrating_pid(1.0, 2.0).expect("a PID").pid;
    /// assert!((pid.kp - 0.225).abs() < 1e-15 && (pid.kp / pid.ki - 16.0).abs() < 1e-12);
    /// assert!((pid.kd / pid.kp - 1.0).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi).
    pub fn integrating_pid(gain: f64, dead_time: f64) -> Result<Self, Refusal> {
        check(gain, 0.0, dead_time)?;
        Self::with(0.45 / gain / dead_time, 8.0 * dead_time, 0.5 * dead_time, 0.0)
    }

    fn with(kp: f64, ti: f64, td: f64, share: f64) -> Result<Self, Refusal> {
        let b = if share > 0.5 { 1.0 } else { 0.0 };
        let pid = PidConfig { kp, ki: kp / ti, kd: kp * td, tf: FILTER * td, b, ..PidConfig::default() };
        Ok(Self { pid: checks::in_range(pid)?, warnings: Warnings::new() })
    }
}

fn check(gain: f64, tau: f64, dead_time: f64) -> Result<(), Refusal> {
    checks::gain(gain)?;
    checks::not_negative("tau", tau)?;
    checks::some_dead_time(dead_time)
}
