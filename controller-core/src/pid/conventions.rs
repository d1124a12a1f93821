//! Other ways to write PID parameters, turned into parallel gains.

use super::PidConfig;
use crate::error::{Checker, ConfigErrors, Param};

/// The spans that percent-based parameters refer to.
///
/// ```
/// use controller_core::Span;
/// let span = Span { pv_lo: 0.0, pv_hi: 200.0, op_lo: 0.0, op_hi: 100.0 };
/// assert_eq!(span.ratio(), 0.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Span {
    /// Measurement at 0 % \[y\].
    pub pv_lo: f64,
    /// Measurement at 100 % \[y\].
    pub pv_hi: f64,
    /// Output at 0 % \[u\].
    pub op_lo: f64,
    /// Output at 100 % \[u\].
    pub op_hi: f64,
}

impl Span {
    /// Output span over measurement span [u/y].
    #[must_use]
    pub fn ratio(&self) -> f64 {
        (self.op_hi - self.op_lo) / (self.pv_hi - self.pv_lo)
    }
}

impl PidConfig {
    /// From the standard (ideal, ISA) form `k*(1 + 1/(ti*s) + td*s)`: gain `k` [u/y], integral time `ti` \[s\]
    /// (infinite: no integral term), derivative time `td` \[s\], filter `tf` \[s\].
    ///
    /// `kp = k`, `ki = k/ti`, `kd = k*td`. Faults show up in [`PidConfig::validate`].
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// let pid = PidConfig::from_standard(2.0, 10.0, 1.0, 0.1);
    /// assert_eq!((pid.kp, pid.ki, pid.kd, pid.tf), (2.0, 0.2, 2.0, 0.1));
    /// assert_eq!(PidConfig::from_standard(2.0, f64::INFINITY, 0.0, 0.0).ki, 0.0);
    /// ```
    #[must_use]
    pub fn from_standard(k: f64, ti: f64, td: f64, tf: f64) -> Self {
        Self { kp: k, ki: k / ti, kd: k * td, tf, ..Self::default() }
    }

    /// From the series (interacting) form `k*(1 + 1/(ti*s))*(1 + td*s)`, units as in
    /// [`from_standard`](Self::from_standard).
    ///
    /// `kp = k*(ti+td)/ti`, `ki = k/ti`, `kd = k*td`.
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// let pid = PidConfig::from_series(2.0, 8.0, 2.0, 0.1);
    /// assert_eq!((pid.kp, pid.ki, pid.kd), (2.5, 0.25, 4.0));
    /// ```
    #[must_use]
    pub fn from_series(k: f64, ti: f64, td: f64, tf: f64) -> Self {
        let interaction = 1.0 + td / ti;
        Self { kp: k * interaction, ki: k / ti, kd: k * td, tf, ..Self::default() }
    }

    /// From a proportional band `pb` \[%\], with `ti`, `td`, `tf` in seconds: `k = 100/pb * op span / pv span`.
    ///
    /// # Errors
    /// `pb` not finite or outside 1e-6..=1e6 %; a span that is not finite or has no width.
    ///
    /// ```
    /// use controller_core::{PidConfig, Span};
    /// let span = Span { pv_lo: 0.0, pv_hi: 200.0, op_lo: 0.0, op_hi: 100.0 };
    /// let pid = PidConfig::from_proportional_band(50.0, 10.0, 0.0, 0.0, span).unwrap();
    /// assert_eq!((pid.kp, pid.ki), (1.0, 0.1));
    /// ```
    pub fn from_proportional_band(
        pb: f64,
        ti: f64,
        td: f64,
        tf: f64,
        span: Span,
    ) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        check.range(Param::ProportionalBand, pb, 1e-6, 1e6);
        check.bounds((Param::Span, span.pv_lo), (Param::Span, span.pv_hi), 1e15);
        check.bounds((Param::Span, span.op_lo), (Param::Span, span.op_hi), 1e15);
        check.finish(Self::from_standard(100.0 / pb * span.ratio(), ti, td, tf))
    }

    /// From a gain `k` [u/y], a reset rate in repeats per minute and a derivative time `td` \[s\].
    ///
    /// `ki = k*repeats/60`.
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// assert_eq!(PidConfig::from_repeats_per_minute(3.0, 2.0, 0.0, 0.0).ki, 0.1);
    /// ```
    #[must_use]
    pub fn from_repeats_per_minute(k: f64, repeats: f64, td: f64, tf: f64) -> Self {
        Self { kp: k, ki: k * repeats / 60.0, kd: k * td, tf, ..Self::default() }
    }

    /// The standard-form parameters `(k, ti, td)` of this controller: `ti` is infinite without an integral term;
    /// `None` when `kp = 0`, for which the standard form does not exist.
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// let pid = PidConfig { kp: 2.0, ki: 0.5, kd: 1.0, tf: 0.1, ..PidConfig::default() };
    /// assert_eq!(pid.to_standard(), Some((2.0, 4.0, 0.5)));
    /// ```
    #[must_use]
    pub fn to_standard(&self) -> Option<(f64, f64, f64)> {
        if self.kp == 0.0 {
            return None;
        }
        let ti = if self.ki == 0.0 { f64::INFINITY } else { self.kp / self.ki };
        Some((self.kp, ti, self.kd / self.kp))
    }
}
