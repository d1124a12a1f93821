//! The variables of the block, with what they are.

use super::super::block::{Builder, Initial, Role, Type};
use super::plan::{Chains, Plan};
use super::tuning;
use controller_core::{Mode, Quality, Status};

/// Bit of a refused parameter: the core has no such bit, its laws cannot be built from one.
const PAR_REFUSED: u32 = 1 << 26;

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
    ("ST_ALARM_HI_HI", Status::ALARM_HI_HI),
    ("ST_ALARM_HI", Status::ALARM_HI),
    ("ST_ALARM_LO", Status::ALARM_LO),
    ("ST_ALARM_LO_LO", Status::ALARM_LO_LO),
    ("ST_ALARM_DEV", Status::ALARM_DEVIATION),
];

const MODES: [(&str, Mode, &str); 7] = [
    ("MODE_OFF", Mode::Off, "out of service"),
    ("MODE_MAN", Mode::Manual, "the operator gives the output"),
    ("MODE_AUTO", Mode::Auto, "closed on the local set-point"),
    ("MODE_CAS", Mode::Cascade, "closed on the remote set-point"),
    ("MODE_TRK", Mode::Track, "another block gives the output"),
    ("MODE_HOLD", Mode::Hold, "the output stays"),
    ("MODE_FALLBACK", Mode::Fallback, "no good measurement; asked for, it means Hold"),
];

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
    real("SP", "set-point [y]");
    real("SP_CAS", "remote set-point, used in Cascade [y]");
    real("PV", "measurement [y]");
    let count = |b: &mut Builder, name: &str, initial: i32, comment: &str| {
        b.declare(Role::Input, Type::Count, name, Initial::Count(initial), comment);
    };
    count(b, "PV_QUALITY", 0, "0 good, 1 uncertain, anything else bad");
    count(b, "MODE", 2, "0 Off, 1 Manual, 2 Auto, 3 Cascade, 4 Track, 5 Hold");
    b.declare(Role::Input, Type::Real, "MAN", Initial::Zero, "output in Manual [u]");
    let flag = |b: &mut Builder, name: &str, initial: bool, comment: &str| {
        b.declare(Role::Input, Type::Flag, name, Initial::Flag(initial), comment);
    };
    flag(b, "MAN_ON", true, "use MAN; otherwise the output stays in Manual");
    b.declare(Role::Input, Type::Real, "TRK", Initial::Zero, "output in Track [u]");
    b.declare(Role::Input, Type::Real, "FF", Initial::Zero, "feed-forward, added inside the limits [u]");
    b.declare(Role::Input, Type::Real, "BKCAL_IN", Initial::Zero, "read-back: output really applied [u]");
    flag(b, "BKCAL_ON", false, "use BKCAL_IN");
    if plan.compensator.is_some() {
        flag(b, "COMP_ON", true, "use the disturbance compensator");
    }
    flag(b, "INHIBIT_UP", false, "the integral term must not rise");
    flag(b, "INHIBIT_DOWN", false, "the integral term must not fall");
    flag(b, "ACK", false, "lets a latched fallback end");
    if let Some(tuning) = &plan.tuning {
        let mut real = |name: &str, value: f64, comment: &str| {
            b.declare(Role::Input, Type::Real, name, Initial::Number(value), comment);
        };
        real("KP", tuning.kp, "proportional gain; keeps its sign [u/y]");
        if let Some(tn) = tuning.tn {
            real("TN", tn, "integral time, above 0 [s]");
        }
        real("TV", tuning.tv, "derivative time, 0 or more; needs TF [s]");
        real("TF", tuning.tf, "filter time, 0 or at least TS/2 [s]");
    }
}

fn outputs(b: &mut Builder, plan: &Plan) {
    let mut real =
        |name: &str, comment: &str| b.declare(Role::Output, Type::Real, name, Initial::Zero, comment);
    real("OP", "output, limited [u]");
    real("OP_UNLIM", "output before the limits: not for an actuator [u]");
    real("I_TERM", "integral term [u]");
    real("PD_TERM", "filtered proportional and derivative terms [u]");
    if plan.compensator.is_some() {
        real("COMP_OUT", "output of the compensator, used or not [u]");
        real("D_HAT", "estimated disturbance at the plant input [u]");
    }
    real("SP_WORK", "working set-point [y]");
    real("BKCAL_OUT", "for a primary loop: its BKCAL_IN [y]");
    b.declare(
        Role::Output,
        Type::Flag,
        "BLOCKED_UP",
        Initial::Zero,
        "a higher set-point cannot act: INHIBIT_UP of a primary",
    );
    b.declare(
        Role::Output,
        Type::Flag,
        "BLOCKED_DOWN",
        Initial::Zero,
        "a lower set-point cannot act: INHIBIT_DOWN of a primary",
    );
    b.declare(Role::Output, Type::Count, "MODE_ACT", Initial::Zero, "mode in force; 6: fallback");
    b.declare(Role::Output, Type::Word, "STATUS", Initial::Zero, "status bits, see ST_...");
}

