//! Parameters of a second-order active disturbance rejection controller.

use super::checks;
use super::reduction::Reduced;
use crate::Refusal;

/// Second-order ADRC by two bandwidths: `u = kc*(kp*(r - z1) - kd*z2 - z3)` with an observer of third order for
/// `z1..z3` (Vrančić & Huba 2021, Fig. 13 and Table 7; the rule of bandwidths is that of Gao).
///
/// `kc = 1/b0`, `kp = omega_c^2`, `kd = 2*omega_c`: the loop around an ideal observer is `(1 + s/omega_c)^-2`.
/// `beta1 = 3*omega_o`, `beta2 = 3*omega_o^2`, `beta3 = omega_o^3`: all poles of the observer at `-omega_o`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdrcDesign {
    /// Estimate of the plant's gain at high frequencies, `y'' = b0*u + ...` [y/u/s^2].
    pub b0: f64,
    /// Bandwidth of the controller [rad/s].
    pub omega_c: f64,
    /// Bandwidth of the observer [rad/s].
    pub omega_o: f64,
    /// `1/b0`, to the last digit: a rounded one leaves an offset.
    pub kc: f64,
    /// `omega_c^2` [1/s^2].
    pub kp: f64,
    /// `2*omega_c` [1/s].
    pub kd: f64,
    /// `3*omega_o` [1/s].
    pub beta1: f64,
    /// `3*omega_o^2` [1/s^2].
    pub beta2: f64,
    /// `omega_o^3` [1/s^3]; see [`with_beta3_as_printed`](Self::with_beta3_as_printed).
    pub beta3: f64,
}

/// Bandwidth of the observer over that of the controller, as in Table 7.
const OBSERVER: f64 = 4.0;
/// `omega_c` times the settling time: then `(1 + x)*exp(-x)`, what a double pole has left of a step, is 0.05 %.
const SETTLING: f64 = 10.0;

impl AdrcDesign {
    /// The parameters for a gain `b0` [y/u/s^2], of the sign of the plant's gain, and the two bandwidths in rad/s.
    ///
    /// ```
    /// use controller_design::rules::adrc::AdrcDesign;
    /// // Table 7 of Vrančić & Huba 2021, first row
    /// let design = AdrcDesign::new(5.0, 10.0, 40.0).expect("a design");
    /// assert_eq!((design.kc, design.kp, design.kd), (0.2, 100.0, 20.0));
    /// assert_eq!((design.beta1, design.beta2, design.beta3), (120.0, 4800.0, 64000.0));
    /// ```
    ///
    /// # Errors
    /// A `b0` of 0, a bandwidth that is not above 0, a number that is not finite or out of range.
    pub fn new(b0: f64, omega_c: f64, omega_o: f64) -> Result<Self, Refusal> {
        checks::gain(b0)?;
        checks::positive("omega_c", omega_c)?;
        checks::positive("omega_o", omega_o)?;
        let square = omega_o * omega_o;
        let design = Self {
            b0,
            omega_c,
            omega_o,
            kc: 1.0 / b0,
            kp: omega_c * omega_c,
            kd: 2.0 * omega_c,
            beta1: 3.0 * omega_o,
            beta2: 3.0 * square,
            beta3: square * omega_o,
        };
        let Self { kc, kp, kd, beta1, beta2, beta3, .. } = design;
        let fine = |x: f64| x.is_finite() && x.abs() >= f64::MIN_POSITIVE;
        if [kc, kp, kd, beta1, beta2, beta3].into_iter().all(fine) {
            Ok(design)
        } else {
            Err(Refusal::NoSolution {
                why: "the parameters do not fit into double precision",
                help: "choose bandwidths and a gain nearer to 1",
            })
        }
    }

    /// The parameters for a settling time in seconds: `omega_c = 10/settling_time`, `omega_o = 4*omega_c`. With an ideal
    /// observer the set-point response is then within 0.05 % of its end.
    ///
    /// ```
    /// use controller_design::rules::adrc::AdrcDesign;
    /// // Table 7, second row: omega_c = 0.4
    /// let design = AdrcDesign::for_settling_time(3.0, 25.0).expect("a design");
    /// assert!((design.kp - 0.16).abs() < 1e-15 && (design.beta2 - 7.68).abs() < 1e-14);
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn for_settling_time(b0: f64, settling_time: f64) -> Result<Self, Refusal> {
        checks::positive("settling_time", settling_time)?;
        let omega_c = SETTLING / settling_time;
        Self::new(b0, omega_c, OBSERVER * omega_c)
    }

    /// The same for a model: `b0 = gain/a2`, its gain at high frequencies. The papers choose `b0` by hand; for plants
    /// with dead time they take a larger one, which makes the loop slower.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::{adrc::AdrcDesign, reduction::Reduced};
    /// let areas = Areas::of_model(2.0, &[1.0], &[1.0, 1.2, 0.2], 0.0).expect("a stable plant");
    /// let model = Reduced::new(&areas).expect("a model");
    /// assert!((AdrcDesign::for_model(&model, 1.0).expect("a design").b0 - 10.0).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Self::new); a model of first order.
    pub fn for_model(model: &Reduced, settling_time: f64) -> Result<Self, Refusal> {
        if model.a2 == 0.0 {
            return Err(Refusal::Plant {
                must: "be of second order at least",
                help: "give b0 yourself, or use a PI",
            });
        }
        Self::for_settling_time(model.gain / model.a2, settling_time)
    }

    /// The same with `beta3 = 4*beta2`, as Table 7 of Vrančić & Huba 2021 prints it and as its Table 8 was computed: it
    /// is no power of a bandwidth (19200 in place of 64000, 30.72 in place of 4.096). For comparisons only.
    ///
    /// ```
    /// use controller_design::rules::adrc::AdrcDesign;
    /// let design = AdrcDesign::new(5.0, 10.0, 40.0).expect("a design");
    /// assert_eq!(design.with_beta3_as_printed().beta3, 19200.0);
    /// ```
    #[must_use]
    pub const fn with_beta3_as_printed(mut self) -> Self {
        self.beta3 = 4.0 * self.beta2;
        self
    }
}
