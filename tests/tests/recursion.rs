//! The runtime sample by sample against recursions written independently: direct-form polynomials for PI and observer,
//! the chapter's parallel PID by Tustin's rule; saturation and anti-windup included. `f64` to 1e-9 of the signals' size
//! (1e-7 for orders where the direct form itself is not better), `f32` to 1e-4.

use controller_core::{AntiWindupConfig, ControllerConfig, LimitConfig, ObserverConfig, PidConfig, Real};
use controller_tests::cases::{model, pid};
use controller_tests::oracle::de_cases::CASES as DE_CASES;
use controller_tests::oracle::dob_discrete::{AntiWindup, Observer, ObserverFilter, PiWithObserver};
use controller_tests::oracle::hold_polynomials::HoldPolynomials;
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::oracle::structure_a::StructureA;
use controller_tests::rig::{Rig, law};

const TS: f64 = 0.05;

struct Case {
    name: &'static str,
    plant: PlantFactors<'static>,
    kp: f64,
    ki: f64,
    alpha: f64,
    /// Filter poles at alpha, and plant zeros that become poles of the filter.
    lags: usize,
    zero_lags: &'static [f64],
}

const CASES: [Case; 6] = [
    Case {
        name: "first order",
        plant: PlantFactors { gain: 1.98, lags: &[8.0], dead_time: 0.32, ..PlantFactors::UNITY },
        kp: 2.0,
        ki: 0.4,
        alpha: 0.5,
        lags: 1,
        zero_lags: &[],
    },
    Case {
        name: "second order",
        plant: PlantFactors { lags: &[1.0, 0.5], dead_time: 0.2, ..PlantFactors::UNITY },
        kp: 1.0,
        ki: 0.7,
        alpha: 0.3,
        lags: 2,
        zero_lags: &[],
    },
    Case {
        name: "third order",
        plant: PlantFactors { lags: &[1.0, 0.7, 0.4], dead_time: 0.234, ..PlantFactors::UNITY },
        kp: 0.8,
        ki: 0.5,
        alpha: 0.4,
        lags: 3,
        zero_lags: &[],
    },
    Case {
        name: "complex pair",
        plant: PlantFactors { gain: 2.0, pairs: &[(0.8, 1.0)], dead_time: 0.15, ..PlantFactors::UNITY },
        kp: 0.1,
        ki: 0.2,
        alpha: 0.4,
        lags: 2,
        zero_lags: &[],
    },
    Case {
        name: "integrating",
        plant: PlantFactors {
            gain: 0.5,
            integrators: 1,
            lags: &[0.4],
            dead_time: 0.2,
            ..PlantFactors::UNITY
        },
        kp: 0.9,
        ki: 0.12,
        alpha: 0.4,
        lags: 2,
        zero_lags: &[],
    },
    Case {
        name: "slow zero",
        plant: PlantFactors {
            lags: &[2.0, 0.5],
            zeros: &[(0.6, 0.0)],
            dead_time: 0.3,
            ..PlantFactors::UNITY
        },
        kp: 0.9,
        ki: 0.6,
        alpha: 0.3,
        lags: 1,
        zero_lags: &[0.6],
    },
];

