//! Set-point conditioning: range, rate, following the measurement.

use crate::accumulator::Accumulator;
use crate::error::{Checker, ConfigErrors, Param};
use crate::limit::RANGE_LIMIT;
use crate::real::{Real, coefficient};
use crate::snapshot::Words;
use crate::stored::Flag;

/// Range and rate of a set-point. Bounds up to 1e12 in size, rates above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SetpointConfig {
    /// Lowest set-point \[y\]; default -1e6.
    pub lo: f64,
    /// Highest set-point \[y\], above `lo`; default 1e6.
    pub hi: f64,
    /// Fastest rise [y/s], above 0; `None`: no limit.
    pub rate_up: Option<f64>,
    /// Fastest fall [y/s], above 0; `None`: no limit.
    pub rate_down: Option<f64>,
    /// In Off, Manual and Track the working set-point follows the measurement (`sp_track`).
    pub track: bool,
}

impl Default for SetpointConfig {
    fn default() -> Self {
        Self { lo: -1e6, hi: 1e6, rate_up: None, rate_down: None, track: false }
    }
}

impl SetpointConfig {
    /// The same configuration with every number rounded to `T`.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            lo: round(self.lo),
            hi: round(self.hi),
            rate_up: self.rate_up.map(round),
            rate_down: self.rate_down.map(round),
            track: self.track,
        }
    }
}

/// A set-point conditioner for one sampling period. Its state is the working set-point, a compensated sum, so that slow
/// ramps do not stall.
///
/// Law: `w[k] = clamp(clamp(r[k], lo, hi), w[k-1] - ts*rate_down, w[k-1] + ts*rate_up)`; after the range itself has
/// moved, the working set-point ramps back into it. Cost: 4 compares, up to 5 additions. Source: own.
///
/// ```
/// use controller_core::{Accumulator, Setpoint, SetpointConfig};
/// let config = SetpointConfig { lo: 0.0, hi: 90.0, rate_up: Some(10.0), ..SetpointConfig::default() };
/// let setpoint = Setpoint::<f64>::new(&config, 0.5).unwrap();
/// let mut w = Accumulator::new(setpoint.start(200.0, 20.0)); // a ramp starts at the measurement
/// assert_eq!(w.value(), 20.0);
/// setpoint.advance(&mut w, 200.0);
/// assert_eq!(w.value(), 25.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint<T> {
    lo: T,
    hi: T,
    up: T,
    down: T,
    ramps: Flag,
    track: Flag,
}

impl<T: Real> Setpoint<T> {
    /// The conditioner for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Bounds that are not finite, larger than 1e12 or leave no room; rates that are not above 0.
    pub fn new(config: &SetpointConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        check.bounds((Param::SetpointLo, config.lo), (Param::SetpointHi, config.hi), RANGE_LIMIT);
        check.optional(Param::SetpointRateUp, config.rate_up, f64::MIN_POSITIVE, 1e15);
        check.optional(Param::SetpointRateDown, config.rate_down, f64::MIN_POSITIVE, 1e15);
        // Twice the largest range: never active, and finite.
        let free = 4.0 * RANGE_LIMIT;
        let per_sample = |rate: Option<f64>| rate.map_or(free, |r| (r * ts).min(free));
        check.finish(Self {
            lo: T::from_f64(config.lo),
            hi: T::from_f64(config.hi),
            up: coefficient(per_sample(config.rate_up)),
            down: coefficient(per_sample(config.rate_down)),
            ramps: Flag::new(config.rate_up.is_some() || config.rate_down.is_some()),
            track: Flag::new(config.track),
        })
    }

    /// The working set-point to begin with \[y\]: the set-point, or the measurement `y` when a rate is given or the
    /// set-point follows the measurement.
    #[must_use]
    pub fn start(&self, r: T, y: T) -> T {
        self.into_range(if self.ramps.is_set() || self.track.is_set() { y } else { r })
    }

    /// Moves the working set-point towards `r` \[y\].
    #[inline(always)]
    pub fn advance(&self, working: &mut Accumulator<T>, r: T) {
        self.ramp(working, self.into_range(r));
    }

    /// As [`advance`](Self::advance) for a set-point that is in the range already.
    #[inline(always)]
    pub fn ramp(&self, working: &mut Accumulator<T>, r: T) {
        // Most set-points rest: one compare for them.
        if r == working.value() {
            working.set(r);
        } else {
            let _ = working.approach(r, self.down, self.up);
        }
    }

    /// `r` moved into the range \[y\].
    #[must_use]
    #[inline(always)]
    pub fn into_range(&self, r: T) -> T {
        r.clamp_to(self.lo, self.hi)
    }

    /// Whether `r` is within the range and not at an end of it: [`into_range`](Self::into_range) then gives `r`.
    #[inline(always)]
    pub(crate) fn is_inside(&self, r: T) -> bool {
        r > self.lo && r < self.hi
    }

    /// Whether the working set-point follows the measurement while the loop is open.
    #[must_use]
    pub fn tracks(&self) -> bool {
        self.track.is_set()
    }

    /// The longest steps of one sample, down and up \[y\], both above 0.
    #[must_use]
    pub fn steps(&self) -> (T, T) {
        (self.down, self.up)
    }

    /// Whether a rate was given.
    #[must_use]
    pub fn ramps(&self) -> bool {
        self.ramps.is_set()
    }

    /// The range \[y\].
    #[must_use]
    pub fn range(&self) -> (T, T) {
        (self.lo, self.hi)
    }

    /// Its numbers.
    #[inline(always)]
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.lo);
        words.number(self.hi);
        words.number(self.up);
        words.number(self.down);
        words.word(u32::from(self.ramps.byte()) | u32::from(self.track.byte()) << 8);
    }
}
