//! What a design does when its file is run.

use crate::design_file;
use crate::scenario::{DesignFile, read, show_short};
use crate::simulate::{COLUMNS, ControllerResult, Metrics, Precision, RunOptions, View, run};
use controller_design::design::Design;

/// Steps between the samples are left out of windows longer than this, in samples.
const FINE: f64 = 2e4;

/// The run of a design file of unit steps.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignRun {
    /// Integral of the absolute error after a unit step of the set-point, of the sampled loop \[y s\].
    pub iae_setpoint: f64,
    /// The same after a unit step of the load at the plant's input \[y s\].
    pub iae_load: f64,
    /// All indices of that step of the set-point.
    pub setpoint: Metrics,
    /// And of that step of the load.
    pub load: Metrics,
    /// Why the figures are not those of a loop that works: fallbacks, limits, an error that does not die out.
    pub troubles: Vec<String>,
    /// That the window was too short for the response.
    pub cut: Option<String>,
}

impl DesignRun {
    /// Everything that a person should know of it.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.cut.iter().chain(&self.troubles).cloned().collect()
    }
}

/// Runs the loop of a design by its own design file, with windows of at most `longest` samples; `None` when it cannot be run.
#[must_use]
pub fn run_design(made: &Design, longest: f64) -> Option<DesignRun> {
    run_file(made, design_file::of(made, None, ""), longest)
}

/// The same of its `file`.
#[must_use]
pub fn run_file(made: &Design, mut file: DesignFile, longest: f64) -> Option<DesignRun> {
    let mut cut = design_file::cut(made);
    if file.window > longest * made.ts {
        cut = Some(design_file::shortage(file.window / made.ts, longest));
        file.window = longest * made.ts;
    }
    let mut scenario = read(&file.text(), Precision::F64).ok()?.scenario;
    if file.window > FINE * made.ts {
        // So many samples show the response between them, too.
        scenario.substeps = 1;
    }
    let record = Some(View { columns: COLUMNS, ..View::whole(scenario.duration) });
    let result = run(&scenario, RunOptions { record, ..RunOptions::default() }).ok()?;
    let result = result.controllers.first()?;
    let [setpoint, load] = [result.events.first()?, result.events.get(1)?].map(|part| part.metrics);
    let [setpoint, load] = [per_unit(&setpoint, file.setpoint_step), per_unit(&load, file.load_step)];
    let [iae_setpoint, iae_load] = [setpoint.iae, load.iae];
    (iae_setpoint.is_finite() && iae_load.is_finite()).then(|| DesignRun {
        iae_setpoint,
        iae_load,
        setpoint,
        load,
        troubles: troubles(result, &file),
        cut,
    })
}

/// The indices for a step of 1 from those for this one.
fn per_unit(of: &Metrics, step: f64) -> Metrics {
    let size = step.abs();
    Metrics {
        ie: of.ie / step,
        iae: of.iae / size,
        ise: of.ise / (step * step),
        itae: of.itae / size,
        e_max: of.e_max / size,
        tv: of.tv / size,
    }
}

/// What the simulated loop of a design ran into: the remarks on its run, and the limits of its output other than one at
/// which it begins.
#[must_use]
pub fn troubles(result: &ControllerResult, file: &DesignFile) -> Vec<String> {
    let mut list: Vec<String> =
        result.remarks.iter().map(|remark| format!("simulated: {}", remark.text)).collect();
    let (lo, hi) = (file.controller.config.limits.lo, file.controller.config.limits.hi);
    let rest = if file.plant.integrators() > 0 { 0.0 } else { file.initial_setpoint / file.plant.gain() };
    let rest = rest - file.initial_load;
    let near = |limit: f64| (rest - limit).abs() < 1e-9 * (hi - lo);
    let asked = result.record.as_ref().and_then(|record| record.u.range());
    let is_said = result.remarks.iter().any(|remark| remark.text.contains("at an output limit"));
    if let Some((least, most)) = asked.filter(|_| !is_said) {
        for (hit, limit) in [(least <= lo, lo), (most >= hi, hi)] {
            if hit && !near(limit) {
                let limit = show_short(limit);
                list.push(format!("simulated: the output is at its limit {limit} for a time"));
            }
        }
    }
    list
}
