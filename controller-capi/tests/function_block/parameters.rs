//! Parameters: what is refused and under which name, what is adopted and how.

use crate::rig::{Rig, pi, same};
use controller_capi::plc::{Vars, status};
use controller_capi::{Config, Input, Output, ctl_f32_init, ctl_f32_size, ctl_f32_step};

const NOT_FINITE: i32 = 1;
const OUT_OF_RANGE: i32 = 2;
const INVERTED: i32 = 3;
const SIGN_MISMATCH: i32 = 4;
const NEEDS_FILTER: i32 = 5;

type Change = fn(&mut Vars<f64>);

/// What is refused, its name, and why.
const REFUSED: &[(Change, &str, i32)] = &[
    (|v| v.settings.ts = 0.0, "ts", OUT_OF_RANGE),
    (|v| v.settings.ts = -0.1, "ts", OUT_OF_RANGE),
    (|v| v.settings.kp = f64::NAN, "kp", NOT_FINITE),
    (|v| v.settings.kp = f64::INFINITY, "kp", NOT_FINITE),
    (|v| v.settings.tn = -1.0, "tn", OUT_OF_RANGE),
    (|v| v.settings.tn = 1e-320, "tn", NOT_FINITE),
    (|v| v.settings.tv = -1.0, "tv", OUT_OF_RANGE),
    (|v| v.settings.tv = 1.0, "tv", NEEDS_FILTER),
    (|v| v.settings.tf = 0.01, "tf", OUT_OF_RANGE),
    (|v| v.settings.b = 2.5, "b", OUT_OF_RANGE),
    (|v| v.settings.c = -0.5, "c", OUT_OF_RANGE),
    (|v| v.settings.tt = -1.0, "tt", OUT_OF_RANGE),
    (|v| v.settings.deadband = -1.0, "deadband", OUT_OF_RANGE),
    (|v| v.settings.pv_hi = 0.0, "pv_hi", INVERTED),
    (|v| v.settings.pv_under = -1.0, "pv_under", OUT_OF_RANGE),
    (|v| v.settings.pv_over = 1001.0, "pv_over", OUT_OF_RANGE),
    (|v| v.settings.op_hi = 0.0, "op_hi", INVERTED),
    (|v| v.settings.op_lim_hi = 101.0, "op_lim_hi", OUT_OF_RANGE),
    (|v| v.settings.op_lim_lo = -1.0, "op_lim_lo", OUT_OF_RANGE),
    (|v| (v.settings.op_lim_lo, v.settings.op_lim_hi) = (80.0, 20.0), "op_lim_lo", INVERTED),
    (|v| (v.settings.sp_lim_lo, v.settings.sp_lim_hi) = (80.0, 20.0), "sp_lim_lo", INVERTED),
    (|v| v.settings.op_rate_up = -1.0, "op_rate_up", OUT_OF_RANGE),
    (|v| v.settings.sp_rate_dn = -1.0, "sp_rate_dn", OUT_OF_RANGE),
    (|v| v.settings.off_op = 101.0, "off_op", OUT_OF_RANGE),
    (|v| (v.choices.fail_act, v.settings.fail_op) = (1, -1.0), "fail_op", OUT_OF_RANGE),
    (|v| v.choices.fail_act = 2, "fail_rate", OUT_OF_RANGE),
    (|v| v.choices.fail_act = 3, "fail_act", OUT_OF_RANGE),
    (|v| v.choices.fail_hold = -1, "fail_hold", OUT_OF_RANGE),
    (|v| (v.switches.h_en, v.switches.l_en, v.settings.l_lim) = (1, 1, 1.0), "l_lim", INVERTED),
    (|v| v.settings.dev_lim = -1.0, "dev_lim", OUT_OF_RANGE),
    (|v| v.settings.alm_hyst = -1.0, "alm_hyst", OUT_OF_RANGE),
    (|v| v.settings.hh_lim = f64::NAN, "hh_lim", NOT_FINITE),
    (|v| v.choices.scan_div = -1, "scan_div", OUT_OF_RANGE),
    (|v| v.choices.scan_div = 65536, "scan_div", OUT_OF_RANGE),
    (|v| v.choices.pv_src = 3, "pv_src", OUT_OF_RANGE),
    (|v| v.choices.pv_raw_hi = 0, "pv_raw_hi", INVERTED),
    (|v| v.choices.op_raw_lo = 27648, "op_raw_hi", INVERTED),
    (|v| v.choices.aw = 3, "aw", OUT_OF_RANGE),
    (|v| v.choices.comp = 3, "comp", OUT_OF_RANGE),
    (|v| v.choices.comp = 1, "m_gain", OUT_OF_RANGE),
    (|v| estimator(v).kfd = 0.0, "kfd", NOT_FINITE),
    (|v| estimator(v).tfd = 0.0, "tfd", OUT_OF_RANGE),
    (|v| estimator(v).m_gain = -1.0, "m_gain", SIGN_MISMATCH),
    (|v| estimator(v).m_t1 = -1.0, "m_t1", OUT_OF_RANGE),
    (|v| estimator(v).m_t1 = 1e-9, "m_t1", OUT_OF_RANGE),
    (|v| estimator(v).m_dead = -1.0, "m_dead", OUT_OF_RANGE),
    (|v| estimator(v).latency = -1.0, "latency", OUT_OF_RANGE),
];

