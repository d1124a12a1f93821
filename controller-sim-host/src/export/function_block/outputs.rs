//! Alarms, status and outputs at the end of a sample.

use super::super::block::{Builder, x};
use super::modes::automatic;
use super::parts::status;
use super::plan::Plan;

/// An alarm: its flag, its status bit, the constants of its level and of where it clears.
pub(super) struct Alarm {
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
        active: "ALM_HI_HI",
        bit: "ST_ALARM_HI_HI",
        level: "HI_HI",
        clears: "HI_HI_CLEAR",
        what: "PV very high",
        low: false,
    },
    Alarm {
        active: "ALM_HI",
        bit: "ST_ALARM_HI",
        level: "HI",
        clears: "HI_CLEAR",
        what: "PV high",
        low: false,
    },
    Alarm {
        active: "ALM_LO",
        bit: "ST_ALARM_LO",
        level: "LO",
        clears: "LO_CLEAR",
        what: "PV low",
        low: true,
    },
    Alarm {
        active: "ALM_LO_LO",
        bit: "ST_ALARM_LO_LO",
        level: "LO_LO",
        clears: "LO_LO_CLEAR",
        what: "PV very low",
        low: true,
    },
    Alarm {
        active: "ALM_DEV",
        bit: "ST_ALARM_DEV",
        level: "DEV",
        clears: "DEV_CLEAR",
        what: "deviation of PV from the working set-point",
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
        b.when(x("COMP_ON").and(automatic("MODE_NOW")), |b| status(b, "ST_COMPENSATING"));
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
    b.set("I_TERM", x("I_SUM"));
    b.set("PD_TERM", x("PD"));
    if plan.compensator.is_some() {
        b.set("COMP_OUT", x("UF_NEW"));
        b.set("D_HAT", x("DH"));
    }
    b.set("SP_WORK", x("SPW"));
    b.set("BKCAL_OUT", x("SPW"));
    b.set("MODE_ACT", x("MODE_LAST"));
    b.note("for a primary loop: whether another set-point can act");
    let (at_top, at_bottom) = if plan.numbers.reversed {
        (x("U_LIMITED").at_most(x("OP_LO")), x("U_LIMITED").at_least(x("OP_HI")))
    } else {
        (x("U_LIMITED").at_least(x("OP_HI")), x("U_LIMITED").at_most(x("OP_LO")))
    };
    b.set("BLOCKED_UP", at_top.or(x("SPW").at_least(x("SP_HI"))));
    b.set("BLOCKED_DOWN", at_bottom.or(x("SPW").at_most(x("SP_LO"))));
}
