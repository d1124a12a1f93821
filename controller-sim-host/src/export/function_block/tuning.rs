//! Tuning on site: other values of KP, TN, TV, TF become coefficients, taken over without a bump.

use super::super::block::{Builder, Expression, Initial, Role, Type, x};
use super::parts::{add, deadband, finite, long, status};
use super::plan::{Plan, Tuning};
use super::{anew, compensator, law};

/// At the start of a sample: judges the inputs, rebuilds the coefficients when they have changed.
pub(super) fn retune(b: &mut Builder, plan: &Plan) {
    let Some(tuning) = plan.tuning else { return };
    let inputs = tuning.inputs().map(|(name, _)| name);
    b.note("tuning on site: inputs that have stayed as a design before began count as those of this design");
    for name in inputs {
        anew::asked(b, name);
    }
    b.when(x("KP_ASKED").below(x("ZERO")), |b| b.set("KP_ASKED", -x("KP_ASKED")));
    b.note("values that cannot be used are refused, the old ones stay");
    b.set("PAR_OK", finite("KP_ASKED"));
    for name in &inputs[1..] {
        refuse(b, finite(&format!("{name}_ASKED")).opposite());
    }
    b.when(x("PAR_OK"), |b| {
        b.set("PAR_CHANGED", Expression::Flag(false));
        for name in inputs {
            let same = x(&format!("{name}_ASKED")).is(x(&format!("{name}_TAKEN")));
            b.when(same.opposite(), |b| b.set("PAR_CHANGED", Expression::Flag(true)));
        }
        b.when(x("PAR_CHANGED"), |b| {
            coefficients(b, plan);
            b.when(x("PAR_OK"), |b| take(b, plan, tuning));
        });
    });
    b.set("PAR_REFUSED", x("PAR_OK").opposite());
}

/// The bit of refused values.
pub(super) fn refused(b: &mut Builder, plan: &Plan) {
    if plan.tuning.is_some() {
        b.when(x("PAR_REFUSED"), |b| status(b, "ST_PAR_REFUSED"));
    }
}

/// `to := x` where `x` may be below 0 as its size.
fn size(b: &mut Builder, to: &str, of: Expression) {
    b.set(to, of);
    b.when(x(to).below(x("L_ZERO")), |b| b.set(to, -x(to)));
}

fn refuse(b: &mut Builder, when: Expression) {
    b.when(when, |b| b.set("PAR_OK", Expression::Flag(false)));
}

/// The new coefficients in double precision, each rounded once; `PAR_OK` says whether they may be used.
fn coefficients(b: &mut Builder, plan: &Plan) {
    let zero = || x("L_ZERO");
    b.note("TN >= 0, TV >= 0 and with TF only, TF = 0 or at least TS/2");
    b.set("L_KP", long("KP_ASKED"));
    b.set("L_TN", long("TN_ASKED"));
    b.set("L_TV", long("TV_ASKED"));
    b.set("L_TF", long("TF_ASKED"));
    refuse(b, x("L_KP").above(x("L_GAIN_MAX")));
    refuse(b, x("L_TN").below(zero()));
    refuse(b, x("L_TV").below(zero()));
    refuse(b, x("L_TF").is(zero()).opposite().and(x("L_TF").below(x("L_TF_MIN"))));
    refuse(b, x("L_TF").above(x("L_TF_MAX")));
    b.set("L_KD", x("L_KP") * x("L_TV"));
    b.when(x("PAR_OK"), |b| {
        b.note("parallel gains, rounded like every parameter: ki = KP/TN, kd = KP*TV; TN = 0: no integral action");
        b.set("L_KI", zero());
        b.when(x("L_TN").above(zero()), |b| b.set("L_KI", x("L_KP") / x("L_TN")));
        refuse(b, x("L_KI").above(x("L_GAIN_MAX")));
        refuse(b, x("L_KD").above(x("L_GAIN_MAX")));
    });
    b.when(x("PAR_OK"), |b| {
        for name in ["L_KI", "L_KD"] {
            b.set("ROUNDED", x(name).to(Type::Real));
            b.set(name, long("ROUNDED"));
        }
        refuse(b, x("L_KD").above(zero()).and(x("L_TF").is(zero())));
        anti_windup(b, plan);
        let [kp, ..] = plan.config.pid.signed_gains();
        if kp < 0.0 {
            b.note("the direction of the design: gains below 0");
            for gain in ["L_KP", "L_KI", "L_KD"] {
                b.set(gain, -x(gain));
            }
        }
        if plan.turns() {
            let still = x("L_KI").is(zero()).and(x("L_KP").below(zero()));
            b.set("N_REVERSED", x("L_KI").below(zero()).or(still));
        }
        filter_gains(b);
        store(b, x("L_KI") * x("L_TS") * x("L_SHARE_NOW"), "N_KI_NOW");
        store(b, x("L_KI") * x("L_TS") * x("L_SHARE_BEFORE"), "N_KI_BEFORE");
        overflow(b);
    });
}

