//! The law inside a loop: what a [`Controller`](crate::Controller) asks of a PID or an ADRC.

use crate::adrc::{Adrc, AdrcInput, AdrcState};
use crate::pid::{Pid, PidCoefficients, PidInput, PidOutput, PidState};
use crate::real::Real;
use crate::snapshot::{Reader, Words};
use core::fmt::Debug;

mod sealed {
    pub trait Sealed {}
    impl<T> Sealed for super::Pid<T> {}
    impl<T> Sealed for super::Adrc<T> {}
}

/// A law that a [`Controller`](crate::Controller) can close the loop with: [`Pid`] or [`Adrc`]. Sealed.
///
/// Its output is `i + pd`: a part that remembers, and one that follows the inputs. For a PID these are the integral term
/// and the filtered terms; for an ADRC the negative of the estimated disturbance and the feedback of the other estimates.
/// To begin at a given output, a loop sets `i`.
///
/// `a` is everywhere the output that was applied since the last sample without the offset that was in it \[u\]: what the
/// law itself has moved.
pub trait Regulator<T: Real>: sealed::Sealed + Copy + Debug + PartialEq {
    /// What the law moves.
    type State: Copy + Debug + PartialEq + Default;
    /// Numbers of the state in a snapshot.
    const NUMBERS: usize;

    /// At rest at `seen` with the output `u0` \[u\].
    fn settle(&self, state: &mut Self::State, seen: PidInput<T>, u0: T);
    /// What this sample adds to `i` from the error \[u\]; 0 for a law that learns `i` from what it observes.
    fn increment(&self, state: &Self::State, seen: PidInput<T>) -> T;
    /// Takes the sample in; gives `pd` \[u\].
    fn filter(&self, state: &mut Self::State, seen: PidInput<T>, a: T) -> T;
    /// Adds the anti-windup's correction and this sample's increment to `i`.
    fn integrate(&self, state: &mut Self::State, correction: T, increment: T);
    /// `i` and `pd` as this sample would give them without increment and correction.
    fn preview(&self, state: &Self::State, seen: PidInput<T>, a: T) -> PidOutput<T>;
    /// Takes over the state of the law `old`, but for its output; returns how much the output has lost \[u\].
    fn convert(&self, old: &Self, state: &mut Self::State, seen: PidInput<T>) -> T;
    /// Keeps `i` where nothing overflows, `most` being the largest a loop allows \[u\].
    fn bound_integral(&self, state: &mut Self::State, most: T);

    /// `i` \[u\].
    fn integral(state: &Self::State) -> T;
    /// The increment that the last sample added \[u\].
    fn last_increment(state: &Self::State) -> T;
    /// Sets `i` \[u\], of which `increment` counts as added by this sample.
    fn begin(state: &mut Self::State, i: T, increment: T);
    /// Lets `i` follow while the loop is open; a law that observes goes on observing.
    fn follow(state: &mut Self::State, i: T);
    /// Moves `i` by `delta` \[u\].
    fn shift(state: &mut Self::State, delta: T);
    /// Forgets the last increment: it has been judged.
    fn forget_increment(state: &mut Self::State);

    /// The smallest constant error \[y\] that still moves `i` when that is of size `level` \[u\].
    fn resolution(&self, level: T) -> f64;
    /// The largest number of a step for signals up to `y` and outputs up to `u` in size.
    fn bound(&self, y: f64, u: f64) -> f64;
    /// The largest number that a step can form from `state`, for a set-point up to `r`, measurements up to `y` and outputs
    /// up to `u` in size.
    fn reach(&self, state: &Self::State, r: f64, y: f64, u: f64) -> f64;

    /// Writes the law's numbers.
    fn coefficients_to(&self, words: &mut impl Words);
    /// Writes the state's numbers.
    fn save(state: &Self::State, words: &mut impl Words);
    /// Reads the state's numbers; `None` when one is not finite.
    fn restore(reader: &mut Reader<'_>) -> Option<Self::State>;
}

impl<T: Real> Regulator<T> for Pid<T> {
    type State = PidState<T>;
    const NUMBERS: usize = 9;

    fn settle(&self, state: &mut PidState<T>, seen: PidInput<T>, u0: T) {
        self.settle(state, seen, u0);
    }
    #[inline(always)]
    fn increment(&self, state: &PidState<T>, seen: PidInput<T>) -> T {
        self.increment(state, seen)
    }
    #[inline(always)]
    fn filter(&self, state: &mut PidState<T>, seen: PidInput<T>, _: T) -> T {
        self.filter(state, seen)
    }
    #[inline(always)]
    fn integrate(&self, state: &mut PidState<T>, correction: T, increment: T) {
        state.shift_integral(correction);
        state.integrate(increment);
    }
    #[inline(always)]
    fn preview(&self, state: &PidState<T>, seen: PidInput<T>, _: T) -> PidOutput<T> {
        PidOutput { i: state.integral(), pd: self.preview(state, seen) }
    }
    fn convert(&self, old: &Self, state: &mut PidState<T>, seen: PidInput<T>) -> T {
        old.preview(state, state.input()) - self.preview(state, seen)
    }
    #[inline(always)]
    fn bound_integral(&self, state: &mut PidState<T>, most: T) {
        state.bound_integral(most);
    }

