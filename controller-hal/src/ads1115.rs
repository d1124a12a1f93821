//! A 16-bit ADC (analogue-to-digital converter) on an I2C bus.

use crate::number::Number;
use crate::sense::{Reading, Sense};
use crate::span::CountSpan;
use embedded_hal::i2c::I2c;

/// Codes at which the ADC ends.
const ENDS: (i32, i32) = (-32768, 32767);
/// Numbers of the registers.
const CONVERSION: u8 = 0;
const CONFIGURATION: u8 = 1;
/// Writing it starts a conversion; reading it as 1 says that none is going on.
const START_OR_READY: u16 = 1 << 15;
/// One conversion at a time; the comparator is off.
const SINGLE_SHOT: u16 = 1 << 8 | 0b11;
/// Polarity of the comparator, which is off: without effect, but the chip does not start with it. So no configuration that is
/// sent here is the one of a chip that was reset.
const NOT_RESET: u16 = 1 << 3;

/// Which pins are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Inputs {
    /// AIN0 against AIN1.
    Differential01 = 0,
    /// AIN0 against AIN3.
    Differential03 = 1,
    /// AIN1 against AIN3.
    Differential13 = 2,
    /// AIN2 against AIN3.
    Differential23 = 3,
    /// AIN0 against ground.
    Single0 = 4,
    /// AIN1 against ground.
    Single1 = 5,
    /// AIN2 against ground.
    Single2 = 6,
    /// AIN3 against ground.
    Single3 = 7,
}

/// Full scale of the amplifier, at 32768 counts. (The pins must not leave the supply, whatever the full scale.)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Gain {
    /// 6.144 V.
    V6_144 = 0,
    /// 4.096 V.
    V4_096 = 1,
    /// 2.048 V.
    V2_048 = 2,
    /// 1.024 V.
    V1_024 = 3,
    /// 0.512 V.
    V0_512 = 4,
    /// 0.256 V.
    V0_256 = 5,
}

impl Gain {
    /// Counts at a voltage \[V\], to write a span with; beyond the full scale the ADC never gets there.
    ///
    /// ```
    /// use controller_hal::Gain;
    /// assert_eq!((Gain::V4_096.counts(1.0), Gain::V4_096.counts(-0.5)), (8000, -4000));
    /// ```
    #[must_use]
    pub fn counts(self, volts: f64) -> i32 {
        let full = match self {
            Self::V6_144 => 6.144,
            Self::V4_096 => 4.096,
            Self::V2_048 => 2.048,
            Self::V1_024 => 1.024,
            Self::V0_512 => 0.512,
            Self::V0_256 => 0.256,
        };
        let counts = 32768.0 * volts / full;
        (if counts < 0.0 { counts - 0.5 } else { counts + 0.5 }).to_counts()
    }
}

/// Conversions per second; one takes the inverse of it, the chip's clock being good to 10 %.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Rate {
    /// 8 per second.
    R8 = 0,
    /// 16 per second.
    R16 = 1,
    /// 32 per second.
    R32 = 2,
    /// 64 per second.
    R64 = 3,
    /// 128 per second.
    R128 = 4,
    /// 250 per second.
    R250 = 5,
    /// 475 per second.
    R475 = 6,
    /// 860 per second.
    R860 = 7,
}

/// What an [`Ads1115`] measures and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ads1115Config {
    /// Address; 0x48 to 0x4B by the pin ADDR.
    pub address: u8,
    /// Pins.
    pub inputs: Inputs,
    /// Full scale.
    pub gain: Gain,
    /// Speed: a conversion must fit into a sampling period, with a fifth to spare.
    pub rate: Rate,
}

impl Default for Ads1115Config {
    fn default() -> Self {
        Self { address: 0x48, inputs: Inputs::Single0, gain: Gain::V2_048, rate: Rate::R860 }
    }
}

impl Ads1115Config {
    /// The configuration register, which starts a conversion.
    const fn word(self) -> u16 {
        START_OR_READY
            | (self.inputs as u16) << 12
            | (self.gain as u16) << 9
            | (self.rate as u16) << 5
            | SINGLE_SHOT
            | NOT_RESET
    }
}

/// Why there is no measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Ads1115Error<E> {
    /// The bus failed.
    Bus(E),
    /// No conversion is done: the first call, or the rate is too low for the sampling period.
    NotReady,
    /// The chip has another configuration than it was given, as after a loss of its supply. Its counts would mean other
    /// voltages; the next conversion is started anew.
    Reset,
}

