//! The plants with their ADCs and the DAC, simulated: what stands here is on a real board the drivers of its own crate.
//!
//! Everything outside this folder is the same there, but for the calls of `pass_10_ms`, `off` and `recorded`.

mod devices;
mod plant;

pub(crate) use devices::{I2cBus, Power, Relay, SpiBus};

use core::cell::RefCell;
use core::sync::atomic::{AtomicBool, AtomicU16, Ordering};
use critical_section::Mutex;
use plant::Plant;

/// Counts of the ADC on SPI per degree of the plate: 12 bits for 0 to 102.4 degC.
pub(crate) const PLATE_COUNTS_PER_DEGREE: i32 = 40;
/// What the oven's transmitter gives \[V/degC\].
pub(crate) const OVEN_VOLTS_PER_DEGREE: f64 = 0.015;
/// Temperature of the room \[degC\].
pub(crate) const ROOM: f32 = 20.0;
/// Full duty of the PWM channel.
const FULL: u16 = 4000;

/// The register of the PWM channel and that of the relay's pin: they can be written from anywhere, at any time.
static DUTY: AtomicU16 = AtomicU16::new(0);
static RELAY: AtomicBool = AtomicBool::new(false);

/// What is there, and what happens to it.
struct World {
    /// Age \[10 ms\].
    now: u32,
    /// `1.2*exp(-0.2*s)/((1 + 0.2*s)*(1 + s))`, `demo/loop.toml`.
    plate: Plant<20>,
    /// `1.5*exp(-0.1*s)/((1 + 0.5*s)*(1 + 4*s))`, `demo/oven.toml`.
    oven: Plant<10>,
    /// Registers of the ADC on I2C: the configuration, the result.
    configuration: u16,
    conversion: i16,
    /// Age at which its conversion is done.
    done: u32,
    /// The code in the DAC, which is the recorder's input.
    recorded: u16,
    /// The I2C bus was held already.
    held: bool,
}

static WORLD: Mutex<RefCell<World>> = Mutex::new(RefCell::new(World {
    now: 0,
    plate: Plant::new(1.2, 0.05, 0.01),
    oven: Plant::new(1.5, 0.02, 0.0025),
    configuration: 0,
    conversion: 0,
    done: 0,
    recorded: 0,
    held: false,
}));

fn with<R>(act: impl FnOnce(&mut World) -> R) -> R {
    critical_section::with(|cs| act(&mut WORLD.borrow_ref_mut(cs)))
}

/// 10 ms pass, whatever the program does.
pub(crate) fn pass_10_ms() {
    with(World::pass_10_ms);
}

/// Turns everything off, whoever holds what: the last thing that happens after a fault.
pub(crate) fn off() {
    DUTY.store(0, Ordering::Relaxed);
    RELAY.store(false, Ordering::Relaxed);
}

/// The code that the recorder shows.
pub(crate) fn recorded() -> u16 {
    with(|world| world.recorded)
}

impl World {
    fn pass_10_ms(&mut self) {
        self.now += 1;
        let duty = f32::from(DUTY.load(Ordering::Relaxed)) / f32::from(FULL);
        self.plate.pass(100.0 * duty - self.draught());
        self.oven.pass(if RELAY.load(Ordering::Relaxed) { 100.0 } else { 0.0 });
    }

    /// From 3 s on a door is open \[% of the power that is lost\].
    fn draught(&self) -> f32 {
        if self.now >= 300 { 15.0 } else { 0.0 }
    }

    /// From 4 s to 4.7 s the plate's sensor is unplugged.
    fn unplugged(&self) -> bool {
        (400..470).contains(&self.now)
    }

    /// From 5.5 s on something holds the I2C bus, once.
    fn holds_the_bus(&mut self) -> bool {
        self.now >= 550 && !core::mem::replace(&mut self.held, true)
    }

    /// Half a count of noise, so that rounding does not hide everything.
    fn noise(&self) -> f32 {
        if self.now.wrapping_mul(0x9E37_79B9) >> 31 == 0 { 0.25 } else { -0.25 }
    }

    fn plate_code(&self) -> u16 {
        let counts = (ROOM + self.plate.output()) * PLATE_COUNTS_PER_DEGREE as f32 + 0.5 + self.noise();
        (counts as u16).min(4095)
    }

    /// At a full scale of 4.096 V.
    fn oven_code(&self) -> i16 {
        ((ROOM + self.oven.output()) * (8000.0 * OVEN_VOLTS_PER_DEGREE as f32) + 0.5 + self.noise()) as i16
    }
}