fn estimator(vars: &mut Vars<f64>) -> &mut controller_capi::plc::vars::Settings<f64> {
    vars.choices.comp = 1;
    let s = &mut vars.settings;
    (s.kfd, s.tfd, s.m_gain, s.m_t1, s.m_t2) = (0.7, 0.5, 1.0, 2.0, 1.0);
    s
}

#[test]
fn what_is_refused_is_named_and_the_old_law_stays() {
    for (i, &(change, name, reason)) in REFUSED.iter().enumerate() {
        let mut rig = pi::<f64>();
        change(&mut rig.vars);
        // Before the first sample: no loop, no output.
        rig.vars.results.op = 77.0;
        assert_eq!((rig.scan(), rig.refused(), rig.vars.reports.error_reason), (7, name, reason), "case {i}");
        assert_eq!((rig.op(), rig.vars.reports.status), (77.0, status::NOT_RUNNING));
        assert!(rig.memory.iter().all(|&byte| byte == 0));
        // Once it runs: the old law goes on, as by hand.
        let mut rig = pi::<f64>();
        rig.run(50.0, 50.0);
        rig.run(55.0, 50.0);
        let good = rig.vars.parameters_of();
        change(&mut rig.vars);
        for k in 2..5 {
            assert_eq!(
                (rig.scan(), rig.refused(), rig.vars.reports.error_reason),
                (7, name, reason),
                "case {i}"
            );
            assert!(rig.has(status::REFUSED) && rig.vars.flags.fault == 1 && rig.vars.reports.mode == 3);
            same::<f64>(rig.op(), 40.0 + 0.1 * f64::from(k), 60.0);
        }
        rig.vars.set_parameters(good);
        same::<f64>(rig.run(55.0, 50.0), 40.5, 60.0);
        assert!(!rig.has(status::REFUSED) && rig.vars.reports.error_param == 0);
    }
}

/// Parameters as a program keeps them.
trait Recipe: Sized {
    type All;
    fn parameters_of(&self) -> Self::All;
    fn set_parameters(&mut self, all: Self::All);
}

impl Recipe for Vars<f64> {
    type All = (
        controller_capi::plc::vars::Settings<f64>,
        controller_capi::plc::vars::Choices,
        controller_capi::plc::vars::Switches,
    );
    fn parameters_of(&self) -> Self::All {
        (self.settings, self.choices, self.switches)
    }
    fn set_parameters(&mut self, all: Self::All) {
        (self.settings, self.choices, self.switches) = all;
    }
}

#[test]
fn refused_parameters_leave_the_spans_alone() {
    let mut rig = pi::<f64>();
    rig.vars.choices.pv_src = 1;
    rig.vars.codes.pv_raw = 13824;
    rig.run(50.0, 0.0);
    rig.vars.settings.pv_hi = 200.0;
    rig.vars.settings.tn = -1.0;
    assert_eq!(rig.scan(), 7);
    assert_eq!(rig.vars.results.pv_eng, 50.0);
    rig.vars.settings.tn = 10.0;
    rig.run(50.0, 0.0);
    assert_eq!(rig.vars.results.pv_eng, 100.0);
}

/// The gain doubles at a deviation of 5: the output goes on from where it is, by the new increment 0.4 * 0.1 * 5.
#[test]
fn adopted_without_a_bump() {
    let mut rig = pi::<f64>();
    rig.run(50.0, 50.0);
    rig.run(55.0, 50.0);
    same::<f64>(rig.run(55.0, 50.0), 40.2, 60.0);
    rig.vars.settings.kp = 4.0;
    same::<f64>(rig.run(55.0, 50.0), 40.4, 60.0);
    same::<f64>(rig.run(55.0, 50.0), 40.6, 60.0);
    // From PI to PID, to other limits, to an estimator: nothing moves but the integral.
    (rig.vars.settings.tv, rig.vars.settings.tf) = (1.0, 0.5);
    rig.vars.settings.op_lim_hi = 95.0;
    same::<f64>(rig.run(55.0, 50.0), 40.8, 80.0);
    estimator(&mut rig.vars);
    same::<f64>(rig.run(55.0, 50.0), 41.0, 80.0);
    rig.vars.choices.comp = 0;
    rig.run(55.0, 50.0);
    assert!((rig.op() - 41.2).abs() < 0.1, "{}", rig.op());
}

