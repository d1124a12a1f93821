//! What was run: the loop around the controllers, and the parameters of each.

use super::words;
use crate::output::precision_name;
use crate::output::table::{plant_text, rounded_numbers};
use crate::plant::Nonlinear;
use crate::scenario::{Actuator, CompensatorSpec, ControllerSpec, Scenario, Sensor, Stiction, show_short};
use crate::simulate::Precision;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AdrcConfig, AlarmConfig, AntiWindupConfig, ControllerConfig, EstimatorConfig, FallbackAction,
    FallbackReturn, IntegralRule, Mode, ObserverConfig, PidConfig,
};

/// A line of a table: name, unit, one value per column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) values: Vec<String>,
}

/// Limits of this size are those nobody has set.
const UNSET: f64 = 1e6;

/// The loop that all controllers share: name and value.
pub(super) fn shared(scenario: &Scenario, precision: Precision) -> Vec<(&'static str, String)> {
    let [y, u] = [&scenario.units.y, &scenario.units.u].map(|unit| words::unit(unit));
    let with = |x: f64, unit: &str| format!("{} {unit}", show_short(x)).trim_end().to_owned();
    let mut list = vec![("Plant", rounded_numbers(&plant_text(scenario)))];
    if let Some(plant) = &scenario.nonlinear {
        list.push(("Parameters of the plant", joined(&nonlinear(plant))));
    }
    if let Some(inner) = &scenario.inner_plant {
        list.push(("Inner part of the plant", rounded_numbers(&inner.to_string())));
    }
    list.push(("Sampling period", with(scenario.ts, "s")));
    list.push(("Length of the run", with(scenario.duration, "s")));
    list.push(("Latency", with(scenario.latency, "s")));
    list.push(("Steps between samples", scenario.substeps.to_string()));
    list.push(("Number type", precision_name(precision).to_owned()));
    if scenario.initial.setpoint != 0.0 {
        list.push(("At rest before t = 0 at", with(scenario.initial.setpoint, &y)));
    }
    if scenario.initial.disturbance != 0.0 {
        list.push(("Disturbance before t = 0", with(scenario.initial.disturbance, &u)));
    }
    if let Some(noise) = scenario.noise {
        let std = with(noise.std, &y);
        list.push(("Measurement noise", format!("standard deviation {std}, seed {}", noise.seed)));
    }
    if scenario.sensor != Sensor::default() {
        list.push(("Sensor", sensor(&scenario.sensor, &y)));
    }
    if scenario.actuator != Actuator::default() {
        list.push(("Actuator", actuator(&scenario.actuator, &u)));
    }
    list
}

/// Names with values, units of the format.
fn nonlinear(plant: &Nonlinear) -> Vec<String> {
    let parameters = plant.parameters().into_iter();
    parameters.map(|(name, value, unit)| format!("{name} {} {unit}", show_short(value))).collect()
}

fn sensor(sensor: &Sensor, unit: &str) -> String {
    let mut parts = range(sensor.lo, sensor.hi, unit);
    if sensor.resolution > 0.0 {
        parts.push(format!("resolution {} {unit}", show_short(sensor.resolution)));
    }
    joined(&parts)
}

fn actuator(actuator: &Actuator, unit: &str) -> String {
    let mut parts = range(actuator.lo, actuator.hi, unit);
    if actuator.rate.is_finite() {
        parts.push(format!(
            "at most {} {} per s",
            show_short(actuator.rate),
            if unit.is_empty() { "u" } else { unit }
        ));
    }
    for (name, value) in [("resolution", actuator.resolution), ("dead band", actuator.deadband)] {
        if value > 0.0 {
            parts.push(format!("{name} {} {unit}", show_short(value)));
        }
    }
    if let Some(Stiction { band, jump }) = actuator.stiction {
        parts.push(format!("stiction: band {}, jump {} {unit}", show_short(band), show_short(jump)));
    }
    parts.push(if actuator.read_back { "read back" } else { "not read back" }.to_owned());
    joined(&parts)
}

fn joined(parts: &[String]) -> String {
    parts.iter().map(|part| part.trim_end()).collect::<Vec<_>>().join(", ")
}

fn range(lo: f64, hi: f64, unit: &str) -> Vec<String> {
    let text = match (lo.is_finite(), hi.is_finite()) {
        (true, true) => format!("{} to {} {unit}", show_short(lo), show_short(hi)),
        (true, false) => format!("from {} {unit}", show_short(lo)),
        (false, true) => format!("up to {} {unit}", show_short(hi)),
        (false, false) => return Vec::new(),
    };
    vec![text]
}

