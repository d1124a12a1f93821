//! What is wired to the board, behind the traits of embedded-hal.

use super::{DUTY, FULL, RELAY, with};
use core::convert::Infallible;
use core::sync::atomic::Ordering;
use embedded_hal::{digital, i2c, pwm, spi};

/// The bus of the plate's ADC.
pub(crate) struct SpiBus;

/// The bus of the oven's ADC and of the recorder's DAC. Both drivers have a handle of their own, as `RefCellDevice` of
/// embedded-hal-bus gives them.
#[derive(Clone, Copy)]
pub(crate) struct I2cBus;

/// The PWM channel of the plate's heater.
pub(crate) struct Power;

/// The pin of the oven's relay.
pub(crate) struct Relay;

/// Nobody answers.
#[derive(Debug)]
pub(crate) struct Silent;

impl spi::Error for Silent {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl spi::ErrorType for SpiBus {
    type Error = Silent;
}

impl spi::SpiDevice for SpiBus {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Silent> {
        let code = with(|world| if world.unplugged() { Err(Silent) } else { Ok(world.plate_code()) })?;
        for operation in operations {
            if let spi::Operation::Read(bytes) = operation {
                for (byte, value) in bytes.iter_mut().zip((code << 1).to_be_bytes()) {
                    *byte = value;
                }
            }
        }
        Ok(())
    }
}

impl i2c::Error for Silent {
    fn kind(&self) -> i2c::ErrorKind {
        i2c::ErrorKind::NoAcknowledge(i2c::NoAcknowledgeSource::Address)
    }
}

impl i2c::ErrorType for I2cBus {
    type Error = Silent;
}

/// Addresses of the ADC and of the DAC; a register of the ADC.
const ADC: u8 = 0x48;
const DAC: u8 = 0x60;
const CONFIGURATION: u8 = 1;
/// No conversion is going on.
const READY: u16 = 1 << 15;

impl i2c::I2c for I2cBus {
    fn transaction(&mut self, address: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Silent> {
        if with(|world| world.holds_the_bus()) {
            // Until the third period from here begins.
            let now = || with(|world| world.now);
            let end = now() + 3;
            while now() < end {}
        }
        let mut register = 0;
        for operation in operations {
            match (address, operation) {
                (ADC, i2c::Operation::Write([number])) => register = *number,
                (ADC, i2c::Operation::Write([CONFIGURATION, high, low])) => with(|world| {
                    world.configuration = u16::from_be_bytes([*high, *low]) & !READY;
                    world.conversion = world.oven_code();
                    world.done = world.now + 1;
                }),
                (ADC, i2c::Operation::Read(bytes)) => {
                    let value = with(|world| match register {
                        CONFIGURATION if world.now >= world.done => world.configuration | READY,
                        CONFIGURATION => world.configuration,
                        _ => world.conversion.cast_unsigned(),
                    });
                    for (byte, value) in bytes.iter_mut().zip(value.to_be_bytes()) {
                        *byte = value;
                    }
                }
                (DAC, i2c::Operation::Write([high, low])) => {
                    with(|world| world.recorded = u16::from_be_bytes([*high, *low]));
                }
                _ => return Err(Silent),
            }
        }
        Ok(())
    }
}

impl pwm::ErrorType for Power {
    type Error = Infallible;
}

impl pwm::SetDutyCycle for Power {
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        DUTY.store(duty, Ordering::Relaxed);
        Ok(())
    }
}

impl digital::ErrorType for Relay {
    type Error = Infallible;
}

impl digital::OutputPin for Relay {
    fn set_low(&mut self) -> Result<(), Infallible> {
        RELAY.store(false, Ordering::Relaxed);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        RELAY.store(true, Ordering::Relaxed);
        Ok(())
    }
}
