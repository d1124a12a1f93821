//! The PID: difference equation, start, anti-windup.

use super::super::block::{Builder, Expression, x};
use super::parts::{add, clamp, restart};
use super::plan::Plan;

/// `(P_B*w_r + H_R*(r - w_r)) - (P_Y*w_y + H_Y*(y - w_y))` for the inputs `r` and `y`.
fn filtered(r: &str, y: &str) -> Expression {
    (x("P_R") * x("W_R") + x("H_R") * (x(r) - x("W_R")))
        - (x("P_Y") * x("W_Y") + x("H_Y") * (x(y) - x("W_Y")))
}

/// What the filtered terms would be, without moving the lags.
pub(super) fn preview(b: &mut Builder, to: &str, r: &str, y: &str) {
    b.set(to, filtered(r, y));
}

/// The filtered terms of this sample; moves the lags.
pub(super) fn filter(b: &mut Builder, r: &str, y: &str) {
    b.note("pd = P_R*w_r + H_R*(r - w_r) - P_Y*w_y - H_Y*(y - w_y)");
    b.set("PD", filtered(r, y));
    b.note("w_r <- w_r + G*(r - w_r), w_y likewise; every added number keeps its rounding error");
    for (lag, carry, input) in [("W_R", "W_R_C", r), ("W_Y", "W_Y_C", y)] {
        add(b, lag, carry, x("G") * (x(input) - x(lag)));
    }
    b.set("R_LAST", x(r));
    b.set("Y_LAST", x(y));
}

/// The increment of the integral term for the inputs `r` and `y`: `KI_NOW*e[k] + KI_BEFORE*e[k-1]`.
pub(super) fn increment(b: &mut Builder, to: &str, r: &str, y: &str) {
    b.set(to, x("KI_NOW") * (x(r) - x(y)) + x("KI_BEFORE") * (x("R_LAST") - x("Y_LAST")));
}

/// What a secondary loop lets through of the increment `from`.
pub(super) fn allowed(b: &mut Builder, to: &str, from: &str) {
    b.set(to, x(from));
    let up = x("INHIBIT_UP").and(x(from).above(x("ZERO")));
    let down = x("INHIBIT_DN").and(x(from).below(x("ZERO")));
    b.when(up.or(down), |b| b.set(to, x("ZERO")));
}

/// The correction of the anti-windup for the sample before, `applied` being the output that was applied.
pub(super) fn unwind(b: &mut Builder, plan: &Plan, to: &str, applied: &str) {
    let track = |b: &mut Builder| b.set(to, x("AW_GAIN") * (x(applied) - x("V")));
    if plan.conditional() {
        b.note("anti-windup: the last increment is taken back when it drove further into the limit");
        let up = x("V").above(x(applied)).and(x("INC").above(x("ZERO")));
        let down = x("V").below(x(applied)).and(x("INC").below(x("ZERO")));
        b.either(x("AW_TAKES_BACK").and(up.or(down)), |b| b.set(to, -x("INC")), track);
    } else {
        b.note("anti-windup: min(1, TS/TT)*(applied - wanted) of the last sample");
        track(b);
    }
}

/// Everything at rest at `r` and `y` with the output `u`.
pub(super) fn settle(b: &mut Builder, r: &str, y: &str, u: &str) {
    b.note("PID at rest: I = u - (P_R*r - P_Y*y)");
    restart(b, "I_SUM", "I_SUM_C", x(u) - (x("P_R") * x(r) - x("P_Y") * x(y)));
    restart(b, "W_R", "W_R_C", x(r));
    restart(b, "W_Y", "W_Y_C", x(y));
    b.set("R_LAST", x(r));
    b.set("Y_LAST", x(y));
    b.set("INC", x("ZERO"));
}

/// Keeps the integral term where nothing can overflow.
pub(super) fn bound(b: &mut Builder) {
    b.when(x("I_SUM").at_least(x("I_MIN")).and(x("I_SUM").at_most(x("I_MAX"))).opposite(), |b| {
        clamp(b, "ACC_S", "I_SUM", "I_MIN", "I_MAX");
        restart(b, "I_SUM", "I_SUM_C", x("ACC_S"));
    });
}
