//! A DAC (digital-to-analogue converter) on an I2C bus.

use crate::actuate::{Actuate, ActuateError, OutputConfig, OutputSpan};
use crate::number::Number;
use controller_core::ConfigErrors;
use embedded_hal::i2c::I2c;

/// The 12-bit DAC MCP4725 and those that take its fast write: `lo..=hi` \[u\] becomes the codes 0 to 4095, by the law
/// of [`OutputSpan`].
///
/// Two bytes a sample (at 400 kHz about 70 us with the address); the non-volatile memory is left alone. Beyond the ends
/// it saturates; an output that is not finite is never sent, as with [`Pwm`](crate::Pwm).
///
/// ```no_run
/// # fn valve(bus: impl embedded_hal::i2c::I2c) -> Result<(), controller_core::ConfigErrors> {
/// use controller_hal::{Actuate, Mcp4725, OutputConfig};
/// let mut valve = Mcp4725::<_, f32>::new(bus, Mcp4725::<(), f32>::ADDRESS, &OutputConfig::default())?;
/// let applied = valve.apply(50.0).ok();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Mcp4725<B, T> {
    bus: B,
    address: u8,
    span: OutputSpan<T>,
    applied: Option<T>,
}

impl<B, T> Mcp4725<B, T> {
    /// The address of a DAC whose pin A0 is low.
    pub const ADDRESS: u8 = 0x60;
    const FULL: u16 = 4095;
}

impl<B: I2c, T: Number> Mcp4725<B, T> {
    /// The DAC at `address`; writes nothing yet.
    ///
    /// # Errors
    /// As [`OutputSpan::new`].
    pub fn new(bus: B, address: u8, config: &OutputConfig) -> Result<Self, ConfigErrors> {
        Ok(Self { bus, address, span: OutputSpan::new(config)?, applied: None })
    }

    /// What the DAC gives \[u\]; `None`: nothing yet, or not known since a failure.
    #[must_use]
    pub fn applied(&self) -> Option<T> {
        self.applied
    }

    /// Gives the bus back.
    pub fn release(self) -> B {
        self.bus
    }
}

impl<B: I2c, T: Number> Actuate<T> for Mcp4725<B, T> {
    type Error = B::Error;

    fn apply(&mut self, u: T) -> Result<T, ActuateError<B::Error>> {
        let Self { bus, address, span, applied } = self;
        // Fast write: two zeros, power-down off (two zeros), the code, high bits first.
        span.drive(u, Self::FULL, applied, |code| bus.write(*address, &code.to_be_bytes()))
    }
}