/// The rule of the anti-windup, which acts only with integral action; `min(1, TS/TT)`, by default with `TT = max(kp/ki, TF, TS)`.
fn anti_windup(b: &mut Builder, plan: &Plan) {
    let integral = || x("L_KI").is(x("L_ZERO")).opposite();
    if plan.conditional() {
        b.set("N_AW_TAKES_BACK", integral());
        return;
    }
    match plan.tracking() {
        None => {}
        Some(Some(_)) => {
            b.note("share of the anti-windup min(1, TS/TT); without integral action 0");
            b.set("N_AW_GAIN", x("ZERO"));
            b.when(integral(), |b| b.set("N_AW_GAIN", x("AW_SHARE")));
        }
        Some(None) => {
            b.note(
                "TT = max(kp/ki, TF, TS); share of the anti-windup min(1, TS/TT); without integral action 0",
            );
            b.set("N_AW_GAIN", x("ZERO"));
            b.when(integral(), |b| {
                b.set("L_TT", x("L_TS"));
                b.when(x("L_TF").above(x("L_TT")), |b| b.set("L_TT", x("L_TF")));
                b.set("L_SIZE", x("L_KP") / x("L_KI"));
                b.when(x("L_SIZE").above(x("L_TT")), |b| b.set("L_TT", x("L_SIZE")));
                b.set("L_VALUE", x("L_TS") / x("L_TT"));
                b.when(x("L_VALUE").below(x("L_ONE")).opposite(), |b| b.set("L_VALUE", x("L_ONE")));
                round(b, "N_AW_GAIN");
            });
        }
    }
}

/// `G`, `P` and `H` for both inputs.
fn filter_gains(b: &mut Builder) {
    b.note("G = 2*TS/(TS + 2*TF), 1 without a filter");
    let filtered = || x("L_TF").is(x("L_ZERO")).opposite();
    b.set("L_G", x("L_ONE"));
    b.when(filtered(), |b| b.set("L_G", x("L_TWO_TS") / (x("L_TS") + x("L_TWO") * x("L_TF"))));
    store(b, x("L_G"), "N_G");
    for (weight_p, weight_d, p, h, what) in [
        ("L_B", "L_C", "N_P_R", "N_H_R", "set-point: P = B*kp - ki*TF, H = P*G/2 + C*kd*G/TS"),
        ("L_ONE", "L_ONE", "N_P_Y", "N_H_Y", "measurement: P = kp - ki*TF, H = P*G/2 + kd*G/TS"),
    ] {
        b.note(what);
        b.set("L_P", x(weight_p) * x("L_KP") - x("L_KI") * x("L_TF"));
        store(b, x("L_P"), p);
        b.set("L_Q", x(weight_d) * x("L_KD"));
        b.set("L_H", x("L_P"));
        b.when(filtered(), |b| {
            b.set("L_H", x("L_P") * (x("L_HALF") * x("L_G")) + x("L_Q") * (x("L_G") / x("L_TS")));
        });
        store(b, x("L_H"), h);
    }
}

/// `value`, rounded once, into the new coefficient `to`.
fn store(b: &mut Builder, value: Expression, to: &str) {
    b.set("L_VALUE", value);
    round(b, to);
}

/// `L_VALUE`, rounded once, into `to`; what is below the smallest normal number becomes 0.
fn round(b: &mut Builder, to: &str) {
    size(b, "L_SIZE", x("L_VALUE"));
    b.either(
        x("L_SIZE").below(x("L_SMALLEST")),
        |b| b.set(to, x("ZERO")),
        |b| b.set(to, x("L_VALUE").to(Type::Real)),
    );
}

/// Refuses gains with which a product could leave a millionth of the number type's range.
fn overflow(b: &mut Builder) {
    b.note("gains with which a number could overflow are refused");
    for (to, of) in [("L_P", "N_P_R"), ("L_Q", "N_P_Y"), ("L_H", "N_H_R"), ("L_G", "N_H_Y")] {
        size(b, to, long(of));
    }
    b.set("ROUNDED", x("N_KI_NOW") + x("N_KI_BEFORE"));
    size(b, "L_SIZE", long("ROUNDED"));
    b.set("L_VALUE", x("L_P") + x("L_Q") + x("L_TWO") * (x("L_H") + x("L_G")) + x("L_TWO") * x("L_SIZE"));
    b.set("L_VALUE", x("L_VALUE") * x("L_SIGNAL") + x("L_FROM_Y") + x("L_FROM_U") + x("L_OFFSET"));
    refuse(b, x("L_VALUE").at_most(x("L_VALUE_MAX")).opposite());
}

