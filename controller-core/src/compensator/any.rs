//! The compensator with a shape known at run time: hosts and C callers.

use super::MAX_EXCESS;
use super::config::CompensatorConfig;
use super::discretise::{Discretised, discretise};
use super::kernel::{Coefficients, Compensate, CompensatorOutput, Sealed};
use super::view::{LagsView, StateRef, StateView};
use crate::delay::{DelayLine, Memory};
use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::lag::Lag;
use crate::plant_model::MAX_ORDER;
use crate::real::{Real, coefficient};
use crate::snapshot::{Reader, Words};
use crate::stored::List;
use core::marker::PhantomData;
use heapless::Vec;

/// A [`Compensator`](super::Compensator) whose order is a number, over delay memory that the caller brings: the
/// same kernel over the same numbers of lags, hence the same bits.
///
/// Law, units, source: as [`Compensator`](super::Compensator). Cost: the same operations in loops.
/// It takes memory for the largest shape (8 poles), whatever the model.
///
/// ```
/// use controller_core::{AnyCompensator, Compensate, ObserverConfig, plant_model::PlantModel};
/// let config = ObserverConfig { model: PlantModel::first_order(1.0, 10.0, 2.0), alpha: 1.0, order: None };
/// let law = AnyCompensator::<f64, [f64; 64]>::new(&config.to_compensator(0.0), 0.1, 64).unwrap();
/// let mut state = law.state([0.0; 64]).unwrap();
/// law.settle(&mut state, 0.0, 0.0);
/// assert_eq!(law.sample(&mut state, 0.0, 0.0).u_f, 0.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct AnyCompensator<T, M> {
    g: List<T, MAX_ORDER>,
    y_feed: List<T, MAX_ORDER>,
    y_lead: List<T, MAX_ORDER>,
    y_dc: List<T, MAX_ORDER>,
    u_lead: List<T, MAX_ORDER>,
    e_gain: List<T, MAX_EXCESS>,
    inv_gain: T,
    gain: T,
    delay: usize,
    ts: T,
    memory: PhantomData<fn() -> M>,
}

/// State of an [`AnyCompensator`] over the delay memory `M`.
#[derive(Debug, Clone, PartialEq)]
pub struct AnyCompensatorState<T, M> {
    y: List<Lag<T>, MAX_ORDER>,
    u: List<Lag<T>, MAX_ORDER>,
    e: List<Lag<T>, MAX_EXCESS>,
    reference: T,
    line: DelayLine<M>,
}

/// The slice as one of known length, when it has it.
#[inline(always)]
fn exactly<X, const L: usize>(list: &[X]) -> Option<&[X; L]> {
    list.try_into().ok()
}

#[inline(always)]
fn exactly_mut<X, const L: usize>(list: &mut [X]) -> Option<&mut [X; L]> {
    list.try_into().ok()
}

impl<T: Real, M: Memory<T>> AnyCompensator<T, M> {
    /// Discretises `config` for the sampling period `ts` \[s\] and delay memory of `capacity` samples.
    ///
    /// # Errors
    /// Every fault of [`CompensatorConfig::validate`].
    pub fn new(config: &CompensatorConfig, ts: f64, capacity: usize) -> Result<Self, ConfigErrors> {
        config.validate(ts, capacity)?;
        let Discretised { g, y_feed, y_lead, y_dc, u_lead, e_gain, inv_gain, gain, delay } =
            discretise::<T>(config, ts);
        let rounded = |list: Vec<f64, MAX_ORDER>| List::of(list.iter().map(|&x| coefficient(x)));
        let law = Self {
            g: rounded(g),
            y_feed: rounded(y_feed),
            y_lead: rounded(y_lead),
            y_dc: rounded(y_dc),
            u_lead: rounded(u_lead),
            e_gain: List::of(e_gain.iter().map(|&x| coefficient(x))),
            inv_gain: coefficient(inv_gain),
            gain: coefficient(gain),
            delay,
            ts: coefficient(ts),
            memory: PhantomData,
        };
        law.coefficients().check()?;
        Ok(law)
    }

