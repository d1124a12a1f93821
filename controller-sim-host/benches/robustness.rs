//! Where the time of a robustness study goes: samples of a DE-MOMI loop drawn, their margins, their simulations, the rows.
//!
//! Prints one line: the number of samples, seconds of one core for each phase, the steps of the plants and the time that these
//! take alone. Every phase is the shortest of several. `cargo xtask bench` runs this; by hand:
//! `cargo bench -p controller-sim-host --bench robustness`.

use controller_design::margins::DiscreteLoop;
use controller_sim_host::analysis::law;
use controller_sim_host::batch::sample::{SampleStudy, SampleSummary, Seeded, quantities, work};
use controller_sim_host::batch::{Cells, Stopped};
use controller_sim_host::plant::{Input, LinearPlant, StateSpace};
use controller_sim_host::scenario::{Scenario, read, uncertainty};
use controller_sim_host::simulate::{Control, Precision, run_controller};
use std::hint::black_box;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

const TEXT: &str = include_str!("robustness.scenario.toml");
const SAMPLES: usize = 200;
const REPETITIONS: usize = 5;

/// The shortest of several \[s\].
fn shortest<T>(mut work: impl FnMut() -> T) -> f64 {
    let mut once = || {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    (0..REPETITIONS).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn main() {
    let scenario = read(TEXT, Precision::F64).expect("a scenario").scenario;
    let wishes: Vec<_> =
        uncertainty(TEXT, false).expect("ranges").into_iter().map(|u| (u.name, u.spread)).collect();
    let quantities = quantities(&scenario, &wishes).expect("quantities of the plant");
    let drawn = Seeded { quantities, samples: SAMPLES, seed: 1, precision: Precision::F64 };
    let law = law(&scenario, 0).expect("a law");
    let study = SampleStudy::new(scenario, drawn).expect("a loop that is analysed");
    let control = Control::new();

    let all =
        || (1..=SAMPLES).filter_map(|number| study.sample(number).scenario.ok()).collect::<Vec<Scenario>>();
    let draws = shortest(all);
    let list = all();
    let margins = shortest(|| {
        let of = |one: &Scenario| DiscreteLoop::new(&one.plant, law.clone(), one.latency)?.margins_or_poles();
        list.iter().map(of).filter(Result::is_ok).count()
    });
    let simulations = shortest(|| {
        let of = |one: &Scenario| run_controller(one, 0, Precision::F64, &control);
        list.iter().map(of).filter(Result::is_ok).count()
    });
    let whole = shortest(|| {
        let mut summary = SampleSummary::new(&study.layout());
        let take = |rows: Vec<Cells>| -> Result<(), Stopped> {
            rows.iter().for_each(|row| summary.add(row));
            Ok(())
        };
        work(&study, 0..SAMPLES, 1, &control, &AtomicU64::new(0), take)
    });
    let steps = (study.scenario.duration / study.scenario.ts).round() as usize * study.scenario.substeps;
    let floor = shortest(|| {
        let system = StateSpace::new(&study.scenario.plant, study.scenario.ts);
        let mut plant = LinearPlant::new(system.clone(), vec![0.0; system.order()]);
        let index = plant.prepare(study.scenario.ts / study.scenario.substeps as f64);
        let mut sum = 0.0;
        for _ in 0..steps {
            plant.advance_by(index, black_box(Input { value: 1.0, slope: 0.0 }), &[]);
            sum += plant.output(1.0);
        }
        sum
    });
    println!(
        "samples={SAMPLES} draws_seconds={draws} margins_seconds={margins} simulations_seconds={simulations} \
         whole_seconds={whole} steps={} floor_seconds={}",
        steps * SAMPLES,
        floor * SAMPLES as f64
    );
}
