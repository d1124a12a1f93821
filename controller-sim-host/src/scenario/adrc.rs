//! The key `adrc` of a controller.

use super::ControllerSpec;
use super::fault::{Fault, code};
use super::number::Allowed;
use super::places::Places;
use super::sections::take;
use super::table::Table;
use controller_core::{AdrcConfig, Param};
use std::ops::Range;

const ADRC: &str = "`adrc = { b0 = 5.0, omega_c = 10.0, omega_o = 40.0 }`";
const FEEDBACK: [(&str, Param); 2] = [("kp", Param::AdrcKp), ("kd", Param::AdrcKd)];
const OBSERVER: [(&str, Param); 3] =
    [("beta1", Param::Beta1), ("beta2", Param::Beta2), ("beta3", Param::Beta3)];

/// Keys that a controller with an ADRC does not have, and why.
const OTHERS: [(&str, &str); 6] = [
    ("pid", "an ADRC takes the place of a PID; write two controllers to compare them"),
    ("design", "an ADRC takes the place of a PID; write two controllers to compare them"),
    ("estimator", "the observer of an ADRC estimates the disturbance itself"),
    ("observer", "the observer of an ADRC estimates the disturbance itself"),
    ("anti_windup", "the observer of an ADRC is told what was applied: nothing winds up"),
    ("deadband", "an observer would take the band for the plant"),
];

/// Where the key is, without asking for it: it then comes after `pid` in the list of known keys.
pub(super) fn place(table: &Table<'_>) -> Option<Range<usize>> {
    table.written().into_iter().find(|(key, ..)| *key == "adrc").map(|(_, span, _)| span)
}

/// Reads the ADRC of a controller; `at` is the place of its key.
pub(super) fn read(table: &Table<'_>, at: &Range<usize>, places: &mut Places) -> Option<AdrcConfig> {
    for (key, why) in OTHERS {
        if let Some(span) = table.key_span(key) {
            let fault = Fault::new(code::CONFLICT, span, format!("a controller with `adrc` has no `{key}`"));
            table.log.fault(fault.help(why).related(at.clone(), "the ADRC"));
        }
    }
    let part = table.table("adrc", ADRC)?;
    if part.span("b0").is_none() {
        part.missing("b0", "the gain of the model y'' = b0*(u + d), `b0 = 5.0`");
        places.silence(&[Param::B0]);
    }
    let feedback = "the bandwidth of the feedback, `omega_c = 10.0`, or both `kp` and `kd`";
    require(&part, "omega_c", &FEEDBACK, feedback, places);
    let observer = "the bandwidth of the observer, `omega_o = 40.0`, or all of `beta1`, `beta2`, `beta3`";
    require(&part, "omega_o", &OBSERVER, observer, places);
    let mut config = AdrcConfig { b0: 0.0, kp: 0.0, kd: 0.0, beta1: 0.0, beta2: 0.0, beta3: 0.0 };
    change_config(part, &mut config, places);
    Some(config)
}

/// The bandwidth or all of the gains that it stands for.
fn require(
    part: &Table<'_>,
    bandwidth: &'static str,
    gains: &[(&'static str, Param)],
    example: &str,
    places: &mut Places,
) {
    if part.span(bandwidth).is_some() {
        return;
    }
    let absent: Vec<&'static str> =
        gains.iter().map(|(key, _)| *key).filter(|key| part.span(key).is_none()).collect();
    if let Some(first) = absent.first() {
        if absent.len() == gains.len() {
            part.missing_one_of(&[&[bandwidth], &*absent].concat(), example);
        } else {
            part.missing(first, example);
        }
        places.silence(&gains.iter().map(|(_, param)| *param).collect::<Vec<_>>());
    }
}

/// Reads a change of the law in an event over what the controller has.
pub(super) fn change(event: &Table<'_>, spec: &mut ControllerSpec, places: &mut Places) {
    if spec.adrc.is_some() {
        for (key, _) in OTHERS {
            refuse(event, key, &spec.name, "an ADRC");
        }
    }
    let Some(part) = event.table("adrc", ADRC) else { return };
    match &mut spec.adrc {
        Some(config) => change_config(part, config, places),
        None => refuse(event, "adrc", &spec.name, "a PID"),
    }
}

/// A running loop keeps the kind of its law: there is no state to take over.
fn refuse(event: &Table<'_>, key: &'static str, name: &str, has: &str) {
    let Some(span) = event.key_span(key) else { return };
    // An event for all controllers: one fault says it.
    if event.log.is_faulty(&span) {
        return;
    }
    let message = format!("controller `{name}` has {has}; an event cannot give it `{key}`");
    event.log.fault(Fault::new(code::CONFLICT, span, message).help(
        "restrict the event by `controller = \"name\"` to one that has it, or write a second controller",
    ));
}

fn change_config(part: Table<'_>, config: &mut AdrcConfig, places: &mut Places) {
    take(&part, "b0", Param::B0, places, &mut config.b0);
    if let Some(omega_c) = bandwidth(&part, "omega_c", &FEEDBACK, places) {
        let AdrcConfig { kp, kd, .. } = AdrcConfig::from_bandwidths(config.b0, omega_c, 0.0);
        (config.kp, config.kd) = (kp, kd);
    }
    take(&part, "kp", Param::AdrcKp, places, &mut config.kp);
    take(&part, "kd", Param::AdrcKd, places, &mut config.kd);
    if let Some(omega_o) = bandwidth(&part, "omega_o", &OBSERVER, places) {
        let AdrcConfig { beta1, beta2, beta3, .. } = AdrcConfig::from_bandwidths(config.b0, 0.0, omega_o);
        (config.beta1, config.beta2, config.beta3) = (beta1, beta2, beta3);
    }
    take(&part, "beta1", Param::Beta1, places, &mut config.beta1);
    take(&part, "beta2", Param::Beta2, places, &mut config.beta2);
    take(&part, "beta3", Param::Beta3, places, &mut config.beta3);
    part.finish();
}

/// A bandwidth, which sets all of `gains`; none of them may stand beside it.
fn bandwidth(
    part: &Table<'_>,
    key: &'static str,
    gains: &[(&'static str, Param)],
    places: &mut Places,
) -> Option<f64> {
    let span = part.span(key)?;
    for (_, param) in gains {
        places.set(*param, part.name(key), span.clone());
    }
    let both = gains.iter().find_map(|(gain, _)| part.key_span(gain).map(|at| (*gain, at)));
    if let (Some((gain, at)), Some(own)) = (both, part.key_span(key)) {
        let message = format!("`{key}` sets `{gain}`: write one of them");
        part.log.fault(Fault::new(code::CONFLICT, at, message).related(own, "the bandwidth"));
        places.silence(&gains.iter().map(|(_, param)| *param).collect::<Vec<_>>());
    }
    part.number_in(key, Allowed::new(1e-15, 1e15, "rad/s")).map(|omega| omega.value)
}
