//! The small sections of a controller: limits, set-point, anti-windup, fallback, alarms. Each is read over
//! what was there before, so that an event may give a part.

use super::fault::{Fault, code};
use super::number::{Allowed, without_unit};
use super::places::Places;
use super::table::Table;
use controller_core::{
    AlarmConfig, AntiWindupConfig, FallbackAction, FallbackConfig, FallbackReturn, LimitConfig, Param,
    SetpointConfig,
};

/// The widest range of a parameter, as far as it does not depend on others: what is said of a value that is no
/// finite number. The law itself checks all others.
fn allowed(param: Param) -> Option<Allowed> {
    let range = |min, max, unit| Some(Allowed::new(min, max, unit));
    match param {
        Param::Kp | Param::Ki | Param::Kd | Param::ModelGain | Param::B0 => range(-1e15, 1e15, ""),
        Param::AdrcKp | Param::Beta2 => range(f64::MIN_POSITIVE, 1e30, ""),
        Param::AdrcKd | Param::Beta1 => range(f64::MIN_POSITIVE, 1e15, ""),
        Param::Beta3 => range(f64::MIN_POSITIVE, 1e45, ""),
        Param::B | Param::C => range(0.0, 2.0, ""),
        Param::Kfd => range(0.0, 1.0, ""),
        Param::Tf | Param::DeadTime => range(0.0, 1e12, "s"),
        Param::Tt | Param::Tfd | Param::Alpha | Param::ModelPoles => range(f64::MIN_POSITIVE, 1e12, "s"),
        Param::Deadband | Param::AlarmHysteresis => range(0.0, 1e12, ""),
        Param::OutputRateUp
        | Param::OutputRateDown
        | Param::SetpointRateUp
        | Param::SetpointRateDown
        | Param::FallbackRate => range(f64::MIN_POSITIVE, 1e15, "per second"),
        Param::AlarmDeviation => range(f64::MIN_POSITIVE, 1e12, ""),
        _ => Some(Allowed::SIGNAL),
    }
}

/// Reads the number `key` into `target`, when it is there, and notes that it sets `param`.
pub(super) fn take(
    table: &Table<'_>,
    key: &'static str,
    param: Param,
    places: &mut Places,
    target: &mut f64,
) {
    let Some(span) = table.span(key) else { return };
    places.set(param, table.name(key), span);
    if let Some(number) = table.number(key, allowed(param)) {
        *target = number.value;
    }
}

/// As [`take`] for a number that may be absent.
pub(super) fn take_optional(
    table: &Table<'_>,
    key: &'static str,
    param: Param,
    places: &mut Places,
    target: &mut Option<f64>,
) {
    let mut number = f64::NAN;
    take(table, key, param, places, &mut number);
    if !number.is_nan() {
        *target = Some(number);
    }
}

/// A rate: a number, or `"none"` to lift the limit again.
fn take_rate(
    table: &Table<'_>,
    key: &'static str,
    params: &[Param],
    places: &mut Places,
    targets: [&mut Option<f64>; 2],
) {
    let Some(span) = table.span(key) else { return };
    for param in params {
        places.set(*param, table.name(key), span.clone());
    }
    let mut none = false;
    let mut rate = None;
    if table.is_text(key) {
        let Some(text) = table.text(key) else { return };
        none = text.value == "none";
        if !none && without_unit(text.value).is_none() && text.value.parse::<f64>().is_err() {
            let help = (text.value.trim().eq_ignore_ascii_case("none")
                || ["off", "unlimited", "inf"].contains(&text.value))
            .then(|| "write \"none\" in lower case for no limit".to_owned());
            table.unknown_choice(key, &text, "a number above 0, \"none\"", help);
            return;
        }
    }
    if !none {
        rate = table.number(key, params.first().and_then(|param| allowed(*param))).map(|rate| rate.value);
    }
    if none || rate.is_some() {
        for target in targets {
            *target = rate;
        }
    }
}

/// `rate` for both directions, or `rate_up` and `rate_down`.
fn read_rates(
    table: &Table<'_>,
    [up, down]: [Param; 2],
    places: &mut Places,
    rate_up: &mut Option<f64>,
    rate_down: &mut Option<f64>,
) {
    if let (Some(both), Some(one)) =
        (table.key_span("rate"), table.key_span("rate_up").or(table.key_span("rate_down")))
    {
        let message = format!("`{}` and a rate for one direction exclude each other", table.name("rate"));
        let fault = Fault::new(code::CONFLICT, one, message)
            .help("write either `rate`, for both directions, or `rate_up` and `rate_down`")
            .related(both, "the rate for both directions");
        table.log.fault(fault);
    }
    let (mut ignored_up, mut ignored_down) = (None, None);
    take_rate(table, "rate", &[up, down], places, [&mut *rate_up, &mut *rate_down]);
    take_rate(table, "rate_up", &[up], places, [rate_up, &mut ignored_up]);
    take_rate(table, "rate_down", &[down], places, [rate_down, &mut ignored_down]);
}

/// `limits = { lo, hi, rate | rate_up, rate_down }`.
pub(super) fn limits(table: Table<'_>, config: &mut LimitConfig, places: &mut Places) {
    take(&table, "lo", Param::OutputLo, places, &mut config.lo);
    take(&table, "hi", Param::OutputHi, places, &mut config.hi);
    let params = [Param::OutputRateUp, Param::OutputRateDown];
    read_rates(&table, params, places, &mut config.rate_up, &mut config.rate_down);
    table.finish();
}

