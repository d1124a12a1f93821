//! Complex numbers in double precision.

use core::fmt;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::number::decimal;

/// A complex number `re + j*im`; as a value of the Laplace variable `s` both parts are in rad/s.
///
/// ```
/// use controller_design::model::Complex;
/// let s = Complex::new(0.0, 2.0);
/// assert_eq!(s * s, Complex::real(-4.0));
/// assert_eq!((Complex::real(1.0) / s).im, -0.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// `0`.
    pub const ZERO: Self = Self::real(0.0);
    /// `1`.
    pub const ONE: Self = Self::real(1.0);

    /// `re + j*im`.
    #[must_use]
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// The real number `re`.
    #[must_use]
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// The conjugate `re - j*im`.
    #[must_use]
    pub const fn conj(self) -> Self {
        Self { re: self.re, im: -self.im }
    }

    /// The modulus, without overflow or underflow on the way.
    ///
    /// ```
    /// use controller_design::model::Complex;
    /// assert!((Complex::new(3e200, -4e200).abs() / 5e200 - 1.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn abs(self) -> f64 {
        libm::hypot(self.re, self.im)
    }

    /// The argument in radians, in `[-pi, pi]`.
    #[must_use]
    pub fn arg(self) -> f64 {
        libm::atan2(self.im, self.re)
    }

    /// `e` to the power of this number.
    ///
    /// ```
    /// use controller_design::model::Complex;
    /// let turned = Complex::new(0.0, core::f64::consts::PI).exp();
    /// assert!((turned + Complex::ONE).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn exp(self) -> Self {
        let modulus = libm::exp(self.re);
        // Off the general path: an overflowing modulus times a sine of zero would be NaN.
        if self.im == 0.0 {
            return Self::real(modulus);
        }
        Self { re: modulus * libm::cos(self.im), im: modulus * libm::sin(self.im) }
    }

    /// Whether both parts are finite.
    #[must_use]
    pub const fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

impl Div for Complex {
    type Output = Self;

    /// Smith's algorithm: no overflow of the squared modulus. Division by zero gives NaN.
    fn div(self, other: Self) -> Self {
        if other.re.abs() >= other.im.abs() {
            let ratio = other.im / other.re;
            let scale = other.re + other.im * ratio;
            Self { re: (self.re + self.im * ratio) / scale, im: (self.im - self.re * ratio) / scale }
        } else {
            let ratio = other.re / other.im;
            let scale = other.re * ratio + other.im;
            Self { re: (self.re * ratio + self.im) / scale, im: (self.im * ratio - self.re) / scale }
        }
    }
}

impl Neg for Complex {
    type Output = Self;

    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl fmt::Display for Complex {
    /// `-0.2+0.9j`; a real number without its imaginary part.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.im == 0.0 {
            return f.write_str(&decimal(self.re));
        }
        let sign = if self.im < 0.0 { '-' } else { '+' };
        write!(f, "{}{sign}{}j", decimal(self.re), decimal(self.im.abs()))
    }
}
