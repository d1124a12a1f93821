//! The key `design` of a controller: its parameters by a tuning rule, for the plant of the scenario.

use super::fault::{Fault, code};
use super::number::Allowed;
use super::places::Places;
use super::table::Table;
use super::{CompensatorSpec, ControllerSpec};
use crate::output::table::rounded_numbers;
use controller_core::Param;
use controller_design::Refusal;
use controller_design::design::{
    Design, EstimatorFilter, Filter, Law, Method, ObserverFilter, Request, design,
};
use controller_design::model::TransferFunction;
use std::ops::Range;

/// For messages.
pub(super) const DESIGN: &str = "`design = { method = \"de-momi\" }`";

const TIME: Allowed = Allowed::new(0.0, 1e12, "s");
const GAIN: Allowed = Allowed::new(f64::MIN_POSITIVE, 1e15, "");
const SENSITIVITY: Allowed = Allowed::new(1.001, 100.0, "");
const RATIO: Allowed = Allowed::new(1.000_001, 1e9, "");

/// Keys that a designed controller does not have beside it.
const MADE: [&str; 4] = ["pid", "estimator", "observer", "adrc"];

/// The keys beside the method.
const OPTIONS: [&str; 9] = ["tf", "kpidn", "tfd", "kden", "ms", "ms_max", "alpha", "noise_ratio", "tau_c"];

/// Parameters that come from the design, for the places of what is wrong with them.
const PARAMS: [Param; 12] = [
    Param::Kp,
    Param::Ki,
    Param::Kd,
    Param::Tf,
    Param::B,
    Param::C,
    Param::ModelGain,
    Param::ModelPoles,
    Param::DeadTime,
    Param::Kfd,
    Param::Tfd,
    Param::Alpha,
];

/// A wish for a design, as it was read.
#[derive(Debug, Clone)]
pub(super) struct Wish {
    request: Request,
    /// Of the method, for what the rule refuses.
    span: Range<usize>,
    name: String,
}

/// Reads `design` of `table`; the sampling period is not known yet.
pub(super) fn read(table: &Table<'_>, places: &mut Places) -> Option<Wish> {
    let key = table.key_span("design")?;
    for other in MADE {
        if let Some(span) = table.key_span(other) {
            let message =
                format!("`{}` and `design` exclude each other: the design gives it", table.name(other));
            let fault = Fault::new(code::CONFLICT, span, message).help("remove one of the two");
            table.log.fault(fault.related(key.clone(), "the design"));
        }
    }
    let part = table.table("design", DESIGN)?;
    for param in PARAMS {
        places.set(param, part.whole_name(), part.place.clone());
    }
    let words: Vec<(&str, Method)> = Method::ALL.into_iter().map(|method| (method.name(), method)).collect();
    if part.span("method").is_none() {
        part.missing("method", DESIGN);
    }
    let method = part.choice("method", &words);
    let mut request = Request::new(method.as_ref().map_or(Method::Momi, |method| method.value), 1.0);
    either(&part, "tf", "kpidn");
    either(&part, "tfd", "kden");
    either(&part, "alpha", "noise_ratio");
    let number = |key, allowed| part.span(key).and_then(|_| part.number_in(key, allowed)).map(|x| x.value);
    let times = [number("tf", TIME), number("tfd", TIME), number("alpha", TIME)];
    let gains = [number("kpidn", GAIN), number("kden", GAIN), number("noise_ratio", RATIO)];
    request.filter = times[0].map(Filter::Time).or(gains[0].map(Filter::NoiseGain)).unwrap_or(request.filter);
    let estimator = times[1].map(EstimatorFilter::Time).or(gains[1].map(EstimatorFilter::NoiseGain));
    request.estimator_filter = estimator.unwrap_or(request.estimator_filter);
    let observer = times[2].map(ObserverFilter::Time).or(gains[2].map(ObserverFilter::NoiseRatio));
    request.observer_filter = observer.unwrap_or(request.observer_filter);
    request.ms = number("ms", SENSITIVITY);
    request.ms_max = number("ms_max", SENSITIVITY);
    request.tau_c = number("tau_c", TIME);
    if let Some(method) = &method {
        for option in OPTIONS {
            let Some(span) = part.key_span(option).filter(|_| !method.value.options().contains(&option))
            else {
                continue;
            };
            let message =
                format!("`{}` means nothing to the method {}", part.name(option), method.value.name());
            let of = Method::ALL.into_iter().filter(|method| method.options().contains(&option));
            let of: Vec<&str> = of.map(Method::name).collect();
            let help = format!("it belongs to {}", of.join(", "));
            part.log.fault(Fault::new(code::CONFLICT, span, message).help(help));
        }
    }
    let (span, name) = (part.place.clone(), part.whole_name());
    part.finish();
    method.map(|method| Wish { request, span: if span.is_empty() { method.span } else { span }, name })
}

/// Two ways to say one thing.
fn either(part: &Table<'_>, one: &'static str, other: &'static str) {
    if let (Some(first), Some(second)) = (part.key_span(one), part.key_span(other)) {
        let message = format!("`{}` and `{}` exclude each other", part.name(one), part.name(other));
        let fault = Fault::new(code::CONFLICT, second, message).help("remove one of the two");
        part.log.fault(fault.related(first, "the other one"));
    }
}

impl Wish {
    /// Designs the controller for `plant` and puts it into `spec`; a warning for each of the design's.
    ///
    /// # Errors
    /// What the rule refuses, as a fault.
    pub(super) fn fulfil(
        &self,
        plant: &TransferFunction,
        ts: f64,
        latency: f64,
        spec: &mut ControllerSpec,
    ) -> Result<Vec<Fault>, Fault> {
        let request = Request { ts, latency, ..self.request };
        let made = design(plant, &request).map_err(|refusal| self.refused(&refusal))?;
        apply(&made, spec);
        let warn =
            |text: String| Fault::new(code::DESIGN, self.span.clone(), format!("`{}`: {text}", self.name));
        Ok(made.warnings.iter().map(|warning| warn(warning.to_string())).collect())
    }

    /// The warning that the rule knows the plant only where the run starts.
    pub(super) fn of_linear_model(&self, plant: &TransferFunction) -> Fault {
        let message = format!(
            "`{}`: for the plant's linear model at the start, {}",
            self.name,
            rounded_numbers(&plant.to_string())
        );
        Fault::new(code::DESIGN, self.span.clone(), message)
    }

    fn refused(&self, refusal: &Refusal) -> Fault {
        let message = format!("`{}` by {}: {refusal}", self.name, self.request.method.name());
        Fault::new(code::DESIGN, self.span.clone(), message).help(refusal.help())
    }
}

/// Puts what was designed into a controller.
pub(crate) fn apply(made: &Design, spec: &mut ControllerSpec) {
    match &made.law {
        Law::Pid { pid, estimator, observer } => {
            spec.config.pid = *pid;
            let estimator = estimator.map(CompensatorSpec::Estimator);
            let observer = observer.clone().map(CompensatorSpec::Observer);
            spec.compensator = estimator.or(observer).unwrap_or_default();
        }
        Law::Adrc(adrc) => spec.adrc = Some(*adrc),
    }
}
