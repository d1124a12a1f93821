//! The variables of the block, with what they are.

use super::super::block::{Builder, Initial, Role, Type};
use super::outputs::ALARMS;
use super::plan::{Chains, Plan};
use super::tuning;
use controller_core::Status;

/// Bits that the core does not have, as the function block of the C interface shows them: refused parameters, lost memory.
const PAR_REFUSED: u32 = 1 << 26;
const STATE_LOST: u32 = 1 << 27;

/// The bits of the status word: name and number.
const BITS: [(&str, Status); 20] = [
    ("ST_LIMITED_HIGH", Status::LIMITED_HIGH),
    ("ST_LIMITED_LOW", Status::LIMITED_LOW),
    ("ST_RATE_LIMITED", Status::RATE_LIMITED),
    ("ST_SP_LIMITED", Status::SETPOINT_LIMITED),
    ("ST_SP_RAMPING", Status::SETPOINT_RAMPING),
    ("ST_BAD_INPUT", Status::BAD_INPUT),
    ("ST_UNCERTAIN", Status::UNCERTAIN),
    ("ST_HELD", Status::HELD),
    ("ST_FALLBACK", Status::FALLBACK),
    ("ST_AWAITING_ACK", Status::AWAITING_ACKNOWLEDGEMENT),
    ("ST_REJECTED", Status::REJECTED),
    ("ST_UNINITIALISED", Status::UNINITIALISED),
    ("ST_OVERRUN", Status::OVERRUN),
    ("ST_COMPENSATING", Status::COMPENSATING),
    ("ST_INHIBITED", Status::INHIBITED),
    ("ST_ALARM_HH", Status::ALARM_HI_HI),
    ("ST_ALARM_H", Status::ALARM_HI),
    ("ST_ALARM_L", Status::ALARM_LO),
    ("ST_ALARM_LL", Status::ALARM_LO_LO),
    ("ST_ALARM_DEV", Status::ALARM_DEVIATION),
];

/// Codes of the modes: what the output `MODE` shows.
const MODES: [(&str, i32, &str); 7] = [
    ("MODE_OFF", 1, "out of service"),
    ("MODE_MAN", 2, "manual"),
    ("MODE_AUTO", 3, "closed loop on SP"),
    ("MODE_CAS", 4, "closed loop on SP_REMOTE"),
    ("MODE_TRK", 5, "OP follows TRK_VALUE"),
    ("MODE_HOLD", 6, "OP stays"),
    ("MODE_FALLBACK", 7, "no good measurement"),
];
/// The code of hold.
const HOLD: i32 = 6;

/// Declares all variables.
pub(super) fn all(b: &mut Builder, plan: &Plan) {
    inputs(b, plan);
    outputs(b, plan);
    names(b, plan);
    numbers(b, plan);
    coefficients(b, plan);
    if let Some(chains) = &plan.compensator {
        compensator(b, chains);
    }
    if plan.tuning.is_some() {
        tuning::declare(b, plan);
    }
    state(b, plan);
    scratch(b, plan);
}

fn inputs(b: &mut Builder, plan: &Plan) {
    let mut real =
        |name: &str, comment: &str| b.declare(Role::Input, Type::Real, name, Initial::Zero, comment);
    real("SP", "Local set-point [PV unit]; moved into its limits");
    real("SP_REMOTE", "Set-point with CAS [PV unit]; moved into the limits");
    real("PV", "Measurement [PV unit]; outside PV_MIN to PV_MAX: bad");
    real("OP_MAN", "Output with MAN [OP unit]; moved into the limits");
    real("OP_READBACK", "What the actuator, or the inner loop, really took [OP unit]; counts with RB_USE");
    real("TRK_VALUE", "Output with TRK [OP unit]; moved into the limits");
    real("FF", "Feed-forward, added inside the limits [OP unit]; moved into FF_MIN to FF_MAX");
    let quality = "2 good, 1 uncertain (used, and shown), any other: bad";
    b.declare(Role::Input, Type::Count, "PV_QUALITY", Initial::Count(2), quality);
    let without = if plan.compensator.is_some() { "" } else { "; this loop has none" };
    for (name, initial, comment) in [
        ("OFF", false, "Out of service: OP goes to OFF_OP, or stays"),
        ("TRK", false, "OP follows TRK_VALUE"),
        ("MAN", false, "Manual: OP is OP_MAN"),
        ("HOLD", false, "OP stays"),
        ("CAS", false, "Closed loop on SP_REMOTE"),
        ("AUTO", true, "Closed loop on SP. None of the six: as with HOLD"),
        ("RB_USE", false, "OP_READBACK is valid"),
        ("INHIBIT_UP", false, "The integral term must not drive the output up"),
        ("INHIBIT_DN", false, "The integral term must not drive the output down"),
        ("ACK", false, "Lets a latched fallback end; clears the bit that says that the state was lost"),
        ("COMPENSATE", true, &format!("Use the compensator{without}")),
    ] {
        let initial = if initial { Initial::Flag(true) } else { Initial::Zero };
        b.declare(Role::Input, Type::Flag, name, initial, comment);
    }
    if let Some(tuning) = &plan.tuning {
        for (name, value) in tuning.inputs() {
            let comment = match name {
                "KP" => "Gain; only its size counts, the design gives the direction [OP unit / PV unit]",
                "TN" => "Reset time [s], above 0; 0: no integral action",
                "TV" => "Rate time [s], above 0, needs TF; 0: no derivative action",
                _ => "Filter time over all terms [s], at least TS/2; 0: no filter",
            };
            b.declare(Role::Input, Type::Real, name, Initial::Number(value), comment);
        }
    }
}

