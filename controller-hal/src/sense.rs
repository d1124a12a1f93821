//! What reads a measurement.

use controller_core::{ControllerInput, Quality, Real};

/// A measurement and how good it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading<T> {
    /// The measurement \[y\].
    pub value: T,
    /// Whether it may be used.
    pub quality: Quality,
}

impl<T> Reading<T> {
    /// A reading that is in order.
    ///
    /// ```
    /// use controller_core::Quality;
    /// use controller_hal::Reading;
    /// assert_eq!(Reading::good(21.5), Reading { value: 21.5, quality: Quality::Good });
    /// ```
    #[must_use]
    pub const fn good(value: T) -> Self {
        Self { value, quality: Quality::Good }
    }
}

impl<T: Real> Reading<T> {
    /// `input` with this reading as its measurement.
    ///
    /// ```
    /// use controller_core::{ControllerInput, Quality};
    /// use controller_hal::Reading;
    /// let reading = Reading { value: 21.5, quality: Quality::Uncertain };
    /// let input = reading.into_input(ControllerInput { r: 20.0, ..ControllerInput::default() });
    /// assert_eq!((input.r, input.y, input.quality), (20.0, 21.5, Quality::Uncertain));
    /// ```
    #[must_use]
    pub fn into_input(self, input: ControllerInput<T>) -> ControllerInput<T> {
        ControllerInput { y: self.value, quality: self.quality, ..input }
    }
}

/// Something that measures. (embedded-hal 1.0 has no trait for ADCs.)
///
/// An implementation for the ADC in a microcontroller is a few lines:
///
/// ```
/// use controller_hal::{CountSpan, Reading, Sense, SpanConfig};
/// struct Temperature {
///     read: fn() -> u16, // what the vendor's crate offers
///     span: CountSpan<f32>,
/// }
/// impl Sense<f32> for Temperature {
///     type Error = core::convert::Infallible;
///     fn sample(&mut self) -> Result<Reading<f32>, Self::Error> {
///         Ok(self.span.reading(i32::from((self.read)())))
///     }
/// }
/// let span = CountSpan::new(&SpanConfig::new((0, 4095), (0.0, 409.5))).unwrap();
/// let mut sensor = Temperature { read: || 1000, span };
/// assert_eq!(sensor.sample().unwrap().value, 100.0);
/// ```
pub trait Sense<T> {
    /// Why there may be no measurement.
    type Error;

    /// Measures.
    ///
    /// # Errors
    /// When there is no measurement; one that is there but doubtful says so by its quality.
    fn sample(&mut self) -> Result<Reading<T>, Self::Error>;
}

impl<T, S: Sense<T> + ?Sized> Sense<T> for &mut S {
    type Error = S::Error;
    fn sample(&mut self) -> Result<Reading<T>, S::Error> {
        S::sample(self)
    }
}

/// A sensor whose failures become bad samples: what a loop reads from.
///
/// A failure, and a measurement that is not finite, is a reading of [`Quality::Bad`] with the last usable value (0 before the first); it is counted.
///
/// ```
/// use controller_core::Quality;
/// use controller_hal::{Monitored, Reading, Sense};
/// struct Loose(u32);
/// impl Sense<f32> for Loose {
///     type Error = &'static str;
///     fn sample(&mut self) -> Result<Reading<f32>, Self::Error> {
///         self.0 += 1;
///         if self.0 == 2 { Err("no answer") } else { Ok(Reading { value: 20.0, quality: Quality::Good }) }
///     }
/// }
/// let mut sensor = Monitored::new(Loose(0));
/// assert_eq!(sensor.read().quality, Quality::Good);
/// assert_eq!(sensor.read(), Reading { value: 20.0, quality: Quality::Bad });
/// assert_eq!((sensor.failures(), sensor.failures_in_a_row(), sensor.last_error()), (1, 1, Some(&"no answer")));
/// assert_eq!(sensor.read().quality, Quality::Good);
/// assert_eq!((sensor.failures(), sensor.failures_in_a_row()), (1, 0));
/// ```
#[derive(Debug)]
pub struct Monitored<S: Sense<T>, T> {
    sensor: S,
    last: T,
    last_error: Option<S::Error>,
    failures: u32,
    in_a_row: u32,
}

impl<T: Real, S: Sense<T>> Monitored<S, T> {
    /// Watches over `sensor`.
    pub fn new(sensor: S) -> Self {
        Self { sensor, last: T::ZERO, last_error: None, failures: 0, in_a_row: 0 }
    }

    /// Measures; never fails.
    pub fn read(&mut self) -> Reading<T> {
        match self.sensor.sample() {
            Ok(reading) if reading.value.is_finite_number() => {
                if reading.quality != Quality::Bad {
                    self.last = reading.value;
                }
                self.in_a_row = 0;
                return reading;
            }
            Ok(_) => {}
            Err(error) => self.last_error = Some(error),
        }
        self.failures = self.failures.saturating_add(1);
        self.in_a_row = self.in_a_row.saturating_add(1);
        Reading { value: self.last, quality: Quality::Bad }
    }

    /// Failures so far; stays at `u32::MAX` once there.
    #[must_use]
    pub fn failures(&self) -> u32 {
        self.failures
    }

    /// Failures since the sensor last answered.
    #[must_use]
    pub fn failures_in_a_row(&self) -> u32 {
        self.in_a_row
    }

    /// Why the sensor last did not answer.
    #[must_use]
    pub fn last_error(&self) -> Option<&S::Error> {
        self.last_error.as_ref()
    }

    /// The sensor.
    pub fn sensor_mut(&mut self) -> &mut S {
        &mut self.sensor
    }

    /// Gives the sensor back.
    pub fn release(self) -> S {
        self.sensor
    }
}
