//! A tuned loop: text for people, JSON for programs.

use super::design::designed_table;
use super::design_json::Designed;
use super::identification::{Identification, Object as Identified, identify_table};
use super::json::text;
use super::table::format_number;
use crate::simulate::Metrics;
use controller_design::design::Design;
use serde::Serialize;

/// What came of a record.
#[derive(Debug, Clone, Copy)]
pub struct Tuning<'a> {
    /// The process.
    pub finding: Identification<'a>,
    /// The controller.
    pub made: &'a Design,
    /// Of the two together.
    pub warnings: &'a [String],
    /// The simulated set-point step and load step.
    pub events: [Metrics; 2],
    /// Predicted integral of the absolute error after a unit step of the load, of the sampled loop \[y s\], where the rule
    /// looks at it.
    pub iae_load: Option<f64>,
    /// Largest distance of the response of the loop's model from the record \[y\].
    pub worst_residual: f64,
    /// Number of lags of that model.
    pub order: usize,
    /// Lowest and highest output that the simulated controller asks for \[u\].
    pub range: (f64, f64),
}

impl Tuning<'_> {
    /// Everything that a person should know.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.made.warnings.iter().map(ToString::to_string).chain(self.warnings.iter().cloned()).collect()
    }

    /// What the simulation gave: names, values and their units.
    pub(crate) fn simulated(&self, unit: &str) -> [(&'static str, String, String); 5] {
        let y = if unit.trim().is_empty() { "y" } else { unit.trim() };
        let [setpoint, load] = &self.events;
        let area = format!("{y} s");
        let number = format_number;
        [
            ("IAE of the set-point step", number(setpoint.iae), area.clone()),
            ("IAE of the load step", number(load.iae), area),
            ("largest error of the load step", number(load.e_max), y.to_owned()),
            (
                "output asked for",
                format!("{} to {}", number(self.range.0), number(self.range.1)),
                "u".to_owned(),
            ),
            ("largest residual of the model", number(self.worst_residual), y.to_owned()),
        ]
    }
}

/// The process and its controller as text.
#[must_use]
pub fn tune_table(tuning: &Tuning<'_>) -> String {
    let mut out = identify_table(&tuning.finding);
    out.push_str(&format!(
        "largest distance of the loop's model, of order {}, from the record: {}\n\n",
        tuning.order,
        format_number(tuning.worst_residual)
    ));
    out.push_str(&designed_table(tuning.made, tuning.iae_load));
    let [setpoint, load] = &tuning.events;
    out.push_str(&format!(
        "\nsimulated with noise and resolution of the record\n  {:<30}IAE {:>10}  e_max {:>10}\n  {:<30}IAE {:>10}  e_max {:>10}\n",
        "set-point step as recorded",
        format_number(setpoint.iae),
        format_number(setpoint.e_max),
        "load, a fifth of the input's",
        format_number(load.iae),
        format_number(load.e_max)
    ));
    let (lo, hi) = tuning.range;
    out.push_str(&format!(
        "  output asked for: {} to {}, largest |u| {}\n",
        format_number(lo),
        format_number(hi),
        format_number(lo.abs().max(hi.abs()))
    ));
    if !tuning.warnings.is_empty() {
        out.push_str("\nwarnings:\n");
        for warning in tuning.warnings {
            out.push_str(&format!("  {warning}\n"));
        }
    }
    out
}

#[derive(Serialize)]
struct Object<'a> {
    version: &'static str,
    identified: Identified<'a>,
    design: Designed<'a>,
    worst_residual: f64,
    setpoint_step: Loop,
    load_step: Loop,
    u_range: [f64; 2],
    warnings: &'a [String],
    saved: Option<&'a str>,
    report: Option<&'a str>,
}

#[derive(Serialize)]
struct Loop {
    ie: f64,
    iae: f64,
    e_max: f64,
    tv: f64,
}

impl From<&Metrics> for Loop {
    fn from(m: &Metrics) -> Self {
        Self { ie: m.ie, iae: m.iae, e_max: m.e_max, tv: m.tv }
    }
}

/// The process and its controller as JSON: see `schema.json`.
#[must_use]
pub fn tune_json(tuning: &Tuning<'_>, saved: Option<&str>, report: Option<&str>) -> String {
    text(&Object {
        version: env!("CARGO_PKG_VERSION"),
        identified: Identified::new(&tuning.finding, &[]),
        design: Designed::new(tuning.made, tuning.iae_load, &[], saved),
        worst_residual: tuning.worst_residual,
        setpoint_step: (&tuning.events[0]).into(),
        load_step: (&tuning.events[1]).into(),
        u_range: tuning.range.into(),
        warnings: tuning.warnings,
        saved,
        report,
    })
}
