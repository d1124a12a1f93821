//! Which line is which.

use super::drawing::look;
use super::panels::{Look, Loop, panels, shows_applied, shows_measurement};
use crate::scenario::Scenario;
use maud::{Markup, html};

/// A line and what it is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) look: Look,
    pub(super) text: String,
}

/// Everything that needs to be told apart.
pub(super) fn entries(scenario: &Scenario, loops: &[Loop<'_>]) -> Vec<Entry> {
    let has_disturbance = panels(scenario, loops).iter().any(|panel| panel.title.starts_with("Disturbance"));
    let text = if has_disturbance { "set-point r, disturbance d" } else { "set-point r" };
    let mut list = vec![Entry { look: Look::Reference, text: text.to_owned() }];
    list.extend(
        loops.iter().map(|l| Entry { look: Look::Controller(l.index), text: l.spec.name.trim().to_owned() }),
    );
    let first = loops.first().map_or(0, |l| l.index);
    if shows_measurement(scenario) {
        list.push(Entry { look: Look::Faint(first), text: "measurement (faint)".to_owned() });
    }
    if let Some(l) = loops.iter().find(|l| shows_applied(l)) {
        list.push(Entry {
            look: Look::Applied(l.index),
            text: "applied by the actuator (dotted)".to_owned(),
        });
    }
    list
}

/// The line of an entry, from the left.
pub(super) fn sample(entry: &Entry, y: &str) -> Markup {
    html! { line class={ "l " (look(entry.look)) } x1="0" x2="30" y1=(y) y2=(y) {} }
}

/// What a line of these classes is, for a legend.
pub(super) fn line(class: &str, text: &str) -> Markup {
    html! {
        li {
            svg width="30" height="12" aria-hidden="true" { line class={ "l " (class) } x1="0" x2="30" y1="6" y2="6" {} }
            span { (text) }
        }
    }
}

/// What an area of this class is.
pub(super) fn area(class: &str, text: &str) -> Markup {
    html! {
        li {
            svg width="30" height="12" aria-hidden="true" { rect class=(class) x="4" width="22" y="0.5" height="11" {} }
            span { (text) }
        }
    }
}
