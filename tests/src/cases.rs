//! The papers' processes and parameters, written as the product's configurations.

use crate::oracle::de_cases::DeCase;
use crate::oracle::state_space::PlantFactors;
use crate::oracle::structure_a::{Estimator, PidGains};
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{EstimatorConfig, IntegralRule, LimitConfig, ObserverConfig, PidConfig};
use controller_design::model::{TransferFunction, parse};
use controller_sim_host::scenario::{
    Actuator, Change, ControllerSpec, Event, Initial, Scenario, Sensor, Signal, Units,
};

/// The process as a model for a disturbance block.
#[must_use]
pub fn model(plant: &PlantFactors<'_>) -> PlantModel {
    let mut model = PlantModel {
        gain: plant.gain,
        integrators: plant.integrators,
        dead_time: plant.dead_time,
        ..PlantModel::default()
    };
    for &tau in plant.lags {
        model = model.with_pole(Factor::first(tau));
    }
    for &(a1, a2) in plant.pairs {
        model = model.with_pole(Factor::second(a1, a2));
    }
    for &(z1, z2) in plant.zeros {
        model = model.with_zero(Factor::second(z1, z2));
    }
    model
}

/// The process as a plant to simulate, by way of its expression.
///
/// # Panics
/// When the expression is not one, which the tests of the expressions would show first.
#[must_use]
pub fn transfer_function(plant: &PlantFactors<'_>) -> TransferFunction {
    let mut text = format!("{}", plant.gain);
    for (z1, z2) in plant.zeros {
        text += &format!("*(1+({z1:e})*s+({z2:e})*s^2)");
    }
    text += &format!("*exp(-{:e}*s)", plant.dead_time);
    for _ in 0..plant.integrators {
        text += "/s";
    }
    for tau in plant.lags {
        text += &format!("/(1+({tau:e})*s)");
    }
    for (a1, a2) in plant.pairs {
        text += &format!("/(1+({a1:e})*s+({a2:e})*s^2)");
    }
    parse(&text).unwrap_or_else(|faults| panic!("{text}: {faults:?}"))
}

/// The chapter's PID, both integrations by Tustin's rule.
#[must_use]
pub fn pid(gains: &PidGains) -> PidConfig {
    let PidGains { kp, ki, kd, tf, b, c } = *gains;
    PidConfig { kp, ki, kd, tf, b, c, integral_rule: IntegralRule::Trapezoid, ..PidConfig::default() }
}

/// The chapter's estimator.
#[must_use]
pub fn estimator(estimator: &Estimator) -> EstimatorConfig {
    let Estimator { gain, a1, a2, dead_time, kfd, tfd } = *estimator;
    EstimatorConfig { gain, a1, a2, dead_time, kfd, tfd }
}

/// A PI with or without an observer for the same plant.
#[must_use]
pub fn pi_with_observer(plant: &PlantFactors<'_>, kp: f64, ki: f64, alpha: Option<f64>) -> ControllerSpec {
    let spec = ControllerSpec::pid("PI", PidConfig { kp, ki, ..PidConfig::default() });
    match alpha {
        Some(alpha) => spec.with_observer(ObserverConfig { model: model(plant), alpha, order: None }),
        None => spec,
    }
}

/// MOMI, DRMO and DE-MOMI of one process of the chapter.
#[must_use]
pub fn chapter_controllers(case: &DeCase) -> Vec<ControllerSpec> {
    vec![
        ControllerSpec::pid("MOMI", pid(&case.momi)),
        ControllerSpec::pid("DRMO", pid(&case.drmo)),
        ControllerSpec::pid("DE-MOMI", pid(&case.momi)).with_estimator(estimator(&case.estimator)),
    ]
}

/// A scenario from rest with one event at `t = 0`.
#[must_use]
pub fn from_rest(
    plant: &PlantFactors<'_>,
    ts: f64,
    duration: f64,
    change: Change,
    controllers: Vec<ControllerSpec>,
) -> Scenario {
    Scenario {
        title: String::new(),
        description: String::new(),
        units: Units::default(),
        ts,
        duration,
        latency: 0.0,
        substeps: 20,
        plant: transfer_function(plant),
        nonlinear: None,
        inner_plant: None,
        initial: Initial::default(),
        events: vec![Event { at: 0.0, label: String::new(), changes: vec![change], controller: None }],
        controllers,
        noise: None,
        sensor: Sensor::default(),
        actuator: Actuator::default(),
    }
}

/// A unit step of the set-point.
pub const SETPOINT_STEP: Change = Change::Setpoint(Signal::Step(1.0));
/// A unit step of the disturbance at the plant input.
pub const DISTURBANCE_STEP: Change = Change::Disturbance(Signal::Step(1.0));

/// The same controller with an output range.
#[must_use]
pub fn limited(mut spec: ControllerSpec, lo: f64, hi: f64) -> ControllerSpec {
    spec.config.limits = LimitConfig::range(lo, hi);
    spec
}
