//! The input of an undisturbed sample.

use super::built::{Block, Built};
use controller_core::{ControllerInput, Real};

impl<T: Real, C: Block<T>> Built<T, C> {
    /// An input that nothing is wrong with: everything in the middle of its range, acknowledged.
    pub(crate) fn good(&self) -> ControllerInput<T> {
        let middle = |lo: f64, hi: f64| T::from_f64(0.5 * lo + 0.5 * hi);
        let (y_lo, y_hi) = self.measurement();
        let config = &self.case.config;
        ControllerInput {
            y: middle(config.measurement_lo, config.measurement_hi).clamp_to(y_lo, y_hi),
            r: middle(config.setpoint.lo, config.setpoint.hi),
            acknowledge: true,
            ..ControllerInput::default()
        }
    }
}
