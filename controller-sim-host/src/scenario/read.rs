//! From the text of a scenario to a scenario that can be run, or to everything that is wrong with it.

use super::Scenario;
use super::controllers::Draft;
use super::fault::{Fault, code};
use super::files::NoFiles;
use super::include::{self, Roots};
use super::library::Library;
use super::log::{Log, MOST as MOST_FAULTS};
use super::oddities::{self, Tables};
use super::plants::{Plant, Written};
use super::sources::Sources;
use super::table::Table;
use super::trial::{self, Context};
use super::{events, plants, ranges, run, surroundings, syntax, texts, uncertainty};
use crate::simulate::Precision;
use toml::de::DeTable;

/// The version of the scenario format that this program reads.
pub const VERSION: u64 = 1;

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
/// be built in `precision`; files the text names, and a sweep: [`read_with`](super::read_with) reads these.
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
    let library = Library::new(&NoFiles);
    read_one(&Input { name: "", text, replaced: None, precision, library: &library, takes_sweep: false })
}

/// What one case is read from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input<'a> {
    /// What messages call it.
    pub(super) name: &'a str,
    pub(super) text: &'a str,
    /// An included file and the text to take for it.
    pub(super) replaced: Option<(&'a str, &'a str)>,
    pub(super) precision: Precision,
    pub(super) library: &'a Library<'a>,
    /// Whether a `[sweep]` is the caller's business; if not, there must be none.
    pub(super) takes_sweep: bool,
}