impl<E: core::fmt::Debug> core::fmt::Display for Ads1115Error<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Bus(error) => write!(f, "the bus failed: {error:?}"),
            Self::NotReady => f.write_str("no conversion is done"),
            Self::Reset => f.write_str("the ADC has lost its configuration"),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for Ads1115Error<E> {}

/// The 16-bit ADC ADS1115 (and, with its codes in the upper 12 bits, ADS1015) in single shots, without waiting.
///
/// [`sample`](Sense::sample) takes the conversion that the call before has started, and starts the next: the measurement is
/// one sampling period old, which belongs into the loop's `latency`. Who has a second timer calls [`start`](Self::start) a
/// conversion time before the sample and [`collect`](Self::collect) in it. Bus traffic of a sample: 14 bytes, with their
/// acknowledgements and repeated starts about 0.3 ms at 400 kHz.
///
/// The ends of the ADC are [`Uncertain`](controller_core::Quality) at best, a conversion that is missing is an error:
/// through [`Monitored`](crate::Monitored) a bad sample.
///
/// ```no_run
/// # fn oven(bus: impl embedded_hal::i2c::I2c) -> Result<(), controller_core::ConfigErrors> {
/// use controller_hal::{Ads1115, Ads1115Config, CountSpan, Gain, Monitored, SpanConfig};
/// let gain = Gain::V4_096;
/// // A transmitter of 4 to 20 mA across 150 ohms, 0 to 400 degC.
/// let counts = (gain.counts(0.0), gain.counts(150.0 * 0.020));
/// let span = CountSpan::<f32>::new(&SpanConfig::current_loop(counts, (0.0, 400.0)))?;
/// let mut sensor = Monitored::new(Ads1115::new(bus, Ads1115Config { gain, ..Ads1115Config::default() }, span));
/// let reading = sensor.read();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Ads1115<B, T> {
    bus: B,
    config: Ads1115Config,
    span: CountSpan<T>,
    started: bool,
}

impl<B: I2c, T: Number> Ads1115<B, T> {
    /// The ADC on `bus`; sends nothing yet.
    pub const fn new(bus: B, config: Ads1115Config, span: CountSpan<T>) -> Self {
        Self { bus, config, span, started: false }
    }

    /// Starts a conversion.
    ///
    /// # Errors
    /// When the bus fails.
    pub fn start(&mut self) -> Result<(), Ads1115Error<B::Error>> {
        self.started = false;
        let [high, low] = self.config.word().to_be_bytes();
        self.bus.write(self.config.address, &[CONFIGURATION, high, low]).map_err(Ads1115Error::Bus)?;
        self.started = true;
        Ok(())
    }

    /// Takes the conversion that was started.
    ///
    /// # Errors
    /// When the bus fails, no conversion is done, or the chip has lost its configuration.
    pub fn collect(&mut self) -> Result<Reading<T>, Ads1115Error<B::Error>> {
        if !self.started {
            return Err(Ads1115Error::NotReady);
        }
        let word = self.register(CONFIGURATION)?;
        if (word ^ self.config.word()) & !START_OR_READY != 0 {
            self.started = false;
            return Err(Ads1115Error::Reset);
        }
        if word & START_OR_READY == 0 {
            return Err(Ads1115Error::NotReady);
        }
        let [high, low] = self.register(CONVERSION)?.to_be_bytes();
        self.started = false;
        Ok(self.span.reading_between(i32::from(i16::from_be_bytes([high, low])), ENDS))
    }

    /// Gives the bus back.
    pub fn release(self) -> B {
        self.bus
    }

    fn register(&mut self, number: u8) -> Result<u16, Ads1115Error<B::Error>> {
        let mut bytes = [0; 2];
        self.bus.write_read(self.config.address, &[number], &mut bytes).map_err(Ads1115Error::Bus)?;
        Ok(u16::from_be_bytes(bytes))
    }
}

impl<B: I2c, T: Number> Sense<T> for Ads1115<B, T> {
    type Error = Ads1115Error<B::Error>;

    fn sample(&mut self) -> Result<Reading<T>, Self::Error> {
        let reading = self.collect();
        // One that still runs goes on.
        if !self.started
            && let Err(error) = self.start()
            && reading.is_err()
        {
            return Err(error);
        }
        reading
    }
}
