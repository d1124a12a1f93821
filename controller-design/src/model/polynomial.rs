//! Polynomials in `s` with real coefficients.

use core::fmt;
use core::ops::{Add, Mul, Neg, Sub};
use std::vec;
use std::vec::Vec;

use controller_core::plant_model::Factor;

use super::complex::Complex;
use super::factorise::factorise;
use super::number::decimal;

/// A polynomial `c0 + c1*s + c2*s^2 + ...`; coefficient `k` is in `s^k` (seconds to the power of k) when the
/// polynomial has no unit itself.
///
/// The last stored coefficient is never zero; the zero polynomial stores none.
///
/// ```
/// use controller_design::model::Polynomial;
/// let lag = Polynomial::new([1.0, 0.5]);
/// assert_eq!((&lag * &lag).coefficients(), [1.0, 1.0, 0.25]);
/// assert_eq!((&lag * &lag).to_string(), "1+s+0.25*s^2");
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// The polynomial with these coefficients, in ascending powers of `s`. Zeros at the end are dropped.
    #[must_use]
    pub fn new(coefficients: impl Into<Vec<f64>>) -> Self {
        let mut coefficients = coefficients.into();
        while coefficients.last() == Some(&0.0) {
            coefficients.pop();
        }
        Self { coefficients }
    }

    /// The constant polynomial `value`.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::new([value])
    }

    /// `value * s^power`.
    #[must_use]
    pub fn monomial(value: f64, power: usize) -> Self {
        let mut coefficients = vec![0.0; power];
        coefficients.push(value);
        Self::new(coefficients)
    }

    /// The coefficients in ascending powers of `s`, the last one not zero.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The coefficient of `s^power`; 0 beyond the degree.
    #[must_use]
    pub fn coefficient(&self, power: usize) -> f64 {
        self.coefficients.get(power).copied().unwrap_or(0.0)
    }

    /// The degree; 0 for the zero polynomial as well.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }

    /// Whether every coefficient is zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// Whether every coefficient is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.coefficients.iter().all(|c| c.is_finite())
    }

    /// The value at the real number `s`, by Horner's rule.
    ///
    /// ```
    /// use controller_design::model::Polynomial;
    /// assert_eq!(Polynomial::new([1.0, -3.0, 2.0]).at_real(0.5), 0.0);
    /// ```
    #[must_use]
    pub fn at_real(&self, s: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, &c| sum * s + c)
    }

    /// The value at the complex number `s`, by Horner's rule.
    ///
    /// ```
    /// use controller_design::model::{Complex, Polynomial};
    /// assert_eq!(Polynomial::new([1.0, 0.0, 1.0]).at(Complex::new(0.0, 1.0)), Complex::ZERO);
    /// ```
    #[must_use]
    pub fn at(&self, s: Complex) -> Complex {
        self.coefficients.iter().rev().fold(Complex::ZERO, |sum, &c| sum * s + Complex::real(c))
    }

    /// The polynomial with every coefficient multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self::new(self.coefficients.iter().map(|c| c * factor).collect::<Vec<_>>())
    }

    /// The roots in rad/s, as many as the degree, multiple ones repeated; conjugates stand next to each other and
    /// are exact conjugates. A constant has none, nor has a polynomial that is not finite.
    ///
    /// The product of the roots' factors equals the polynomial to a few rounding errors in each coefficient, so
    /// a root is as accurate as the coefficients determine it. Roots that a multiple root explains to that same
    /// accuracy are reported as that multiple root.
    ///
    /// ```
    /// use controller_design::model::{Complex, Polynomial};
    /// let triple = Polynomial::new([1.0, 3.0, 3.0, 1.0]);
    /// for root in triple.roots() {
    ///     assert!((root - Complex::real(-1.0)).abs() < 1e-14);
    /// }
    /// ```
    #[must_use]
    pub fn roots(&self) -> Vec<Complex> {
        if !self.is_finite() {
            return Vec::new();
        }
        let at_origin = self.coefficients.iter().take_while(|&&c| c == 0.0).count();
        let rest = self.coefficients.get(at_origin..).unwrap_or_default();
        let mut roots = vec![Complex::ZERO; at_origin];
        roots.extend(factorise(rest).roots());
        roots
    }

    /// The real factors of first and second order whose product is this polynomial over its constant term, which
    /// must not be zero. A polynomial of degree 2 or less stays one factor.
    pub(crate) fn factors(&self) -> Vec<Factor> {
        factorise(&self.coefficients).unscaled()
    }
}

impl Add for &Polynomial {
    type Output = Polynomial;

    fn add(self, other: Self) -> Polynomial {
        let length = self.coefficients.len().max(other.coefficients.len());
        Polynomial::new((0..length).map(|k| self.coefficient(k) + other.coefficient(k)).collect::<Vec<_>>())
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;

    fn sub(self, other: Self) -> Polynomial {
        self + &-other
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;

    fn mul(self, other: Self) -> Polynomial {
        if self.is_zero() || other.is_zero() {
            return Polynomial::default();
        }
        let mut product = vec![0.0; self.degree() + other.degree() + 1];
        for (i, a) in self.coefficients.iter().enumerate() {
            for (sum, b) in product.iter_mut().skip(i).zip(&other.coefficients) {
                *sum += a * b;
            }
        }
        Polynomial::new(product)
    }
}

impl Neg for &Polynomial {
    type Output = Polynomial;

    fn neg(self) -> Polynomial {
        self.scaled(-1.0)
    }
}

impl fmt::Display for Polynomial {
    /// As an expression in `s`, ascending: `1+0.4*s+s^2`. Every number reads back as the same number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_zero() {
            return f.write_str("0");
        }
        let mut first = true;
        for (power, &c) in self.coefficients.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            if c < 0.0 {
                f.write_str("-")?;
            } else if !first {
                f.write_str("+")?;
            }
            first = false;
            let size = c.abs();
            match power {
                0 => f.write_str(&decimal(size))?,
                _ if size == 1.0 => f.write_str("s")?,
                _ => write!(f, "{}*s", decimal(size))?,
            }
            if power > 1 {
                write!(f, "^{power}")?;
            }
        }
        Ok(())
    }
}
