//! Laws for several operating points.

use controller_core::{
    Controller, ControllerConfig, ControllerInput, LimitConfig, Mode, Param, Pid, PidConfig, PidInput,
    PidState, Quality,
};
use controller_hal::{
    CountSpan, FlowConfig, GainSchedule, Monitored, OperatingPoint, Reading, Sense, SpanConfig,
    SquareRootFlow,
};
use proptest::prelude::*;

fn pid(kp: f64) -> Pid<f64> {
    Pid::new(&PidConfig { kp, ki: 0.5 * kp, kd: 0.1 * kp, tf: 0.2, ..PidConfig::default() }, 0.1).unwrap()
}

fn points<const N: usize>(at: [f64; N]) -> [OperatingPoint<Pid<f64>>; N] {
    let law = |at: f64| pid(1.0 + if at.is_nan() { 0.0 } else { at.abs() * 0.01 });
    at.map(|at| OperatingPoint { at, law: law(at) })
}

type Loops<const N: usize> = GainSchedule<Pid<f64>, PidState<f64>, f64, N>;

fn schedule<const N: usize>(at: [f64; N], hysteresis: f64, signal: f64) -> Loops<N> {
    GainSchedule::new(points(at), hysteresis, signal, |_| PidState::default()).unwrap()
}

#[test]
fn the_law_changes_at_the_borders_with_hysteresis() {
    let mut loops = schedule([0.0, 10.0, 40.0], 4.0, 0.0);
    // borders at 5 and 25; 2 each way
    let walk = [
        (6.9, 0),
        (7.0, 0),
        (7.1, 1),
        (3.1, 1),
        (2.9, 0),
        (100.0, 2),
        (23.1, 2),
        (22.9, 1),
        (26.9, 1),
        (27.1, 2),
        (-50.0, 0),
    ];
    for (signal, active) in walk {
        let before = loops.active();
        assert_eq!(loops.choose(Reading::good(signal)), before != active, "{signal}");
        assert_eq!(loops.active(), active, "{signal}");
        assert_eq!(*loops.instance().law(), points([0.0, 10.0, 40.0])[active].law);
    }
}

#[test]
fn it_begins_at_the_nearest_point() {
    for (signal, active) in
        [(-1e9, 0), (5.0, 0), (5.1, 1), (24.0, 1), (26.0, 2), (f64::INFINITY, 2), (f64::NAN, 0)]
    {
        assert_eq!(schedule([0.0, 10.0, 40.0], 4.0, signal).active(), active, "{signal}");
    }
}

#[test]
fn a_signal_that_is_no_number_changes_nothing() {
    let mut loops = schedule([0.0, 10.0], 1.0, 10.0);
    for signal in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!loops.choose(Reading::good(signal)) && loops.active() == 1);
    }
}

#[test]
fn a_bad_reading_changes_nothing_whatever_its_value() {
    let mut loops = schedule([0.0, 10.0, 20.0], 1.0, 10.0);
    for value in [0.0, -1e9, 20.0, 1e9, f64::NAN] {
        assert!(!loops.choose(Reading { value, quality: Quality::Bad }) && loops.active() == 1, "{value}");
    }
    // One that is in doubt is used, as by a loop.
    assert!(loops.choose(Reading { value: 20.0, quality: Quality::Uncertain }) && loops.active() == 2);
}

/// A flow transmitter of 4 to 20 mA through every block on the way, each of which has its own idea of the value of a sample
/// that failed: 0 of the root, the last one of the monitor, the line prolonged of the span.
#[test]
fn a_flow_transmitter_that_fails_leaves_the_law() {
    struct Transmitter(Result<Reading<f32>, ()>);
    impl Sense<f32> for Transmitter {
        type Error = ();
        fn sample(&mut self) -> Result<Reading<f32>, ()> {
            self.0
        }
    }
    // 200 counts per mA, 0 to 25 kPa, a flow of 0 to 100.
    let span = CountSpan::<f32>::new(&SpanConfig::current_loop((0, 4000), (0.0, 25.0))).unwrap();
    let flow =
        SquareRootFlow::new(&FlowConfig { pressure: 25.0, flow: 100.0, ..FlowConfig::default() }).unwrap();
    let mut transmitter = Monitored::new(Transmitter(Err(())));
    let points = [10.0, 50.0, 100.0].map(|at| OperatingPoint { at, law: pid(at) });
    let mut loops = GainSchedule::new(points, 8.0, 50.0_f32, |_| PidState::default()).unwrap();
    let broken = [Err(()), Ok(span.reading(0)), Ok(span.reading(4300)), Ok(Reading::good(f32::NAN))];
    // Before the first sample that answers, the law is the one it began with; then 50 and 90 % of the flow.
    for (milliamperes, active) in [(None, 1), (Some(8.0), 1), (Some(16.96), 2)] {
        if let Some(milliamperes) = milliamperes {
            transmitter.sensor_mut().0 = Ok(span.reading((200.0_f32 * milliamperes) as i32));
            let _ = loops.choose(flow.convert(transmitter.read()));
        }
        assert_eq!(loops.active(), active);
        for sample in broken {
            transmitter.sensor_mut().0 = sample;
            let signal = flow.convert(transmitter.read());
            assert!(!loops.choose(signal) && loops.active() == active, "{sample:?}");
            // Straight from the span, without a monitor.
            if let Ok(reading) = sample {
                assert!(!loops.choose(flow.convert(reading)) && loops.active() == active, "{sample:?}");
            }
        }
    }
}

