//! The plant of a scenario: the whole, and its parts when it has two.

use super::fault::{Fault, code};
use super::models;
use super::table::{Located, Table};
use super::trial::{LONGEST_DELAY, delay_fault};
use controller_design::model::{TransferFunction, parse};

/// A plant as it was read.
#[derive(Debug, Clone)]
pub(super) struct Plant {
    /// From the actuator to the measurement, as it is known: what controllers are designed for.
    pub(super) whole: TransferFunction,
    /// What is simulated.
    pub(super) actual: TransferFunction,
    /// The part that the actuator drives first and the part behind it, when they are written one by one.
    pub(super) parts: Option<[TransferFunction; 2]>,
}

/// `[plant]`.
pub(super) fn read(root: &Table<'_>, ts: Option<&Located<f64>>, latency: f64) -> Option<Plant> {
    let example = "`[plant]` and below it `tf = \"exp(-0.2*s)/(1+s)\"`";
    if root.span("plant").is_none() {
        root.missing("plant", example);
    }
    let table = root.table("plant", example)?;
    let outer = models::read(&table);
    let inner = table.span("inner").map(|_| models::value(&table, "inner"));
    let plant = outer.and_then(|outer| match inner {
        None => Some((Plant::known(outer.value, None), outer.span)),
        Some(inner) => Some((in_series(&table, inner?, &outer)?, outer.span)),
    });
    let actual = table.span("actual").and_then(|_| models::value(&table, "actual"));
    if let Some(ts) = ts {
        let known = plant.iter().map(|(plant, span)| (&plant.whole, span));
        for (plant, span) in known.chain(actual.iter().map(|actual| (&actual.value, &actual.span))) {
            let samples = (plant.dead_time() + latency) / ts.value;
            if samples > LONGEST_DELAY {
                let what = "the plant's dead time and the latency are";
                table.log.fault(delay_fault(what, samples, span.clone()));
            }
        }
    }
    let mut plant = plant.map(|(plant, _)| plant);
    if let (Some(plant), Some(actual)) = (&mut plant, actual) {
        if plant.parts.is_some() {
            let message = format!(
                "`{}` is a whole plant; with an `inner` part there is no whole",
                table.name("actual")
            );
            table.log.fault(Fault::new(code::CONFLICT, actual.span.clone(), message));
        }
        plant.actual = actual.value;
    }
    table.finish();
    plant
}

impl Plant {
    fn known(whole: TransferFunction, parts: Option<[TransferFunction; 2]>) -> Self {
        Self { actual: whole.clone(), whole, parts }
    }
}

/// The inner part with the outer one behind it.
fn in_series(
    table: &Table<'_>,
    inner: Located<TransferFunction>,
    outer: &Located<TransferFunction>,
) -> Option<Plant> {
    let name = table.name("inner");
    if inner.value.differentiators() > 0 {
        let message = format!("`{name}` has a zero at s = 0: nothing can hold it at a set-point");
        table.log.fault(Fault::new(code::CONFLICT, inner.span, message));
        return None;
    }
    if inner.value.integrators() > 0 && outer.value.differentiators() > 0 {
        let message =
            format!("`{name}` has a pole at s = 0 and the outer part a zero there, which would cancel");
        let fault =
            Fault::new(code::CONFLICT, inner.span, message).related(outer.span.clone(), "the outer part");
        table.log.fault(fault);
        return None;
    }
    // Printed, a transfer function keeps its factors and every bit of its numbers.
    match parse(&format!("({})*({})", inner.value, outer.value)) {
        Ok(whole) => Some(Plant::known(whole, Some([inner.value, outer.value.clone()]))),
        Err(errors) => {
            let reason = errors.first().map_or("", |error| &error.message);
            let message = format!("`{name}` and the outer part together: {reason}");
            table.log.fault(Fault::new(code::EXPRESSION, inner.span, message));
            None
        }
    }
}
