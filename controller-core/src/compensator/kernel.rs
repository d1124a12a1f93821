//! The one step that every compensator runs, over slices, and the trait the controller sees.

use super::view::LagsView;
use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::lag::Lag;
use crate::real::Real;
use crate::snapshot::{Reader, Words};

/// What a compensator gives in one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CompensatorOutput<T> {
    /// What to add to the controller's output \[u\]: `u_f = -gain*d_hat`.
    pub u_f: T,
    /// Estimated disturbance at the plant input \[u\], relative to the point of initialisation.
    pub d_hat: T,
}

/// The coefficients of a compensator, borrowed: what the step uses, what an export writes and what an analysis of
/// the deployed law reads. The difference equation is that of [`Compensator`](super::Compensator).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients<'a, T> {
    /// Gains `g = 1-p` of the lags, for the `y` and for the `u` chain.
    pub g: &'a [T],
    /// Share of a first lag's difference that the second lag of its section is fed, at the index of the first.
    pub y_feed: &'a [T],
    /// Weights of the differences in the `y` sections: `E_1, E_2` for every two lags, one for a single last lag.
    pub y_lead: &'a [T],
    /// Static gains of the `y` sections (1, or 0 when integrating) at the index of each section's last lag.
    pub y_dc: &'a [T],
    /// Weights `E_j` of the differences in the `u` chain.
    pub u_lead: &'a [T],
    /// Gains of the lags that both paths share.
    pub e_gain: &'a [T],
    /// `1/K` of the model.
    pub inv_gain: T,
    /// Share of the estimated disturbance that is fed back.
    pub gain: T,
    /// Whole samples of delay in front of the `u` chain, behind the one that every sampled loop has.
    pub delay: usize,
}

impl<T: Real> Coefficients<'_, T> {
    /// The unscaled estimate `x = (u path) - (y path)/K`: minus the disturbance, filtered. Moves the lags.
    #[inline(always)]
    pub(super) fn advance(&self, lags: &mut LagsView<'_, T>, y: T, u: T) -> T {
        let from_u = self.u_path(lags.u, u);
        let from_y = self.y_path(lags.y, y);
        let mut x = from_u - self.inv_gain * from_y;
        for (lag, &g) in lags.e.iter_mut().zip(self.e_gain) {
            // (1+z^-1)/2 behind a lag: the mean of its state before and after the sample.
            let before = lag.advance(g, x);
            x = before.value + (g * T::from_f64(0.5)) * before.difference;
        }
        x
    }

    /// A chain of lags, each fed by the state before it: `w_n + sum E_j*(w_(j-1) - w_j)`.
    #[inline(always)]
    pub(super) fn u_path(&self, lags: &mut [Lag<T>], u: T) -> T {
        let mut x = u;
        let mut sum = T::ZERO;
        for ((lag, &g), &lead) in lags.iter_mut().zip(self.g).zip(self.u_lead) {
            let before = lag.advance(g, x);
            sum = sum + lead * before.difference;
            x = before.value;
        }
        sum + x
    }

    /// A cascade of second-order sections, and one of first order when the number of lags is odd.
    #[inline(always)]
    fn y_path(&self, lags: &mut [Lag<T>], y: T) -> T {
        let mut x = y;
        let (sections, rest) = lags.as_chunks_mut::<2>();
        let [(g, _), (feed, _), (lead, _), (dc, _)] =
            [self.g, self.y_feed, self.y_lead, self.y_dc].map(<[T]>::as_chunks::<2>);
        let gains = g.iter().zip(feed);
        let weights = lead.iter().zip(dc);
        for (([first, second], (g, feed)), (lead, dc)) in sections.iter_mut().zip(gains).zip(weights) {
            let (&[g1, g2], &[feed, _], &[e1, e2], &[_, dc]) = (g, feed, lead, dc);
            let one = first.advance(g1, x);
            let two = second.advance(g2, one.value + feed * one.difference);
            x = (dc * two.value + e2 * two.difference) + e1 * one.difference;
        }
        if let ([lag], Some(&g), Some(&lead), Some(&dc)) =
            (rest, self.g.last(), self.y_lead.last(), self.y_dc.last())
        {
            let before = lag.advance(g, x);
            x = dc * before.value + lead * before.difference;
        }
        x
    }

    /// Puts all lags at rest for the measurement `y0` and the delayed input `u0`; returns the estimate there.
    pub(super) fn settle(&self, lags: &mut LagsView<'_, T>, y0: T, u0: T) -> T {
        lags.u.fill(Lag::settled(u0));
        self.settle_y(lags, y0, u0)
    }

    /// Puts the lags of the `y` path and the shared ones at rest for the measurement `y0`; the `u` chain, which has
    /// followed the applied output all along, goes on. Returns the estimate there; `u` is the delayed input.
    pub(super) fn settle_y(&self, lags: &mut LagsView<'_, T>, y0: T, u: T) -> T {
        let mut x = y0;
        for (section, dc) in lags.y.chunks_mut(2).zip(self.y_dc.chunks(2)) {
            section.fill(Lag::settled(x));
            x = x * dc.last().copied().unwrap_or_default();
        }
        let estimate = self.preview_u(lags.u, u) - self.inv_gain * x;
        lags.e.fill(Lag::settled(estimate));
        estimate
    }

    /// The output of the `u` chain for the input `u`, without moving it.
    fn preview_u(&self, lags: &[Lag<T>], u: T) -> T {
        let mut x = u;
        let mut sum = T::ZERO;
        for (lag, &lead) in lags.iter().zip(self.u_lead) {
            let tap = lag.tap(x);
            sum = sum + lead * tap.difference;
            x = tap.value;
        }
        sum + x
    }

    /// Largest size of any number in the `y` path per unit of `y`, and in the `u` path per unit of `u`, the estimate
    /// included, for overflow checks. Infinite or NaN when a coefficient is.
    pub(super) fn bounds(&self) -> (f64, f64) {
        let size = |x: &T| x.to_f64().abs();
        let sum = |list: &[T]| list.iter().map(size).sum::<f64>();
        let (mut signal, mut largest) = (1.0_f64, 1.0_f64);
        for ((lead, dc), feed) in self.y_lead.chunks(2).zip(self.y_dc.chunks(2)).zip(self.y_feed.chunks(2)) {
            // A lag stays within its input, a difference within twice of it.
            let fed = (1.0 + 2.0 * sum(feed)) * signal;
            signal = (2.0 * sum(lead) + sum(dc)) * fed;
            largest = largest + fed + signal;
        }
        let from_y = largest + signal * size(&self.inv_gain);
        (from_y, 1.0 + 2.0 * sum(self.u_lead))
    }

    /// All of them, in order.
    #[inline(always)]
    pub(super) fn write(&self, words: &mut impl Words) {
        let length = |list: &[T]| u32::try_from(list.len()).unwrap_or(0);
        let of_y = length(self.g) | length(self.y_feed) << 4 | length(self.y_lead) << 8;
        let others = length(self.y_dc) << 12 | length(self.u_lead) << 16 | length(self.e_gain) << 20;
        words.word(of_y | others);
        let of_y = self.g.iter().zip(self.y_feed).zip(self.y_lead.iter().zip(self.y_dc));
        for (((g, feed), (lead, dc)), u_lead) in of_y.zip(self.u_lead) {
            words.number(*g);
            words.number(*feed);
            words.number(*lead);
            words.number(*dc);
            words.number(*u_lead);
        }
        words.numbers(self.e_gain);
        words.number(self.inv_gain);
        words.number(self.gain);
        words.word(u32::try_from(self.delay).unwrap_or(u32::MAX));
    }

    /// Refuses coefficients that do not fit the number type.
    #[inline(never)]
    pub(super) fn check(&self) -> Result<(), ConfigErrors> {
        let mut check = Checker::default();
        if !self.is_finite() {
            let (y, u) = self.bounds();
            let worst = if y > u { y } else { u };
            check.fault(Param::Overflow, Reason::OutOfRange, worst, 0.0, T::LARGEST);
        }
        check.into_result()
    }

    fn is_finite(&self) -> bool {
        let (y, u) = self.bounds();
        let rest =
            [self.inv_gain, self.gain].iter().chain(self.g).chain(self.e_gain).all(|x| x.is_finite_number());
        y <= T::LARGEST && u <= T::LARGEST && rest
    }
}

