//! What is computed between the samples does not change what is computed at them: random plants of order 1 to 6 with dead
//! time, latency and disturbances off the grid give the same samples for any number of substeps, and a step may be
//! divided anywhere.
//!
//! Tolerance 1e-11 of the largest output: a substep is a matrix exponential times the state, correct to some 10 units
//! of 1e-16 of the state; of the 60 samples of 10 substeps none is forgotten by an integrator, so that 600 errors of
//! 1e-15 may add up, and an order more is left for outputs that are smaller than the states. A zero far slower than
//! the fastest pole makes the output a difference of states that are larger by that ratio: 1e-9, the promise, is asked for
//! then.

use controller_sim_host::plant::{Input, LinearPlant, StateSpace};
use controller_sim_host::scenario::Signal;
use controller_sim_host::simulate::ClosedLoop;
use controller_tests::cases::transfer_function;
use controller_tests::oracle::state_space::PlantFactors;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRng, TestRunner};
use std::cell::Cell;

const TS: f64 = 0.1;
const SAMPLES: usize = 60;

/// A drawn plant with the lists that [`PlantFactors`] borrows.
#[derive(Clone, Debug)]
struct Drawn {
    gain: f64,
    integrators: usize,
    lags: Vec<f64>,
    pairs: Vec<(f64, f64)>,
    zeros: Vec<(f64, f64)>,
    dead_time: f64,
}

impl Drawn {
    /// See the head of the file.
    fn tolerance(&self) -> f64 {
        if self.zeros.is_empty() { 1e-11 } else { 1e-9 }
    }

    fn factors(&self) -> PlantFactors<'_> {
        PlantFactors {
            gain: self.gain,
            integrators: self.integrators,
            lags: &self.lags,
            pairs: &self.pairs,
            zeros: &self.zeros,
            dead_time: self.dead_time,
        }
    }
}

/// Time constants from a fifth of a sample to 50 samples, evenly over the decades.
fn time_constant() -> impl Strategy<Value = f64> {
    (-1.7..0.7_f64).prop_map(|exponent| 10.0_f64.powf(exponent))
}

fn lag() -> impl Strategy<Value = f64> {
    // One in eight is unstable, slowly enough to stay in range.
    (time_constant(), 0..8_u8).prop_map(|(tau, kind)| if kind == 0 { -tau.max(2.0) } else { tau })
}

fn pair() -> impl Strategy<Value = (f64, f64)> {
    (time_constant(), 0.05..0.95_f64).prop_map(|(tau, damping)| (2.0 * damping * tau, tau * tau))
}

/// Dead times and latencies: none, whole samples, fractions.
fn delay(longest: u8) -> impl Strategy<Value = f64> {
    (0..longest, prop_oneof![Just(0.0), Just(0.5), Just(0.37), 0.0..1.0_f64])
        .prop_map(|(whole, part)| (f64::from(whole) + part) * TS)
}

fn plant() -> impl Strategy<Value = Drawn> {
    let poles = (0..3_usize, prop::collection::vec(lag(), 0..5), prop::collection::vec(pair(), 0..3));
    let zeros = prop::collection::vec((time_constant(), any::<bool>()), 0..3);
    (poles, zeros, 0.1..10.0_f64, any::<bool>(), delay(20)).prop_filter_map(
        "order 1 to 6",
        |((integrators, lags, pairs), zeros, size, falls, dead_time)| {
            let order = integrators + lags.len() + 2 * pairs.len();
            let zeros = zeros.iter().take(order).map(|&(z, right)| (if right { -z } else { z }, 0.0));
            let gain = if falls { -size } else { size };
            let drawn = Drawn { gain, integrators, lags, pairs, zeros: zeros.collect(), dead_time };
            (1..=6).contains(&order).then_some(drawn)
        },
    )
}

/// Disturbances anywhere between the samples, pulses shorter than one included.
fn disturbances() -> impl Strategy<Value = Vec<(f64, Signal)>> {
    let signal = prop_oneof![
        (-1.0..1.0_f64).prop_map(Signal::Step),
        (-1.0..1.0_f64, 0.01..3.0_f64).prop_map(|(slope, duration)| Signal::Ramp { slope, duration }),
        (-1.0..1.0_f64, 0.01..3.0_f64).prop_map(|(height, duration)| Signal::Pulse { height, duration }),
    ];
    prop::collection::vec((0.0..5.0_f64, signal), 0..4).prop_map(|mut list| {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        list
    })
}

