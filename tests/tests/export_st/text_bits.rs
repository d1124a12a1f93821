//! Bit for bit: the exported text, read by a foreign parser and compiled as C, against the core's step.
//!
//! The block from which the text was printed has no part in the program: a wrong sign, parenthesis or number in the text
//! gives other bits.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, random, scenario};
use crate::recorded::Recorded;
use crate::translate::{Translated, translate};
use controller_core::{Real, Status};
use controller_sim_host::export::block::{Block, Role};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::sync::atomic::{AtomicUsize, Ordering};

const SAMPLES: u32 = 10_000;

/// Power-ups of a loop, beside its long run.
const STARTS: u64 = 12;

/// How programs are compiled: each reads a REAL's decimals in its own way.
const BUILDS: [&[&str]; 2] = [&["-O0"], &["-O2", "-DBY_DOUBLE"]];

/// What the loops have met, together.
#[derive(Debug, Default)]
struct Met {
    modes: [u32; 7],
    status: u32,
    tuned: [u32; 2],
}

/// The exported text of a loop.
pub(crate) fn text(scenario: &Scenario, spec: &ControllerSpec, precision: Precision) -> String {
    let export = Export::new(scenario, spec, precision, None).expect("a loop");
    export.text(Format::StructuredText, "test").expect("a text")
}

/// The program of a text whose inputs and outputs are those of `block`, in its order.
pub(crate) fn translated(name: &str, text: &str, block: &Block) -> Translated {
    let translated = translate(text).unwrap_or_else(|fault| panic!("{name}: {fault}\n{text}"));
    let names = |role: Role| block.variables.iter().filter(move |v| v.role == role).map(|v| &v.name);
    assert!(translated.inputs.iter().eq(names(Role::Input)), "{name}: {:?}", translated.inputs);
    assert!(translated.outputs.iter().eq(names(Role::Output)), "{name}: {:?}", translated.outputs);
    translated
}

/// One loop, as exported and while it is tuned.
fn one<T: Real>(cc: &str, scenario: &Scenario, spec: &ControllerSpec, precision: Precision, met: &mut Met) {
    let recorded = [false, true].map(|tuning| Recorded::<T>::new(scenario, spec, precision, tuning, SAMPLES));
    let name = format!("{} {precision:?} text", spec.name);
    let source = translated(&name, &text(scenario, spec, precision), &recorded[0].block).source;
    let programs = BUILDS.map(|options| compile(cc, &name.replace([' ', ','], "_"), &source, options));
    for (program, options) in programs.iter().zip(BUILDS) {
        for recorded in &recorded {
            recorded.check(&format!("text {options:?}"), &run(program, &recorded.records));
        }
    }
    // Settling happens once in a life: many lives, each from another beginning.
    for seed in 0..STARTS {
        let recorded = Recorded::<T>::scattered(scenario, spec, precision, 100 + seed, 60);
        recorded.check(&format!("text, start {seed}"), &run(&programs[1], &recorded.records));
    }
    for Recorded { driven, .. } in &recorded {
        met.modes.iter_mut().zip(driven.modes).for_each(|(all, more)| *all += more);
        met.status |= driven.status;
        met.tuned = [met.tuned[0] + driven.tuned[0], met.tuned[1] + driven.tuned[1]];
    }
}

/// All loops of a scenario in the precisions that `of` names, on as many threads as there are processors.
fn each(cc: &str, scenario: &Scenario, of: impl Fn(usize) -> Vec<Precision> + Sync) -> Met {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut met = Met::default();
        while let Some((n, spec)) = {
            let n = next.fetch_add(1, Ordering::Relaxed);
            scenario.controllers.get(n).map(|spec| (n, spec))
        } {
            for precision in of(n) {
                match precision {
                    Precision::F32 => one::<f32>(cc, scenario, spec, precision, &mut met),
                    Precision::F64 => one::<f64>(cc, scenario, spec, precision, &mut met),
                }
            }
        }
        met
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().fold(Met::default(), |mut all, worker| {
            let more = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            all.modes.iter_mut().zip(more.modes).for_each(|(all, more)| *all += more);
            all.status |= more.status;
            all.tuned = [all.tuned[0] + more.tuned[0], all.tuned[1] + more.tuned[1]];
            all
        })
    })
}

#[test]
fn every_text_steps_with_the_bits_of_the_core() {
    let Some(cc) = compiler() else { return not_run("exported texts against the core", "no C compiler") };
    let met = each(cc, &scenario(all()), |_| vec![Precision::F32, Precision::F64]);
    assert!(met.modes.iter().all(|&n| n > 2000), "{met:?}");
    assert!(met.tuned[0] > 1500 && met.tuned[1] > 1500, "{met:?}");
    for (bit, what) in Status::NAMES {
        assert!(met.status & bit.bits() != 0 || *bit == Status::OVERRUN, "never {what}");
    }
}

/// With `SOAK=1` in the environment many more.
#[test]
fn texts_of_random_parts_step_with_the_bits_of_the_core() {
    let Some(cc) = compiler() else {
        return not_run("random exported texts against the core", "no C compiler");
    };
    let count = if std::env::var_os("SOAK").is_some() { 600 } else { 8 };
    // Others than those whose blocks are compared.
    let scenario = scenario((0..count).map(|n| random(1000 + n)).collect());
    each(cc, &scenario, |n| vec![[Precision::F32, Precision::F64][n % 2]]);
}
