//! Whether a measurement may be used, and what a loop does while none may.

use crate::error::{Checker, ConfigErrors, Param};
use crate::limit::RANGE_LIMIT;
use crate::real::{Real, coefficient};
use crate::snapshot::Words;
use crate::stored::{Flag, Optional};

/// How good the sender says a measurement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Quality {
    /// Use it.
    #[default]
    Good = 0,
    /// Use it, and say so in the status.
    Uncertain = 1,
    /// Do not use it.
    Bad = 2,
}

/// What the output does when the measurement has been bad for longer than `hold_samples`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FallbackAction {
    /// Stays where it is.
    #[default]
    Hold,
    /// Goes to `output` \[u\] (within the rate limit).
    Substitute {
        /// The output to go to \[u\].
        output: f64,
    },
    /// Goes to `output` \[u\] at `rate` [u/s].
    Ramp {
        /// The output to go to \[u\].
        output: f64,
        /// How fast [u/s], above 0.
        rate: f64,
    },
}

impl FallbackAction {
    /// The output it goes to \[u\]; `None` when it stays.
    #[must_use]
    pub fn output(&self) -> Option<f64> {
        match *self {
            Self::Hold => None,
            Self::Substitute { output } | Self::Ramp { output, .. } => Some(output),
        }
    }
}

/// When a loop closes again after a fallback.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FallbackReturn {
    /// With the first good measurement.
    #[default]
    Automatic,
    /// With the first good measurement that comes together with an acknowledgement.
    Acknowledged,
}

/// The policy for bad measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FallbackConfig {
    /// Bad samples in a row for which output and terms are simply held; default 25. While it may last, holding costs far
    /// less than settling anew (a few per cent of IAE against tens in the middle of a transient); held too long, the jump
    /// of the measurement at its end reaches the output through the derivative and the compensator. A tenth of the
    /// plant's mean response time is a good limit.
    pub hold_samples: u16,
    /// What to do after that.
    pub action: FallbackAction,
    /// How to come back.
    pub back: FallbackReturn,
}

impl Default for FallbackConfig {
    fn default() -> Self {
        Self { hold_samples: 25, action: FallbackAction::Hold, back: FallbackReturn::Automatic }
    }
}

impl FallbackConfig {
    /// The same configuration with every number rounded to `T`.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        let action = match self.action {
            FallbackAction::Hold => FallbackAction::Hold,
            FallbackAction::Substitute { output } => FallbackAction::Substitute { output: round(output) },
            FallbackAction::Ramp { output, rate } => {
                FallbackAction::Ramp { output: round(output), rate: round(rate) }
            }
        };
        Self { action, ..*self }
    }
}

/// What a loop may do with the measurement of this sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Verdict {
    /// Use it.
    Use,
    /// Use it after settling everything at it: the loop has been without one for long.
    UseAfterSettling,
    /// Hold the output for now.
    Hold,
    /// The fallback is in force.
    Fallback,
    /// The measurement is good, but the fallback waits for an acknowledgement.
    Await,
}

/// State of a [`SampleGuard`]: bad samples in a row, and whether the fallback is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SampleGuardState {
    pub(crate) bad: u16,
    pub(crate) fallback: Flag,
    pub(crate) settle: Flag,
}

/// Judges measurements: finite, in range, not marked bad; counts bad ones; decides on hold, fallback and return.
///
/// Law: up to `hold_samples` bad samples in a row are held without re-initialisation; the next one starts the
/// fallback; a good one ends it, at once or with an acknowledgement, by settling at the measurement.
/// Source: own, after the fault handling of process controllers. Cost: 2 compares and a few integer instructions.
///
/// ```
/// use controller_core::{FallbackConfig, Quality, SampleGuard, SampleGuardState, Verdict};
/// let guard = SampleGuard::<f32>::new(&FallbackConfig { hold_samples: 1, ..FallbackConfig::default() }, -10.0, 110.0, 0.1).unwrap();
/// let mut state = SampleGuardState::default();
/// assert_eq!(guard.judge(&mut state, 20.0, Quality::Good, false), Verdict::Use);
/// assert_eq!(guard.judge(&mut state, f32::NAN, Quality::Good, false), Verdict::Hold);
/// assert_eq!(guard.judge(&mut state, 850.0, Quality::Good, false), Verdict::Fallback);
/// assert_eq!(guard.judge(&mut state, 21.0, Quality::Good, false), Verdict::UseAfterSettling);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleGuard<T> {
    lo: T,
    hi: T,
    hold_samples: u16,
    acknowledged: Flag,
    target: Optional<T>,
    step: T,
}

