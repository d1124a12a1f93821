//! What can be said of a loop once its law is made.

use super::build::Made;
use super::{ContinuousDesign, Design, Law, Method, Predicted, Request, Sampled};
use crate::margins::{ContinuousLoop, DiscreteLaw, DiscreteLoop, Margins, TOO_MANY_TURNS};
use crate::model::TransferFunction;
use crate::rules::noise_limit;
use crate::warning::warn;
use crate::{Refusal, Warning};
use controller_core::{Adrc, AdrcCoefficients, AdrcConfig};

/// Largest maximum sensitivity of a robust loop.
pub(super) const ROBUST: f64 = 2.0;
/// Delay margin in samples below which the sampling period is too long.
const FEW_SAMPLES: f64 = 10.0;

/// The continuous loop of a law.
fn continuous(plant: &TransferFunction, law: &Law, latency: f64) -> Result<ContinuousLoop, Refusal> {
    let (pid, estimator, observer) = match law {
        Law::Pid { pid, estimator, observer } => (pid, estimator, observer),
        Law::Adrc(config) => return Ok(ContinuousLoop::of_adrc(plant, config)?.with_latency(latency)),
    };
    let mut made = ContinuousLoop::new(plant, pid).with_latency(latency);
    if let Some(estimator) = estimator {
        made = made.with_estimator(estimator)?;
    }
    if let Some(observer) = observer {
        made = made.with_observer(observer)?;
    }
    Ok(made)
}

/// The integrals of the error with an ADRC, from the sampled law at `z = 1`: with `1 - C_u = n*c`, `n = 1 - 1/z`, the load
/// gives `-ts*c/kp` and the set-point `ts*(c/K + kd)/kp`, in the coefficients of the law.
fn of_adrc(config: &AdrcConfig, plant: &TransferFunction, ts: f64) -> Option<Predicted> {
    let AdrcCoefficients { g, l1, l2, l3, kp, kd } = Adrc::<f64>::new(config, ts).ok()?.coefficients();
    if plant.differentiators() > 0 {
        return None;
    }
    let c = (l2 / g + kp * (1.0 - l1) + kd * (l1 - 0.5 * l2)) / l3;
    let static_error = if plant.integrators() > 0 { 0.0 } else { c / plant.gain() };
    Some(Predicted {
        ie_setpoint: Some(ts * (static_error + kd) / kp),
        ie_load: Some(-ts * c / kp),
        iae_load: None,
    })
}

/// The loop of the law that will run on the sampled plant.
fn sampled(plant: &TransferFunction, law: &Law, request: &Request) -> Result<Sampled, Refusal> {
    const LONG: Refusal = Refusal::NoSolution {
        why: "the law cannot be built for this sampling period",
        help: "choose a shorter ts, so that every time constant is at least ts/1000 and tf at least ts/2",
    };
    let made = match law {
        Law::Pid { pid, estimator, observer } => {
            let estimator = estimator.as_ref().map(|estimator| estimator.to_compensator(request.latency));
            let observer = observer.as_ref().map(|observer| observer.to_compensator(request.latency));
            match estimator.or(observer) {
                Some(compensator) => DiscreteLaw::with_compensator(pid, &compensator, request.ts),
                None => DiscreteLaw::new(pid, request.ts),
            }
        }
        Law::Adrc(config) => DiscreteLaw::adrc(config, request.ts),
    };
    let made = made.map_err(|_| LONG)?;
    let made = DiscreteLoop::new(plant, made, request.latency)?;
    let (margins, noise) = made.margins_and_noise().map_err(|refusal| match refusal {
        TOO_MANY_TURNS => refusal,
        Refusal::NoSolution { .. } => Refusal::NoSolution {
            why: "the sampled loop is not stable, although the continuous one is",
            help: "choose a shorter ts",
        },
        other => other,
    })?;
    Ok(Sampled { margins, noise })
}

/// The delay margin in samples when it is so small that the sampling matters.
fn few_samples(margins: &Margins, ts: f64) -> Option<f64> {
    let samples = margins.delay_margin / ts;
    (samples < FEW_SAMPLES).then_some(samples)
}

/// That `Ms` is above 2, and the options of the method that lower it.
pub(super) fn fragile(method: Method) -> &'static str {
    let has = |option: &str| method.options().contains(&option);
    if has("kden") {
        "above 2, little robustness: ms_max, a longer tf or a smaller kpidn lowers it"
    } else if has("alpha") {
        "above 2, little robustness: ms_max, a longer alpha or a smaller ms lowers it"
    } else if has("tau_c") {
        "above 2, little robustness: a longer tau_c lowers it"
    } else if has("ms") {
        "above 2, little robustness: a smaller ms lowers it"
    } else if has("kpidn") {
        "above 2, little robustness: a longer tf or a smaller kpidn may lower it"
    } else {
        "above 2, little robustness: the rule has no option that lowers it"
    }
}

