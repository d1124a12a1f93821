//! Single cases. Each of them was wrong once, or would be with a plausible shortcut.

use super::built::{AnyBlock, Block, Built, saved};
use super::configs::Case;
use super::driven::Driven;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    CompensatorConfig, ControllerConfig, ControllerInput, ControllerOutput, ControllerState, FallbackAction,
    FallbackConfig, LimitConfig, Mode, NoCompensator, ObserverConfig, PidConfig, Real, SetpointConfig,
};

fn case(ts: f64, config: ControllerConfig, model: PlantModel) -> Case {
    let observer = ObserverConfig { model, alpha: 2.0 * ts, order: None };
    Case { ts, config, block: observer.to_compensator(0.0) }
}

fn lags(gain: f64, taus: &[f64]) -> PlantModel {
    let gain = PlantModel { gain, ..PlantModel::default() };
    taus.iter().fold(gain, |model, &tau| model.with_pole(Factor::first(tau)))
}

fn pi() -> ControllerConfig {
    let pid = PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() };
    ControllerConfig { pid, ..ControllerConfig::default() }
}

fn built<T: Real, C: Block<T>>(case: &Case) -> Built<T, C> {
    Built::new(case).unwrap_or_else(|faults| panic!("{case:?}: {faults}"))
}

fn is_finite<T: Real>(out: &ControllerOutput<T>) -> bool {
    [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].iter().all(|x| x.is_finite_number())
}

/// A state that nothing has happened to yet takes the shape of the law it is handed to.
#[test]
fn a_zeroed_state_takes_the_shape_of_the_next_law() {
    let first = built::<f64, AnyBlock<f64>>(&case(0.1, pi(), lags(1.0, &[1.0])));
    let third = built::<f64, AnyBlock<f64>>(&case(0.1, pi(), lags(1.0, &[3.0, 2.0, 1.0])));
    let mut state = ControllerState::over(first.law.compensator().blank());
    third.law.adopt(&first.law, &mut state);
    let mut fresh = ControllerState::over(third.law.compensator().blank());
    for k in 0..20 {
        let input = ControllerInput { y: f64::from(k), ..ControllerInput::default() };
        let (out, expected) = (third.law.step(&mut state, &input), third.law.step(&mut fresh, &input));
        assert_eq!(out, expected, "sample {k}");
    }
    assert_eq!(saved(&third.law, &state), saved(&third.law, &fresh));
}

/// With another sampling period the compensator settles; it has the shape of the new law all the same.
#[test]
fn a_law_of_another_shape_and_period_settles_in_its_own_shape() {
    let first = built::<f64, AnyBlock<f64>>(&case(0.1, pi(), lags(1.0, &[1.0])));
    let third = built::<f64, AnyBlock<f64>>(&case(0.2, pi(), lags(1.0, &[3.0, 2.0, 1.0])));
    let laws = [first, third];
    let mut driven = Driven::new(&laws);
    driven.step(&laws[0].good()).expect("a step");
    laws[1].law.adopt(&laws[0].law, &mut driven.state);
    let mut fresh = ControllerState::over(laws[1].law.compensator().blank());
    laws[1].law.settle(&mut fresh, 0.0, 0.0, driven.state.u());
    for k in 0..20 {
        let input = ControllerInput { mode: Mode::Hold, y: f64::from(k), ..ControllerInput::default() };
        let out = laws[1].law.step(&mut driven.state, &input);
        let expected = laws[1].law.step(&mut fresh, &input);
        assert_eq!((out.u_f, out.d_hat), (expected.u_f, expected.d_hat), "sample {k}");
    }
}

/// A share of zero, or a model of huge gain, does not hide that the path of the measurement overflows on the way.
#[test]
fn an_overflow_inside_the_compensator_is_seen_whatever_it_is_multiplied_by() {
    for (share, gain) in [(0.0, 1.0), (1e-30, 1.0), (1.0, 1e15)] {
        let slow = lags(gain, &[3e8; 5]);
        let mut case = case(1.0, pi(), slow);
        case.block = CompensatorConfig { gain: share, time_constant: 0.1, ..case.block };
        let Ok(built) = Built::<f32, AnyBlock<f32>>::new(&case) else { continue };
        let mut state = ControllerState::over(built.law.compensator().blank());
        for y in [0.0, 1e6, -1e6, 1e6] {
            let out = built.law.step(&mut state, &ControllerInput { y, ..ControllerInput::default() });
            assert!(is_finite(&out), "share {share}, gain {gain}: {out:?}");
        }
    }
}