/// The new coefficients take over: lags, being signals, are kept, the integral term absorbs the difference.
fn take(b: &mut Builder, plan: &Plan, tuning: Tuning) {
    b.when(x("STARTED"), |b| {
        b.note("without a bump: what the old anti-windup still owes, and the difference of the filtered terms, go into I");
        b.set("OWED", x("ZERO"));
        b.when(super::modes::automatic("MODE_LAST"), |b| law::unwind(b, plan, "OWED", "U"));
        b.set("V", x("U"));
        law::preview(b, "PREVIEW", "R_LAST", "Y_LAST");
    });
    for coefficient in plan.tuned() {
        b.set(coefficient, x(&format!("N_{coefficient}")));
    }
    for (input, _) in tuning.inputs() {
        b.set(&format!("{input}_TAKEN"), x(&format!("{input}_ASKED")));
    }
    b.when(x("STARTED"), |b| {
        deadband(b, "Y_SEEN", "SPW", "Y");
        law::preview(b, "PREVIEW_NEW", "SPW", "Y_SEEN");
        b.set("JUMP", x("ZERO"));
        if let Some(chains) = &plan.compensator {
            compensator::refer_anew(b, chains, "Y", "U");
            b.when(x("COMPENSATING").opposite(), |b| b.set("JUMP", x("ZERO")));
        }
        b.set("U_F", x("U_F") + x("JUMP"));
        add(b, "I_SUM", "I_SUM_C", (x("PREVIEW") - x("PREVIEW_NEW")) + (x("OWED") - x("JUMP")));
        law::bound(b);
        b.set("INC", x("ZERO"));
    });
}

/// The numbers that only tuning needs.
pub(super) fn declare(b: &mut Builder, plan: &Plan) {
    let pid = &plan.config.pid;
    let n = &plan.numbers;
    let larger = |a: f64, b: f64| if a.abs() > b.abs() { a.abs() } else { b.abs() };
    let c = &plan.config;
    let y = larger(c.measurement_lo, c.measurement_hi);
    let r = larger(c.setpoint.lo, c.setpoint.hi);
    let u = larger(c.limits.lo, c.limits.hi);
    let (from_y, from_u) = plan.compensator.as_ref().map_or((0.0, 0.0), |chains| chains.bounds);
    let (now, before) = if plan.trapezoid() { (0.5, 0.5) } else { (1.0, 0.0) };
    let numbers = [
        ("L_ZERO", 0.0, "0 in double precision"),
        ("L_ONE", 1.0, "1"),
        ("L_MINUS_ONE", -1.0, "-1"),
        ("L_TWO", 2.0, "2"),
        ("L_HALF", 0.5, "1/2"),
        ("L_TS", n.ts, "sampling period [s]"),
        ("L_TWO_TS", 2.0 * n.ts, "2*TS [s]"),
        ("L_B", pid.b, "set-point weight of the proportional term"),
        ("L_C", pid.c, "set-point weight of the derivative term"),
        ("L_SHARE_NOW", now, "weight of e[k] in the integral rule"),
        ("L_SHARE_BEFORE", before, "weight of e[k-1] in the integral rule"),
        ("L_SMALLEST", plan.smallest, "smallest normal number of the loop"),
        ("L_GAIN_MAX", 1e15, "largest gain"),
        ("L_TF_MIN", 0.5 * n.ts, "shortest filter time [s]"),
        ("L_TF_MAX", 1e12, "longest filter time [s]"),
        ("L_SIGNAL", y + r + c.deadband.abs(), "largest signal [PV unit]"),
        ("L_FROM_Y", from_y * y, "largest number of the compensator, from PV [OP unit]"),
        ("L_FROM_U", from_u * u, "largest number of the compensator, from OP [OP unit]"),
        ("L_OFFSET", larger(c.offset_lo, c.offset_hi), "largest feed-forward [OP unit]"),
        ("L_VALUE_MAX", 1e-6 * plan.largest, "largest number that a step may form [OP unit]"),
    ];
    for (name, value, comment) in numbers {
        b.declare(Role::Constant, Type::Long, name, Initial::Number(value), comment);
    }
    for (name, value) in plan.tuning.map_or(Vec::new(), |tuning| tuning.inputs().to_vec()) {
        let name = format!("{name}_DESIGN");
        b.declare(Role::Constant, Type::Real, &name, Initial::Number(value), "value of the design");
    }
    let comment = "anti-windup: min(1, TS/TT)";
    b.declare(Role::Constant, Type::Real, "AW_SHARE", Initial::Number(plan.anti_windup_share), comment);
}