/// The parameters of controllers, a column for each: the tuning always, the rest where any of them has it.
pub(super) fn lines(specs: &[&ControllerSpec], scenario: &Scenario) -> Vec<Line> {
    let units = &scenario.units;
    let name =
        |unit: &str, symbol: &str| if unit.trim().is_empty() { symbol.to_owned() } else { words::unit(unit) };
    let (y, u) = (name(&units.y, "y"), name(&units.u, "u"));
    let mut list = Vec::new();
    let mut add =
        |name: &str, unit: String, always: bool, value: &dyn Fn(&ControllerSpec) -> Option<String>| {
            let values: Vec<Option<String>> = specs.iter().map(|spec| value(spec)).collect();
            if always || values.iter().any(Option::is_some) {
                let values =
                    values.into_iter().map(|value| value.unwrap_or_else(|| "\u{2013}".to_owned())).collect();
                list.push(Line { name: name.to_owned(), unit, values });
            }
        };
    let none = String::new;
    let pid = |c: &ControllerSpec, value: &dyn Fn(&PidConfig) -> String| {
        c.adrc.is_none().then(|| value(&c.config.pid))
    };
    add("kp", format!("{u}/{y}"), false, &|c| pid(c, &|p| show_short(p.kp)));
    add("ki", format!("{u}/({y} s)"), false, &|c| pid(c, &|p| show_short(p.ki)));
    add("kd", format!("{u} s/{y}"), false, &|c| pid(c, &|p| show_short(p.kd)));
    add("tf", "s".to_owned(), false, &|c| pid(c, &|p| show_short(p.tf)));
    add("b", none(), false, &|c| pid(c, &|p| show_short(p.b)));
    add("c", none(), false, &|c| pid(c, &|p| show_short(p.c)));
    add("action", none(), false, &|c| (c.config.pid.action == Action::Direct).then(|| "direct".to_owned()));
    add("integral rule", none(), false, &|c| {
        (c.config.pid.integral_rule == IntegralRule::Trapezoid).then(|| "trapezoid".to_owned())
    });
    let adrc =
        |c: &ControllerSpec, value: fn(&AdrcConfig) -> f64| c.adrc.as_ref().map(|a| show_short(value(a)));
    let per_second = |power: &str| format!("1/s{power}");
    add("ADRC: b0", format!("{y}/({u} s\u{b2})"), false, &|c| adrc(c, |a| a.b0));
    add("ADRC: kp", per_second("\u{b2}"), false, &|c| adrc(c, |a| a.kp));
    add("ADRC: kd", per_second(""), false, &|c| adrc(c, |a| a.kd));
    add("ADRC: beta1", per_second(""), false, &|c| adrc(c, |a| a.beta1));
    add("ADRC: beta2", per_second("\u{b2}"), false, &|c| adrc(c, |a| a.beta2));
    add("ADRC: beta3", per_second("\u{b3}"), false, &|c| adrc(c, |a| a.beta3));
    let set = |x: f64, unset: f64| (x != unset).then(|| show_short(x));
    add("output from", u.clone(), false, &|c| set(c.config.limits.lo, -UNSET));
    add("output to", u.clone(), false, &|c| set(c.config.limits.hi, UNSET));
    add("output rises by at most", format!("{u}/s"), false, &|c| c.config.limits.rate_up.map(show_short));
    add("output falls by at most", format!("{u}/s"), false, &|c| c.config.limits.rate_down.map(show_short));
    add("anti-windup", none(), false, &|c| c.adrc.is_none().then(|| anti_windup(&c.config).to_owned()));
    add("tt", "s".to_owned(), false, &|c| match c.config.anti_windup {
        _ if c.adrc.is_some() => None,
        AntiWindupConfig::BackCalculation { tt: Some(tt) } => Some(show_short(tt)),
        AntiWindupConfig::BackCalculation { tt: None } => {
            Some(show_short(c.config.pid.default_tt(scenario.ts)))
        }
        _ => None,
    });
    add("set-point from", y.clone(), false, &|c| set(c.config.setpoint.lo, -UNSET));
    add("set-point to", y.clone(), false, &|c| set(c.config.setpoint.hi, UNSET));
    add("set-point rises by at most", format!("{y}/s"), false, &|c| {
        c.config.setpoint.rate_up.map(show_short)
    });
    add("set-point falls by at most", format!("{y}/s"), false, &|c| {
        c.config.setpoint.rate_down.map(show_short)
    });
    add("set-point follows y", none(), false, &|c| c.config.setpoint.track.then(|| "yes".to_owned()));
    add("error deadband", y.clone(), false, &|c| set(c.config.deadband, 0.0));
    let estimator = |c: &ControllerSpec, value: fn(&EstimatorConfig) -> f64| match &c.compensator {
        CompensatorSpec::Estimator(e) => Some(show_short(value(e))),
        _ => None,
    };
    add("estimator: gain", format!("{y}/{u}"), false, &|c| estimator(c, |e| e.gain));
    add("estimator: a1", "s".to_owned(), false, &|c| estimator(c, |e| e.a1));
    add("estimator: a2", "s\u{b2}".to_owned(), false, &|c| estimator(c, |e| e.a2));
    add("estimator: dead time", "s".to_owned(), false, &|c| estimator(c, |e| e.dead_time));
    add("estimator: kfd", none(), false, &|c| estimator(c, |e| e.kfd));
    add("estimator: tfd", "s".to_owned(), false, &|c| estimator(c, |e| e.tfd));
    let observer = |c: &ControllerSpec, value: fn(&ObserverConfig) -> Option<String>| match &c.compensator {
        CompensatorSpec::Observer(o) => value(o),
        _ => None,
    };
    add("observer: model", format!("{y}/{u}"), false, &|c| observer(c, |o| Some(model(&o.model))));
    add("observer: alpha", "s".to_owned(), false, &|c| observer(c, |o| Some(show_short(o.alpha))));
    add("observer: order", none(), false, &|c| observer(c, |o| o.order.map(|order| order.to_string())));
    add("measurement valid", y.clone(), false, &|c| {
        let (lo, hi) = (c.config.measurement_lo, c.config.measurement_hi);
        ((lo, hi) != (-UNSET, UNSET)).then(|| format!("{} to {}", show_short(lo), show_short(hi)))
    });
    add("offset", u.clone(), false, &|c| {
        let (lo, hi) = (c.config.offset_lo, c.config.offset_hi);
        ((lo, hi) != (-UNSET, UNSET)).then(|| format!("{} to {}", show_short(lo), show_short(hi)))
    });
    add("fallback", u.clone(), false, &|c| {
        (c.config.fallback != ControllerConfig::default().fallback).then(|| fallback(&c.config))
    });
    add("alarms", y, false, &|c| alarms(&c.config.alarms));
    add("output in mode Off", u, false, &|c| c.config.off_output.map(show_short));
    add("mode at the start", none(), false, &|c| {
        (c.mode != Mode::Auto).then(|| words::mode(c.mode).to_owned())
    });
    list
}

