//! A robustness study of ten thousand plants: its time, its memory, and where the time goes.

use std::path::Path;
use std::time::Instant;

use super::field;
use crate::program;
use crate::shell::{Cmd, Outcome};
use crate::usage::measured;

/// The loop, below the workspace root.
const SCENARIO: &str = "controller-sim-host/benches/robustness.scenario.toml";
const SAMPLES: u64 = 10_000;
/// A study whose memory is that of the large one.
const FEW: u64 = 1000;

/// Most time of the processor, over both cores \[s\]: a minute on two.
const MOST_SECONDS: f64 = 120.0;
/// Most memory that ten times the samples may take more \[kB\]: what an allocator keeps, less than a tenth of the rows.
const MOST_GROWTH: u64 = 4096;

/// Runs the study and prints its figures; an error when it takes too long or its memory grows.
pub(super) fn run(root: &Path, folder: &Path) -> Outcome {
    let bench = ["bench", "-p", "controller-sim-host", "--bench", "robustness"];
    let line = Cmd::cargo(root).args(bench).capture()?;
    let of = |name: &str| field(&line, name);
    let [samples, draws, margins, simulations, whole, steps, floor] = [
        of("samples=")?,
        of("draws_seconds=")?,
        of("margins_seconds=")?,
        of("simulations_seconds=")?,
        of("whole_seconds=")?,
        of("steps=")?,
        of("floor_seconds=")?,
    ];
    println!("\nrobustness: a DE-MOMI loop on drawn plants, one core, milliseconds a plant");
    let rest = (whole - draws - margins - simulations).max(0.0);
    for (name, time) in
        [("draws", draws), ("margins", margins), ("simulation", simulations), ("rows", rest), ("all", whole)]
    {
        println!("  {name:<12}{:>8.3} ms  {:>3.0} %", 1e3 * time / samples, 100.0 * time / whole);
    }
    println!(
        "  floor of the simulation: {:.0} steps of the plant, {:.3} ms; it takes {:.1} times that",
        steps / samples,
        1e3 * floor / samples,
        simulations / floor
    );
    let program = program::shipped(root)?;
    let study = |samples: u64, out: &str| {
        Cmd::new(&program, root)
            .args([
                "batch",
                "sample",
                SCENARIO,
                "-n",
                &samples.to_string(),
                "--jobs",
                "2",
                "--quiet",
                "--force",
            ])
            .arg("--out")
            .arg(folder.join(out))
    };
    let few = measured(&study(FEW, "few.csv"))?;
    let start = Instant::now();
    let many = measured(&study(SAMPLES, "many.csv"))?;
    let (clock, cpu) = (start.elapsed().as_secs_f64(), many.cpu.as_secs_f64());
    println!(
        "  the program, {SAMPLES} plants, two threads: {clock:.1} s, {cpu:.1} s of the processor (at most {MOST_SECONDS})"
    );
    println!("  memory: {} kB of {FEW} plants, {} kB of {SAMPLES}", few.peak, many.peak);
    judge(cpu, few.peak, many.peak)
}

fn judge(cpu: f64, few: u64, many: u64) -> Outcome {
    let mut faults = Vec::new();
    // Written so that a time that is no number is too long.
    if cpu.is_nan() || cpu > MOST_SECONDS {
        faults.push(format!("{SAMPLES} plants take {cpu:.0} s of the processor"));
    }
    if many > few + MOST_GROWTH {
        faults.push(format!("memory grows with the number of plants, from {few} kB to {many} kB"));
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_studies_and_growing_ones_are_refused() {
        assert!(judge(120.0, 10_000, 14_096).is_ok());
        assert!(judge(120.1, 10_000, 10_000).is_err() && judge(f64::NAN, 1, 1).is_err());
        assert!(judge(1.0, 10_000, 14_097).is_err());
    }
}
