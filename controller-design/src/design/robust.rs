//! Keeping a loop with a disturbance estimator within a maximum sensitivity.

use core::cell::Cell;

use crate::margins::{ContinuousLoop, DiscreteLaw, DiscreteLoop};
use crate::model::TransferFunction;
use crate::rules::de_momi;
use crate::rules::reduction::Reduced;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};
use controller_core::{EstimatorConfig, PidConfig};

/// Steps of `tfd` that are tried, each 5 % up: to some 18 times the first.
const STEPS: usize = 60;
const STEP: f64 = 1.05;
/// Halvings of the range of `kfd`.
const HALVINGS: usize = 40;
/// Frequencies of the first loops from which a hundred of them would take many seconds.
const MOST_POINTS: usize = 200_000;
/// The estimator stays worth its place down to this share of its gain.
const LEAST_SHARE: f64 = 0.3;

/// Changes `estimator` until the loop's maximum sensitivity is at most `most`: first `tfd` is raised, `kfd` following by
/// eqs (18), (19) of Vrančić & Huba 2021, as long as that keeps at least 30 % of the first gain; then `kfd` is cut. The
/// larger of the continuous and the sampled loop's counts.
///
/// # Errors
/// The loop is above `most` without any estimator, or not stable.
pub(super) fn within(
    plant: &TransferFunction,
    pid: &PidConfig,
    estimator: &mut EstimatorConfig,
    model: &Reduced,
    (most, ts): (f64, f64),
    warnings: &mut Warnings,
) -> Result<(), Refusal> {
    if !(most > 1.0 && most <= 100.0) {
        return Err(Refusal::OutOfRange { parameter: "ms_max", value: most, min: 1.0, max: 100.0 });
    }
    let points = Cell::new(0);
    // The larger of the two, or the first one above `enough`.
    let ms = |estimator: &EstimatorConfig, enough: f64| {
        let loop_ = ContinuousLoop::new(plant, pid).with_estimator(estimator);
        let Ok((one, many)) = loop_.and_then(|loop_| loop_.ms()) else { return f64::INFINITY };
        points.set(points.get() + many);
        if one > enough {
            return one;
        }
        let law = DiscreteLaw::with_compensator(pid, &estimator.to_compensator(0.0), ts).ok();
        let sampled = law.and_then(|law| DiscreteLoop::new(plant, law, 0.0).ok());
        let Some(Ok((two, many))) = sampled.map(|sampled| sampled.ms()) else { return f64::INFINITY };
        points.set(points.get() + many);
        one.max(two)
    };
    let keeps = |estimator: &EstimatorConfig| ms(estimator, most) <= most;
    if keeps(estimator) {
        return Ok(());
    }
    let plain = ms(&EstimatorConfig { kfd: 0.0, ..*estimator }, f64::INFINITY);
    if !plain.is_finite() {
        return Err(Refusal::NoSolution {
            why: "the loop cannot be built or is not stable at this sampling period, with or without the estimator",
            help: "choose a shorter ts, or a lower noise gain",
        });
    }
    if plain > most {
        return Err(Refusal::Unattainable { what: "ms_max", asked: most, least: plain });
    }
    if points.get() > MOST_POINTS {
        return Err(Refusal::NoSolution {
            why: "the dead time is too long against ts and the lags to search for a filter that keeps ms_max",
            help: "choose a longer ts, or give tfd",
        });
    }
    let first = *estimator;
    let mut tfd = first.tfd;
    for _ in 0..STEPS {
        tfd *= STEP;
        let kfd = de_momi::kfd(pid, model, tfd);
        if kfd < LEAST_SHARE * first.kfd {
            break;
        }
        let slower = EstimatorConfig { tfd, kfd, ..first };
        if keeps(&slower) {
            *estimator = slower;
            let text = "raised to keep ms_max";
            warn(warnings, Warning::Value { about: "tfd", value: tfd, text });
            return Ok(());
        }
    }
    let (mut low, mut high) = (0.0, first.kfd);
    for _ in 0..HALVINGS {
        let kfd = 0.5 * (low + high);
        if keeps(&EstimatorConfig { kfd, ..first }) { low = kfd } else { high = kfd }
    }
    *estimator = EstimatorConfig { kfd: low, ..first };
    warn(warnings, Warning::Value { about: "kfd", value: low, text: "cut to keep ms_max" });
    Ok(())
}