fn one_more(mut counts: [u32; 7], index: usize) -> [u32; 7] {
    counts[index] += 1;
    counts
}

/// The largest errors so far: without zeros, with zeros.
fn larger(mut worst: [f64; 2], drawn: &Drawn, error: f64) -> [f64; 2] {
    let group = &mut worst[usize::from(!drawn.zeros.is_empty())];
    *group = group.max(error);
    worst
}

fn runner() -> TestRunner {
    // The same cases on every run; failures are printed, not stored.
    let config = Config { cases: 400, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(Default::default()))
}

#[test]
fn samples_do_not_depend_on_the_substeps() {
    let outputs = prop::collection::vec(-1.0..1.0_f64, SAMPLES);
    let strategy = (plant(), delay(3), disturbances(), outputs);
    let worst = Cell::new([0.0_f64; 2]);
    let orders = Cell::new([0_u32; 7]);
    runner()
        .run(&strategy, |(drawn, latency, disturbances, outputs)| {
            let plant = transfer_function(&drawn.factors());
            orders.set(one_more(orders.get(), plant.order()));
            let samples = |substeps| {
                let (mut sampled, _) =
                    ClosedLoop::new(&plant, TS, latency, substeps, (0.0, 0.0), &disturbances).expect("rests");
                let mut list = Vec::new();
                for &u in &outputs {
                    sampled.hold(u, |_| {});
                    list.push(sampled.measure());
                }
                list
            };
            let one = samples(1);
            let scale = one.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
            for substeps in [3, 10] {
                for (a, b) in one.iter().zip(samples(substeps)) {
                    let error = (a - b).abs() / scale.max(1e-300);
                    worst.set(larger(worst.get(), &drawn, error));
                    prop_assert!(error <= drawn.tolerance(), "{substeps} substeps: {error:e}");
                }
            }
            Ok(())
        })
        .unwrap_or_else(|fault| panic!("{fault}"));
    let orders = orders.get();
    println!("orders 1 to 6: {:?} plants", &orders[1..]);
    println!("worst without zeros, with zeros: {:?}", worst.get());
    assert!(orders[1..].iter().all(|count| *count >= 10), "{orders:?}");
}

/// The whole state is compared: by as many later outputs as the largest order, and one.
#[test]
fn a_step_may_be_divided_anywhere() {
    let worst = Cell::new([0.0_f64; 2]);
    let cuts = prop::collection::vec(0.0..1.0_f64, 1..5);
    let inputs = prop::collection::vec((-1.0..1.0_f64, -3.0..3.0_f64, cuts), 5..20);
    runner()
        .run(&(plant(), inputs), |(drawn, inputs)| {
            let plant = transfer_function(&drawn.factors());
            let system = StateSpace::new(&plant, TS);
            let rest = vec![0.0; system.order()];
            let (mut whole, mut divided) =
                (LinearPlant::new(system.clone(), rest.clone()), LinearPlant::new(system, rest));
            for (value, slope, mut cuts) in inputs {
                whole.advance(TS, Input { value, slope }, &[]);
                cuts.sort_by(f64::total_cmp);
                cuts.push(1.0);
                let mut from = 0.0;
                for to in cuts {
                    let start = from * TS;
                    divided.advance((to - from) * TS, Input { value: value + slope * start, slope }, &[]);
                    from = to;
                }
            }
            let later = |plant: &mut LinearPlant| -> Vec<f64> {
                let mut look = || {
                    plant.advance(TS, Input::default(), &[]);
                    plant.output(0.0)
                };
                (0..7).map(|_| look()).collect()
            };
            let (a, b) = (later(&mut whole), later(&mut divided));
            let scale = a.iter().fold(1e-300_f64, |m, y| m.max(y.abs()));
            for (a, b) in a.iter().zip(&b) {
                let error = (a - b).abs() / scale;
                worst.set(larger(worst.get(), &drawn, error));
                prop_assert!(error <= drawn.tolerance(), "{error:e}");
            }
            Ok(())
        })
        .unwrap_or_else(|fault| panic!("{fault}"));
    println!("worst without zeros, with zeros: {:?}", worst.get());
}
