//! Sums over a loop, to find memory that has been damaged.

use super::law::Controller;
use super::state::ControllerState;
use crate::checksum::Checksum;
use crate::compensator::Compensate;
use crate::real::Real;
use crate::regulator::Regulator;
use crate::snapshot::Words;

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// A sum over every number of this law that a step uses: for memory that may be damaged while a program does not look.
    /// The law is the same until it is replaced, and so is its sum.
    ///
    /// ```
    /// use controller_core::{Controller, ControllerConfig, PidConfig};
    /// let law = |kp| {
    ///     let pid = PidConfig { kp, ..PidConfig::default() };
    ///     Controller::<f32>::new(&ControllerConfig { pid, ..ControllerConfig::default() }, 0.1).unwrap()
    /// };
    /// assert_eq!(law(2.0).checksum(), law(2.0).checksum());
    /// assert_ne!(law(2.0).checksum(), law(2.0000002).checksum());
    /// ```
    #[must_use]
    pub fn checksum(&self) -> Checksum {
        let mut sum = Checksum::new();
        self.law.coefficients_to(&mut sum);
        self.compensator.coefficients_to(&mut sum);
        self.limit.write(&mut sum);
        self.setpoint.write(&mut sum);
        self.anti_windup.write(&mut sum);
        self.guard.write(&mut sum);
        self.alarms.write(&mut sum);
        self.off_output.write(&mut sum);
        sum.number(self.deadband.width());
        sum.number(self.offset_lo);
        sum.number(self.offset_hi);
        sum.number(self.initial_output);
        sum.number(self.integral_bound);
        sum.number(self.ts);
        sum.word(u32::from(self.reversed.byte()));
        sum
    }

    /// A sum over every number of `state` that the next step uses, delay line included.
    /// Cost: linear in the length of the delay line.
    ///
    /// ```
    /// use controller_core::{Controller, ControllerConfig, ControllerInput};
    /// let law = Controller::<f32>::new(&ControllerConfig::default(), 0.1).unwrap();
    /// let mut state = law.zeroed();
    /// let before = Controller::<f32>::state_checksum(&state);
    /// law.step(&mut state, &ControllerInput { y: 1.0, ..ControllerInput::default() });
    /// assert_ne!(Controller::<f32>::state_checksum(&state), before);
    /// ```
    #[must_use]
    pub fn state_checksum(state: &ControllerState<T, C::State, L::State>) -> Checksum {
        let mut sum = Checksum::new();
        Self::write_state(state, &mut sum);
        sum
    }
}
