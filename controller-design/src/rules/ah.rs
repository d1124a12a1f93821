//! The kappa-tau rule: a PID from the step response, for a wanted `Ms`.

use controller_core::PidConfig;

use super::checks;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// The largest sensitivity that the rule was made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AhMs {
    /// `Ms = 1.4`: calm.
    Ms14,
    /// `Ms = 2`: fast; the one that Vrančić & Huba 2021 compare with.
    Ms20,
}

/// The kappa-tau PID of Åström & Hägglund 1995 ("AH" in Vrančić & Huba 2021, Table 5), from gain, apparent time
/// constant and apparent dead time of a self-regulating plant.
///
/// With `a = gain*L/T` and `x = L/(L + T)`, `L` the dead time and `T` the time constant, `kp*a`, `ti/L`, `td/L` and
/// `b` are each `c0*exp(c1*x + c2*x^2)`. `c = 0`. The rule says nothing about the filter: `tf = td/10` here.
///
/// The curves were fitted to plants of several lags, some with dead time or a zero in the right half-plane. They do not
/// hold for what is truly of first order with a short dead time: there the loop gain stays at `s = kd*gain/T` beyond the
/// dead time, so that `Ms` is at least `1/(1 - s)`; for `Ms = 1.4` that is more than wished for below `x = 0.32`, for
/// `Ms = 2` below 0.31; below 0.15 and 0.21 `s` is above 1 and the loop unstable. [`new`](Self::new) cannot see the
/// plant and warns; the method `ah` of a design refuses a plant whose loop has more than 1.5 times the wanted `Ms`.
///
/// `L` is where the steepest tangent of the step response leaves the initial value; for a plant in writing
/// `of_plant` finds it (with the feature `std`). The paper takes `T = A_1/A_0 - L`.
#[derive(Debug, Clone, PartialEq)]
pub struct AhPid {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// What to know about it.
    pub warnings: Warnings,
}

/// `c0*exp(c1*x + c2*x^2)`.
struct Curve([f64; 3]);

impl Curve {
    fn at(&self, x: f64) -> f64 {
        let [c0, c1, c2] = self.0;
        c0 * libm::exp((c1 + c2 * x) * x)
    }
}

/// The curves for `kp*a`, `ti/L`, `td/L`, `b`.
struct Curves {
    gain: Curve,
    integral: Curve,
    derivative: Curve,
    weight: Curve,
}

const MS_14: Curves = Curves {
    gain: Curve([3.8, -8.4, 7.3]),
    integral: Curve([5.2, -2.5, -1.4]),
    derivative: Curve([0.89, -0.37, -4.1]),
    weight: Curve([0.40, 0.18, 2.8]),
};

const MS_20: Curves = Curves {
    gain: Curve([8.4, -9.6, 9.8]),
    integral: Curve([3.2, -1.5, -0.93]),
    derivative: Curve([0.86, -1.9, -0.44]),
    weight: Curve([0.22, 0.65, 0.051]),
};

/// Share of the filter in the derivative time.
const FILTER: f64 = 0.1;
/// With a plant of first order the loop gain does not fall below `kd*gain/tau` at high frequencies: from 1 on the loop
/// is unstable, at a half `Ms` is 2 by this alone.
const LARGEST_DERIVATIVE: f64 = 0.5;
/// What that loop gain is called.
pub(crate) const LOOP_GAIN: &str = "kd*gain/tau";
/// `L/(L + T)` below which the gain grows beyond what any actuator follows.
const LEAST_SHARE: f64 = 0.05;

impl AhPid {
    /// The gains for `gain*exp(-s*dead_time)/(1 + tau*s)`, or a plant that looks like it; times in seconds.
    ///
    /// ```
    /// use controller_design::rules::ah::{AhMs, AhPid};
    /// // Apparent dead time of exp(-5*s)/(1+s)^3; Table 5 of Vrančić & Huba 2021: 0.52, 0.136, 0.52, b = 0.36
    /// let dead_time = 5.805472;
    /// let pid = AhPid::new(1.0, 8.0 - dead_time, dead_time, AhMs::Ms20).expect("a PID").pid;
    /// assert!((pid.kp - 0.52188).abs() < 1e-5 && (pid.ki - 0.13615).abs() < 1e-5);
    /// assert!((pid.kd - 0.52056).abs() < 1e-5 && (pid.b - 0.36219).abs() < 1e-5);
    /// ```
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a `tau` or `dead_time` that is not above 0.
    pub fn new(gain: f64, tau: f64, dead_time: f64, ms: AhMs) -> Result<Self, Refusal> {
        checks::gain(gain)?;
        checks::positive("tau", tau)?;
        checks::some_dead_time(dead_time)?;
        let x = dead_time / (dead_time + tau);
        let curves = match ms {
            AhMs::Ms14 => MS_14,
            AhMs::Ms20 => MS_20,
        };
        let kp = curves.gain.at(x) * (tau / dead_time) / gain;
        let (ti, td) = (curves.integral.at(x) * dead_time, curves.derivative.at(x) * dead_time);
        // The calm rule's weight passes 2, the most a controller takes, when nearly all is dead time.
        let b = curves.weight.at(x).min(2.0);
        let pid =
            PidConfig { kp, ki: kp / ti, kd: kp * td, tf: FILTER * td, b, c: 0.0, ..PidConfig::default() };
        let mut warnings = Warnings::new();
        if x < LEAST_SHARE {
            let (about, text) =
                ("dead_time/(dead_time+tau)", "the gain grows as the dead time falls: limit the noise");
            let (min, max) = (LEAST_SHARE, 1.0);
            warn(&mut warnings, Warning::OutsideValidity { about, value: x, min, max, text });
        }
        let share = pid.kd * gain / tau;
        if share > LARGEST_DERIVATIVE {
            let text = "unstable on a plant that is truly of first order: look at the margins";
            let (about, max) = (LOOP_GAIN, LARGEST_DERIVATIVE);
            warn(&mut warnings, Warning::OutsideValidity { about, value: share, min: 0.0, max, text });
        }
        Ok(Self { pid: checks::in_range(pid)?, warnings })
    }

    /// The gains for any self-regulating plant, from the inflexion of its step response as Vrančić & Huba 2021 do:
    /// [`Inflexion`](super::inflexion::Inflexion), `tau = A_1/A_0 - dead_time`.
    ///
    /// ```
    /// use controller_design::model::parse;
    /// use controller_design::rules::ah::{AhMs, AhPid};
    /// let plant = parse("1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))").expect("a valid plant");
    /// let pid = AhPid::of_plant(&plant, AhMs::Ms20).expect("a PID").pid;
    /// // Table 5: 21.35, 53.05, 2.22, b = 0.24
    /// assert!((pid.kp - 21.3545).abs() < 1e-3 && (pid.ki - 53.0479).abs() < 1e-3);
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Self::new), for the areas of the plant, and for [`Inflexion::of`](super::inflexion::Inflexion::of).
    #[cfg(feature = "std")]
    pub fn of_plant(plant: &crate::model::TransferFunction, ms: AhMs) -> Result<Self, Refusal> {
        let dead_time = super::inflexion::Inflexion::of(plant)?.dead_time();
        let areas = plant.areas6()?;
        let tau = areas.of(1) / areas.of(0) - dead_time;
        if tau <= 0.0 {
            return Err(Refusal::Plant {
                must: "rise without swinging: the steepest tangent of its step response leaves it no time constant",
                help: "use a rule that takes the plant as it is",
            });
        }
        Self::new(plant.gain(), tau, dead_time, ms)
    }
}
