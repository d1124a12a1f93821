//! Modes: which one is in force, where it wants the output, how the loop closes without a bump.

use super::super::block::{Builder, Expression, x};
use super::parts::{deadband, limit, ramp, restart, status};
use super::plan::Plan;
use super::start::asked_by;
use super::{law, start};

/// Whether a mode closes the loop.
pub(super) fn automatic(mode: &str) -> Expression {
    x(mode).is(x("MODE_AUTO")).or(x(mode).is(x("MODE_CAS")))
}

/// `MODE_DUE`: priority Off, Track, Fallback, Manual, Hold, Auto and Cascade.
pub(super) fn in_force(b: &mut Builder) {
    b.note("priority: Off, Track, Fallback, Manual, Hold, Auto and Cascade");
    b.set("MODE_DUE", x("MODE_ASKED"));
    let first = x("MODE_ASKED").is(x("MODE_OFF")).or(x("MODE_ASKED").is(x("MODE_TRK")));
    b.when(first.opposite(), |b| {
        b.when(x("IN_FALLBACK"), |b| b.set("MODE_DUE", x("MODE_FALLBACK")));
    });
}

/// `TARGET`, `TARGET_GIVEN`: where the mode in `mode` wants the output, if anywhere.
pub(super) fn target(b: &mut Builder, plan: &Plan, mode: &str) {
    let n = &plan.numbers;
    b.set("TARGET_GIVEN", Expression::Flag(false));
    b.set("TARGET", x("U"));
    let to = |b: &mut Builder, value: &str| {
        b.set("TARGET", x(value));
        b.set("TARGET_GIVEN", Expression::Flag(true));
    };
    let is = |of: &str| x(mode).is(x(of));
    b.when(is("MODE_MAN").and(x("MAN_FINITE")), |b| to(b, "MAN_WITHIN"));
    b.when(is("MODE_TRK").and(x("TRK_FINITE")), |b| to(b, "TRK_WITHIN"));
    if n.off_output.is_some() {
        b.when(is("MODE_OFF"), |b| to(b, "OFF_OP"));
    }
    if n.fallback_output.is_some() {
        b.when(is("MODE_FALLBACK"), |b| to(b, "FAIL_OP"));
    }
}

/// `STEP_UP`, `STEP_DOWN`: the longest steps of the output in this sample.
pub(super) fn limiter_steps(b: &mut Builder, plan: &Plan) {
    b.set("STEP_UP", x("OP_STEP_UP"));
    b.set("STEP_DOWN", x("OP_STEP_DOWN"));
    if plan.slow_fallback() {
        b.when(x("MODE_NOW").is(x("MODE_FALLBACK")), |b| {
            b.set("STEP_UP", x("FB_STEP_UP"));
            b.set("STEP_DOWN", x("FB_STEP_DOWN"));
        });
    }
}

/// The bits of the limiter after `U_LIMITED` and `RATE_HELD`.
pub(super) fn limit_bits(b: &mut Builder) {
    b.when(x("U_LIMITED").at_least(x("OP_LIM_HI")), |b| status(b, "ST_LIMITED_HIGH"));
    b.when(x("U_LIMITED").at_most(x("OP_LIM_LO")), |b| status(b, "ST_LIMITED_LOW"));
    b.when(x("RATE_HELD"), |b| status(b, "ST_RATE_LIMITED"));
}

/// The compensator in or out of the sum without a bump: the integral term takes the difference.
pub(super) fn use_compensator(b: &mut Builder, plan: &Plan) {
    if plan.compensator.is_none() {
        return;
    }
    b.note("compensator in or out of the sum: the integral term takes the difference");
    b.when(x("COMPENSATING").and(x("COMPENSATE").opposite()), |b| {
        super::parts::add(b, "I_SUM", "I_SUM_C", x("UF_NEW"));
    });
    b.when(x("COMPENSATE").and(x("COMPENSATING").opposite()), |b| {
        super::parts::add(b, "I_SUM", "I_SUM_C", -x("UF_NEW"));
    });
    b.set("COMPENSATING", x("COMPENSATE"));
    b.either(x("COMPENSATE"), |b| b.set("U_F", x("UF_NEW")), |b| b.set("U_F", x("ZERO")));
}

/// Which mode acts, and what it does with output and terms.
pub(super) fn act(b: &mut Builder, plan: &Plan) {
    b.set("MODE_WAS", x("MODE_LAST"));
    in_force(b);
    b.note("a few bad samples: output and terms stay");
    b.set("HELD_NOW", x("HOLDING").and(automatic("MODE_DUE")));
    b.set("MODE_NOW", x("MODE_DUE"));
    b.when(x("HELD_NOW"), |b| {
        b.either(
            automatic("MODE_WAS"),
            |b| b.set("MODE_NOW", x("MODE_WAS")),
            |b| b.set("MODE_NOW", x("MODE_HOLD")),
        );
    });
    b.set("CLOSED", automatic("MODE_NOW"));
    b.set("WANTED", x("U"));
    b.when(x("HELD_NOW").opposite(), |b| {
        b.set("BEGINS", Expression::Flag(false));
        b.set("R_TO", x("R_ASKED"));
        b.either(x("CLOSED"), |b| begin(b, plan), |b| leave(b, plan));
        move_setpoint(b, plan);
        deadband(b, "Y_SEEN", "SPW", "Y");
        b.when(x("CLOSED"), increment);
        law::filter(b, "SPW", "Y_SEEN");
        b.either(x("CLOSED"), |b| close(b, plan), |b| b.set("V", x("TARGET")));
        b.set("WANTED", x("V"));
    });
    b.note("output within range and rate; the range beats the rate");
    limiter_steps(b, plan);
    limit(b, ("U", "U_C"), "WANTED", ("STEP_DOWN", "STEP_UP"), "U_LIMITED", Some("RATE_HELD"));
    limit_bits(b);
    b.when(automatic("MODE_NOW").opposite(), |b| {
        b.note("the integral term follows, so that closing the loop moves nothing");
        restart(b, "I_SUM", "I_SUM_C", x("U_LIMITED") - x("PD") - x("U_F") - x("OFFSET"));
        b.set("INC", x("ZERO"));
    });
    b.set("MODE_LAST", x("MODE_NOW"));
}

