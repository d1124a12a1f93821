//! Polynomial values in twice the working precision.
//!
//! Near a cluster of roots a polynomial is the small difference of large terms; in plain `f64` its value there is
//! rounding error long before the roots are found. A number is carried as the unevaluated sum of two `f64`
//! (Dekker 1971), some 106 bits.

use super::complex::Complex;

/// Relative error of one operation.
pub(crate) const EPSILON: f64 = f64::EPSILON * f64::EPSILON;

/// The number `hi + lo`, `|lo|` at most half a unit in the last place of `hi`.
#[derive(Debug, Clone, Copy, Default)]
struct Double {
    hi: f64,
    lo: f64,
}

impl Double {
    const fn new(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// `a + b` exactly, `|a| >= |b|`.
    fn renormalised(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    fn add(self, other: Self) -> Self {
        let sum = self.hi + other.hi;
        let part = sum - self.hi;
        // What the addition of the high parts lost, exactly.
        let lost = (self.hi - (sum - part)) + (other.hi - part);
        Self::renormalised(sum, lost + (self.lo + other.lo))
    }

    fn sub(self, other: Self) -> Self {
        self.add(Self { hi: -other.hi, lo: -other.lo })
    }

    fn times(self, factor: f64) -> Self {
        let product = self.hi * factor;
        let ((a, b), (c, d)) = (halves(self.hi), halves(factor));
        let lost = ((a * c - product) + a * d + b * c) + b * d;
        Self::renormalised(product, lost + self.lo * factor)
    }
}

/// The number as a sum of two with 26 bits each, whose products are exact (Veltkamp).
fn halves(x: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * x;
    let high = shifted - (shifted - x);
    (high, x - high)
}

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
