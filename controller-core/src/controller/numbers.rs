//! The numbers of a loop: what an export writes.

use super::law::Controller;
use crate::compensator::Compensate;
use crate::real::Real;
use crate::regulator::Regulator;

/// Every number that a [`Controller`] uses beside those of its law and its compensator, as the step uses them: steps per
/// sample in place of rates. What the numbers do is said by their blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerNumbers<T> {
    /// Sampling period \[s\].
    pub ts: T,
    /// Range of the measurement \[y\].
    pub measurement: (T, T),
    /// Bad samples in a row that are held.
    pub hold_samples: u16,
    /// A fallback ends with an acknowledgement only.
    pub acknowledged: bool,
    /// Where a fallback takes the output \[u\]; `None`: it stays.
    pub fallback_output: Option<T>,
    /// Longest step on the way there \[u\].
    pub fallback_step: T,
    /// Range of the set-point \[y\].
    pub setpoint: (T, T),
    /// Longest steps of the set-point, down and up \[y\].
    pub setpoint_steps: (T, T),
    /// The set-point has a rate.
    pub setpoint_ramps: bool,
    /// The working set-point follows the measurement in Off, Manual and Track.
    pub setpoint_tracks: bool,
    /// Half width of the error deadband \[y\].
    pub deadband: T,
    /// Range of the offset \[u\].
    pub offset: (T, T),
    /// Range of the output \[u\].
    pub output: (T, T),
    /// Longest steps of the output, down and up \[u\].
    pub output_steps: (T, T),
    /// Output in mode Off \[u\]; `None`: it stays.
    pub off_output: Option<T>,
    /// Output of a zeroed state \[u\].
    pub initial_output: T,
    /// Share of `a - v` that the anti-windup adds to the integral term.
    pub anti_windup_gain: T,
    /// The anti-windup takes the last increment back.
    pub conditional: bool,
    /// Largest size of the integral term \[u\].
    pub integral_bound: T,
    /// Levels hi hi, hi, lo, lo lo, deviation, and the hysteresis \[y\]; `None` without any alarm.
    pub alarms: Option<([T; 5], T)>,
    /// The output falls when the set-point rises.
    pub reversed: bool,
}

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// The numbers that the step uses, those of the law and of the compensator left out.
    ///
    /// ```
    /// use controller_core::{Controller, ControllerConfig, LimitConfig};
    /// let limits = LimitConfig { rate_up: Some(5.0), ..LimitConfig::range(0.0, 100.0) };
    /// let law = Controller::<f64>::new(&ControllerConfig { limits, ..ControllerConfig::default() }, 0.5).unwrap();
    /// let numbers = law.numbers();
    /// assert_eq!((numbers.output, numbers.output_steps.1), ((0.0, 100.0), 2.5));
    /// ```
    #[must_use]
    pub fn numbers(&self) -> ControllerNumbers<T> {
        let (fallback_output, fallback_step) = self.guard.fallback_output();
        ControllerNumbers {
            ts: self.ts,
            measurement: self.guard.range(),
            hold_samples: self.guard.hold_samples(),
            acknowledged: self.guard.is_acknowledged(),
            fallback_output,
            fallback_step,
            setpoint: self.setpoint.range(),
            setpoint_steps: self.setpoint.steps(),
            setpoint_ramps: self.setpoint.ramps(),
            setpoint_tracks: self.setpoint.tracks(),
            deadband: self.deadband.width(),
            offset: (self.offset_lo, self.offset_hi),
            output: self.output_range(),
            output_steps: self.limit.steps(),
            off_output: self.off_output.get(),
            initial_output: self.initial_output,
            anti_windup_gain: self.anti_windup.gain(),
            conditional: self.anti_windup.is_conditional(),
            integral_bound: self.integral_bound,
            alarms: self.alarms.levels(),
            reversed: self.reversed.is_set(),
        }
    }
}
