//! The plant of a scenario: the whole, its parts when it has two, and its linear model when it is not linear.

use super::fault::{Fault, code};
use super::log::Log;
use super::number::show_short;
use super::surroundings::Start;
use super::table::{Located, Table};
use super::trial::{LONGEST_DELAY, delay_fault};
use super::{models, nonlinear};
use crate::plant::Nonlinear;
use controller_design::model::{TransferFunction, parse};

/// Most time constants of a non-linear plant in a step between two samples: what the integrator is asked to do.
const MOST_LAGS: f64 = 1000.0;

/// A plant as it is written; one that is not linear has its linear model where the run starts.
#[derive(Debug, Clone)]
pub(super) enum Written {
    Linear(Box<Plant>),
    Nonlinear(Located<Nonlinear>),
}

/// A plant as it was read.
#[derive(Debug, Clone)]
pub(super) struct Plant {
    /// From the actuator to the measurement, as it is known: what controllers are designed for. The linear model of one that is
    /// not linear.
    pub(super) whole: TransferFunction,
    /// What is simulated when it is linear.
    pub(super) actual: TransferFunction,
    /// What is simulated in its place.
    pub(super) nonlinear: Option<Nonlinear>,
    /// The part that the actuator drives first and the part behind it, when they are written one by one.
    pub(super) parts: Option<[TransferFunction; 2]>,
}

/// `[plant]`.
pub(super) fn read(root: &Table<'_>, ts: Option<&Located<f64>>, latency: f64) -> Option<Written> {
    let example = "`[plant]` and below it `tf = \"exp(-0.2*s)/(1+s)\"`";
    if root.span("plant").is_none() {
        root.missing("plant", example);
    }
    let table = root.table("plant", example)?;
    if let Some(key) = nonlinear::FORMS.into_iter().find(|&key| table.span(key).is_some()) {
        let plant = read_nonlinear(&table, key, ts, latency);
        table.finish();
        return plant.map(Written::Nonlinear);
    }
    let outer = models::read(&table);
    let inner = table.span("inner").map(|_| models::value(&table, "inner"));
    let plant = outer.and_then(|outer| match inner {
        None => Some((Plant::known(outer.value, None), outer.span)),
        Some(inner) => Some((in_series(&table, inner?, &outer)?, outer.span)),
    });
    let actual = table.span("actual").and_then(|_| models::value(&table, "actual"));
    if let Some(ts) = ts {
        let known = plant.iter().map(|(plant, span)| (&plant.whole, span));
        for (plant, span) in known.chain(actual.iter().map(|actual| (&actual.value, &actual.span))) {
            let samples = (plant.dead_time() + latency) / ts.value;
            if samples > LONGEST_DELAY {
                let what = "the plant's dead time and the latency are";
                table.log.fault(delay_fault(what, samples, span.clone()));
            }
        }
    }
    let mut plant = plant.map(|(plant, _)| plant);
    if let (Some(plant), Some(actual)) = (&mut plant, actual) {
        if plant.parts.is_some() {
            let message = format!(
                "`{}` is a whole plant; with an `inner` part there is no whole",
                table.name("actual")
            );
            table.log.fault(Fault::new(code::CONFLICT, actual.span.clone(), message));
        }
        plant.actual = actual.value;
    }
    table.finish();
    plant.map(|plant| Written::Linear(Box::new(plant)))
}

/// The plant `key`, which stands alone.
fn read_nonlinear(
    table: &Table<'_>,
    key: &'static str,
    ts: Option<&Located<f64>>,
    latency: f64,
) -> Option<Located<Nonlinear>> {
    let own = table.key_span(key)?;
    let others = nonlinear::FORMS.into_iter().chain(models::FORMS).chain(["den"]);
    let other = others.filter(|&other| other != key).find_map(|other| Some((other, table.key_span(other)?)));
    if let Some(other) = other {
        models::two_plants(table, (key, own), other);
        let _ = table.span("inner");
        return None;
    }
    if let Some(span) = table.key_span("inner") {
        let message = format!(
            "`{}` is part of a linear plant; `{}` is a whole one",
            table.name("inner"),
            table.name(key)
        );
        let help = "remove it: a cascade needs a plant of two linear parts";
        table.log.fault(Fault::new(code::CONFLICT, span, message).help(help).related(own, "the plant"));
    }
    if let Some(span) = table.key_span("dead_time") {
        let message = format!("`{}` belongs into the braces of `{key}`", table.name("dead_time"));
        table.log.fault(Fault::new(code::CONFLICT, span, message));
    }
    let plant = nonlinear::read(table, key)?;
    if let Some(ts) = ts {
        let samples = (plant.value.dead_time() + latency) / ts.value;
        if samples > LONGEST_DELAY {
            let fault = delay_fault("the plant's dead time and the latency are", samples, plant.span.clone());
            table.log.fault(fault);
        }
    }
    Some(plant)
}

