//! Compensated accumulation: a running sum that does not stall.

use crate::real::Real;

/// A running sum with the rounding error of the last addition kept beside it (Kahan's compensated addition).
///
/// Law: `sum <- sum + x`, exact to about `eps^2` of the sum instead of `eps`. A plain single-precision integrator
/// at 100 stops moving when an increment falls below 4e-6; this one goes on down to about 2e-13.
///
/// Difference equation: `t = x + carry; s = sum + t; carry = t - (s - sum); sum = s`.
/// Cost: 4 additions. Never fails; finite inputs whose sum is finite keep it finite.
/// Source: W. Kahan, "Further remarks on reducing truncation errors", Comm. ACM 8 (1965) 40.
///
/// ```
/// use controller_core::Accumulator;
/// let mut plain = 100.0_f32;
/// let mut kept = Accumulator::new(100.0_f32);
/// for _ in 0..1_000_000 {
///     plain += 1.0e-6;
///     kept.add(1.0e-6);
/// }
/// assert_eq!(plain, 100.0); // stalled
/// assert!((kept.value() - 101.0).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accumulator<T> {
    sum: T,
    carry: T,
}

impl<T: Real> Accumulator<T> {
    /// A sum that starts at `value`.
    #[must_use]
    pub const fn new(value: T) -> Self {
        Self { sum: value, carry: T::ZERO }
    }

    /// Adds `x`.
    #[inline(always)]
    pub fn add(&mut self, x: T) {
        let t = x + self.carry;
        let s = self.sum + t;
        self.carry = t - (s - self.sum);
        self.sum = s;
    }

    /// Starts again at `value`.
    #[inline(always)]
    pub fn set(&mut self, value: T) {
        self.sum = value;
        self.carry = T::ZERO;
    }

    /// Goes to `target`, but by no more than `up` or `down`; returns whether that held it back. A step far below a unit in
    /// the last place still adds up: a ramp does not stall.
    #[inline(always)]
    pub fn approach(&mut self, target: T, down: T, up: T) -> bool {
        let way = target - self.sum;
        if way > up {
            self.add(up);
        } else if way < -down {
            self.add(-down);
        } else {
            self.set(target);
            return false;
        }
        true
    }

    /// The sum, rounded to `T`.
    #[must_use]
    #[inline(always)]
    pub fn value(&self) -> T {
        self.sum
    }

    /// `x` minus the sum, with the part of it that does not fit in [`value`](Self::value).
    #[must_use]
    #[inline(always)]
    pub fn short_of(&self, x: T) -> T {
        (x - self.sum) - self.carry
    }

    /// Keeps the sum within `-most..=most`.
    #[inline(always)]
    pub(crate) fn keep_within(&mut self, most: T) {
        // Written so that a NaN, which no sum of checked numbers gives, could not stay either.
        let inside = self.sum.magnitude() <= most;
        if !inside {
            self.set(self.sum.clamp_to(-most, most));
        }
    }

    /// The part of the sum that does not fit in [`value`](Self::value).
    #[must_use]
    pub fn carry(&self) -> T {
        self.carry
    }

    /// A sum from its two parts, for restoring a snapshot.
    #[must_use]
    pub(crate) const fn from_parts(sum: T, carry: T) -> Self {
        Self { sum, carry }
    }
}