fn outputs(b: &mut Builder, plan: &Plan) {
    let mut output =
        |kind: Type, name: &str, comment: &str| b.declare(Role::Output, kind, name, Initial::Zero, comment);
    let without = if plan.compensator.is_some() { "" } else { "; this loop has no compensator" };
    for (name, comment) in [
        ("OP", "Output [OP unit], within its limits"),
        ("OP_UNLIM", "Output before the limits: not for an actuator [OP unit]"),
        ("PV_ENG", "The measurement that was used [PV unit]; while there is none, the last finite one"),
        ("SP_WORKING", "Working set-point [PV unit]"),
        ("DEV", "SP_WORKING - PV_ENG [PV unit]"),
        ("I_TERM", "Integral term [OP unit]"),
        ("PD_TERM", "Proportional and derivative terms, filtered [OP unit]"),
        ("UF", &format!("Output of the compensator, used or not [OP unit]{without}")),
        (
            "D_HAT",
            &format!("Estimated disturbance at the plant's input, relative to the start [OP unit]{without}"),
        ),
        ("BKCAL_OUT", "For a primary loop: its OP_READBACK and its TRK_VALUE [PV unit]"),
    ] {
        output(Type::Real, name, comment);
    }
    let modes = "Mode in force: 1 off, 2 manual, 3 automatic, 4 cascade, 5 track, 6 hold, 7 fallback";
    output(Type::Count, "MODE", modes);
    output(Type::Word, "STATUS", "What the block did: see EXPORTED.md");
    for (name, comment) in [
        ("IN_AUTO", "The loop is closed: Auto or Cascade"),
        ("IN_CAS", "The loop is closed on SP_REMOTE"),
        ("BLOCKED_UP", "A higher set-point cannot act: INHIBIT_UP of a primary loop"),
        ("BLOCKED_DN", "A lower set-point cannot act: INHIBIT_DN of a primary loop"),
    ] {
        output(Type::Flag, name, comment);
    }
    let configured = plan.alarms();
    for alarm in &ALARMS {
        let is = configured.iter().any(|(other, _)| other.active == alarm.active);
        let without = if is { "" } else { "; this loop has none" };
        output(Type::Flag, alarm.output, &format!("Alarm: {}{without}", alarm.what));
    }
}

fn names(b: &mut Builder, plan: &Plan) {
    for (name, mode, what) in MODES {
        b.declare(Role::Named, Type::Count, name, Initial::Count(mode), &format!("{mode}: {what}"));
    }
    for (name, quality) in [("Q_GOOD", 2), ("Q_UNCERTAIN", 1)] {
        let what = format!("{quality} at PV_QUALITY");
        b.declare(Role::Named, Type::Count, name, Initial::Count(quality), &what);
    }
    let hold = i32::from(plan.numbers.hold_samples);
    b.declare(Role::Named, Type::Count, "FAIL_HOLD", Initial::Count(hold), "bad samples that are held");
    b.declare(Role::Named, Type::Word, "ST_NONE", Initial::Word(0), "no bit");
    for (name, bit) in BITS {
        let what = Status::NAMES.iter().find(|(known, _)| *known == bit).map_or("", |(_, what)| what);
        let unused = if bit == Status::OVERRUN { ", never set by this block" } else { "" };
        let what = format!("bit {}: {what}{unused}", bit.bits().trailing_zeros());
        b.declare(Role::Named, Type::Word, name, Initial::Word(bit.bits()), &what);
    }
    let what = "bit 26: tuned values cannot be used, the old ones stay";
    b.declare(Role::Named, Type::Word, "ST_PAR_REFUSED", Initial::Word(PAR_REFUSED), what);
    let what = "bit 27: the memory was of another design, the loop has begun anew; until ACK";
    b.declare(Role::Named, Type::Word, "ST_STATE_LOST", Initial::Word(STATE_LOST), what);
}

