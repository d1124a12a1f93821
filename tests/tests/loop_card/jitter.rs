//! The jitter margin is safe: loops whose outputs come late by any time up to it, another one each sample.

use crate::cases::{Case, loops};
use controller_core::ControllerInput;
use controller_sim_host::simulate::{Gaussian, Precision};
use controller_tests::oracle::state_space::StateSpace;

/// Steps of the plant in a sample.
const PARTS: usize = 20;

/// Largest output in the last tenth of a run after a pulse, against that in the first one. `late(k)` is the lateness of the
/// output `k`, in parts; what comes after a newer one is dropped.
fn left(case: &Case, samples: usize, mut late: impl FnMut(usize) -> usize) -> f64 {
    let step = case.ts / PARTS as f64;
    let system = StateSpace::new(&case.plant);
    let mut plant = system.sampled(step, case.plant.dead_time + case.latency);
    let mut law = case.law::<f64>();
    // The parts at which outputs come, and what acts now: its sample and its value.
    let mut under_way: Vec<(usize, usize, f64)> = Vec::new();
    let mut acting = (0, 0.0);
    let mut largest = [0.0_f64; 10];
    for k in 0..samples {
        let input = ControllerInput { y: plant.output(), ..ControllerInput::default() };
        let u = law.step(&input).u;
        let cell = &mut largest[k * 10 / samples];
        *cell = cell.max(u.abs());
        under_way.push((k * PARTS + late(k), k, u));
        for part in k * PARTS..(k + 1) * PARTS {
            for &(at, sample, value) in &under_way {
                if at <= part && sample >= acting.0 {
                    acting = (sample, value);
                }
            }
            under_way.retain(|(at, ..)| *at > part);
            let pulse = if k == 0 { 1.0 } else { 0.0 };
            plant.step(acting.1, pulse);
        }
    }
    largest[9] / largest[0]
}

#[test]
fn every_loop_bears_its_jitter_margin() {
    const SAMPLES: usize = 20_000;
    for case in loops() {
        let margin = case.card(Precision::F64).value("jitter_margin").expect("a figure");
        // Down to whole parts: no more than the margin.
        let most = (margin / case.ts * PARTS as f64).floor().min(1e4) as usize;
        let mut noise = Gaussian::new(3);
        let any = left(&case, SAMPLES, |_| (noise.sample().abs() * 0.5 * most as f64) as usize % (most + 1));
        let in_turn = left(&case, SAMPLES, |k| if k % 2 == 0 { most } else { 0 });
        let in_runs = left(&case, SAMPLES, |k| if k / 40 % 2 == 0 { most } else { 0 });
        println!("{:28} {most:6} parts: {any:.1e} {in_turn:.1e} {in_runs:.1e}", case.name);
        for rest in [any, in_turn, in_runs] {
            assert!(rest < 0.05, "{}: {rest} is left", case.name);
        }
    }
}
