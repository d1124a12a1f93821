//! The period of the task, and dividing it.

use crate::rig::{Rig, pi, same};
use controller_capi::plc::status;
use controller_core::Status;

/// The process exp(-0.2 s)/((1 + 0.2 s)(1 + s)) of the estimator's model, in steps of 1 ms, with a load of 1 at its input.
struct Process {
    x: [f64; 2],
    line: std::collections::VecDeque<f64>,
    area: f64,
}

impl Process {
    fn new() -> Self {
        Self { x: [0.0; 2], line: vec![0.0; 200].into(), area: 0.0 }
    }

    fn run(&mut self, milliseconds: u32, u: f64, load: f64) {
        for _ in 0..milliseconds {
            self.line.push_back(u + load);
            let delayed = self.line.pop_front().unwrap();
            self.x[0] += 0.001 / 0.2 * (delayed - self.x[0]);
            self.x[1] += 0.001 * (self.x[0] - self.x[1]);
            self.area += self.x[1].abs() * 0.001;
        }
    }
}

/// PID with disturbance estimator of the published example for that process.
fn estimating() -> Rig<f64> {
    let mut rig = Rig::<f64>::new(32);
    let s = &mut rig.vars.settings;
    (s.kp, s.tn, s.tv, s.tf, s.c, s.ts) = (2.35, 2.35 / 1.88, 0.48 / 2.35, 0.119, 1.0, 0.01);
    (s.pv_lo, s.pv_hi, s.op_lo, s.op_hi) = (-100.0, 100.0, -10.0, 10.0);
    (s.kfd, s.tfd, s.m_gain, s.m_a1, s.m_a2, s.m_dead) = (0.69, 0.06, 1.0, 1.2, 0.2, 0.2);
    rig.vars.choices.comp = 1;
    rig
}

/// Integral of the absolute error over 20 s after a unit load, the task running every `milliseconds`.
fn area(milliseconds: u32, measured: bool) -> f64 {
    let mut rig = estimating();
    let mut process = Process::new();
    rig.run(0.0, 0.0);
    if measured {
        rig.vars.signals.tcyc = f64::from(milliseconds) * 1e-3;
    }
    for _ in 0..20_000 / milliseconds {
        let u = rig.run(0.0, process.x[1]);
        process.run(milliseconds, u, 1.0);
    }
    process.area
}

#[test]
fn at_twice_the_period_only_the_check_keeps_the_loop() {
    let (right, blind, checked) = (area(10, true), area(20, false), area(20, true));
    println!("IAE: {right:.3} in time, {blind:.3} at twice the period, {checked:.3} with TCYC");
    assert!(blind > 20.0 * right);
    // Without the estimator the area is 1/KI of the law as it runs: with half its KI. It is not less than that, and the loop
    // hardly overshoots.
    let expected = 2.0 / 1.88;
    assert!(checked > 0.999 * expected && checked < 1.05 * expected);
    assert_eq!(area(10, true), area(10, false));
}

/// The estimator carries a load of 1 when the task becomes slow: OP stays where it is when it goes and when it comes back.
#[test]
fn goes_and_comes_back_without_a_bump() {
    let mut rig = estimating();
    let mut process = Process::new();
    rig.run(0.0, 0.0);
    rig.vars.signals.tcyc = 0.01;
    for _ in 0..6000 {
        let u = rig.run(0.0, process.x[1]);
        process.run(10, u, 1.0);
    }
    let used = Status::COMPENSATING.bits();
    assert!(rig.has(used) && (rig.vars.results.uf + 0.69).abs() < 1e-3, "{}", rig.vars.results.uf);
    let before = rig.op();
    let at = |tcyc: f64, rig: &mut Rig<f64>| {
        rig.vars.signals.tcyc = tcyc;
        rig.run(0.0, process.x[1]);
        assert!((rig.op() - before).abs() < 1e-3, "{} after {before}", rig.op());
    };
    at(0.012, &mut rig);
    assert!(rig.has(used | status::PERIOD_OFF) && !rig.has(status::COMPENSATOR_OUT));
    at(0.0135, &mut rig);
    assert!(rig.has(status::PERIOD_OFF | status::COMPENSATOR_OUT) && !rig.has(used));
    assert_eq!(rig.vars.results.period, 0.0135);
    for _ in 0..9 {
        at(0.01, &mut rig);
        assert!(rig.has(status::COMPENSATOR_OUT) && !rig.has(used) && !rig.has(status::PERIOD_OFF));
    }
    at(0.01, &mut rig);
    assert!(rig.has(used) && !rig.has(status::COMPENSATOR_OUT));
}

