//! Output limits: range and rate.

use crate::error::{Checker, ConfigErrors, Param};
use crate::real::{Real, coefficient};

/// Largest size of any signal's range.
pub(crate) const RANGE_LIMIT: f64 = 1e12;

/// Range and rate of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// A limiter for range and rate.
///
/// Law: `u[k] = clamp(clamp(v[k], u[k-1] - ts*rate_down, u[k-1] + ts*rate_up), lo, hi)`: the range beats the rate,
/// so that a range that moves inwards holds at once.
/// Cost: 4 compares, 2 additions. Total: any `v`, NaN included, gives an output in the range.
///
/// ```
/// use controller_core::{Limit, LimitConfig};
/// let config = LimitConfig { lo: 0.0, hi: 10.0, rate_up: Some(50.0), rate_down: None };
/// let limit = Limit::<f32>::new(&config, 0.1).unwrap();
/// let out = limit.apply(2.0, 9.0);
/// assert_eq!((out.u, out.rate), (7.0, true));
/// assert!(limit.apply(8.0, 11.0).high);
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
pub struct Limited<T> {
    /// The output \[u\].
    pub u: T,
    /// At the upper limit.
    pub high: bool,
    /// At the lower limit.
    pub low: bool,
    /// The rate limit was active.
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
        // A step as wide as the range is no limit; so a missing rate costs the same as a given one.
        let full = 2.0 * (config.hi - config.lo);
        let per_sample = |rate: Option<f64>| rate.map_or(full, |r| (r * ts).min(full));
        check.finish(Self {
            lo: T::from_f64(config.lo),
            hi: T::from_f64(config.hi),
            up: coefficient(per_sample(config.rate_up)),
            down: coefficient(per_sample(config.rate_down)),
        })
    }

    /// Limits `v` \[u\] after an output `before` \[u\].
    #[must_use]
    #[inline(always)]
    pub fn apply(&self, before: T, v: T) -> Limited<T> {
        let slewed = v.clamp_to(before - self.down, before + self.up);
        let u = slewed.clamp_to(self.lo, self.hi);
        Limited { u, high: slewed > self.hi, low: slewed < self.lo, rate: slewed != v }
    }

    /// `v` moved into the range, without the rate.
    #[must_use]
    #[inline(always)]
    pub fn into_range(&self, v: T) -> T {
        v.clamp_to(self.lo, self.hi)
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
}
