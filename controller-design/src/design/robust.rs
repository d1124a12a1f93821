//! Keeping a loop with a disturbance estimator within a maximum sensitivity.

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
    let ms = |estimator: &EstimatorConfig| {
        let loop_ = ContinuousLoop::new(plant, pid).with_estimator(estimator);
        let sampled = DiscreteLaw::with_compensator(pid, &estimator.to_compensator(0.0), ts)
            .ok()
            .and_then(|law| DiscreteLoop::new(plant, law, 0.0).ok());
        match (loop_.and_then(|loop_| loop_.margins()), sampled.map(|sampled| sampled.margins())) {
            (Ok(one), Some(Ok(two))) => one.ms.max(two.ms),
            _ => f64::INFINITY,
        }
    };
    if ms(estimator) <= most {
        return Ok(());
    }
    let plain = ms(&EstimatorConfig { kfd: 0.0, ..*estimator });
    if plain > most {
        return Err(Refusal::Unattainable { what: "ms_max", asked: most, least: plain });
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
        if ms(&slower) <= most {
            *estimator = slower;
            let text = "raised to keep ms_max";
            warn(warnings, Warning::Value { about: "tfd", value: tfd, text });
            return Ok(());
        }
    }
    let (mut low, mut high) = (0.0, first.kfd);
    for _ in 0..HALVINGS {
        let kfd = 0.5 * (low + high);
        if ms(&EstimatorConfig { kfd, ..first }) <= most { low = kfd } else { high = kfd }
    }
    *estimator = EstimatorConfig { kfd: low, ..first };
    warn(warnings, Warning::Value { about: "kfd", value: low, text: "cut to keep ms_max" });
    Ok(())
}
