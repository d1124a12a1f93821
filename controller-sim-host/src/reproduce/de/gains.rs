//! Tables 2 and 4: the gains of MOMI and DRMO.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{GP1, GP2, GP3, GP4, Process};

pub(super) fn first(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    [GP1, GP2].iter().try_for_each(|process| put(process, values))
}

pub(super) fn second(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    [GP3, GP4].iter().try_for_each(|process| put(process, values))
}

fn put(process: &Process, values: &mut Values) -> Result<(), Stop> {
    let design = process.design()?;
    for (rule, pid) in [("MOMI", &design.momi), ("DRMO", &design.drmo)] {
        let row = format!("{} {rule}", process.name);
        values.row(&row, [("KP", pid.kp), ("KI", pid.ki), ("KD", pid.kd)]);
    }
    Ok(())
}
