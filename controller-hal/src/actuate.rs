//! What moves the plant.

use crate::faults::Faults;
use crate::number::Number;
use controller_core::{ConfigErrors, Param};
use core::fmt;

/// Something that carries out an output. Over a DAC, a PWM channel, a relay.
///
/// ```
/// use controller_hal::{Actuate, ActuateError};
/// struct Valve(u16); // steps, 0 to 200
/// impl Actuate<f32> for Valve {
///     type Error = core::convert::Infallible;
///     fn apply(&mut self, u: f32) -> Result<f32, ActuateError<Self::Error>> {
///         if !u.is_finite() {
///             return Err(ActuateError::NotFinite);
///         }
///         self.0 = (2.0 * u) as u16;
///         Ok(0.5 * f32::from(self.0))
///     }
/// }
/// assert_eq!(Valve(0).apply(33.3), Ok(33.0)); // what a loop takes for `u_applied`
/// ```
pub trait Actuate<T> {
    /// Why the device may not do it.
    type Error;

    /// Carries out `u`; gives what was accepted, limited and quantised \[u\].
    ///
    /// # Errors
    /// When `u` is not finite (nothing is carried out, or what is safe), or the device did not take it.
    fn apply(&mut self, u: T) -> Result<T, ActuateError<Self::Error>>;
}

impl<T, A: Actuate<T> + ?Sized> Actuate<T> for &mut A {
    type Error = A::Error;
    fn apply(&mut self, u: T) -> Result<T, ActuateError<A::Error>> {
        A::apply(self, u)
    }
}

/// Why an output was not carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ActuateError<E> {
    /// It was not finite; the actuator keeps its output or has gone to its safe one ([`OnInvalid`]).
    NotFinite,
    /// The device or its bus failed; what the actuator does now is not known.
    Device(E),
}

impl<E: fmt::Debug> fmt::Display for ActuateError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("the output is not a finite number"),
            Self::Device(error) => write!(f, "the actuator failed: {error:?}"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for ActuateError<E> {}

/// What an actuator does with an output that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum OnInvalid {
    /// It keeps what it has.
    #[default]
    Keep,
    /// It goes to this output \[u\].
    Safe(f64),
}

/// Range of an actuator; what a person writes for an [`OutputSpan`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OutputConfig {
    /// Output at the lowest level \[u\]; default 0.
    pub lo: f64,
    /// Output at the highest level \[u\], above `lo`; default 100.
    pub hi: f64,
    /// What to do with an output that is not finite.
    pub invalid: OnInvalid,
}

impl Default for OutputConfig {
    fn default() -> Self {
        Self { lo: 0.0, hi: 100.0, invalid: OnInvalid::Keep }
    }
}

/// Scales outputs to the levels of a device, `0..=full`, and back.
///
/// Law: `n = round(full * clamp((u - lo)/(hi - lo), 0, 1))`, halves upwards; back `u = lo + (hi - lo)*n/full`. The ends are
/// met exactly. Cost: 3 operations and a conversion, 4 compares; back a division.
///
/// ```
/// use controller_hal::{OutputConfig, OutputSpan};
/// let span = OutputSpan::<f32>::new(&OutputConfig { lo: -10.0, hi: 10.0, ..OutputConfig::default() }).unwrap();
/// assert_eq!(span.level(0.0, 4094), Some(2047));
/// assert_eq!((span.level(99.0, 4094), span.level(-99.0, 4094), span.level(f32::NAN, 4094)), (Some(4094), Some(0), None));
/// assert_eq!(span.output(4094, 4094), 10.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputSpan<T> {
    lo: T,
    hi: T,
    /// `1/(hi - lo)`.
    per_width: T,
    safe: Option<T>,
}

impl<T: Number> OutputSpan<T> {
    /// The span of `config`.
    ///
    /// # Errors
    /// Ends that are not finite, larger than 1e12, too near to each other for the number type or in the wrong order; a safe
    /// output outside.
    pub fn new(config: &OutputConfig) -> Result<Self, ConfigErrors> {
        let mut faults = Faults::default();
        let (lo, hi) = (config.lo, config.hi);
        if lo > hi {
            faults.range(Param::Span, lo, lo.min(hi), hi);
        } else {
            faults.ends(lo, hi, T::EPS);
        }
        let safe = match config.invalid {
            OnInvalid::Keep => None,
            OnInvalid::Safe(output) => {
                faults.range(Param::SafeOutput, output, lo.min(hi), hi.max(lo));
                Some(T::from_f64(output))
            }
        };
        let (lo, hi) = (T::from_f64(lo), T::from_f64(hi));
        let per_width = T::from_f64(1.0 / (hi.to_f64() - lo.to_f64()));
        faults.finish(Self { lo, hi, per_width, safe })
    }

    /// The level of `u` on a scale that ends at `full`; `None` when `u` is not finite.
    #[must_use]
    #[inline]
    pub fn level(&self, u: T, full: u16) -> Option<u16> {
        if !u.is_finite_number() {
            return None;
        }
        let (full, half) = (i32::from(full), T::from_f64(0.5));
        let nearest = (self.fraction(u) * T::from_counts(full) + half).to_counts();
        u16::try_from(if nearest > full { full } else { nearest }).ok()
    }

    /// Where `u` lies between the ends, 0 to 1; 0 for a NaN.
    #[must_use]
    #[inline]
    pub fn fraction(&self, u: T) -> T {
        // Met exactly, which a rounded product need not be.
        if u >= self.hi { T::ONE } else { ((u - self.lo) * self.per_width).clamp_to(T::ZERO, T::ONE) }
    }

    /// The output of a level on a scale that ends at `full` \[u\].
    #[must_use]
    #[inline]
    pub fn output(&self, level: u16, full: u16) -> T {
        if level == 0 || full == 0 {
            return self.lo;
        }
        if level >= full {
            return self.hi;
        }
        let part = T::from_counts(i32::from(level)) / T::from_counts(i32::from(full));
        (self.lo + (self.hi - self.lo) * part).clamp_to(self.lo, self.hi)
    }

    /// The output to go to instead of one that is not finite; `None`: keep what is there.
    #[must_use]
    pub fn safe(&self) -> Option<T> {
        self.safe
    }

    /// The ends \[u\].
    #[must_use]
    pub fn range(&self) -> (T, T) {
        (self.lo, self.hi)
    }

    /// Brings `u`, or what is safe in its place, to a device as a level of `0..=full`; notes in `applied` what it took.
    pub(crate) fn drive<E>(
        &self,
        u: T,
        full: u16,
        applied: &mut Option<T>,
        device: impl FnOnce(u16) -> Result<(), E>,
    ) -> Result<T, ActuateError<E>> {
        let asked = self.level(u, full);
        let Some(level) = asked.or_else(|| self.level(self.safe?, full)) else {
            return Err(ActuateError::NotFinite);
        };
        if let Err(error) = device(level) {
            *applied = None;
            return Err(ActuateError::Device(error));
        }
        let output = self.output(level, full);
        *applied = Some(output);
        if asked.is_some() { Ok(output) } else { Err(ActuateError::NotFinite) }
    }
}