/// Signals of the old law may be far outside the ranges for which the new one was shown not to overflow.
#[test]
fn a_swap_to_narrow_ranges_and_large_gains_stays_finite() {
    let wide = ControllerConfig { measurement_lo: -1e12, measurement_hi: 1e12, ..pi() };
    let narrow = ControllerConfig {
        pid: PidConfig { ki: 1e15, tf: 1e12, ..PidConfig::default() },
        measurement_lo: -1.0,
        measurement_hi: 1.0,
        setpoint: SetpointConfig { lo: -1.0, hi: 1.0, ..SetpointConfig::default() },
        ..ControllerConfig::default()
    };
    let cases = [case(1.0, wide, lags(1.0, &[1.0])), case(1.0, narrow, lags(1.0, &[1.0]))];
    let laws = cases.map(|case| built::<f32, NoCompensator>(&case));
    let mut driven = Driven::new(&laws);
    driven.step(&ControllerInput { y: 1e12, ..ControllerInput::default() }).expect("a step");
    driven.swap(1).expect("a swap");
    driven.check_state().expect("a finite state");
    driven.recover().expect("good samples");
}

/// As above for the outputs in the delay line and the lags of the compensator.
#[test]
fn a_swap_to_a_narrow_output_and_a_steep_model_stays_finite() {
    let wide = ControllerConfig { limits: LimitConfig::range(-1e12, 1e12), ..pi() };
    let narrow = ControllerConfig {
        limits: LimitConfig::range(-1e-6, 1e-6),
        measurement_lo: -1e-6,
        measurement_hi: 1e-6,
        ..pi()
    };
    let steep = lags(1.0, &[1e9; 4]);
    let mut cases = [case(1.0, wide, lags(1.0, &[1.0; 4])), case(1.0, narrow, steep)];
    cases[1].block.time_constant = 0.1;
    let laws = cases.map(|case| built::<f32, AnyBlock<f32>>(&case));
    let mut driven = Driven::new(&laws);
    for k in 0..8_u8 {
        let sign = if k & 1 == 0 { 1.0 } else { -1.0 };
        let input = ControllerInput {
            mode: Mode::Manual,
            manual: Some(sign * 1e12),
            y: sign * 1e6,
            ..ControllerInput::default()
        };
        driven.step(&input).expect("a step");
    }
    driven.swap(1).expect("a swap");
    driven.check_state().expect("a finite state");
    driven.recover().expect("good samples");
}

/// A manual value far outside the range is no debt of the anti-windup rule.
#[test]
fn a_swap_in_manual_mode_does_not_add_the_wanted_value_to_the_integral_term() {
    let config = ControllerConfig {
        pid: PidConfig { ki: 1e12, tf: 1e12, ..PidConfig::default() },
        anti_windup: controller_core::AntiWindupConfig::BackCalculation { tt: Some(1.0) },
        ..ControllerConfig::default()
    };
    let laws = [built::<f32, NoCompensator>(&case(1.0, config, lags(1.0, &[1.0])))];
    for (manual, y) in [(f32::MAX, 1e6), (f32::MAX, -1e6), (f32::MIN, 1e6), (f32::MIN, -1e6)] {
        let mut driven = Driven::new(&laws);
        let input =
            ControllerInput { mode: Mode::Manual, manual: Some(manual), y, ..ControllerInput::default() };
        driven.step(&input).expect("a step");
        let before = driven.state.pid().integral();
        driven.swap(0).expect("a swap");
        driven.check_state().expect("a finite state");
        assert_eq!(driven.state.pid().integral(), before, "a swap to the same law");
    }
}

