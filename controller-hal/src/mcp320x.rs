//! ADCs (analogue-to-digital converters) on an SPI bus.

use crate::number::Number;
use crate::sense::{Reading, Sense};
use crate::span::CountSpan;
use embedded_hal::spi::SpiDevice;

/// First and last code.
const ENDS: (i32, i32) = (0, 4095);

/// Why an ADC gave no measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mcp320xError<E> {
    /// The bus failed.
    Bus(E),
    /// The bit that is always 0 was 1: nobody drives the line.
    NoAnswer,
}

impl<E: core::fmt::Debug> core::fmt::Display for Mcp320xError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Bus(error) => write!(f, "the bus failed: {error:?}"),
            Self::NoAnswer => f.write_str("the ADC does not answer"),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for Mcp320xError<E> {}

/// The one-channel 12-bit ADC MCP3201: two bytes a sample, mode 0 or 3.
///
/// The first and the last code are [`Uncertain`](controller_core::Quality) at best: the voltage may lie beyond them.
///
/// ```no_run
/// # fn pressure(device: impl embedded_hal::spi::SpiDevice) -> Result<(), controller_core::ConfigErrors> {
/// use controller_hal::{CountSpan, Mcp3201, Monitored, SpanConfig};
/// let span = CountSpan::<f32>::new(&SpanConfig::current_loop((0, 4000), (0.0, 10.0)))?; // bar
/// let mut sensor = Monitored::new(Mcp3201::new(device, span));
/// let reading = sensor.read();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Mcp3201<D, T> {
    device: D,
    span: CountSpan<T>,
}

impl<D: SpiDevice, T: Number> Mcp3201<D, T> {
    /// The ADC behind `device`.
    pub const fn new(device: D, span: CountSpan<T>) -> Self {
        Self { device, span }
    }

    /// Gives the device back.
    pub fn release(self) -> D {
        self.device
    }
}

impl<D: SpiDevice, T: Number> Sense<T> for Mcp3201<D, T> {
    type Error = Mcp320xError<D::Error>;

    fn sample(&mut self) -> Result<Reading<T>, Self::Error> {
        let mut bytes = [0; 2];
        self.device.read(&mut bytes).map_err(Mcp320xError::Bus)?;
        // Two undefined bits, a zero, the code, and its second bit once more.
        let word = u16::from_be_bytes(bytes);
        if word & 0x2000 != 0 {
            return Err(Mcp320xError::NoAnswer);
        }
        Ok(self.span.reading_between(i32::from((word >> 1) & 0x0FFF), ENDS))
    }
}

/// One single-ended channel of the 12-bit ADCs MCP3204 (4 channels) and MCP3208 (8): three bytes a sample, mode 0
/// or 3. Several channels of one chip are several of these over a shared bus.
///
/// Codes and usage as [`Mcp3201`].
#[derive(Debug)]
pub struct Mcp3204<D, T> {
    device: D,
    channel: u8,
    span: CountSpan<T>,
}

impl<D: SpiDevice, T: Number> Mcp3204<D, T> {
    /// Channel 0 to 7 of the ADC behind `device`; only the lowest three bits of `channel` count.
    pub const fn new(device: D, channel: u8, span: CountSpan<T>) -> Self {
        Self { device, channel: channel & 7, span }
    }

    /// Gives the device back.
    pub fn release(self) -> D {
        self.device
    }
}

impl<D: SpiDevice, T: Number> Sense<T> for Mcp3204<D, T> {
    type Error = Mcp320xError<D::Error>;

    fn sample(&mut self) -> Result<Reading<T>, Self::Error> {
        // Start bit, single-ended, channel.
        let mut bytes = [0x06 | (self.channel >> 2), self.channel << 6, 0];
        self.device.transfer_in_place(&mut bytes).map_err(Mcp320xError::Bus)?;
        let [_, high, low] = bytes;
        if high & 0x10 != 0 {
            return Err(Mcp320xError::NoAnswer);
        }
        let code = u16::from_be_bytes([high & 0x0F, low]);
        Ok(self.span.reading_between(i32::from(code), ENDS))
    }
}
