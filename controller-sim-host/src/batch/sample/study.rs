//! What is asked for, the columns of its rows, and its samples.

use super::draw::Source;
use super::quantity::{Quantity, changed};
use crate::analysis;
use crate::batch::digest::Fnv;
use crate::batch::layout::{Column, Kind, Layout};
use crate::scenario::Scenario;
use crate::simulate::{EventKind, Precision, windows};
use controller_design::margins::DiscreteLaw;
use std::borrow::Cow;

/// Changes whenever rows of the same request would come out otherwise.
const FORMAT: &str = "controller-sim sample 1";

/// What became of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The sampled loop is stable.
    Stable,
    /// It is not: the closed loop has poles outside the unit circle or on it.
    Unstable,
    /// The values that were drawn are no scenario.
    Refused,
    /// The loop could not be analysed or simulated.
    Failed,
}

impl Status {
    pub(super) const ALL: [Self; 4] = [Self::Stable, Self::Unstable, Self::Refused, Self::Failed];

    /// As it stands in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

/// As they stand in files.
pub(in crate::batch) const STATUSES: [&str; 4] =
    [Status::Stable.name(), Status::Unstable.name(), Status::Refused.name(), Status::Failed.name()];

/// The first columns of every study.
static FIRST: [Column; DRAWN] = [
    Column::fixed("study", Kind::Text),
    Column::fixed("row", Kind::Count),
    Column::fixed("sample", Kind::Count),
    Column::fixed("controller", Kind::Text),
    Column::fixed("status", Kind::Text),
    Column::fixed("reason", Kind::Text),
];
pub(super) const SAMPLE: usize = 2;
pub(super) const CONTROLLER: usize = 3;
pub(super) const STATUS: usize = 4;
pub(super) const REASON: usize = 5;
/// The first quantity.
pub(super) const DRAWN: usize = 6;

/// Between the quantities and the indices of events.
pub(super) const MARGINS: [&str; 6] = ["unstable_poles", "ms", "mt", "gm", "pm_deg", "delay_margin"];
/// Indices of each event.
pub(super) const INDICES: [&str; 6] = ["ie", "iae", "ise", "itae", "e_max", "tv"];

/// The columns with these names, when they are those of samples.
pub(in crate::batch) fn columns_named(names: &[String]) -> Option<Vec<Column>> {
    let (first, rest) = names.split_at_checked(DRAWN)?;
    let is_first = first.iter().map(String::as_str).eq(FIRST.iter().map(|column| &*column.name));
    let has = |name: &&str| rest.iter().any(|other| other == *name);
    let is_name = |name: &String| {
        !name.is_empty() && name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_')
    };
    let is_whole = is_first && MARGINS.iter().all(has) && rest.iter().all(is_name);
    is_whole.then(|| columns(rest.iter().cloned()))
}

fn columns(rest: impl Iterator<Item = String>) -> Vec<Column> {
    let numbers = rest.map(|name| Column { name: Cow::Owned(name), kind: Kind::Number });
    FIRST.iter().cloned().chain(numbers).collect()
}

/// What is drawn, how often, and from which seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Seeded {
    /// The quantities.
    pub quantities: Vec<Quantity>,
    /// Number of samples, at least 1.
    pub samples: usize,
    /// Samples of another seed have other values.
    pub seed: u64,
    /// Number type of the controllers in the simulation.
    pub precision: Precision,
}

/// A sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The values of the quantities, and the seed of the noise if there is noise.
    pub values: Vec<f64>,
    /// The scenario with them, or why there is none.
    pub scenario: Result<Scenario, String>,
}

/// Loops of a scenario on plants around its own.
#[derive(Debug, Clone)]
pub struct SampleStudy {
    /// The scenario; its controllers do not change.
    pub scenario: Scenario,
    /// What is drawn.
    pub drawn: Seeded,
    /// The law of each controller.
    pub(super) laws: Vec<DiscreteLaw>,
    has_noise: bool,
    /// When the events begin \[s\], and what they are.
    windows: Vec<(f64, EventKind)>,
}