/// `setpoint = { lo, hi, rate | rate_up, rate_down, track }`.
pub(super) fn setpoint(table: Table<'_>, config: &mut SetpointConfig, places: &mut Places) {
    take(&table, "lo", Param::SetpointLo, places, &mut config.lo);
    take(&table, "hi", Param::SetpointHi, places, &mut config.hi);
    let params = [Param::SetpointRateUp, Param::SetpointRateDown];
    read_rates(&table, params, places, &mut config.rate_up, &mut config.rate_down);
    if let Some(track) = table.flag("track") {
        config.track = track.value;
    }
    table.finish();
}

/// `anti_windup = { rule, tt }`.
pub(super) fn anti_windup(table: Table<'_>, config: &mut AntiWindupConfig, places: &mut Places) {
    let rules = [
        ("back-calculation", AntiWindupConfig::BackCalculation { tt: None }),
        ("conditional", AntiWindupConfig::Conditional),
        ("none", AntiWindupConfig::None),
    ];
    if let Some(rule) = table.choice("rule", &rules) {
        let same = std::mem::discriminant(&rule.value) == std::mem::discriminant(config);
        // Naming the rule that is in force already keeps its time constant.
        if !same {
            *config = rule.value;
        }
    }
    let mut new = None;
    take_optional(&table, "tt", Param::Tt, places, &mut new);
    match (&mut *config, table.span("tt")) {
        (AntiWindupConfig::BackCalculation { tt }, Some(_)) => *tt = new.or(*tt),
        (_, Some(span)) => {
            let message = format!("`{}` has no meaning for this rule", table.name("tt"));
            table.log.fault(
                Fault::new(code::CONFLICT, span, message)
                    .help("only the rule \"back-calculation\" has a `tt`"),
            );
        }
        (_, None) => {}
    }
    table.finish();
}

/// `measurement = { lo, hi }` or `offset = { lo, hi }`.
pub(super) fn range(table: Table<'_>, params: [Param; 2], lo: &mut f64, hi: &mut f64, places: &mut Places) {
    take(&table, "lo", params[0], places, lo);
    take(&table, "hi", params[1], places, hi);
    table.finish();
}

/// `fallback = { hold_samples, action, output, rate, return }`.
pub(super) fn fallback(table: Table<'_>, config: &mut FallbackConfig, places: &mut Places) {
    #[derive(Clone, Copy, PartialEq)]
    enum Kind {
        Hold,
        Substitute,
        Ramp,
    }
    if let Some(n) = table.integer_in("hold_samples", 0, u64::from(u16::MAX)) {
        config.hold_samples = u16::try_from(n.value).unwrap_or(u16::MAX);
    }
    let kinds = [("hold", Kind::Hold), ("substitute", Kind::Substitute), ("ramp", Kind::Ramp)];
    let kind = table.choice("action", &kinds).map_or(Kind::Hold, |kind| kind.value);
    let known = table.span("action").is_none_or(|span| !table.log.is_faulty(&span));
    let (mut output, mut rate) = (0.0, 0.0);
    take(&table, "output", Param::FallbackOutput, places, &mut output);
    take(&table, "rate", Param::FallbackRate, places, &mut rate);
    if known {
        let needs =
            [("output", kind != Kind::Hold, "`output = 0.0`"), ("rate", kind == Kind::Ramp, "`rate = 1.0`")];
        for (key, needed, example) in needs {
            match (needed, table.span(key)) {
                (true, None) => {
                    table.missing(key, example);
                    places.silence(&[Param::FallbackOutput, Param::FallbackRate]);
                }
                (false, Some(span)) => {
                    let message = format!("`{}` has no meaning for this action", table.name(key));
                    let help =
                        "`output` belongs to the actions \"substitute\" and \"ramp\", `rate` to \"ramp\"";
                    table.log.fault(Fault::new(code::CONFLICT, span, message).help(help));
                }
                _ => {}
            }
        }
    }
    config.action = match kind {
        Kind::Hold => FallbackAction::Hold,
        Kind::Substitute => FallbackAction::Substitute { output },
        Kind::Ramp => FallbackAction::Ramp { output, rate },
    };
    let returns = [("automatic", FallbackReturn::Automatic), ("acknowledged", FallbackReturn::Acknowledged)];
    if let Some(back) = table.choice("return", &returns) {
        config.back = back.value;
    }
    table.finish();
}

/// `alarms = { hi_hi, hi, lo, lo_lo, deviation, hysteresis }`.
pub(super) fn alarms(table: Table<'_>, config: &mut AlarmConfig, places: &mut Places) {
    take_optional(&table, "hi_hi", Param::AlarmHiHi, places, &mut config.hi_hi);
    take_optional(&table, "hi", Param::AlarmHi, places, &mut config.hi);
    take_optional(&table, "lo", Param::AlarmLo, places, &mut config.lo);
    take_optional(&table, "lo_lo", Param::AlarmLoLo, places, &mut config.lo_lo);
    take_optional(&table, "deviation", Param::AlarmDeviation, places, &mut config.deviation);
    take(&table, "hysteresis", Param::AlarmHysteresis, places, &mut config.hysteresis);
    table.finish();
}

/// `mode = "auto"`.
pub(super) fn mode(table: &Table<'_>) -> Option<controller_core::Mode> {
    let words = controller_core::Mode::REQUESTS.map(|mode| (mode.name(), mode));
    table.choice("mode", &words).map(|mode| mode.value)
}

/// A signal of the run, such as a set-point: as large as the runtime allows.
pub(super) fn signal(table: &Table<'_>, key: &'static str) -> Option<f64> {
    table.number_in(key, Allowed::SIGNAL).map(|number| number.value)
}
