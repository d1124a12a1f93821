//! Plants, requests and records from any bytes, and what must hold of whatever comes out. Shared by a test and a fuzz target.
#![allow(dead_code, reason = "neither user needs all of it")]

mod draws;
mod plants;
mod records;

pub(crate) use draws::Draws;
pub(crate) use plants::{expression, request};
pub(crate) use records::{assess_any, identify_any};

use controller_core::{AnyCompensator, Controller, ControllerConfig, LimitConfig};
use controller_design::Refusal;
use controller_design::design::{Design, Law, Request, design};
use controller_design::margins::Margins;
use controller_design::model::TransferFunction;

/// Designs; whether there is a result. Either way it must be sound.
///
/// # Panics
/// When it is not.
pub(crate) fn design_any(plant: &TransferFunction, request: &Request) -> bool {
    match design(plant, request) {
        Ok(made) => {
            sound(&made);
            true
        }
        Err(refusal) => {
            printable(&refusal);
            false
        }
    }
}

/// A refusal says why and what would help.
pub(crate) fn printable(refusal: &Refusal) {
    assert!(refusal.to_string().len() > 10 && !refusal.to_string().contains('\n'), "{refusal:?}");
    assert!(refusal.help().len() > 10, "{refusal:?}");
}

fn sound(made: &Design) {
    for warning in &made.warnings {
        let text = warning.to_string();
        assert!(text.len() > 10 && !text.contains("NaN") && !text.contains('\n'), "{text}");
    }
    for margins in [&made.robustness, &made.sampled.margins] {
        bounds(margins);
    }
    let noise = &made.sampled.noise;
    let predicted = &made.predicted;
    let given = [made.noise.kpidn, made.noise.kden, made.noise.an];
    for value in
        given.into_iter().chain([predicted.ie_setpoint, predicted.ie_load, predicted.iae_load]).flatten()
    {
        assert!(!value.is_nan(), "{:?} {:?}", made.noise, made.predicted);
    }
    assert!(!format!("{noise:?}").contains("NaN"), "{noise:?}");
    assert!(finite(&made.law), "{:?}", made.law);
    runs(&made.law, made.ts, made.latency);
}

/// What holds of any stable loop.
fn bounds(m: &Margins) {
    assert!(m.ms >= 1.0 - 1e-6 && m.ms.is_finite() && m.mt >= 0.0 && m.mt.is_finite(), "{m:?}");
    assert!(m.gm >= 1.0 && (0.0..1.0).contains(&m.gm_low), "{m:?}");
    assert!(m.pm_deg >= 0.0 && m.delay_margin >= 0.0, "{m:?}");
}

fn finite(law: &Law) -> bool {
    match law {
        Law::Pid { pid, estimator, observer } => {
            let pid = [pid.kp, pid.ki, pid.kd, pid.tf, pid.b, pid.c];
            let estimator = estimator.map(|e| [e.gain, e.a1, e.a2, e.dead_time, e.kfd, e.tfd]);
            let observer = observer.as_ref().map(|o| [o.alpha, o.model.gain, o.model.dead_time]);
            let all = pid.into_iter().chain(estimator.into_iter().flatten());
            all.chain(observer.into_iter().flatten()).all(f64::is_finite)
        }
        Law::Adrc(c) => [c.b0, c.kp, c.kd, c.beta1, c.beta2, c.beta3].into_iter().all(f64::is_finite),
    }
}

/// The law can be built as it will run.
fn runs(law: &Law, ts: f64, latency: f64) {
    let limits = LimitConfig { lo: -1e6, hi: 1e6, ..LimitConfig::default() };
    let config = ControllerConfig { limits, ..ControllerConfig::default() };
    let built = match law {
        Law::Pid { pid, estimator, observer } => {
            let config = ControllerConfig { pid: *pid, ..config };
            let estimator = estimator.as_ref().map(|estimator| estimator.to_compensator(latency));
            let observer = observer.as_ref().map(|observer| observer.to_compensator(latency));
            match estimator.or(observer) {
                None => Controller::<f64>::new(&config, ts).map(drop),
                Some(compensator) => {
                    let capacity = AnyCompensator::<f64, Vec<f64>>::needed_capacity(&compensator, ts);
                    AnyCompensator::<f64, Vec<f64>>::new(&compensator, ts, capacity)
                        .and_then(|made| Controller::with_compensator(&config, made, ts))
                        .map(drop)
                }
            }
        }
        Law::Adrc(adrc) => Controller::<f64, _, _>::with_adrc(&config, adrc, ts).map(drop),
    };
    assert!(built.is_ok(), "{built:?}: {law:?}, ts {ts}");
}
