//! Output limits: range and rate.

use crate::accumulator::Accumulator;
use crate::error::{Checker, ConfigErrors, Param};
use crate::real::{Real, coefficient};
use crate::snapshot::Words;

/// Largest size of any signal's range.
pub(crate) const RANGE_LIMIT: f64 = 1e12;

/// Range and rate of an output. Bounds up to 1e12 in size, rates above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LimitConfig {
    /// Lowest output \[u\]; default -1e6.
    pub lo: f64,
    /// Highest output \[u\], above `lo`; default 1e6.
    pub hi: f64,
    /// Fastest rise [u/s], above 0; `None`: no limit.
    pub rate_up: Option<f64>,
    /// Fastest fall [u/s], above 0; `None`: no limit.
    pub rate_down: Option<f64>,
}

impl Default for LimitConfig {
    fn default() -> Self {
        Self { lo: -1e6, hi: 1e6, rate_up: None, rate_down: None }
    }
}

impl LimitConfig {
    /// A range without a rate limit.
    #[must_use]
    pub fn range(lo: f64, hi: f64) -> Self {
        Self { lo, hi, ..Self::default() }
    }

    /// The same configuration with every number rounded to `T`.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            lo: round(self.lo),
            hi: round(self.hi),
            rate_up: self.rate_up.map(round),
            rate_down: self.rate_down.map(round),
        }
    }
}

/// A limiter for range and rate. Its state is the last output, a compensated sum, so that a rate far below one unit in
/// the last place per sample still moves.
///
/// Law: `u[k] = clamp(clamp(v[k], u[k-1] - ts*rate_down, u[k-1] + ts*rate_up), lo, hi)`: the range beats the rate,
/// so that a range that moves inwards holds at once.
/// Cost: 6 compares, up to 5 additions. Total: any `v`, NaN included, gives an output in the range.
/// Source: own; range before rate is a rule of this project.
///
/// ```
/// use controller_core::{Accumulator, Limit, LimitConfig};
/// let config = LimitConfig { lo: 0.0, hi: 10.0, rate_up: Some(50.0), rate_down: None };
/// let limit = Limit::<f32>::new(&config, 0.1).unwrap();
/// let mut last = Accumulator::new(2.0);
/// let out = limit.apply(&mut last, 9.0);
/// assert_eq!((out.u, out.rate), (7.0, true));
/// assert!(limit.apply(&mut last, 11.0).high);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit<T> {
    lo: T,
    hi: T,
    up: T,
    down: T,
}

/// A limited output and which limit was active.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limited<T> {
    /// The output \[u\].
    pub u: T,
    /// It is at the upper limit.
    pub high: bool,
    /// It is at the lower limit.
    pub low: bool,
    /// The rate held it back.
    pub rate: bool,
}

impl<T: Real> Limit<T> {
    /// The limiter for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Bounds that are not finite, larger than 1e12 or leave no room; rates that are not above 0.
    pub fn new(config: &LimitConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        check.bounds((Param::OutputLo, config.lo), (Param::OutputHi, config.hi), RANGE_LIMIT);
        check.optional(Param::OutputRateUp, config.rate_up, f64::MIN_POSITIVE, 1e15);
        check.optional(Param::OutputRateDown, config.rate_down, f64::MIN_POSITIVE, 1e15);
        // Wider than any step between two ranges: never active, and a missing rate costs the same as a given one.
        let full = 8.0 * RANGE_LIMIT;
        let per_sample = |rate: Option<f64>| rate.map_or(full, |r| (r * ts).min(full));
        check.finish(Self {
            lo: T::from_f64(config.lo),
            hi: T::from_f64(config.hi),
            up: coefficient(per_sample(config.rate_up)),
            down: coefficient(per_sample(config.rate_down)),
        })
    }

    /// Limits `v` \[u\] after the output `last`, which becomes this one.
    #[inline(always)]
    pub fn apply(&self, last: &mut Accumulator<T>, v: T) -> Limited<T> {
        let rate = last.approach(v, self.down, self.up);
        let slewed = last.value();
        // Nearly every sample: what follows would leave the output as it is.
        if slewed > self.lo && slewed < self.hi {
            return Limited { u: slewed, high: false, low: false, rate };
        }
        let u = slewed.clamp_to(self.lo, self.hi);
        if u != slewed {
            last.set(u);
        }
        Limited { u, high: u >= self.hi, low: u <= self.lo, rate }
    }

    /// The same limiter with steps of at most `step` \[u\], above 0.
    #[must_use]
    #[inline(always)]
    pub fn no_faster_than(mut self, step: T) -> Self {
        self.up = if step < self.up { step } else { self.up };
        self.down = if step < self.down { step } else { self.down };
        self
    }

    /// `v` moved into the range, without the rate.
    #[must_use]
    #[inline(always)]
    pub fn into_range(&self, v: T) -> T {
        v.clamp_to(self.lo, self.hi)
    }

    /// The longest steps of one sample, down and up \[u\], both above 0.
    #[must_use]
    pub fn steps(&self) -> (T, T) {
        (self.down, self.up)
    }

    /// Lowest output \[u\].
    #[must_use]
    pub fn lo(&self) -> T {
        self.lo
    }

    /// Highest output \[u\].
    #[must_use]
    pub fn hi(&self) -> T {
        self.hi
    }

    /// Its numbers.
    #[inline(always)]
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.lo);
        words.number(self.hi);
        words.number(self.up);
        words.number(self.down);
    }
}
