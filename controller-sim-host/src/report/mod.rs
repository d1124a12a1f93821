//! Pages and pictures of runs: one HTML file that needs nothing else, one SVG file.
//!
//! They are drawn from [`Record`](crate::simulate::Record)s, so that their size does not grow with the run and nothing
//! that happened between two columns is lost. A page is for reading: it says what was run, shows the curves, lists the
//! metrics and the parameters, and has the text of the scenario in it to repeat the run.

mod analysis;
mod assessment;
mod bands;
mod card;
mod chapter;
mod commissioning;
mod describe;
mod drawing;
mod experiment;
mod frame;
mod glossary;
mod identification;
mod legend;
mod mapped;
mod marks;
mod overview;
mod page;
mod panels;
mod parameters;
mod path;
mod samples;
mod scale;
pub mod sheet;
mod standalone;
mod tables;
mod tuning;
mod words;

pub use assessment::{Experiment, Line, advice, assessment_page, lines, verdict_line};
pub use experiment::Signals;
pub use mapped::{MapLook, map_page, map_sheet, sheet_page, sheet_svg};

use crate::output::Identification;
use crate::scenario::{Fault, Scenario};
use crate::simulate::{Precision, RunResult};

/// The run of one case of one scenario file.
#[derive(Debug, Clone, Copy)]
pub struct Chapter<'a> {
    /// Name of the file.
    pub name: &'a str,
    /// Which case of its sweep, such as `latency = 0.1`.
    pub case: Option<&'a str>,
    /// Text of the file.
    pub text: &'a str,
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Number type the controllers ran in.
    pub precision: Precision,
    /// What came out; the curves are those of [`ControllerResult::record`](crate::simulate::ControllerResult::record).
    pub result: &'a RunResult,
    /// What is odd about the scenario.
    pub warnings: &'a [Fault],
}

impl Chapter<'_> {
    /// The title of the scenario, else the name of the file; with the case.
    fn title(&self) -> String {
        let title = self.scenario.title.trim();
        let title = if title.is_empty() { self.name } else { title };
        match self.case {
            Some(case) => format!("{title}: {case}"),
            None => title.to_owned(),
        }
    }
}

/// A page with a chapter for each run: HTML that needs no other file and no network, for screens light and dark, wide
/// and narrow, and for paper. `command` is what made it. Cost: some 100 kB a chapter, whatever the length of the run.
#[must_use]
pub fn page(chapters: &[Chapter<'_>], command: &str) -> String {
    page::page(chapters, command)
}

/// A page with the analysis of each case: numbers, Bode and Nyquist plots, sensitivities, noise; as [`page`] otherwise.
#[must_use]
pub fn analysis_page(list: &[crate::output::Analysed<'_>], command: &str) -> String {
    analysis::page(list, command)
}

/// The page of a study of samples of the scenario `name`: what was drawn, unstable loops, distributions. `command` is what made
/// it. Cost: some 10 kB for each index and controller, whatever the number of samples.
#[must_use]
pub fn samples_page(made: &crate::output::Sampled<'_>, name: &str, command: &str) -> String {
    samples::page(made, name, command)
}

/// The picture of a chapter as an SVG file of its own.
#[must_use]
pub fn figure(chapter: &Chapter<'_>) -> String {
    standalone::figure(chapter)
}

/// The page of an identified process: the record with the model's response, residuals, areas, model, warnings. `command` is
/// what made it. Cost: some 100 kB, whatever the length of the record.
#[must_use]
pub fn identification(finding: &Identification<'_>, command: &str) -> String {
    identification::page(finding, command)
}

/// The page of a tuned loop: the record with its model, the simulated loop, margins and noise. `command` is what made it.
#[must_use]
pub fn tuning(
    tuning: &crate::output::Tuning<'_>,
    chapter: &Chapter<'_>,
    analysed: &crate::output::Analysed<'_>,
    command: &str,
) -> String {
    tuning::page(tuning, chapter, analysed, command)
}
