//! A law and its state in one object, for those who want one.

use crate::adrc::{Adrc, AdrcInput, AdrcOutput, AdrcState};
use crate::compensator::Compensate;
use crate::controller::{Controller, ControllerInput, ControllerOutput, ControllerState};
use crate::pid::{Pid, PidInput, PidOutput, PidState};
use crate::real::Real;
use crate::regulator::Regulator;

/// A discretised law: immutable coefficients that move a state.
pub trait Law {
    /// What the law moves.
    type State;
    /// What it reads in one sample.
    type Input;
    /// What it gives in one sample.
    type Output;

    /// One sample.
    fn run(&self, state: &mut Self::State, input: &Self::Input) -> Self::Output;

    /// Takes `state` over from `old` without a bump.
    fn take_over(&self, old: &Self, state: &mut Self::State);
}

/// A law together with its state.
///
/// ```
/// use controller_core::{Instance, Pid, PidConfig, PidInput, PidState};
/// let law = Pid::<f64>::new(&PidConfig { kp: 2.0, ki: 1.0, ..PidConfig::default() }, 0.1).unwrap();
/// let mut pid = Instance::new(law, PidState::default());
/// assert_eq!(pid.step(&PidInput { r: 1.0, y: 0.0 }).u(), 2.1);
/// let softer = Pid::<f64>::new(&PidConfig { kp: 1.0, ki: 1.0, ..PidConfig::default() }, 0.1).unwrap();
/// pid.adopt(softer);
/// // No bump: only the integral moves on.
/// assert!((pid.step(&PidInput { r: 1.0, y: 0.0 }).u() - 2.2).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instance<L, S> {
    law: L,
    state: S,
}

impl<S, L: Law<State = S>> Instance<L, S> {
    /// Puts the two together.
    pub const fn new(law: L, state: S) -> Self {
        Self { law, state }
    }

    /// One sample.
    pub fn step(&mut self, input: &L::Input) -> L::Output {
        self.law.run(&mut self.state, input)
    }

    /// Replaces the law whole, without a bump.
    pub fn adopt(&mut self, law: L) {
        law.take_over(&self.law, &mut self.state);
        self.law = law;
    }

    /// The law.
    pub const fn law(&self) -> &L {
        &self.law
    }

    /// The state.
    pub const fn state(&self) -> &S {
        &self.state
    }

    /// The state, to settle or restore it.
    pub const fn state_mut(&mut self) -> &mut S {
        &mut self.state
    }
}

impl<T: Real> Law for Pid<T> {
    type State = PidState<T>;
    type Input = PidInput<T>;
    type Output = PidOutput<T>;
    fn run(&self, state: &mut PidState<T>, input: &PidInput<T>) -> PidOutput<T> {
        self.step(state, *input)
    }
    fn take_over(&self, old: &Self, state: &mut PidState<T>) {
        self.adopt(old, state);
    }
}

impl<T: Real> Law for Adrc<T> {
    type State = AdrcState<T>;
    type Input = AdrcInput<T>;
    type Output = AdrcOutput<T>;
    fn run(&self, state: &mut AdrcState<T>, input: &AdrcInput<T>) -> AdrcOutput<T> {
        self.step(state, *input)
    }
    fn take_over(&self, old: &Self, state: &mut AdrcState<T>) {
        self.adopt(old, state);
    }
}

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Law for Controller<T, C, L> {
    type State = ControllerState<T, C::State, L::State>;
    type Input = ControllerInput<T>;
    type Output = ControllerOutput<T>;
    fn run(&self, state: &mut Self::State, input: &Self::Input) -> ControllerOutput<T> {
        self.step(state, input)
    }
    fn take_over(&self, old: &Self, state: &mut Self::State) {
        self.adopt(old, state);
    }
}