fn numbers(b: &mut Builder, plan: &Plan) {
    let n = &plan.numbers;
    let smaller = |a: f64, b: f64| if a < b { a } else { b };
    let mut real = |name: &str, value: f64, comment: &str| {
        b.declare(Role::Constant, Type::Real, name, Initial::Number(value), comment);
    };
    real("ZERO", 0.0, "0");
    real("MINUS_ONE", -1.0, "-1");
    real("LARGEST", plan.largest, "largest finite number");
    real("MOST_NEGATIVE", -plan.largest, "smallest finite number");
    real("PV_MIN", n.measurement.0, "lowest valid measurement [PV unit]");
    real("PV_MAX", n.measurement.1, "highest valid measurement [PV unit]");
    real("SP_LIM_LO", n.setpoint.0, "lowest set-point [PV unit]");
    real("SP_LIM_HI", n.setpoint.1, "highest set-point [PV unit]");
    real("SP_STEP_UP", n.setpoint_steps.1, "longest rise of the set-point in a sample [PV unit]");
    real("SP_STEP_DOWN", -n.setpoint_steps.0, "longest fall of the set-point in a sample, below 0 [PV unit]");
    real("DEADBAND", n.deadband, "half width of the error deadband [PV unit]");
    real("DEADBAND_NEG", 0.0 - n.deadband, "its lower end [PV unit]");
    real("FF_MIN", n.offset.0, "lowest feed-forward [OP unit]");
    real("FF_MAX", n.offset.1, "highest feed-forward [OP unit]");
    real("OP_LIM_LO", n.output.0, "lowest output [OP unit]");
    real("OP_LIM_HI", n.output.1, "highest output [OP unit]");
    real("OP_STEP_UP", n.output_steps.1, "longest rise of the output in a sample [OP unit]");
    real("OP_STEP_DOWN", -n.output_steps.0, "longest fall of the output in a sample, below 0 [OP unit]");
    real("OP_INIT", n.initial_output, "output before the first sample [OP unit]");
    if let Some(output) = n.off_output {
        real("OFF_OP", output, "output in Off [OP unit]");
    }
    if let Some(output) = n.fallback_output {
        real("FAIL_OP", output, "output of the fallback [OP unit]");
    }
    if plan.slow_fallback() {
        let (down, up) = n.output_steps;
        real("FB_STEP_UP", smaller(n.fallback_step, up), "longest rise in a sample of a fallback [OP unit]");
        real(
            "FB_STEP_DOWN",
            -smaller(n.fallback_step, down),
            "longest fall in a sample of a fallback, below 0 [OP unit]",
        );
    }
    real("I_MAX", n.integral_bound, "bound of the integral term: nothing overflows [OP unit]");
    real("I_MIN", -n.integral_bound, "its lower end [OP unit]");
    for (alarm, [level, clears]) in plan.alarms() {
        real(alarm.level, level, &format!("alarm: {} [PV unit]", alarm.what));
        real(alarm.clears, clears, "where it goes again [PV unit]");
    }
}

