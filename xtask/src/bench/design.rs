//! The time of each tuning rule, and of two of them beside the same in Python.
//!
//! Rules are measured by `controller-design/benches/rules.rs`, in the shortest of several runs of each plant; the table shows
//! the median over the plants. What Python finds must be what the rules find, or the times mean nothing.

use std::path::Path;

use super::field;
use crate::shell::{Cmd, Outcome};

/// The two rules in Python, below the workspace root.
const PYTHON: &str = "tests/bench/design_python.py";
/// The sensitivity peak that both sides design for, as the benchmark names it.
const MS: &str = "1.4";
/// The lines that are compared.
const PI_MS: &str = "PiMs, Ms 1.4";
const PI_IAE: &str = "PiIae, exp(-s)/(1+s)";

/// Least ratio of a rule to its like in Python.
const LEAST_RATIO: f64 = 20.0;
/// How far the integral gains may lie apart: Python knows the sensitivity at the points of a grid.
const KI_TOLERANCE: f64 = 2e-4;
/// The least integral of the absolute error of exp(-s)/(1+s), and how far Python's may lie from it.
const IAE: f64 = 1.51959;
const IAE_TOLERANCE: f64 = 1e-3;

/// Runs the rules and their likes in Python and prints the times; an error when a rule is too slow or the two sides found
/// different things.
pub(super) fn run(root: &Path, python: &Path, folder: &Path) -> Outcome {
    let bench = |words: &[&str]| {
        let cmd = Cmd::cargo(root).args(["bench", "-p", "controller-design", "--bench", "rules", "--"]);
        cmd.args(words.iter().copied()).capture()
    };
    let plants = folder.join("plants.tsv");
    std::fs::write(&plants, bench(&["plants"])?)
        .map_err(|e| format!("cannot write {}: {e}", plants.display()))?;
    let rows = rows(&bench(&[])?)?;
    let theirs = Cmd::new(python, root)
        .arg(PYTHON)
        .arg(&plants)
        .arg(MS)
        // Threads would count several times in the time of the processor.
        .env("OPENBLAS_NUM_THREADS", "1")
        .capture()?;

    println!("\ntime of one design: median over the plants (shortest to longest)");
    for row in &rows {
        println!("  {row}");
    }
    let found = [field(&theirs, "worst_ki=")?, field(&theirs, "iae=")?];
    let mut faults = Vec::new();
    for (name, label) in [(PI_MS, "pi_ms_seconds="), (PI_IAE, "pi_iae_seconds=")] {
        let ours = rows.iter().find(|row| row.name == name).ok_or_else(|| format!("no line for {name}"))?;
        let python = field(&theirs, label)? * 1e9;
        let ratio = python / ours.median;
        println!("  {name}: {} in Python, {ratio:.0} times as long (at least {LEAST_RATIO})", time(python));
        faults.extend(too_slow(name, ratio));
    }
    faults.extend(differ(found));
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

/// What is wrong with a ratio.
fn too_slow(name: &str, ratio: f64) -> Option<String> {
    // Written so that a ratio that is no number is too small.
    (ratio.is_nan() || ratio < LEAST_RATIO)
        .then(|| format!("{name} is only {ratio:.0} times as fast as Python"))
}

/// What is wrong with the results of Python: the worst deviation of an integral gain, and the least IAE.
fn differ([worst_ki, iae]: [f64; 2]) -> Option<String> {
    let same = worst_ki <= KI_TOLERANCE && (iae / IAE - 1.0).abs() <= IAE_TOLERANCE;
    (!same).then(|| format!("not the same designs: ki apart by up to {worst_ki}, IAE {iae} in Python"))
}

/// The times of one rule in ns.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    name: String,
    plants: usize,
    median: f64,
    shortest: f64,
    longest: f64,
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, plants, median, shortest, longest } = self;
        write!(f, "{name:<27} {:>9}", time(*median))?;
        if *plants > 1 {
            write!(f, "  ({} to {}; {plants} plants)", time(*shortest), time(*longest))?;
        }
        Ok(())
    }
}

/// The table that the benchmark prints; other lines are none of it.
fn rows(text: &str) -> Outcome<Vec<Row>> {
    let rows: Vec<Row> = text.lines().filter_map(row).collect();
    if rows.is_empty() { Err("the benchmark of the rules printed no times".into()) } else { Ok(rows) }
}

fn row(line: &str) -> Option<Row> {
    let mut fields = line.split('\t');
    let row = Row {
        name: fields.next()?.into(),
        plants: fields.next()?.parse().ok()?,
        median: fields.next()?.parse().ok()?,
        shortest: fields.next()?.parse().ok()?,
        longest: fields.next()?.parse().ok()?,
    };
    fields.next().is_none().then_some(row)
}

/// A time in ns as people read it: three digits and a unit.
fn time(ns: f64) -> String {
    let (value, unit) = match ns {
        _ if ns < 999.5 => return format!("{ns:.0} ns"),
        _ if ns < 999.5e3 => (ns / 1e3, "us"),
        _ if ns < 999.5e6 => (ns / 1e6, "ms"),
        _ => (ns / 1e9, "s"),
    };
    let digits = if value < 9.995 { 2 } else { usize::from(value < 99.95) };
    format!("{value:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_read_and_the_rest_is_not() {
        let text =
            "\nrunning 0 tests\nPiMs, Ms 1.4\t144\t398527\t205425\t933510\nMOMI\t1\t1773\t1773\t1773\n";
        let rows = rows(text).unwrap();
        assert_eq!(rows.len(), 2);
        assert_eq!(
            rows[0].to_string(),
            "PiMs, Ms 1.4                   399 us  (205 us to 934 us; 144 plants)"
        );
        assert_eq!(rows[1].to_string(), "MOMI                          1.77 us");
        assert!(super::rows("nothing\t1\n").is_err());
    }

    #[test]
    fn times_have_three_digits() {
        let list = [11.0, 999.6, 12_345.0, 999_600.0, 12_226_397.0, 1_282_083_366.0];
        assert_eq!(list.map(time), ["11 ns", "1.00 us", "12.3 us", "1.00 ms", "12.2 ms", "1.28 s"]);
    }

    #[test]
    fn slow_rules_and_other_designs_are_refused() {
        assert!(too_slow("x", 20.0).is_none());
        assert!(too_slow("x", 19.9).is_some() && too_slow("x", f64::NAN).is_some());
        assert!(differ([1e-5, 1.5196]).is_none());
        assert!(differ([3e-4, 1.5196]).is_some() && differ([f64::NAN, 1.5196]).is_some());
        assert!(differ([0.0, 1.53]).is_some());
    }
}
