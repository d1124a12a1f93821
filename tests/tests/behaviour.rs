//! The loop's manners: cascade, missed scans, fallbacks, set-point conditioning, limits in every mode, inhibition,
//! alarms, status.

use controller_core::{
    AlarmConfig, Controller, ControllerConfig, ControllerInput, ControllerState, FallbackAction,
    FallbackConfig, FallbackReturn, LimitConfig, Mode, PidConfig, Quality, SetpointConfig, Status,
};
use controller_tests::oracle::state_space::PlantFactors;

const TS: f64 = 0.1;
type Law = Controller<f64>;

fn config() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 100.0),
        measurement_lo: -20.0,
        measurement_hi: 150.0,
        ..ControllerConfig::default()
    }
}

fn start(config: &ControllerConfig, r: f64, y: f64, u: f64) -> (Law, ControllerState<f64, ()>) {
    let law = Law::new(config, TS).expect("valid");
    let mut state = law.zeroed();
    law.settle(&mut state, r, y, u);
    (law, state)
}

fn input(r: f64, y: f64) -> ControllerInput<f64> {
    ControllerInput { r, y, ..ControllerInput::default() }
}

/// Outer loop over inner loop: the inner saturates, the outer must not wind up, and takes the inner over bumplessly.
#[test]
fn cascade_hands_back_limits_and_set_points() {
    let inner_plant = PlantFactors { lags: &[0.5], ..PlantFactors::UNITY };
    let outer_plant = PlantFactors { lags: &[5.0], ..PlantFactors::UNITY };
    let (mut inner_y, mut outer_y) = (inner_plant.sampled(TS), outer_plant.sampled(TS));
    let inner_config = ControllerConfig {
        limits: LimitConfig::range(0.0, 2.0),
        setpoint: SetpointConfig { lo: 0.0, hi: 10.0, ..SetpointConfig::default() },
        ..config()
    };
    let outer_config = ControllerConfig {
        pid: PidConfig { kp: 3.0, ki: 0.6, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 10.0),
        ..config()
    };
    let (inner, mut inner_state) = start(&inner_config, 0.0, 0.0, 0.0);
    let (outer, mut outer_state) = start(&outer_config, 0.0, 0.0, 0.0);
    let mut handed = inner.step(&mut inner_state, &input(0.0, 0.0));
    let (mut blocked, mut excess) = (false, 0.0_f64);
    for k in 0..1500 {
        // 2 is all the inner loop can give; 4 is out of reach, 1 is not.
        let r = if k < 800 { 4.0 } else { 1.0 };
        let cascade = k >= 50;
        let top = outer.step(
            &mut outer_state,
            &ControllerInput {
                u_applied: Some(handed.r),
                inhibit_up: handed.blocked_up,
                inhibit_down: handed.blocked_down,
                mode: if cascade { Mode::Auto } else { Mode::Track },
                track: handed.r,
                ..input(r, outer_y.output())
            },
        );
        let mode = if cascade { Mode::Cascade } else { Mode::Auto };
        let before = handed.u;
        handed = inner.step(
            &mut inner_state,
            &ControllerInput { r_remote: top.u, mode, ..input(0.7, inner_y.output()) },
        );
        if k == 50 {
            assert!((handed.u - before).abs() < 0.1, "the switch to Cascade moves the inner output");
            assert_eq!(handed.mode, Mode::Cascade);
        }
        blocked |= handed.blocked_up;
        excess = excess.max(top.i);
        let inner_out = inner_y.output();
        let _ = inner_y.step(handed.u, 0.0);
        let _ = outer_y.step(inner_out, 0.0);
        if k == 860 {
            assert!(outer_y.output() < 1.75, "the outer loop had wound up: {}", outer_y.output());
        }
    }
    assert!(blocked, "the inner limit must be told");
    assert!(excess < 10.0, "the outer integral stayed bounded: {excess}");
    assert!((outer_y.output() - 1.0).abs() < 1e-3, "{}", outer_y.output());
}

