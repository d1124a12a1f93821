//! Arithmetic on rational functions with dead time that keeps their factors.
//!
//! A value is `gain * prod(num) * exp(-s*dead_time) / (s^origin * prod(den))`. Products, quotients and powers only
//! join lists; a sum expands what its two terms do not have in common.

use std::vec;
use std::vec::Vec;

use super::polynomial::Polynomial;

/// The largest degree of a numerator or denominator.
pub const MAX_DEGREE: usize = 20;

/// Two dead times this close (relative) are the same: `0.3` and `0.1+0.2` differ by rounding only.
const SAME: f64 = 4.0 * f64::EPSILON;

/// An operation without a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    DivisionByZero,
    /// `0^0`.
    ZeroToTheZero,
    /// The dead times of the two terms in seconds.
    DeadTimesDiffer(f64, f64),
    /// A number too large or too small for `f64`.
    OutOfRange,
    /// The degree of the result.
    DegreeTooHigh(usize),
}

/// The value; see the module. No polynomial is a constant or has a zero constant term. Denominators are
/// normalised to a constant term of 1; a numerator that is a sum not yet multiplied is kept as it was added up,
/// so that a sum of many terms rounds no coefficient twice.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Factored {
    /// 0 only for the zero function; everything else is then empty or 0.
    pub(crate) gain: f64,
    /// Poles at `s = 0`; negative: zeros there.
    pub(crate) origin: isize,
    pub(crate) num: Vec<Polynomial>,
    pub(crate) den: Vec<Polynomial>,
    /// In seconds; may be negative on the way.
    pub(crate) dead_time: f64,
}

impl Factored {
    pub(crate) fn constant(gain: f64) -> Self {
        Self { gain, origin: 0, num: Vec::new(), den: Vec::new(), dead_time: 0.0 }
    }

    /// `s`.
    pub(crate) fn s() -> Self {
        Self { origin: -1, ..Self::constant(1.0) }
    }

    /// `exp(-s*dead_time)`.
    pub(crate) fn delay(dead_time: f64) -> Self {
        Self { dead_time, ..Self::constant(1.0) }
    }

    /// A polynomial; its powers of `s` are taken out.
    pub(crate) fn polynomial(p: &Polynomial) -> Self {
        let zeros = p.coefficients().iter().take_while(|c| **c == 0.0).count();
        let rest = p.coefficients().get(zeros..).unwrap_or_default();
        match *rest {
            [] => Self::constant(0.0),
            [c] => Self { origin: -(zeros as isize), ..Self::constant(c) },
            _ => Self { origin: -(zeros as isize), num: vec![Polynomial::new(rest)], ..Self::constant(1.0) },
        }
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.gain == 0.0
    }

    /// The value of a constant.
    pub(crate) fn as_constant(&self) -> Option<f64> {
        let plain = self.origin == 0 && self.num.is_empty() && self.den.is_empty() && self.dead_time == 0.0;
        plain.then_some(self.gain)
    }

    /// Degree of the numerator, zeros at `s = 0` included.
    pub(crate) fn num_degree(&self) -> usize {
        self.origin.min(0).unsigned_abs() + degree(&self.num)
    }

    /// Degree of the denominator, poles at `s = 0` included.
    pub(crate) fn den_degree(&self) -> usize {
        self.origin.max(0).unsigned_abs() + degree(&self.den)
    }

    /// The value, if all of its numbers and degrees are in range.
    pub(crate) fn checked(self) -> Result<Self, Fault> {
        let finite = |list: &[Polynomial]| list.iter().all(Polynomial::is_finite);
        if !(self.gain.is_finite() && self.dead_time.is_finite() && finite(&self.num) && finite(&self.den)) {
            return Err(Fault::OutOfRange);
        }
        match self.num_degree().max(self.den_degree()) {
            degree if degree > MAX_DEGREE => Err(Fault::DegreeTooHigh(degree)),
            _ => Ok(self),
        }
    }

    /// The same value, every numerator polynomial with a constant term of 1.
    pub(crate) fn normalised(mut self) -> Result<Self, Fault> {
        for p in &mut self.num {
            let constant = p.coefficient(0);
            if constant != 1.0 {
                let unit = Polynomial::new(p.coefficients().iter().map(|c| c / constant).collect::<Vec<_>>());
                if unit.degree() != p.degree() {
                    return Err(Fault::OutOfRange);
                }
                *p = unit;
                self.gain = product(self.gain, constant)?;
            }
        }
        self.checked()
    }

    pub(crate) fn neg(mut self) -> Self {
        if !self.is_zero() {
            self.gain = -self.gain;
        }
        self
    }

    pub(crate) fn mul(self, other: Self) -> Result<Self, Fault> {
        let (mut a, b) = (self.normalised()?, other.normalised()?);
        if a.is_zero() || b.is_zero() {
            return Ok(Self::constant(0.0));
        }
        a.gain = product(a.gain, b.gain)?;
        a.origin += b.origin;
        a.num.extend(b.num);
        a.den.extend(b.den);
        a.dead_time += b.dead_time;
        a.checked()
    }