impl Written {
    /// The plant, when it is linear.
    pub(super) fn linear(&self) -> Option<&TransferFunction> {
        match self {
            Self::Linear(plant) => Some(&plant.actual),
            Self::Nonlinear(_) => None,
        }
    }

    /// The plant where the run starts, with its linear model there; `step` is the time between two substeps \[s\].
    pub(super) fn at(self, start: &Start, step: Option<f64>, log: &Log<'_>) -> Option<Plant> {
        let Located { value: plant, span } = match self {
            Self::Linear(plant) => return Some(*plant),
            Self::Nonlinear(plant) => plant,
        };
        let lag = plant.shortest_lag();
        if let Some(step) = step.filter(|step| *step > MOST_LAGS * lag) {
            let message = format!(
                "the plant moves within {} s, a step between the samples takes {} s: too fast for the integrator",
                show_short(lag),
                show_short(step)
            );
            let help =
                format!("choose a shorter `ts` or more `substeps`: at most {MOST_LAGS} times as long a step");
            log.fault(Fault::new(code::TOO_LARGE, span.clone(), message).help(help));
        }
        let (y0, d0) = (start.initial.setpoint, start.initial.disturbance);
        if let Some(whole) = plant.linear_model(y0, d0) {
            return Some(Plant { nonlinear: Some(plant), ..Plant::known(whole, None) });
        }
        // A start that was not understood is not judged.
        if start.is_faulty {
            return None;
        }
        let range = plant.range(d0);
        let allowed = match range {
            Some([lo, hi]) if hi.is_finite() => format!("above {}, below {}", show_short(lo), show_short(hi)),
            Some([lo, _]) => format!("{} or more", show_short(lo)),
            None => "none".to_owned(),
        };
        let name = plant.name();
        let help = range.map_or(Some("with these parameters nothing holds the plant anywhere"), |_| None);
        let (place, message, help) = match &start.setpoint {
            Some(place) => {
                let message = format!("`initial.setpoint = {}` is no rest of the {name}", log.slice(place));
                (place.clone(), message, help)
            }
            None => {
                let message = format!("`initial.setpoint` is missing: the {name} has no rest at 0");
                (span, message, help.or(Some("write where the run starts in `[initial]`")))
            }
        };
        let mut fault = Fault::new(code::OUT_OF_RANGE, place, format!("{message}; allowed: {allowed}"));
        fault.help = help.map(str::to_owned);
        log.fault(fault);
        None
    }
}

impl Plant {
    /// A linear plant that is what it is known as.
    fn known(whole: TransferFunction, parts: Option<[TransferFunction; 2]>) -> Self {
        Self { actual: whole.clone(), whole, nonlinear: None, parts }
    }
}

/// The inner part with the outer one behind it.
fn in_series(
    table: &Table<'_>,
    inner: Located<TransferFunction>,
    outer: &Located<TransferFunction>,
) -> Option<Plant> {
    let name = table.name("inner");
    if inner.value.differentiators() > 0 {
        let message = format!("`{name}` has a zero at s = 0: nothing can hold it at a set-point");
        table.log.fault(Fault::new(code::CONFLICT, inner.span, message));
        return None;
    }
    if inner.value.integrators() > 0 && outer.value.differentiators() > 0 {
        let message =
            format!("`{name}` has a pole at s = 0 and the outer part a zero there, which would cancel");
        let fault =
            Fault::new(code::CONFLICT, inner.span, message).related(outer.span.clone(), "the outer part");
        table.log.fault(fault);
        return None;
    }
    // Printed, a transfer function keeps its factors and every bit of its numbers.
    match parse(&format!("({})*({})", inner.value, outer.value)) {
        Ok(whole) => Some(Plant::known(whole, Some([inner.value, outer.value.clone()]))),
        Err(errors) => {
            let reason = errors.first().map_or("", |error| &error.message);
            let message = format!("`{name}` and the outer part together: {reason}");
            table.log.fault(Fault::new(code::EXPRESSION, inner.span, message));
            None
        }
    }
}
