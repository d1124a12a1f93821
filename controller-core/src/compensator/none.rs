//! No compensator: a plain PID loop.

use super::kernel::{Compensate, CompensatorOutput, Sealed};
use crate::real::Real;
use crate::snapshot::{Reader, Words};

/// The compensator of a loop that has none: `u_f = 0`, no state, no cost.
///
/// ```
/// use controller_core::{Controller, ControllerConfig, NoCompensator};
/// let law: Controller<f32, NoCompensator> = Controller::new(&ControllerConfig::default(), 0.01).unwrap();
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoCompensator;

impl Sealed for NoCompensator {}

impl<T: Real> Compensate<T> for NoCompensator {
    type State = ();
    const PRESENT: bool = false;

    #[inline(always)]
    fn sample(&self, _: &mut (), _: T, _: T) -> CompensatorOutput<T> {
        CompensatorOutput { u_f: T::ZERO, d_hat: T::ZERO }
    }
    fn settle(&self, _: &mut (), _: T, _: T) {}
    fn resettle(&self, _: &mut (), _: T) {}
    fn skip(&self, _: &mut (), _: T, _: usize) {}
    fn adopt(&self, _: &Self, _: &mut (), _: T, _: T) -> T {
        T::ZERO
    }
    fn ts(&self) -> Option<T> {
        None
    }
    fn inv_gain(&self) -> T {
        T::ZERO
    }
    fn bounds(&self) -> (f64, f64) {
        (0.0, 0.0)
    }
    fn reach(&self, _: &(), _: f64, _: f64) -> f64 {
        0.0
    }
    fn words(_: &()) -> usize {
        0
    }
    fn coefficients_to(&self, _: &mut impl Words) {}
    fn save(_: &(), _: &mut impl Words) {}
    fn restore(_: &mut (), _: &mut Reader<'_>) -> Option<f64> {
        Some(0.0)
    }
    fn restore_line(_: &mut (), _: &mut Reader<'_>) -> Option<()> {
        Some(())
    }
}
