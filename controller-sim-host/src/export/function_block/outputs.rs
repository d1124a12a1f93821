//! Alarms, status and outputs at the end of a sample.

use super::super::block::{Builder, Expression, x};
use super::modes::automatic;
use super::parts::{finite, status};
use super::plan::Plan;

/// An alarm: the output that shows it, its flag, its status bit, the constants of its level and of where it clears.
pub(super) struct Alarm {
    pub(super) output: &'static str,
    pub(super) active: &'static str,
    pub(super) bit: &'static str,
    pub(super) level: &'static str,
    pub(super) clears: &'static str,
    pub(super) what: &'static str,
    /// The sign with which the signal is compared.
    pub(super) low: bool,
}

/// In the order of the levels.
pub(super) const ALARMS: [Alarm; 5] = [
    Alarm {
        output: "HH_ALM",
        active: "HH_ACTIVE",
        bit: "ST_ALARM_HH",
        level: "HH_LIM",
        clears: "HH_CLEAR",
        what: "measurement very high",
        low: false,
    },
    Alarm {
        output: "H_ALM",
        active: "H_ACTIVE",
        bit: "ST_ALARM_H",
        level: "H_LIM",
        clears: "H_CLEAR",
        what: "measurement high",
        low: false,
    },
    Alarm {
        output: "L_ALM",
        active: "L_ACTIVE",
        bit: "ST_ALARM_L",
        level: "L_LIM",
        clears: "L_CLEAR",
        what: "measurement low",
        low: true,
    },
    Alarm {
        output: "LL_ALM",
        active: "LL_ACTIVE",
        bit: "ST_ALARM_LL",
        level: "LL_LIM",
        clears: "LL_CLEAR",
        what: "measurement very low",
        low: true,
    },
    Alarm {
        output: "DEV_ALM",
        active: "DEV_ACTIVE",
        bit: "ST_ALARM_DEV",
        level: "DEV_LIM",
        clears: "DEV_CLEAR",
        what: "deviation",
        low: false,
    },
];

/// Alarms on `PV` and on the deviation, when the measurement is good.
pub(super) fn alarms(b: &mut Builder, plan: &Plan) {
    if plan.alarms().is_empty() {
        return;
    }
    b.note("alarms: one comes beyond its level and goes behind level and hysteresis");
    b.when(x("USABLE").or(x("AWAITING")), |b| {
        b.set("ERR", x("SPW") - x("Y"));
        b.when(x("ERR").below(x("ZERO")), |b| b.set("ERR", -x("ERR")));
        for (alarm, _) in plan.alarms() {
            let signal = if alarm.bit == "ST_ALARM_DEV" { "ERR" } else { "Y" };
            b.set("RELEASE", x(alarm.level));
            b.when(x(alarm.active), |b| b.set("RELEASE", x(alarm.clears)));
            let (signal, release) = (x(signal), x("RELEASE"));
            b.set(alarm.active, if alarm.low { signal.below(release) } else { signal.above(release) });
        }
    });
}

/// The bits that every sample of a loop at work ends with.
pub(super) fn last_bits(b: &mut Builder, plan: &Plan) {
    if plan.compensator.is_some() {
        b.when(x("COMPENSATE").and(automatic("MODE_NOW")), |b| status(b, "ST_COMPENSATING"));
    }
    b.when(x("SPW").is(x("R_ASKED")).opposite(), |b| status(b, "ST_SP_RAMPING"));
    for (alarm, _) in plan.alarms() {
        b.when(x(alarm.active), |b| status(b, alarm.bit));
    }
}

/// What the caller reads.
pub(super) fn write(b: &mut Builder, plan: &Plan) {
    b.note("outputs");
    b.set("OP", x("U"));
    b.set("OP_UNLIM", x("V"));
    b.when(finite("PV"), |b| b.set("PV_ENG", x("PV")));
    b.set("SP_WORKING", x("SPW"));
    b.set("DEV", x("SPW") - x("PV_ENG"));
    b.set("I_TERM", x("I_SUM"));
    b.set("PD_TERM", x("PD"));
    let (u_f, d_hat) = if plan.compensator.is_some() { ("UF_NEW", "DH") } else { ("ZERO", "ZERO") };
    b.set("UF", x(u_f));
    b.set("D_HAT", x(d_hat));
    b.set("BKCAL_OUT", x("SPW"));
    b.set("MODE", x("MODE_LAST"));
    b.set("IN_AUTO", automatic("MODE_LAST"));
    b.set("IN_CAS", x("MODE_LAST").is(x("MODE_CAS")));
    b.note("for a primary loop: whether another set-point can act");
    let blocked = |b: &mut Builder, reversed: bool| {
        let (full, empty) = (x("U_LIMITED").at_least(x("OP_LIM_HI")), x("U_LIMITED").at_most(x("OP_LIM_LO")));
        let (up, down) = if reversed { (empty, full) } else { (full, empty) };
        b.set("BLOCKED_UP", up.or(x("SPW").at_least(x("SP_LIM_HI"))));
        b.set("BLOCKED_DN", down.or(x("SPW").at_most(x("SP_LIM_LO"))));
    };
    if plan.turns() {
        b.either(x("REVERSED"), |b| blocked(b, true), |b| blocked(b, false));
    } else {
        blocked(b, plan.numbers.reversed);
    }
    let configured = plan.alarms();
    for alarm in &ALARMS {
        let is = configured.iter().any(|(other, _)| other.active == alarm.active);
        b.set(alarm.output, if is { x(alarm.active) } else { Expression::Flag(false) });
    }
}
