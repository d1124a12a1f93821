//! The equations of the paper that lack something, and those that hold.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::designs::TABLE_6;
use super::loops::{Loop, PARTS, PLANTS, SUM, TANK, pi};
use controller_design::model::Complex;
use controller_design::response::{ContinuousResponse, Load};
use controller_design::rules::ObserverDesign;

pub(super) fn all(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    let (_, _, kp, ti) = TABLE_6[0];
    let tank = Loop::new(TANK, pi(kp, ti))?;
    values.put("(36), (43): tank C1, alpha 8.35", "An", tank.frequency(Some(8.35))?.noise_gain());
    let design = ObserverDesign::with_noise_ratio(&tank.plant, &tank.pid, 2.0)?;
    values.put("(46): tank C1, b1 = 2", "alpha", design.observer.alpha);

    let one = Loop::optimal(PLANTS[0].1, 1.2)?;
    for part in PARTS {
        let alpha = part * SUM;
        let response = ContinuousResponse::with_alpha(&one.plant, &one.pid, alpha)?;
        let ie = -response.indices(Load::Ramp)?.ie;
        values.put(&format!("(32), (33): plant 1, alpha {alpha}"), "IE of a unit ramp", ie);
    }
    let (without, with) = (one.frequency(None)?, one.frequency(Some(10.0))?);
    let (mut identity, mut sensitivity) = (0.0_f64, 0.0_f64);
    for i in 0..200 {
        let omega = libm::pow(10.0, -4.0 + 0.025 * f64::from(i));
        let (c_u, c_y) = with.compensator(omega);
        identity = identity.max((c_u + c_y * with.plant(omega)).abs());
        // (34): the sensitivity without observer, times what C_u leaves.
        let by_paper = without.sensitivity(omega) * (Complex::ONE - c_u);
        sensitivity = sensitivity.max((by_paper.abs() / with.sensitivity(omega).abs() - 1.0).abs());
    }
    values.put("(28): plant 1, alpha 10", "largest |Cu + Cy G|", identity);
    values.put("(34): plant 1, alpha 10", "largest error of |S|", sensitivity);
    Ok(())
}