#[test]
fn a_late_scan_is_lost_samples() {
    let mut rig = estimating();
    rig.run(0.0, 0.0);
    rig.vars.signals.tcyc = 0.01;
    rig.run(0.0, 0.0);
    rig.vars.signals.tcyc = 0.05;
    rig.run(0.0, 0.0);
    assert!(rig.has(Status::OVERRUN.bits()));
    rig.run(0.0, 0.0);
    assert!(!rig.has(Status::OVERRUN.bits()));
    // A task of another period is not a row of gaps: the loop stays closed, and integrates.
    (rig.vars.settings.tv, rig.vars.settings.tf) = (0.0, 0.0);
    let first = rig.run(1.0, 0.0);
    let then = rig.run(1.0, 0.0);
    same::<f64>(then - first, 1.88 * 0.01, 10.0);
}

#[test]
fn divides_the_scans() {
    let mut rig = pi::<f32>();
    rig.vars.choices.scan_div = 4;
    rig.vars.settings.ts = 0.5;
    rig.vars.signals.tcyc = 0.125;
    rig.run(50.0, 50.0);
    // KI * TS * 5 = 0.2 * 0.5 * 5 = 0.5 in every fourth call.
    for k in 1..40_i32 {
        let steps = f64::from(k / 4);
        let expected = if k < 4 { 30.0 } else { 40.0 + 0.5 * steps };
        same::<f32>(rig.run(55.0, 50.0), expected, 60.0);
        assert!(!rig.has(status::PERIOD_OFF));
    }
    assert_eq!(rig.vars.results.period, 0.5);
    // 0 is 1.
    rig.vars.choices.scan_div = 0;
    rig.run(55.0, 50.0);
    let before = rig.run(55.0, 50.0);
    same::<f32>(rig.run(55.0, 50.0), before + 0.5, 60.0);
    assert!(rig.has(status::PERIOD_OFF));
}

#[test]
fn a_slip_in_the_divider_is_corrected_at_once() {
    let mut rig = pi::<f32>();
    rig.run(50.0, 50.0);
    rig.vars.choices.scan_div = 65_535;
    rig.run(50.0, 50.0);
    rig.vars.choices.scan_div = 1;
    rig.vars.commands.man = 1;
    rig.vars.signals.op_man = 7.0;
    assert_eq!(rig.run(50.0, 50.0), 7.0);
}

#[test]
fn a_short_pulse_between_two_samples_is_not_lost() {
    let mut rig = pi::<f64>();
    rig.vars.choices.scan_div = 3;
    rig.vars.choices.fail_hold = 0;
    rig.vars.switches.fail_ack = 1;
    rig.run(50.0, 50.0);
    rig.vars.codes.pv_quality = 0;
    for _ in 0..3 {
        rig.run(50.0, 50.0);
    }
    assert_eq!(rig.vars.reports.mode, 7);
    rig.vars.codes.pv_quality = 2;
    rig.vars.commands.ack = 1;
    rig.run(50.0, 50.0);
    rig.vars.commands.ack = 0;
    rig.run(50.0, 50.0);
    rig.run(50.0, 50.0);
    assert_eq!(rig.vars.reports.mode, 3);
}

/// The plant went on while the PLC stood still: the loop begins at what is there, not with the jump since then.
#[test]
fn restart_begins_anew() {
    let mut jumps = pi::<f64>();
    (jumps.vars.settings.tv, jumps.vars.settings.tf) = (1.0, 0.2);
    jumps.run(50.0, 50.0);
    let mut restarts = Rig { memory: jumps.memory.clone(), vars: jumps.vars };
    restarts.vars.commands.restart = 1;
    restarts.run(50.0, 30.0);
    restarts.vars.commands.restart = 0;
    jumps.run(50.0, 30.0);
    // Without: 2 * 20 * (0.1 + 2 * 1.0)/(0.1 + 2 * 0.2) = 168 at once, limited to 100.
    assert_eq!(jumps.op(), 100.0);
    // With: from 30 by the increment 0.2 * 0.1 * 20 at most.
    assert!((restarts.op() - 30.0).abs() <= 0.4 + 1e-12, "{}", restarts.op());
    let before = restarts.op();
    same::<f64>(restarts.run(50.0, 30.0), before + 0.4, 60.0);
}
