//! Saturation: the loop comes back, with the estimator and the observer in it, and never locks up.

use controller_core::{AntiWindupConfig, ControllerConfig, EstimatorConfig, LimitConfig, PidConfig};
use controller_sim_host::scenario::{Actuator, Change, ControllerSpec, Scenario, Signal};
use controller_sim_host::simulate::{RunOptions, run};
use controller_tests::cases::{SETPOINT_STEP, chapter_controllers, from_rest, limited, pi_with_observer};
use controller_tests::oracle::de_cases::CASES;
use controller_tests::oracle::dob_cases;
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::rig::{Rig, law};

const BACK: AntiWindupConfig = AntiWindupConfig::BackCalculation { tt: None };

fn iae(scenario: &Scenario) -> f64 {
    run(scenario, RunOptions::default()).expect("valid parameters").controllers[0].total.iae
}

fn with_rule(mut spec: ControllerSpec, rule: AntiWindupConfig) -> ControllerSpec {
    spec.config.anti_windup = rule;
    spec
}

/// G_P5, unit set-point step, `|u| <= 2`, estimator on: the chapter's reference gives 0.568 with the model fed by the
/// saturated output, 1.19 with the unsaturated one.
#[test]
fn tracking_of_gp5_with_a_limited_output() {
    let case = &CASES[4];
    let spec = chapter_controllers(case).remove(2);
    let scenario = |spec, actuator| Scenario {
        actuator,
        ..from_rest(&case.plant, case.ts, case.horizon, SETPOINT_STEP, vec![spec])
    };
    let inside = |rule| scenario(with_rule(limited(spec.clone(), -2.0, 2.0), rule), Actuator::default());
    let back = iae(&inside(BACK));
    let conditional = iae(&inside(AntiWindupConfig::Conditional));
    let none = iae(&inside(AntiWindupConfig::None));
    let range = Actuator { lo: -2.0, hi: 2.0, read_back: true, ..Actuator::default() };
    let downstream = iae(&scenario(with_rule(limited(spec.clone(), -100.0, 100.0), BACK), range));
    let blind = Actuator { read_back: false, ..range };
    let unsaturated = iae(&scenario(with_rule(limited(spec, -100.0, 100.0), BACK), blind));
    println!(
        "G_P5 |u| <= 2: back-calculation {back:.4}, conditional {conditional:.4}, none {none:.4}, read-back {downstream:.4}, blind {unsaturated:.4}"
    );
    assert!(back <= 0.575, "{back}");
    assert!((downstream / back - 1.0).abs() <= 0.01, "{downstream} against {back}");
    assert!(unsaturated > 0.8, "feeding the unsaturated output must show: {unsaturated}");
    assert!(none > 0.8, "no anti-windup must show: {none}");
}

/// `exp(-20s)/(1+80s)`, true PI for Ms 1.2, alpha 10 s, `|u| <= 0.6`, a disturbance of 1 for 600 s.
#[test]
fn an_observer_in_saturation() {
    let case = &dob_cases::CASES[1];
    let pulse = Change::Disturbance(Signal::Pulse { height: 1.0, duration: 600.0 });
    let spec = pi_with_observer(&case.plant, case.kp, case.ki, Some(10.0));
    for per_dead_time in [20.0, 100.0] {
        let ts = case.plant.dead_time / per_dead_time;
        let scenario = |spec, actuator| Scenario {
            actuator,
            ..from_rest(&case.plant, ts, 1200.0, pulse.clone(), vec![spec])
        };
        let inside = |rule| scenario(with_rule(limited(spec.clone(), -0.6, 0.6), rule), Actuator::default());
        let conditional = iae(&inside(AntiWindupConfig::Conditional));
        let back = iae(&inside(BACK));
        let range = Actuator { lo: -0.6, hi: 0.6, read_back: true, ..Actuator::default() };
        let wide =
            |rule, actuator| iae(&scenario(with_rule(limited(spec.clone(), -50.0, 50.0), rule), actuator));
        let downstream = wide(BACK, range);
        let downstream_conditional = wide(AntiWindupConfig::Conditional, range);
        let unsaturated = wide(BACK, Actuator { read_back: false, ..range });
        println!(
            "T/Ts {per_dead_time}: conditional {conditional:.1}, back-calculation {back:.1}, read-back {downstream:.1} / {downstream_conditional:.1}, unsaturated {unsaturated:.1}"
        );
        assert!(conditional <= 241.0, "{conditional}");
        assert!(back <= 263.0, "{back}");
        assert!((downstream / back - 1.0).abs() <= 0.01, "{downstream} against {back}");
        assert!((downstream_conditional / conditional - 1.0).abs() <= 0.01, "{downstream_conditional}");
        assert!(unsaturated > 440.0, "{unsaturated}");
    }
}