fn names(b: &mut Builder, plan: &Plan) {
    for (name, mode, what) in MODES {
        b.declare(Role::Named, Type::Count, name, Initial::Count(i32::from(mode as u8)), what);
    }
    for (name, quality) in [("Q_GOOD", Quality::Good), ("Q_UNCERTAIN", Quality::Uncertain)] {
        b.declare(Role::Named, Type::Count, name, Initial::Count(i32::from(quality as u8)), "PV_QUALITY");
    }
    let hold = i32::from(plan.numbers.hold_samples);
    b.declare(Role::Named, Type::Count, "HOLD_SAMPLES", Initial::Count(hold), "bad samples that are held");
    b.declare(Role::Named, Type::Word, "ST_NONE", Initial::Word(0), "no bit");
    for (name, bit) in BITS {
        let what = Status::NAMES.iter().find(|(known, _)| *known == bit).map_or("", |(_, what)| what);
        let unused = if bit == Status::OVERRUN { ", never set by this block" } else { "" };
        let what = format!("bit {}: {what}{unused}", bit.bits().trailing_zeros());
        b.declare(Role::Named, Type::Word, name, Initial::Word(bit.bits()), &what);
    }
    let what = "bit 26: tuned values cannot be used, the old ones stay";
    b.declare(Role::Named, Type::Word, "ST_PAR_REFUSED", Initial::Word(PAR_REFUSED), what);
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
    real("PV_LO", n.measurement.0, "lowest valid measurement [y]");
    real("PV_HI", n.measurement.1, "highest valid measurement [y]");
    real("SP_LO", n.setpoint.0, "lowest set-point [y]");
    real("SP_HI", n.setpoint.1, "highest set-point [y]");
    real("SP_STEP_UP", n.setpoint_steps.1, "longest rise of the set-point in a sample [y]");
    real("SP_STEP_DOWN", -n.setpoint_steps.0, "longest fall of the set-point in a sample, below 0 [y]");
    real("DEADBAND", n.deadband, "half width of the error deadband [y]");
    real("DEADBAND_NEG", 0.0 - n.deadband, "its lower end [y]");
    real("FF_LO", n.offset.0, "lowest feed-forward [u]");
    real("FF_HI", n.offset.1, "highest feed-forward [u]");
    real("OP_LO", n.output.0, "lowest output [u]");
    real("OP_HI", n.output.1, "highest output [u]");
    real("OP_STEP_UP", n.output_steps.1, "longest rise of the output in a sample [u]");
    real("OP_STEP_DOWN", -n.output_steps.0, "longest fall of the output in a sample, below 0 [u]");
    real("OP_INITIAL", n.initial_output, "output before the first sample [u]");
    if let Some(output) = n.off_output {
        real("OP_OFF", output, "output in Off [u]");
    }
    if let Some(output) = n.fallback_output {
        real("OP_FALLBACK", output, "output of the fallback [u]");
    }
    if plan.slow_fallback() {
        let (down, up) = n.output_steps;
        real("FB_STEP_UP", smaller(n.fallback_step, up), "longest rise in a sample of a fallback [u]");
        real(
            "FB_STEP_DOWN",
            -smaller(n.fallback_step, down),
            "longest fall in a sample of a fallback, below 0 [u]",
        );
    }
    real("I_MAX", n.integral_bound, "bound of the integral term: nothing overflows [u]");
    real("I_MIN", -n.integral_bound, "its lower end [u]");
    for (alarm, [level, clears]) in plan.alarms() {
        real(alarm.level, level, &format!("alarm: {} [y]", alarm.what));
        real(alarm.clears, clears, "where it goes again [y]");
    }
}

