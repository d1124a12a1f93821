//! A loop as a function block: the statements of one sample, in the order and with the operations of
//! `controller_core::Controller::step`.

mod anew;
mod compensator;
mod declare;
mod inputs;
mod law;
mod modes;
mod outputs;
mod parts;
mod plan;
mod start;
mod tuning;

use super::Export;
use super::block::{Block, Builder, x};
use plan::Plan;

/// The block; `None` for an ADRC. `head` gives its first lines for a loop that can be tuned on site or not, and for the
/// number of the design.
pub(super) fn block(
    export: &Export<'_>,
    name: &str,
    head: impl FnOnce(bool, i32) -> Vec<String>,
) -> Option<Block> {
    let plan = Plan::new(export)?;
    let mut b = Builder::new();
    declare::all(&mut b, &plan);
    anew::begin(&mut b, &plan);
    tuning::retune(&mut b, &plan);
    inputs::read(&mut b, &plan);
    tuning::refused(&mut b, &plan);
    b.either(
        x("STARTED").opposite().and(x("USABLE").opposite()),
        |b| start::without_measurement(b, &plan),
        |b| sample(b, &plan),
    );
    outputs::write(&mut b, &plan);
    Some(b.finish(name, |design| head(plan.tuning.is_some(), design)))
}

/// A sample of an instance that has, or gets, a measurement.
fn sample(b: &mut Builder, plan: &Plan) {
    b.when(x("STARTED").opposite(), |b| start::settle(b, plan));
    b.note("good measurements are followed while a latched fallback waits, too");
    b.when(x("USABLE").or(x("AWAITING")), |b| b.set("Y", x("PV")));
    if let Some(chains) = &plan.compensator {
        compensator::sample(b, chains, "Y", "APPLIED");
    }
    b.when(x("RESETTLE"), |b| start::settle_again(b, plan));
    modes::use_compensator(b, plan);
    modes::act(b, plan);
    outputs::alarms(b, plan);
    outputs::last_bits(b, plan);
}
