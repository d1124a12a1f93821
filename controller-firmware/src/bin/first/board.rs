//! A board with a heater, simulated, where a project of its own has its board's crate.

#[path = "../demo/rig/plant.rs"]
mod plant;

use controller_firmware::image::{exit, println};
use core::cell::{Cell, RefCell};
use core::convert::Infallible;
use embedded_hal::pwm::{self, SetDutyCycle};
use embedded_hal::spi::{self, Operation, SpiDevice};
use plant::Plant;

pub(crate) use controller_firmware::CLOCK;

/// Samples until the image ends by itself.
const SAMPLES: u32 = 800;
/// Full duty.
const FULL: u16 = 1000;

pub(crate) struct Heater {
    duty: Cell<u16>,
    samples: Cell<u32>,
    /// That of `demo/loop.toml`.
    plate: RefCell<Plant<20>>,
}

impl Heater {
    pub(crate) const fn new() -> Self {
        Self { duty: Cell::new(0), samples: Cell::new(0), plate: RefCell::new(Plant::new(1.2, 0.05, 0.01)) }
    }
}

/// The converter on SPI; each reading lets 10 ms pass.
pub(crate) struct Converter<'a>(pub(crate) &'a Heater);

impl spi::ErrorType for Converter<'_> {
    type Error = Infallible;
}

impl SpiDevice for Converter<'_> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let Self(heater) = self;
        let mut plate = heater.plate.borrow_mut();
        plate.pass(100.0 * f32::from(heater.duty.get()) / f32::from(FULL));
        let degrees = 20.0 + plate.output();
        heater.samples.set(heater.samples.get() + 1);
        if heater.samples.get() >= SAMPLES {
            println!("after {SAMPLES} samples: {} tenths of a degree", (10.0 * degrees + 0.5) as i32);
            exit(0);
        }
        let code = (40.0 * degrees + 0.5) as u16;
        for operation in operations {
            if let Operation::Read(bytes) = operation {
                for (byte, value) in bytes.iter_mut().zip((code << 1).to_be_bytes()) {
                    *byte = value;
                }
            }
        }
        Ok(())
    }
}

/// The channel of the pulse-width modulator.
pub(crate) struct Channel<'a>(pub(crate) &'a Heater);

impl pwm::ErrorType for Channel<'_> {
    type Error = Infallible;
}

impl SetDutyCycle for Channel<'_> {
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.duty.set(duty);
        Ok(())
    }
}