fn coefficients(b: &mut Builder, plan: &Plan) {
    let p = &plan.pid;
    let list = [
        ("KI_NOW", p.ki_now, "weight of e[k] in the increment of the integral term [u/y]"),
        ("KI_BEFORE", p.ki_before, "weight of e[k-1] [u/y]"),
        ("G", p.g, "gain of the filter's lags"),
        ("P_R", p.p_r, "weight of the set-point's lag [u/y]"),
        ("H_R", p.h_r, "weight of the set-point's difference from its lag [u/y]"),
        ("P_Y", p.p_y, "weight of the measurement's lag [u/y]"),
        ("H_Y", p.h_y, "weight of the measurement's difference from its lag [u/y]"),
        ("AW_GAIN", plan.numbers.anti_windup_gain, "anti-windup: min(1, TS/TT), 0 under another rule"),
    ];
    for (name, value, comment) in list {
        b.declare(Role::Coefficient, Type::Real, name, Initial::Number(value), comment);
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
    real("INV_GAIN", chains.inv_gain, "compensator: 1/K of the model [u/y]");
    real("COMP_GAIN", chains.gain, "compensator: share of the disturbance that is fed back");
    let mut count = |name: &str, value: usize, comment: &str| {
        let value = i32::try_from(value).unwrap_or(i32::MAX);
        b.declare(Role::Named, Type::Count, name, Initial::Count(value), comment);
    };
    count("CELLS", chains.capacity, "cells of the delay line");
    count("LAST_CELL", chains.capacity.saturating_sub(1), "index of the last one");
    count("DELAY_SAMPLES", chains.delay, "samples of delay");
    if chains.delay > 0 {
        count("DELAY_LESS_ONE", chains.delay - 1, "one less");
    }
}

fn state(b: &mut Builder, plan: &Plan) {
    let mut real =
        |name: &str, comment: &str| b.declare(Role::State, Type::Real, name, Initial::Zero, comment);
    for (name, comment) in [
        ("I_SUM", "integral term [u]"),
        ("W_R", "lag of the set-point [y]"),
        ("W_Y", "lag of the measurement [y]"),
        ("U", "last output [u]"),
        ("SPW", "working set-point [y]"),
    ] {
        real(name, comment);
        real(&format!("{name}_C"), "what rounding has left over of it");
    }
    real("R_LAST", "set-point that the PID saw [y]");
    real("Y_LAST", "measurement that the PID saw [y]");
    real("INC", "last increment of the integral term [u]");
    real("V", "last output before the limits [u]");
    real("PD", "last filtered terms [u]");
    real("U_F", "last output of the compensator that was in use [u]");
    real("Y", "last good measurement [y]");
    real("R_ASKED", "last usable set-point [y]");
    real("OFFSET", "last usable feed-forward [u]");
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
        real("EST_0", "estimate at the point of initialisation [u]");
        let cells = Some(chains.capacity);
        b.declare_array(Role::State, Type::Real, "DELAY", cells, Initial::Zero, "applied outputs [u]");
        b.declare(Role::State, Type::Count, "NEWEST", Initial::Zero, "cell of the newest one");
        b.declare(Role::State, Type::Flag, "COMPENSATING", Initial::Zero, "the compensator was in use");
    }
    let hold = Initial::Count(i32::from(Mode::Hold as u8));
    b.declare(Role::State, Type::Count, "MODE_ASKED", hold.clone(), "last mode asked for");
    b.declare(Role::State, Type::Count, "MODE_LAST", hold, "last mode in force");
    b.declare(Role::State, Type::Count, "BAD_COUNT", Initial::Zero, "bad samples in a row");
    let mut flag =
        |name: &str, comment: &str| b.declare(Role::State, Type::Flag, name, Initial::Zero, comment);
    flag("IN_FALLBACK", "the fallback is in force");
    flag("AWAKE", "a sample was taken");
    flag("STARTED", "a good sample was taken");
    for (alarm, _) in plan.alarms() {
        flag(alarm.active, alarm.what);
    }
    if let Some(tuning) = &plan.tuning {
        let values =
            [("KP", Some(tuning.kp)), ("TN", tuning.tn), ("TV", Some(tuning.tv)), ("TF", Some(tuning.tf))];
        for (name, value) in values {
            if let Some(value) = value {
                let name = format!("{name}_TAKEN");
                b.declare(Role::State, Type::Real, &name, Initial::Number(value), "value in use");
            }
        }
    }
}

fn scratch(b: &mut Builder, plan: &Plan) {
    let mut of = |kind: Type, names: &[&str]| {
        for name in names {
            b.declare(Role::Scratch, kind, name, Initial::Zero, "");
        }
    };
    of(Type::Real, &["ACC_T", "ACC_S", "WAY", "ERR", "OFFSET_BEFORE", "SP_ASKED", "MAN_OP", "TRK_OP"]);
    of(Type::Real, &["APPLIED", "OWN", "TARGET", "WANTED", "U_LIMITED", "STEP_UP", "STEP_DOWN", "R_TO"]);
    of(Type::Real, &["SUM", "SUM_C", "V_BEGIN", "I_BEGIN", "INC_BEGIN", "PREVIEW", "CORRECTION", "Y_SEEN"]);
    of(Type::Real, &["INC_ASKED", "INC_ALLOWED"]);
    of(Type::Flag, &["USABLE", "RESETTLE", "HOLDING", "AWAITING", "GOOD", "SP_FINITE", "FF_FINITE"]);
    of(
        Type::Flag,
        &["MAN_FINITE", "TRK_FINITE", "TARGET_GIVEN", "RATE_HELD", "HELD_NOW", "CLOSED", "BEGINS"],
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
    if plan.tuning.is_some() {
        of(Type::Flag, &["PAR_OK", "PAR_CHANGED", "PAR_REFUSED"]);
        of(Type::Real, &["OWED", "PREVIEW_NEW", "JUMP", "ROUNDED"]);
        of(Type::Long, &["L_KP", "L_KI", "L_KD", "L_TV", "L_TF", "L_G", "L_P", "L_Q", "L_H", "L_SIZE"]);
        of(Type::Long, &["L_VALUE"]);
        if plan.config.pid.ki != 0.0 {
            of(Type::Long, &["L_TN"]);
        }
        if plan.tuned().contains(&"AW_GAIN") {
            of(Type::Long, &["L_TT"]);
        }
        let new: Vec<String> = plan.tuned().iter().map(|name| format!("N_{name}")).collect();
        of(Type::Real, &new.iter().map(String::as_str).collect::<Vec<_>>());
    }
}
