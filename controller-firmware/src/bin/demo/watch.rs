//! The main loop, for what is not urgent: logs, the operator, another tuning.

use crate::heater_law::{self, Law};
use crate::run::periods;
use crate::telemetry::{EVENTS, Event, Loop, WATCHED, only};
use crate::{heater, oven, rig};
use controller_core::{ConfigErrors, ControllerConfig, Mode, PidConfig, Status, TraceSample};
use controller_firmware::{image, stack};
use core::cell::Cell;
use critical_section::Mutex;

/// From one line with numbers to the next \[periods\].
const LINES: u32 = 200;

type Deed = fn(&mut Watch);

/// What the operator does, and when \[periods\]. Whatever is late is done late, not left out.
const OPERATOR: [(u32, Deed); 8] = [
    (100, |_| set(&heater::SETPOINT, 60.0)),
    (100, |_| set(&oven::SETPOINT, 80.0)),
    // The link to the panel is broken for a moment.
    (250, |_| set(&heater::SETPOINT, f32::NAN)),
    (260, |_| set(&heater::SETPOINT, 60.0)),
    (605, Watch::prepare),
    (800, Watch::publish),
    (850, |_| set(&heater::SETPOINT, 50.0)),
    (1000, |_| end()),
];

/// What is known of the loops here.
#[derive(Default)]
struct Watch {
    heater: Seen,
    oven: Seen,
    /// Deeds of the operator that are done.
    done: usize,
    /// Parameters that wait for the operator.
    prepared: Option<Law>,
}

/// What was last logged of a loop.
#[derive(Default)]
struct Seen {
    mode: Option<Mode>,
    status: Status,
    /// In which of the stretches of [`LINES`] periods the last line with numbers was.
    line: Option<u32>,
}

/// Watches for ever.
pub(crate) fn run() -> ! {
    let mut watch = Watch::default();
    loop {
        while let Some((which, event)) = EVENTS.pop() {
            watch.report(which, &event);
        }
        while let Some((at, act)) = OPERATOR.get(watch.done)
            && periods() >= *at
        {
            watch.done += 1;
            act(&mut watch);
        }
        // Sleeps until the next interrupt.
        cortex_m::asm::wfi();
    }
}

impl Watch {
    fn report(&mut self, which: Loop, event: &Event) {
        match *event {
            Event::Adopted { k, generation } => {
                defmt::info!("{}: sample {=u32}: parameters {=u32} adopted", which, k, generation);
            }
            Event::Lost { k, periods } => {
                defmt::warn!("{}: sample {=u32}: {=u32} periods lost", which, k, periods);
            }
            Event::Refused { k, device } => {
                defmt::error!("{}: sample {=u32}: output refused by {}", which, k, device);
            }
            Event::Sample(sample) => match which {
                Loop::Heater => self.heater.report(which, &sample),
                Loop::Oven => self.oven.report(which, &sample),
            },
        }
    }

    /// Builds and checks another tuning here, where there is time; the loops run on.
    fn prepare(&mut self) {
        match slower() {
            Ok(law) => self.prepared = Some(law),
            Err(faults) => defmt::error!("parameters refused: {}", faults),
        }
    }

    fn publish(&mut self) {
        if let Some(law) = self.prepared.take() {
            let generation = heater::LAW.publish(law);
            defmt::info!("parameters {=u32}: half the gain", generation);
        }
    }
}

impl Seen {
    /// Logs changes of mode and status, and now and then the numbers.
    fn report(&mut self, which: Loop, sample: &TraceSample<f32>) {
        let TraceSample { k, r, y, u, d_hat, mode, status, .. } = *sample;
        if self.mode != Some(mode) {
            self.mode = Some(mode);
            defmt::info!("{}: sample {=u32}: mode {}", which, k, mode);
        }
        let (was, is) = (self.status, only(status, WATCHED));
        self.status = is;
        let came = Status::from_bits(is.bits() & !was.bits());
        let went = Status::from_bits(was.bits() & !is.bits());
        if came != Status::NONE {
            defmt::warn!("{}: sample {=u32}: {}", which, k, came);
        }
        if went != Status::NONE {
            defmt::info!("{}: sample {=u32}: no longer {}", which, k, went);
        }
        let line = Some(k / LINES);
        if self.line != line {
            self.line = line;
            // In tenths: whole numbers need no formatting of floats on the host's side to be compared.
            let tenths = |x: f32| (10.0 * x + if x < 0.0 { -0.5 } else { 0.5 }) as i32;
            let (r, y, u, d) = (tenths(r), tenths(y), tenths(u), tenths(d_hat));
            defmt::info!("{}: r {=i32} y {=i32} u {=i32} d {=i32} [0.1 degC, 0.1 %]", which, r, y, u, d);
        }
    }
}

/// The same loop with half the gain; not inlined, for its stack.
#[inline(never)]
fn slower() -> Result<Law, ConfigErrors> {
    let PidConfig { kp, ki, kd, .. } = heater_law::CONTROLLER.pid;
    let pid = PidConfig { kp: 0.5 * kp, ki: 0.5 * ki, kd: 0.5 * kd, ..heater_law::CONTROLLER.pid };
    heater_law::law_of(&ControllerConfig { pid, ..heater_law::CONTROLLER })
}

fn set(setpoint: &Mutex<Cell<f32>>, to: f32) {
    critical_section::with(|cs| setpoint.borrow(cs).set(to));
}

/// The end of the demo; a real loop has none.
fn end() {
    defmt::info!("the recorder shows {=u16} of 4095", rig::recorded());
    if stack::is_exhausted() {
        defmt::error!("the stack was too small");
    }
    defmt::info!("done; {=u32} records lost", EVENTS.dropped());
    image::exit(0)
}
