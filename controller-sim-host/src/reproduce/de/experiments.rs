//! Table 8: the IAE of tracking and of disturbance rejection.

use super::super::bench::{Bench, Experiment, REJECTION, Stop, TRACKING};
use super::super::values::Values;
use super::adrc;
use super::passes::pass;
use super::process::{Design, GP5, GP6, Process};
use super::settings::PRINTED_PASS;
use crate::scenario::ControllerSpec;
use crate::simulate::Metrics;
use controller_core::{IntegralRule, PidConfig};
use controller_design::rules::ah::{AhMs, AhPid};
use controller_design::rules::drmo::Drmo;

/// Indices of one controller in both experiments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) tracking: Metrics,
    pub(super) rejection: Metrics,
}

/// Both experiments of the chapter, each from rest, without noise.
pub(super) fn both(
    bench: &Bench<'_>,
    process: &Process,
    controllers: &[ControllerSpec],
) -> Result<Vec<Pair>, Stop> {
    let plant = process.plant()?;
    let run = |change| {
        let (ts, duration) = (process.ts, process.horizon);
        bench.metrics(&Experiment { plant: &plant, ts, duration, substeps: 20, change }, controllers.to_vec())
    };
    let (tracking, rejection) = (run(TRACKING)?, run(REJECTION)?);
    Ok(tracking
        .into_iter()
        .zip(rejection)
        .map(|(tracking, rejection)| Pair { tracking, rejection })
        .collect())
}

/// A PID of the chapter as the reference discretises it: Tustin's rule for every term.
pub(super) fn pid(name: &str, pid: PidConfig) -> ControllerSpec {
    ControllerSpec::pid(name, PidConfig { integral_rule: IntegralRule::Trapezoid, ..pid })
}

/// MOMI, DRMO and DE-MOMI.
pub(super) fn controllers(design: &Design) -> [ControllerSpec; 3] {
    [
        pid("DE-MOMI", design.momi).with_estimator(design.estimator),
        pid("MOMI", design.momi),
        pid("DRMO", design.drmo),
    ]
}

/// `ah` with a filter on the derivative only: the law of this library with other numbers.
///
/// `kp + kd s/(1+tf s)` is `(kp + (kd + kp tf) s)/(1+tf s)`, and the law has `kp - ki tf` where this has `kp`.
fn derivative_filter(ah: PidConfig, tf: f64) -> PidConfig {
    let (kp, kd) = (ah.kp + ah.ki * tf, ah.kd + ah.kp * tf);
    PidConfig {
        kp,
        kd,
        tf,
        b: (ah.b * ah.kp + ah.ki * tf) / kp,
        c: (ah.b * ah.kp * tf + ah.c * ah.kd) / kd,
        ..ah
    }
}

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for process in [GP5, GP6] {
        one(bench, &process, values)?;
    }
    Ok(())
}

fn one(bench: &Bench<'_>, process: &Process, values: &mut Values) -> Result<(), Stop> {
    let converged = process.design()?;
    let printed = if process.name == GP5.name {
        let pass = pass(&converged.areas, process.noise_gain(), process.ts, PRINTED_PASS)?;
        let drmo = Drmo::new(&converged.areas, pass.pid.tf)?.pid;
        // The gains of one pass beside the filter of the next.
        let tf = pass.next;
        Design { momi: PidConfig { tf, ..pass.pid }, drmo: PidConfig { tf, ..drmo }, ..converged.clone() }
    } else {
        converged.clone()
    };
    let tf = printed.momi.tf;
    let ah = AhPid::of_plant(&converged.plant, AhMs::Ms20)?.pid;
    let mut specs = controllers(&printed).to_vec();
    specs.push(pid("AH", derivative_filter(ah, tf)));
    specs.push(adrc::controller(&adrc::by_rule(process)?.with_beta3_as_printed()));
    specs.extend(controllers(&converged));
    specs.push(pid("AH", PidConfig { tf, ..ah }));
    specs.push(adrc::controller(&adrc::by_rule(process)?));
    let pairs = both(bench, process, &specs)?;
    let rows = [
        "DE-MOMI",
        "MOMI",
        "DRMO",
        "AH",
        "ADRC",
        "DE-MOMI, converged",
        "MOMI, converged",
        "DRMO, converged",
        "AH, law (4)",
        "ADRC, beta3 = wo^3",
    ];
    for (row, pair) in rows.iter().zip(&pairs) {
        values.row(
            &format!("{} {row}", process.name),
            [("tracking", pair.tracking.iae), ("DR", pair.rejection.iae)],
        );
    }
    let [de, momi, drmo, ah, with_printed, .., by_rule] = &*pairs else { return Ok(()) };
    let name = process.name;
    let best = |of: fn(&Pair) -> f64, others: &[&Pair]| others.iter().all(|other| of(de) < of(other));
    let (tracking, rejection) = (|p: &Pair| p.tracking.iae, |p: &Pair| p.rejection.iae);
    values.yes(name, "DE-MOMI best in DR", best(rejection, &[momi, drmo, ah, with_printed]));
    values.yes(name, "DE-MOMI best in tracking", best(tracking, &[momi, drmo, ah, with_printed]));
    if name == GP5.name {
        let with_rule = best(rejection, &[momi, drmo, ah, by_rule]);
        values.yes("GP5, beta3 = wo^3", "DE-MOMI best in DR", with_rule);
    } else {
        values.put(name, "DE-MOMI/MOMI - 1", de.tracking.iae / momi.tracking.iae - 1.0);
    }
    Ok(())
}
