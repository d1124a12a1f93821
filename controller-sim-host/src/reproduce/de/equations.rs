//! Numbers that stand in equations of the chapter, and the equations that must not be taken as they are typeset.

use super::super::bench::{Bench, Stop, plant};
use super::super::values::Values;
use super::passes::pass;
use super::process::{GP1, GP2, GP3, GP4, Process};
use controller_design::areas::Areas;
use controller_design::rules::noise_limit::high_frequency;
use controller_design::rules::reduction::Reduced;

pub(super) fn all(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    values.put("(33)", "omega_HF", high_frequency(GP3.ts));
    for (process, model, inverse) in
        [(GP1, "(22)", "(24)"), (GP2, "(22)", "(24)"), (GP3, "(36)", "(38)"), (GP4, "(36)", "(38)")]
    {
        let design = process.design()?;
        let (reduced, estimator) = (&design.model, &design.estimator);
        let row = |equation: &str| format!("{equation} {}", process.name);
        values.row(&row(model), [("Tdelm", reduced.dead_time), ("a1m", reduced.a1), ("a2m", reduced.a2)]);
        values.row(
            &row(inverse),
            [("KFD", estimator.kfd), ("a1m", estimator.a1), ("a2m", estimator.a2), ("TFD", estimator.tfd)],
        );
        if model == "(22)" {
            values.put(&row("(23)"), "KFD", estimator.kfd);
            typeset_drmo(&process, &design.areas, values)?;
        } else {
            values.put(&row("(35)"), "TF", design.momi.tf);
            let second = pass(&design.areas, process.noise_gain(), process.ts, 2)?;
            values.put(&format!("(35) {}, pass 2", process.name), "TF", second.next);
            values.row(&row("(37)"), [("TFD", estimator.tfd), ("KFD", estimator.kfd)]);
        }
    }
    let row = "(14) for 1/((1+s)(1+0.2s))";
    let model = Reduced::new(&plant("1/((1+s)*(1+0.2*s))")?.areas6()?)?;
    values.row(row, [("Tdelm", model.dead_time), ("a2m", model.a2)]);
    let model = Reduced::new(&plant("exp(-s)/(1+s)")?.areas6()?)?;
    values.put("(14) for exp(-s)/(1+s)", "Tdelm", model.dead_time);
    Ok(())
}

/// Eqs (9), (10) with `2 K_D` in `beta`, as they are typeset.
fn typeset_drmo(process: &Process, areas: &Areas, values: &mut Values) -> Result<(), Stop> {
    let design = process.design()?;
    let kd = design.momi.kd;
    let [a0, a1, a2, a3, _, _] = areas.filtered(design.momi.tf).values();
    let alpha = a1 * a1 * a1 + a0 * a0 * a3 - 2.0 * a0 * a1 * a2;
    let beta = a1 * a2 - a0 * a3 + 2.0 * kd * (a0 * a1 * a1 - a0 * a0 * a2);
    let gamma =
        kd * kd * kd * a0 * a0 * a0 * a0 + 3.0 * kd * kd * a0 * a0 * a1 + kd * (2.0 * a0 * a2 + a1 * a1) + a3;
    let kp = (beta - libm::sqrt(beta * beta - alpha * gamma)) / alpha;
    let ki = (1.0 + kp * a0) * (1.0 + kp * a0) / (2.0 * (kd * a0 * a0 + a1));
    values.row(&format!("(10) as typeset, {}", process.name), [("KP", kp), ("KI", ki)]);
    Ok(())
}
