//! The `[[event]]` tables: read in the order of time, so that changes of parameters build on each other.

use super::controllers::{Draft, PARAMETER_KEYS};
use super::fault::{Fault, code};
use super::number::{Allowed, show};
use super::sections::{mode, signal};
use super::signals;
use super::suggest::closest;
use super::table::Table;
use super::texts;
use super::trial::{self, Context};
use super::value::shortened;
use super::{Change, Event};
use crate::simulate::sample_of;
use std::ops::Range;

/// Most samples that one event makes bad or loses.
const MOST_SAMPLES: u64 = 1_000_000_000;

/// An event and where its changes are written.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) event: Event,
    /// One for each change.
    pub(super) spans: Vec<Range<usize>>,
}

/// Reads all events; `drafts` are the controllers as they start and end up as the events leave them.
pub(super) fn read(root: &Table<'_>, drafts: &mut [Draft], context: &Context<'_>) -> Vec<Placed> {
    let duration = context.duration;
    let mut tables: Vec<(Option<f64>, Table<'_>)> =
        root.tables("event").into_iter().map(|table| (read_time(&table, duration), table)).collect();
    // Stable: of two events at one time the one written first comes first.
    tables.sort_by(|(a, _), (b, _)| a.unwrap_or(f64::INFINITY).total_cmp(&b.unwrap_or(f64::INFINITY)));
    let mut events = Vec::new();
    for (at, table) in tables {
        let controller = read_controller(&table, drafts);
        let mut changes = read_changes(&table, context);
        if let Some(who) = concerned(&table, controller, drafts.len()) {
            changes.extend(read_parameters(&table, drafts, &who, context));
        }
        let label = texts::label(&table);
        let keys = table.written();
        if keys.iter().all(|(key, ..)| matches!(*key, "at" | "controller" | "label")) {
            let message = "this event changes nothing";
            let help = "write what happens, for example `setpoint = 1.0` or `disturbance = 1.0`";
            table.log.fault(Fault::new(code::MISSING_KEY, table.place.clone(), message).help(help));
        }
        changes.sort_by_key(|(span, _)| span.start);
        check_not_late(&table, at, &changes, context);
        table.finish();
        if let Some(at) = at {
            let (spans, changes) = changes.into_iter().unzip();
            events.push(Placed {
                event: Event { at, label, changes, controller: controller.flatten() },
                spans,
            });
        }
    }
    events
}

/// Where a value is written, and what it changes.
type PlacedChange = (Range<usize>, Change);

fn read_time(table: &Table<'_>, duration: Option<f64>) -> Option<f64> {
    if table.span("at").is_none() {
        table.missing("at", "when it happens, in seconds: `at = 10.0`");
    }
    let end = duration.unwrap_or(1e18);
    let at = table.number("at", Some(Allowed::new(0.0, end, "s")))?;
    if at.value >= 0.0 && at.value < end {
        // No sign on a zero: it would be printed.
        return Some(at.value.abs());
    }
    let raw = table.log.slice(&at.span);
    let message = if at.value < 0.0 {
        format!("`at = {raw}` is before the run begins; allowed: 0 s to below {} s", show(end))
    } else {
        format!(
            "`at = {raw}` is not before the end of the run; allowed: 0 s to below `duration`, {} s",
            show(end)
        )
    };
    let fault = Fault::new(code::OUT_OF_RANGE, at.span, message);
    table.log.fault(if at.value < 0.0 {
        fault.help("what holds before `t = 0` is written in `[initial]`")
    } else {
        fault.help("make the run longer, or the event earlier")
    });
    None
}

/// Everything but a disturbance takes effect with the next sample: there must be one.
fn check_not_late(table: &Table<'_>, at: Option<f64>, changes: &[PlacedChange], context: &Context<'_>) {
    let (Some(at), Some(duration), Some(ts), Some(span)) =
        (at, context.duration, context.ts, table.span("at"))
    else {
        return;
    };
    let waits = changes.iter().any(|(_, change)| !matches!(change, Change::Disturbance(_)));
    let samples = sample_of(duration, ts);
    if waits && sample_of(at, ts) >= samples {
        let raw = table.log.slice(&span);
        let message = format!("`at = {raw}` comes after the last of the {samples} samples");
        let help = "only a disturbance begins between samples; make the run longer, or the event earlier";
        table.log.fault(Fault::new(code::OUT_OF_RANGE, span, message).help(help));
    }
}

/// The controller the event is restricted to: none when there is no such name, else the index or all.
fn read_controller(table: &Table<'_>, drafts: &[Draft]) -> Option<Option<usize>> {
    if table.span("controller").is_none() {
        return Some(None);
    }
    let name = table.text("controller")?;
    let index = drafts.iter().position(|draft| draft.name_span.is_some() && draft.name() == name.value);
    if index.is_none() {
        let names: Vec<&str> = drafts.iter().map(Draft::name).filter(|name| !name.is_empty()).collect();
        let message = format!("there is no controller `{}`", shortened(name.value));
        let help = match closest(name.value, &names) {
            Some(meant) => format!("did you mean \"{meant}\"?"),
            None if names.is_empty() => "write a `[[controller]]` with this name".to_owned(),
            None => format!("the controllers are \"{}\"", names.join("\", \"")),
        };
        // A controller whose own name is wrong may be the one that is meant.
        if drafts.iter().all(|draft| draft.name_span.is_some()) {
            table.log.fault(Fault::new(code::UNKNOWN_NAME, name.span, message).help(help));
        }
    }
    index.map(Some)
}

/// The controllers whose parameters the event changes; none when it changes none.
fn concerned(table: &Table<'_>, controller: Option<Option<usize>>, count: usize) -> Option<Vec<usize>> {
    let any = PARAMETER_KEYS.iter().filter(|&&key| table.span(key).is_some()).count() > 0;
    match controller? {
        _ if !any => None,
        Some(one) => Some(vec![one]),
        None => Some((0..count).collect()),
    }
}

fn read_parameters(
    table: &Table<'_>,
    drafts: &mut [Draft],
    who: &[usize],
    context: &Context<'_>,
) -> Option<PlacedChange> {
    let first = PARAMETER_KEYS.iter().filter_map(|key| table.key_span(key)).min_by_key(|span| span.start)?;
    let mut list = Vec::new();
    for &index in who {
        let Some(draft) = drafts.get_mut(index) else { continue };
        let before = table.log.count();
        draft.change(table);
        table.log.turn_to(Some(index));
        trial::check(draft, context, table.log, before);
        table.log.turn_to(None);
        list.push((index, draft.spec()));
    }
    Some((first, Change::Parameters(list)))
}

/// Everything but parameters.
fn read_changes(table: &Table<'_>, context: &Context<'_>) -> Vec<PlacedChange> {
    let mut changes: Vec<PlacedChange> = Vec::new();
    let mut add = |key: &'static str, change: Option<Change>| {
        if let (Some(span), Some(change)) = (table.span(key), change) {
            changes.push((span, change));
        }
    };
    add("setpoint", signals::read(table, "setpoint", context).map(Change::Setpoint));
    add("disturbance", signals::read(table, "disturbance", context).map(Change::Disturbance));
    add("remote_setpoint", signals::read(table, "remote_setpoint", context).map(Change::RemoteSetpoint));
    add("measurement", signals::measurement(table, context));
    add("mode", mode(table).map(Change::Mode));
    add("manual", signal(table, "manual").map(Change::Manual));
    add("track", signal(table, "track").map(Change::Track));
    add("offset", signal(table, "offset").map(Change::Offset));
    add("compensator", table.flag("compensator").map(|on| Change::Compensator(on.value)));
    add("bad_samples", read_count(table, "bad_samples").map(Change::BadSamples));
    add("lost_samples", read_count(table, "lost_samples").map(Change::LostSamples));
    add("acknowledge", read_acknowledge(table).then_some(Change::Acknowledge));
    changes
}

fn read_count(table: &Table<'_>, key: &'static str) -> Option<u32> {
    table.integer_in(key, 1, MOST_SAMPLES).and_then(|n| u32::try_from(n.value).ok())
}

fn read_acknowledge(table: &Table<'_>) -> bool {
    let Some(flag) = table.flag("acknowledge") else { return false };
    if !flag.value {
        let message = "`acknowledge = false` has no meaning";
        let help = "an acknowledgement is a single event: write `acknowledge = true`, or leave it out";
        table.log.fault(Fault::new(code::CONFLICT, flag.span, message).help(help));
    }
    flag.value
}
