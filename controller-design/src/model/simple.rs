//! The three models that tuning rules are written for: first and second order with dead time, integrating with
//! dead time.

use super::{ModelError, TransferFunction};
use crate::Refusal;

/// A lag below this share of the sampling period counts as dead time.
const FAST_LAG: f64 = 0.05;

/// First order plus dead time: `gain*exp(-dead_time*s)/(1 + tau*s)`.
///
/// ```
/// use controller_design::model::Fopdt;
/// let tank = Fopdt { gain: 1.98, tau: 80.3, dead_time: 3.2 };
/// assert_eq!(tank.transfer_function()?.to_string(), "1.98*exp(-3.2*s)/(1+80.3*s)");
/// # Ok::<(), controller_design::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fopdt {
    /// Static gain [y/u].
    pub gain: f64,
    /// Time constant \[s\].
    pub tau: f64,
    /// Dead time \[s\].
    pub dead_time: f64,
}

/// Second order plus dead time: `gain*exp(-dead_time*s)/(1 + a1*s + a2*s^2)`, eq. (13) of Vrančić & Huba 2021.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sopdt {
    /// Static gain [y/u].
    pub gain: f64,
    /// Coefficient of `s` \[s\].
    pub a1: f64,
    /// Coefficient of `s^2` [s^2].
    pub a2: f64,
    /// Dead time \[s\].
    pub dead_time: f64,
}

/// Integrating plus dead time: `gain*exp(-dead_time*s)/s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ipdt {
    /// Slope of the output per unit of the input [y/u/s].
    pub gain: f64,
    /// Dead time \[s\].
    pub dead_time: f64,
}

impl Fopdt {
    /// The first-order model with the areas `A_0`, `A_1`, `A_2` of `plant`: the same gain, the same mean response time
    /// `A_1/A_0 = tau + dead_time` and the same second area. With `kappa = 2*A_0*A_2/A_1^2 - 1`,
    /// `tau = A_1/A_0*sqrt(kappa)`.
    ///
    /// # Errors
    /// The plant has no areas (it integrates, differentiates or is unstable), or no such model with `tau` and
    /// `dead_time` not below 0 (an underdamped plant, or one with a strong right-half-plane or slow zero).
    ///
    /// ```
    /// use controller_design::model::{Fopdt, parse};
    /// let model = Fopdt::from_areas(&parse("2*exp(-s)/(1+5*s)").expect("a valid plant"))?;
    /// assert!((model.tau - 5.0).abs() < 1e-12 && (model.dead_time - 1.0).abs() < 1e-12);
    /// # Ok::<(), controller_design::Refusal>(())
    /// ```
    pub fn from_areas(plant: &TransferFunction) -> Result<Self, Refusal> {
        const HELP: &str = "use a rule that takes the plant as it is";
        let [a0, a1, a2, ..] = plant.areas6()?.values();
        let mean = a1 / a0;
        let kappa = 2.0 * (a2 / a0) / (mean * mean) - 1.0;
        if !(mean > 0.0 && mean.is_finite()) {
            return Err(Refusal::Plant { must: "have a positive mean response time A1/A0", help: HELP });
        }
        // Rounding leaves a plant of pure dead time a little below 0, one of first order a little above 1.
        if !(-1e-9..=1.0 + 1e-9).contains(&kappa) {
            return Err(Refusal::Plant {
                must: "be close to a first-order lag with dead time (it has no such model with its areas A0 to A2)",
                help: HELP,
            });
        }
        let tau = mean * libm::sqrt(kappa.clamp(0.0, 1.0));
        Ok(Self { gain: a0, tau, dead_time: (mean - tau).max(0.0) })
    }

    /// The model as a transfer function.
    ///
    /// # Errors
    /// Those of [`TransferFunction::first_order`].
    pub fn transfer_function(&self) -> Result<TransferFunction, ModelError> {
        TransferFunction::first_order(self.gain, self.tau, self.dead_time)
    }
}

impl Sopdt {
    /// The model as a transfer function.
    ///
    /// # Errors
    /// Those of [`TransferFunction::second_order`].
    pub fn transfer_function(&self) -> Result<TransferFunction, ModelError> {
        TransferFunction::second_order(self.gain, self.a1, self.a2, self.dead_time)
    }

    /// The same model with a lag that is far below the sampling period `ts` \[s\] (a twentieth) as dead time: sampled, the two
    /// cannot be told apart, and a compensator cannot invert the lag.
    ///
    /// ```
    /// use controller_design::model::Sopdt;
    /// let fitted = Sopdt { gain: 2.0, a1: 10.001, a2: 0.01, dead_time: 2.1 };
    /// let model = fitted.without_fast_lag(0.1);
    /// assert!((model.a1 - 10.0).abs() < 1e-6 && model.a2 == 0.0 && (model.dead_time - 2.101).abs() < 1e-6);
    /// assert_eq!(fitted.without_fast_lag(0.001), fitted);
    /// ```
    #[must_use]
    pub fn without_fast_lag(self, ts: f64) -> Self {
        match self.time_constants() {
            Some((slow, fast)) if fast > 0.0 && fast < FAST_LAG * ts && slow > fast => {
                Self { a1: slow, a2: 0.0, dead_time: self.dead_time + fast, ..self }
            }
            _ => self,
        }
    }

    /// The two time constants, the slower first \[s\]; `None` for complex poles.
    #[must_use]
    pub fn time_constants(&self) -> Option<(f64, f64)> {
        let root = self.a1 * self.a1 - 4.0 * self.a2;
        if root < 0.0 {
            return None;
        }
        let slow = 0.5 * (self.a1 + libm::sqrt(root));
        Some((slow, if slow == 0.0 { 0.0 } else { self.a2 / slow }))
    }
}

impl Ipdt {
    /// The model as a transfer function.
    ///
    /// # Errors
    /// Those of [`TransferFunction::integrating`].
    pub fn transfer_function(&self) -> Result<TransferFunction, ModelError> {
        TransferFunction::integrating(self.gain, self.dead_time)
    }
}
