//! The state of one first-order lag, with compensated accumulation.

use crate::accumulator::Accumulator;
use crate::real::Real;

/// The state `w` of a first-order lag of unit static gain: a signal in the units of the lag's input.
///
/// Law: `W(s)/X(s) = 1/(1 + s*tau)`; difference equation `w[k+1] = w[k] + g*(x[k] - w[k])` with `g = 1 - exp(-ts/tau)`
/// (or any `0 < g <= 1` that the block that owns it computes). The addition is compensated, so a slow lag
/// (`g = 1e-5`) still settles to a rounding error of its input in single precision.
///
/// Every filtered path of the runtime is written with `w[k]` and the difference `x[k] - w[k]`: static gains are
/// then exact by construction, and a law can be swapped while the state, a plain signal, stays valid.
///
/// Source: the lead-lag realisation of the discrete-exact pair; Kahan's addition ([`Accumulator`]).
/// Cost: 6 additions and multiplications.
///
/// ```
/// use controller_core::Lag;
/// let mut lag = Lag::settled(0.0_f64);
/// let before = lag.advance(0.25, 1.0);
/// assert_eq!((before.value, before.difference), (0.0, 1.0));
/// assert_eq!(lag.value(), 0.25);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lag<T> {
    w: Accumulator<T>,
}

/// What a lag was before it took a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LagTap<T> {
    /// `w[k]`.
    pub value: T,
    /// `x[k] - w[k]`.
    pub difference: T,
}

impl<T: Real> Lag<T> {
    /// A lag at rest at `x`.
    #[must_use]
    pub const fn settled(x: T) -> Self {
        Self { w: Accumulator::new(x) }
    }

    /// Takes the sample `x` with gain `g`; returns the state before it.
    #[inline(always)]
    pub fn advance(&mut self, g: T, x: T) -> LagTap<T> {
        let tap = self.tap(x);
        self.w.add(g * tap.difference);
        tap
    }

    /// What [`advance`](Self::advance) would return, without moving.
    #[must_use]
    #[inline(always)]
    pub fn tap(&self, x: T) -> LagTap<T> {
        let value = self.w.value();
        LagTap { value, difference: x - value }
    }

    /// The state `w`.
    #[must_use]
    pub fn value(&self) -> T {
        self.w.value()
    }

    /// The two parts of the state, for a snapshot.
    pub(crate) fn parts(&self) -> [T; 2] {
        [self.w.value(), self.w.carry()]
    }

    /// The inverse of [`parts`](Self::parts).
    pub(crate) const fn from_parts(parts: [T; 2]) -> Self {
        let [value, carry] = parts;
        Self { w: Accumulator::from_parts(value, carry) }
    }
}
