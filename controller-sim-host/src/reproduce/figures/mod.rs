//! Every figure of the papers: the ones that can be computed again, with what draws them, and why the others cannot.

mod frequency;
mod peaks;
mod processes;
mod trade_off;

use super::Paper;
use super::bench::{Bench, Stop};
use crate::report::sheet::Sheet;
use crate::simulate::Control;

/// A figure of a paper.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// The paper.
    pub paper: Paper,
    /// Its number there.
    pub number: u8,
    /// What it shows.
    pub title: &'static str,
    source: Source,
}

/// Where a figure comes from.
#[derive(Debug, Clone, Copy)]
enum Source {
    /// Built-in scenarios by this name.
    Scenario(&'static str),
    /// It is computed here.
    Drawn(fn(&Bench<'_>) -> Result<Sheet, Stop>),
    /// It cannot be computed, for this reason.
    Not(&'static str),
}

/// How a figure can be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The built-in scenarios by this name are run.
    Run(&'static str),
    /// [`draw`] computes it.
    Draw,
    /// Not at all, for this reason.
    Not(&'static str),
}

impl Figure {
    /// Its name: that of the paper and its number, such as `dob-10`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}-{}", self.paper.name(), self.number)
    }

    /// How it can be drawn.
    #[must_use]
    pub fn way(&self) -> Way {
        match self.source {
            Source::Drawn(_) => Way::Draw,
            Source::Scenario(name) => Way::Run(name),
            Source::Not(why) => Way::Not(why),
        }
    }
}

const BLOCKS: &str = "a block diagram";
const CHART: &str = "a flow chart of an algorithm";

const fn figure(paper: Paper, number: u8, title: &'static str, source: Source) -> Figure {
    Figure { paper, number, title, source }
}

/// All of them, in the order of the papers.
static FIGURES: [Figure; 42] = {
    use Paper::{De, Dob, Pi};
    use Source::{Drawn, Not, Scenario};
    [
        figure(De, 1, "loop with one degree of freedom", Not(BLOCKS)),
        figure(De, 2, "loop with two degrees of freedom", Not(BLOCKS)),
        figure(De, 3, "PID with disturbance estimator", Not(BLOCKS)),
        figure(De, 4, "responses for K_FD = 1 and 0.44", Not("the chapter does not tell the process")),
        figure(De, 5, "DE-MOMI structure", Not(BLOCKS)),
        figure(De, 6, "process GP1 under MOMI, DRMO, DE-MOMI", Scenario("de-fig-06")),
        figure(De, 7, "process GP2 under MOMI, DRMO, DE-MOMI", Scenario("de-fig-07")),
        figure(De, 8, "layout of a web page with scripts", Not("a picture of a web page")),
        figure(De, 9, "iteration for T_F", Not(CHART)),
        figure(De, 10, "iteration for T_FD", Not(CHART)),
        figure(De, 11, "process GP3 under MOMI, DRMO, DE-MOMI", Scenario("de-fig-11")),
        figure(De, 12, "process GP4 under MOMI, DRMO, DE-MOMI", Scenario("de-fig-12")),
        figure(De, 13, "ADRC structure", Not(BLOCKS)),
        figure(De, 14, "process GP5, five methods", Scenario("de-fig-14")),
        figure(De, 15, "process GP6, five methods", Scenario("de-fig-15")),
        figure(Dob, 1, "structure of disturbance observers", Not(BLOCKS)),
        figure(Dob, 2, "proposed control scheme", Not(BLOCKS)),
        figure(Dob, 3, "bound on robustness, noise amplification", Drawn(trade_off::bounds)),
        figure(Dob, 4, "error after a step and a ramp of the load: y of the page", Scenario("dob-fig-04-05")),
        figure(Dob, 5, "control action after them: u of the page", Scenario("dob-fig-04-05")),
        figure(Dob, 6, "load to error over frequency", Drawn(frequency::load)),
        figure(Dob, 7, "sensitivity over frequency, Ms marked", Drawn(frequency::sensitivity)),
        figure(Dob, 8, "noise to control action over frequency", Drawn(frequency::noise)),
        figure(Dob, 9, "rejection of a random walk, of one drawn here", Scenario("random-walk")),
        figure(Dob, 10, "trade-off maps", Drawn(trade_off::maps)),
        figure(Dob, 11, "the 134 processes, noise gain 2", Drawn(processes::twice)),
        figure(Dob, 12, "the 134 processes, noise gain 10", Drawn(processes::ten)),
        figure(Dob, 13, "the two-tank rig", Not("a photograph with a diagram")),
        figure(Dob, 14, "the rig, load and level: y of the page", Scenario("dob-fig-14-15")),
        figure(Dob, 15, "the rig, load and pump: u of the page", Scenario("dob-fig-14-15")),
        figure(Pi, 1, "a load response and its peaks", Drawn(peaks::example)),
        figure(Pi, 2, "kp of least IAE and two fits", Drawn(peaks::gain)),
        figure(Pi, 3, "ti of least IAE and two fits", Drawn(peaks::time)),
        figure(Pi, 4, "three tunings, first order with dead time", Drawn(peaks::three_of_lag)),
        figure(Pi, 5, "optimal load responses", Drawn(peaks::responses)),
        figure(Pi, 6, "IAE, largest error, its time, settling time", Drawn(peaks::metrics)),
        figure(Pi, 7, "damping ratios", Drawn(peaks::damping)),
        figure(Pi, 8, "time ratios", Drawn(peaks::times)),
        figure(Pi, 9, "three tunings, integrator with dead time", Drawn(peaks::three_of_integrator)),
        figure(Pi, 10, "damping ratios, integrator", Drawn(peaks::damping_of_integrator)),
        figure(Pi, 11, "time ratios, integrator", Drawn(peaks::times_of_integrator)),
        figure(Pi, 12, "Ms, gain and phase margin", Drawn(peaks::margins)),
    ]
};

/// Every figure of the papers.
pub fn figures() -> impl Iterator<Item = &'static Figure> {
    FIGURES.iter()
}

/// The figure called `name`, such as `dob-10`, `dob-fig-10` or `de-06`.
#[must_use]
pub fn figure_named(name: &str) -> Option<&'static Figure> {
    let (paper, number) = name.split_once('-')?;
    let number = number.strip_prefix("fig-").or_else(|| number.strip_prefix("figure-")).unwrap_or(number);
    let is_digits = (1..=3).contains(&number.len()) && number.bytes().all(|c| c.is_ascii_digit());
    let number: u8 = number.parse().ok().filter(|_| is_digits)?;
    FIGURES.iter().find(|one| one.paper.name().eq_ignore_ascii_case(paper) && one.number == number)
}

/// Why a figure was not drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DrawError {
    /// It was stopped from outside.
    Stopped,
    /// Something has no result.
    Failed(String),
}

/// Computes a figure whose way is [`Way::Draw`]. The result does not depend on how many threads there are.
///
/// # Errors
/// [`DrawError`]; a figure that is not drawn here fails.
pub fn draw(figure: &Figure, control: &Control) -> Result<Sheet, DrawError> {
    let Source::Drawn(of) = figure.source else {
        return Err(DrawError::Failed(format!("{} is not drawn here", figure.name())));
    };
    of(&Bench::new(control)).map_err(|stop| match stop {
        Stop::Stopped => DrawError::Stopped,
        Stop::Failed(why) => DrawError::Failed(why),
    })
}

/// The title of a sheet.
fn titled(paper: Paper, number: u8, title: &str) -> String {
    format!("{}, figure {number}: {title}", paper.source())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo;

    #[test]
    fn names_are_found_however_they_are_written() {
        for name in ["dob-10", "DOB-10", "dob-fig-10", "dob-figure-10", "dob-010"] {
            assert_eq!(figure_named(name).map(Figure::name).as_deref(), Some("dob-10"), "{name}");
        }
        for name in ["", "dob", "dob-", "dob-99", "xyz-1", "dob-10x", "dob-+1", "10", "dob-256"] {
            assert!(figure_named(name).is_none(), "{name}");
        }
    }

    #[test]
    fn every_number_is_there_once() {
        for (paper, last) in [(Paper::De, 15), (Paper::Dob, 15), (Paper::Pi, 12)] {
            let numbers: Vec<u8> = figures().filter(|one| one.paper == paper).map(|one| one.number).collect();
            assert_eq!(numbers, (1..=last).collect::<Vec<u8>>());
        }
        for one in figures() {
            if let Source::Scenario(name) = one.source {
                assert!(demo::named(name).is_ok(), "{name}");
            }
        }
    }
}
