//! Polynomial values in twice the working precision.
//!
//! Near a cluster of roots a polynomial is the small difference of large terms; in plain `f64` its value there is
//! rounding error long before the roots are found.

use super::complex::Complex;
use crate::double::Double;

/// Relative error of one operation.
pub(crate) const EPSILON: f64 = f64::EPSILON * f64::EPSILON;

/// A polynomial's value and slope at one point, built up coefficient by coefficient.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Horner {
    value: (Double, Double),
    slope: (Double, Double),
}

impl Horner {
    /// Takes in the next lower coefficient `c` of the polynomial at `x`.
    pub(crate) fn step(&mut self, x: Complex, c: f64) {
        let (re, im) = times(self.slope, x);
        self.slope = (re.add(self.value.0), im.add(self.value.1));
        let (re, im) = times(self.value, x);
        self.value = (re.add(Double::new(c)), im);
    }

    /// The value, rounded.
    pub(crate) const fn value(&self) -> Complex {
        Complex::new(self.value.0.hi, self.value.1.hi)
    }

    /// The derivative, rounded.
    pub(crate) const fn slope(&self) -> Complex {
        Complex::new(self.slope.0.hi, self.slope.1.hi)
    }
}

/// `a*x`, real and imaginary part.
fn times(a: (Double, Double), x: Complex) -> (Double, Double) {
    (a.0.times(x.re).sub(a.1.times(x.im)), a.0.times(x.im).add(a.1.times(x.re)))
}
