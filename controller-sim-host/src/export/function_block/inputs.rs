//! The inputs of a sample: judged, moved into their ranges, replaced where they cannot be used.

use super::super::block::{Builder, Expression, number, x};
use super::parts::{clamp, finite, status};
use super::plan::Plan;

/// All of it, up to the applied output in `APPLIED`.
pub(super) fn read(b: &mut Builder, plan: &Plan) {
    b.set("STATUS", x("ST_NONE"));
    b.set("OFFSET_BEFORE", x("OFFSET"));
    b.when(x("ACK"), |b| b.set("STATE_LOST", flag(false)));
    b.when(x("STATE_LOST"), |b| status(b, "ST_STATE_LOST"));
    mode(b);
    measurement(b, plan);
    setpoint(b);
    offset(b);
    manual_and_track(b);
    applied(b);
}

fn flag(is: bool) -> Expression {
    Expression::Flag(is)
}

/// The flags that ask for modes, the one that counts first before the others.
const WISHES: [(&str, &str); 6] = [
    ("OFF", "MODE_OFF"),
    ("TRK", "MODE_TRK"),
    ("MAN", "MODE_MAN"),
    ("HOLD", "MODE_HOLD"),
    ("CAS", "MODE_CAS"),
    ("AUTO", "MODE_AUTO"),
];

fn mode(b: &mut Builder) {
    b.note("mode asked for: the first of OFF, TRK, MAN, HOLD, CAS, AUTO that is TRUE; none: hold");
    first_of(b, &WISHES);
}

fn first_of(b: &mut Builder, wishes: &[(&str, &str)]) {
    match wishes {
        [] => b.set("MODE_ASKED", x("MODE_HOLD")),
        [(flag, mode), rest @ ..] => {
            b.either(x(flag), |b| b.set("MODE_ASKED", x(mode)), |b| first_of(b, rest));
        }
    }
}

fn measurement(b: &mut Builder, plan: &Plan) {
    b.note("measurement: finite, in range, not marked bad");
    b.set("USABLE", flag(false));
    b.set("RESETTLE", flag(false));
    b.set("HOLDING", flag(false));
    b.set("AWAITING", flag(false));
    let in_range = x("PV").at_least(x("PV_MIN")).and(x("PV").at_most(x("PV_MAX")));
    let quality = x("PV_QUALITY").is(x("Q_GOOD")).or(x("PV_QUALITY").is(x("Q_UNCERTAIN")));
    b.set("GOOD", in_range.and(quality));
    let use_it = |b: &mut Builder| {
        b.set("RESETTLE", x("IN_FALLBACK"));
        b.set("IN_FALLBACK", flag(false));
        b.set("BAD_COUNT", number(0));
        b.set("USABLE", flag(true));
        b.when(x("PV_QUALITY").is(x("Q_UNCERTAIN")), |b| status(b, "ST_UNCERTAIN"));
    };
    b.either(
        x("GOOD"),
        |b| {
            if plan.numbers.acknowledged {
                b.either(
                    x("IN_FALLBACK").and(x("ACK").opposite()),
                    |b| {
                        b.set("AWAITING", flag(true));
                        status(b, "ST_FALLBACK");
                        status(b, "ST_AWAITING_ACK");
                    },
                    use_it,
                );
            } else {
                use_it(b);
            }
        },
        |b| {
            status(b, "ST_BAD_INPUT");
            b.either(
                x("BAD_COUNT").at_least(x("FAIL_HOLD")),
                |b| b.set("IN_FALLBACK", flag(true)),
                |b| b.set("BAD_COUNT", x("BAD_COUNT") + number(1)),
            );
            b.either(
                x("IN_FALLBACK"),
                |b| status(b, "ST_FALLBACK"),
                |b| {
                    b.set("HOLDING", flag(true));
                    status(b, "ST_HELD");
                },
            );
        },
    );
}

fn setpoint(b: &mut Builder) {
    b.note("set-point: local, or remote in Cascade; into its range, the last good one if not finite");
    b.set("SP_ASKED", x("SP"));
    b.when(x("MODE_ASKED").is(x("MODE_CAS")), |b| b.set("SP_ASKED", x("SP_REMOTE")));
    b.set("SP_FINITE", finite("SP_ASKED"));
    b.either(
        x("SP_FINITE"),
        |b| {
            b.either(
                x("SP_ASKED").above(x("SP_LIM_LO")).and(x("SP_ASKED").below(x("SP_LIM_HI"))),
                |b| b.set("R_ASKED", x("SP_ASKED")),
                |b| {
                    clamp(b, "R_ASKED", "SP_ASKED", "SP_LIM_LO", "SP_LIM_HI");
                    b.when(x("R_ASKED").is(x("SP_ASKED")).opposite(), |b| status(b, "ST_SP_LIMITED"));
                },
            );
        },
        |b| status(b, "ST_REJECTED"),
    );
}

fn offset(b: &mut Builder) {
    b.note("feed-forward: into its range, the last good one if not finite");
    b.set("FF_FINITE", finite("FF"));
    b.either(
        x("FF").at_least(x("FF_MIN")).and(x("FF").at_most(x("FF_MAX"))),
        |b| b.set("OFFSET", x("FF")),
        |b| {
            b.set("ACC_T", x("OFFSET"));
            b.either(x("FF_FINITE"), |b| b.set("ACC_T", x("FF")), |b| status(b, "ST_REJECTED"));
            clamp(b, "OFFSET", "ACC_T", "FF_MIN", "FF_MAX");
        },
    );
}

fn manual_and_track(b: &mut Builder) {
    b.note("manual and track outputs, into the output's range");
    b.set("MAN_FINITE", finite("OP_MAN"));
    clamp(b, "MAN_WITHIN", "OP_MAN", "OP_LIM_LO", "OP_LIM_HI");
    b.set("TRK_FINITE", finite("TRK_VALUE"));
    clamp(b, "TRK_WITHIN", "TRK_VALUE", "OP_LIM_LO", "OP_LIM_HI");
    let manual = x("MODE_ASKED").is(x("MODE_MAN")).and(x("MAN_FINITE").opposite());
    let track = x("MODE_ASKED").is(x("MODE_TRK")).and(x("TRK_FINITE").opposite());
    b.when(manual.or(track), |b| status(b, "ST_REJECTED"));
}

fn applied(b: &mut Builder) {
    b.note("output that was applied: the read-back, or the last output");
    b.set("APPLIED", x("U"));
    b.when(x("RB_USE"), |b| {
        b.either(
            finite("OP_READBACK"),
            |b| clamp(b, "APPLIED", "OP_READBACK", "OP_LIM_LO", "OP_LIM_HI"),
            |b| status(b, "ST_REJECTED"),
        );
    });
    b.note("the part of it that the law has moved");
    b.set("OWN", x("APPLIED") - x("OFFSET_BEFORE"));
}
