//! The control task: once a period, from an interrupt.

use crate::heater_law::{Law, State};
use crate::rig::{Bus, Power};
use controller_core::{ControllerInput, ParamCell, Trace, TraceSample};
use controller_hal::{Actuate, Mcp3201, Monitored, Pwm};
use core::cell::Cell;
use critical_section::Mutex;

/// Laws on their way to the task.
pub(crate) static LAW: ParamCell<Law> = ParamCell::new();
/// What the task did, on its way to the main context.
pub(crate) static TRACE: Trace<TraceSample<f32>, 128> = Trace::new();
/// The set-point \[degC\].
pub(crate) static SETPOINT: Mutex<Cell<f32>> = Mutex::new(Cell::new(20.0));

/// Everything the interrupt owns.
pub(crate) struct Task {
    law: Law,
    seen: u32,
    state: State,
    sensor: Monitored<Mcp3201<Bus, f32>, f32>,
    heater: Pwm<Power, f32>,
    k: u32,
}

impl Task {
    /// A task that begins with `law`.
    pub(crate) fn new(law: Law, sensor: Mcp3201<Bus, f32>, heater: Pwm<Power, f32>) -> Self {
        Self { law, seen: 0, state: law.zeroed(), sensor: Monitored::new(sensor), heater, k: 0 }
    }

    /// One sample: nothing here waits, fails or allocates.
    pub(crate) fn sample(&mut self) {
        if let Some(law) = LAW.take_newer(&mut self.seen) {
            law.adopt(&self.law, &mut self.state);
            self.law = law;
        }
        let input = self.sensor.read().into_input(ControllerInput {
            r: critical_section::with(|cs| SETPOINT.borrow(cs).get()),
            u_applied: self.heater.applied(),
            ..ControllerInput::default()
        });
        let output = self.law.step(&mut self.state, &input);
        if self.heater.apply(output.u).is_err() {
            defmt::error!("sample {=u32}: the heater does not take its duty", self.k);
        }
        TRACE.push(TraceSample::new(self.k, &input, &output));
        self.k = self.k.wrapping_add(1);
    }
}
