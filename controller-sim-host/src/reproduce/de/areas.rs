//! Tables 1 and 3: the characteristic areas.

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
    let areas = process.areas()?;
    let filtered = areas.filtered(process.design()?.momi.tf);
    for (k, (area, starred)) in areas.values().iter().zip(filtered.values()).enumerate() {
        values.put(process.name, &format!("A{k}"), *area);
        values.put(process.name, &format!("A{k}*"), starred);
    }
    Ok(())
}