/// Reads one case; a sweep in the text is not looked at.
pub(super) fn read_one(input: &Input<'_>) -> Result<Read, Vec<Fault>> {
    let text = input.text;
    let (document, errors) = DeTable::parse_recoverable(text);
    let mut syntax = syntax::faults(text, &errors);
    if syntax::is_hopeless(&syntax) {
        return Err(syntax);
    }
    if let Some(fault) = nothing_in(text, document.get_ref(), &syntax) {
        return Err(vec![fault]);
    }
    let includes = include::load(document.get_ref(), text, input.replaced, input.library);
    let mut found: Vec<_> = includes.iter().filter(|include| include.text.is_ok()).collect();
    let sources =
        Sources::new(input.name, text, found.iter().filter_map(|include| include.text.clone().ok()));
    let mut documents: Vec<_> =
        sources.included().map(|(at, part)| (at, DeTable::parse_recoverable(&part.text))).collect();
    let mut incomplete = found.len() < includes.len();
    for (index, (at, part)) in sources.included().enumerate().collect::<Vec<_>>().into_iter().rev() {
        let Some((_, (_, errors))) = documents.get(index) else { continue };
        let faults = syntax::faults(&part.text, errors);
        // Nothing in such a text means what it seems to.
        if syntax::is_hopeless(&faults) {
            documents.remove(index);
            found.remove(index);
            incomplete = true;
        }
        syntax.extend(faults.into_iter().map(|fault| fault.shifted(at)));
    }
    let log = Log::new(sources.whole());
    let own = Table::root(document.get_ref(), 0, &log);
    let included =
        documents.iter().map(|(at, (document, _))| Table::root(document.get_ref(), *at, &log)).collect();
    let roots = Roots { own, included };
    incomplete |= roots.own.items("include").iter().any(|item| !item.value.is_str());
    let about_includes = roots.own.span("include");
    include::check(&roots, &includes, &found);
    let scenario = read_roots(roots, input);
    let (mut faults, warnings) = log.finish();
    let resolve = |list: Vec<Fault>| list.into_iter().map(|fault| sources.resolve(fault)).collect::<Vec<_>>();
    if !syntax.is_empty() || incomplete {
        faults.retain(|fault| {
            let of_includes = about_includes
                .as_ref()
                .is_some_and(|place| place.start <= fault.span.start && fault.span.end <= place.end);
            of_includes || syntax::is_credible(sources.whole(), fault, &syntax)
        });
        faults.extend(syntax);
        faults.sort_by_key(|fault| (fault.span.start, fault.span.end));
        faults.truncate(MOST_FAULTS);
        return Err(resolve(faults));
    }
    match scenario {
        Some(scenario) if faults.is_empty() => Ok(Read { scenario, warnings: resolve(warnings) }),
        _ => Err(resolve(faults)),
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
fn read_roots(roots: Roots<'_>, input: &Input<'_>) -> Option<Scenario> {
    let log = roots.own.log;
    refuse_sweep(&roots.own, input);
    let run = run::read(&roots);
    // What the report is called is not taken from an included file.
    let (title, description) = (texts::title(&roots.own), texts::description(&roots.own));
    let units = texts::units(roots.of("units"));
    let latency = run.latency.as_ref().map_or(0.0, |latency| latency.value);
    // Its length was reported: the sums with it are not reported again.
    let summand = if run.latency_is_long { 0.0 } else { latency };
    let written = plants::read(roots.of("plant"), run.ts.as_ref(), summand);
    let start = surroundings::initial(roots.of("initial"), written.as_ref().and_then(Written::linear));
    let step = run.ts.as_ref().map(|ts| ts.value / run.substeps as f64);
    let plant = written.and_then(|written| written.at(&start, step, log));
    let noise = surroundings::noise(roots.of("noise"));
    let sensor = surroundings::sensor(roots.of("sensor"));
    let actuator = surroundings::actuator(roots.of("actuator"));

    uncertainty::check(&roots.own);

    let context = Context {
        ts: run.ts.as_ref().map(|ts| ts.value),
        ts_span: run.ts.map(|ts| ts.span),
        latency,
        latency_span: run.latency.map(|latency| latency.span),
        plant: plant.as_ref().map(|plant| plant.whole.clone()),
        precision: input.precision,
        duration: run.duration,
        library: input.library,
    };
    let mut drafts = read_controllers(&roots, &context, plant.as_ref());
    let controllers: Vec<_> = drafts.iter().map(Draft::spec).collect();
    let places: Vec<_> = drafts.iter().map(Draft::all_places).collect();
    let events = events::read(roots.of("event"), &mut drafts, &context);
    let tables =
        Tables { sensor: roots.of("sensor").span("sensor"), actuator: roots.of("actuator").span("actuator") };
    roots.finish();
    if log.count() > 0 {
        return None;
    }
    let plant = plant?;
    let scenario = Scenario {
        title,
        description,
        units,
        ts: context.ts?,
        duration: run.duration?,
        latency,
        substeps: run.substeps,
        plant: plant.actual,
        nonlinear: plant.nonlinear,
        inner_plant: plant.parts.map(|[inner, _]| inner),
        initial: start.initial,
        events: events.iter().map(|placed| placed.event.clone()).collect(),
        controllers,
        noise,
        sensor,
        actuator,
    };
    for (index, places) in places.iter().enumerate() {
        log.turn_to(Some(index));
        ranges::warn(&scenario, index, &events, places, log);
    }
    log.turn_to(None);
    ranges::warn_of_compensators(&scenario, &events, log);
    oddities::warn(&scenario, &events, &tables, log);
    Some(scenario)
}

fn refuse_sweep(own: &Table<'_>, input: &Input<'_>) {
    // The caller has read it when it takes it.
    if let (Some(span), false) = (own.key_span("sweep"), input.takes_sweep) {
        let message = "a sweep has several cases, and a single one is read here";
        own.log.fault(Fault::new(code::NOT_SUPPORTED, span, message).help("take the sweep away"));
    }
}

/// The included controllers first, in the order of the files.
fn read_controllers(roots: &Roots<'_>, context: &Context<'_>, plant: Option<&Plant>) -> Vec<Draft> {
    let log = roots.own.log;
    // What an included file lacks was said of it.
    if roots.included.is_empty() && roots.own.span("controller").is_none() {
        roots.own.missing("controller", "at least one `[[controller]]`, with a `name` and a `pid`");
    }
    let mut drafts: Vec<Draft> = Vec::new();
    for table in roots.all().flat_map(|table| table.tables("controller")) {
        let before = log.count();
        log.turn_to(Some(drafts.len()));
        let mut draft = Draft::read(table);
        if let (Some(plant), Some(ts), true) = (plant, context.ts, log.count() == before) {
            draft.design(plant, ts, context.latency, log);
        }
        check_laws(&draft, context, plant, log, before);
        let twin = drafts
            .iter()
            .find(|other| other.name() == draft.name())
            .and_then(|other| other.name_span.clone());
        if let (Some(first), Some(span)) = (twin, draft.name_span.clone()) {
            let message = format!("there are two controllers named `{}`", draft.name());
            let fault = Fault::new(code::DUPLICATE, span, message).help("give each a name of its own");
            log.fault(fault.related(first, "the first one"));
        }
        drafts.push(draft);
    }
    log.turn_to(None);
    drafts
}

/// Checks a controller, and the one inside of it, each against what it drives.
fn check_laws(draft: &Draft, context: &Context<'_>, plant: Option<&Plant>, log: &Log<'_>, before: usize) {
    let Some((secondary, place)) = &draft.secondary else {
        trial::check(draft, context, log, before);
        return;
    };
    let parts = plant.and_then(|plant| plant.parts.clone());
    if plant.is_some() && parts.is_none() {
        let message = "a secondary controller needs the part of the plant that it controls";
        let help = "write that part in `[plant]`: `inner = \"1/(1+0.1*s)\"`; the other keys there are the part behind it";
        log.fault(Fault::new(code::CONFLICT, place.clone(), message).help(help));
    }
    let [inner, outer] = parts.map_or([None, None], |parts| parts.map(Some));
    trial::check(secondary, &Context { plant: inner, ..context.clone() }, log, before);
    // Behind a closed inner loop, which follows its set-point, only the outer part is left.
    trial::check(draft, &Context { plant: outer, ..context.clone() }, log, before);
}
