//! The slow loop: an oven with an ADC on I2C and a heater behind a relay, and a DAC for a recorder on the same bus.

use crate::heater_law;
use crate::oven_law::{self, Law, State, TS};
use crate::rig::{I2cBus, OVEN_VOLTS_PER_DEGREE, Relay};
use crate::telemetry::{Device, Event, Loop, Reporter};
use controller_core::{ConfigErrors, ControllerInput};
use controller_hal::{
    Actuate, Ads1115, Ads1115Config, CountSpan, Gain, Mcp4725, Monitored, OnInvalid, OutputConfig, Rate,
    SpanConfig, TimeProportioned, TimeProportionedConfig,
};
use core::cell::{Cell, RefCell};
use critical_section::Mutex;

/// The set-point \[degC\].
pub(crate) static SETPOINT: Mutex<Cell<f32>> = Mutex::new(Cell::new(20.0));

/// The relay has two masters: the timer interrupt, which ticks it, and the loop, which says how much.
static RELAY: Mutex<RefCell<Option<TimeProportioned<Relay, f32>>>> = Mutex::new(RefCell::new(None));

/// From one tick of the relay to the next \[s\]: the period of the timer, which is that of the fast loop.
const TICK: f64 = heater_law::TS;
/// The relay's window \[ticks\]. Half of it is part of the loop's `latency`, a period of the ADC is the rest.
const WINDOW: u16 = 20;
const _: () = assert!(
    oven_law::LATENCY >= TS + 0.5 * TICK * WINDOW as f64 - 1e-9,
    "the loop was designed for less latency than ADC and relay have"
);

/// The exported law; not inlined, for its stack.
#[inline(never)]
pub(crate) fn law() -> Result<Law, ConfigErrors> {
    oven_law::law()
}

/// Everything the loop owns, but the relay.
pub(crate) struct Oven {
    law: Law,
    state: State,
    sensor: Monitored<Ads1115<I2cBus, f32>, f32>,
    recorder: Mcp4725<I2cBus, f32>,
    reporter: Reporter,
}

impl Oven {
    /// The loop with its law.
    pub(crate) fn new(law: &Law) -> Result<Self, ConfigErrors> {
        let config = Ads1115Config { gain: Gain::V4_096, rate: Rate::R128, ..Ads1115Config::default() };
        let counts = (0, config.gain.counts(200.0 * OVEN_VOLTS_PER_DEGREE));
        let span = CountSpan::new(&SpanConfig::new(counts, (0.0, 200.0)))?;
        let recorded = OutputConfig { lo: 0.0, hi: 200.0, invalid: OnInvalid::Keep };
        let relay = TimeProportionedConfig {
            output: OutputConfig { lo: 0.0, hi: 100.0, invalid: OnInvalid::Safe(0.0) },
            window: WINDOW,
            minimum_on: 2,
            minimum_off: 2,
        };
        let relay = TimeProportioned::new(Relay, &relay)?;
        critical_section::with(|cs| RELAY.borrow_ref_mut(cs).replace(relay));
        let mut adc = Ads1115::new(I2cBus, config, span);
        // Every sample takes the conversion that the one before started. If nobody answers here, the first sample is bad.
        let _ = adc.start();
        Ok(Self {
            law: *law,
            state: law.zeroed(),
            sensor: Monitored::new(adc),
            recorder: Mcp4725::new(I2cBus, Mcp4725::<(), f32>::ADDRESS, &recorded)?,
            reporter: Reporter::new(Loop::Oven, 10),
        })
    }

    /// Sample `k`, after `lost` periods without one.
    pub(crate) fn sample(&mut self, k: u32, lost: u32) {
        if lost > 0 {
            self.law.advance(&mut self.state, lost);
            self.reporter.tell(Event::Lost { k, periods: lost });
        }
        let input = self.sensor.read().into_input(ControllerInput {
            r: critical_section::with(|cs| SETPOINT.borrow(cs).get()),
            u_applied: with_relay(|relay| relay.applied()).flatten(),
            ..ControllerInput::default()
        });
        let output = self.law.step(&mut self.state, &input);
        if !with_relay(|relay| relay.apply(output.u).is_ok()).unwrap_or(false) {
            self.reporter.tell(Event::Refused { k, device: Device::Relay });
        }
        if self.recorder.apply(input.y).is_err() {
            self.reporter.tell(Event::Refused { k, device: Device::Recorder });
        }
        self.reporter.sample(k, &input, &output);
    }
}

/// Moves the relay; every [`TICK`], from the timer interrupt.
pub(crate) fn tick() {
    // A pin that fails is set again with the next tick; `applied` then says nothing.
    let _ = with_relay(TimeProportioned::tick);
}

/// Nothing if there is no relay yet, or somebody has it: in a critical section nobody can, and an interrupt must not panic.
fn with_relay<R>(act: impl FnOnce(&mut TimeProportioned<Relay, f32>) -> R) -> Option<R> {
    critical_section::with(|cs| RELAY.borrow(cs).try_borrow_mut().ok()?.as_mut().map(act))
}
