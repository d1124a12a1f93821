//! A compensator's state as slices: one body for the shapes known at compile time and those known at run time.

use super::kernel::{Coefficients, CompensatorOutput};
use crate::delay::{DelayLine, Memory};
use crate::lag::Lag;
use crate::real::Real;
use crate::snapshot::{Reader, Words};

/// Samples for which the chain of applied outputs is followed after the line has filled, when samples were lost.
const SETTLING: usize = 1000;

/// The lags, borrowed.
pub(super) struct LagsView<'a, T> {
    pub(super) y: &'a mut [Lag<T>],
    pub(super) u: &'a mut [Lag<T>],
    pub(super) e: &'a mut [Lag<T>],
}

/// A whole state, borrowed: the same for compile-time and run-time shapes.
pub(super) struct StateView<'a, T, M> {
    pub(super) lags: LagsView<'a, T>,
    pub(super) line: &'a mut DelayLine<M>,
    pub(super) reference: &'a mut T,
}

impl<T: Real, M: Memory<T>> StateView<'_, T, M> {
    /// One sample, see [`super::Compensate::sample`].
    #[inline(always)]
    pub(super) fn sample(mut self, law: &Coefficients<'_, T>, y: T, u_applied: T) -> CompensatorOutput<T> {
        self.line.push(u_applied);
        let u = self.line.tap(law.delay);
        let x = law.advance(&mut self.lags, y, u);
        let d_hat = *self.reference - x;
        CompensatorOutput { u_f: -(law.gain * d_hat), d_hat }
    }

    /// See [`super::Compensate::settle`].
    pub(super) fn settle(mut self, law: &Coefficients<'_, T>, y0: T, u0: T) {
        self.line.fill(u0);
        *self.reference = law.settle(&mut self.lags, y0, u0);
    }

    /// See [`super::Compensate::resettle`].
    pub(super) fn resettle(mut self, law: &Coefficients<'_, T>, y0: T) {
        let u = self.line.tap(law.delay);
        *self.reference = law.settle_y(&mut self.lags, y0, u);
    }

    /// See [`super::Compensate::skip`].
    pub(super) fn skip(self, law: &Coefficients<'_, T>, u: T, n: usize) {
        // Once the line is full of `u`, the chain only settles; after long it has.
        let walked = n.min(self.line.capacity() + SETTLING);
        for _ in 0..walked {
            self.line.push(u);
            let _ = law.u_path(self.lags.u, self.line.tap(law.delay));
        }
        if n > walked {
            self.lags.u.fill(Lag::settled(u));
        }
    }

    /// See [`super::Compensate::restore`].
    pub(super) fn restore(self, reader: &mut Reader<'_>) -> Option<f64> {
        reader.shape(self.lags.y.len(), self.lags.e.len(), self.line.capacity())?;
        reader.lags(self.lags.y)?;
        reader.lags(self.lags.u)?;
        reader.lags(self.lags.e)?;
        *self.reference = reader.number()?;
        reader.line(self.line)
    }
}

/// A whole state, borrowed for reading.
pub(super) struct StateRef<'a, T, M> {
    pub(super) y: &'a [Lag<T>],
    pub(super) u: &'a [Lag<T>],
    pub(super) e: &'a [Lag<T>],
    pub(super) line: &'a DelayLine<M>,
    pub(super) reference: T,
}

impl<T: Real, M: Memory<T>> StateRef<'_, T, M> {
    /// See [`super::Compensate::save`].
    pub(super) fn save(&self, words: &mut impl Words) {
        words.shape(self.y.len(), self.e.len(), self.line.capacity());
        words.lags(self.y);
        words.lags(self.u);
        words.lags(self.e);
        words.number(self.reference);
        words.line(self.line);
    }

    /// See [`super::Compensate::words`].
    pub(super) fn words(&self) -> usize {
        let lags = self.y.len() + self.u.len() + self.e.len();
        // The lags' two parts, the reference and the line; the shape and the line's place.
        (2 * lags + 1 + self.line.capacity()) * T::WORDS + 2
    }

    /// The largest number that any later step can reach from here, for inputs up to `y` and `u` in size: a lag stays
    /// within the larger of itself and its input.
    pub(super) fn reach(&self, law: &Coefficients<'_, T>, y: f64, u: f64) -> f64 {
        let size = |x: &T| x.to_f64().abs();
        let held = |lag: &Lag<T>, input: f64| {
            let state: f64 = lag.parts().iter().map(size).sum();
            if state > input { state } else { input }
        };
        let mut worst = 0.0_f64;
        let mut note = |x: f64| {
            // Written so that a NaN is noted, too.
            worst = if x <= worst { worst } else { x };
            x
        };

        let cells = self.line.parts().0.as_ref().iter().map(size);
        let mut x = note(cells.fold(u, |largest, c| if c > largest { c } else { largest }));
        let mut from_u = 0.0;
        for (lag, lead) in self.u.iter().zip(law.u_lead) {
            let w = note(held(lag, x));
            from_u += note(size(lead) * (x + w));
            x = w;
        }
        from_u = note(from_u + x);

        let mut x = y;
        let sections = law.y_feed.chunks(2).zip(law.y_lead.chunks(2)).zip(law.y_dc.chunks(2));
        for (lags, ((feed, lead), dc)) in self.y.chunks(2).zip(sections) {
            let dc = dc.last().map_or(0.0, size);
            x = match (lags, feed, lead) {
                ([one, two], [feed, _], [e1, e2]) => {
                    let w1 = note(held(one, x));
                    let x2 = note(w1 + size(feed) * (x + w1));
                    let w2 = note(held(two, x2));
                    note(dc * w2 + size(e2) * (x2 + w2) + size(e1) * (x + w1))
                }
                ([one], _, [lead, ..]) => {
                    let w = note(held(one, x));
                    note(dc * w + size(lead) * (x + w))
                }
                _ => x,
            };
        }
        let mut estimate = note(from_u + size(&law.inv_gain) * x);
        for (lag, gain) in self.e.iter().zip(law.e_gain) {
            let w = note(held(lag, estimate));
            estimate = note(w + size(gain) * (estimate + w));
        }
        note(estimate + size(&self.reference));
        worst
    }

    /// What the line will deliver in the next sample, after `u` has been pushed.
    pub(super) fn next_tap(&self, delay: usize, u: T) -> T {
        if delay == 0 { u } else { self.line.tap(delay - 1) }
    }
}
