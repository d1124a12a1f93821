//! The loop; any board whose drivers are of embedded-hal runs it.

use crate::loop_law::{self, Law, State};
use controller_core::{ConfigErrors, ControllerInput};
use controller_hal::{Actuate, CountSpan, Mcp3201, Monitored, OutputConfig, Pwm, SpanConfig};
use embedded_hal::{pwm::SetDutyCycle, spi::SpiDevice};

pub(crate) struct Control<S: SpiDevice, P> {
    law: Law,
    state: State,
    sensor: Monitored<Mcp3201<S, f32>, f32>,
    heater: Pwm<P, f32>,
}

impl<S: SpiDevice, P: SetDutyCycle> Control<S, P> {
    #[inline(never)] // or `main`, which does not end, would keep the 10 KB of stack that this takes
    pub(crate) fn new(spi: S, pwm: P) -> Result<Self, ConfigErrors> {
        let law = loop_law::law()?; // no fault: it was checked when it was exported
        let span = CountSpan::new(&SpanConfig::new((0, 4000), (0.0, 100.0)))?; // counts, degC
        let heater = Pwm::new(pwm, &OutputConfig::default())?; // 0 to 100 %
        Ok(Self { law, state: law.zeroed(), sensor: Monitored::new(Mcp3201::new(spi, span)), heater })
    }

    /// Once every `loop_law::TS`. The first good sample settles the loop where the plant is.
    pub(crate) fn sample(&mut self, setpoint: f32) {
        let u_applied = self.heater.applied();
        let asked = ControllerInput { r: setpoint, u_applied, ..ControllerInput::default() };
        let output = self.law.step(&mut self.state, &self.sensor.read().into_input(asked));
        // If it fails, `applied` says nothing in the next sample, and the loop goes by its own output.
        let _ = self.heater.apply(output.u);
    }
}
