//! The compensator with a shape known at compile time: what is flashed.

use super::MAX_EXCESS;
use super::config::{CompensatorConfig, EstimatorConfig, ObserverConfig};
use super::discretise::{Discretised, discretise};
use super::kernel::{Coefficients, Compensate, CompensatorOutput, Sealed};
use super::view::{LagsView, StateRef, StateView};
use crate::delay::DelayLine;
use crate::error::ConfigErrors;
use crate::lag::Lag;
use crate::plant_model::MAX_ORDER;
use crate::real::{Real, coefficient};
use crate::snapshot::{Reader, Words};

/// A disturbance estimator for a model of second order ([`EstimatorConfig`] with `a2 > 0`), delay line of `R`
/// samples. A first-order model needs [`Compensator<T, 1, 2, R>`](Compensator).
pub type Estimator<T, const R: usize> = Compensator<T, 2, 1, R>;

/// A disturbance observer for a model with `N` poles and as many filter poles as it needs, delay line of `R` samples.
pub type Observer<T, const N: usize, const R: usize> = Compensator<T, N, 0, R>;

/// A disturbance compensator for a model with `N` poles, `E` excess filter poles and a delay line of `R` samples.
///
/// Continuous law and discrete pair: see the [module](crate::compensator). Difference equation of one sample, with
/// the lags `w <- w + g*(x - w)`:
///
/// ```text
/// x_u = w_N + sum_j E_j*(w_(j-1) - w_j),  w_0 = u_applied[k-1-delay]         chain of N lags
/// x_y = dc*w_2 + E_2*(x_2-w_2) + E_1*(x-w_1),  x_2 = w_1 + F*(x-w_1)          section by section, from y[k]
/// x   = (w + (g/2)*(x - w))                                                  E times, from x_u - x_y/K
/// d_hat = x_0 - x;  u_f = -gain*d_hat                                        x_0: x at the point of initialisation
/// ```
///
/// `d + (zeros moved into C_y) = N + E`, `d` the filter order: for an estimator `E = 3 - N`.
/// Units: `y` \[y\], `u` \[u\]. Inputs must be finite (the [`Controller`](crate::Controller) checks them).
/// Cost per sample: `6*(2N+E)` operations for the lags, `6N + 2E + 4` for the outputs, one write and one read of the
/// delay line; no division, and the same on every call. State: `4N + 2E + 2 + R` numbers.
/// Source: Tena et al. 2022, eqs (26), (27); Vrančić & Huba 2021, eqs (13)-(15).
///
/// ```
/// use controller_core::{CompensatorInput, EstimatorConfig, Estimator};
/// let config = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
/// let estimator = Estimator::<f32, 32>::new(&config.to_compensator(0.0), 0.01).unwrap();
/// let mut state = estimator.settled(0.0, 0.0);
/// let out = estimator.step(&mut state, CompensatorInput { y: 0.0, u_applied: 0.0 });
/// assert_eq!(out.u_f, 0.0);
/// // A line of 8 samples cannot hold a dead time of 20.
/// assert!(Estimator::<f32, 8>::new(&config.to_compensator(0.0), 0.01).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensator<T, const N: usize, const E: usize, const R: usize> {
    g: [T; N],
    y_feed: [T; N],
    y_lead: [T; N],
    y_dc: [T; N],
    u_lead: [T; N],
    e_gain: [T; E],
    inv_gain: T,
    gain: T,
    delay: usize,
    ts: T,
}

/// State of a [`Compensator`]: lags (plain signals), the applied outputs of the last `R` samples, the estimate at
/// the point of initialisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompensatorState<T, const N: usize, const E: usize, const R: usize> {
    y: [Lag<T>; N],
    u: [Lag<T>; N],
    e: [Lag<T>; E],
    reference: T,
    line: DelayLine<[T; R]>,
}

/// What a compensator reads in one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CompensatorInput<T> {
    /// Measurement `y[k]` \[y\].
    pub y: T,
    /// Output that was applied since the last sample, `u[k-1]` after limits or as read back \[u\].
    pub u_applied: T,
}

impl<T: Real, const N: usize, const E: usize, const R: usize> Default for CompensatorState<T, N, E, R> {
    fn default() -> Self {
        Self {
            y: [Lag::settled(T::ZERO); N],
            u: [Lag::settled(T::ZERO); N],
            e: [Lag::settled(T::ZERO); E],
            reference: T::ZERO,
            line: DelayLine::new([T::ZERO; R]),
        }
    }
}

/// Rounds a list of coefficients into an array of the same length.
fn array<T: Real, const L: usize>(from: &[f64]) -> [T; L] {
    let mut out = [T::ZERO; L];
    for (x, y) in out.iter_mut().zip(from) {
        *x = coefficient(*y);
    }
    out
}

