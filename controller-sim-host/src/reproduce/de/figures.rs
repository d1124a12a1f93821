//! What the figures of the chapter show.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::experiments::{both, controllers, pid};
use super::process::{GP1, GP2, GP3, GP4, GP5, GP6};
use controller_core::PidConfig;
use controller_design::rules::ah::{AhMs, AhPid};

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    let mut holds = [0.0; 4];
    for (process, figure) in [
        (GP1, Some("fig. 6")),
        (GP2, Some("fig. 7")),
        (GP3, Some("fig. 11")),
        (GP4, Some("fig. 12")),
        (GP5, None),
        (GP6, None),
    ] {
        let design = process.design()?;
        let mut specs = controllers(&design).to_vec();
        let ah = AhPid::of_plant(&design.plant, AhMs::Ms20)?.pid;
        specs.push(pid("AH", PidConfig { tf: design.momi.tf, ..ah }));
        let pairs = both(bench, &process, &specs)?;
        let [de, momi, drmo, ah] = &*pairs else { continue };
        if let Some(figure) = figure {
            for (rule, pair) in [("DE-MOMI", de), ("MOMI", momi)] {
                let row = format!("{figure}, {} {rule}", process.name);
                values.row(&row, [("IAE tracking", pair.tracking.iae), ("IAE DR", pair.rejection.iae)]);
            }
        }
        let claims = [
            de.rejection.iae < momi.rejection.iae,
            de.rejection.iae < drmo.rejection.iae,
            drmo.rejection.iae < momi.rejection.iae,
            (de.tracking.iae / momi.tracking.iae - 1.0).abs() < 0.015,
        ];
        for (count, claim) in holds.iter_mut().zip(claims) {
            *count += if claim { 1.0 } else { 0.0 };
        }
        if process.name == GP2.name {
            let jerky = de.tracking.tv > 1.1 * momi.tracking.tv;
            values.yes("fig. 7, GP2", "tracking: TV > 1.1 of MOMI", jerky);
        }
        if process.name == GP5.name {
            let oscillates = ah.rejection.tv > 2.0 * drmo.rejection.tv;
            values.yes("fig. 14, GP5 AH", "DR: TV > 2 of DRMO", oscillates);
        }
    }
    let claims =
        ["DR: DE-MOMI < MOMI", "DR: DE-MOMI < DRMO", "DR: DRMO < MOMI", "tracking within 1.5 % of MOMI"];
    for (claim, count) in claims.iter().zip(holds) {
        values.put("GP1..GP6", claim, count);
    }
    Ok(())
}
