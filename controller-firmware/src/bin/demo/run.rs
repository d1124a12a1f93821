//! Start-up and main loop: sets the timer, logs what the task reports, retunes it.

use crate::heater_law::{self, Law, TS};
use crate::rig::{self, Bus, COUNTS_PER_DEGREE, Power};
use crate::task::{LAW, SETPOINT, TRACE, Task};
use controller_core::{ConfigErrors, ControllerConfig, Mode, PidConfig, Status, TraceSample};
use controller_firmware::image;
use controller_hal::{CountSpan, Mcp3201, OnInvalid, OutputConfig, Pwm, SpanConfig};
use core::cell::{Cell, RefCell};
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use defmt_semihosting as _;

/// Clock of the system timer \[Hz\].
const CLOCK: u32 = controller_firmware::CLOCK;
/// Ticks from one sample to the next, from the sampling period that the law was designed for.
const TICKS: u32 = (TS * CLOCK as f64) as u32;
const _: () = assert!(TICKS >= 1 && TICKS < 1 << 24, "the system timer cannot count the sampling period");

/// Length of the demo \[samples\].
const SAMPLES: u32 = 1000;

static TASK: Mutex<RefCell<Option<Task>>> = Mutex::new(RefCell::new(None));
static MILLISECONDS: Mutex<Cell<u32>> = Mutex::new(Cell::new(0));

defmt::timestamp!("{=u32:tms}", critical_section::with(|cs| MILLISECONDS.borrow(cs).get()));

#[entry]
fn main() -> ! {
    image::on_fault(rig::off);
    match start() {
        Ok(()) => watch(),
        Err(faults) => {
            defmt::error!("the loop cannot be built: {}", faults);
            image::exit(1)
        }
    }
}

fn start() -> Result<(), ConfigErrors> {
    let law = heater_law::law()?;
    let span = SpanConfig::new((0, 100 * COUNTS_PER_DEGREE), (0.0, 100.0));
    let sensor = Mcp3201::new(Bus, CountSpan::new(&span)?);
    let range = OutputConfig { lo: 0.0, hi: 100.0, invalid: OnInvalid::Safe(0.0) };
    let task = Task::new(law, sensor, Pwm::new(Power, &range)?);
    critical_section::with(|cs| TASK.borrow_ref_mut(cs).replace(task));
    // The one peripheral of the board that the demo uses.
    if let Some(peripherals) = cortex_m::Peripherals::take() {
        let mut timer = peripherals.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(TICKS - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
    }
    defmt::info!("the loop runs every {=u32} ms", (1e3 * TS) as u32);
    Ok(())
}

#[exception]
fn SysTick() {
    // Moved here with the first interrupt: from then on nobody has to ask for it.
    static mut OWN: Option<Task> = None;
    if OWN.is_none() {
        *OWN = critical_section::with(|cs| TASK.borrow_ref_mut(cs).take());
    }
    if let Some(task) = OWN {
        task.sample();
    }
    critical_section::with(|cs| {
        let now = MILLISECONDS.borrow(cs);
        now.set(now.get() + (1e3 * TS) as u32);
    });
}

/// The main loop: what is not urgent.
fn watch() -> ! {
    let (mut mode, mut status) = (Mode::Hold, Status::NONE);
    loop {
        while let Some(sample) = TRACE.pop() {
            report(&sample, &mut mode, &mut status);
            scene(sample.k);
        }
        // Sleeps until the next interrupt.
        cortex_m::asm::wfi();
    }
}

/// Logs changes of mode and status, and a line every second.
fn report(sample: &TraceSample<f32>, mode: &mut Mode, status: &mut Status) {
    if sample.mode != *mode {
        defmt::info!("mode {} (was {})", sample.mode, *mode);
        *mode = sample.mode;
    }
    // Limits come and go with noise; faults are what somebody must see.
    let faults = |status: Status| status.bits() & (Status::BAD_INPUT | Status::FALLBACK).bits();
    if faults(sample.status) != faults(*status) {
        if faults(sample.status) == 0 {
            defmt::info!("sample {=u32}: the sensor is back", sample.k);
        } else {
            defmt::warn!("sample {=u32}: {}", sample.k, sample.status);
        }
        *status = sample.status;
    }
    if sample.k.is_multiple_of(100) {
        // In tenths: whole numbers need no formatting of floats on the host's side to be compared.
        let tenths = |x: f32| (10.0 * x + if x < 0.0 { -0.5 } else { 0.5 }) as i32;
        defmt::info!(
            "r {=i32} y {=i32} u {=i32} d {=i32} [0.1 degC, 0.1 %]",
            tenths(sample.r),
            tenths(sample.y),
            tenths(sample.u),
            tenths(sample.d_hat)
        );
    }
}

/// What happens to the loop, by the number of the sample.
fn scene(k: u32) {
    match k {
        100 => critical_section::with(|cs| SETPOINT.borrow(cs).set(60.0)),
        400 => rig::draught(15.0),
        550 => rig::unplug(true),
        620 => rig::unplug(false),
        750 => match slower() {
            Ok(law) => {
                let generation = LAW.publish(law);
                defmt::info!("parameters {=u32}: half the gain", generation);
            }
            Err(faults) => defmt::error!("parameters refused: {}", faults),
        },
        800 => critical_section::with(|cs| SETPOINT.borrow(cs).set(50.0)),
        SAMPLES => {
            defmt::info!("done; {=u32} records lost", TRACE.dropped());
            image::exit(0)
        }
        _ => {}
    }
}

/// Another tuning, built and checked where there is time: the same loop with half the gain.
fn slower() -> Result<Law, ConfigErrors> {
    let PidConfig { kp, ki, kd, .. } = heater_law::CONTROLLER.pid;
    let pid = PidConfig { kp: 0.5 * kp, ki: 0.5 * ki, kd: 0.5 * kd, ..heater_law::CONTROLLER.pid };
    heater_law::law_of(&ControllerConfig { pid, ..heater_law::CONTROLLER })
}
