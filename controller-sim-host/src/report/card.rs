//! The loop card on a page: figures with their lights, and the runs they were tried in.

use super::page::{notes, scroll};
use super::{Chapter, chapter};
use crate::card::{Figure, Light, LoopCard, Trial};
use crate::output::card::shown;
use crate::output::precision_name;
use maud::{Markup, html};

/// The card itself. `id` is its own, `of` what is spoken.
pub(super) fn table(id: &str, card: &LoopCard, of: &str) -> Markup {
    let table = html! {
        table class="lights" {
            thead { tr {
                th scope="col" class="text" id=(id) { "Loop card" span class="spoken" { " of " (of) } }
                th scope="col" { "value" }
                th scope="col" class="text" { "unit" }
                th scope="col" class="text" { "light" }
                th scope="col" class="text" { "practice" }
            } }
            tbody { @for figure in &card.figures { (row(figure)) } }
        }
    };
    html! {
        p {
            "The law as it is deployed: " (precision_name(card.precision)) ", hold, dead time and latency. "
            (card.count(Light::Good)) " figures are good, " (card.count(Light::Look)) " to look at, "
            (card.count(Light::Bad)) " bad."
        }
        (scroll(id, &table))
        @if !card.absent.is_empty() {
            p class="absent" {
                "Without a figure: "
                @for (index, (key, why)) in card.absent.iter().enumerate() {
                    @if index > 0 { "; " }
                    (key.replace('_', " ")) ", " (why)
                }
                "."
            }
        }
    }
}

fn row(figure: &Figure) -> Markup {
    html! {
        tr {
            th scope="row" { (figure.title) }
            td { (shown(figure.value)) }
            td class="text unit" { (figure.unit) }
            td class="text" { (light(figure.light)) }
            td class="text practice" {
                (figure.practice)
                @if !figure.note.is_empty() { br; span class="unit" { (figure.note) } }
            }
        }
    }
}

/// A light: a mark of its own shape, a word, and a colour, which nobody needs.
fn light(light: Light) -> Markup {
    let (class, shape) = match light {
        Light::Good => ("good", "M2 8.5l4 4 8-9"),
        Light::Look => ("look", "M8 2l6.5 12h-13zM8 6.5v3.5M8 11.7v.6"),
        Light::Bad => ("bad", "M3 3l10 10M13 3L3 13"),
    };
    html! {
        span class={ "light " (class) } {
            svg width="14" height="14" viewBox="0 0 16 16" aria-hidden="true" { path d=(shape) {} }
            (light.word())
        }
    }
}

/// The runs of the card, below headings that `heading` makes.
pub(super) fn trials(id: &str, card: &LoopCard, heading: &dyn Fn(&str) -> Markup) -> Markup {
    html! {
        @for (index, trial) in card.trials.iter().enumerate() {
            (heading(trial.title))
            p { (trial.text) }
            (remarks(trial))
            (chapter::picture(&format!("{id}-{}", index + 1), &Chapter {
                name: &card.name,
                case: None,
                text: "",
                scenario: &trial.scenario,
                precision: card.precision,
                result: &trial.result,
                warnings: &[],
            }))
        }
    }
}

/// What to know of a run; that the output is at its limit where it was sent there goes without saying.
fn remarks(trial: &Trial) -> Markup {
    if trial.title.contains("limits") {
        return html! {};
    }
    let list: Vec<String> = trial.remarks().iter().map(|remark| remark.text.clone()).collect();
    notes(&list)
}
