//! The discretised PID and its state.

use super::config::{IntegralRule, PidConfig};
use crate::accumulator::Accumulator;
use crate::error::ConfigErrors;
use crate::lag::Lag;
use crate::real::{Real, coefficient};

/// The PID of eq. (4) of Vrančić & Huba 2021, discretised for one sampling period.
///
/// Continuous law: see [`PidConfig`] and the module that holds it; `e = r - y`.
///
/// Difference equation, with `P_w = w*kp - ki*tf` and `Q_v = v*kd` for the weights `(w, v) = (b, c)` on `r` and
/// `(1, 1)` on `y`, `g = 2*ts/(ts + 2*tf)` and `H = P*g/2 + Q*g/ts` (Tustin):
///
/// ```text
/// I[k]  = I[k-1] + ki*ts*e[k]                      backward, or ki*ts*(e[k]+e[k-1])/2, trapezoid
/// pd[k] = P_b*wr[k] + H_r*(r[k]-wr[k]) - P_1*wy[k] - H_y*(y[k]-wy[k])
/// wr[k+1] = wr[k] + g*(r[k]-wr[k]),  wy likewise
/// u[k]  = I[k] + pd[k]
/// ```
///
/// `tf = 0` is a static gain: `g = 1`, `H = P`. All three sums are compensated ([`Accumulator`]).
///
/// Inputs must be finite: a bare law does not check them, [`Controller`](crate::Controller) does.
/// Cost: 29 additions, subtractions and multiplications, no division, no branch.
/// Source: eq. (4) of Vrančić & Huba 2021; Tustin's rule for the filtered path as that chapter's experiments use it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pid<T> {
    ki_now: T,
    ki_before: T,
    g: T,
    p_r: T,
    h_r: T,
    p_y: T,
    h_y: T,
}

/// The coefficients of a [`Pid`] as numbers: what an export writes and what an analysis of the deployed law reads. The
/// difference equation is that of [`Pid`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidCoefficients<T> {
    /// Weight of `e[k]` in the integral's increment [u/y]: `ki*ts` or half of it.
    pub ki_now: T,
    /// Weight of `e[k-1]` in the integral's increment [u/y]: 0 or half of `ki*ts`.
    pub ki_before: T,
    /// Gain `g` of the lags, above 0 and at most 1.
    pub g: T,
    /// `P_b`, the weight of the set-point's lag [u/y].
    pub p_r: T,
    /// `H_r`, the weight of the set-point's difference from its lag [u/y].
    pub h_r: T,
    /// `P_1`, the weight of the measurement's lag [u/y].
    pub p_y: T,
    /// `H_y`, the weight of the measurement's difference from its lag [u/y].
    pub h_y: T,
}

/// State of a [`Pid`]: the integral term in the output's unit, everything else plain signals, so that it stays
/// valid when the law is replaced.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidState<T> {
    integral: Accumulator<T>,
    r_lag: Lag<T>,
    y_lag: Lag<T>,
    r: T,
    y: T,
    increment: T,
}

/// What a [`Pid`] reads in one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PidInput<T> {
    /// Set-point \[y\].
    pub r: T,
    /// Measurement \[y\].
    pub y: T,
}

/// What a [`Pid`] gives in one sample \[u\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PidOutput<T> {
    /// Integral term.
    pub i: T,
    /// Filtered proportional and derivative terms.
    pub pd: T,
}

impl<T: Real> PidOutput<T> {
    /// The controller's output before any offset or limit: `i + pd`.
    #[must_use]
    #[inline(always)]
    pub fn u(&self) -> T {
        self.i + self.pd
    }
}

impl<T: Real> Pid<T> {
    /// Discretises `config` for the sampling period `ts` \[s\]; computed in `f64`, each coefficient rounded once.
    ///
    /// # Errors
    /// Every fault of [`PidConfig::validate`], all at once.
    ///
    /// ```
    /// use controller_core::{Pid, PidConfig, PidInput, PidState};
    /// let config = PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() };
    /// let pid = Pid::<f32>::new(&config, 0.1).unwrap();
    /// let mut state = PidState::default();
    /// let out = pid.step(&mut state, PidInput { r: 1.0, y: 0.0 });
    /// assert_eq!(out.u(), 2.0 + 0.05);
    /// ```
    pub fn new(config: &PidConfig, ts: f64) -> Result<Self, ConfigErrors> {
        config.validate(ts)?;
        let [kp, ki, kd] = config.signed_gains();
        let g = if config.tf == 0.0 { 1.0 } else { 2.0 * ts / (ts + 2.0 * config.tf) };
        let paths = |weight_p: f64, weight_d: f64| {
            let p = weight_p * kp - ki * config.tf;
            let q = weight_d * kd;
            let h = if config.tf == 0.0 { p } else { p * (0.5 * g) + q * (g / ts) };
            (p, h)
        };
        let (p_r, h_r) = paths(config.b, config.c);
        let (p_y, h_y) = paths(1.0, 1.0);
        let (now, before) = match config.integral_rule {
            IntegralRule::Backward => (1.0, 0.0),
            IntegralRule::Trapezoid => (0.5, 0.5),
        };
        Ok(Self {
            ki_now: coefficient(ki * ts * now),
            ki_before: coefficient(ki * ts * before),
            g: coefficient(g),
            p_r: coefficient(p_r),
            h_r: coefficient(h_r),
            p_y: coefficient(p_y),
            h_y: coefficient(h_y),
        })
    }

