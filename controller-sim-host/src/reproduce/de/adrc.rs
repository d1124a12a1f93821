//! Table 7: active disturbance rejection control.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{GP5, GP6, Process};
use crate::scenario::ControllerSpec;
use controller_core::AdrcConfig;
use controller_design::rules::adrc::AdrcDesign;

/// By the bandwidth rule, with the settling times and gains behind the printed settings.
pub(super) fn by_rule(process: &Process) -> Result<AdrcDesign, Stop> {
    let (b0, settling_time) = if process.name == GP5.name { (5.0, 1.0) } else { (3.0, 25.0) };
    Ok(AdrcDesign::for_settling_time(b0, settling_time)?)
}

/// What runs.
pub(super) fn controller(design: &AdrcDesign) -> ControllerSpec {
    let AdrcDesign { b0, kp, kd, beta1, beta2, beta3, .. } = *design;
    ControllerSpec::adrc("ADRC", AdrcConfig { b0, kp, kd, beta1, beta2, beta3 })
}

pub(super) fn settings(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for process in [GP5, GP6] {
        let AdrcDesign { kc, kp, kd, beta1, beta2, beta3, .. } = by_rule(&process)?;
        values.row(process.name, [("KC", kc), ("KP", kp), ("KD", kd)]);
        values.row(process.name, [("beta1", beta1), ("beta2", beta2), ("beta3", beta3)]);
    }
    Ok(())
}
