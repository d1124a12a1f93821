//! What gives a design where a rule has none: tried, not guessed.

use super::calmer::Judged;
use super::{Design, Filter, Method, ObserverFilter, Request, design};
use crate::Refusal;
use crate::model::TransferFunction;

/// A request that gives a robust loop, `Ms` at most 2, on a plant for which another one was refused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remedy {
    /// The request.
    pub request: Request,
    /// The option that makes the difference, by its name in files, and its value; `None`: the defaults will do.
    ///
    /// Of `want` the value is that of the index in [`Request::observer_filter`].
    pub option: Option<(&'static str, f64)>,
}

/// Most remedies that are named.
const ENOUGH: usize = 3;
/// Other rules, those first that take most plants; last those whose loops are seldom robust.
const OTHERS: [Method; 9] = [
    Method::PiMs,
    Method::Momi,
    Method::Simc,
    Method::DeMomi,
    Method::Dob,
    Method::Amigo,
    Method::Drmo,
    Method::Adrc,
    Method::PiIae,
];
/// Wishes for an index in units of the least attainable: the last bit costs the robustness.
const ABOVE_LEAST: [f64; 6] = [1.02, 1.1, 1.25, 1.5, 2.0, 4.0];
/// Closed-loop time constants for `simc` in units of the plant's own time.
const CLOSED_LOOP: [f64; 4] = [0.25, 1.0, 4.0, 16.0];
/// The least of them in samples.
const SAMPLES: f64 = 20.0;

/// What works on `plant` in place of `refused`, at most three: other options of the same method first, then other methods
/// with their defaults. Every one was designed and is robust. Empty where nothing was found. Cost: that of some ten designs.
///
/// ```
/// use controller_design::design::{Method, Request, design, remedies};
/// use controller_design::model::parse;
/// // A single lag has no magnitude optimum; SIMC with a chosen speed takes it.
/// let plant = parse("1/(1+s)").expect("a valid plant");
/// let refused = Request::new(Method::Momi, 0.01);
/// assert!(design(&plant, &refused).is_err());
/// let found = remedies(&plant, &refused);
/// assert_eq!((found[0].request.method, found[0].option), (Method::Simc, Some(("tau_c", 0.25))));
/// ```
#[must_use]
pub fn remedies(plant: &TransferFunction, refused: &Request) -> Vec<Remedy> {
    let own = Request { latency: refused.latency, ..Request::new(refused.method, refused.ts) };
    let works = |remedy: &Remedy| design(plant, &remedy.request).is_ok_and(|made| made.is_robust());
    let mut found = Vec::new();
    // One option of the same method is enough.
    found.extend(options(plant, refused, own).into_iter().find(works));
    for method in OTHERS {
        if method != refused.method && found.len() < ENOUGH {
            let request = Request { method, ..own };
            let plain = [Remedy { request, option: None }];
            found.extend(plain.into_iter().chain(speeds(plant, request)).find(works));
        }
    }
    found
}

/// Options that may help the method itself.
fn options(plant: &TransferFunction, refused: &Request, own: Request) -> Vec<Remedy> {
    let mut list = Vec::new();
    if let Filter::NoiseGain(asked) = refused.filter
        && let Ok(Design { noise, .. }) = design(plant, &own)
        && let Some(kpidn) = noise.kpidn.map(|kpidn| short(if kpidn < asked { kpidn } else { 1.02 * kpidn }))
    {
        list.push(Remedy {
            request: Request { filter: Filter::NoiseGain(kpidn), ..own },
            option: Some(("kpidn", kpidn)),
        });
    }
    if let ObserverFilter::Wanted(wish) = refused.observer_filter
        && let Err(Refusal::Unattainable { least, .. }) =
            design(plant, &Request { observer_filter: refused.observer_filter, ..own })
    {
        list.extend(ABOVE_LEAST.map(|times| {
            let value = format!("{:.2e}", times * least).parse().unwrap_or(times * least);
            let observer_filter = ObserverFilter::Wanted(wish.with(value));
            Remedy { request: Request { observer_filter, ..own }, option: Some(("want", value)) }
        }));
    }
    let ms = match refused.method {
        Method::Ah => Some(1.4),
        Method::Adrc => Some(2.0),
        _ => None,
    };
    if let Some(ms) = ms.filter(|ms| refused.ms != Some(*ms)) {
        list.push(Remedy { request: Request { ms: Some(ms), ..own }, option: Some(("ms", ms)) });
    }
    list.extend(speeds(plant, own));
    list.extend([5.0, 25.0].map(|times| {
        let ts = short(refused.ts / times);
        Remedy { request: Request { ts, ..own }, option: Some(("ts", ts)) }
    }));
    list
}

/// SIMC with a time constant of the closed loop that suits the plant.
fn speeds(plant: &TransferFunction, own: Request) -> Vec<Remedy> {
    if own.method != Method::Simc {
        return Vec::new();
    }
    let lags = plant.poles().into_iter().map(|pole| 1.0 / pole.abs()).filter(|lag| lag.is_finite());
    let whole = plant.dead_time() + lags.sum::<f64>();
    let speed = |share: f64| {
        let tau_c = short((share * whole).max(SAMPLES * own.ts));
        Remedy { request: Request { tau_c: Some(tau_c), ..own }, option: Some(("tau_c", tau_c)) }
    };
    CLOSED_LOOP.into_iter().map(speed).collect()
}

/// A number with two digits.
fn short(x: f64) -> f64 {
    if !(x > 0.0 && x.is_finite()) {
        return x;
    }
    let decade = libm::floor(libm::log10(x)) - 1.0;
    // Through text, so that it prints as it is: 0.26, not 0.26000000000000001.
    format!("{}e{decade}", libm::floor(x / libm::pow(10.0, decade))).parse().unwrap_or(x)
}
