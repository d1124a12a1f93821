//! The two number types of the runtime: `f32` and `f64`.
//!
//! A step uses `+ - * /`, comparison and `abs` only, so that equal inputs give equal bits on every machine.
//! Everything that needs `exp` or `sqrt` happens in `new`, in `f64`, with `libm` on every platform.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point number a law can run in: `f32` (what a small target runs) or `f64`.
///
/// Sealed: an integer or a fixed-point type would compile and be wrong, because gains and divisions assume a
/// float's range.
///
/// ```
/// use controller_core::Real;
/// assert_eq!(f32::from_f64(0.1), 0.1_f32);
/// assert!(!f64::NAN.is_finite_number());
/// // A NaN never leaves a clamp: it goes to the lower bound.
/// assert_eq!(f32::NAN.clamp_to(-1.0, 1.0), -1.0);
/// ```
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Largest finite value, as `f64`.
    const LARGEST: f64;
    /// Smallest positive normal value, as `f64`.
    const SMALLEST_NORMAL: f64;
    /// Distance from 1 to the next number, as `f64`.
    const EPS: f64;
    /// 32-bit words that hold one number in a snapshot.
    const WORDS: usize;

    /// The nearest number of this type.
    #[must_use]
    fn from_f64(x: f64) -> Self;
    /// The same value as `f64`.
    #[must_use]
    fn to_f64(self) -> f64;
    /// Absolute value.
    #[must_use]
    fn magnitude(self) -> Self;
    /// Neither infinite nor NaN.
    #[must_use]
    fn is_finite_number(self) -> bool;
    /// The bit pattern as two 32-bit words, low word first; an `f32` has a zero high word.
    #[must_use]
    fn to_words(self) -> [u32; 2];
    /// The number with these bits, the inverse of [`to_words`](Self::to_words).
    #[must_use]
    fn from_words(words: [u32; 2]) -> Self;

    /// `self` moved into `lo..=hi` by two selects; a NaN becomes `lo`. Needs `lo <= hi`.
    ///
    /// Cost: two compares, no call, no panic path (`f32::clamp` has one).
    #[must_use]
    #[inline(always)]
    fn clamp_to(self, lo: Self, hi: Self) -> Self {
        let above = if self > lo { self } else { lo };
        if above < hi { above } else { hi }
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const LARGEST: f64 = f32::MAX as f64;
    const SMALLEST_NORMAL: f64 = f32::MIN_POSITIVE as f64;
    const EPS: f64 = f32::EPSILON as f64;
    const WORDS: usize = 1;

    #[inline]
    #[allow(clippy::cast_possible_truncation)] // rounding to single precision is what is asked for
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn is_finite_number(self) -> bool {
        self.abs() <= f32::MAX
    }
    #[inline]
    fn to_words(self) -> [u32; 2] {
        [self.to_bits(), 0]
    }
    #[inline]
    fn from_words(words: [u32; 2]) -> Self {
        let [low, _] = words;
        f32::from_bits(low)
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const LARGEST: f64 = f64::MAX;
    const SMALLEST_NORMAL: f64 = f64::MIN_POSITIVE;
    const EPS: f64 = f64::EPSILON;
    const WORDS: usize = 2;

    #[inline]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn is_finite_number(self) -> bool {
        self.abs() <= f64::MAX
    }
    #[inline]
    #[allow(clippy::cast_possible_truncation)] // the two halves of the bit pattern
    fn to_words(self) -> [u32; 2] {
        let bits = self.to_bits();
        [bits as u32, (bits >> 32) as u32]
    }
    #[inline]
    fn from_words(words: [u32; 2]) -> Self {
        let [low, high] = words;
        f64::from_bits(u64::from(low) | (u64::from(high) << 32))
    }
}

/// A coefficient computed in `f64`, rounded once; a value below the normal range becomes 0, so that a law's
/// cost and bits do not depend on how a core treats subnormals.
pub(crate) fn coefficient<T: Real>(x: f64) -> T {
    if x.abs() < T::SMALLEST_NORMAL { T::ZERO } else { T::from_f64(x) }
}
