//! From the text of a scenario to a scenario that can be run, or to everything that is wrong with it.

use super::controllers::Draft;
use super::events;
use super::expression;
use super::fault::{Fault, code};
use super::log::{Log, MOST as MOST_FAULTS};
use super::number::{Allowed, show_short};
use super::ranges;
use super::sections::signal;
use super::syntax;
use super::table::{Located, Table};
use super::texts;
use super::trial::{self, Context, LONGEST_DELAY, delay_fault};
use super::{Actuator, Initial, Noise, Scenario, Sensor};
use crate::simulate::Precision;
use controller_design::model::TransferFunction;
use toml::de::DeTable;

/// The version of the scenario format that this program reads.
pub const VERSION: u64 = 1;

/// Most samples of a run.
const MOST_SAMPLES: f64 = 1e9;

/// A scenario and what is odd about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// The scenario.
    pub scenario: Scenario,
    /// What can be run but is probably not meant, in the order of the text.
    pub warnings: Vec<Fault>,
}

/// Reads a scenario for a run in `precision`: the TOML text, every value, every controller's law.
///
/// # Errors
/// Everything that is wrong, in the order of the text (at most 100 faults): text that is no TOML, unknown and
/// missing keys, values of the wrong type or out of range, mistakes in expressions, controllers that cannot
/// be built in `precision`.
///
/// ```
/// use controller_sim_host::scenario::read;
/// use controller_sim_host::simulate::Precision;
/// let text = r#"
/// version = 1
/// ts = 0.1
/// duration = 60.0
/// [plant]
/// tf = "2*exp(-s)/(1+10*s)"
/// [[event]]
/// at = 0.0
/// setpoint = 1.0
/// [[controller]]
/// name = "PI"
/// pid = { kp = 2.0, ki = 0.2 }
/// "#;
/// let read_back = read(text, Precision::F64).expect("a valid scenario");
/// assert_eq!(read_back.scenario.controllers[0].config.pid.kp, 2.0);
///
/// let faults = read(&text.replace("ki = 0.2", "Ki = 0.2"), Precision::F64).expect_err("a misspelt key");
/// assert_eq!(faults[0].message, "unknown key `Ki` in `pid`");
/// assert_eq!(faults[0].help.as_deref(), Some("did you mean `ki`?"));
/// assert_eq!((faults[0].place(text).line, faults[0].place(text).column), (12, 19));
/// ```
pub fn read(text: &str, precision: Precision) -> Result<Read, Vec<Fault>> {
    let (document, errors) = DeTable::parse_recoverable(text);
    let syntax = syntax::faults(text, &errors);
    if syntax::is_hopeless(&syntax) {
        return Err(syntax);
    }
    if let Some(fault) = nothing_in(text, document.get_ref(), &syntax) {
        return Err(vec![fault]);
    }
    let log = Log::new(text);
    let scenario = read_root(Table::root(document.get_ref(), &log), precision);
    let (faults, warnings) = log.finish();
    if !syntax.is_empty() {
        let credible = faults.into_iter().filter(|fault| syntax::is_credible(text, fault, &syntax));
        let mut all: Vec<Fault> = syntax.iter().cloned().chain(credible).collect();
        all.sort_by_key(|fault| (fault.span.start, fault.span.end));
        all.truncate(MOST_FAULTS);
        return Err(all);
    }
    match scenario {
        Some(scenario) if faults.is_empty() => Ok(Read { scenario, warnings }),
        _ => Err(faults),
    }
}

/// The one fault of a text without a single key.
fn nothing_in(text: &str, document: &DeTable<'_>, syntax: &[Fault]) -> Option<Fault> {
    if !syntax.is_empty() || document.iter().next().is_some() {
        return None;
    }
    let what =
        if text.trim().is_empty() { "the scenario is empty" } else { "the scenario has comments only" };
    Some(Fault::new(code::MISSING_KEY, 0..0, what).help("`controller-sim demo --save` writes an example"))
}

