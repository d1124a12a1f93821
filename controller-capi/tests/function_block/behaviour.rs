//! Gains, modes, bad measurements, alarms.

use crate::rig::{Fb, pi, same};
use controller_core::Status;

/// At rest at SP = PV = 50 and OP = 30, then SP = 55: the proportional term is 2 * 5, the integral adds 2/10 * 0.1 * 5 in
/// each sample.
fn steps_as_by_hand<T: Fb>() {
    for (kp, direct, sign) in [(2.0, 0, 1.0), (-2.0, 0, 1.0), (2.0, 1, -1.0), (-2.0, 1, -1.0)] {
        let mut rig = pi::<T>();
        rig.vars.settings.kp = T::from_f64(kp);
        rig.vars.switches.direct = direct;
        assert_eq!(rig.run(50.0, 50.0), 30.0);
        for k in 1..20 {
            same::<T>(rig.run(55.0, 50.0), 30.0 + sign * (10.0 + 0.1 * f64::from(k)), 60.0);
        }
        let results = &rig.vars.results;
        assert_eq!(
            (results.dev.to_f64(), results.sp_working.to_f64(), results.pv_eng.to_f64()),
            (5.0, 55.0, 50.0)
        );
        assert_eq!((rig.vars.reports.mode, rig.vars.flags.in_auto, rig.vars.flags.in_cas), (3, 1, 0));
    }
}

#[test]
fn gain_reset_time_and_direction() {
    steps_as_by_hand::<f32>();
    steps_as_by_hand::<f64>();
}

#[test]
fn without_reset_time_there_is_no_integral() {
    let mut rig = pi::<f64>();
    rig.vars.settings.tn = 0.0;
    rig.run(50.0, 50.0);
    for _ in 0..1000 {
        assert_eq!(rig.run(55.0, 50.0), 40.0);
    }
    assert_eq!(rig.run(50.0, 50.0), 30.0);
    // Nor does it wind up or move while the output is at its limit.
    for _ in 0..100 {
        assert_eq!(rig.run(100.0, 50.0), 100.0);
    }
    assert_eq!(rig.run(50.0, 50.0), 30.0);
}

/// PD with KP = 2, TV = 0.5 s, TF = 0.2 s, TS = 0.1 s: a step of PV by -1 gives, by Tustin's rule for
/// (KP + KP*TV*s)/(1 + TF*s), 2*(0.1 + 2*0.5)/(0.1 + 2*0.2) = 4.4 in its first sample, and 2 in the end.
#[test]
fn rate_time() {
    let mut rig = pi::<f64>();
    (rig.vars.settings.tn, rig.vars.settings.tv, rig.vars.settings.tf) = (0.0, 0.5, 0.2);
    rig.run(50.0, 50.0);
    same::<f64>(rig.run(50.0, 49.0), 34.4, 40.0);
    for _ in 0..200 {
        rig.run(50.0, 49.0);
    }
    same::<f64>(rig.op(), 32.0, 40.0);
}

#[test]
fn modes_and_their_order() {
    let mut rig = pi::<f64>();
    rig.run(50.0, 50.0);
    let numbers = |rig: &crate::rig::Rig<f64>| (rig.vars.reports.mode, rig.op());
    let c = |rig: &mut crate::rig::Rig<f64>| -> (i32, f64) {
        rig.run(50.0, 50.0);
        numbers(rig)
    };
    (rig.vars.signals.op_man, rig.vars.signals.trk_value, rig.vars.settings.off_op) = (40.0, 60.0, 5.0);
    rig.vars.signals.sp_remote = 70.0;
    rig.vars.commands.cas = 1;
    // SP 50 -> 70: 2 * 20 more, and 0.2 * 0.1 * 20 = 0.4 of the integral: no bump between the two, then by the increment.
    assert_eq!(c(&mut rig).0, 4);
    assert_eq!(rig.vars.flags.in_cas, 1);
    rig.vars.commands.hold = 1;
    assert_eq!(c(&mut rig).0, 6);
    rig.vars.commands.man = 255;
    assert_eq!(c(&mut rig), (2, 40.0));
    rig.vars.commands.trk = 1;
    assert_eq!(c(&mut rig), (5, 60.0));
    rig.vars.commands.off = 1;
    assert_eq!(c(&mut rig), (1, 5.0));
    rig.vars.switches.off_hold = 1;
    assert_eq!(c(&mut rig), (1, 5.0));
    rig.vars.commands = controller_capi::plc::vars::Commands::default();
    assert_eq!(c(&mut rig), (6, 5.0));
    // Back to automatic: from where it is, without a bump.
    rig.vars.commands.auto_ = 1;
    assert_eq!(c(&mut rig), (3, 5.0));
}

#[test]
fn a_value_that_is_no_number_is_replaced_and_shown() {
    let mut rig = pi::<f64>();
    rig.run(50.0, 50.0);
    rig.vars.commands.man = 1;
    rig.vars.signals.op_man = f64::NAN;
    assert_eq!(rig.run(50.0, 50.0), 30.0);
    assert!(rig.has(Status::REJECTED.bits()));
    rig.vars.commands.man = 0;
    assert_eq!(rig.run(f64::INFINITY, 50.0), 30.0);
    assert!(rig.has(Status::REJECTED.bits()));
    rig.vars.signals.tcyc = f64::NAN;
    rig.run(50.0, 50.0);
    assert!(rig.has(Status::REJECTED.bits()));
}

