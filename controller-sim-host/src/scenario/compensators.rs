//! The keys `estimator` and `observer` of a controller.

use super::fault::{Fault, code};
use super::models;
use super::number::Allowed;
use super::places::Places;
use super::sections::take;
use super::table::Table;
use super::{CompensatorSpec, ControllerSpec};
use controller_core::{EstimatorConfig, ObserverConfig, Param};

const ESTIMATOR: &str =
    "`estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.7, tfd = 0.06 }`";
const OBSERVER: &str = "`observer = { model = \"exp(-0.2*s)/(1+s)\", alpha = 0.1 }`";

/// Everything that a model expression sets.
const MODEL: [Param; 5] =
    [Param::ModelGain, Param::ModelPoles, Param::ModelZeros, Param::ModelOrder, Param::DeadTime];

/// Reads the compensator of a controller.
pub(super) fn read(table: &Table<'_>, places: &mut Places) -> CompensatorSpec {
    let both = (table.key_span("estimator"), table.key_span("observer"));
    let estimator = table.table("estimator", ESTIMATOR).map(|part| {
        let mut config = EstimatorConfig::default();
        for (key, param, example) in [
            ("gain", Param::ModelGain, "the gain of the model, `gain = 1.0`"),
            ("a1", Param::ModelPoles, "the coefficient of s in the model's denominator, `a1 = 1.2`"),
            ("kfd", Param::Kfd, "the gain of the estimator, 0 to 1, `kfd = 0.7`"),
            ("tfd", Param::Tfd, "the filter time constant in seconds, `tfd = 0.06`"),
        ] {
            require(&part, key, param, example, places);
        }
        estimator(part, &mut config, places);
        CompensatorSpec::Estimator(config)
    });
    let observer = table.table("observer", OBSERVER).map(|part| {
        let mut config = ObserverConfig::default();
        require(&part, "model", Param::ModelGain, "`model = \"exp(-0.2*s)/(1+s)\"`", places);
        if part.span("model").is_none() {
            places.silence(&MODEL);
        }
        require(&part, "alpha", Param::Alpha, "the filter time constant in seconds, `alpha = 0.1`", places);
        observer(part, &mut config, places);
        CompensatorSpec::Observer(config)
    });
    if let (Some(first), Some(second)) = both {
        let message = "a controller has either an estimator or an observer, not both";
        let fault = Fault::new(code::CONFLICT, second, message)
            .help("write two controllers to compare them")
            .related(first, "the other one");
        table.log.fault(fault);
        places.silence(&MODEL);
        places.silence(&[Param::FilterOrder, Param::Kfd, Param::Tfd, Param::Alpha]);
    }
    estimator.or(observer).unwrap_or_default()
}

fn require(part: &Table<'_>, key: &'static str, param: Param, example: &str, places: &mut Places) {
    if part.span(key).is_none() {
        part.missing(key, example);
        places.silence(&[param]);
    }
}

/// Reads a change of the compensator in an event over what the controller has.
pub(super) fn change(table: &Table<'_>, spec: &mut ControllerSpec, places: &mut Places) {
    if let Some(part) = table.table("estimator", ESTIMATOR) {
        match &mut spec.compensator {
            CompensatorSpec::Estimator(config) => estimator(part, config, places),
            other => refuse(table, "estimator", &spec.name, other),
        }
    }
    if let Some(part) = table.table("observer", OBSERVER) {
        match &mut spec.compensator {
            CompensatorSpec::Observer(config) => observer(part, config, places),
            other => refuse(table, "observer", &spec.name, other),
        }
    }
}

/// A running loop keeps the kind of its compensator: there is no state to take over.
fn refuse(table: &Table<'_>, key: &'static str, name: &str, has: &CompensatorSpec) {
    let has = match has {
        CompensatorSpec::None => "no compensator",
        CompensatorSpec::Estimator(_) => "an estimator",
        CompensatorSpec::Observer(_) => "an observer",
    };
    let Some(span) = table.key_span(key) else { return };
    // An event for all controllers: one fault says it.
    if table.log.is_faulty(&span) {
        return;
    }
    let message = format!("controller `{name}` has {has}; an event cannot make it `{key}`");
    table.log.fault(Fault::new(code::CONFLICT, span, message).help(
        "restrict the event by `controller = \"name\"` to one that has it, or write a second controller",
    ));
}

fn estimator(part: Table<'_>, config: &mut EstimatorConfig, places: &mut Places) {
    take(&part, "gain", Param::ModelGain, places, &mut config.gain);
    take(&part, "a1", Param::ModelPoles, places, &mut config.a1);
    // Both coefficients make the poles, and the core has one name for them.
    if let Some(span) = part.span("a2") {
        match part.number("a2", Some(Allowed::new(0.0, 1e24, "s^2"))) {
            Some(a2) => config.a2 = a2.value,
            None => places.silence(&[Param::ModelPoles]),
        }
        places.set_a2(part.name("a2"), span);
    }
    take(&part, "dead_time", Param::DeadTime, places, &mut config.dead_time);
    take(&part, "kfd", Param::Kfd, places, &mut config.kfd);
    take(&part, "tfd", Param::Tfd, places, &mut config.tfd);
    part.finish();
}

fn observer(part: Table<'_>, config: &mut ObserverConfig, places: &mut Places) {
    if let Some(span) = part.span("model") {
        for param in MODEL {
            places.set(param, part.name("model"), span.clone());
        }
    }
    if let Some(model) = models::value(&part, "model") {
        match model.value.to_plant_model() {
            Ok(model) => config.model = model,
            Err(error) => {
                let message = format!("`{}` cannot be used as a model: {error}", part.name("model"));
                part.log.fault(Fault::new(code::EXPRESSION, model.span, message));
            }
        }
    }
    take(&part, "alpha", Param::Alpha, places, &mut config.alpha);
    if let Some(order) = part.integer_in("order", 1, 16) {
        places.set(Param::FilterOrder, part.name("order"), order.span);
        config.order = usize::try_from(order.value).ok();
    }
    part.finish();
}
