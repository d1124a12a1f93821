//! The heater and its converters, simulated behind the traits of embedded-hal.
//!
//! Everything above this file is the same on a real board, where the drivers of its own crate stand here.

use core::cell::RefCell;
use core::convert::Infallible;
use core::sync::atomic::{AtomicU16, Ordering};
use critical_section::Mutex;
use embedded_hal::pwm::SetDutyCycle;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};

/// Counts of the converter per degree: 12 bits for 0 to 102.4 degC.
pub(crate) const COUNTS_PER_DEGREE: i32 = 40;
/// Temperature of the room \[degC\].
pub(crate) const ROOM: f32 = 20.0;
/// Full duty.
const FULL: u16 = 4000;
/// Dead time \[samples of 10 ms\].
const DELAY: usize = 20;

/// `1.2*exp(-0.2*s)/((1 + 0.2*s)*(1 + s))` from percent to degrees above the room, stepped by 10 ms.
struct Heater {
    line: [f32; DELAY],
    next: usize,
    element: f32,
    plate: f32,
    /// Somebody opens the door: percent of the power that is lost.
    draught: f32,
    unplugged: bool,
    count: u32,
}

/// The register of the modulator: it can be written from anywhere, at any time.
static DUTY: AtomicU16 = AtomicU16::new(0);

static HEATER: Mutex<RefCell<Heater>> = Mutex::new(RefCell::new(Heater {
    line: [0.0; DELAY],
    next: 0,
    element: 0.0,
    plate: 0.0,
    draught: 0.0,
    unplugged: false,
    count: 0,
}));

fn with<R>(act: impl FnOnce(&mut Heater) -> R) -> R {
    critical_section::with(|cs| act(&mut HEATER.borrow_ref_mut(cs)))
}

/// Opens and closes the door.
pub(crate) fn draught(percent: f32) {
    with(|heater| heater.draught = percent);
}

/// Pulls the plug of the sensor, or puts it back.
pub(crate) fn unplug(unplugged: bool) {
    with(|heater| heater.unplugged = unplugged);
}

/// Turns the heater off, whatever else goes on: the last thing that happens after a fault.
pub(crate) fn off() {
    DUTY.store(0, Ordering::Relaxed);
}

impl Heater {
    fn pass_10_ms(&mut self) {
        let power = 100.0 * f32::from(DUTY.load(Ordering::Relaxed)) / f32::from(FULL) - self.draught;
        let late = core::mem::replace(&mut self.line[self.next], power);
        self.next = (self.next + 1) % DELAY;
        self.element += 0.05 * (1.2 * late - self.element);
        self.plate += 0.01 * (self.element - self.plate);
        self.count += 1;
    }

    /// What the converter shows: half a count of noise, so that rounding does not hide everything.
    fn code(&self) -> u16 {
        let noise = if self.count.wrapping_mul(0x9E37_79B9) >> 31 == 0 { 0.25 } else { -0.25 };
        let counts = (ROOM + self.plate) * COUNTS_PER_DEGREE as f32 + 0.5 + noise;
        (counts as u16).min(4095)
    }
}

/// The bus of the converter.
pub(crate) struct Bus;

/// The line stays high: nobody answers.
#[derive(Debug)]
pub(crate) struct Silent;

impl embedded_hal::spi::Error for Silent {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl ErrorType for Bus {
    type Error = Silent;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Silent> {
        let code = with(|heater| {
            heater.pass_10_ms();
            if heater.unplugged { Err(Silent) } else { Ok(heater.code()) }
        })?;
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

/// The pulse-width modulator of the heater.
pub(crate) struct Power;

impl embedded_hal::pwm::ErrorType for Power {
    type Error = Infallible;
}

impl SetDutyCycle for Power {
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        DUTY.store(duty, Ordering::Relaxed);
        Ok(())
    }
}
