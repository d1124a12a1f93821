//! The first samples: an instance that is all zero settles itself at its first good measurement.

use super::super::block::{Builder, Expression, x};
use super::modes::{self, automatic};
use super::parts::{clamp, deadband, finite, limit, restart, status};
use super::plan::Plan;
use super::{compensator, law};

/// Before the first good measurement: the modes that need none work, the others hold.
pub(super) fn without_measurement(b: &mut Builder, plan: &Plan) {
    b.note("no good measurement yet: modes that need none work, the others hold");
    modes::in_force(b);
    b.set("MODE_NOW", x("MODE_DUE"));
    b.when(automatic("MODE_DUE"), |b| b.set("MODE_NOW", x("MODE_HOLD")));
    modes::target(b, plan, "MODE_NOW");
    b.either(x("TARGET_GIVEN"), |b| b.set("V", x("TARGET")), |b| b.set("V", x("APPLIED")));
    restart(b, "U", "U_C", x("APPLIED"));
    modes::limiter_steps(b, plan);
    limit(b, ("U", "U_C"), "V", ("STEP_DOWN", "STEP_UP"), "U_LIMITED", Some("RATE_HELD"));
    modes::limit_bits(b);
    restart(b, "SPW", "SPW_C", x("R_ASKED"));
    b.set("MODE_LAST", x("MODE_NOW"));
    nothing_estimated(b, plan);
    status(b, "ST_UNINITIALISED");
}

/// The first good measurement of a zeroed instance: everything at rest at it and at the applied output.
pub(super) fn settle(b: &mut Builder, plan: &Plan) {
    let n = &plan.numbers;
    b.note("first good measurement: everything at rest at it and at the applied output");
    clamp(b, "Y", "PV", "PV_MIN", "PV_MAX");
    b.when(x("SP_FINITE").opposite(), |b| clamp(b, "R_ASKED", "PV", "SP_LIM_LO", "SP_LIM_HI"));
    if n.setpoint_ramps || n.setpoint_tracks {
        b.note("the working set-point starts at the measurement");
        clamp(b, "SPW", "PV", "SP_LIM_LO", "SP_LIM_HI");
        b.set("SPW_C", x("ZERO"));
    } else {
        restart(b, "SPW", "SPW_C", x("R_ASKED"));
    }
    b.when(x("FF_FINITE").opposite(), |b| clamp(b, "OFFSET", "ZERO", "FF_MIN", "FF_MAX"));
    if let Some(chains) = &plan.compensator {
        compensator::settle(b, chains, "Y", "APPLIED");
    }
    deadband(b, "Y_SEEN", "SPW", "Y");
    law::settle(b, "SPW", "Y_SEEN", "APPLIED");
    b.set("PD", x("APPLIED") - x("I_SUM"));
    restart(b, "U", "U_C", x("APPLIED"));
    b.set("V", x("APPLIED"));
    b.set("U_F", x("ZERO"));
    for (alarm, _) in plan.alarms() {
        b.set(alarm.active, Expression::Flag(false));
    }
    b.set("MODE_LAST", x("MODE_HOLD"));
    if plan.compensator.is_some() {
        b.set("COMPENSATING", x("COMPENSATE"));
    }
    b.set("STARTED", Expression::Flag(true));
    b.set("OWN", x("APPLIED"));
}

/// The first good measurement after a long time without: at rest, the chain of applied outputs going on.
pub(super) fn settle_again(b: &mut Builder, plan: &Plan) {
    b.note("good again after a fallback: at rest at the measurement and the applied output");
    if let Some(chains) = &plan.compensator {
        compensator::settle_y(b, chains, "Y");
    }
    deadband(b, "Y_SEEN", "SPW", "Y");
    law::settle(b, "SPW", "Y_SEEN", "OWN");
    restart(b, "U", "U_C", x("APPLIED"));
    b.set("V", x("APPLIED"));
    b.set("MODE_LAST", x("MODE_HOLD"));
    nothing_estimated(b, plan);
}

fn nothing_estimated(b: &mut Builder, plan: &Plan) {
    if plan.compensator.is_some() {
        b.set("UF_NEW", x("ZERO"));
        b.set("DH", x("ZERO"));
    }
}

/// The set-point as the mode in `mode` asks for it, within its range, into `to`; the last usable one if not finite.
pub(super) fn asked_by(b: &mut Builder, to: &str, mode: &str) {
    b.set("ACC_T", x("SP"));
    b.when(x(mode).is(x("MODE_CAS")), |b| b.set("ACC_T", x("SP_REMOTE")));
    b.when(finite("ACC_T").opposite(), |b| b.set("ACC_T", x("R_ASKED")));
    clamp(b, to, "ACC_T", "SP_LIM_LO", "SP_LIM_HI");
}