#[test]
fn quality_and_fallback() {
    let mut rig = pi::<f32>();
    rig.vars.choices.fail_hold = 2;
    rig.vars.choices.fail_act = 1;
    rig.vars.settings.fail_op = 12.0;
    rig.vars.switches.fail_ack = 1;
    rig.run(50.0, 50.0);
    rig.vars.codes.pv_quality = 1;
    rig.run(50.0, 50.0);
    assert!(rig.has(Status::UNCERTAIN.bits()) && rig.vars.reports.mode == 3);
    for quality in [0, 7] {
        rig.vars.codes.pv_quality = quality;
        assert_eq!(rig.run(50.0, 50.0), 30.0);
        assert!(rig.has((Status::BAD_INPUT | Status::HELD).bits()));
    }
    assert_eq!(rig.run(50.0, 50.0), 12.0);
    assert!(rig.has((Status::BAD_INPUT | Status::FALLBACK).bits()));
    assert_eq!((rig.vars.reports.mode, rig.vars.flags.in_auto), (7, 0));
    rig.vars.codes.pv_quality = 2;
    assert_eq!(rig.run(50.0, 50.0), 12.0);
    assert!(rig.has(Status::AWAITING_ACKNOWLEDGEMENT.bits()));
    rig.vars.commands.ack = 1;
    assert_eq!(rig.run(50.0, 50.0), 12.0);
    assert_eq!(rig.vars.reports.mode, 3);
}

#[test]
fn a_measurement_that_is_no_number_keeps_the_last_one_in_view() {
    let mut rig = pi::<f64>();
    rig.run(50.0, 47.0);
    rig.run(50.0, f64::NAN);
    assert_eq!((rig.vars.results.pv_eng, rig.vars.results.dev), (47.0, 3.0));
    // What is finite but impossible is shown.
    rig.run(50.0, 850.0);
    assert_eq!(rig.vars.results.pv_eng, 850.0);
    assert!(rig.has(Status::BAD_INPUT.bits()));
}

#[test]
fn before_the_first_good_measurement() {
    let mut rig = pi::<f64>();
    rig.vars.codes.pv_quality = 0;
    assert_eq!(rig.run(50.0, 50.0), 30.0);
    assert!(rig.has(Status::UNINITIALISED.bits()));
    rig.vars.commands.man = 1;
    rig.vars.signals.op_man = 44.0;
    assert_eq!(rig.run(50.0, 50.0), 44.0);
}

#[test]
fn alarms_come_and_go_with_hysteresis() {
    let mut rig = pi::<f64>();
    let settings = &mut rig.vars.settings;
    (settings.hh_lim, settings.h_lim, settings.l_lim, settings.ll_lim) = (90.0, 80.0, 20.0, 10.0);
    (settings.dev_lim, settings.alm_hyst) = (35.0, 2.0);
    let switches = &mut rig.vars.switches;
    (switches.hh_en, switches.h_en, switches.l_en, switches.ll_en) = (1, 1, 1, 1);
    // PV, then HH H L LL DEV by hand for SP = 50.
    let table = [
        (50.0, [0, 0, 0, 0, 0]),
        (80.0, [0, 0, 0, 0, 0]),
        (80.5, [0, 1, 0, 0, 0]),
        (78.5, [0, 1, 0, 0, 0]),
        (78.0, [0, 0, 0, 0, 0]),
        (91.0, [1, 1, 0, 0, 1]),
        (88.5, [1, 1, 0, 0, 1]),
        (84.0, [0, 1, 0, 0, 1]),
        (83.0, [0, 1, 0, 0, 0]),
        (19.0, [0, 0, 1, 0, 0]),
        (9.0, [0, 0, 1, 1, 1]),
        (11.9, [0, 0, 1, 1, 1]),
        (12.0, [0, 0, 1, 0, 1]),
        (22.0, [0, 0, 0, 0, 0]),
    ];
    for (pv, alarms) in table {
        rig.run(50.0, pv);
        let f = &rig.vars.flags;
        assert_eq!([f.hh_alm, f.h_alm, f.l_alm, f.ll_alm, f.dev_alm], alarms, "PV = {pv}");
    }
    rig.vars.switches.h_en = 0;
    rig.run(50.0, 85.0);
    assert_eq!((rig.vars.flags.h_alm, rig.vars.flags.hh_alm), (0, 0));
}

/// The primary of a cascade reads back the set-point of the secondary and stops where it cannot follow.
#[test]
fn a_cascade_hands_its_limits_up() {
    let mut inner = pi::<f64>();
    inner.vars.commands.cas = 1;
    inner.vars.signals.sp_remote = 200.0;
    inner.run(0.0, 50.0);
    for _ in 0..500 {
        inner.run(0.0, 50.0);
    }
    assert_eq!((inner.vars.results.bkcal_out, inner.vars.results.op), (100.0, 100.0));
    assert_eq!((inner.vars.flags.blocked_up, inner.vars.flags.blocked_dn), (1, 0));
    let mut outer = pi::<f64>();
    outer.run(50.0, 50.0);
    outer.vars.commands.inhibit_up = 1;
    // The proportional term moves by 2, the integral must not: 0.2 * 0.1 * 1 is left out.
    assert_eq!(outer.run(51.0, 50.0), 32.0);
    assert_eq!(outer.run(51.0, 50.0), 32.0);
    assert!(outer.has(Status::INHIBITED.bits()));
}