impl<T: Real> SampleGuard<T> {
    /// A guard for measurements in `lo..=hi` \[y\] sampled every `ts` \[s\].
    ///
    /// # Errors
    /// A range that is not finite, larger than 1e12 or empty; a fallback output that is not finite or larger than
    /// 1e12; a rate that is not above 0.
    pub fn new(config: &FallbackConfig, lo: f64, hi: f64, ts: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        check.bounds((Param::MeasurementLo, lo), (Param::MeasurementHi, hi), RANGE_LIMIT);
        let free = 4.0 * RANGE_LIMIT;
        let (target, step) = match config.action {
            FallbackAction::Hold => (None, free),
            FallbackAction::Substitute { output } => (Some(output), free),
            FallbackAction::Ramp { output, rate } => {
                check.range(Param::FallbackRate, rate, f64::MIN_POSITIVE, 1e15);
                (Some(output), (rate * ts).min(free))
            }
        };
        check.optional(Param::FallbackOutput, target, -RANGE_LIMIT, RANGE_LIMIT);
        check.finish(Self {
            lo: T::from_f64(lo),
            hi: T::from_f64(hi),
            hold_samples: config.hold_samples,
            acknowledged: Flag::new(config.back == FallbackReturn::Acknowledged),
            target: Optional::new(target.map(coefficient)),
            step: coefficient(step),
        })
    }

    /// Whether `y` is as good as the measurements before: [`judge`](Self::judge) then says [`Verdict::Use`] and changes
    /// nothing.
    #[inline(always)]
    pub(crate) fn goes_on(&self, state: &SampleGuardState, y: T, quality: Quality) -> bool {
        let [low, high] = state.bad.to_le_bytes();
        let nothing_remembered =
            u32::from_le_bytes([low, high, state.fallback.byte(), state.settle.byte()]) == 0;
        y >= self.lo && y <= self.hi && quality == Quality::Good && nothing_remembered
    }

    /// Judges the measurement `y` of quality `quality`.
    #[inline]
    pub fn judge(&self, state: &mut SampleGuardState, y: T, quality: Quality, acknowledge: bool) -> Verdict {
        let good = y >= self.lo && y <= self.hi && quality != Quality::Bad;
        if !good {
            if state.bad >= self.hold_samples {
                state.fallback = Flag::new(true);
            } else {
                state.bad += 1;
            }
            return if state.fallback.is_set() { Verdict::Fallback } else { Verdict::Hold };
        }
        if state.fallback.is_set() && self.acknowledged.is_set() && !acknowledge {
            return Verdict::Await;
        }
        let settle = state.fallback.is_set() || state.settle.is_set();
        *state = SampleGuardState::default();
        if settle { Verdict::UseAfterSettling } else { Verdict::Use }
    }

    /// Tells the guard that `n` samples were lost: more than may be held means settling at the next good one.
    pub fn lost(&self, state: &mut SampleGuardState, n: u32) {
        // Lost and bad samples are the same to the loop: time without a measurement.
        let without = u32::from(state.bad).saturating_add(n);
        state.bad = u16::try_from(without).unwrap_or(u16::MAX);
        if without > u32::from(self.hold_samples) {
            state.settle = Flag::new(true);
        }
    }

    /// Where the fallback takes the output \[u\] (`None`: it stays) and the longest step on the way \[u\].
    #[must_use]
    pub fn fallback_output(&self) -> (Option<T>, T) {
        (self.target.get(), self.step)
    }

    /// Bad samples in a row that are held.
    #[must_use]
    pub fn hold_samples(&self) -> u16 {
        self.hold_samples
    }

    /// Whether a fallback ends with an acknowledgement only.
    #[must_use]
    pub fn is_acknowledged(&self) -> bool {
        self.acknowledged.is_set()
    }

    /// The measurement's range \[y\].
    #[must_use]
    pub fn range(&self) -> (T, T) {
        (self.lo, self.hi)
    }

    /// Its numbers.
    #[inline(always)]
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.lo);
        words.number(self.hi);
        words.number(self.step);
        self.target.write(words);
        words.word(u32::from(self.hold_samples) | u32::from(self.acknowledged.byte()) << 16);
    }
}