/// Slow ramps arrive: a step per sample that is lost in the rounding of a large signal still adds up.
#[test]
fn slow_ramps_arrive_in_single_precision() {
    // A rate of 0.01 per second sampled every millisecond: 1e-5 a sample, at 500 less than half a unit in the last place.
    let rate = Some(0.01);
    let config = ControllerConfig {
        setpoint: SetpointConfig { rate_up: rate, rate_down: rate, ..SetpointConfig::default() },
        limits: LimitConfig { rate_up: rate, rate_down: rate, ..LimitConfig::default() },
        fallback: FallbackConfig {
            hold_samples: 0,
            action: FallbackAction::Ramp { output: 600.0, rate: 0.01 },
            ..FallbackConfig::default()
        },
        ..pi()
    };
    let built = built::<f32, NoCompensator>(&case(1e-3, config, lags(1.0, &[1.0])));
    let settled = || {
        let mut state = ControllerState::over(());
        built.law.settle(&mut state, 500.0, 500.0, 500.0);
        state
    };
    let after = |input: ControllerInput<f32>| {
        let mut state = settled();
        (0..100_000).map(|_| built.law.step(&mut state, &input)).last().expect("samples")
    };
    let setpoint =
        after(ControllerInput { mode: Mode::Hold, r: 600.0, y: 500.0, ..ControllerInput::default() });
    let output = after(ControllerInput {
        mode: Mode::Manual,
        manual: Some(600.0),
        y: 500.0,
        ..ControllerInput::default()
    });
    let fallback = after(ControllerInput { y: f32::NAN, ..ControllerInput::default() });
    // One unit after 100 s; a unit in the last place at 500 is 3e-5.
    let near = |x: f32| (x - 501.0).abs() < 1e-3;
    let found = [setpoint.r, output.u, fallback.u];
    assert!(found.iter().all(|&x| near(x)), "set-point, output, fallback: {found:?}");
}

/// A loop that comes back after many lost samples at rest sees no disturbance where there is none.
#[test]
fn lost_samples_leave_no_false_disturbance() {
    let (ts, tau) = (0.1, 10.0);
    let built = built::<f64, AnyBlock<f64>>(&case(ts, pi(), lags(1.0, &[tau])));
    let mut state = ControllerState::over(built.law.compensator().blank());
    built.law.settle(&mut state, 0.0, 0.0, 0.0);
    let g = 1.0 - (-ts / tau).exp();
    let mut y = 0.0;
    let mut input = ControllerInput { mode: Mode::Manual, manual: Some(1.0), ..ControllerInput::default() };
    for k in 0..100 {
        if k == 2 {
            // The plant goes on to its new rest while the task does not run.
            built.law.advance(&mut state, 10_000);
            y = 1.0;
        }
        input.y = y;
        let out = built.law.step(&mut state, &input);
        assert!(out.d_hat.abs() < 1e-9, "sample {k}: {out:?}");
        y += g * (out.u - y);
    }
}

/// Two swaps between two samples are one: nothing jumps by what the first of them has already absorbed.
#[test]
fn two_swaps_in_a_row_bump_no_more_than_one() {
    let model = || lags(1.0, &[10.0]);
    let mut cases = [case(0.1, pi(), model()), case(0.1, pi(), model()), case(0.2, pi(), model())];
    cases[1].block.gain = 0.5;
    let laws = cases.map(|case| built::<f64, AnyBlock<f64>>(&case));
    let next = |swaps: &[usize]| {
        let mut driven = Driven::new(&laws);
        // A measurement that moves while the output is held is a disturbance.
        for k in 0..20 {
            let y = 0.05 * f64::from(k);
            driven.step(&ControllerInput { y, ..ControllerInput::default() }).expect("a step");
        }
        for &to in swaps {
            driven.swap(to).expect("a swap");
        }
        driven.step(&ControllerInput { y: 0.95, ..ControllerInput::default() }).expect("a step").u
    };
    let (once, twice) = (next(&[2]), next(&[1, 2]));
    assert!((once - twice).abs() < 1e-9, "{once} after one swap, {twice} after two");
}
