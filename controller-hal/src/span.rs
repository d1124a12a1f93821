//! Counts of an ADC to engineering units.

use crate::faults::Faults;
use crate::number::Number;
use crate::sense::Reading;
use controller_core::{ConfigErrors, Param, Quality, Reason};

/// Largest size of a count: exact in single precision.
const COUNT_LIMIT: i32 = 1 << 24;

/// What a person writes for a [`CountSpan`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpanConfig {
    /// Counts at the two ends of the span, the lower first; sizes up to 2^24.
    pub counts: (i32, i32),
    /// Units at these counts \[y\], sizes up to 1e12; the first may be the larger one (a thermistor that falls).
    pub units: (f64, f64),
    /// Lowest and highest count of a sensor in order; beyond: [`Quality::Uncertain`].
    pub good: (i32, i32),
    /// Lowest and highest count that may be used at all, around `good`; beyond: [`Quality::Bad`].
    pub usable: (i32, i32),
}

impl SpanConfig {
    /// A sensor that is in order from end to end of its span, and bad beyond.
    #[must_use]
    pub const fn new(counts: (i32, i32), units: (f64, f64)) -> Self {
        Self { counts, units, good: counts, usable: counts }
    }

    /// A current loop of 4 to 20 mA, from its counts at 0 and 20 mA: good from 3.8 to 20.5 mA, failed below 3.6 and above
    /// 21 mA, as NAMUR NE 43 has it. A broken wire is a bad sample, not a cold furnace.
    ///
    /// ```
    /// use controller_core::Quality;
    /// use controller_hal::{CountSpan, SpanConfig};
    /// // 0.15 V to 3 V across 150 ohms: 200 counts per mA
    /// let span = CountSpan::<f32>::new(&SpanConfig::current_loop((0, 4000), (0.0, 160.0))).unwrap();
    /// let at = |milliamperes: f32| span.reading((200.0 * milliamperes) as i32);
    /// assert_eq!((at(12.0).value, at(12.0).quality), (80.0, Quality::Good));
    /// assert_eq!((at(3.7).quality, at(3.5).quality), (Quality::Uncertain, Quality::Bad));
    /// assert_eq!((at(20.5).quality, at(20.9).quality, at(21.1).quality), (Quality::Good, Quality::Uncertain, Quality::Bad));
    /// ```
    #[must_use]
    pub fn current_loop(counts: (i32, i32), units: (f64, f64)) -> Self {
        let (zero, full) = (f64::from(counts.0), f64::from(counts.1));
        let at = |milliamperes: f64| {
            let counts = zero + (full - zero) * (milliamperes / 20.0);
            let nearest = if counts < 0.0 { counts - 0.5 } else { counts + 0.5 };
            nearest.to_counts()
        };
        Self { counts: (at(4.0), counts.1), units, good: (at(3.8), at(20.5)), usable: (at(3.6), at(21.0)) }
    }
}

/// Scales the counts of an ADC to units and judges them.
///
/// Law: `y = lo + (n - n_lo)*(hi - lo)/(n_hi - n_lo)`, the gain rounded once; the error is at most
/// `2*eps*(|lo| + |hi|)` within the span, none at `n_lo`. Cost: a conversion, 2 operations, 4 compares.
///
/// ```
/// use controller_core::Quality;
/// use controller_hal::{CountSpan, SpanConfig};
/// let config = SpanConfig { usable: (-5, 1030), ..SpanConfig::new((0, 1000), (-50.0, 150.0)) };
/// let span = CountSpan::<f32>::new(&config).unwrap();
/// assert_eq!(span.reading(250).value, 0.0);
/// assert_eq!((span.reading(1001).quality, span.reading(1031).quality), (Quality::Uncertain, Quality::Bad));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountSpan<T> {
    zero: i32,
    lo: T,
    gain: T,
    good: (i32, i32),
    usable: (i32, i32),
}

impl<T: Number> CountSpan<T> {
    /// The span of `config`.
    ///
    /// # Errors
    /// Counts larger than 2^24 or with no room between; units that are not finite, larger than 1e12 or too near to each other
    /// for the number type; `good` not within `usable`.
    pub fn new(config: &SpanConfig) -> Result<Self, ConfigErrors> {
        let mut faults = Faults::default();
        let pairs = [
            (Param::Counts, config.counts),
            (Param::GoodCounts, config.good),
            (Param::UsableCounts, config.usable),
        ];
        let most = f64::from(COUNT_LIMIT);
        for (param, (lo, hi)) in pairs {
            let (lo, hi) = (f64::from(lo), f64::from(hi));
            if faults.range(param, lo, -most, most) & faults.range(param, hi, -most, most) && lo >= hi {
                faults.fault(param, Reason::Inverted, lo, -most, hi);
            }
        }
        let (good, usable) = (config.good, config.usable);
        if good.0 < usable.0 || good.1 > usable.1 {
            faults.fault(
                Param::GoodCounts,
                Reason::OutOfRange,
                f64::from(if good.0 < usable.0 { good.0 } else { good.1 }),
                f64::from(usable.0),
                f64::from(usable.1),
            );
        }
        let (lo, hi) = config.units;
        faults.ends(lo, hi, T::EPS);
        let width = f64::from(config.counts.1) - f64::from(config.counts.0);
        let gain = (hi - lo) / width;
        faults.finish(Self {
            zero: config.counts.0,
            lo: T::from_f64(lo),
            gain: T::from_f64(gain),
            good,
            usable,
        })
    }

    /// `counts` in units \[y\].
    #[must_use]
    #[inline]
    pub fn units(&self, counts: i32) -> T {
        self.lo + T::from_counts(counts.saturating_sub(self.zero)) * self.gain
    }

    /// `counts` in units, with its quality.
    #[must_use]
    #[inline]
    pub fn reading(&self, counts: i32) -> Reading<T> {
        let within = |(lo, hi): (i32, i32)| counts >= lo && counts <= hi;
        let quality = match (within(self.usable), within(self.good)) {
            (false, _) => Quality::Bad,
            (true, false) => Quality::Uncertain,
            (true, true) => Quality::Good,
        };
        Reading { value: self.units(counts), quality }
    }

    /// As [`reading`](Self::reading) for an ADC that ends at the codes `ends`: there the true value may lie beyond, so
    /// that the reading is [`Quality::Uncertain`] at best.
    #[must_use]
    pub fn reading_between(&self, counts: i32, ends: (i32, i32)) -> Reading<T> {
        let reading = self.reading(counts);
        let clipped = counts <= ends.0 || counts >= ends.1;
        let quality = match reading.quality {
            Quality::Good if clipped => Quality::Uncertain,
            quality => quality,
        };
        Reading { quality, ..reading }
    }
}