impl SampleStudy {
    /// A study of all controllers of `scenario`.
    ///
    /// # Errors
    /// A controller that is not analysed, such as a cascade, by its name; a plant that is not linear.
    pub fn new(scenario: Scenario, drawn: Seeded) -> Result<Self, String> {
        if let Some(plant) = &scenario.nonlinear {
            return Err(format!(
                "the {} is not linear, and its loop has no margins: `run` shows its linear model, which can be drawn around",
                plant.name()
            ));
        }
        let law = |index: usize| {
            let name = scenario.controllers[index].name.trim();
            analysis::law(&scenario, index).map_err(|why| format!("{name}: {why}"))
        };
        let laws = (0..scenario.controllers.len()).map(law).collect::<Result<_, _>>()?;
        let has_noise =
            scenario.noise.is_some() || drawn.quantities.iter().any(|quantity| quantity.name == "noise.std");
        let windows = windows(&scenario);
        Ok(Self { scenario, drawn, laws, has_noise, windows })
    }

    /// Whether the measurement has noise: each sample has a seed of its own for it.
    #[must_use]
    pub const fn has_noise(&self) -> bool {
        self.has_noise
    }

    /// When the events begin \[s\], and what they are: those of the columns `e1_..`, `e2_..` and so on.
    #[must_use]
    pub fn windows(&self) -> &[(f64, EventKind)] {
        &self.windows
    }

    /// The columns of its rows.
    #[must_use]
    pub fn layout(&self) -> Layout {
        let drawn = self.drawn.quantities.iter().map(Quantity::column);
        let noise = self.has_noise.then(|| "noise_seed".to_owned());
        let margins = MARGINS.map(str::to_owned);
        let indices = (1..=self.windows.len()).flat_map(|n| INDICES.map(|name| format!("e{n}_{name}")));
        Layout::samples(columns(drawn.chain(noise).chain(margins).chain(indices)))
    }

    /// The place of the first margin among the columns.
    pub(super) fn margins_at(&self) -> usize {
        DRAWN + self.drawn.quantities.len() + usize::from(self.has_noise)
    }

    /// Number of rows: one for each controller on each sample.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.drawn.samples * self.scenario.controllers.len()
    }

    /// What its rows carry: a digest of all that they depend on, and their number.
    #[must_use]
    pub fn name(&self) -> String {
        let mut hash = Fnv::new();
        let mut add = |text: &str| {
            hash.add(text.as_bytes());
            hash.add(&[0]);
        };
        add(FORMAT);
        add(env!("CARGO_PKG_VERSION"));
        // Every field of it, numbers with all their digits; what it is called changes no row.
        let scenario = Scenario { title: String::new(), description: String::new(), ..self.scenario.clone() };
        add(&format!("{scenario:?}"));
        for Quantity { name, ends, spread, .. } in &self.drawn.quantities {
            add(&format!("{name} {ends:?} {:?}", spread.distribution));
        }
        add(&format!("{} {:?}", self.drawn.seed, self.drawn.precision));
        format!("{}/{}", hash.text(), self.rows())
    }

    /// The sample `number`, from 1.
    #[must_use]
    pub fn sample(&self, number: usize) -> Drawn {
        let Seeded { quantities, seed, .. } = &self.drawn;
        let source = |name: &str| Source::new(*seed, number as u64, name);
        let draw = |quantity: &Quantity| quantity.spread.draw(quantity.ends, source(&quantity.name));
        let mut values: Vec<f64> = quantities.iter().map(draw).collect();
        let mut scenario = changed(&self.scenario, quantities, &values);
        if self.has_noise {
            let seed = source("noise.seed").seed();
            // Below 2^53: a double holds it.
            values.push(seed as f64);
            if let Ok(Scenario { noise: Some(noise), .. }) = &mut scenario {
                noise.seed = seed;
            }
        }
        Drawn { values, scenario }
    }
}
