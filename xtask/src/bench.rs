//! The speed of the simulation, beside a plain loop in Python with numpy, that of the tuning rules
//! ([`design`]), that of many plants by them ([`batch`]), and that of many plants around one ([`robustness`]).
//!
//! Both compute the same loop (plant, controller, disturbance estimator); the integrals of the error show that they did.
//! The time is that of the processor: other work on the machine disturbs it less than the clock. Runs of both sides
//! alternate and the fastest of each are compared: what disturbs a run only ever makes it slower. That of the program is the
//! time of its whole process, with reading the scenario and writing the result; that of Python is the loop's alone.

mod batch;
mod design;
mod robustness;

use std::path::{Path, PathBuf};

use crate::long_runs::LongRun;
use crate::program;
use crate::python;
use crate::shell::{Cmd, Outcome, target_dir};
use crate::usage::measured;

/// The loop in Python and what it needs, below the workspace root.
const LOOP: &str = "tests/bench/numpy_loop.py";
const REQUIREMENTS: &str = "tests/bench/requirements.txt";

/// Samples of a run of the program, and of the loop in Python.
const SAMPLES: u64 = 5_000_000;
const NUMPY_SAMPLES: u64 = 100_000;
/// Samples between two events: 10 s, several times the settling time.
const EVERY: u64 = 1000;
/// Runs of each kind; odd, so that one of them is the median.
const REPETITIONS: usize = 7;

/// Least ratio of the program to the loop in Python.
const LEAST_RATIO: f64 = 100.0;
/// Most time of ten steps between samples, in times of one.
const MOST_SUBSTEPS: f64 = 5.0;
/// How far the integrals of the absolute error may lie apart: the program discretises the estimator as an exact pair, the
/// loop as model and filter by Tustin's rule, and these differ by up to 0.5 % (by 0.1 % at this sampling period).
const TOLERANCE: f64 = 0.005;

