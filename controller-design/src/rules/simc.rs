//! SIMC: PI and PID by direct synthesis, with the closed-loop time constant as the one knob.

use controller_core::PidConfig;
use controller_core::plant_model::Factor;

use super::checks;
use super::reduction::Reduced;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// The SIMC rules of Skogestad (Journal of Process Control 13, 2003), given as a parallel PID; `b = 1`, `c = 0`.
///
/// `tau_c` \[s\] is the wanted time constant of the closed loop; `None` takes `tau_c = dead_time`, the fastest one with
/// good robustness: `Ms` 1.59 for a first-order plant, 1.70 for an integrating one. The integral time is
/// `min(tau1, 4*(tau_c + dead_time))`. For the PID the original is in series form, `kc*(1 + 1/(ti*s))*(1 + td*s)`;
/// the rules say nothing about its filter: here `tf = td/10`.
#[derive(Debug, Clone, PartialEq)]
pub struct Simc {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// The time constant of the closed loop that was used \[s\].
    pub tau_c: f64,
    /// What to know about it.
    pub warnings: Warnings,
}

/// Share of the filter in the derivative time.
const FILTER: f64 = 0.1;

impl Simc {
    /// The PI for `gain*exp(-s*dead_time)/(1 + tau*s)`; `tau` 0 or more (0: a pure integral controller).
    ///
    /// ```
    /// use controller_design::rules::simc::Simc;
    /// let pid = Simc::pi(2.0, 6.0, 1.0, None).expect("a PI").pid;
    /// assert_eq!((pid.kp, pid.ki), (1.5, 0.25));
    /// ```
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a negative time; no dead time and no `tau_c`.
    pub fn pi(gain: f64, tau: f64, dead_time: f64, tau_c: Option<f64>) -> Result<Self, Refusal> {
        Self::with(gain, Slow::Lag(tau), 0.0, dead_time, tau_c)
    }

    /// The PID for `gain*exp(-s*dead_time)/((1 + tau1*s)*(1 + tau2*s))`, `tau1 >= tau2`.
    ///
    /// ```
    /// use controller_design::rules::simc::Simc;
    /// let pid = Simc::pid(2.0, 6.0, 2.0, 1.0, None).expect("a PID").pid;
    /// assert_eq!((pid.kp, pid.ki, pid.kd), (2.0, 0.25, 3.0));
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi); `tau2` above `tau1`.
    pub fn pid(gain: f64, tau1: f64, tau2: f64, dead_time: f64, tau_c: Option<f64>) -> Result<Self, Refusal> {
        if tau2 > tau1 {
            return Err(Refusal::OutOfRange { parameter: "tau2", value: tau2, min: 0.0, max: tau1 });
        }
        Self::with(gain, Slow::Lag(tau1), tau2, dead_time, tau_c)
    }

    /// The PI for `gain*exp(-s*dead_time)/s`, `gain` in `[y/u/s]`.
    ///
    /// ```
    /// use controller_design::rules::simc::Simc;
    /// let pid = Simc::integrating_pi(0.5, 1.0, None).expect("a PI").pid;
    /// assert_eq!((pid.kp, pid.ki), (1.0, 0.125));
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi).
    pub fn integrating_pi(gain: f64, dead_time: f64, tau_c: Option<f64>) -> Result<Self, Refusal> {
        Self::with(gain, Slow::Integrator, 0.0, dead_time, tau_c)
    }

    /// The PID for `gain*exp(-s*dead_time)/(s*(1 + tau2*s))`, `gain` in `[y/u/s]`.
    ///
    /// ```
    /// use controller_design::rules::simc::Simc;
    /// let pid = Simc::integrating_pid(0.5, 2.0, 1.0, None).expect("a PID").pid;
    /// assert_eq!((pid.kp, pid.ki, pid.kd), (1.25, 0.125, 2.0));
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi).
    pub fn integrating_pid(
        gain: f64,
        tau2: f64,
        dead_time: f64,
        tau_c: Option<f64>,
    ) -> Result<Self, Refusal> {
        Self::with(gain, Slow::Integrator, tau2, dead_time, tau_c)
    }

    /// The PID (PI for a model of first order) for a reduced model.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::{reduction::Reduced, simc::Simc};
    /// let areas = Areas::of_model(2.0, &[1.0], &[1.0, 8.0, 12.0], 1.0).expect("a stable plant");
    /// let pid = Simc::of_model(&Reduced::new(&areas).expect("a model"), None).expect("a PID").pid;
    /// assert!((pid.kp - 2.0).abs() < 1e-9 && (pid.kd - 3.0).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    /// As for [`pi`](Self::pi); a model with complex poles.
    pub fn of_model(model: &Reduced, tau_c: Option<f64>) -> Result<Self, Refusal> {
        let Some((slow, fast)) = Factor::second(model.a1, model.a2).real_time_constants() else {
            return Err(Refusal::Plant {
                must: "have real poles: the rule cancels lags, not oscillations",
                help: "use a rule that takes the plant as it is",
            });
        };
        Self::with(model.gain, Slow::Lag(slow), fast, model.dead_time, tau_c)
    }

    fn with(gain: f64, slow: Slow, tau2: f64, dead_time: f64, tau_c: Option<f64>) -> Result<Self, Refusal> {
        checks::gain(gain)?;
        if let Slow::Lag(tau) = slow {
            checks::not_negative("tau", tau)?;
        }
        checks::not_negative("tau2", tau2)?;
        checks::not_negative("dead_time", dead_time)?;
        let tau_c = tau_c.unwrap_or(dead_time);
        checks::positive("tau_c", tau_c)?;
        let horizon = tau_c + dead_time;
        // `kc` and `ki` of the series form; `ki` without dividing by a lag that may be 0.
        let (kc, ki) = match slow {
            Slow::Lag(tau) if tau <= 4.0 * horizon => (tau / horizon / gain, 1.0 / gain / horizon),
            Slow::Lag(tau) => (tau / horizon / gain, 0.25 * (tau / horizon) / horizon / gain),
            Slow::Integrator => (1.0 / gain / horizon, 0.25 / gain / horizon / horizon),
        };
        let pid = PidConfig {
            kp: kc + ki * tau2,
            ki,
            kd: kc * tau2,
            tf: FILTER * tau2,
            b: 1.0,
            ..PidConfig::default()
        };
        let mut warnings = Warnings::new();
        if tau_c < dead_time {
            let text = "faster than the dead time allows with good robustness";
            let (min, max) = (dead_time, f64::INFINITY);
            warn(&mut warnings, Warning::OutsideValidity { about: "tau_c", value: tau_c, min, max, text });
        }
        if tau2 > 0.0 && tau2 < dead_time {
            let text =
                "below the dead time: the derivative brings little, a PI with half of it added would do";
            warn(&mut warnings, Warning::Value { about: "tau2", value: tau2, text });
        }
        Ok(Self { pid: checks::in_range(pid)?, tau_c, warnings })
    }
}

/// The slow part of a plant.
enum Slow {
    Lag(f64),
    Integrator,
}
