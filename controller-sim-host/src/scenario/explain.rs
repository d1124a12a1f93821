//! From a fault of a configuration to words and a place in the scenario.

use super::controllers::Draft;
use super::fault::{Fault, code};
use super::log::Log;
use super::number::{range_text, show_short};
use super::places::Setting;
use super::trial::Context;
use super::{CompensatorSpec, ControllerSpec};
use controller_core::{ConfigError, Param, Reason};
use std::ops::Range;

/// The fault `error` of the controller `draft`, at the place of the parameter that caused it.
pub(super) fn explain(
    error: &ConfigError,
    draft: &Draft,
    spec: &ControllerSpec,
    context: &Context<'_>,
    log: &Log<'_>,
) -> Fault {
    let setting = setting(error, draft, spec);
    let fallback = match error.param {
        Param::Ts => context.ts_span.clone(),
        Param::Latency => context.latency_span.clone(),
        _ => None,
    };
    let span = setting.map(|s| s.span.clone()).or(fallback).unwrap_or_else(|| draft.places.whole.clone());
    let subject = subject(error, setting, draft.has_converted_gains(), &span, log);
    match error.reason {
        Reason::NotFinite => {
            let allowed = range_text(error.min, error.max, "");
            let message = format!("{subject} is not a finite number; allowed: {allowed}");
            Fault::new(code::OUT_OF_RANGE, span, message)
        }
        Reason::Inverted => inverted(error, draft, subject, span, log),
        Reason::NeedsFilter => needs_filter(context, subject, span),
        Reason::SignMismatch => sign(error, draft, spec, span),
        _ if error.param == Param::Overflow => overflow(error, draft),
        _ if is_of_the_model(error.param) => model(error, span, subject),
        _ => out_of_range(error, spec, subject, span),
    }
}

/// What set the parameter. Of an estimator's two coefficients it is the one that makes the pole: the fast one
/// comes from `a2`.
fn setting<'d>(error: &ConfigError, draft: &'d Draft, spec: &ControllerSpec) -> Option<&'d Setting> {
    if let (Param::ModelPoles, CompensatorSpec::Estimator(model)) = (error.param, &spec.compensator) {
        let from_a2 = match error.reason {
            Reason::Unstable => model.a1 > 0.0,
            _ => error.min == 0.0 || error.value < 0.5 * model.a1,
        };
        if from_a2 {
            return draft.places.a2();
        }
    }
    draft.places.of(error.param)
}

/// The parameter with its value, as it was written when it was.
fn subject(
    error: &ConfigError,
    setting: Option<&Setting>,
    converted: bool,
    span: &Range<usize>,
    log: &Log<'_>,
) -> String {
    let value = show_short(error.value);
    let Some(setting) = setting else {
        return format!("`{} = {value}`", error.param.name());
    };
    let gain = match error.param {
        Param::Kp => "kp",
        Param::Ki => "ki",
        Param::Kd => "kd",
        _ => "",
    };
    let (gain, converted) = match of_a_bandwidth(error.param, setting) {
        Some(gain) => (gain, true),
        None => (gain, converted),
    };
    let written = log.slice(span);
    if converted && !gain.is_empty() {
        format!("`{gain} = {value}`, computed from `{} = {written}`,", setting.name)
    } else if written.parse::<f64>().is_ok() {
        format!("`{} = {written}`", setting.name)
    } else {
        format!("`{} = {value}`", setting.name)
    }
}

/// The gain of an ADRC that a bandwidth has set.
fn of_a_bandwidth(param: Param, setting: &Setting) -> Option<&'static str> {
    let gain = match param {
        Param::AdrcKp => "kp",
        Param::AdrcKd => "kd",
        Param::Beta1 => "beta1",
        Param::Beta2 => "beta2",
        Param::Beta3 => "beta3",
        _ => return None,
    };
    (setting.name.ends_with("omega_c") || setting.name.ends_with("omega_o")).then_some(gain)
}

fn is_of_the_model(param: Param) -> bool {
    matches!(param, Param::ModelPoles | Param::ModelZeros | Param::ModelOrder)
}

fn out_of_range(error: &ConfigError, spec: &ControllerSpec, subject: String, span: Range<usize>) -> Fault {
    let unit = match error.param {
        Param::Ts | Param::Tf | Param::Tt | Param::Tfd | Param::Alpha | Param::DeadTime | Param::Latency => {
            "s"
        }
        _ => "",
    };
    let mut allowed = range_text(error.min, error.max, unit);
    let mut fault = Fault::new(code::OUT_OF_RANGE, span, "");
    match error.param {
        Param::Tf => {
            let reason = "a filter shorter than half a sample cannot be sampled";
            if spec.config.pid.kd == 0.0 {
                allowed = format!("0, or {allowed}");
            }
            if error.value > 0.0 && error.value < error.min {
                fault = fault.help(reason);
            }
        }
        Param::AdrcKp | Param::AdrcKd if error.value >= error.max => {
            fault = fault
                .help("the sampled feedback is unstable beyond: make it slower, or choose a shorter `ts`");
        }
        Param::Beta3 if error.value >= error.max => {
            fault = fault.help("the observer is unstable unless `beta3` is below `beta1*beta2`");
        }
        Param::ModelGain | Param::B0 => {
            let (least, most) = if error.min > 0.0 { (error.min, error.max) } else { (1e-15, error.max) };
            let size = format!("size {} to {}", show_short(least), show_short(most));
            fault.message = if error.value == 0.0 {
                let name = subject.split(" = ").next().unwrap_or(&subject).trim_start_matches('`');
                format!("`{name}` must not be 0 ({size})")
            } else {
                format!("{subject} is out of range; allowed: {size}")
            };
            return fault;
        }
        Param::FilterOrder => {
            fault = fault.help("leave `order` out to have the smallest one that the model allows");
        }
        _ => {}
    }
    fault.message = format!("{subject} is out of range; allowed: {allowed}");
    fault
}

