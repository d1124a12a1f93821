//! Sequences in which controllers go wrong: windup behind flickering measurements, slow ramps in single precision, parts
//! that do not belong together, models on the edge between real and complex poles.

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Accumulator, AntiWindupConfig, Compensate, Compensator, CompensatorInput, Controller, ControllerConfig,
    ControllerInput, Estimator, EstimatorConfig, FallbackAction, FallbackConfig, Limit, LimitConfig, Mode,
    Observer, ObserverConfig, Param, PidConfig, Reason, SetpointConfig, Status,
};

const TS: f64 = 0.1;

fn config() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 100.0),
        ..ControllerConfig::default()
    }
}

fn input(r: f64, y: f64) -> ControllerInput<f64> {
    ControllerInput { r, y, ..ControllerInput::default() }
}

/// Saturated, every m-th measurement bad, or the mode flickering between Auto and Cascade: the integral stays where it is
/// with good measurements.
#[test]
fn anti_windup_survives_flickering_samples_and_modes() {
    for rule in [AntiWindupConfig::default(), AntiWindupConfig::Conditional] {
        let law =
            Controller::<f64>::new(&ControllerConfig { anti_windup: rule, ..config() }, TS).expect("valid");
        let integral = |every: usize, flicker: bool| {
            let mut state = law.zeroed();
            law.settle(&mut state, 50.0, 50.0, 40.0);
            for k in 0..20_000 {
                let y = if every > 0 && k % every == 0 { f64::NAN } else { 50.0 };
                let mode = if flicker && k % 2 == 0 { Mode::Cascade } else { Mode::Auto };
                let _ = law.step(&mut state, &ControllerInput { r_remote: 150.0, mode, ..input(150.0, y) });
            }
            state.pid().integral()
        };
        let clean = integral(0, false);
        for (every, flicker) in [(2, false), (3, false), (7, false), (0, true), (3, true)] {
            let i = integral(every, flicker);
            // One increment (5) may be on its way.
            assert!(
                (i - clean).abs() <= 5.0 + 1e-9,
                "{rule:?} every {every} flicker {flicker}: {i} against {clean}"
            );
        }
    }
}

#[test]
fn a_bad_sample_with_a_mode_change_moves_nothing() {
    for mode in [Mode::Hold, Mode::Off, Mode::Manual] {
        let law = Controller::<f64>::new(&config(), TS).expect("valid");
        let mut state = law.zeroed();
        law.settle(&mut state, 50.0, 50.0, 40.0);
        let out = law.step(&mut state, &ControllerInput { mode, ..input(58.0, f64::NAN) });
        assert_eq!(out.u, 40.0, "{mode:?}");
    }
}

/// `(1 + 0.21 s)^2` written as `1 + 0.42 s + 0.0441 s^2` is complex by one rounding; all such models work.
#[test]
fn critically_damped_models_work() {
    let mut built = 0;
    for n in 1..4000 {
        let tau = f64::from(n) * 1e-3;
        let a2 = (tau * tau * 1e8).round() / 1e8;
        let model = EstimatorConfig { gain: 1.0, a1: 2.0 * tau, a2, dead_time: 0.01, kfd: 0.7, tfd: 0.05 };
        let Ok(law) = Estimator::<f64, 32>::estimator(&model, 0.0, 0.001) else { continue };
        let mut state = law.settled(1.0, 1.0);
        let out = law.step(&mut state, CompensatorInput { y: 1.1, u_applied: 1.0 });
        assert!(out.u_f.is_finite() && out.d_hat.is_finite(), "tau {tau}");
        built += 1;
    }
    assert!(built > 3900, "{built}");
}

#[test]
fn coefficients_that_do_not_fit_single_precision_are_refused() {
    let slow = PlantModel::second_order(1.0, 2e9, 1e18, 0.0).with_pole(Factor::second(2e9, 1e18));
    let config = ObserverConfig { model: slow, alpha: 0.1, order: None }.to_compensator(0.0);
    let single = Observer::<f32, 4, 4>::new(&config, 1.0);
    let faults = match single {
        Err(faults) => faults,
        Ok(law) => Controller::with_compensator(&self::config(), law, 1.0).expect_err("must be refused"),
    };
    assert_eq!(faults[0].param, Param::Overflow);
    // Not hidden by a gain of nothing, either.
    let mut off = config;
    off.gain = 0.0;
    let refused = match Observer::<f32, 4, 4>::new(&off, 1.0) {
        Err(_) => true,
        Ok(law) => Controller::with_compensator(&self::config(), law, 1.0).is_err(),
    };
    assert!(refused);
}

