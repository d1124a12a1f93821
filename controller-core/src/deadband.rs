//! Error deadband: a loop that leaves small errors alone.

use crate::error::{Checker, ConfigErrors, Param};
use crate::limit::RANGE_LIMIT;
use crate::real::{Real, coefficient};

/// An error deadband of half width `w`.
///
/// Law: with `e = r - y`, the measurement handed to the PID is `y' = r - (e - clamp(e, -w, w))`: inside the band the
/// PID sees no error and no noise, outside it the error is reduced by `w`, without a jump at the edge. All PID
/// terms see the band; the disturbance compensator does not. Since the PID sees `r` in place of `y` inside the band, a
/// set-point that moves by `dr` within it acts on the proportional term as `(b-1)*dr`, on the derivative as `(c-1)*dr`.
/// Source: own; the common dead zone on the error, kept continuous.
/// Cost: 2 compares, 2 additions. Units: those of `y`; range 0 to 1e12; `w = 0` passes `y` through exactly.
///
/// ```
/// use controller_core::Deadband;
/// let band = Deadband::<f64>::new(0.5).unwrap();
/// assert_eq!(band.apply(10.0, 10.25), 10.0); // inside: no error
/// assert_eq!(band.apply(10.0, 8.0), 8.5); // outside: error 2 becomes 1.5
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deadband<T> {
    width: T,
}

impl<T: Real> Deadband<T> {
    /// A band from `-width` to `width` \[y\].
    ///
    /// # Errors
    /// `width` not finite, negative or above 1e12.
    pub fn new(width: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        check.range(Param::Deadband, width, 0.0, RANGE_LIMIT);
        check.finish(Self { width: coefficient(width) })
    }

    /// Half width \[y\].
    #[must_use]
    pub fn width(&self) -> T {
        self.width
    }

    /// The measurement as the PID is to see it \[y\].
    #[must_use]
    #[inline(always)]
    pub fn apply(&self, r: T, y: T) -> T {
        // Inside the band the result is `r` itself: a rounding error left over would be integrated for ever.
        let e = r - y;
        if e > self.width {
            y + self.width
        } else if e < -self.width {
            y - self.width
        } else {
            r
        }
    }
}