    #[inline(always)]
    fn integral(state: &PidState<T>) -> T {
        state.integral()
    }
    #[inline(always)]
    fn last_increment(state: &PidState<T>) -> T {
        state.increment()
    }
    #[inline(always)]
    fn begin(state: &mut PidState<T>, i: T, increment: T) {
        state.set_integral(i);
        state.remember_increment(increment);
    }
    #[inline(always)]
    fn follow(state: &mut PidState<T>, i: T) {
        state.set_integral(i);
    }
    #[inline(always)]
    fn shift(state: &mut PidState<T>, delta: T) {
        state.shift_integral(delta);
    }
    fn forget_increment(state: &mut PidState<T>) {
        state.forget_increment();
    }

    fn resolution(&self, level: T) -> f64 {
        self.resolution(level)
    }
    fn bound(&self, y: f64, _: f64) -> f64 {
        self.bound() * y
    }
    fn reach(&self, state: &PidState<T>, r: f64, y: f64, _: f64) -> f64 {
        self.reach(state, r, y) + state.integral_size()
    }

    #[inline(always)]
    fn coefficients_to(&self, words: &mut impl Words) {
        let PidCoefficients { ki_now, ki_before, g, p_r, h_r, p_y, h_y } = self.coefficients();
        words.number(ki_now);
        words.number(ki_before);
        words.number(g);
        words.number(p_r);
        words.number(h_r);
        words.number(p_y);
        words.number(h_y);
    }
    fn save(state: &PidState<T>, words: &mut impl Words) {
        words.numbers(&state.parts());
    }
    fn restore(reader: &mut Reader<'_>) -> Option<PidState<T>> {
        reader.numbers().map(PidState::from_parts)
    }
}

impl<T: Real> Regulator<T> for Adrc<T> {
    type State = AdrcState<T>;
    const NUMBERS: usize = 7;

    fn settle(&self, state: &mut AdrcState<T>, seen: PidInput<T>, u0: T) {
        self.settle(state, AdrcInput { r: seen.r, y: seen.y, u: u0 });
    }
    #[inline(always)]
    fn increment(&self, _: &AdrcState<T>, _: PidInput<T>) -> T {
        T::ZERO
    }
    #[inline(always)]
    fn filter(&self, state: &mut AdrcState<T>, seen: PidInput<T>, a: T) -> T {
        self.observe(state, seen.y, a);
        self.bound_estimates(state);
        state.set_r(seen.r);
        self.feedback(state, seen.r)
    }
    #[inline(always)]
    fn integrate(&self, _: &mut AdrcState<T>, _: T, _: T) {}
    fn preview(&self, state: &AdrcState<T>, seen: PidInput<T>, a: T) -> PidOutput<T> {
        let mut ahead = *state;
        let out = self.step(&mut ahead, AdrcInput { r: seen.r, y: seen.y, u: a });
        PidOutput { i: -out.d, pd: out.pd }
    }
    fn convert(&self, old: &Self, state: &mut AdrcState<T>, seen: PidInput<T>) -> T {
        let lost = self.convert(old, state, seen.r);
        state.set_r(seen.r);
        lost
    }
    #[inline(always)]
    fn bound_integral(&self, state: &mut AdrcState<T>, _: T) {
        self.bound_disturbance(state);
    }

    #[inline(always)]
    fn integral(state: &AdrcState<T>) -> T {
        -state.disturbance()
    }
    #[inline(always)]
    fn last_increment(_: &AdrcState<T>) -> T {
        T::ZERO
    }
    #[inline(always)]
    fn begin(state: &mut AdrcState<T>, i: T, _: T) {
        state.set_disturbance(-i);
    }
    #[inline(always)]
    fn follow(_: &mut AdrcState<T>, _: T) {}
    #[inline(always)]
    fn shift(state: &mut AdrcState<T>, delta: T) {
        state.shift_disturbance(-delta);
    }
    fn forget_increment(_: &mut AdrcState<T>) {}

    fn resolution(&self, level: T) -> f64 {
        self.resolution(level)
    }
    fn bound(&self, y: f64, u: f64) -> f64 {
        self.bound(y, u)
    }
    fn reach(&self, state: &AdrcState<T>, r: f64, y: f64, u: f64) -> f64 {
        self.reach(state, r, y, u)
    }

    fn coefficients_to(&self, words: &mut impl Words) {
        words.numbers(&self.numbers());
    }
    fn save(state: &AdrcState<T>, words: &mut impl Words) {
        words.numbers(&state.parts());
    }
    fn restore(reader: &mut Reader<'_>) -> Option<AdrcState<T>> {
        reader.numbers().map(AdrcState::from_parts)
    }
}