/// Entering Auto or Cascade: where the output is to begin, in `V_BEGIN`.
fn begin(b: &mut Builder, plan: &Plan) {
    b.either(
        automatic("MODE_WAS").opposite(),
        |b| {
            b.note("from another mode: begin where that mode would have put the output");
            target(b, plan, "MODE_WAS");
            b.set("SUM", x("U"));
            b.set("SUM_C", x("U_C"));
            limit(b, ("SUM", "SUM_C"), "TARGET", ("OP_STEP_DOWN", "OP_STEP_UP"), "V_BEGIN", None);
            b.set("INC_BEGIN", x("ZERO"));
            b.set("BEGINS", Expression::Flag(true));
        },
        |b| {
            b.when(x("MODE_WAS").is(x("MODE_NOW")).opposite(), |b| {
                b.note("between Auto and Cascade: begin where the old set-point would have put the output");
                start::asked_by(b, "R_TO", "MODE_WAS");
                b.set("SUM", x("SPW"));
                b.set("SUM_C", x("SPW_C"));
                ramp(b, ("SUM", "SUM_C"), "R_TO");
                b.set("R_TO", x("R_ASKED"));
                deadband(b, "Y_SEEN", "SUM", "Y");
                law::increment(b, "INC_ASKED", "SUM", "Y_SEEN");
                law::allowed(b, "INC_BEGIN", "INC_ASKED");
                law::preview(b, "PREVIEW", "SUM", "Y_SEEN");
                law::unwind(b, plan, "CORRECTION", "APPLIED");
                b.set("I_BEGIN", x("I_SUM") + x("INC_BEGIN") + x("CORRECTION"));
                b.set("V_BEGIN", x("I_BEGIN") + x("PREVIEW") + x("OFFSET") + x("U_F"));
                b.set("BEGINS", Expression::Flag(true));
            });
        },
    );
}

/// A mode that does not close the loop. One that keeps the output keeps what the automatic law gives in the sample of
/// the change; on a bad sample, what is there.
fn leave(b: &mut Builder, plan: &Plan) {
    target(b, plan, "MODE_NOW");
    let last = automatic("MODE_WAS").and(x("TARGET_GIVEN").opposite()).and(x("USABLE"));
    b.when(last, |b| {
        asked_by(b, "R_TO", "MODE_WAS");
        b.set("CLOSED", Expression::Flag(true));
    });
}

/// The working set-point: the measurement where it tracks, else on its way to `R_TO`.
fn move_setpoint(b: &mut Builder, plan: &Plan) {
    b.note("working set-point");
    if !plan.numbers.setpoint_tracks {
        ramp(b, ("SPW", "SPW_C"), "R_TO");
        return;
    }
    let released = x("MODE_NOW")
        .is(x("MODE_OFF"))
        .or(x("MODE_NOW").is(x("MODE_MAN")))
        .or(x("MODE_NOW").is(x("MODE_TRK")));
    b.either(
        released.and(x("CLOSED").opposite()),
        |b| {
            super::parts::clamp(b, "SPW", "Y", "SP_LIM_LO", "SP_LIM_HI");
            b.set("SPW_C", x("ZERO"));
        },
        |b| ramp(b, ("SPW", "SPW_C"), "R_TO"),
    );
}

/// The increment of the integral term, as far as a secondary loop lets it through.
fn increment(b: &mut Builder) {
    b.note("increment of the integral term: KI_NOW*e[k] + KI_BEFORE*e[k-1]");
    law::increment(b, "INC_ASKED", "SPW", "Y_SEEN");
    law::allowed(b, "INC_ALLOWED", "INC_ASKED");
    b.when(x("INC_ALLOWED").is(x("INC_ASKED")).opposite(), |b| status(b, "ST_INHIBITED"));
}

/// The integral term and the wanted output of a closed loop.
fn close(b: &mut Builder, plan: &Plan) {
    b.either(
        x("BEGINS"),
        |b| {
            restart(b, "I_SUM", "I_SUM_C", x("V_BEGIN") - x("PD") - x("U_F") - x("OFFSET"));
            b.set("INC", x("INC_BEGIN"));
        },
        |b| {
            law::unwind(b, plan, "CORRECTION", "APPLIED");
            super::parts::add(b, "I_SUM", "I_SUM_C", x("CORRECTION"));
            b.set("INC", x("INC_ALLOWED"));
            super::parts::add(b, "I_SUM", "I_SUM_C", x("INC_ALLOWED"));
        },
    );
    law::bound(b);
    b.note("v = I + pd + offset + u_f");
    b.set("V", x("I_SUM") + x("PD") + x("OFFSET") + x("U_F"));
}