const LAG: PlantFactors<'static> = PlantFactors { lags: &[1.0], dead_time: 0.1, ..PlantFactors::UNITY };

fn rig(pid: PidConfig, rule: AntiWindupConfig, (lo, hi): (f64, f64), plant: &PlantFactors<'_>) -> Rig<f64> {
    let config = ControllerConfig {
        pid,
        limits: LimitConfig::range(lo, hi),
        anti_windup: rule,
        ..ControllerConfig::default()
    };
    let unused = EstimatorConfig { gain: plant.gain, a1: 1.0, a2: 0.0, dead_time: 0.1, kfd: 0.5, tfd: 0.2 };
    let mut rig =
        Rig::new(law(&config, &unused.to_compensator(0.0), 0.02).expect("valid"), plant.sampled(0.02));
    rig.input.compensate = false;
    rig
}

fn settle(rig: &mut Rig<f64>, seconds: f64) -> f64 {
    for _ in 0..(seconds / 0.02) as usize {
        let _ = rig.step();
    }
    rig.y()
}

/// I-only, P-only, `kp <= 0`: a set-point out of reach for long, then one in reach.
#[test]
fn odd_controllers_come_back_from_the_limit() {
    for rule in [BACK, AntiWindupConfig::Conditional] {
        for (name, kp, ki) in [("I only", 0.0, 0.4), ("negative kp", -0.05, 0.2), ("PI", 2.0, 1.0)] {
            let pid = PidConfig { kp, ki, ..PidConfig::default() };
            let mut rig = rig(pid, rule, (-1.0, 1.0), &LAG);
            rig.input.r = 5.0;
            let stuck = settle(&mut rig, 100.0);
            assert!((stuck - 1.0).abs() < 1e-6, "{name} {rule:?}: {stuck}");
            rig.input.r = 0.5;
            // It leaves the limit within a second (conditional: nothing was added; back-calculation: v near the limit).
            let left =
                (0..).take(1000).position(|_| rig.step().u < 1.0).expect("leaves the limit") as f64 * 0.02;
            let back = settle(&mut rig, 60.0);
            assert!((back - 0.5).abs() < 1e-4, "{name} {rule:?}: {back}");
            println!("{name} {rule:?}: leaves the limit after {left:.2} s");
            // I only: back-calculation may let v stand ki*tt*e above the limit, tt = ts.
            assert!(left <= 8.0, "{name} {rule:?}: {left}");
        }
        // Without an integral term the bias is untouched by saturation.
        let mut p_only = rig(PidConfig { kp: 3.0, ..PidConfig::default() }, rule, (-1.0, 1.0), &LAG);
        p_only.input.r = 10.0;
        settle(&mut p_only, 20.0);
        p_only.input.r = 0.2;
        let y = settle(&mut p_only, 40.0);
        assert!((y - 0.2 * 3.0 / 4.0).abs() < 1e-9, "P only {rule:?}: {y}");
        assert_eq!(p_only.state.pid().integral(), 0.0);
    }
}

/// The case that locks up the form `I -= ts*e` of the literature: the upper limit moves below the running output, then
/// a load of the other sign frees the loop.
#[test]
fn a_limit_below_the_running_output_does_not_lock_up() {
    for rule in [BACK, AntiWindupConfig::Conditional] {
        for compensate in [false, true] {
            let pid = PidConfig { kp: 1.5, ki: 1.0, ..PidConfig::default() };
            let mut rig = rig(pid, rule, (-2.0, 2.0), &LAG);
            rig.input.compensate = compensate;
            rig.input.r = 1.0;
            settle(&mut rig, 40.0);
            let tight = ControllerConfig {
                pid,
                limits: LimitConfig::range(-2.0, 0.8),
                anti_windup: rule,
                ..ControllerConfig::default()
            };
            let unused = EstimatorConfig { gain: 1.0, a1: 1.0, a2: 0.0, dead_time: 0.1, kfd: 0.5, tfd: 0.2 };
            let fresh = law(&tight, &unused.to_compensator(0.0), 0.02).expect("valid");
            fresh.adopt(&rig.law, &mut rig.state);
            rig.law = fresh;
            let stuck = settle(&mut rig, 60.0);
            assert!((stuck - 0.8).abs() < 1e-3, "{rule:?}: {stuck}");
            rig.d = 0.6;
            let free = settle(&mut rig, 60.0);
            assert!((free - 1.0).abs() < 1e-6, "{rule:?} compensate {compensate}: {free}");
        }
    }
}