fn coefficients(b: &mut Builder, plan: &Plan) {
    let p = &plan.pid;
    let list = [
        ("KI_NOW", p.ki_now, "weight of e[k] in the increment of the integral term [OP unit / PV unit]"),
        ("KI_BEFORE", p.ki_before, "weight of e[k-1] [OP unit / PV unit]"),
        ("G", p.g, "gain of the filter's lags"),
        ("P_R", p.p_r, "weight of the set-point's lag [OP unit / PV unit]"),
        ("H_R", p.h_r, "weight of the set-point's difference from its lag [OP unit / PV unit]"),
        ("P_Y", p.p_y, "weight of the measurement's lag [OP unit / PV unit]"),
        ("H_Y", p.h_y, "weight of the measurement's difference from its lag [OP unit / PV unit]"),
        ("AW_GAIN", plan.numbers.anti_windup_gain, "anti-windup: min(1, TS/TT), 0 under another rule"),
    ];
    for (name, value, comment) in list {
        b.declare(Role::Coefficient, Type::Real, name, Initial::Number(value), comment);
    }
    if plan.conditional() {
        let value = if plan.numbers.conditional { Initial::Flag(true) } else { Initial::Zero };
        let comment = "anti-windup: increments may be taken back; there is integral action";
        b.declare(Role::Coefficient, Type::Flag, "AW_TAKES_BACK", value, comment);
    }
    if plan.turns() {
        let comment = "OP falls when the set-point rises";
        b.declare(Role::Coefficient, Type::Flag, "REVERSED", Initial::Flag(plan.numbers.reversed), comment);
    }
}

fn compensator(b: &mut Builder, chains: &Chains) {
    let mut real = |name: &str, value: f64, comment: &str| {
        b.declare(Role::Constant, Type::Real, name, Initial::Number(value), comment);
    };
    let order = chains.g.len();
    for at in 0..order {
        let n = at + 1;
        let value = |list: &[f64]| list.get(at).copied().unwrap_or_default();
        real(&format!("CG{n}"), value(&chains.g), "compensator: gain of lag");
        real(
            &format!("EU{n}"),
            value(&chains.u_lead),
            "compensator: weight of a difference in the chain of outputs",
        );
        real(
            &format!("EY{n}"),
            value(&chains.y_lead),
            "compensator: weight of a difference in the chain of PV",
        );
        // Two lags make a section: the first feeds the second, the last has the static gain.
        if n % 2 == 1 && n < order {
            real(
                &format!("FY{n}"),
                value(&chains.y_feed),
                "compensator: share of a difference fed to the next lag",
            );
        }
        if n % 2 == 0 || n == order {
            real(&format!("DC{n}"), value(&chains.y_dc), "compensator: static gain of a section");
        }
    }
    for (at, (gain, half)) in chains.e_gain.iter().zip(&chains.e_half).enumerate() {
        real(&format!("EG{}", at + 1), *gain, "compensator: gain of a lag that both chains share");
        real(&format!("EH{}", at + 1), *half, "compensator: half of it");
    }
    real("INV_GAIN", chains.inv_gain, "compensator: 1/K of the model [OP unit / PV unit]");
    real("COMP_GAIN", chains.gain, "compensator: share of the disturbance that is fed back");
}

fn state(b: &mut Builder, plan: &Plan) {
    let mut real =
        |name: &str, comment: &str| b.declare(Role::State, Type::Real, name, Initial::Zero, comment);
    for (name, comment) in [
        ("I_SUM", "integral term [OP unit]"),
        ("W_R", "lag of the set-point [PV unit]"),
        ("W_Y", "lag of the measurement [PV unit]"),
        ("U", "last output [OP unit]"),
        ("SPW", "working set-point [PV unit]"),
    ] {
        real(name, comment);
        real(&format!("{name}_C"), "what rounding has left over of it");
    }
    real("R_LAST", "set-point that the PID saw [PV unit]");
    real("Y_LAST", "measurement that the PID saw [PV unit]");
    real("INC", "last increment of the integral term [OP unit]");
    real("V", "last output before the limits [OP unit]");
    real("PD", "last filtered terms [OP unit]");
    real("U_F", "last output of the compensator that was in use [OP unit]");
    real("Y", "last good measurement [PV unit]");
    real("R_ASKED", "last usable set-point [PV unit]");
    real("OFFSET", "last usable feed-forward [OP unit]");
    if let Some(chains) = &plan.compensator {
        for chain in ["WU", "WY"] {
            for n in 1..=chains.g.len() {
                real(&format!("{chain}{n}"), "lag of the compensator");
                real(&format!("{chain}{n}_C"), "what rounding has left over of it");
            }
        }
        for n in 1..=chains.e_gain.len() {
            real(&format!("WE{n}"), "shared lag of the compensator");
            real(&format!("WE{n}_C"), "what rounding has left over of it");
        }
        real("EST_0", "estimate at the point of initialisation [OP unit]");
        let cells = Some(chains.capacity);
        b.declare_array(Role::State, Type::Real, "DELAY", cells, Initial::Zero, "applied outputs [OP unit]");
        b.declare(Role::State, Type::Count, "NEWEST", Initial::Zero, "cell of the newest one");
        b.declare(Role::State, Type::Flag, "COMPENSATING", Initial::Zero, "the compensator was in use");
    }
    let hold = Initial::Count(HOLD);
    b.declare(Role::State, Type::Count, "MODE_ASKED", hold.clone(), "last mode asked for");
    b.declare(Role::State, Type::Count, "MODE_LAST", hold, "last mode in force");
    b.declare(Role::State, Type::Count, "BAD_COUNT", Initial::Zero, "bad samples in a row");
    let mut flag =
        |name: &str, comment: &str| b.declare(Role::State, Type::Flag, name, Initial::Zero, comment);
    flag("IN_FALLBACK", "the fallback is in force");
    flag("STARTED", "a good sample was taken");
    flag("STATE_LOST", "the memory was of another design, and nobody has acknowledged it");
    for (alarm, _) in plan.alarms() {
        flag(alarm.active, alarm.what);
    }
    if let Some(tuning) = &plan.tuning {
        for (name, value) in tuning.inputs() {
            let value = Initial::Number(value);
            let mut real = |end: &str, comment: &str| {
                b.declare(Role::State, Type::Real, &format!("{name}_{end}"), value.clone(), comment);
            };
            real("TAKEN", "value in use");
            real("BEFORE", "value at the input that counts as that of the design");
        }
    }
}

