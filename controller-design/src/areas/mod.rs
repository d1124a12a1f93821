//! Characteristic areas (moments) of a process: its series at `s = 0`.
//!
//! `G(s) = A_0 - A_1*s + A_2*s^2 - A_3*s^3 + ...`; `A_0` is the gain, `A_1/A_0` the average residence time. They
//! are all that the rules of the magnitude-optimum family need to know of a plant, and they can be had from a
//! transfer function (here) as well as from a recorded change between two steady states.
//! Source: Vrančić & Huba 2021, eqs (5), (7).

mod series;
#[cfg(feature = "std")]
mod transfer_function;

use crate::Refusal;
use crate::double::Double;
pub use series::{MAX_AREAS, MAX_COEFFICIENTS, areas_into};

/// Relative error of areas that were handed over as plain numbers.
const ROUNDED: f64 = f64::EPSILON;
/// Relative error of areas that were computed here.
const COMPUTED: f64 = f64::EPSILON * f64::EPSILON * 64.0;

/// The areas `A_0..A_5` of a process; `A_k` in `[y/u] s^k`.
///
/// Areas that were computed from a model carry more digits than [`values`](Self::values) shows: for plants of low
/// order the rules lose many. Two are equal when their values are.
///
/// ```
/// use controller_design::areas::Areas;
/// // exp(-0.5*s)/(1+s)^2, Table 1 of Vrančić & Huba 2021
/// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 2.0, 1.0], 0.5).expect("a stable plant");
/// assert_eq!(areas.of(2), 4.125);
/// assert_eq!(areas.filtered(0.1).of(2), 4.385);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Areas {
    values: [f64; 6],
    tails: [f64; 6],
    error: f64,
}

impl PartialEq for Areas {
    fn eq(&self, other: &Self) -> bool {
        self.values == other.values
    }
}

impl Areas {
    /// From `A_0..A_5`, measured for instance. Any numbers are taken; the rules refuse what they cannot use.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// assert_eq!(Areas::new([1.0, 2.5, 4.125, 5.77, 7.42, 9.07]).of(1), 2.5);
    /// ```
    #[must_use]
    pub const fn new(values: [f64; 6]) -> Self {
        Self { values, tails: [0.0; 6], error: ROUNDED }
    }

    /// `A_0..A_5`.
    #[must_use]
    pub const fn values(&self) -> [f64; 6] {
        self.values
    }

    /// `A_k`; 0 for `k` above 5.
    #[must_use]
    pub fn of(&self, k: usize) -> f64 {
        self.values.get(k).copied().unwrap_or(0.0)
    }

    /// The areas `A*` of the process with a lag `1/(1 + tf*s)` in series (Vrančić & Huba 2021, eq. (7)):
    /// `A*_0 = A_0`, `A*_k = A_k + tf*A*_(k-1)`. `tf` in seconds.
    #[must_use]
    pub fn filtered(&self, tf: f64) -> Self {
        let mut result = *self;
        let mut last = Double::default();
        for k in 0..result.values.len() {
            last = self.double(k).add(last.times(tf));
            (result.values[k], result.tails[k]) = (last.hi, last.lo);
        }
        result
    }

    /// The areas of the process behind an additional dead time \[s\]: the series of `exp(-s*dead_time)` times that of
    /// the process, `A'_k = sum(dead_time^i/i! * A_(k-i))`. Meant for measured areas: in `f64`.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// let lag = Areas::new([2.0, 6.0, 18.0, 54.0, 162.0, 486.0]);
    /// assert_eq!(lag.delayed(1.0).of(1), 8.0);
    /// assert_eq!(lag.delayed(1.0).of(2), 25.0);
    /// ```
    #[must_use]
    pub fn delayed(&self, dead_time: f64) -> Self {
        let mut values = [0.0; 6];
        for (k, value) in values.iter_mut().enumerate() {
            let mut weight = 1.0;
            for i in 0..=k {
                *value += weight * self.of(k - i);
                weight *= dead_time / (i + 1) as f64;
            }
        }
        Self::new(values)
    }

    /// The areas of `gain * num(s)/den(s) * exp(-s*dead_time)` (Vrančić & Huba 2021, eq. (5)); coefficients in
    /// ascending powers of `s`, the first of each 1; `dead_time` in seconds.
    ///
    /// Relative error 1e-15, whatever the order and the scale of time, as long as the areas do not cancel to less
    /// than 1e-15 of their terms.
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a negative dead time, a first coefficient other than 1, more than
    /// [`MAX_COEFFICIENTS`] coefficients, a denominator with a root outside the open left half-plane, areas beyond
    /// the range of `f64`.
    pub fn of_model(gain: f64, num: &[f64], den: &[f64], dead_time: f64) -> Result<Self, Refusal> {
        let mut areas = [Double::default(); 6];
        series::check(num, den)?;
        series::areas(gain, &[num], &[den], dead_time, &mut areas)?;
        Ok(Self::computed(&areas))
    }

    fn computed(areas: &[Double; 6]) -> Self {
        Self { values: areas.map(|a| a.hi), tails: areas.map(|a| a.lo), error: COMPUTED }
    }

    /// `A_k` with all digits there are.
    pub(crate) fn double(&self, k: usize) -> Double {
        Double { hi: self.values[k], lo: self.tails[k] }
    }

    /// Relative error of each area by rounding alone.
    pub(crate) const fn error(&self) -> f64 {
        self.error
    }
}
