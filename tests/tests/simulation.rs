//! The simulator's plant against an independent state space and closed forms: dead time, latency, disturbances off the
//! sampling grid, all exact.

use controller_core::{LimitConfig, Mode, PidConfig};
use controller_sim_host::scenario::{Change, ControllerSpec, Event, Initial, Noise, Signal};
use controller_sim_host::simulate::{ClosedLoop, EventKind, Metrics, Precision, RunOptions, run};
use controller_tests::cases::{SETPOINT_STEP, from_rest, transfer_function};
use controller_tests::oracle::state_space::PlantFactors;

const PLANTS: [PlantFactors<'static>; 7] = [
    PlantFactors { lags: &[1.0], dead_time: 0.234, ..PlantFactors::UNITY },
    PlantFactors { gain: 2.5, lags: &[1.0, 0.2, 0.04, 0.008], ..PlantFactors::UNITY },
    PlantFactors { lags: &[1.0, 1.0, 1.0, 1.0], dead_time: 0.517, ..PlantFactors::UNITY },
    PlantFactors { lags: &[2.0, 0.5], zeros: &[(-0.3, 0.0)], dead_time: 0.1, ..PlantFactors::UNITY },
    PlantFactors { gain: 0.4, integrators: 1, lags: &[0.5], dead_time: 0.31, ..PlantFactors::UNITY },
    PlantFactors { pairs: &[(0.5, 1.0)], zeros: &[(0.3, 0.0)], dead_time: 0.05, ..PlantFactors::UNITY },
    PlantFactors { integrators: 2, lags: &[0.1], dead_time: 0.02, ..PlantFactors::UNITY },
];

#[test]
fn outputs_at_the_samples_agree_with_the_state_space() {
    let ts = 0.05;
    for plant in &PLANTS {
        for latency in [0.0, 0.4 * ts, ts, 1.73 * ts] {
            let late = PlantFactors { dead_time: plant.dead_time + latency, ..*plant };
            let mut theirs = late.sampled(ts);
            let (mut ours, u0) =
                ClosedLoop::new(&transfer_function(plant), ts, latency, 7, (0.0, 0.0), &[]).expect("rests");
            assert_eq!(u0, 0.0);
            let mut largest = 0.0_f64;
            for k in 0..600_u32 {
                let u = (f64::from(k) * 0.31).sin() + if k % 50 < 25 { 0.5 } else { -0.5 };
                let y = theirs.step(u, 0.0);
                largest = largest.max(y.abs());
                let error = (ours.measure() - y).abs();
                assert!(
                    error <= 1e-11 * (1.0 + largest),
                    "{plant:?} latency {latency} sample {k}: {error:e}"
                );
                ours.hold(u, |_| {});
            }
        }
    }
}

/// A disturbance that begins between samples, through a dead time that is no multiple of the period: at any time the
/// response of a lag is `K*(1-exp(-(t-t0-T)/tau))`; a ramp `slope*K*((t') - tau*(1-exp(-t'/tau)))`; a pulse their
/// difference. The steps between the samples are exact, too.
#[test]
fn disturbances_off_the_grid_follow_closed_forms() {
    let (gain, tau, dead, ts) = (2.0, 0.7, 0.123, 0.05);
    let plant = PlantFactors { gain, lags: &[0.7], dead_time: dead, ..PlantFactors::UNITY };
    let step = |t: f64| if t > 0.0 { gain * (1.0 - (-t / tau).exp()) } else { 0.0 };
    let ramp = |t: f64| if t > 0.0 { gain * (t - tau * (1.0 - (-t / tau).exp())) } else { 0.0 };
    let list = [
        (0.313, Signal::Step(1.5)),
        (0.5, Signal::Ramp { slope: 0.8, duration: 1.017 }),
        (0.777, Signal::Pulse { height: -2.0, duration: 0.0311 }),
        (1.9, Signal::Step(0.25)),
    ];
    let exact = |t: f64| {
        let t = t - dead;
        1.5 * step(t - 0.313) + 0.8 * (ramp(t - 0.5) - ramp(t - 1.517))
            - 2.0 * (step(t - 0.777) - step(t - 0.8081))
            - 1.25 * step(t - 1.9)
    };
    let (mut plant, _) =
        ClosedLoop::new(&transfer_function(&plant), ts, 0.0, 4, (0.0, 0.0), &list).expect("rests");
    let mut worst = 0.0_f64;
    for _ in 0..100 {
        plant.hold(0.0, |s| {
            worst = worst.max((s.y0 - exact(s.t0)).abs()).max((s.y1 - exact(s.t1)).abs());
        });
    }
    assert!(worst <= 1e-12, "{worst:e}");
}

fn pi(name: &str) -> ControllerSpec {
    ControllerSpec::pid(name, PidConfig { kp: 0.8, ki: 0.6, ..PidConfig::default() })
}

