//! Another design than the one that the variables are of: every number anew, the loop begins where the output is.
//!
//! The first scan of an instance is the case of no design at all, whatever its memory holds: no variable counts on a value
//! from its declaration.

use super::super::block::{Builder, IN_FORCE, number, x};
use super::parts::{clamp, finite};
use super::plan::Plan;

pub(super) fn begin(b: &mut Builder, plan: &Plan) {
    let inputs = plan.tuning.map_or(Vec::new(), |tuning| tuning.inputs().to_vec());
    b.anew(
        |b| {
            b.note("first scan, or memory of another design: all values by statements, the loop begins anew");
            b.set("LOST", x(IN_FORCE).is(number(0)).opposite());
            for (input, _) in &inputs {
                let as_designed = x(input).is(x(&format!("{input}_DESIGN")));
                let or_before = x(input).is(x(&format!("{input}_BEFORE")));
                b.set(&format!("{input}_UNTUNED"), x("LOST").and(as_designed.or(or_before)));
            }
        },
        |b| {
            if let Some(chains) = &plan.compensator {
                b.repeat("CELL", 0, chains.last_cell(), |b| b.set_cell("DELAY", "CELL", x("ZERO")));
            }
            b.set("PV_ENG", x("ZERO"));
            b.set("U", x("OP_INIT"));
            b.when(x("LOST").and(finite("OP")), |b| {
                b.note("where the actuator is");
                clamp(b, "U", "OP", "OP_LIM_LO", "OP_LIM_HI");
            });
            b.set("STATE_LOST", x("LOST"));
            for (input, _) in &inputs {
                b.when(x(&format!("{input}_UNTUNED")), |b| b.set(&format!("{input}_BEFORE"), x(input)));
            }
        },
    );
}

/// The inputs of tuning as they are meant, behind `_ASKED`: one that has stayed as a design before began counts as that of
/// this design, until it changes.
pub(super) fn asked(b: &mut Builder, input: &str) {
    let [asked, before, design] = ["ASKED", "BEFORE", "DESIGN"].map(|end| format!("{input}_{end}"));
    b.set(&asked, x(input));
    b.either(x(input).is(x(&before)), |b| b.set(&asked, x(&design)), |b| b.set(&before, x(&design)));
}