    /// One sample: integrates the error, filters the rest. See the type for the equation, units and cost.
    #[inline]
    pub fn step(&self, state: &mut PidState<T>, input: PidInput<T>) -> PidOutput<T> {
        let increment = self.increment(state, input);
        state.integrate(increment);
        let pd = self.filter(state, input);
        PidOutput { i: state.integral(), pd }
    }

    /// The increment of the integral term that this sample asks for \[u\].
    #[must_use]
    #[inline(always)]
    pub fn increment(&self, state: &PidState<T>, input: PidInput<T>) -> T {
        self.ki_now * (input.r - input.y) + self.ki_before * (state.r - state.y)
    }

    /// The filtered proportional and derivative terms of this sample \[u\]; moves the lags, not the integral.
    #[inline(always)]
    pub fn filter(&self, state: &mut PidState<T>, input: PidInput<T>) -> T {
        let r = state.r_lag.advance(self.g, input.r);
        let y = state.y_lag.advance(self.g, input.y);
        state.r = input.r;
        state.y = input.y;
        (self.p_r * r.value + self.h_r * r.difference) - (self.p_y * y.value + self.h_y * y.difference)
    }

    /// What [`filter`](Self::filter) would give, without moving the state.
    #[must_use]
    pub fn preview(&self, state: &PidState<T>, input: PidInput<T>) -> T {
        let r = state.r_lag.tap(input.r);
        let y = state.y_lag.tap(input.y);
        (self.p_r * r.value + self.h_r * r.difference) - (self.p_y * y.value + self.h_y * y.difference)
    }

    /// Puts the state at rest at `input`, with the integral term such that the output is `u0` \[u\]:
    /// `w_r = r`, `w_y = y`, `I = u0 - (P_b*r - P_1*y)`.
    pub fn settle(&self, state: &mut PidState<T>, input: PidInput<T>, u0: T) {
        *state = PidState {
            integral: Accumulator::new(u0 - (self.p_r * input.r - self.p_y * input.y)),
            r_lag: Lag::settled(input.r),
            y_lag: Lag::settled(input.y),
            r: input.r,
            y: input.y,
            increment: T::ZERO,
        };
    }

    /// Takes `state` over from the law `old` without a bump: the lags, being signals, are kept, and the integral
    /// term absorbs the difference of the filtered terms at the last inputs. In the first sample of the new law
    /// the output then differs from what the old one would have given by at most
    /// `|dki|*ts*|e| + |dH_r|*|r[k]-r[k-1]| + |dH_y|*|y[k]-y[k-1]|`.
    pub fn adopt(&self, old: &Self, state: &mut PidState<T>) {
        let last = PidInput { r: state.r, y: state.y };
        state.shift_integral(old.preview(state, last) - self.preview(state, last));
    }

    /// The coefficients that the step uses.
    ///
    /// ```
    /// use controller_core::{Pid, PidConfig};
    /// let pid = Pid::<f64>::new(&PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() }, 0.5).unwrap();
    /// let c = pid.coefficients();
    /// assert_eq!((c.ki_now, c.ki_before, c.g, c.p_y, c.h_y), (0.25, 0.0, 1.0, 2.0, 2.0));
    /// ```
    #[must_use]
    pub const fn coefficients(&self) -> PidCoefficients<T> {
        let Self { ki_now, ki_before, g, p_r, h_r, p_y, h_y } = *self;
        PidCoefficients { ki_now, ki_before, g, p_r, h_r, p_y, h_y }
    }

    /// Gain from a step of `y` to the output in the same sample [u/y]: `H_y`, without the integral's `ki*ts`.
    #[must_use]
    pub fn high_frequency_gain(&self) -> T {
        self.h_y
    }

    /// Gain from the error to the integral term in one sample, `ki*ts` [u/y].
    #[must_use]
    pub fn integral_gain(&self) -> T {
        self.ki_now + self.ki_before
    }

    /// Bound of `|pd|` and of an increment per unit of signal, for overflow checks: `|P|` times a lag, `2|H|` times a
    /// difference from it, for both inputs.
    pub(crate) fn bound(&self) -> f64 {
        let size = |x: T| x.to_f64().abs();
        size(self.p_r)
            + size(self.p_y)
            + 2.0 * (size(self.h_r) + size(self.h_y))
            + 2.0 * size(self.integral_gain())
    }

