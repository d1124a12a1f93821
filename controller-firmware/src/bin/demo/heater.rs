//! The fast loop: a plate with an ADC on SPI and a heater on a PWM channel, with a disturbance estimator.

use crate::heater_law::{self, Law, State};
use crate::rig::{PLATE_COUNTS_PER_DEGREE, Power, SpiBus};
use crate::telemetry::{Device, Event, Loop, Reporter};
use controller_core::{ConfigErrors, ControllerInput, ParamCell};
use controller_hal::{Actuate, CountSpan, Mcp3201, Monitored, OnInvalid, OutputConfig, Pwm, SpanConfig};
use core::cell::Cell;
use critical_section::Mutex;

/// Laws on their way to the loop.
pub(crate) static LAW: ParamCell<Law> = ParamCell::new();
/// The set-point \[degC\].
pub(crate) static SETPOINT: Mutex<Cell<f32>> = Mutex::new(Cell::new(20.0));

/// The exported law.
///
/// Building a law takes some kilobytes of stack. They are free again afterwards only if they are no part of a frame that
/// lasts, such as that of `main`: so this is never inlined.
#[inline(never)]
pub(crate) fn law() -> Result<Law, ConfigErrors> {
    heater_law::law()
}

/// Everything the loop owns.
pub(crate) struct Heater {
    law: Law,
    /// Generation of the law.
    seen: u32,
    state: State,
    sensor: Monitored<Mcp3201<SpiBus, f32>, f32>,
    power: Pwm<Power, f32>,
    reporter: Reporter,
}

impl Heater {
    /// The loop with its first law.
    pub(crate) fn new(law: &Law) -> Result<Self, ConfigErrors> {
        let span = SpanConfig::new((0, 100 * PLATE_COUNTS_PER_DEGREE), (0.0, 100.0));
        let range = OutputConfig { lo: 0.0, hi: 100.0, invalid: OnInvalid::Safe(0.0) };
        Ok(Self {
            law: *law,
            seen: 0,
            state: law.zeroed(),
            sensor: Monitored::new(Mcp3201::new(SpiBus, CountSpan::new(&span)?)),
            power: Pwm::new(Power, &range)?,
            reporter: Reporter::new(Loop::Heater, 10),
        })
    }

    /// Sample `k`, after `lost` periods without one: nothing here waits for anybody, fails or allocates.
    pub(crate) fn sample(&mut self, k: u32, lost: u32) {
        if let Some(law) = LAW.take_newer(&mut self.seen) {
            law.adopt(&self.law, &mut self.state);
            self.law = law;
            self.reporter.tell(Event::Adopted { k, generation: self.seen });
        }
        if lost > 0 {
            self.law.advance(&mut self.state, lost);
            self.reporter.tell(Event::Lost { k, periods: lost });
        }
        let input = self.sensor.read().into_input(ControllerInput {
            r: critical_section::with(|cs| SETPOINT.borrow(cs).get()),
            u_applied: self.power.applied(),
            ..ControllerInput::default()
        });
        let output = self.law.step(&mut self.state, &input);
        if self.power.apply(output.u).is_err() {
            self.reporter.tell(Event::Refused { k, device: Device::Heater });
        }
        self.reporter.sample(k, &input, &output);
    }
}
