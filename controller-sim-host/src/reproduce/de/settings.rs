//! Tables 5 and 6: controllers and estimators for GP5 and GP6.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::passes::{START, pass, until};
use super::process::{GP5, GP6};
use controller_core::PidConfig;
use controller_design::rules::ah::{AhMs, AhPid};
use controller_design::rules::de_momi::DeMomi;
use controller_design::rules::drmo::Drmo;
use controller_design::rules::reduction::Reduced;

/// The pass of figure 9 that the chapter prints for GP5.
pub(super) const PRINTED_PASS: usize = 4;

pub(super) fn controllers(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for process in [GP5, GP6] {
        let design = process.design()?;
        let ah = AhPid::of_plant(&design.plant, AhMs::Ms20)?.pid;
        for (rule, pid) in
            [("MOMI", design.momi), ("DRMO", design.drmo), ("DE-MOMI", design.momi), ("AH", ah)]
        {
            let PidConfig { kp, ki, kd, b, c, .. } = pid;
            // The chapter gives AH the filter of MOMI.
            let tf = design.momi.tf;
            let row = format!("{} {rule}", process.name);
            values.row(&row, [("KP", kp), ("KI", ki), ("KD", kd), ("TF", tf), ("b", b), ("c", c)]);
        }
    }
    let areas = GP5.areas()?;
    let (gain, ts) = (GP5.noise_gain(), GP5.ts);
    let printed = pass(&areas, gain, ts, PRINTED_PASS)?;
    let drmo = Drmo::new(&areas, printed.pid.tf)?.pid;
    for (rule, pid) in [("MOMI", printed.pid), ("DRMO", drmo)] {
        values.row(&format!("GP5 {rule}, pass 4"), [("KP", pid.kp), ("KI", pid.ki), ("KD", pid.kd)]);
    }
    values.row("GP5, pass 4", [("TF used", printed.pid.tf), ("TF next", printed.next)]);
    let needed = until(&areas, gain, ts, GP5.design()?.momi.tf, 1e-3)?;
    values.put("GP5, fig. 9", "passes to 0.1 %", needed as f64);
    Ok(())
}

pub(super) fn estimators(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for process in [GP5, GP6] {
        let design = process.design()?;
        let Reduced { gain, a1, a2, dead_time, .. } = design.model;
        values.row(process.name, [("KPRM", gain), ("a1m", a1), ("a2m", a2), ("Tdelm", dead_time)]);
        let estimator = design.estimator;
        values.row(process.name, [("TFD", estimator.tfd), ("KFD", estimator.kfd)]);
    }
    // Figure 10 with the gains that belong to the first filter of figure 9.
    let areas = GP6.areas()?;
    let tfd = stale_tfd(&areas)?;
    let stale = DeMomi::new(&areas, START, tfd)?;
    let kfd = stale.estimator.map_or(f64::NAN, |one| one.kfd);
    values.row("GP6, gains left at TF = 0.1", [("TFD", tfd), ("KFD", kfd)]);
    Ok(())
}

/// The filter of the estimator for the noise gain of GP6, with the controller for `TF = 0.1`.
fn stale_tfd(areas: &controller_design::areas::Areas) -> Result<f64, Stop> {
    use controller_design::rules::noise_limit::kden;
    let model = Reduced::new(areas)?;
    let too_noisy = |tfd: f64| -> Result<bool, Stop> {
        let kfd = DeMomi::new(areas, START, tfd)?.estimator.map_or(0.0, |one| one.kfd);
        Ok(kden(&model, kfd, tfd, GP6.ts) > GP6.noise_gain())
    };
    // The gain falls as the filter gets longer.
    let (mut lo, mut hi) = (GP6.ts, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if too_noisy(middle)? { lo = middle } else { hi = middle }
    }
    Ok(hi)
}