/// Reads everything; nothing comes back only when there are faults.
fn read_root(root: Table<'_>, precision: Precision) -> Option<Scenario> {
    let log = root.log;
    read_version(&root);
    let (title, description, units) = (texts::title(&root), texts::description(&root), texts::units(&root));
    let ts =
        required(&root, "ts", Allowed::new(1e-9, 1e9, "s"), "the sampling period in seconds: `ts = 0.01`");
    let duration =
        required(&root, "duration", Allowed::TIME, "the length of the run in seconds: `duration = 20.0`");
    let latency = root.number_in("latency", Allowed::new(0.0, 1e12, "s"));
    let substeps = root.integer_in("substeps", 1, 1000).map_or(10, |n| n.value);
    check_length(&root, ts.as_ref(), duration.as_ref());
    let latency_span = root.span("latency");
    let latency_is_long = check_latency(&root, ts.as_ref(), latency.as_ref());
    let latency = latency.map_or(0.0, |latency| latency.value);
    // Its length was reported: the sums with it are not reported again.
    let summand = if latency_is_long { 0.0 } else { latency };
    let plant = read_plant(&root, ts.as_ref(), summand);
    let initial = read_initial(&root, plant.as_ref());
    let noise = read_noise(&root);
    let actuator = read_actuator(&root);

    let (ts, ts_span) = (ts.as_ref().map(|ts| ts.value), ts.map(|ts| ts.span));
    let duration = duration.map(|duration| duration.value);
    let context = Context { ts, ts_span, latency, latency_span, plant, precision };
    let mut drafts = read_controllers(&root, &context);
    let controllers: Vec<_> = drafts.iter().map(Draft::spec).collect();
    let places: Vec<_> = drafts.iter().map(|draft| draft.places.clone()).collect();
    let events = events::read(&root, &mut drafts, duration, &context);
    root.finish();
    if log.count() > 0 {
        return None;
    }
    let scenario = Scenario {
        title,
        description,
        units,
        ts: ts?,
        duration: duration?,
        latency,
        substeps: usize::try_from(substeps).ok()?,
        plant: context.plant?,
        inner_plant: None,
        initial,
        events: events.iter().map(|placed| placed.event.clone()).collect(),
        controllers,
        noise,
        sensor: Sensor::default(),
        actuator,
    };
    for (index, places) in places.iter().enumerate() {
        ranges::warn(&scenario, index, &events, places, log);
    }
    ranges::warn_of_compensators(&scenario, &events, log);
    Some(scenario)
}

fn read_version(root: &Table<'_>) {
    if root.span("version").is_none() {
        root.missing("version", "`version = 1` on the first line");
        return;
    }
    let Some(version) = root.integer_in("version", 0, u64::MAX) else { return };
    if version.value != VERSION {
        let message = format!(
            "`version = {}` is not known; this program reads version {VERSION}",
            root.log.slice(&version.span)
        );
        root.log.fault(
            Fault::new(code::NOT_SUPPORTED, version.span, message)
                .help(format!("write `version = {VERSION}`")),
        );
    }
}

fn required(root: &Table<'_>, key: &'static str, allowed: Allowed, example: &str) -> Option<Located<f64>> {
    if root.span(key).is_none() {
        root.missing(key, example);
    }
    root.number_in(key, allowed)
}

/// The run must have a sample, and not more than anyone waits for.
fn check_length(root: &Table<'_>, ts: Option<&Located<f64>>, duration: Option<&Located<f64>>) {
    let (Some(ts), Some(duration)) = (ts, duration) else { return };
    let samples = duration.value / ts.value;
    let [length, period] = [&duration.span, &ts.span].map(|span| root.log.slice(span));
    let fault = if samples > MOST_SAMPLES {
        let message = format!(
            "`duration = {length}` is {} samples of {period} s; allowed: at most {MOST_SAMPLES:e}",
            show_short(samples)
        );
        Fault::new(code::TOO_LARGE, duration.span.clone(), message)
            .help("choose a longer `ts` or a shorter run")
    } else if samples < 1.0 - 1e-9 {
        let message =
            format!("`duration = {length}` is shorter than one sample; allowed: `ts`, {period} s, or more");
        Fault::new(code::OUT_OF_RANGE, duration.span.clone(), message)
    } else {
        return;
    };
    root.log.fault(fault.related(ts.span.clone(), "the sampling period"));
}

