//! Plants that are not linear: `two_tank` and `heater` in `[plant]`.

use super::fault::{Fault, code};
use super::number::Allowed;
use super::table::{Located, Table};
use crate::plant::{Heater, Nonlinear, TankLoad, TwoTank};

/// The keys of `[plant]` that are such plants.
pub(super) const FORMS: [&str; 2] = ["two_tank", "heater"];

const TWO_TANK: &str = "`two_tank = {}` for the rig of the paper, or its parameters in the braces";
const HEATER: &str = "`heater = { gain = 0.6, tau_heat = 60.0, tau_cool = 150.0 }`";

const SIZE: Allowed = Allowed::new(1e-6, 1e9, "");
const SIZE_OR_NONE: Allowed = Allowed::new(0.0, 1e9, "");
const PERCENT: Allowed = Allowed::new(0.0, 100.0, "%");
const GAIN: Allowed = Allowed::new(1e-15, 1e15, "");
const GAIN_OR_NONE: Allowed = Allowed::new(0.0, 1e15, "");
const LAG: Allowed = Allowed::new(1e-9, 1e12, "s");
const LAG_OR_NONE: Allowed = Allowed::new(0.0, 1e12, "s");

/// The plant that is the value of `key`, one of [`FORMS`].
pub(super) fn read(table: &Table<'_>, key: &'static str) -> Option<Located<Nonlinear>> {
    let part = table.table(key, if key == "heater" { HEATER } else { TWO_TANK })?;
    let (before, span) = (table.log.count(), part.place.clone());
    let value = if key == "heater" { heater(&part).map(Nonlinear::Heater) } else { Some(two_tank(&part)) };
    part.finish();
    value.filter(|_| table.log.count() == before).map(|value| Located { value, span })
}

fn two_tank(part: &Table<'_>) -> Nonlinear {
    let mut tank = TwoTank::default();
    let take = |key: &'static str, allowed: Allowed, target: &mut f64| {
        if let Some(number) = part.number_in(key, allowed) {
            *target = number.value;
        }
    };
    take("area", SIZE, &mut tank.area);
    take("height", SIZE, &mut tank.height);
    take("drop", SIZE_OR_NONE, &mut tank.drop);
    take("drain", SIZE, &mut tank.drain);
    take("valve", PERCENT, &mut tank.valve);
    take("supply", SIZE, &mut tank.supply);
    take("pump", SIZE, &mut tank.pump);
    take("pump_start", SIZE_OR_NONE, &mut tank.pump_start);
    take("feed_area", SIZE, &mut tank.feed_area);
    take("feed_level", SIZE, &mut tank.feed_level);
    take("dead_time", LAG_OR_NONE, &mut tank.dead_time);
    let loads = [("valve", TankLoad::Valve), ("input", TankLoad::Input)];
    if let Some(load) = part.choice("disturbance", &loads) {
        tank.load = load.value;
    }
    if let (true, Some(span)) =
        (tank.pump_start >= tank.supply, part.span("pump_start").or(part.span("supply")))
    {
        let message = format!(
            "`{}`, {} V, must be below `{}`, {} V: the pump would never lift water",
            part.name("pump_start"),
            tank.pump_start,
            part.name("supply"),
            tank.supply
        );
        part.log.fault(Fault::new(code::CONFLICT, span, message));
    }
    Nonlinear::TwoTank(tank)
}

fn heater(part: &Table<'_>) -> Option<Heater> {
    let required = |key: &'static str, allowed: Allowed, example: &str| {
        if part.span(key).is_none() {
            part.missing(key, example);
        }
        part.number_in(key, allowed).map(|number| number.value)
    };
    let gain = required("gain", GAIN, "the gain while heating: `gain = 0.6`");
    let tau_heat = required("tau_heat", LAG, "the time constant while heating in seconds: `tau_heat = 60.0`");
    let tau_cool =
        required("tau_cool", LAG, "the time constant while cooling in seconds: `tau_cool = 150.0`");
    let optional = |key: &'static str, allowed: Allowed, default: Option<f64>| match part.span(key) {
        Some(_) => part.number_in(key, allowed).map(|number| number.value),
        None => default,
    };
    let gain_cool = optional("gain_cool", GAIN_OR_NONE, gain);
    let ambient = optional("ambient", Allowed::SIGNAL, Some(0.0));
    let sensor_lag = optional("sensor_lag", LAG_OR_NONE, Some(0.0));
    let dead_time = optional("dead_time", LAG_OR_NONE, Some(0.0));
    Some(Heater {
        gain: gain?,
        gain_cool: gain_cool?,
        tau_heat: tau_heat?,
        tau_cool: tau_cool?,
        ambient: ambient?,
        sensor_lag: sensor_lag?,
        dead_time: dead_time?,
    })
}
