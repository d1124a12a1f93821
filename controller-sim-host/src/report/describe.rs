//! What a picture shows, in words.

use super::drawing::shown;
use super::panels::Loop;
use super::{Chapter, words};
use crate::scenario::{Units, show_short};
use crate::simulate::Envelope;

/// Most controllers and events that are told one by one.
const MOST: usize = 12;

/// The name of a picture.
pub(super) fn title(chapter: &Chapter<'_>, loops: &[Loop<'_>]) -> String {
    let (from, to) = shown(chapter, loops);
    format!("{}, {} s to {} s", chapter.title(), show_short(from), show_short(to))
}

/// What is seen: controllers, ranges, metrics, events.
pub(super) fn description(chapter: &Chapter<'_>, loops: &[Loop<'_>]) -> String {
    let Units { y, u } = &chapter.scenario.units;
    let mut text = match loops.len() {
        0 => return "The run was not recorded.".to_owned(),
        1 => "Curves over time of one controller.".to_owned(),
        n => format!("Curves over time of {n} controllers."),
    };
    let range = |envelope: &Envelope, unit: &str| match envelope.range() {
        Some((lo, hi)) if unit.is_empty() => format!("{} to {}", show_short(lo), show_short(hi)),
        Some((lo, hi)) => format!("{} to {} {unit}", show_short(lo), show_short(hi)),
        None => "nothing".to_owned(),
    };
    for l in loops.iter().take(MOST) {
        let iae = chapter.result.controllers.get(l.index).map_or(f64::NAN, |c| c.total.iae);
        text.push_str(&format!(
            " {}: plant output {}, controller output {}, IAE of the run {}.",
            l.spec.name,
            range(&l.record.output, y),
            range(&l.record.u, u),
            crate::output::table::format_number(iae),
        ));
    }
    let (from, to) = shown(chapter, loops);
    let events = chapter.scenario.events.iter().filter(|event| (from..=to).contains(&event.at));
    let list: Vec<String> = events
        .clone()
        .take(MOST)
        .map(|event| format!("{} at {} s", words::event(chapter.scenario, event), words::number(event.at)))
        .collect();
    if !list.is_empty() {
        text.push_str(&format!(" Events: {}", list.join("; ")));
        let more = events.count() - list.len();
        text.push_str(&if more > 0 { format!("; and {more} more.") } else { ".".to_owned() });
    }
    text
}
