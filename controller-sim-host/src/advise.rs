//! All tuning rules on one plant, side by side.

use crate::design_run::run_design;
use controller_design::Refusal;
use controller_design::design::{AdrcGain, Design, Method, Request, design};
use controller_design::model::TransferFunction;

/// Delay margin in samples below which a sampling period is too long.
const FEW_SAMPLES: f64 = 10.0;
/// Longest window of the comparison, in samples.
const LONGEST: f64 = 2e5;
/// Delay margin in samples above which it could be much longer.
const MANY_SAMPLES: f64 = 200.0;

/// Noise gain over the least one from which it is worth a word.
const NOISY: f64 = 5.0;

/// What comes of every rule on a plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// The plant.
    pub plant: TransferFunction,
    /// Sampling period \[s\].
    pub ts: f64,
    /// One row for each rule, in the order of [`Method::ALL`].
    pub rows: Vec<Row>,
    /// The options that were given, by their names in files.
    pub options: Vec<&'static str>,
    /// Whether the gain of the ADRC was searched for.
    pub searches_b0: bool,
}

/// One rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The rule.
    pub method: Method,
    /// What came of it, or why nothing did.
    pub outcome: Result<Outcome, Refusal>,
}

/// The loop that a rule makes, simulated as it will run.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The design.
    pub design: Design,
    /// Integral of the absolute error after a unit step of the set-point \[y s\].
    pub iae_setpoint: f64,
    /// The same after a unit step of the load at the plant's input \[y s\].
    pub iae_load: f64,
    /// Why these figures may lack a part.
    pub warnings: Vec<String>,
}

impl Outcome {
    /// Delay margin of the sampled loop in samples.
    #[must_use]
    pub fn delay_margin_samples(&self) -> f64 {
        self.design.sampled.margins.delay_margin / self.design.ts
    }
}

impl Advice {
    /// Which rules looked at each option that was given, a sentence each.
    #[must_use]
    pub fn on_the_options(&self) -> Vec<String> {
        let used = |option: &&str| format!("{option} is used by {} only", Method::that_look_at(option));
        let mut notes: Vec<String> = self.options.iter().map(used).collect();
        if self.searches_b0 {
            notes.push(
                "adrc: b0 is searched for, as by `--b0 search`; without that the rule takes its model's"
                    .to_owned(),
            );
        }
        notes
    }

    /// The noise gain of a row over the least of all, when it is more than 5 times that, and whose that is.
    #[must_use]
    pub fn noise_over_least(&self, row: &Row) -> Option<(f64, Method)> {
        let noise = |row: &Row| Some((row.outcome.as_ref().ok()?.design.sampled.noise.white, row.method));
        let least = self.rows.iter().filter_map(noise).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let ratio = noise(row)?.0 / least.0;
        (ratio > NOISY && ratio.is_finite()).then_some((ratio, least.1))
    }

    /// Whether the sampling period fits, in a sentence.
    #[must_use]
    pub fn on_the_period(&self) -> String {
        let made =
            self.rows.iter().filter_map(|row| row.outcome.as_ref().ok().map(|made| (row.method, made)));
        let slow: Vec<&str> = made
            .clone()
            .filter(|(_, made)| made.delay_margin_samples() < FEW_SAMPLES)
            .map(|(method, _)| method.name())
            .collect();
        if !slow.is_empty() {
            return format!(
                "ts = {} s is long for {}: less than {FEW_SAMPLES} samples of delay margin; a shorter one makes them more robust",
                self.ts,
                slow.join(", ")
            );
        }
        let least = made.map(|(_, made)| made.delay_margin_samples()).fold(f64::INFINITY, f64::min);
        if least.is_finite() && least > MANY_SAMPLES {
            return format!("ts = {} s fits; one {:.0} times as long would, too", self.ts, least / 50.0);
        }
        format!("ts = {} s fits", self.ts)
    }
}

/// Designs a controller by every rule, `request` says with which wishes, and simulates each with unit steps of the
/// set-point and of the load.
#[must_use]
pub fn advise(plant: &TransferFunction, ts: f64, request: impl Fn(Method) -> Request) -> Advice {
    let row = |method| Row {
        method,
        outcome: design(plant, &request(method)).and_then(|made| simulated(made).ok_or(UNSETTLED)),
    };
    Advice {
        plant: plant.clone(),
        ts,
        rows: Method::ALL.into_iter().map(row).collect(),
        options: Vec::new(),
        searches_b0: request(Method::Adrc).b0 == AdrcGain::Search,
    }
}

const UNSETTLED: Refusal = Refusal::NoSolution {
    why: "the simulated loop runs into a limit or a fallback, or does not come to rest",
    help: "choose a shorter ts",
};

/// What comes of a design by its own design file. Where its whole window is simulated the loop must be at rest at its end.
fn simulated(made: Design) -> Option<Outcome> {
    let run = run_design(&made, LONGEST)?;
    if run.cut.is_none() && !run.troubles.is_empty() {
        return None;
    }
    Some(Outcome {
        design: made,
        iae_setpoint: run.iae_setpoint,
        iae_load: run.iae_load,
        warnings: run.cut.into_iter().chain(run.troubles).collect(),
    })
}