/// The margins of the continuous loop; `known`: those of the rule, which saw a latency as a part of the plant.
fn robustness(
    plant: &TransferFunction,
    law: &Law,
    latency: f64,
    known: Option<Margins>,
) -> Result<Margins, Refusal> {
    match known {
        Some(known) if latency == 0.0 => Ok(known),
        _ => continuous(plant, law, latency)?.margins(),
    }
}

/// What can be said of the continuous loop.
pub(super) fn finish_continuous(
    plant: &TransferFunction,
    request: &Request,
    law: Law,
    made: Made,
) -> Result<ContinuousDesign, Refusal> {
    let Made { mut noise, margins, warnings, .. } = made;
    let robustness = robustness(plant, &law, request.latency, margins)?;
    if let Law::Pid { pid, .. } = &law {
        noise.kpidn = Some(noise_limit::kpidn(pid, request.ts));
    }
    Ok(ContinuousDesign { method: request.method, law, robustness, noise, warnings })
}

/// What can be said of the loop as a whole.
pub(super) fn finish(
    plant: &TransferFunction,
    delayed: &TransferFunction,
    request: &Request,
    law: Law,
    made: Made,
) -> Result<Design, Refusal> {
    let Made { areas, model, mut noise, iae_load, margins, mut warnings } = made;
    let robustness = robustness(plant, &law, request.latency, margins)?;
    let sampled = sampled(plant, &law, request)?;
    let mut predicted = Predicted { iae_load, ..Predicted::default() };
    let mut filtered_areas = None;
    if let Law::Pid { pid, estimator, observer } = &law {
        noise.kpidn = Some(noise_limit::kpidn(pid, request.ts));
        filtered_areas = areas.map(|areas| areas.filtered(pid.tf));
        if pid.ki != 0.0 && delayed.differentiators() == 0 {
            let rest = estimator.as_ref().map_or(1.0, |estimator| 1.0 - estimator.kfd);
            predicted.ie_load = Some(if observer.is_some() { 0.0 } else { -rest / pid.ki });
            let inverse = if delayed.integrators() > 0 { 0.0 } else { 1.0 / delayed.gain() };
            // An estimator whose model has another gain sees a disturbance where there is none.
            let static_error =
                estimator.as_ref().map_or(inverse, |e| inverse + e.kfd * (1.0 / e.gain - inverse));
            predicted.ie_setpoint = Some((static_error + (1.0 - pid.b) * pid.kp) / pid.ki);
        }
    }
    if let Law::Adrc(config) = &law {
        predicted = of_adrc(config, delayed, request.ts).unwrap_or(predicted);
    }
    let ms = robustness.ms.max(sampled.margins.ms);
    let is_told = |warning: &Warning| matches!(warning, Warning::Value { about, .. } if about.eq_ignore_ascii_case("ms"));
    if ms > ROBUST
        && !warnings.iter().any(is_told)
        && request.ms.is_none_or(|asked| asked < ROBUST)
        && request.ms_max.is_none()
    {
        let text = fragile(request.method);
        warn(&mut warnings, Warning::Value { about: "Ms", value: ms, text });
    }
    if let Some(samples) = few_samples(&sampled.margins, request.ts) {
        let text = "fewer than 10, the sampling itself costs robustness: choose a shorter ts";
        warn(&mut warnings, Warning::Value { about: "delay margin in samples", value: samples, text });
    }
    Ok(Design {
        method: request.method,
        ts: request.ts,
        latency: request.latency,
        plant: plant.clone(),
        law,
        areas,
        filtered_areas,
        model,
        robustness,
        sampled,
        noise,
        predicted,
        warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::{Method, fragile};

    /// An option that is named is one of the method, so that the program takes it.
    #[test]
    fn the_advice_is_of_options_that_the_method_has() {
        let all: Vec<&str> = Method::ALL.iter().flat_map(|method| method.options()).copied().collect();
        for method in Method::ALL {
            let words = fragile(method).split([' ', ',', ':']);
            let named: Vec<&str> = words.filter(|word| all.contains(word)).collect();
            assert!(named.iter().all(|word| method.options().contains(word)), "{method:?}: {named:?}");
            assert_eq!(named.is_empty(), method.options().is_empty(), "{method:?}");
        }
    }
}
