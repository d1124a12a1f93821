//! The same loops in Rust: the core's double-precision step on the same plants, no C and no HAL.

use crate::record::Row;
use controller_core::{
    Compensate, ConfigErrors, Controller, ControllerConfig, ControllerInput, ControllerOutput,
    ControllerState, Mode, Quality,
};

/// The thread's period \[s\].
pub(crate) const TS: f64 = 0.001;

/// A loop with its parameters as they are set and as they are in force.
pub(crate) struct Reference<C: Compensate<f64>> {
    base: ControllerConfig,
    build: fn(&ControllerConfig) -> Result<Controller<f64, C>, ConfigErrors>,
    law: Option<Controller<f64, C>>,
    state: ControllerState<f64, C::State>,
    tried: [f64; 3],
    /// The first fault of what is set.
    pub(crate) fault: Option<controller_core::ConfigError>,
    pub(crate) adopted: u32,
}

/// What is set in a row beside the parameters that stay.
fn set(base: &ControllerConfig, [kp, ki, hi]: [f64; 3]) -> ControllerConfig {
    let mut config = *base;
    config.pid.kp = kp;
    config.pid.ki = ki;
    config.limits.hi = hi;
    config
}

impl<C: Compensate<f64>> Reference<C> {
    /// A loop that waits for its first parameters.
    pub(crate) fn new(
        base: ControllerConfig,
        build: fn(&ControllerConfig) -> Result<Controller<f64, C>, ConfigErrors>,
        state: C::State,
    ) -> Self {
        let state = ControllerState::over(state);
        Self { base, build, law: None, state, tried: [f64::NAN; 3], fault: None, adopted: 0 }
    }

    fn adopt(&mut self, row: &Row) {
        let wanted = [row.kp, row.ki, row.output_hi];
        let same = wanted.iter().zip(&self.tried).all(|(a, b)| a.to_bits() == b.to_bits());
        if same || (row.param_hold && self.law.is_some()) {
            return;
        }
        self.tried = wanted;
        match (self.build)(&set(&self.base, wanted)) {
            Ok(law) => {
                if let Some(old) = &self.law {
                    law.adopt(old, &mut self.state);
                }
                self.law = Some(law);
                self.adopted += 1;
                self.fault = None;
            }
            Err(faults) => self.fault = faults.as_slice().first().copied(),
        }
    }

    /// One sample.
    pub(crate) fn step(&mut self, row: &Row, y: f64, applied: Option<f64>) -> ControllerOutput<f64> {
        self.adopt(row);
        let mode = if !row.enable {
            Mode::Off
        } else if row.track {
            Mode::Track
        } else if row.manual {
            Mode::Manual
        } else if row.hold {
            Mode::Hold
        } else if row.cascade {
            Mode::Cascade
        } else {
            Mode::Auto
        };
        let input = ControllerInput {
            r: row.setpoint,
            r_remote: row.setpoint_remote,
            y,
            quality: match row.quality {
                0 => Quality::Good,
                1 => Quality::Uncertain,
                _ => Quality::Bad,
            },
            mode,
            manual: Some(row.value),
            track: row.value,
            offset: row.feed_forward,
            u_applied: applied,
            compensate: row.compensate,
            inhibit_up: row.inhibit_up,
            inhibit_down: row.inhibit_down,
            acknowledge: row.acknowledge,
        };
        self.law.as_ref().expect("the first parameters are good").step(&mut self.state, &input)
    }
}