    /// A zeroed state over `memory`.
    ///
    /// # Errors
    /// Memory too short for the delay of this law.
    pub fn state(&self, memory: M) -> Result<AnyCompensatorState<T, M>, ConfigErrors> {
        let mut check = Checker::default();
        let have = memory.as_ref().len();
        if have <= self.delay {
            let [value, need] = [have, self.delay + 1].map(super::config::index_to_f64);
            check.fault(Param::Capacity, Reason::TooLarge, value, need, f64::INFINITY);
        }
        let zero = Lag::settled(T::ZERO);
        check.finish(AnyCompensatorState {
            y: List::of(core::iter::repeat_n(zero, self.g.len())),
            u: List::of(core::iter::repeat_n(zero, self.g.len())),
            e: List::of(core::iter::repeat_n(zero, self.e_gain.len())),
            reference: T::ZERO,
            line: DelayLine::new(memory),
        })
    }

    /// Samples of delay memory that a compensator with this configuration needs.
    #[must_use]
    pub fn needed_capacity(config: &CompensatorConfig, ts: f64) -> usize {
        let delay = config.model.dead_time + config.latency;
        super::shape::whole_samples(delay, ts, super::shape::nearness::<f32>()).0.saturating_add(1)
    }

    /// Whether the delay of this law fits the memory of `state`, which may have been made for another law. A law that
    /// does not fit must not adopt the state: it would read the oldest sample in place of older ones.
    #[must_use]
    pub fn fits(&self, state: &AnyCompensatorState<T, M>) -> bool {
        self.delay < state.line.capacity()
    }

    /// Gives `state` as many lags as this law has, when it was made for a law of another shape.
    fn reshape(&self, state: &mut AnyCompensatorState<T, M>) {
        let zero = Lag::settled(T::ZERO);
        if state.y.len() != self.g.len() || state.e.len() != self.e_gain.len() {
            state.y = List::of(core::iter::repeat_n(zero, self.g.len()));
            state.u = state.y;
            state.e = List::of(core::iter::repeat_n(zero, self.e_gain.len()));
        }
    }

    /// A sample of a law with `N` poles and `E` excess sections, in loops of known length; `None`, and nothing moved, when
    /// it has another shape.
    #[inline(always)]
    fn sample_as<const N: usize, const E: usize>(
        &self,
        state: &mut AnyCompensatorState<T, M>,
        y: T,
        u_applied: T,
    ) -> Option<CompensatorOutput<T>> {
        let law = Coefficients {
            g: exactly::<T, N>(&self.g)?,
            y_feed: exactly::<T, N>(&self.y_feed)?,
            y_lead: exactly::<T, N>(&self.y_lead)?,
            y_dc: exactly::<T, N>(&self.y_dc)?,
            u_lead: exactly::<T, N>(&self.u_lead)?,
            e_gain: exactly::<T, E>(&self.e_gain)?,
            ..self.coefficients()
        };
        let lags = LagsView {
            y: exactly_mut::<Lag<T>, N>(&mut state.y)?,
            u: exactly_mut::<Lag<T>, N>(&mut state.u)?,
            e: exactly_mut::<Lag<T>, E>(&mut state.e)?,
        };
        let view = StateView { lags, line: &mut state.line, reference: &mut state.reference };
        Some(view.sample(&law, y, u_applied))
    }

    /// Order of the chains and number of excess sections.
    #[must_use]
    pub fn shape(&self) -> (usize, usize) {
        (self.g.len(), self.e_gain.len())
    }

    /// The coefficients that the step uses.
    #[must_use]
    #[inline(always)]
    pub fn coefficients(&self) -> Coefficients<'_, T> {
        Coefficients {
            g: &self.g,
            y_feed: &self.y_feed,
            y_lead: &self.y_lead,
            y_dc: &self.y_dc,
            u_lead: &self.u_lead,
            e_gain: &self.e_gain,
            inv_gain: self.inv_gain,
            gain: self.gain,
            delay: self.delay,
        }
    }
}