#[test]
fn one_point_is_a_plain_loop() {
    let mut loops = schedule([3.0], 1.0, 0.0);
    let mut state = PidState::default();
    let law = points([3.0])[0].law;
    for (k, signal) in [0.0, 1e300, -1e300, 3.0].into_iter().enumerate() {
        let input = PidInput { r: 1.0, y: 0.1 * k as f64 };
        assert_eq!(loops.step(Reading::good(signal), &input), law.step(&mut state, input));
    }
}

#[test]
fn tables_that_are_none_are_refused() {
    let refused = |points: Result<Loops<3>, _>| {
        let faults: controller_core::ConfigErrors = points.err().unwrap();
        faults.iter().map(|fault| fault.param).collect::<Vec<_>>()
    };
    let make = |at, hysteresis| GainSchedule::new(points(at), hysteresis, 0.0, |_| PidState::default());
    assert_eq!(refused(make([0.0, 10.0, 10.0], 1.0)), [Param::OperatingPoint]);
    assert_eq!(refused(make([0.0, f64::NAN, 10.0], 1.0)), [Param::OperatingPoint]);
    assert_eq!(
        refused(make([10.0, 5.0, 0.0], -1.0)),
        [Param::OperatingPoint, Param::OperatingPoint, Param::Hysteresis]
    );
    assert_eq!(refused(make([0.0, 10.0, 15.0], 5.0)), [Param::Hysteresis]);
    let none = GainSchedule::<Pid<f64>, _, f64, 0>::new([], 0.0, 0.0, |_| PidState::default());
    assert_eq!(none.err().unwrap().len(), 1);
}

/// A whole loop over a plant whose gain depends on the flow, scheduled by the flow that micromath's root gives: each change
/// of the law moves the output by no more than `adopt` promises, here nothing but the integral's new increment.
#[test]
fn a_scheduled_loop_changes_its_law_bumplessly() {
    let (ts, span) = (0.1, FlowConfig { pressure: 25.0, flow: 100.0, ..FlowConfig::default() });
    let flow = SquareRootFlow::new(&span).unwrap();
    let ki = |at: f64| 0.02 * at;
    let law = |at: f64| {
        let config = ControllerConfig {
            pid: PidConfig { kp: 0.05 * at, ki: ki(at), ..PidConfig::default() },
            limits: LimitConfig::range(0.0, 300.0),
            ..ControllerConfig::default()
        };
        Controller::<f32>::new(&config, ts).unwrap()
    };
    let points = [20.0, 50.0, 80.0].map(|at| OperatingPoint { at, law: law(at) });
    let begin = |law: &Controller<f32>| {
        let mut state = law.zeroed();
        law.settle(&mut state, 60.0, 60.0, 30.0);
        state
    };
    let mut loops = GainSchedule::new(points, 6.0, 20.0_f32, begin).unwrap();
    let (mut y, mut u, mut changes) = (60.0_f32, 30.0_f32, Vec::new());
    for k in 0..2000 {
        let dp = 25.0 * (0.2 + 0.6 * (k as f32 / 2000.0)).powi(2);
        let signal = flow.convert(Reading { value: dp, quality: Quality::Good });
        let input = ControllerInput { r: 60.0, y, mode: Mode::Auto, ..ControllerInput::default() };
        let before = loops.active();
        let output = loops.step(signal, &input);
        if loops.active() != before {
            changes.push((k, signal.value));
            // ki*ts*|e| of the new law, and rounding.
            let bound = ki(points[loops.active()].at) as f32 * 0.1 * (60.0 - y).abs() + 2e-5;
            assert!((output.u - u).abs() <= bound, "{k}: {} {u}", output.u);
        }
        u = output.u;
        y += 0.1 * (u * 2.0 * (20.0 / signal.value) - y);
    }
    let [first, second] = changes[..] else { panic!("{changes:?}") };
    assert!((first.1 - 38.0).abs() < 0.1 && (second.1 - 68.0).abs() < 0.1, "{changes:?}");
    assert!((y - 60.0).abs() < 1.0, "{y}");
}

proptest! {
    /// Whatever the signal does, the law is that of a region that holds the signal, its borders widened by the hysteresis; and
    /// at constant inputs no change moves the output of a PID at rest.
    #[test]
    fn the_active_point_holds_the_signal(
        gaps in proptest::array::uniform5(0.5_f64..10.0),
        hysteresis in 0.0_f64..0.4,
        signals in proptest::collection::vec(-20.0_f64..70.0, 1..60),
    ) {
        let mut sum = -5.0;
        let at = gaps.map(|gap| { sum += gap; sum });
        let input = PidInput { r: 2.0, y: 2.0 };
        let begin = |law: &Pid<f64>| {
            let mut state = PidState::default();
            law.settle(&mut state, input, 7.0);
            state
        };
        let mut loops = GainSchedule::new(points(at), hysteresis, 0.0, begin).unwrap();
        for signal in signals {
            let out = loops.step(Reading::good(signal), &input);
            prop_assert!((out.u() - 7.0).abs() < 1e-12);
            let i = loops.active();
            let border = |a: usize| 0.5 * (at[a] + at[a + 1]);
            if i > 0 {
                prop_assert!(signal >= border(i - 1) - 0.5 * hysteresis - 1e-9);
            }
            if i < 4 {
                prop_assert!(signal <= border(i) + 0.5 * hysteresis + 1e-9);
            }
        }
    }
}
