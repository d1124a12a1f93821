//! The compensator's promise: `C_u + G_d*C_y = 0`, so that a perfect model feeds nothing back while tracking and the
//! loop's stability is that of the loop without it.
//!
//! The plant in these tests is a state space with a matrix exponential (or its values to 60 digits from `golden/`); it
//! shares no code with the runtime.

use controller_core::{
    Compensate, CompensatorConfig, ControllerConfig, LimitConfig, ObserverConfig, PidConfig, Real,
};
use controller_tests::cases::model;
use controller_tests::oracle::complex::{abs, add, mul, unit};
use controller_tests::oracle::dob_cases;
use controller_tests::oracle::golden::{PHASES, plants};
use controller_tests::oracle::state_space::PlantFactors;
use controller_tests::response::response;
use controller_tests::rig::{Block, CAPACITY, Rig, law};

fn observer(plant: &PlantFactors<'_>, alpha: f64, latency: f64) -> CompensatorConfig {
    ObserverConfig { model: model(plant), alpha, order: None }.to_compensator(latency)
}

/// A small deterministic generator of numbers in 0..1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn log(&mut self, lo: f64, hi: f64) -> f64 {
        lo * (hi / lo).powf(self.next())
    }
    fn index(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

/// 1e-10 to order 4, 1e-7 to order 8, of the size of the terms that make up `C_u`: zeros that cannot move into the `y`
/// path (right half plane, complex) and are slow against a sample give its numerator coefficients of the size
/// `prod(1 + 2|z|/ts)`, whose rounding no arrangement removes. The size is taken from the plant alone.
fn tolerance(plant: &PlantFactors<'_>, ts: f64) -> f64 {
    let stays = |&&(z1, z2): &&(f64, f64)| z1 < 0.0 || z2 != 0.0;
    let size: f64 = plant
        .zeros
        .iter()
        .filter(stays)
        .map(|&(z1, z2)| 1.0 + 2.0 * z1.abs() / ts + 4.0 * z2.abs() / (ts * ts))
        .product();
    // Up to a size of 1e3 the figure itself is kept.
    let factor = if size > 1e3 { size * 1e-3 } else { 1.0 };
    factor * if plant.order() <= 4 { 1e-10 } else { 1e-7 }
}

/// Against the plants to 60 digits: orders 1 to 8, equal lags, complex pairs, integrators, zeros of every kind,
/// fractional dead time, 1 to 1e4 samples per time constant; filters from faster than a sample to slower than the plant.
#[test]
fn the_pair_cancels_on_the_golden_plants() {
    let mut worst = [0.0_f64; 9];
    for plant in plants() {
        let order = plant.factors().order();
        for filter in [0.3, 1.0, 10.0, 1000.0] {
            let config = observer(&plant.factors(), filter * plant.ts, 0.0);
            let capacity = Block::<f64>::needed_capacity(&config, plant.ts);
            let block = Block::<f64>::new(&config, plant.ts, capacity)
                .unwrap_or_else(|faults| panic!("{}: {faults}", plant.name));
            for (phase, exact) in PHASES.iter().zip(&plant.responses) {
                let (c_u, c_y) = response(&block.coefficients(), *phase);
                let residual = abs(add(c_u, mul(*exact, c_y)));
                worst[order] = worst[order].max(residual / tolerance(&plant.factors(), plant.ts));
                assert!(
                    residual <= tolerance(&plant.factors(), plant.ts),
                    "{} order {order}, filter {filter} samples, phase {phase}: {residual:e}",
                    plant.name
                );
            }
        }
    }
    println!(
        "largest |C_u + G_d C_y| over its tolerance, by order: {:?}",
        worst[1..].iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>()
    );
}

/// A randomised family with the state-space plant: 600 plants, orders 1 to 4 (1e-10) and 5 to 8 (1e-7), with
/// up to seven zeros from 0.1 to 1000 samples on either side.
#[test]
fn the_pair_cancels_on_a_random_family() {
    let mut numbers = Numbers(20_260_917);
    let mut worst = [0.0_f64; 9];
    for round in 0..600 {
        let ts = numbers.log(1e-3, 10.0);
        let order = 1 + round % 8;
        let integrators = if numbers.next() < 0.25 { 1 } else { 0 };
        let (mut lags, mut pairs, mut zeros) = (Vec::new(), Vec::new(), Vec::new());
        let mut left = order - integrators;
        while left > 0 {
            let tau = ts / numbers.log(1e-4, 1.0);
            if left >= 2 && numbers.next() < 0.3 {
                pairs.push((2.0 * (0.15 + 0.8 * numbers.next()) * tau, tau * tau));
                left -= 2;
            } else {
                lags.push(tau);
                left -= 1;
            }
        }
        for _ in 0..numbers.index(order) {
            let size = ts / numbers.log(1e-3, 10.0);
            zeros.push((if numbers.next() < 0.5 { size } else { -size }, 0.0));
        }
        let dead_time = numbers.log(1e-2, 50.0) * ts;
        let gain = numbers.log(1e-2, 1e2) * if numbers.next() < 0.5 { -1.0 } else { 1.0 };
        let plant = PlantFactors { gain, integrators, lags: &lags, pairs: &pairs, zeros: &zeros, dead_time };
        let alpha = numbers.log(0.05, 2e3) * ts;
        let latency = numbers.next() * 2.0 * ts;
        let config = observer(&plant, alpha, latency);
        let block = Block::<f64>::new(&config, ts, CAPACITY).unwrap_or_else(|f| panic!("{plant:?} {f}"));
        let late = PlantFactors { dead_time: dead_time + latency, ..plant };
        let sampled = late.sampled(ts);
        for phase in [1e-3, 0.03, 0.4, 1.5, 3.1] {
            let exact = sampled.frequency_response(phase);
            let (c_u, c_y) = response(&block.coefficients(), phase);
            let residual = abs(add(c_u, mul(exact, c_y)));
            worst[order] = worst[order].max(residual / tolerance(&plant, ts));
            assert!(residual <= tolerance(&plant, ts), "{plant:?} alpha {alpha} phase {phase}: {residual:e}");
        }
    }
    println!(
        "largest |C_u + G_d C_y| over its tolerance, by order: {:?}",
        worst[1..].iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>()
    );
}

/// The step computes what its published equation says: the response to a rotating phasor, fed as two real runs.
#[test]
fn the_step_has_the_published_transfer_functions() {
    for plant in plants().iter().filter(|p| p.factors().order() <= 3).take(12) {
        let alpha = 3.0 * plant.ts;
        let config = observer(&plant.factors(), alpha, 0.3 * plant.ts);
        let block = Block::<f64>::new(&config, plant.ts, CAPACITY).expect("valid");
        for phase in [0.5_f64, 2.0] {
            let (c_u, c_y) = response(&block.coefficients(), phase);
            for (which, expected) in [(0, c_u), (1, c_y)] {
                let mut state = block.state(vec![0.0; CAPACITY]).expect("fits");
                block.settle(&mut state, 0.0, 0.0);
                // Slowest lag 1e4 samples at most (a moved zero); the transient must be gone at the end.
                let n = 400_000;
                let mut out = 0.0;
                for k in 0..=n {
                    // u_applied[k] is u[k-1]: the sample at which it was given.
                    let (x, before) = (unit(phase * k as f64).0, unit(phase * (k as f64 - 1.0)).0);
                    let (y, u) = if which == 0 { (0.0, before) } else { (x, 0.0) };
                    out = block.sample(&mut state, y, u).u_f;
                }
                let steady = mul(expected, unit(phase * n as f64)).0;
                let size = 1.0 + abs(expected);
                assert!((out - steady).abs() <= 1e-8 * size, "{} {which}: {out} {steady}", plant.name);
            }
        }
    }
}

/// With a perfect model `u_f` stays below 1e-9 of `max|u|` while tracking, fractional dead time and latency included.
#[test]
fn a_perfect_model_feeds_nothing_back_while_tracking() {
    let plants = [
        PlantFactors { lags: &[1.0], dead_time: 0.234, ..PlantFactors::UNITY },
        PlantFactors { gain: 2.5, lags: &[1.0, 0.2], dead_time: 0.2, ..PlantFactors::UNITY },
        PlantFactors { lags: &[1.0, 1.0, 1.0], dead_time: 0.517, ..PlantFactors::UNITY },
        PlantFactors { lags: &[2.0, 0.5], zeros: &[(-0.3, 0.0)], dead_time: 0.1, ..PlantFactors::UNITY },
        PlantFactors { gain: 0.4, integrators: 1, lags: &[0.5], dead_time: 0.31, ..PlantFactors::UNITY },
        PlantFactors { pairs: &[(0.5, 1.0)], dead_time: 0.05, ..PlantFactors::UNITY },
        PlantFactors { lags: &[3.0, 1.0], zeros: &[(0.8, 0.0)], dead_time: 0.4, ..PlantFactors::UNITY },
    ];
    let ts = 0.02;
    for plant in &plants {
        for latency in [0.0, 0.5 * ts, ts, 0.37 * ts] {
            let pid = PidConfig { kp: 0.4, ki: 0.25, ..PidConfig::default() };
            let config = ControllerConfig {
                pid,
                limits: LimitConfig::range(-1e3, 1e3),
                ..ControllerConfig::default()
            };
            let compensator = observer(plant, 0.15, latency);
            let late = PlantFactors { dead_time: plant.dead_time + latency, ..*plant };
            let mut rig = Rig::<f64>::new(law(&config, &compensator, ts).expect("valid"), late.sampled(ts));
            rig.input.r = 1.0;
            let (mut largest_f, mut largest_u) = (0.0_f64, 0.0_f64);
            for k in 0..4000 {
                if k == 1500 {
                    rig.input.r = -0.5;
                }
                let out = rig.step();
                largest_f = largest_f.max(out.u_f.abs());
                largest_u = largest_u.max(out.u.abs());
            }
            assert!(
                largest_f <= 1e-9 * largest_u,
                "{plant:?} latency {latency}: {largest_f:e} of {largest_u}"
            );
        }
    }
}

/// Largest `|y|` over the last fifth of a run after a disturbance step, relative to the largest of all; grows when the
/// loop is unstable.
fn tail<T: Real>(case: &dob_cases::DobCase, alpha: Option<f64>, ts: f64, latency: f64) -> f64 {
    let pid = PidConfig { kp: case.kp, ki: case.ki, ..PidConfig::default() };
    let config =
        ControllerConfig { pid, limits: LimitConfig::range(-1e6, 1e6), ..ControllerConfig::default() };
    let compensator = observer(&case.plant, alpha.unwrap_or(1.0), latency);
    let late = PlantFactors { dead_time: case.plant.dead_time + latency, ..case.plant };
    let mut rig = Rig::<T>::new(law(&config, &compensator, ts).expect("valid"), late.sampled(ts));
    rig.input.compensate = alpha.is_some();
    rig.d = 1.0;
    let samples = 12_000.min((40_000.0 / ts) as usize).max(2000);
    let (mut all, mut last) = (0.0_f64, 0.0_f64);
    for k in 0..samples {
        let _ = rig.step();
        all = all.max(rig.y().abs());
        if k * 5 >= samples * 4 {
            last = last.max(rig.y().abs());
        }
    }
    last / all
}

/// Stable for `Ts/alpha` from 0.01 to 50 at latencies of 0, 0.5 and 1 sample, wherever the PI alone is.
#[test]
fn the_observer_never_destabilises_a_stable_loop() {
    let mut loops = 0;
    for case in &dob_cases::CASES {
        for samples_per_dead_time in [2.0, 5.3, 20.0] {
            let ts = case.plant.dead_time / samples_per_dead_time;
            for latency in [0.0, 0.5, 1.0] {
                let pi_alone = tail::<f64>(case, None, ts, latency * ts);
                if pi_alone > 0.01 {
                    println!(
                        "plant {} ms {} T/Ts {samples_per_dead_time}: PI alone not settled",
                        case.plant_number, case.ms0
                    );
                    continue;
                }
                loops += 1;
                for ratio in [0.01, 0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 20.0, 50.0] {
                    let alpha = ts / ratio;
                    let with = tail::<f64>(case, Some(alpha), ts, latency * ts);
                    assert!(
                        with < 0.2,
                        "plant {} Ms {} T/Ts {samples_per_dead_time} latency {latency} Ts/alpha {ratio}: {with}",
                        case.plant_number,
                        case.ms0
                    );
                }
            }
        }
    }
    assert!(loops >= 40, "only {loops} of 54 loops are stable with the PI alone");
    println!("{loops} of 54 loops are stable with the PI alone, and so with the observer");
    // The measure can fail: a late sample that the observer does not know of destabilises it.
    let case = &dob_cases::CASES[3];
    let ts = case.plant.dead_time / 2.0;
    let pid = PidConfig { kp: case.kp, ki: case.ki, ..PidConfig::default() };
    let config =
        ControllerConfig { pid, limits: LimitConfig::range(-1e6, 1e6), ..ControllerConfig::default() };
    let late = PlantFactors { dead_time: case.plant.dead_time + ts, ..case.plant };
    let compensator = observer(&case.plant, ts / 8.0, 0.0);
    let mut rig = Rig::<f64>::new(law(&config, &compensator, ts).expect("valid"), late.sampled(ts));
    rig.d = 1.0;
    for _ in 0..4000 {
        let _ = rig.step();
    }
    assert!(rig.y().abs() > 10.0, "the unmodelled late sample: {}", rig.y());
}