impl<T, M> AnyCompensatorState<T, M> {
    /// Puts `memory` in the place of the delay memory; gives what was there. For borrowed memory that moves between two
    /// samples: the cells must be the same, in the same order.
    ///
    /// ```
    /// use controller_core::{AnyCompensator, Compensate, ObserverConfig, plant_model::PlantModel};
    /// let config = ObserverConfig { model: PlantModel::first_order(1.0, 10.0, 2.0), alpha: 1.0, order: None };
    /// let law = AnyCompensator::<f64, Vec<f64>>::new(&config.to_compensator(0.0), 0.1, 64).unwrap();
    /// let mut state = law.state(vec![0.0; 64]).unwrap();
    /// let cells = state.replace_memory(Vec::new());
    /// let moved = cells.clone();
    /// state.replace_memory(moved);
    /// assert_eq!(law.sample(&mut state, 0.0, 0.0).u_f, 0.0);
    /// ```
    pub fn replace_memory(&mut self, memory: M) -> M
    where
        T: Real,
        M: Memory<T>,
    {
        core::mem::replace(self.line.parts_mut().0, memory)
    }
}

impl<T: Real, M> AnyCompensatorState<T, M> {
    #[inline(always)]
    fn view(&mut self) -> StateView<'_, T, M> {
        StateView {
            lags: LagsView { y: &mut self.y, u: &mut self.u, e: &mut self.e },
            line: &mut self.line,
            reference: &mut self.reference,
        }
    }

    fn as_ref(&self) -> StateRef<'_, T, M> {
        StateRef { y: &self.y, u: &self.u, e: &self.e, line: &self.line, reference: self.reference }
    }
}

impl<T, M> Sealed for AnyCompensator<T, M> {}

impl<T: Real, M: Memory<T> + Clone> Compensate<T> for AnyCompensator<T, M> {
    type State = AnyCompensatorState<T, M>;

    fn sample(&self, state: &mut Self::State, y: T, u_applied: T) -> CompensatorOutput<T> {
        // The shapes of the estimators, by far the most frequent: half of the instructions.
        let known = match self.shape() {
            (2, 1) => self.sample_as::<2, 1>(state, y, u_applied),
            (1, 2) => self.sample_as::<1, 2>(state, y, u_applied),
            _ => None,
        };
        match known {
            Some(output) => output,
            None => state.view().sample(&self.coefficients(), y, u_applied),
        }
    }

    fn settle(&self, state: &mut Self::State, y0: T, u0: T) {
        self.reshape(state);
        state.view().settle(&self.coefficients(), y0, u0);
    }

    fn resettle(&self, state: &mut Self::State, y0: T) {
        state.view().resettle(&self.coefficients(), y0);
    }

    fn skip(&self, state: &mut Self::State, u: T, n: usize) {
        state.view().skip(&self.coefficients(), u, n);
    }

    /// As the trait says; between laws of different shapes the lags cannot be kept: they settle at `y` and at what
    /// the delay line holds, and `u_f` returns to zero.
    fn adopt(&self, old: &Self, state: &mut Self::State, y: T, u: T) -> T {
        let estimate = |law: &Self, state: &Self::State| {
            let mut copy = (state.y, state.u, state.e);
            let mut lags = LagsView { y: &mut copy.0, u: &mut copy.1, e: &mut copy.2 };
            law.coefficients().advance(&mut lags, y, state.as_ref().next_tap(law.delay, u))
        };
        let d_hat = state.reference - estimate(old, state);
        if self.shape() == old.shape() {
            state.reference = d_hat + estimate(self, state);
            (old.gain - self.gain) * d_hat
        } else {
            self.reshape(state);
            let next = state.as_ref().next_tap(self.delay, u);
            state.reference = self.coefficients().settle(&mut state.view().lags, y, next);
            old.gain * d_hat
        }
    }

    fn ts(&self) -> Option<T> {
        Some(self.ts)
    }

    fn inv_gain(&self) -> T {
        self.inv_gain
    }

    fn bounds(&self) -> (f64, f64) {
        self.coefficients().bounds()
    }

    fn reach(&self, state: &Self::State, y: f64, u: f64) -> f64 {
        state.as_ref().reach(&self.coefficients(), y, u)
    }

    fn words(state: &Self::State) -> usize {
        state.as_ref().words()
    }

    #[inline(always)]
    fn coefficients_to(&self, words: &mut impl Words) {
        self.coefficients().write(words);
    }

    fn save(state: &Self::State, words: &mut impl Words) {
        state.as_ref().save(words);
    }

    fn restore(state: &mut Self::State, reader: &mut Reader<'_>) -> Option<f64> {
        state.view().restore(reader)
    }

    fn restore_line(state: &mut Self::State, reader: &mut Reader<'_>) -> Option<()> {
        reader.cells(state.line.parts_mut().0)
    }
}
