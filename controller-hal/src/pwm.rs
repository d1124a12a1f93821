//! A PWM channel (pulse-width modulation).

use crate::actuate::{Actuate, ActuateError, OutputConfig, OutputSpan};
use crate::number::Number;
use controller_core::ConfigErrors;
use embedded_hal::pwm::SetDutyCycle;

/// An output as a duty: `lo..=hi` \[u\] becomes `0..=max_duty_cycle()`, by the law of [`OutputSpan`].
///
/// Beyond the ends it saturates. An output that is not finite never becomes a duty: the channel keeps the one it has or
/// goes to a safe one ([`OnInvalid`](crate::OnInvalid)), and [`apply`](Actuate::apply) says so. A channel that can reach a
/// duty of 0 only stays at `lo`.
///
/// ```no_run
/// # fn heater(channel: impl embedded_hal::pwm::SetDutyCycle) -> Result<(), controller_core::ConfigErrors> {
/// use controller_hal::{Actuate, OnInvalid, OutputConfig, Pwm};
/// let config = OutputConfig { lo: 0.0, hi: 100.0, invalid: OnInvalid::Safe(0.0) };
/// let mut heater = Pwm::<_, f32>::new(channel, &config)?;
/// match heater.apply(42.0) {
///     Ok(applied) => { /* for the loop's `u_applied` */ }
///     Err(failure) => { /* log it; the heater is off or unknown */ }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Pwm<P, T> {
    channel: P,
    span: OutputSpan<T>,
    applied: Option<T>,
}

impl<P: SetDutyCycle, T: Number> Pwm<P, T> {
    /// Drives `channel`; sets no duty yet.
    ///
    /// # Errors
    /// As [`OutputSpan::new`].
    pub fn new(channel: P, config: &OutputConfig) -> Result<Self, ConfigErrors> {
        Ok(Self { channel, span: OutputSpan::new(config)?, applied: None })
    }

    /// What the channel does \[u\]; `None`: nothing yet, or not known since a failure.
    #[must_use]
    pub fn applied(&self) -> Option<T> {
        self.applied
    }

    /// Gives the channel back.
    pub fn release(self) -> P {
        self.channel
    }
}

impl<P: SetDutyCycle, T: Number> Actuate<T> for Pwm<P, T> {
    type Error = P::Error;

    fn apply(&mut self, u: T) -> Result<T, ActuateError<P::Error>> {
        let Self { channel, span, applied } = self;
        let full = channel.max_duty_cycle();
        span.drive(u, full, applied, |duty| channel.set_duty_cycle(duty))
    }
}