#[test]
fn a_rate_limit_is_reported_only_when_there_is_one() {
    let limit = Limit::<f64>::new(&LimitConfig::range(0.0, 100.0), TS).expect("valid");
    let out = limit.apply(&mut Accumulator::new(50.0), 1000.0);
    assert!(!out.rate && out.high && out.u == 100.0);
}

/// Steps far below one unit in the last place still add up: set-point, output and fallback ramps in single precision.
#[test]
fn slow_ramps_do_not_stall_in_single_precision() {
    let ts = 0.001;
    let config = ControllerConfig {
        pid: PidConfig { kp: 1.0, ..PidConfig::default() },
        limits: LimitConfig { lo: 0.0, hi: 1000.0, rate_up: Some(0.01), rate_down: Some(0.01) },
        setpoint: SetpointConfig { rate_up: Some(0.01), ..SetpointConfig::default() },
        fallback: FallbackConfig {
            hold_samples: 0,
            action: FallbackAction::Ramp { output: 0.0, rate: 0.005 },
            ..FallbackConfig::default()
        },
        ..ControllerConfig::default()
    };
    let law = Controller::<f32>::new(&config, ts).expect("valid");
    let run = |y: f32, r: f32| {
        let mut state = law.zeroed();
        law.settle(&mut state, 500.0, 500.0, 500.0);
        let mut out = Default::default();
        for _ in 0..1_000_000 {
            out = law.step(&mut state, &ControllerInput { r, y, ..ControllerInput::default() });
        }
        out
    };
    let ramped = run(500.0, 600.0);
    assert!((ramped.r - 510.0).abs() < 0.01, "set-point {}", ramped.r);
    assert!((ramped.u - 510.0).abs() < 0.01, "output {}", ramped.u);
    let fallback = run(f32::NAN, 500.0);
    assert!((fallback.u - 495.0).abs() < 0.01, "fallback {}", fallback.u);
}

/// A plant at its new rest after a long gap is not taken for a disturbance, and gaps in pieces count together.
#[test]
fn long_gaps_leave_no_false_disturbance() {
    let model = PlantModel::first_order(1.0, 2.0, 0.5);
    let block = ObserverConfig { model, alpha: 0.5, order: None }.to_compensator(0.0);
    let law = Controller::with_compensator(
        &config(),
        Compensator::<f64, 1, 0, 16>::new(&block, TS).expect("valid"),
        TS,
    )
    .expect("valid");
    let mut state = law.zeroed();
    law.settle(&mut state, 0.0, 0.0, 10.0);
    law.advance(&mut state, 10_000);
    for _ in 0..200 {
        let manual = ControllerInput { mode: Mode::Manual, manual: Some(10.0), ..input(0.0, 10.0) };
        let d_hat = law.step(&mut state, &manual).d_hat;
        assert!(d_hat.abs() < 1e-9, "{d_hat}");
    }
    let mut pieces = law.zeroed();
    law.settle(&mut pieces, 40.0, 40.0, 40.0);
    for _ in 0..100 {
        law.advance(&mut pieces, 20);
    }
    let out = law.step(&mut pieces, &input(40.0, 70.0));
    assert!(out.u == 40.0 && out.status.has(Status::OVERRUN), "{}", out.u);
}

#[test]
fn adopting_in_manual_owes_nothing() {
    let law = Controller::<f64>::new(&config(), TS).expect("valid");
    let mut state = law.zeroed();
    law.settle(&mut state, 50.0, 50.0, 40.0);
    let manual = ControllerInput { mode: Mode::Manual, manual: Some(1e9), ..input(50.0, 50.0) };
    let _ = law.step(&mut state, &manual);
    let before = state.pid().integral();
    law.adopt(&law, &mut state);
    assert_eq!(state.pid().integral(), before);
}

