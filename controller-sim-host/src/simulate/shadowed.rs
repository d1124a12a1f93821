//! A law here and, when asked for, the same one on a board.

use super::law::AnyLaw;
use crate::pil::{Compared, LinkError, Shadow, Target, Timing};
use crate::scenario::ControllerSpec;
use controller_core::{ConfigErrors, ControllerInput, ControllerOutput, Mode, Real};

/// An [`AnyLaw`] whose every call also goes to its shadow, if it has one.
#[derive(Debug)]
pub(super) struct Shadowed<T: Real> {
    law: AnyLaw<T>,
    shadow: Option<Box<Shadow>>,
}

/// Why there is no law.
#[derive(Debug)]
pub(super) enum NotBuilt {
    /// Its configuration is refused.
    Refused(Box<ConfigErrors>),
    /// The board cannot be asked.
    Board(LinkError),
}

impl From<ConfigErrors> for NotBuilt {
    fn from(faults: ConfigErrors) -> Self {
        Self::Refused(Box::new(faults))
    }
}

impl<T: Real> Shadowed<T> {
    pub(super) fn new(
        spec: &ControllerSpec,
        ts: f64,
        latency: f64,
        capacity: usize,
        pil: Option<&Target>,
    ) -> Result<Self, NotBuilt> {
        let law = AnyLaw::new(spec, ts, latency, capacity)?;
        let start = |target| Shadow::start::<T>(target, spec, Timing { ts, latency, capacity }).map(Box::new);
        Ok(Self { law, shadow: pil.map(start).transpose().map_err(NotBuilt::Board)? })
    }

    pub(super) fn settle(&mut self, mode: Mode, r0: f64, y0: f64, u0: f64) {
        self.law.settle(mode, r0, y0, u0);
        let Some(shadow) = &mut self.shadow else { return };
        let [r0, y0, u0] = [r0, y0, u0].map(T::from_f64);
        shadow.settle(r0, y0, u0);
        if let Some(input) = AnyLaw::sample_at_rest(mode, r0, y0) {
            shadow.rest(&input);
        }
    }

    #[inline]
    pub(super) fn step(&mut self, input: &ControllerInput<T>) -> ControllerOutput<T> {
        let mut output = ControllerOutput::default();
        self.step_into(input, &mut output);
        output
    }

    /// One sample, written where the last one was.
    #[inline]
    pub(super) fn step_into(&mut self, input: &ControllerInput<T>, output: &mut ControllerOutput<T>) {
        self.law.step_into(input, output);
        if let Some(shadow) = &mut self.shadow {
            shadow.step(input, output);
        }
    }

    pub(super) fn advance(&mut self, n: u32) {
        self.law.advance(n);
        if let Some(shadow) = &mut self.shadow {
            shadow.advance(n);
        }
    }

    pub(super) fn adopt(&mut self, spec: &ControllerSpec) -> Result<(), ConfigErrors> {
        self.law.adopt(spec)?;
        if let Some(shadow) = &mut self.shadow {
            shadow.adopt::<T>(spec);
        }
        Ok(())
    }

    /// Why the board cannot be asked any more.
    #[inline]
    pub(super) fn failure(&self) -> Option<&LinkError> {
        self.shadow.as_ref().and_then(|shadow| shadow.failure())
    }

    /// How both compare; `None` without a board.
    pub(super) fn finish(self) -> Result<Option<Compared>, LinkError> {
        let state = if self.shadow.is_some() { self.law.save() } else { Default::default() };
        self.shadow.map(|shadow| shadow.finish(&state)).transpose()
    }
}