fn anti_windup(config: &ControllerConfig) -> &'static str {
    match config.anti_windup {
        AntiWindupConfig::BackCalculation { .. } => "back-calculation",
        AntiWindupConfig::Conditional => "conditional",
        AntiWindupConfig::None => "none",
    }
}

fn fallback(config: &ControllerConfig) -> String {
    let fallback = &config.fallback;
    let action = match fallback.action {
        FallbackAction::Hold => "hold".to_owned(),
        FallbackAction::Substitute { output } => format!("go to {}", show_short(output)),
        FallbackAction::Ramp { output, rate } => {
            format!("go to {} by {} per s", show_short(output), show_short(rate))
        }
    };
    let back = match fallback.back {
        FallbackReturn::Automatic => "return by itself",
        FallbackReturn::Acknowledged => "return when acknowledged",
    };
    format!("after {} bad samples {action}, {back}", fallback.hold_samples)
}

fn alarms(alarms: &AlarmConfig) -> Option<String> {
    let levels = [
        ("HH", alarms.hi_hi),
        ("H", alarms.hi),
        ("L", alarms.lo),
        ("LL", alarms.lo_lo),
        ("deviation", alarms.deviation),
    ];
    let mut parts: Vec<String> = levels
        .iter()
        .filter_map(|(name, level)| level.map(|level| format!("{name} {}", show_short(level))))
        .collect();
    if parts.is_empty() {
        return None;
    }
    if alarms.hysteresis > 0.0 {
        parts.push(format!("hysteresis {}", show_short(alarms.hysteresis)));
    }
    Some(parts.join(", "))
}

/// A model as it is written in a scenario.
fn model(model: &PlantModel) -> String {
    let factor = |f: &Factor| {
        let terms = [(f.a1, "s"), (f.a2, "s^2")].into_iter().filter(|(a, _)| *a != 0.0);
        terms.fold("1".to_owned(), |text, (a, s)| {
            let sign = if a < 0.0 { '-' } else { '+' };
            let size = if a.abs() == 1.0 { String::new() } else { format!("{}*", show_short(a.abs())) };
            format!("{text}{sign}{size}{s}")
        })
    };
    let factors = |list: &[Factor]| list.iter().map(|f| format!("({})", factor(f))).collect::<Vec<_>>();
    let mut top = vec![show_short(model.gain)];
    if model.dead_time > 0.0 {
        top.push(format!("exp(-{}*s)", show_short(model.dead_time)));
    }
    top.extend(factors(&model.zeros));
    let mut bottom = vec!["s".to_owned(); model.integrators];
    bottom.extend(factors(&model.poles));
    let top = top.join("*");
    match &*bottom {
        [] => top,
        [only] => format!("{top}/{only}"),
        several => format!("{top}/({})", several.join("*")),
    }
}
