//! Numbers of a loop and counts of an ADC or a DAC.

use controller_core::Real;

/// A [`Real`] that converts from and to counts; `f32` and `f64`.
///
/// ```
/// use controller_hal::Number;
/// assert_eq!(f32::from_counts(-7), -7.0);
/// assert_eq!((2.9_f32.to_counts(), (-2.9_f32).to_counts()), (2, -2));
/// // Every bit pattern has a count: no number is out of reach and none is left undefined.
/// assert_eq!((f64::INFINITY.to_counts(), f64::NAN.to_counts()), (i32::MAX, 0));
/// ```
pub trait Number: Real {
    /// The nearest number; exact up to 2^24 in size for `f32`.
    #[must_use]
    fn from_counts(counts: i32) -> Self;
    /// The number without its fraction; beyond the range of counts the end of that range, 0 for a NaN.
    #[must_use]
    fn to_counts(self) -> i32;
}

impl Number for f32 {
    #[inline]
    #[allow(clippy::cast_precision_loss)] // as documented
    fn from_counts(counts: i32) -> Self {
        counts as f32
    }
    #[inline]
    #[allow(clippy::cast_possible_truncation)] // as documented
    fn to_counts(self) -> i32 {
        self as i32
    }
}

impl Number for f64 {
    #[inline]
    fn from_counts(counts: i32) -> Self {
        f64::from(counts)
    }
    #[inline]
    #[allow(clippy::cast_possible_truncation)] // as documented
    fn to_counts(self) -> i32 {
        self as i32
    }
}