#[test]
fn names_are_those_of_the_variables() {
    let name = |number: i32| unsafe { std::ffi::CStr::from_ptr(controller_capi::ctl_fb_param_name(number)) };
    let names = |first: i32, list: &[&str]| {
        for (number, expected) in (first..).zip(list) {
            assert_eq!(name(number).to_str(), Ok(*expected));
        }
    };
    names(1, controller_capi::plc::vars::Settings::<f64>::NAMES);
    names(101, controller_capi::plc::vars::Choices::NAMES);
    assert_eq!(name(0), c"no parameter");
    for unknown in [-1, 47, 100, 113, i32::MIN, i32::MAX] {
        assert_eq!(name(unknown), c"unknown parameter");
    }
}

/// The block is the loop of the interface, bit for bit, with a configuration written by hand: KI = 2.5/8, KD = 2.5 * 0.5.
#[test]
fn agrees_with_the_loop_of_the_interface() {
    let mut rig = Rig::<f32>::new(20);
    let s = &mut rig.vars.settings;
    (s.kp, s.tn, s.tv, s.tf, s.b, s.c, s.ts) = (2.5, 8.0, 0.5, 0.25, 0.75, 0.5, 0.125);
    (s.op_lim_lo, s.op_lim_hi, s.op_rate_up, s.sp_rate_up, s.op_init) = (10.0, 90.0, 40.0, 2.0, 25.0);
    (s.alpha, s.m_gain, s.m_t1, s.m_t2, s.m_dead, s.latency) = (1.5, 1.25, 6.0, 2.0, 1.0, 0.0625);
    rig.vars.choices.comp = 2;
    rig.vars.settings.off_op = 10.0;
    let mut config = Config {
        ts: 0.125,
        kp: 2.5,
        ki: 0.3125,
        kd: 1.25,
        tf: 0.25,
        b: 0.75,
        c: 0.5,
        output_lo: 10.0,
        output_hi: 90.0,
        output_rate_up: 40.0,
        setpoint_lo: 0.0,
        setpoint_hi: 100.0,
        setpoint_rate_up: 2.0,
        measurement_lo: -2.0,
        measurement_hi: 105.0,
        offset_lo: -100.0,
        offset_hi: 100.0,
        off_output: 10.0,
        initial_output: 25.0,
        compensator: 2,
        alpha: 1.5,
        model_gain: 1.25,
        model_dead_time: 1.0,
        latency: 0.0625,
        model_pole_count: 2,
        ..Config::default()
    };
    (config.model_pole_a1[0], config.model_pole_a1[1]) = (6.0, 2.0);
    let mut block = vec![0_u64; ctl_f32_size(20) / 8];
    let (state, size) = (block.as_mut_ptr().cast(), block.len() * 8);
    assert_eq!(unsafe { ctl_f32_init(state, size, &config, std::ptr::null_mut()) }, 0);
    let (mut x1, mut x2) = (40.0_f32, 40.0_f32);
    for k in 0..2000_u32 {
        let sp = if k % 500 < 250 { 45.0 } else { 60.0 };
        // Manual, bad samples, a dip of the measurement, feed-forward.
        let manual = (600..650).contains(&k);
        let quality = if (900..960).contains(&k) { 0 } else { 2 };
        let y = if k == 1200 { f32::NAN } else { x2 };
        let ff = if k > 1500 { 5.0 } else { 0.0 };
        rig.vars.commands.man = u8::from(manual);
        rig.vars.signals.op_man = 33.0;
        rig.vars.codes.pv_quality = quality;
        (rig.vars.signals.sp, rig.vars.signals.pv, rig.vars.signals.ff) = (sp, y, ff);
        assert_eq!(rig.scan(), 0);
        let input = Input {
            r: sp,
            y,
            manual: 33.0,
            has_manual: 1,
            offset: ff,
            mode: if manual { 2 } else { 3 },
            quality: 2 - quality,
            ..Input::default()
        };
        let mut out = Output::default();
        assert_eq!(unsafe { ctl_f32_step(state, size, &input, &mut out) }, 0);
        let results = &rig.vars.results;
        let block =
            [results.op, results.i_term, results.pd_term, results.uf, results.d_hat, results.sp_working];
        let looped = [out.u, out.i, out.pd, out.u_f, out.d_hat, out.r];
        assert_eq!(block.map(f32::to_bits), looped.map(f32::to_bits), "sample {k}");
        assert_eq!((rig.vars.reports.status, rig.vars.reports.mode), (out.status, out.mode));
        x1 += 0.02 * (1.25 * results.op - 4.0 - x1);
        x2 += 0.06 * (x1 - x2);
    }
}
