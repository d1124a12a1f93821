//! The batch of 134 processes beside the same in Python, on one core and on two, and where its time goes.

use std::path::Path;
use std::time::Instant;

use super::field;
use crate::program;
use crate::shell::{Cmd, Outcome};

/// The batch in Python, below the workspace root.
const PYTHON: &str = "tests/bench/batch_python.py";
/// The sensitivity peak of both sides.
const MS: &str = "1.2";
/// Runs of the whole program on each number of cores.
const REPETITIONS: usize = 5;

/// Least ratio of the batch to its like in Python.
const LEAST_RATIO: f64 = 30.0;
/// Least ratio of one core's time to that of two.
const LEAST_SPEED_UP: f64 = 1.8;
/// How far the sums of `IAE*ki` may lie apart: indices are within 0.1 % on both sides.
const TOLERANCE: f64 = 1e-3;

/// Runs the batch here and in Python and prints the times; an error when it is too slow or the two sides did different things.
pub(super) fn run(root: &Path, python: &Path, folder: &Path) -> Outcome {
    let bench = ["bench", "-p", "controller-design", "--bench", "batch"];
    let ours = Cmd::cargo(root).args(bench).capture()?;
    let theirs = Cmd::new(python, root).arg(PYTHON).arg(MS).env("OPENBLAS_NUM_THREADS", "1").capture()?;
    let of = |name: &str| field(&ours, name);
    let [whole_design, margins, simulation, output, updates, floor] = [
        of("design_seconds=")?,
        of("margins_seconds=")?,
        of("simulation_seconds=")?,
        of("output_seconds=")?,
        of("updates=")?,
        of("floor_seconds=")?,
    ];
    let total = whole_design + simulation + output;
    let theirs_total = field(&theirs, "total_seconds=")?;
    let [mine, other] = [of("iae_ki=")?, field(&theirs, "iae_ki=")?];
    let ratio = theirs_total / total;
    println!("\nbatch: design and three simulations of 134 processes at Ms {MS}, one core");
    println!(
        "  Python {theirs_total:.2} s, here {:.1} ms: {ratio:.0} times as fast (at least {LEAST_RATIO})",
        1e3 * total
    );
    for (name, time) in [
        ("designs", (whole_design - margins).max(0.0)),
        ("margins", margins),
        ("simulations", simulation),
        ("output", output),
    ] {
        println!("  {name:<12}{:>8.1} ms  {:>3.0} %", 1e3 * time, 100.0 * time / total);
    }
    println!(
        "  floor of the simulations: {updates:.0} state updates, {:.1} ms; they take {:.1} times that",
        1e3 * floor,
        simulation / floor
    );
    let mut faults = Vec::new();
    faults.extend(judge(ratio, [mine, other]));
    let program = program::shipped(root)?;
    let mut best = [f64::INFINITY; 2];
    for _ in 0..REPETITIONS {
        for (jobs, best) in ["1", "2"].into_iter().zip(&mut best) {
            let list = [
                "batch",
                "--set",
                "ah134",
                "--methods",
                "pi-ms,dob",
                "--ms",
                "1.2,1.4,2",
                "--noise-ratio",
                "2,10",
            ];
            let rest = ["--out", "batch.csv", "--force", "--quiet", "--jobs", jobs];
            let start = Instant::now();
            Cmd::new(&program, folder).args(list).args(rest).capture()?;
            *best = best.min(start.elapsed().as_secs_f64());
        }
    }
    let speed_up = best[0] / best[1];
    println!(
        "  the program, 1206 rows with margins and set-point: {:.2} s on one core, {:.2} s on two: {speed_up:.2} times (at least {LEAST_SPEED_UP})",
        best[0], best[1]
    );
    if std::thread::available_parallelism().is_ok_and(|cores| cores.get() > 1) {
        faults.extend(slow_on_two(speed_up));
    } else {
        println!("  this machine has one core: the second figure means nothing");
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

/// What is wrong with the ratio to Python and with the sums of both sides.
fn judge(ratio: f64, [ours, theirs]: [f64; 2]) -> Vec<String> {
    let mut faults = Vec::new();
    // Written so that a ratio that is no number is too small.
    if ratio.is_nan() || ratio < LEAST_RATIO {
        faults.push(format!("the batch is only {ratio:.0} times as fast as Python"));
    }
    let apart = (ours / theirs - 1.0).abs();
    if apart.is_nan() || apart > TOLERANCE {
        faults.push(format!("not the same batch: the sum of IAE*ki is {ours} here, {theirs} in Python"));
    }
    faults
}

fn slow_on_two(speed_up: f64) -> Option<String> {
    (speed_up.is_nan() || speed_up < LEAST_SPEED_UP)
        .then(|| format!("two cores are only {speed_up:.2} times as fast as one"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_batches_and_other_ones_are_refused() {
        assert!(judge(30.0, [280.9, 280.91]).is_empty());
        assert_eq!(judge(29.0, [280.9, 281.9]).len(), 2);
        assert_eq!(judge(f64::NAN, [f64::NAN, 1.0]).len(), 2);
        assert!(slow_on_two(1.8).is_none() && slow_on_two(1.79).is_some() && slow_on_two(f64::NAN).is_some());
    }
}