mod sealed {
    pub trait Sealed {}
}
pub(super) use sealed::Sealed;

/// What a [`Controller`](crate::Controller) asks of its disturbance compensator. Sealed: the blocks of this crate
/// implement it ([`NoCompensator`](super::NoCompensator), [`Compensator`](super::Compensator),
/// [`AnyCompensator`](super::AnyCompensator)).
pub trait Compensate<T: Real>: Sealed {
    /// The block's state.
    type State: Clone;

    /// Whether there is anything to use.
    const PRESENT: bool = true;

    /// Takes one sample: pushes the applied output `u_applied = u[k-1]` into the delay line, reads `y[k]`.
    fn sample(&self, state: &mut Self::State, y: T, u_applied: T) -> CompensatorOutput<T>;

    /// Everything at rest at `(y0, u0)`, the whole delay line at `u0`: nothing moves, `d_hat = 0`.
    fn settle(&self, state: &mut Self::State, y0: T, u0: T);

    /// The part that follows `y` at rest at `y0`, while the delay line and the lags of the applied output, which have gone
    /// on, keep their history. `d_hat = 0`.
    fn resettle(&self, state: &mut Self::State, y0: T);

    /// `n` samples were lost while `u` was applied: the delay line and the chain of applied outputs go on. At most 1000
    /// samples plus the line's capacity are walked through; after more, the chain counts as settled.
    fn skip(&self, state: &mut Self::State, u: T, n: usize);

    /// Takes the state over from `old`; `y` and `u` are the last measurement and output. `d_hat` does not jump.
    /// Returns by how much `u_f` does.
    fn adopt(&self, old: &Self, state: &mut Self::State, y: T, u: T) -> T;

    /// Sampling period the law was built for \[s\].
    fn ts(&self) -> Option<T>;

    /// `1/K` of the model; its sign is that of the plant. 0 without a model.
    fn inv_gain(&self) -> T;

    /// Bounds of every number of a step per unit of `|y|` and of `|u|`.
    fn bounds(&self) -> (f64, f64);

    /// The largest number that any later step can reach from `state`, for measurements up to `y` and outputs up to `u` in
    /// size.
    fn reach(&self, state: &Self::State, y: f64, u: f64) -> f64;

    /// Number of words a snapshot of the state needs.
    fn words(state: &Self::State) -> usize;

    /// Writes the law's numbers.
    fn coefficients_to(&self, words: &mut impl Words);

    /// Writes the state.
    fn save(state: &Self::State, words: &mut impl Words);

    /// Reads back everything but the cells of the line, which it only looks at: the memory may be borrowed, and what is
    /// refused must not have been written. Gives the size of the largest cell; `None` when a number is not finite or a
    /// place is outside the line.
    fn restore(state: &mut Self::State, reader: &mut Reader<'_>) -> Option<f64>;

    /// Reads the cells of the line, which [`restore`](Self::restore) has looked at.
    fn restore_line(state: &mut Self::State, reader: &mut Reader<'_>) -> Option<()>;
}