impl<T: Real, const N: usize, const E: usize, const R: usize> Compensator<T, N, E, R> {
    /// Discretises `config` for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every fault of [`CompensatorConfig::validate`] for a line of `R` samples; a model whose order is not `N`, or
    /// a filter whose excess order is not `E` (the message names both).
    pub fn new(config: &CompensatorConfig, ts: f64) -> Result<Self, ConfigErrors> {
        const {
            assert!(N >= 1 && N <= MAX_ORDER, "a compensator has 1 to 8 states in its chains");
            assert!(E <= MAX_EXCESS, "a compensator has at most 3 excess sections");
            assert!(R >= 1, "a delay line has at least one sample");
        }
        config.validate_for(ts, R, (N, E))?;
        let Discretised { g, y_feed, y_lead, y_dc, u_lead, e_gain, inv_gain, gain, delay } =
            discretise::<T>(config, ts);
        let law = Self {
            g: array(&g),
            y_feed: array(&y_feed),
            y_lead: array(&y_lead),
            y_dc: array(&y_dc),
            u_lead: array(&u_lead),
            e_gain: array(&e_gain),
            inv_gain: coefficient(inv_gain),
            gain: coefficient(gain),
            delay,
            ts: coefficient(ts),
        };
        law.coefficients().check()?;
        Ok(law)
    }

    /// An estimator, see [`EstimatorConfig`]; `latency` \[s\].
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn estimator(config: &EstimatorConfig, latency: f64, ts: f64) -> Result<Self, ConfigErrors> {
        Self::new(&config.to_compensator(latency), ts)
    }

    /// An observer, see [`ObserverConfig`]; `latency` \[s\].
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn observer(config: &ObserverConfig, latency: f64, ts: f64) -> Result<Self, ConfigErrors> {
        Self::new(&config.to_compensator(latency), ts)
    }

    /// A state at rest at the measurement `y0` and the output `u0`.
    #[must_use]
    pub fn settled(&self, y0: T, u0: T) -> CompensatorState<T, N, E, R> {
        let mut state = CompensatorState::default();
        self.settle(&mut state, y0, u0);
        state
    }

    /// One sample. See the type for the equation, units and cost.
    #[inline]
    pub fn step(
        &self,
        state: &mut CompensatorState<T, N, E, R>,
        input: CompensatorInput<T>,
    ) -> CompensatorOutput<T> {
        self.sample(state, input.y, input.u_applied)
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

impl<T: Real, const N: usize, const E: usize, const R: usize> CompensatorState<T, N, E, R> {
    #[inline(always)]
    fn view(&mut self) -> StateView<'_, T, [T; R]> {
        StateView {
            lags: LagsView { y: &mut self.y, u: &mut self.u, e: &mut self.e },
            line: &mut self.line,
            reference: &mut self.reference,
        }
    }

    fn as_ref(&self) -> StateRef<'_, T, [T; R]> {
        StateRef { y: &self.y, u: &self.u, e: &self.e, line: &self.line, reference: self.reference }
    }
}

impl<T, const N: usize, const E: usize, const R: usize> Sealed for Compensator<T, N, E, R> {}

impl<T: Real, const N: usize, const E: usize, const R: usize> Compensate<T> for Compensator<T, N, E, R> {
    type State = CompensatorState<T, N, E, R>;

    #[inline(always)]
    fn sample(&self, state: &mut Self::State, y: T, u_applied: T) -> CompensatorOutput<T> {
        state.view().sample(&self.coefficients(), y, u_applied)
    }

    fn settle(&self, state: &mut Self::State, y0: T, u0: T) {
        state.view().settle(&self.coefficients(), y0, u0);
    }

    fn resettle(&self, state: &mut Self::State, y0: T) {
        state.view().resettle(&self.coefficients(), y0);
    }

    fn skip(&self, state: &mut Self::State, u: T, n: usize) {
        state.view().skip(&self.coefficients(), u, n);
    }

    fn adopt(&self, old: &Self, state: &mut Self::State, y: T, u: T) -> T {
        let estimate = |law: &Self| {
            let mut copy = (state.y, state.u, state.e);
            let mut lags = LagsView { y: &mut copy.0, u: &mut copy.1, e: &mut copy.2 };
            law.coefficients().advance(&mut lags, y, state.as_ref().next_tap(law.delay, u))
        };
        let (before, after) = (estimate(old), estimate(self));
        let d_hat = state.reference - before;
        state.reference = d_hat + after;
        (old.gain - self.gain) * d_hat
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