/// The latency alone must not be too long; whether it is.
fn check_latency(root: &Table<'_>, ts: Option<&Located<f64>>, latency: Option<&Located<f64>>) -> bool {
    let (Some(ts), Some(latency)) = (ts, latency) else { return false };
    let samples = latency.value / ts.value;
    if samples <= LONGEST_DELAY {
        return false;
    }
    let what = format!("`latency = {}` is", root.log.slice(&latency.span));
    root.log.fault(delay_fault(&what, samples, latency.span.clone()));
    true
}

fn read_plant(root: &Table<'_>, ts: Option<&Located<f64>>, latency: f64) -> Option<TransferFunction> {
    let example = "`[plant]` and below it `tf = \"exp(-0.2*s)/(1+s)\"`";
    if root.span("plant").is_none() {
        root.missing("plant", example);
    }
    let table = root.table("plant", example)?;
    if table.span("tf").is_none() {
        table.missing("tf", "the plant's transfer function: `tf = \"exp(-0.2*s)/(1+s)\"`");
    }
    let plant = expression::read(&table, "tf");
    if let (Some(plant), Some(ts)) = (&plant, ts) {
        let samples = (plant.value.dead_time() + latency) / ts.value;
        if samples > LONGEST_DELAY {
            root.log.fault(delay_fault(
                "the plant's dead time and the latency are",
                samples,
                plant.span.clone(),
            ));
        }
    }
    table.finish();
    plant.map(|plant| plant.value)
}

fn read_initial(root: &Table<'_>, plant: Option<&TransferFunction>) -> Initial {
    let Some(table) = root.table("initial", "`[initial]` and below it `setpoint = 20.0`") else {
        return Initial::default();
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
    table.finish();
    Initial { setpoint, disturbance }
}

fn read_noise(root: &Table<'_>) -> Option<Noise> {
    let table = root.table("noise", "`[noise]` and below it `std = 0.01`")?;
    if table.span("std").is_none() {
        table.missing("std", "the standard deviation: `std = 0.01`");
    }
    let std = table.number_in("std", Allowed::new(0.0, 1e12, ""));
    let seed = table.integer_in("seed", 0, u64::MAX).map_or(1, |seed| seed.value);
    table.finish();
    std.map(|std| Noise { std: std.value, seed })
}

fn read_actuator(root: &Table<'_>) -> Actuator {
    let mut actuator = Actuator::default();
    let Some(table) = root.table("actuator", "`[actuator]` and below it `lo = 0.0` and `hi = 100.0`") else {
        return actuator;
    };
    for (key, target) in [("lo", &mut actuator.lo), ("hi", &mut actuator.hi)] {
        if let Some(number) = table.number_in(key, Allowed::SIGNAL) {
            *target = number.value;
        }
    }
    if let (true, Some(lo), Some(hi)) = (actuator.lo >= actuator.hi, table.span("lo"), table.span("hi")) {
        let message = format!(
            "`actuator.lo = {}` must be below `actuator.hi = {}`",
            root.log.slice(&lo),
            root.log.slice(&hi)
        );
        root.log.fault(Fault::new(code::CONFLICT, lo, message).related(hi, "the upper bound"));
    }
    if let Some(read_back) = table.flag("read_back") {
        actuator.read_back = read_back.value;
    }
    table.finish();
    actuator
}

fn read_controllers(root: &Table<'_>, context: &Context) -> Vec<Draft> {
    let tables = root.tables("controller");
    if root.span("controller").is_none() {
        root.missing("controller", "at least one `[[controller]]`, with a `name` and a `pid`");
    }
    let mut drafts: Vec<Draft> = Vec::new();
    for table in tables {
        let before = root.log.count();
        let draft = Draft::read(table);
        trial::check(&draft, context, root.log, before);
        let twin = drafts
            .iter()
            .find(|other| other.name() == draft.name())
            .and_then(|other| other.name_span.clone());
        if let (Some(first), Some(span)) = (twin, draft.name_span.clone()) {
            let message = format!("there are two controllers named `{}`", draft.name());
            let fault = Fault::new(code::DUPLICATE, span, message).help("give each a name of its own");
            root.log.fault(fault.related(first, "the first one"));
        }
        drafts.push(draft);
    }
    drafts
}
