//! The loop card: every figure of one loop as it is deployed, judged against stated practice.
//!
//! The loop is that of the law that is flashed: its coefficients in the target's number type, the hold, the dead time and
//! the latency with their fractions. Margins and noise come from its frequency response, the smallest error and the
//! behaviour at the limits from runs of the law itself, memory and instructions from the published table of a board.
//!
//! ```
//! use controller_sim_host::card::{Request, loop_card};
//! use controller_sim_host::demo;
//! use controller_sim_host::scenario::read;
//! use controller_sim_host::simulate::Precision;
//!
//! let demo = read(demo::SCENARIO, Precision::F32).expect("the demo is valid").scenario;
//! let card = loop_card(&demo, 0, Request::default()).expect("a stable loop");
//! assert!(card.value("ms").expect("a figure") > 1.0);
//! assert_eq!((card.value("ram"), card.board.core), (Some(252.0), "Cortex-M4F"));
//! ```

mod check;
mod costs;
mod deployed;
mod figure;
mod file;
mod frequency;
mod limits;
mod practice;
mod smallest;
mod trials;

pub use check::{Check, Verdict, check};
pub use figure::{Better, Figure, KEYS, Light};
pub use file::{Bounds, CardFile};

use crate::scenario::{CompensatorSpec, Scenario};
use crate::simulate::{Precision, Remark, RunResult};
use controller_core::Real;
use controller_pil::board::{BOARDS, Board};
use costs::{Shape, cost};
use deployed::Deployed;
use frequency::Frequency;

/// What a card is made for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The target's number type.
    pub precision: Precision,
    /// The board whose published table is read.
    pub board: &'static Board,
}

impl Default for Request {
    /// Single precision on the reference board.
    fn default() -> Self {
        Self { precision: Precision::F32, board: &BOARDS[0] }
    }
}

/// The card of one loop.
#[derive(Debug, Clone)]
pub struct LoopCard {
    /// Name of the controller.
    pub name: String,
    /// The number type of the law.
    pub precision: Precision,
    /// The board of memory and instructions.
    pub board: &'static Board,
    /// The figures, in the order of [`KEYS`]; those that do not exist for this loop stand in [`absent`](Self::absent).
    pub figures: Vec<Figure>,
    /// Figures that this loop does not have, and why.
    pub absent: Vec<(&'static str, String)>,
    /// What the loop was tried with, for pictures: a step of the set-point and of the load, the limits, noise at rest.
    pub trials: Vec<Trial>,
}

/// A run of the loop.
#[derive(Debug, Clone)]
pub struct Trial {
    /// What is tried.
    pub title: &'static str,
    /// In one or two sentences.
    pub text: String,
    /// What was run.
    pub scenario: Scenario,
    /// What came out.
    pub result: RunResult,
}

impl Trial {
    /// What to know of the run.
    #[must_use]
    pub fn remarks(&self) -> Vec<&Remark> {
        self.result.controllers.iter().flat_map(|controller| &controller.remarks).collect()
    }
}

impl LoopCard {
    /// The figure with this key.
    #[must_use]
    pub fn figure(&self, key: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.key == key)
    }

    /// The value of the figure with this key; infinite where nothing limits it.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<f64> {
        self.figure(key).map(|figure| figure.value)
    }

    /// How many figures have this light.
    #[must_use]
    pub fn count(&self, light: Light) -> usize {
        self.figures.iter().filter(|figure| figure.light == light).count()
    }
}

/// Makes the card of the controller `index` of `scenario`. Cost: some tenths of a second, most of it runs.
///
/// # Errors
/// A cascade; a plant that is not linear; a law that cannot be built in the number type; a loop without margins, an unstable one above all.
pub fn loop_card(scenario: &Scenario, index: usize, request: Request) -> Result<LoopCard, String> {
    match request.precision {
        Precision::F32 => card::<f32>(scenario, index, request),
        Precision::F64 => card::<f64>(scenario, index, request),
    }
}

fn card<T: Real>(scenario: &Scenario, index: usize, request: Request) -> Result<LoopCard, String> {
    let spec = scenario.controllers.get(index).ok_or("there is no such controller")?;
    if spec.secondary.is_some() {
        return Err("a cascade has no card: make one of its inner loop as a scenario of its own".to_owned());
    }
    if let Some(plant) = &scenario.nonlinear {
        return Err(format!(
            "the {} is not linear and has no card: `run` shows its linear model, which can have one",
            plant.name()
        ));
    }
    let deployed = Deployed::<T>::new(scenario, spec)?;
    let frequency = Frequency::new(&deployed)?;
    let mut card = LoopCard {
        name: spec.name.trim().to_owned(),
        precision: request.precision,
        board: request.board,
        figures: Vec::new(),
        absent: Vec::new(),
        trials: Vec::new(),
    };
    practice::judge_frequency(&mut card, &deployed, &frequency);
    practice::judge_smallest(&mut card, &deployed, smallest::smallest(&deployed));
    let shape = shape(&deployed);
    practice::judge_costs(&mut card, &deployed, cost(request.board, request.precision, shape));
    let (window, steps) = trials::steps(&deployed, &frequency.margins, request.precision)?;
    card.trials.push(steps);
    practice::judge_limits(&mut card, limits::at_limits(&deployed, window, request.precision));
    if let Some(trial) = trials::noise(&deployed, request.precision) {
        card.trials.push(trial);
    }
    card.figures.sort_by_key(|figure| KEYS.iter().position(|key| *key == figure.key));
    Ok(card)
}

/// What decides the cost of the loop on a board.
fn shape<T: Real>(deployed: &Deployed<'_, T>) -> Shape {
    match (&deployed.spec.adrc, &deployed.spec.compensator, deployed.law.compensator()) {
        (Some(_), ..) => Shape::Adrc,
        (None, CompensatorSpec::None, _) | (None, _, None) => Shape::Pid,
        (None, _, Some(law)) => {
            let law = law.coefficients();
            Shape::Compensated { lags: law.g.len(), shared: law.e_gain.len(), cells: law.delay + 1 }
        }
    }
}