/// Runs the benchmark and prints it; an error when the program or a rule is too slow, or the two sides computed different
/// things.
pub(crate) fn run(root: &Path) -> Outcome {
    let program = program::shipped(root)?;
    let python = python::environment(root, "bench", REQUIREMENTS)?;
    let folder = target_dir(root).join("bench");
    let scenario = |name: &str, samples: u64| -> Outcome<PathBuf> {
        let path = folder.join(name);
        let text = LongRun { samples, every: EVERY, noise: false }.text();
        std::fs::write(&path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
        Ok(path)
    };
    let (long, short) = (scenario("long.toml", SAMPLES)?, scenario("short.toml", NUMPY_SAMPLES)?);
    let simulate = |file: &Path, substeps: &str| {
        Cmd::new(&program, &folder).arg("run").arg(file).args([
            "--json",
            "--quiet",
            "--threads",
            "1",
            "--substeps",
            substeps,
        ])
    };
    let ours = total_iae(&simulate(&short, "1").capture()?)?;

    let [mut one, mut ten, mut numpy] = [const { Vec::new() }; 3];
    for _ in 0..REPETITIONS {
        for (substeps, rates) in [("1", &mut one), ("10", &mut ten)] {
            let usage = measured(&simulate(&long, substeps))?;
            #[allow(clippy::cast_precision_loss)] // far below 2^52
            rates.push(SAMPLES as f64 / usage.cpu.as_secs_f64());
        }
        let line = Cmd::new(&python, root)
            .arg(LOOP)
            .args([NUMPY_SAMPLES.to_string(), EVERY.to_string()])
            // Matrices of two rows gain nothing from more threads.
            .env("OPENBLAS_NUM_THREADS", "1")
            .capture()?;
        let [rate, theirs] = [field(&line, "samples_per_second=")?, field(&line, "iae=")?];
        same_loop(ours, theirs)?;
        numpy.push(rate);
    }
    let [one, ten, numpy] = [one, ten, numpy].map(Spread::of);
    let (ratio, cost) = (one.highest / numpy.highest, one.highest / ten.highest);
    println!(
        "\nsimulated samples per second of processor time: fastest of {REPETITIONS} runs (slowest, median)"
    );
    println!("  controller-sim, 1 substep    {one}");
    println!("  controller-sim, 10 substeps  {ten}");
    println!("  numpy loop                   {numpy}");
    println!("  controller-sim is {ratio:.0} times as fast (at least {LEAST_RATIO})");
    println!("  10 substeps take {cost:.2} times as long as 1 (at most {MOST_SUBSTEPS})");
    let simulation = judge(ratio, cost);
    let rules = design::run(root, &python, &folder);
    let batch = batch::run(root, &python, &folder);
    let robustness = robustness::run(root, &folder);
    let faults: Vec<String> =
        [simulation, rules, batch, robustness].into_iter().filter_map(Result::err).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

/// Whether the program is fast enough.
fn judge(ratio: f64, cost: f64) -> Outcome {
    let mut faults = Vec::new();
    // Written so that a ratio that is no number is too small.
    if ratio.is_nan() || ratio < LEAST_RATIO {
        faults.push(format!("only {ratio:.0} times as fast as the numpy loop"));
    }
    if cost.is_nan() || cost > MOST_SUBSTEPS {
        faults.push(format!("10 substeps take {cost:.2} times as long as 1"));
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

/// Whether two integrals of the absolute error are those of one loop.
fn same_loop(ours: f64, theirs: f64) -> Outcome {
    let apart = (ours / theirs - 1.0).abs();
    if apart <= TOLERANCE {
        Ok(())
    } else {
        Err(format!("not the same loop: IAE {ours} of the program, {theirs} of the loop in Python"))
    }
}

/// A few measurements of one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spread {
    median: f64,
    lowest: f64,
    highest: f64,
}

impl Spread {
    /// Of at least one measurement.
    fn of(mut list: Vec<f64>) -> Self {
        list.sort_by(f64::total_cmp);
        Self { median: list[list.len() / 2], lowest: list[0], highest: list[list.len() - 1] }
    }
}

impl std::fmt::Display for Spread {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { median, lowest, highest } = self;
        write!(f, "{highest:>12.0}  ({lowest:.0}, {median:.0})")
    }
}

/// The number behind a label.
fn field(text: &str, label: &str) -> Outcome<f64> {
    let word = text.split_once(label).and_then(|(_, rest)| rest.split([' ', ',', '}', '\n']).next());
    word.and_then(|word| word.trim().parse().ok()).ok_or_else(|| format!("no {label} in: {}", text.trim()))
}

/// The integral of the absolute error over the whole run, from the program's JSON.
fn total_iae(json: &str) -> Outcome<f64> {
    let compact: String = json.chars().filter(|c| !c.is_whitespace()).collect();
    let total = compact.split_once("\"total\":{").ok_or("no total in the program's JSON")?.1;
    field(total, "\"iae\":")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read_from_both_sides() {
        let line = "samples_per_second=41637.0 iae=38.9564425\n";
        assert_eq!(field(line, "samples_per_second="), Ok(41637.0));
        assert_eq!(field(line, "iae="), Ok(38.9564425));
        assert!(field("nothing", "iae=").is_err());
        let json = "{\"controllers\": [{\"events\": [{\"metrics\": {\"iae\": 1.0}}],\n \"total\": {\"ie\": 2.0, \"iae\": 3.5, \"ise\": 4}}]}";
        assert_eq!(total_iae(json), Ok(3.5));
        assert!(total_iae("{}").is_err());
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(Spread::of(vec![3.0, 1.0, 2.0]), Spread { median: 2.0, lowest: 1.0, highest: 3.0 });
        assert_eq!(REPETITIONS % 2, 1);
    }

    #[test]
    fn slow_programs_and_other_loops_are_refused() {
        assert!(judge(100.0, 5.0).is_ok());
        assert!(judge(99.9, 5.0).is_err() && judge(100.0, 5.01).is_err() && judge(f64::NAN, 1.0).is_err());
        assert!(same_loop(1.0, 1.004).is_ok());
        assert!(same_loop(1.0, 1.006).is_err() && same_loop(f64::NAN, 1.0).is_err());
    }
}
