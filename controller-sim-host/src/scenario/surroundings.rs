//! What lies around the plant and the controllers: the initial state, noise, sensor, actuator.

use super::fault::{Fault, code};
use super::number::Allowed;
use super::sections::signal;
use super::table::Table;
use super::{Actuator, Initial, Noise, Sensor, Stiction};
use controller_design::model::TransferFunction;
use std::ops::Range;

const STICTION: &str = "`stiction = { band = 5.0, jump = 2.0 }`";

/// A step of a converter: above 0, or 0 for none.
const RESOLUTION: Allowed = Allowed::new(0.0, 1e12, "");

/// Where a run starts.
#[derive(Debug, Clone, Default)]
pub(super) struct Start {
    pub(super) initial: Initial,
    /// Where the set-point is written.
    pub(super) setpoint: Option<Range<usize>>,
    /// Whether something about it was reported.
    pub(super) is_faulty: bool,
}

/// `[initial] setpoint, disturbance`.
pub(super) fn initial(root: &Table<'_>, plant: Option<&TransferFunction>) -> Start {
    let before = root.log.count();
    let Some(table) = root.table("initial", "`[initial]` and below it `setpoint = 20.0`") else {
        return Start { is_faulty: root.log.count() > before, ..Start::default() };
    };
    let setpoint = signal(&table, "setpoint").unwrap_or(0.0);
    let disturbance = signal(&table, "disturbance").unwrap_or(0.0);
    if let (true, Some(span)) = (setpoint != 0.0, table.span("setpoint"))
        && plant.is_some_and(|plant| plant.differentiators() > 0)
    {
        let message = format!(
            "`initial.setpoint = {}`, but a plant with a zero at s = 0 can only rest at 0",
            root.log.slice(&span)
        );
        root.log.fault(Fault::new(code::CONFLICT, span, message).help("leave it out"));
    }
    let place = table.span("setpoint");
    table.finish();
    let initial = Initial { setpoint, disturbance };
    Start { initial, setpoint: place, is_faulty: root.log.count() > before }
}

/// `[noise] std, seed`.
pub(super) fn noise(root: &Table<'_>) -> Option<Noise> {
    let table = root.table("noise", "`[noise]` and below it `std = 0.01`")?;
    if table.span("std").is_none() {
        table.missing("std", "the standard deviation: `std = 0.01`");
    }
    let std = table.number_in("std", Allowed::new(0.0, 1e12, ""));
    let seed = table.integer_in("seed", 0, u64::MAX).map_or(1, |seed| seed.value);
    table.finish();
    std.map(|std| Noise { std: std.value, seed })
}

/// `[sensor] lo, hi, resolution`.
pub(super) fn sensor(root: &Table<'_>) -> Sensor {
    let mut sensor = Sensor::default();
    let Some(table) = root.table("sensor", "`[sensor]` and below it `lo = 0.0` and `hi = 100.0`") else {
        return sensor;
    };
    range(&table, &mut sensor.lo, &mut sensor.hi);
    sensor.resolution = resolution(&table, sensor.lo, sensor.hi);
    table.finish();
    sensor
}

/// `[actuator] lo, hi, rate, resolution, deadband, stiction, read_back`.
pub(super) fn actuator(root: &Table<'_>) -> Actuator {
    let mut actuator = Actuator::default();
    let Some(table) = root.table("actuator", "`[actuator]` and below it `lo = 0.0` and `hi = 100.0`") else {
        return actuator;
    };
    range(&table, &mut actuator.lo, &mut actuator.hi);
    if let Some(rate) = table.number_in("rate", Allowed::new(f64::MIN_POSITIVE, 1e15, "per second")) {
        actuator.rate = rate.value;
    }
    actuator.resolution = resolution(&table, actuator.lo, actuator.hi);
    if let Some(deadband) = table.number_in("deadband", Allowed::new(0.0, 1e12, "")) {
        actuator.deadband = deadband.value;
        check_width(&table, "deadband", deadband.value, actuator.lo, actuator.hi, "it never moves");
    }
    if let Some(part) = table.table("stiction", STICTION) {
        actuator.stiction = stiction(part, &actuator);
    }
    if let Some(read_back) = table.flag("read_back") {
        actuator.read_back = read_back.value;
    }
    table.finish();
    actuator
}

/// `stiction = { band, jump }`.
fn stiction(part: Table<'_>, actuator: &Actuator) -> Option<Stiction> {
    if part.span("band").is_none() {
        part.missing("band", "how far the signal turns before the stem moves: `band = 5.0`");
    }
    let band = part.number_in("band", Allowed::new(0.0, 1e12, ""));
    let jump = match part.span("jump") {
        Some(_) => part.number_in("jump", Allowed::new(0.0, 1e12, "")).map(|jump| jump.value),
        None => Some(0.0),
    };
    check_width(
        &part,
        "band",
        band.as_ref().map_or(0.0, |band| band.value),
        actuator.lo,
        actuator.hi,
        "it never moves",
    );
    if let (Some(band), Some(jump), Some(span)) = (&band, jump, part.span("jump"))
        && jump > band.value
    {
        let message = format!(
            "`{} = {}` must not be above `{} = {}`: the stem would overshoot the signal",
            part.name("jump"),
            part.log.slice(&span),
            part.name("band"),
            part.log.slice(&band.span)
        );
        part.log.fault(Fault::new(code::CONFLICT, span, message).related(band.span.clone(), "the band"));
    }
    part.finish();
    Some(Stiction { band: band?.value, jump: jump? })
}

/// `lo` and `hi`, infinite when they are not written.
fn range(table: &Table<'_>, lo: &mut f64, hi: &mut f64) {
    for (key, target) in [("lo", &mut *lo), ("hi", &mut *hi)] {
        if let Some(number) = table.number_in(key, Allowed::SIGNAL) {
            *target = number.value;
        }
    }
    if let (true, Some(low), Some(high)) = (lo >= hi, table.span("lo"), table.span("hi")) {
        let message = format!(
            "`{} = {}` must be below `{} = {}`",
            table.name("lo"),
            table.log.slice(&low),
            table.name("hi"),
            table.log.slice(&high)
        );
        table.log.fault(Fault::new(code::CONFLICT, low, message).related(high, "the upper bound"));
    }
}

fn resolution(table: &Table<'_>, lo: f64, hi: f64) -> f64 {
    let Some(resolution) = table.number_in("resolution", RESOLUTION) else { return 0.0 };
    check_width(table, "resolution", resolution.value, lo, hi, "it has no second value");
    resolution.value
}

/// A step or a band as wide as the whole range leaves nothing of it.
fn check_width(table: &Table<'_>, key: &'static str, width: f64, lo: f64, hi: f64, effect: &str) {
    let Some(span) = table.span(key).filter(|_| lo < hi && width > hi - lo) else { return };
    let message = format!(
        "`{} = {}` is wider than the range from `lo` to `hi`: {effect}",
        table.name(key),
        table.log.slice(&span)
    );
    table.log.fault(Fault::new(code::CONFLICT, span, message));
}
