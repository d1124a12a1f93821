//! What a person writes for an ADRC.

use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::pid::config::TS_RANGE;
use crate::real::Real;

/// Largest and smallest size of `b0`, and of an angular frequency \[1/s\].
const SIZE: (f64, f64) = (1e-15, 1e15);

/// Parameters of an [`Adrc`](crate::Adrc), SI units.
///
/// Six numbers; [`from_bandwidths`](Self::from_bandwidths) makes them of three. There is no default: an ADRC that knows
/// no `b0` cannot act.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdrcConfig {
    /// Input gain of the model `y'' = b0*(u + d)` [y/u/s²], any sign, size 1e-15 to 1e15.
    pub b0: f64,
    /// Gain of the feedback from `r - z1` [1/s²], above 0 and below `2*kd/ts`.
    pub kp: f64,
    /// Gain of the feedback from `z2` [1/s], above 0 and below `2/ts`.
    pub kd: f64,
    /// Observer gain into `z1` [1/s], above 0, up to 1e15.
    pub beta1: f64,
    /// Observer gain into `z2` [1/s²], above 0, up to 1e30.
    pub beta2: f64,
    /// Observer gain into `z3` [1/s³], above 0 and below `beta1*beta2`: then the observer is stable.
    pub beta3: f64,
}

impl AdrcConfig {
    /// From the bandwidths of the feedback `omega_c` and of the observer `omega_o` [rad/s]: two closed-loop poles at
    /// `-omega_c`, three observer poles at `-omega_o`.
    ///
    /// `kp = omega_c^2`, `kd = 2*omega_c`, `beta = (3*omega_o, 3*omega_o^2, omega_o^3)`; usually `omega_o` is 3 to 10
    /// times `omega_c`. Table 7 of Vrančić & Huba 2021 has `omega_o = 4*omega_c`, but `beta3 = 4*beta2`.
    ///
    /// ```
    /// use controller_core::AdrcConfig;
    /// let adrc = AdrcConfig::from_bandwidths(5.0, 10.0, 40.0);
    /// assert_eq!((adrc.kp, adrc.kd), (100.0, 20.0));
    /// assert_eq!((adrc.beta1, adrc.beta2, adrc.beta3), (120.0, 4800.0, 64_000.0));
    /// ```
    #[must_use]
    pub fn from_bandwidths(b0: f64, omega_c: f64, omega_o: f64) -> Self {
        Self {
            b0,
            kp: omega_c * omega_c,
            kd: 2.0 * omega_c,
            beta1: 3.0 * omega_o,
            beta2: 3.0 * omega_o * omega_o,
            beta3: omega_o * omega_o * omega_o,
        }
    }

    /// All faults of this configuration for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every parameter that is not finite or outside the range its field names.
    pub fn validate(&self, ts: f64) -> Result<(), ConfigErrors> {
        let mut check = Checker::default();
        let (least, most) = SIZE;
        let ts_ok = check.range(Param::Ts, ts, TS_RANGE.0, TS_RANGE.1);
        if check.range(Param::B0, self.b0, -most, most) && self.b0.abs() < least {
            check.fault(Param::B0, Reason::OutOfRange, self.b0, least, most);
        }
        // Beyond these the sampled loop is unstable even with the plant that the law assumes.
        let (kp_most, kd_most) = if ts_ok { (2.0 * self.kd / ts, 2.0 / ts) } else { (most * most, most) };
        let below = |check: &mut Checker, param, value: f64, least: f64, limit: f64, most: f64| {
            let limit = if limit > least && limit < most { limit } else { most };
            if check.range(param, value, least, limit) && value >= limit {
                check.fault(param, Reason::OutOfRange, value, least, limit);
            }
        };
        below(&mut check, Param::AdrcKp, self.kp, least * least, kp_most, most * most);
        below(&mut check, Param::AdrcKd, self.kd, least, kd_most, most);
        check.range(Param::Beta1, self.beta1, least, most);
        check.range(Param::Beta2, self.beta2, least * least, most * most);
        let product = self.beta1 * self.beta2;
        below(&mut check, Param::Beta3, self.beta3, least * least * least, product, most * most * most);
        check.into_result()
    }

    /// The same configuration with every number rounded to `T`: what a front end that runs in `T` sees.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            b0: round(self.b0),
            kp: round(self.kp),
            kd: round(self.kd),
            beta1: round(self.beta1),
            beta2: round(self.beta2),
            beta3: round(self.beta3),
        }
    }
}
