//! A board with a heater, simulated, where a project of its own has its board's crate.
//!
//! In the middle of its samples it fails in the way that its first word names, if there is one: `panic`, `fault` or
//! `interrupt`.

#[path = "../demo/rig/plant.rs"]
mod plant;
#[path = "../../stack.rs"]
#[allow(dead_code, unreachable_pub, reason = "what it offers is not all used here")]
mod stack;

use core::cell::{Cell, RefCell};
use core::convert::Infallible;
use core::sync::atomic::{AtomicU16, Ordering};
use embedded_hal::pwm::{self, SetDutyCycle};
use embedded_hal::spi::{self, Operation, SpiDevice};
use plant::Plant;
use semihosting::{println, process::exit};

/// Clock of the system timer \[Hz\].
pub(crate) const CLOCK: u32 = match u32::from_str_radix(env!("CONTROLLER_CLOCK"), 10) {
    Ok(hertz) => hertz,
    Err(_) => panic!("the build script gives a whole number"),
};

// By this the runner knows which board to emulate. Not loaded; the linker keeps such a section.
core::arch::global_asm!(
    ".pushsection .controller.board, \"\", %progbits",
    concat!(".ascii \"", env!("CONTROLLER_BOARD"), "\""),
    ".popsection"
);

/// Samples until the image ends by itself.
const SAMPLES: u32 = 800;
/// The sample in which it fails, if it has to: the heater is on.
const FAILS_AT: u32 = 400;
/// Exit code after a failure.
const FAILED: i32 = 101;
/// Full duty.
const FULL: u16 = 1000;

/// The register of the PWM channel: it can be written from anywhere, at any time.
static DUTY: AtomicU16 = AtomicU16::new(0);

/// Turns the heater off, whoever has its driver. The emulated board ends with it.
pub(crate) fn heater_off() {
    let was = DUTY.load(Ordering::Relaxed);
    DUTY.store(0, Ordering::Relaxed);
    println!("the duty was {was} and is {}", DUTY.load(Ordering::Relaxed));
    exit(FAILED)
}

/// Does nothing, or fails.
type Failure = fn();

pub(crate) struct Heater {
    fail: Failure,
    samples: Cell<u32>,
    /// That of `demo/loop.toml`.
    plate: RefCell<Plant<20>>,
}

impl Heater {
    pub(crate) fn new() -> Self {
        Self { fail: failure(), samples: Cell::new(0), plate: RefCell::new(Plant::new(1.2, 0.05, 0.01)) }
    }
}

/// The way to fail that the image's first word names.
fn failure() -> Failure {
    let words = semihosting::experimental::env::args::<64>();
    match words.as_ref().ok().and_then(|mut words| words.nth(1)).and_then(Result::ok) {
        Some("panic") => || panic!("on purpose"),
        Some("fault") => || cortex_m::asm::udf(),
        Some("interrupt") => || {
            // Nobody handles it.
            cortex_m::peripheral::SCB::set_pendsv();
            cortex_m::asm::isb();
        },
        _ => || (),
    }
}

/// The ADC on SPI; each reading lets 10 ms pass.
pub(crate) struct Adc<'a>(pub(crate) &'a Heater);

impl spi::ErrorType for Adc<'_> {
    type Error = Infallible;
}

impl SpiDevice for Adc<'_> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let Self(heater) = self;
        let mut plate = heater.plate.borrow_mut();
        plate.pass(100.0 * f32::from(DUTY.load(Ordering::Relaxed)) / f32::from(FULL));
        let degrees = 20.0 + plate.output();
        heater.samples.set(heater.samples.get() + 1);
        if heater.samples.get() == FAILS_AT {
            (heater.fail)();
        }
        if heater.samples.get() >= SAMPLES {
            println!("after {SAMPLES} samples: {} tenths of a degree", (10.0 * degrees + 0.5) as i32);
            println!("{} of {} bytes of stack", stack::high_water(), stack::size());
            exit(i32::from(stack::is_exhausted()));
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

/// The PWM channel.
pub(crate) struct Channel;

impl pwm::ErrorType for Channel {
    type Error = Infallible;
}

impl SetDutyCycle for Channel {
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        DUTY.store(duty, Ordering::Relaxed);
        Ok(())
    }
}