#[test]
fn inhibition_stops_the_integral_one_way() {
    let (law, mut state) = start(&config(), 50.0, 50.0, 40.0);
    let up = ControllerInput { inhibit_up: true, ..input(60.0, 50.0) };
    let out = law.step(&mut state, &up);
    assert!(out.status.has(Status::INHIBITED) && out.i == 40.0 && out.u == 50.0);
    let down = law.step(&mut state, &ControllerInput { inhibit_up: true, ..input(40.0, 50.0) });
    assert!(!down.status.has(Status::INHIBITED) && down.i == 39.5);
}

#[test]
fn bad_samples_are_held_then_the_fallback_acts() {
    for (action, after) in [
        (FallbackAction::Hold, [40.0, 40.0, 40.0]),
        (FallbackAction::Substitute { output: 10.0 }, [10.0, 10.0, 10.0]),
        (FallbackAction::Ramp { output: 39.5, rate: 2.0 }, [39.8, 39.6, 39.5]),
    ] {
        let fallback = FallbackConfig { hold_samples: 2, action, back: FallbackReturn::Acknowledged };
        let (law, mut state) = start(&ControllerConfig { fallback, ..config() }, 50.0, 50.0, 40.0);
        for bad in [input(50.0, f64::NAN), input(50.0, 151.0)] {
            let out = law.step(&mut state, &bad);
            assert_eq!((out.u, out.mode), (40.0, Mode::Auto));
            assert!(out.status.has(Status::HELD | Status::BAD_INPUT));
        }
        for expected in after {
            let marked = ControllerInput { quality: Quality::Bad, ..input(50.0, 50.0) };
            let out = law.step(&mut state, &marked);
            assert!((out.u - expected).abs() < 1e-12, "{action:?}: {} instead of {expected}", out.u);
            assert!(out.mode == Mode::Fallback && out.status.has(Status::FALLBACK));
        }
        // Good again, but latched; then acknowledged: closed without a bump at another measurement.
        let waiting = law.step(&mut state, &input(50.0, 30.0));
        assert!(waiting.status.has(Status::AWAITING_ACKNOWLEDGEMENT) && waiting.mode == Mode::Fallback);
        let back = law.step(&mut state, &ControllerInput { acknowledge: true, ..input(50.0, 30.0) });
        assert!((back.u - waiting.u).abs() < 1e-12 && back.mode == Mode::Auto, "{action:?}");
        assert!(law.step(&mut state, &input(50.0, 30.0)).u > back.u, "and it integrates again");
    }
}

#[test]
fn other_bad_inputs_are_replaced_and_reported() {
    let (law, mut state) = start(&config(), 50.0, 50.0, 40.0);
    let out = law.step(&mut state, &ControllerInput { offset: f64::INFINITY, ..input(f64::NAN, 50.0) });
    assert!(out.status.has(Status::REJECTED) && out.u == 40.0 && out.r == 50.0);
    let out = law.step(&mut state, &ControllerInput { u_applied: Some(f64::NAN), ..input(50.0, 50.0) });
    assert!(out.status.has(Status::REJECTED) && out.u == 40.0);
    let manual = ControllerInput { mode: Mode::Manual, manual: Some(f64::NAN), ..input(50.0, 50.0) };
    let out = law.step(&mut state, &manual);
    assert!(out.status.has(Status::REJECTED) && out.u == 40.0);
    let out = law.step(&mut state, &ControllerInput { quality: Quality::Uncertain, ..input(50.0, 50.0) });
    assert!(out.status.has(Status::UNCERTAIN) && out.u == 40.0);
}

#[test]
fn lost_samples_are_counted_and_survived() {
    let (law, mut state) = start(&config(), 50.0, 50.0, 40.0);
    law.advance(&mut state, 5);
    let out = law.step(&mut state, &input(50.0, 50.0));
    assert!(out.status.has(Status::OVERRUN) && out.u == 40.0);
    assert!(!law.step(&mut state, &input(50.0, 50.0)).status.has(Status::OVERRUN));
    // A long gap: the loop settles where the process has gone meanwhile.
    law.advance(&mut state, 100_000);
    let out = law.step(&mut state, &input(50.0, 80.0));
    assert_eq!((out.u, out.mode), (40.0, Mode::Auto));
}