#[test]
fn without_any_usable_set_point_the_loop_stays() {
    let law = Controller::<f64>::new(&config(), TS).expect("valid");
    let mut state = law.zeroed();
    for _ in 0..50 {
        let out = law.step(&mut state, &ControllerInput { u_applied: Some(60.0), ..input(f64::NAN, 77.0) });
        assert!((out.u - 60.0).abs() < 1e-9 && out.status.has(Status::REJECTED));
    }
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let block = |gain| {
        let model = PlantModel::first_order(gain, 10.0, 1.0);
        ObserverConfig { model, alpha: 1.0, order: None }.to_compensator(0.0)
    };
    let other_period = Compensator::<f64, 1, 0, 256>::new(&block(1.0), 0.01).expect("valid");
    let faults = Controller::with_compensator(&config(), other_period, TS).expect_err("another period");
    assert_eq!((faults[0].param, faults[0].reason), (Param::Ts, Reason::Mismatch));
    let other_sign = Compensator::<f64, 1, 0, 256>::new(&block(-1.0), TS).expect("valid");
    let faults = Controller::with_compensator(&config(), other_sign, TS).expect_err("another sign");
    assert_eq!((faults[0].param, faults[0].reason), (Param::ModelGain, Reason::SignMismatch));
    let off = ControllerConfig { off_output: Some(-500.0), ..config() };
    assert_eq!(Controller::<f64>::new(&off, TS).expect_err("out of range")[0].param, Param::OffOutput);
}

/// Every field wrong at once: every one is named.
#[test]
fn all_faults_of_a_configuration_come_at_once() {
    let nan = f64::NAN;
    let bad = ControllerConfig {
        pid: PidConfig { kp: nan, ki: nan, kd: nan, tf: -1.0, b: 3.0, c: -1.0, ..PidConfig::default() },
        limits: LimitConfig { lo: nan, hi: nan, rate_up: Some(0.0), rate_down: Some(-1.0) },
        setpoint: SetpointConfig { lo: nan, hi: nan, rate_up: Some(nan), rate_down: Some(0.0), track: false },
        anti_windup: AntiWindupConfig::BackCalculation { tt: Some(0.0) },
        deadband: -1.0,
        measurement_lo: nan,
        measurement_hi: nan,
        offset_lo: nan,
        offset_hi: nan,
        initial_output: nan,
        ..ControllerConfig::default()
    };
    let faults = Controller::<f64>::new(&bad, TS).expect_err("all of it is wrong");
    let expected = [
        Param::Kp,
        Param::Ki,
        Param::Kd,
        Param::Tf,
        Param::B,
        Param::C,
        Param::OutputLo,
        Param::OutputHi,
        Param::OutputRateUp,
        Param::OutputRateDown,
        Param::SetpointLo,
        Param::SetpointHi,
        Param::SetpointRateUp,
        Param::SetpointRateDown,
        Param::Tt,
        Param::Deadband,
        Param::MeasurementLo,
        Param::MeasurementHi,
        Param::OffsetLo,
        Param::OffsetHi,
        Param::InitialOutput,
    ];
    for param in expected {
        assert!(faults.iter().any(|f| f.param == param), "{param:?} is missing");
    }
    assert!(faults.iter().all(|f| f.to_string().starts_with(f.param.name())));
}

/// The whole loop's `resolution` is far below where a plain sum stops (about 3.8 here), and errors in between do move the
/// output. (The bound itself is measured in `precision.rs`; errors near it take years to show.)
#[test]
fn resolution_of_a_whole_loop() {
    let config = ControllerConfig {
        pid: PidConfig { kp: 0.0, ki: 1e-3, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 64.0),
        ..ControllerConfig::default()
    };
    let ts = 0.001;
    let law = Controller::<f32>::new(&config, ts).expect("valid");
    let moved = |e: f64| {
        let mut state = law.zeroed();
        law.settle(&mut state, 0.0, 0.0, 63.9);
        let wide = ControllerInput { r: e as f32, y: 0.0, ..ControllerInput::default() };
        // An increment of e*ki*ts needs about this many samples to fill a unit in the last place.
        let unit = 64.0 * f64::from(f32::EPSILON);
        let samples = (3.0 * unit / (e * 1e-6)).min(3e7) as u64;
        (0..samples).any(|_| law.step(&mut state, &wide).u != 63.9_f32)
    };
    let stated = law.resolution();
    assert!(stated < 1e-2, "{stated:e}");
    assert!(moved(1.0) && moved(0.5), "errors a plain sum cannot see must move the output");
}

#[test]
fn the_trait_knows_the_period_and_the_sign() {
    let model = PlantModel::first_order(-2.0, 10.0, 1.0);
    let block = ObserverConfig { model, alpha: 1.0, order: None }.to_compensator(0.0);
    let law = Compensator::<f64, 1, 0, 32>::new(&block, TS).expect("valid");
    assert_eq!((law.ts(), law.inv_gain()), (Some(TS), -0.5));
}
