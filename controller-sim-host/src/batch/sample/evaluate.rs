//! From a sample to its rows.

use super::study::{CONTROLLER, DRAWN, REASON, SAMPLE, STATUS, SampleStudy, Status};
use crate::batch::layout::Cells;
use crate::batch::work::{Stopped, in_order};
use crate::scenario::Scenario;
use crate::simulate::{Control, RunError, run_controller};
use controller_design::margins::{DiscreteLoop, Margins};
use std::ops::Range;
use std::sync::atomic::AtomicU64;

/// Makes the rows in `range`, from 0, on `jobs` threads and gives them to `take` in their order; `done` counts them. What is
/// computed depends neither on the threads nor on the range.
///
/// A loop is stable when the sampled closed loop with the drawn plant has no pole outside the unit circle or on it, counted by
/// the argument principle from its frequency response ([`DiscreteLoop::unstable_poles`]); the simulation does not decide.
/// Limits, quantisation and changes of parameters by events are no part of that count, they are of the simulation.
///
/// # Errors
/// [`Stopped`] by `control`, the rows up to then given; whatever `take` reports ends it as well.
pub fn work<E: From<Stopped>>(
    study: &SampleStudy,
    range: Range<usize>,
    jobs: usize,
    control: &Control,
    done: &AtomicU64,
    take: impl FnMut(Vec<Cells>) -> Result<(), E>,
) -> Result<(), E> {
    let (name, columns) = (study.name(), study.layout().columns().len());
    let controllers = study.scenario.controllers.len();
    in_order(range, controllers, jobs, control, done, take, |index| {
        let drawn = study.sample(index + 1);
        let name = &name;
        move |controller: usize| {
            let mut cells = Cells::new(name, index * controllers + controller + 1, columns);
            (index + 1).to_string().clone_into(&mut cells.0[SAMPLE]);
            study.scenario.controllers[controller].name.trim().clone_into(&mut cells.0[CONTROLLER]);
            cells.put(DRAWN, drawn.values.iter().copied().map(Some));
            let (status, reason) = match &drawn.scenario {
                Err(why) => (Status::Refused, why.clone()),
                Ok(scenario) => fill(study, scenario, controller, control, &mut cells)?,
            };
            status.name().clone_into(&mut cells.0[STATUS]);
            cells.put_reason(REASON, &reason);
            Some(cells)
        }
    })
}

/// Puts margins and indices into a row; nothing comes back when it was stopped.
fn fill(
    study: &SampleStudy,
    scenario: &Scenario,
    controller: usize,
    control: &Control,
    cells: &mut Cells,
) -> Option<(Status, String)> {
    let at = study.margins_at();
    let law = study.laws[controller].clone();
    let held = match DiscreteLoop::new(&scenario.plant, law, scenario.latency) {
        Ok(held) => held,
        Err(refusal) => return Some((Status::Failed, refusal.to_string())),
    };
    let mut status = (Status::Stable, String::new());
    match held.margins_or_poles() {
        Ok(Ok(margins)) => {
            let Margins { ms, mt, gm, pm_deg, delay_margin, .. } = margins;
            cells.put(at, [0.0, ms, mt, gm, pm_deg, delay_margin].map(finite));
        }
        Ok(Err(poles)) => {
            cells.put(at, [Some(poles as f64)]);
            status.0 = Status::Unstable;
        }
        Err(refusal) => status = (Status::Failed, refusal.to_string()),
    }
    match run_controller(scenario, controller, study.drawn.precision, control) {
        Ok(result) => {
            let indices = result.events.iter().flat_map(|event| {
                let m = &event.metrics;
                [m.ie, m.iae, m.ise, m.itae, m.e_max, m.tv]
            });
            cells.put(at + super::study::MARGINS.len(), indices.map(finite));
        }
        Err(RunError::Stopped) => return None,
        Err(error) => status = (Status::Failed, error.to_string()),
    }
    Some(status)
}

/// What is no number has no cell.
fn finite(x: f64) -> Option<f64> {
    (!x.is_nan()).then_some(x)
}
