//! Margins of the optimum.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{Optimum, RANGE, SHOWN};
use controller_design::margins::{ContinuousLoop, Margins};
use controller_design::rules::fits::AirikkaPi;

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    let margins = |one: &Optimum| ContinuousLoop::new(&one.plant, &one.pid).margins();
    for one in Optimum::of(bench, &SHOWN)? {
        let m = margins(&one)?;
        values.row(&one.row(), [("Ms", m.ms), ("Gm", m.gm), ("Pm", m.pm_deg)]);
    }
    let optima = Optimum::of(bench, &RANGE.map(Some))?;
    let all: Vec<Margins> = optima.iter().map(margins).collect::<Result<_, _>>()?;
    let row = "optimum, 0.1 <= r <= 3";
    for (name, of) in [("Ms", (|m| m.ms) as fn(&Margins) -> f64), ("Gm", |m| m.gm), ("Pm", |m| m.pm_deg)] {
        range(row, name, all.iter().map(of), values);
    }
    // The paper's own rule, where it is any good.
    let mut peaks = Vec::new();
    for (one, r) in optima.iter().filter_map(|one| Some((one, one.r.filter(|r| *r >= 0.2)?))) {
        let pid = AirikkaPi::linear(1.0, 1.0 / r, 1.0)?.pid;
        peaks.push(ContinuousLoop::new(&one.plant, &pid).margins()?.ms);
    }
    range("(8), 0.2 <= r <= 3", "Ms", peaks.into_iter(), values);
    for ms in [3.0, 1.9] {
        let least_pm = 2.0 * libm::asin(0.5 / ms).to_degrees();
        values.row(
            &format!("bounds for Ms = {ms}"),
            [("Gm, Ms/(Ms-1)", ms / (ms - 1.0)), ("Pm, 2 asin(1/(2 Ms))", least_pm)],
        );
    }
    Ok(())
}

fn range(row: &str, name: &str, all: impl Iterator<Item = f64> + Clone, values: &mut Values) {
    values.put(row, &format!("{name} least"), all.clone().fold(f64::INFINITY, f64::min));
    values.put(row, &format!("{name} largest"), all.fold(f64::NEG_INFINITY, f64::max));
}
