//! The plant of a scenario: the whole, and its parts when it has two.

use super::fault::{Fault, code};
use super::models;
use super::table::{Located, Table};
use super::trial::{LONGEST_DELAY, delay_fault};
use controller_design::model::{TransferFunction, parse};

/// A plant as it was read.
#[derive(Debug, Clone)]
pub(super) struct Plant {
    /// From the actuator to the measurement.
    pub(super) whole: TransferFunction,
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
        None => Some((Plant { whole: outer.value, parts: None }, outer.span)),
        Some(inner) => Some((in_series(&table, inner?, &outer)?, outer.span)),
    });
    if let (Some((plant, span)), Some(ts)) = (&plant, ts) {
        let samples = (plant.whole.dead_time() + latency) / ts.value;
        if samples > LONGEST_DELAY {
            table.log.fault(delay_fault("the plant's dead time and the latency are", samples, span.clone()));
        }
    }
    table.finish();
    plant.map(|(plant, _)| plant)
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
        Ok(whole) => Some(Plant { whole, parts: Some([inner.value, outer.value.clone()]) }),
        Err(errors) => {
            let reason = errors.first().map_or("", |error| &error.message);
            let message = format!("`{name}` and the outer part together: {reason}");
            table.log.fault(Fault::new(code::EXPRESSION, inner.span, message));
            None
        }
    }
}