fn scratch(b: &mut Builder, plan: &Plan) {
    let mut of = |kind: Type, names: &[&str]| {
        for name in names {
            b.declare(Role::Scratch, kind, name, Initial::Zero, "");
        }
    };
    of(
        Type::Real,
        &["ACC_T", "ACC_S", "WAY", "ERR", "OFFSET_BEFORE", "SP_ASKED", "MAN_WITHIN", "TRK_WITHIN"],
    );
    of(Type::Real, &["APPLIED", "OWN", "TARGET", "WANTED", "U_LIMITED", "STEP_UP", "STEP_DOWN", "R_TO"]);
    of(Type::Real, &["SUM", "SUM_C", "V_BEGIN", "I_BEGIN", "INC_BEGIN", "PREVIEW", "CORRECTION", "Y_SEEN"]);
    of(Type::Real, &["INC_ASKED", "INC_ALLOWED"]);
    of(Type::Flag, &["USABLE", "RESETTLE", "HOLDING", "AWAITING", "GOOD", "SP_FINITE", "FF_FINITE"]);
    of(
        Type::Flag,
        &["LOST", "MAN_FINITE", "TRK_FINITE", "TARGET_GIVEN", "RATE_HELD", "HELD_NOW", "CLOSED", "BEGINS"],
    );
    of(Type::Count, &["MODE_DUE", "MODE_NOW", "MODE_WAS"]);
    if !plan.alarms().is_empty() {
        of(Type::Real, &["RELEASE"]);
    }
    if plan.compensator.is_some() {
        of(Type::Real, &["CX", "DIFF", "BEFORE", "FROM_U", "FROM_Y", "EST", "DH", "UF_NEW", "U_DELAYED"]);
        of(Type::Count, &["CELL"]);
    }
    if plan.compensator.as_ref().is_some_and(|chains| chains.g.len() > 1) {
        of(Type::Real, &["DIFF2"]);
    }
    if let Some(tuning) = &plan.tuning {
        for (name, _) in tuning.inputs() {
            of(Type::Flag, &[&format!("{name}_UNTUNED")]);
            of(Type::Real, &[&format!("{name}_ASKED")]);
        }
        of(Type::Flag, &["PAR_OK", "PAR_CHANGED", "PAR_REFUSED"]);
        of(Type::Real, &["OWED", "PREVIEW_NEW", "JUMP", "ROUNDED"]);
        of(Type::Long, &["L_KP", "L_KI", "L_KD", "L_TV", "L_TF", "L_G", "L_P", "L_Q", "L_H", "L_SIZE"]);
        of(Type::Long, &["L_VALUE"]);
        of(Type::Long, &["L_TN"]);
        if plan.tracking() == Some(None) {
            of(Type::Long, &["L_TT"]);
        }
        for name in plan.tuned() {
            let kind = if matches!(name, "AW_TAKES_BACK" | "REVERSED") { Type::Flag } else { Type::Real };
            of(kind, &[&format!("N_{name}")]);
        }
    }
}