    /// The largest number that the filtered terms and an increment can reach from `state`, for inputs up to `r` and `y` in
    /// size.
    pub(crate) fn reach(&self, state: &PidState<T>, r: f64, y: f64) -> f64 {
        let size = |x: &T| x.to_f64().abs();
        let sum = |list: &[T]| list.iter().map(size).sum::<f64>();
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let (w_r, w_y) = (larger(sum(&state.r_lag.parts()), r), larger(sum(&state.y_lag.parts()), y));
        let filtered = size(&self.p_r) * w_r
            + size(&self.h_r) * (r + w_r)
            + size(&self.p_y) * w_y
            + size(&self.h_y) * (y + w_y);
        let increment =
            (size(&self.ki_now) + size(&self.ki_before)) * (r + y + size(&state.r) + size(&state.y));
        filtered + increment
    }

    /// The smallest constant error \[y\] that still moves the integral term when that term is of size `level` \[u\];
    /// infinite without an integral term.
    ///
    /// The compensated sum loses an increment only below half a unit in the last place of its carry, which itself
    /// is at most half a unit of the sum: `e = eps^2*level/(4*ki*ts)` (Kahan's bound, rounded up to a power of
    /// two). A plain sum would stall at `e = eps*level/(2*ki*ts)`. Compare it with the measurement's step.
    ///
    /// ```
    /// use controller_core::{Pid, PidConfig};
    /// let slow = PidConfig { kp: 1.0, ki: 1.0 / 1800.0, ..PidConfig::default() };
    /// let pid = Pid::<f32>::new(&slow, 0.001).unwrap();
    /// assert!(pid.resolution(50.0) < 1e-6); // a plain single-precision sum stalls at several units
    /// ```
    #[must_use]
    pub fn resolution(&self, level: T) -> f64 {
        let gain = self.integral_gain().to_f64().abs();
        if gain == 0.0 {
            return f64::INFINITY;
        }
        let spacing = T::EPS * level.to_f64().abs();
        0.25 * T::EPS * spacing / gain
    }
}

impl<T: Real> PidState<T> {
    /// The integral term \[u\].
    #[must_use]
    #[inline(always)]
    pub fn integral(&self) -> T {
        self.integral.value()
    }

    /// The last inputs.
    #[must_use]
    pub fn input(&self) -> PidInput<T> {
        PidInput { r: self.r, y: self.y }
    }

    /// The increment that the last sample added to the integral term \[u\].
    #[must_use]
    #[inline(always)]
    pub fn increment(&self) -> T {
        self.increment
    }

    /// Adds an increment and remembers it, so that an anti-windup rule can take it back.
    #[inline(always)]
    pub fn integrate(&mut self, increment: T) {
        self.increment = increment;
        self.integral.add(increment);
    }

    /// Sets the integral term \[u\].
    #[inline(always)]
    pub fn set_integral(&mut self, i: T) {
        self.integral.set(i);
        self.increment = T::ZERO;
    }

    /// Says what the last sample added, when the term was set as a whole.
    #[inline(always)]
    pub fn remember_increment(&mut self, increment: T) {
        self.increment = increment;
    }

    /// Forgets the last increment: it has been judged.
    #[inline(always)]
    pub fn forget_increment(&mut self) {
        self.increment = T::ZERO;
    }

    /// Moves the integral term by `delta` \[u\]: anti-windup and bumpless changes.
    #[inline(always)]
    pub fn shift_integral(&mut self, delta: T) {
        self.integral.add(delta);
    }

    /// Keeps the integral term within `-most..=most`.
    #[inline(always)]
    pub(crate) fn bound_integral(&mut self, most: T) {
        self.integral.keep_within(most);
    }

    /// Size of the integral term, its carry and its last increment together.
    pub(crate) fn integral_size(&self) -> f64 {
        let [i, carry, .., increment] = self.parts();
        [i, carry, increment].iter().map(|x| x.magnitude().to_f64()).sum()
    }

    /// The numbers of the state, for a snapshot.
    pub(crate) fn parts(&self) -> [T; 9] {
        let [r_w, r_c] = self.r_lag.parts();
        let [y_w, y_c] = self.y_lag.parts();
        [self.integral.value(), self.integral.carry(), r_w, r_c, y_w, y_c, self.r, self.y, self.increment]
    }

    /// The inverse of [`parts`](Self::parts).
    pub(crate) fn from_parts(parts: [T; 9]) -> Self {
        let [i, i_c, r_w, r_c, y_w, y_c, r, y, increment] = parts;
        Self {
            integral: Accumulator::from_parts(i, i_c),
            r_lag: Lag::from_parts([r_w, r_c]),
            y_lag: Lag::from_parts([y_w, y_c]),
            r,
            y,
            increment,
        }
    }
}