/// Largest difference of the outputs over a run with steps, a disturbance and saturation, over the largest output.
fn difference<T: Real>(case: &Case, rule: AntiWindupConfig, theirs: AntiWindup) -> f64 {
    // Just below what the set-point of 1 needs: the loop saturates for long, then comes back.
    let limit = if case.plant.integrators > 0 { 0.3 } else { 0.97 / case.plant.gain };
    let config = ControllerConfig {
        pid: PidConfig { kp: case.kp, ki: case.ki, ..PidConfig::default() },
        limits: LimitConfig::range(-limit, limit),
        anti_windup: rule,
        ..ControllerConfig::default()
    };
    let block =
        ObserverConfig { model: model(&case.plant), alpha: case.alpha, order: None }.to_compensator(0.0);
    let mut rig = Rig::<T>::new(law(&config, &block, TS).expect("valid"), case.plant.sampled(TS));
    let filter = ObserverFilter {
        gain: 1.0,
        alpha: case.alpha,
        lags: case.lags,
        averages: 0,
        zero_lags: case.zero_lags,
    };
    let observer = Observer::new(&HoldPolynomials::new(&case.plant, TS), filter, TS);
    let mut direct =
        PiWithObserver::new(case.kp, case.ki, Some(observer), TS).with_limits((-limit, limit), theirs);
    let (mut worst, mut largest, mut saturated) = (0.0_f64, 0.0_f64, 0);
    for k in 0..1500 {
        let r = match k {
            0..400 => 1.0,
            400..800 => -0.5,
            _ => 0.3,
        };
        rig.input.r = T::from_f64(r);
        rig.d = if (200..900).contains(&k) { 0.35 * limit } else { 0.0 };
        // Both see the same measurements: those of the runtime's own plant, as T holds them.
        let y = T::from_f64(rig.y()).to_f64();
        let expected = direct.step(T::from_f64(r).to_f64(), y).u;
        let u = rig.step().u.to_f64();
        worst = worst.max((u - expected).abs());
        largest = largest.max(expected.abs());
        saturated += usize::from(expected.abs() == limit);
    }
    assert!(saturated >= 5, "{} does not saturate: {saturated} samples", case.name);
    worst / largest
}

#[test]
fn pi_and_observer_against_direct_form() {
    for case in &CASES {
        let tt = (case.kp / case.ki).max(TS);
        for (rule, theirs) in [
            (AntiWindupConfig::default(), AntiWindup::BackCalculation { tt }),
            (AntiWindupConfig::Conditional, AntiWindup::Conditional),
            (AntiWindupConfig::None, AntiWindup::Off),
        ] {
            let double = difference::<f64>(case, rule, theirs);
            let single = difference::<f32>(case, rule, theirs);
            println!("{:14} {theirs:?}: f64 {double:.1e}, f32 {single:.1e}", case.name);
            assert!(double <= 1e-9, "{} {theirs:?}: {double:e}", case.name);
            assert!(single <= 1e-4, "{} {theirs:?}: {single:e}", case.name);
        }
    }
}

#[test]
fn the_pid_against_the_parallel_form_of_the_chapter() {
    for case in &DE_CASES {
        for gains in [&case.momi, &case.drmo] {
            for limits in [(-1e5, 1e5), (-1.2, 1.2)] {
                // Their anti-windup has the time constant KP/KI whatever T_F is.
                let config = ControllerConfig {
                    pid: pid(gains),
                    limits: LimitConfig::range(limits.0, limits.1),
                    anti_windup: AntiWindupConfig::BackCalculation { tt: Some(gains.kp / gains.ki) },
                    ..ControllerConfig::default()
                };
                let law = controller_core::Controller::<f64>::new(&config, case.ts).expect("valid");
                let mut state = law.zeroed();
                law.settle(&mut state, 0.0, 0.0, 0.0);
                let mut theirs = StructureA::new(*gains, None, limits, case.ts);
                let mut plant = case.plant.sampled(case.ts);
                let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
                for k in 0..(case.horizon / case.ts) as usize {
                    let r = if k % 3000 < 1500 { 1.0 } else { -1.0 };
                    let y = plant.output();
                    let input = controller_core::ControllerInput { r, y, ..Default::default() };
                    let u = law.step(&mut state, &input).u;
                    let expected = theirs.step(r, y).u;
                    worst = worst.max((u - expected).abs());
                    largest = largest.max(expected.abs());
                    let _ = plant.step(u, 0.1);
                }
                assert!(worst <= 1e-9 * largest, "{} limits {limits:?}: {worst:e} of {largest}", case.name);
            }
        }
    }
}