/// A lower bound that is not below the upper one. The core reports the lower one and, as the largest allowed
/// value, the upper one; of alarms, the lower of two levels.
fn inverted(error: &ConfigError, draft: &Draft, subject: String, span: Range<usize>, log: &Log<'_>) -> Fault {
    let other = match error.param {
        Param::OutputLo => Param::OutputHi,
        Param::SetpointLo => Param::SetpointHi,
        Param::MeasurementLo => Param::MeasurementHi,
        Param::OffsetLo => Param::OffsetHi,
        _ => return alarms_inverted(error, subject, span),
    };
    // As it is written, when it is.
    let written = draft.places.of(other).map(|setting| log.slice(&setting.span));
    let upper = match written {
        Some(written) if written.parse::<f64>().is_ok() => written.to_owned(),
        _ => show_short(error.max),
    };
    let message = format!(
        "{subject} must be below `{} = {upper}`",
        draft.places.of(other).map_or(other.name(), |s| &s.name)
    );
    let Some(setting) = draft.places.of(other) else {
        // The upper bound is a default. When only the upper one was written the place is there.
        let fault = Fault::new(code::CONFLICT, span, message);
        return fault.help(format!("`{}` is not written; {upper} is its default", other.name()));
    };
    if draft.places.of(error.param).is_none() {
        let message = format!("`{} = {upper}` must be above {subject}, the default", setting.name);
        return Fault::new(code::CONFLICT, setting.span.clone(), message);
    }
    Fault::new(code::CONFLICT, span, message).related(setting.span.clone(), "the upper bound")
}

fn alarms_inverted(error: &ConfigError, subject: String, span: Range<usize>) -> Fault {
    let message = format!("{subject} must be below the next higher alarm level, {}", show_short(error.max));
    Fault::new(code::CONFLICT, span, message).help("the order is `lo_lo` < `lo` < `hi` < `hi_hi`")
}

fn needs_filter(context: &Context<'_>, subject: String, span: Range<usize>) -> Fault {
    let message = format!("{subject} needs a filter, and `tf` is 0");
    let least = context.ts.map_or(String::new(), |ts| format!(", at least {} s", show_short(0.5 * ts)));
    Fault::new(code::CONFLICT, span, message).help(format!("write `tf` in `pid`{least}"))
}

fn sign(error: &ConfigError, draft: &Draft, spec: &ControllerSpec, span: Range<usize>) -> Fault {
    let [_, ki, _] = spec.config.pid.signed_gains();
    let message = format!(
        "the model's gain is {}, but the controller's `ki` acts as {}: both must have the same sign",
        show_short(error.value),
        show_short(ki)
    );
    let fault = Fault::new(code::CONFLICT, span, message).help(
        "change the sign of one of them, or write `action = \"direct\"` for a plant with a negative gain",
    );
    match draft.places.of(Param::Ki) {
        Some(ki) => fault.related(ki.span.clone(), "the integral gain"),
        None => fault,
    }
}

fn overflow(error: &ConfigError, draft: &Draft) -> Fault {
    let span = draft
        .places
        .of(Param::Kp)
        .or(draft.places.of(Param::Ki))
        .or(draft.places.of(Param::B0))
        .map_or(draft.places.whole.clone(), |s| s.span.clone());
    if error.min > 0.0 {
        // A coefficient of an ADRC alone, without the signals.
        let allowed = range_text(error.min, error.max, "");
        let message = format!(
            "a coefficient of the sampled law is {} in size; allowed: {allowed}",
            show_short(error.value)
        );
        return Fault::new(code::TOO_LARGE, span, message)
            .help("choose units in which `b0` is nearer to 1, or another `ts`");
    }
    let message = format!(
        "the gains times the ranges of the signals reach {}; allowed: at most {}",
        show_short(error.value),
        show_short(error.max)
    );
    Fault::new(code::TOO_LARGE, span, message)
        .help("lower the gains, or narrow `measurement`, `setpoint` and `limits`")
}

fn model(error: &ConfigError, span: Range<usize>, subject: String) -> Fault {
    let value = show_short(error.value);
    let (least, most) = (show_short(error.min), show_short(error.max));
    let fault = |message: String| Fault::new(code::OUT_OF_RANGE, span.clone(), message);
    match (error.param, error.reason) {
        (Param::ModelPoles, Reason::Unstable) => {
            fault(format!("{subject} makes an unstable model; allowed: `a1` above 0, `a2` of 0 or more"))
        }
        // A frequency has no lower bound, a time constant has.
        (Param::ModelPoles, _) if error.min == 0.0 => fault(format!(
            "the model oscillates at {value} rad/s; allowed: below {most} rad/s, half the sampling frequency"
        ))
        .help("choose a shorter `ts`"),
        (Param::ModelPoles, _) => {
            fault(format!("the model has a time constant of {value} s; allowed: {least} to {most} s"))
                .help("leave out what is much faster than a sample, or choose a shorter `ts`")
        }
        (Param::ModelZeros, Reason::NotProper) => {
            fault(format!("the model has as many zeros as poles; allowed: at most {most} zeros"))
        }
        (Param::ModelOrder, _) => fault(format!("the model's order is {value}; allowed: {least} to {most}")),
        _ => {
            fault(format!("the model has a coefficient {value} in its numerator; allowed: {least} to {most}"))
        }
    }
}
