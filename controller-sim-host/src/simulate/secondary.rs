//! The loop inside of a cascade.

use super::closed_loop::ClosedLoop;
use super::shadowed::{NotBuilt, Shadowed};
use crate::pil::Target;
use crate::scenario::{ControllerSpec, Signal};
use controller_core::{ControllerInput, ControllerOutput, Mode, Real, Status};
use controller_design::model::TransferFunction;

/// A secondary controller on the part of the plant that the actuator drives first. The whole plant is simulated beside
/// it, with the same input: by linearity the outer part then sees exactly what this part gives.
#[derive(Debug)]
pub(super) struct Secondary<T: Real> {
    pub(super) law: Shadowed<T>,
    input: ControllerInput<T>,
    pub(super) output: ControllerOutput<T>,
    pub(super) plant: ClosedLoop,
    /// Its measurement at the start \[y\].
    pub(super) y0: f64,
}

/// The sampling of a loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Timing {
    pub(super) ts: f64,
    pub(super) latency: f64,
    pub(super) substeps: usize,
    /// Where it runs besides here.
    pub(super) pil: Option<&'static Target>,
}

impl<T: Real> Secondary<T> {
    /// At rest under the disturbance `d0` and the output `u0`; `None` when the part cannot rest there.
    pub(super) fn new(
        spec: &ControllerSpec,
        part: &TransferFunction,
        timing: Timing,
        (d0, u0): (f64, f64),
        disturbances: &[(f64, Signal)],
    ) -> Result<Option<Self>, NotBuilt> {
        let Timing { ts, latency, substeps, pil } = timing;
        let y0 = if part.integrators() > 0 { 0.0 } else { part.gain() * (u0 + d0) };
        let Some((plant, _)) = ClosedLoop::new(part, ts, latency, substeps, (y0, d0), disturbances) else {
            return Ok(None);
        };
        let mut law = Shadowed::<T>::new(spec, ts, latency, spec.needed_capacity(ts, latency), pil)?;
        law.settle(Mode::Cascade, y0, y0, u0);
        let r = T::from_f64(y0);
        let input = ControllerInput { r, r_remote: r, mode: Mode::Cascade, ..ControllerInput::default() };
        let output =
            ControllerOutput { r, u: T::from_f64(u0), mode: Mode::Cascade, ..ControllerOutput::default() };
        Ok(Some(Self { law, input, output, plant, y0 }))
    }

    /// One sample with the primary's output `r` as the set-point; gives the measurement.
    pub(super) fn step(&mut self, r: T) -> f64 {
        let y = self.plant.measure();
        self.input.r_remote = r;
        self.input.y = T::from_f64(y);
        self.output = self.law.step(&self.input);
        y
    }

    /// The task did not run.
    pub(super) fn lose(&mut self) {
        self.law.advance(1);
        self.output.status |= Status::OVERRUN;
    }

    /// Tells the secondary controller what the actuator did.
    pub(super) fn read_back(&mut self, applied: f64) {
        self.input.u_applied = Some(T::from_f64(applied));
    }

    /// What the primary controller reads back: the set-point in use, and where it cannot be moved.
    pub(super) fn report(&self, primary: &mut ControllerInput<T>) {
        primary.u_applied = Some(self.output.r);
        primary.inhibit_up = self.output.blocked_up;
        primary.inhibit_down = self.output.blocked_down;
    }
}