#[test]
fn set_points_are_limited_ramped_and_follow_the_measurement() {
    let setpoint =
        SetpointConfig { lo: 10.0, hi: 90.0, rate_up: Some(20.0), rate_down: Some(5.0), track: true };
    let (law, mut state) = start(&ControllerConfig { setpoint, ..config() }, 50.0, 50.0, 40.0);
    let out = law.step(&mut state, &input(500.0, 50.0));
    assert!(out.r == 52.0 && out.status.has(Status::SETPOINT_LIMITED | Status::SETPOINT_RAMPING));
    for _ in 0..30 {
        let _ = law.step(&mut state, &input(500.0, 50.0));
    }
    assert_eq!(law.step(&mut state, &input(500.0, 50.0)).r, 90.0);
    assert_eq!(law.step(&mut state, &input(20.0, 50.0)).r, 89.5);
    // Manual: it follows; back in Auto the ramp starts at the measurement.
    let manual = ControllerInput { mode: Mode::Manual, manual: Some(30.0), ..input(80.0, 61.0) };
    let _ = law.step(&mut state, &manual);
    assert_eq!(law.step(&mut state, &manual).r, 61.0);
    let back = law.step(&mut state, &input(80.0, 61.0));
    assert_eq!((back.r, back.u), (63.0, 30.0));
}

#[test]
fn range_and_rate_hold_in_every_mode() {
    let limits = LimitConfig { lo: 0.0, hi: 100.0, rate_up: Some(50.0), rate_down: Some(20.0) };
    for mode in Mode::REQUESTS {
        let (law, mut state) =
            start(&ControllerConfig { limits, off_output: Some(0.0), ..config() }, 50.0, 50.0, 40.0);
        let mut before = 40.0;
        for k in 0..300 {
            let far = if k % 60 < 30 { 1e4 } else { -1e4 };
            let wild =
                ControllerInput { r_remote: far, manual: Some(far), track: far, mode, ..input(far, 50.0) };
            let u = law.step(&mut state, &wild).u;
            assert!((0.0..=100.0).contains(&u), "{mode:?}: {u}");
            assert!(u - before <= 5.0 + 1e-9 && before - u <= 2.0 + 1e-9, "{mode:?}: {before} -> {u}");
            before = u;
        }
    }
}

#[test]
fn alarms_have_hysteresis() {
    let alarms = AlarmConfig {
        hi_hi: Some(90.0),
        hi: Some(80.0),
        lo: Some(20.0),
        lo_lo: Some(10.0),
        deviation: Some(15.0),
        hysteresis: 1.0,
    };
    let (law, mut state) = start(&ControllerConfig { alarms, ..config() }, 50.0, 50.0, 40.0);
    let mut at = |y: f64| {
        let bits = law.step(&mut state, &input(50.0, y)).status.bits() >> 16;
        (bits & 1, bits >> 1 & 1, bits >> 2 & 1, bits >> 3 & 1, bits >> 4 & 1)
    };
    assert_eq!(at(60.0), (0, 0, 0, 0, 0));
    assert_eq!(at(66.0), (0, 0, 0, 0, 1));
    assert_eq!(at(80.5), (0, 1, 0, 0, 1));
    assert_eq!(at(91.0), (1, 1, 0, 0, 1));
    assert_eq!(at(89.5), (1, 1, 0, 0, 1));
    assert_eq!(at(79.5), (0, 1, 0, 0, 1));
    assert_eq!(at(64.0), (0, 0, 0, 0, 0));
    assert_eq!(at(19.0), (0, 0, 1, 0, 1));
    assert_eq!(at(5.0), (0, 0, 1, 1, 1));
    assert_eq!(at(10.5), (0, 0, 1, 1, 1));
    assert_eq!(at(35.5), (0, 0, 0, 0, 1));
}

#[test]
fn a_deadband_leaves_small_errors_alone() {
    let (law, mut state) = start(&ControllerConfig { deadband: 0.5, ..config() }, 50.0, 50.0, 40.0);
    for k in 0..10_000 {
        let y = 50.0 + if k % 2 == 0 { 0.4 } else { -0.3 };
        assert_eq!(law.step(&mut state, &input(50.0, y)).u, 40.0);
    }
    let out = law.step(&mut state, &input(50.0, 48.5));
    assert!((out.u - (40.0 + 1.0 + 0.05)).abs() < 1e-12, "{}", out.u);
}