/// A first-order loop has closed-form indices: plant `1/(1+s)`, PI that cancels the pole, `e = exp(-k t)` in the limit of
/// fast sampling.
#[test]
fn indices_of_a_first_order_loop() {
    let plant = PlantFactors { lags: &[1.0], ..PlantFactors::UNITY };
    let spec = ControllerSpec::pid("cancelling", PidConfig { kp: 2.0, ki: 2.0, ..PidConfig::default() });
    let scenario = from_rest(&plant, 1e-4, 12.0, SETPOINT_STEP, vec![spec]);
    let Metrics { ie, iae, ise, itae, e_max, tv } =
        run(&scenario, RunOptions::default()).expect("valid").controllers[0].total;
    // e = exp(-2t): IAE = IE = 1/2, ISE = 1/4, ITAE = 1/4; u = 1 + exp(-2t): up by 2, down by 1. Sampling costs O(ts).
    for (name, value, exact) in [
        ("IE", ie, 0.5),
        ("IAE", iae, 0.5),
        ("ISE", ise, 0.25),
        ("ITAE", itae, 0.25),
        ("e_max", e_max, 1.0),
        ("TV", tv, 3.0),
    ] {
        assert!((value / exact - 1.0).abs() < 4e-4, "{name}: {value} instead of {exact}");
    }
}

/// Initial set-point and disturbance: nothing moves until something happens; events divide the run into stretches.
#[test]
fn a_run_starts_at_rest_and_is_divided_by_its_events() {
    for (plant, precision) in
        [(&PLANTS[0], Precision::F64), (&PLANTS[4], Precision::F64), (&PLANTS[0], Precision::F32)]
    {
        let mut scenario = from_rest(plant, 0.05, 30.0, Change::Setpoint(Signal::Step(4.0)), vec![pi("a")]);
        scenario.initial = Initial { setpoint: 3.0, disturbance: 0.7 };
        scenario.events[0].at = 10.0;
        scenario.events.push(Event {
            label: String::new(),
            at: 20.0,
            changes: vec![Change::Disturbance(Signal::Step(0.2))],
            controller: None,
        });
        let result =
            run(&scenario, RunOptions { precision, trace: true, ..RunOptions::default() }).expect("valid");
        let one = &result.controllers[0];
        let kinds: Vec<_> = one.events.iter().map(|s| (s.at, s.kind)).collect();
        assert_eq!(
            kinds,
            [(0.0, EventKind::Start), (10.0, EventKind::Setpoint), (20.0, EventKind::Disturbance)]
        );
        let small = if precision == Precision::F32 { 1e-5 } else { 1e-9 };
        assert!(one.events[0].metrics.iae < small, "{:?}", one.events[0].metrics);
        assert!(one.events[1].metrics.iae > 0.1 && one.events[2].metrics.iae > 0.01);
        assert_eq!(one.trace.len(), 600);
        assert!((one.trace[199].y - 3.0).abs() < small && one.trace[200].r == 4.0);
        assert!((one.trace[0].d - 0.7).abs() < 1e-12 && (one.trace[599].d - 0.2).abs() < 1e-12);
    }
}

/// The same scenario gives the same bits, noise included; another seed does not.
#[test]
fn runs_repeat() {
    let mut scenario = from_rest(&PLANTS[0], 0.05, 5.0, SETPOINT_STEP, vec![pi("a"), pi("b")]);
    scenario.controllers[0].config.limits = LimitConfig::range(-2.0, 2.0);
    scenario.noise = Some(Noise { std: 0.01, seed: 3 });
    let options = RunOptions { trace: true, ..RunOptions::default() };
    let bits = |scenario: &_| {
        let result = run(scenario, options).expect("valid");
        result
            .controllers
            .iter()
            .flat_map(|c| c.trace.iter().map(|s| (s.u.to_bits(), s.y.to_bits())))
            .collect::<Vec<_>>()
    };
    let first = bits(&scenario);
    assert_eq!(first, bits(&scenario));
    scenario.noise = Some(Noise { std: 0.01, seed: 4 });
    assert_ne!(first, bits(&scenario));
}

/// The mode that a controller starts in holds in the first sample: in Cascade a remote set-point that steps at `t = 0` acts
/// at once, as the local one does in Auto; in Hold nothing acts.
#[test]
fn the_first_sample_runs_in_the_mode_of_the_start() {
    let first = |mode, change| {
        let spec = ControllerSpec { mode, ..pi("a") };
        let mut scenario = from_rest(&PLANTS[0], 0.05, 1.0, change, vec![spec]);
        scenario.initial = Initial { setpoint: 2.0, disturbance: 0.3 };
        let options = RunOptions { trace: true, ..RunOptions::default() };
        run(&scenario, options).expect("valid").controllers[0].trace[0]
    };
    let step = || Signal::Step(3.0);
    let auto = first(Mode::Auto, Change::Setpoint(step()));
    // From 2 - 0.3 by kp*1 + ki*ts*1.
    assert!((auto.u - (1.7 + 0.8 + 0.6 * 0.05)).abs() < 1e-12, "{}", auto.u);
    let cascade = first(Mode::Cascade, Change::RemoteSetpoint(step()));
    assert_eq!((cascade.u, cascade.mode), (auto.u, Mode::Cascade));
    let hold = first(Mode::Hold, Change::Setpoint(step()));
    assert!((hold.u - 1.7).abs() < 1e-12 && hold.mode == Mode::Hold, "{}", hold.u);
}