    pub(crate) fn div(self, other: Self) -> Result<Self, Fault> {
        let b = other.normalised()?;
        if b.is_zero() {
            return Err(Fault::DivisionByZero);
        }
        let mut a = self.normalised()?;
        if a.is_zero() {
            return Ok(a);
        }
        a.gain = in_range(a.gain / b.gain)?;
        a.origin -= b.origin;
        a.num.extend(b.den);
        a.den.extend(b.num);
        a.dead_time -= b.dead_time;
        a.checked()
    }

    /// The value to a whole power; `|n|` at most [`MAX_DEGREE`], for which the caller sees.
    pub(crate) fn pow(self, n: i32) -> Result<Self, Fault> {
        if n < 0 {
            return Self::constant(1.0).div(self.pow(-n)?);
        }
        if self.is_zero() {
            return if n == 0 { Err(Fault::ZeroToTheZero) } else { Ok(self) };
        }
        let base = self.normalised()?;
        let degree = n.unsigned_abs() as usize * base.num_degree().max(base.den_degree());
        if degree > MAX_DEGREE {
            return Err(Fault::DegreeTooHigh(degree));
        }
        (0..n).try_fold(Self::constant(1.0), |power, _| power.mul(base.clone()))
    }

    pub(crate) fn add(self, other: Self) -> Result<Self, Fault> {
        let (mut a, mut b) = (self, other);
        if a.is_zero() || b.is_zero() {
            return Ok(if a.is_zero() { b } else { a });
        }
        if (a.dead_time - b.dead_time).abs() > SAME * a.dead_time.abs().max(b.dead_time.abs()) {
            return Err(Fault::DeadTimesDiffer(a.dead_time, b.dead_time));
        }
        let common_num = take_common(&mut a.num, &mut b.num);
        let common_den = take_common(&mut a.den, &mut b.den);
        let origin = a.origin.max(b.origin);
        let common = Self { gain: 1.0, origin, num: common_num, den: common_den, dead_time: a.dead_time };
        let top = add_cancelling(&expanded(&a, &b.den, origin)?, &expanded(&b, &a.den, origin)?);
        let top = Self::polynomial(&top);
        if top.is_zero() {
            return Ok(top);
        }
        let mut sum = common;
        sum.gain = top.gain;
        sum.origin += top.origin;
        sum.num.extend(top.num);
        sum.den.extend(a.den);
        sum.den.extend(b.den);
        sum.checked()
    }
}

fn degree(list: &[Polynomial]) -> usize {
    list.iter().map(Polynomial::degree).sum()
}

/// The number, unless it left the range of `f64` at either end.
fn in_range(value: f64) -> Result<f64, Fault> {
    if value.is_finite() && value != 0.0 { Ok(value) } else { Err(Fault::OutOfRange) }
}

/// The product of two numbers that are not zero.
fn product(a: f64, b: f64) -> Result<f64, Fault> {
    in_range(a * b)
}

/// Removes the polynomials that stand in both lists from both and returns them.
fn take_common(a: &mut Vec<Polynomial>, b: &mut Vec<Polynomial>) -> Vec<Polynomial> {
    let mut common = Vec::new();
    a.retain(|p| match b.iter().position(|q| q == p) {
        Some(k) => {
            common.push(b.remove(k));
            false
        }
        None => true,
    });
    common
}

/// One term's numerator over the common denominator, written out: its own numerator, the other term's `den`, and
/// the powers of `s` it lacks from `s^origin`.
fn expanded(term: &Factored, other_den: &[Polynomial], origin: isize) -> Result<Polynomial, Fault> {
    let powers = (origin - term.origin).unsigned_abs();
    let degree = powers + degree(&term.num) + degree(other_den);
    if degree > MAX_DEGREE {
        return Err(Fault::DegreeTooHigh(degree));
    }
    let start = Polynomial::monomial(term.gain, powers);
    let product = term.num.iter().chain(other_den).fold(start, |product, p| &product * p);
    // A leading coefficient that vanished in the product would change the order of the plant unseen.
    if product.degree() == degree && product.is_finite() { Ok(product) } else { Err(Fault::OutOfRange) }
}

/// The sum, with 0 in place of what is left by rounding where two coefficients cancel: `0.1+0.2-0.3` is 0.
fn add_cancelling(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let length = a.coefficients().len().max(b.coefficients().len());
    let sum = (0..length).map(|k| {
        let (x, y) = (a.coefficient(k), b.coefficient(k));
        if (x + y).abs() <= SAME * x.abs().max(y.abs()) { 0.0 } else { x + y }
    });
    Polynomial::new(sum.collect::<Vec<_>>())
}
