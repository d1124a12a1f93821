//! Counts, per cent, engineering units.

use crate::rig::{pi, same};
use controller_core::Status;

#[test]
fn counts_in_and_out() {
    let mut rig = pi::<f32>();
    rig.vars.choices.pv_src = 1;
    (rig.vars.settings.pv_lo, rig.vars.settings.pv_hi) = (-50.0, 150.0);
    // 6912 is a quarter of 27648: 0 degrees.
    rig.vars.codes.pv_raw = 6912;
    rig.run(0.0, f64::NAN);
    assert_eq!(rig.vars.results.pv_eng, 0.0);
    // 30 % of 27648 is 8294.4.
    assert_eq!((rig.vars.results.op_percent, rig.vars.reports.op_raw), (30.0, 8294));
    // 2 % below the span is valid, more is not; 5 % above it, more is not.
    for (raw, valid) in
        [(-552, true), (-554, false), (29030, true), (29031, false), (i32::MIN, false), (i32::MAX, false)]
    {
        rig.vars.codes.pv_raw = raw;
        rig.run(0.0, 0.0);
        assert_eq!(!rig.has(Status::BAD_INPUT.bits()), valid, "{raw}");
    }
}

#[test]
fn per_cent_in() {
    let mut rig = pi::<f64>();
    rig.vars.choices.pv_src = 2;
    (rig.vars.settings.pv_lo, rig.vars.settings.pv_hi) = (200.0, 1000.0);
    rig.run(600.0, 25.0);
    assert_eq!(rig.vars.results.pv_eng, 400.0);
}

#[test]
fn inverted_spans() {
    let mut rig = pi::<f64>();
    rig.vars.choices.pv_src = 1;
    // A level transmitter that gives 20 mA for an empty vessel, and a valve that opens without a signal.
    (rig.vars.settings.pv_lo, rig.vars.settings.pv_hi) = (100.0, 0.0);
    (rig.vars.settings.op_lo, rig.vars.settings.op_hi) = (100.0, 0.0);
    rig.vars.codes.pv_raw = 6912;
    rig.run(75.0, 0.0);
    assert_eq!((rig.vars.results.pv_eng, rig.vars.results.dev), (75.0, 0.0));
    assert_eq!((rig.op(), rig.vars.results.op_percent, rig.vars.reports.op_raw), (30.0, 70.0, 19354));
    // 70 % of 27648 is 19353.6. The engineering values decide about the action: SP rises, OP rises.
    same::<f64>(rig.run(80.0, 0.0), 40.1, 60.0);
    // The margins go with the ends: 2 % beyond 100, 5 % beyond 0.
    for (raw, valid) in [(-552, true), (-554, false), (29030, true), (29031, false)] {
        rig.vars.codes.pv_raw = raw;
        rig.run(75.0, 0.0);
        assert_eq!(!rig.has(Status::BAD_INPUT.bits()), valid, "{raw}");
    }
    // Counts may be the other way round, too.
    (rig.vars.choices.pv_raw_lo, rig.vars.choices.pv_raw_hi) = (27648, 0);
    rig.vars.codes.pv_raw = 27648;
    rig.run(75.0, 0.0);
    assert_eq!(rig.vars.results.pv_eng, 100.0);
}

#[test]
fn counts_stay_in_their_span_at_the_limits() {
    let mut rig = pi::<f32>();
    (rig.vars.choices.op_raw_lo, rig.vars.choices.op_raw_hi) = (-10, 3);
    rig.vars.commands.man = 1;
    for (op, raw) in [(0.0, -10), (100.0, 3), (-7.0, -10), (1e9, 3), (50.0, -4), (49.9, -4), (80.0, 0)] {
        rig.vars.signals.op_man = op;
        rig.run(50.0, 50.0);
        // 50 % is -3.5: halves go away from zero.
        assert_eq!(rig.vars.reports.op_raw, raw, "{op}");
    }
}

/// KP = 2 %/%: PV 0 to 400, OP 0 to 50: 2 * 50/400 = 0.25 per unit.
#[test]
fn gain_in_per_cent() {
    let mut rig = pi::<f64>();
    rig.vars.switches.kp_percent = 1;
    (rig.vars.settings.pv_hi, rig.vars.settings.op_hi, rig.vars.settings.tn) = (400.0, 50.0, 0.0);
    rig.run(100.0, 100.0);
    assert_eq!(rig.run(140.0, 100.0), 40.0);
    // An inverted span does not turn the loop round.
    (rig.vars.settings.op_lo, rig.vars.settings.op_hi) = (50.0, 0.0);
    assert_eq!(rig.run(140.0, 100.0), 40.0);
}
