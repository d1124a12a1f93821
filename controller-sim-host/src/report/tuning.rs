//! The page of a tuned loop: from the record to the loop that is put into service.

use super::commissioning::card;
use super::page::{self, document, scroll};
use super::{Chapter, analysis, chapter, identification};
use crate::output::table::rounded_numbers;
use crate::output::{Analysed, Tuning};
use maud::{Markup, html};

/// The page as text.
pub(super) fn page(
    tuning: &Tuning<'_>,
    chapter: &Chapter<'_>,
    analysed: &Analysed<'_>,
    command: &str,
) -> String {
    let heading = chapter.scenario.title.clone();
    let content = html! {
        main {
            (summary(tuning, chapter, analysed))
            section {
                h2 id="process" { "The process" }
                (identification::sections(&tuning.finding))
            }
            section {
                h2 id="loop" { "The loop" }
                p {
                    "Simulated with the law that is flashed: the set-point changes as the record did, then a load of a "
                    "fifth of the recorded change of the input acts at the plant's input."
                }
                (chapter::show(0, std::slice::from_ref(chapter)))
            }
            section {
                h2 id="margins" { "Robustness and noise" }
                (analysis::chapter(0, analysed, false, false))
            }
        }
    };
    document("Tuning of a control loop", &heading, &content, command)
}

/// What was chosen, what it promises, and what to know.
fn summary(tuning: &Tuning<'_>, chapter: &Chapter<'_>, analysed: &Analysed<'_>) -> Markup {
    let notes: Vec<String> = tuning.notes().iter().map(|note| rounded_numbers(note)).collect();
    let made = tuning.made;
    let scenario = chapter.scenario;
    let simulated = html! {
        table class="areas" {
            thead { tr {
                th scope="col" class="text" id="simulated" { "Simulated" }
                th scope="col" { "value" }
                th scope="col" class="text" { "unit" }
            } }
            tbody {
                @for (name, value, unit) in tuning.simulated(&scenario.units.y) {
                    tr { th scope="row" { (name) } td { (value) } td class="text unit" { (unit) } }
                }
            }
        }
    };
    html! {
        (page::notes(&notes))
        section {
            h2 id="summary" { "For the commissioning file" }
            p { (made.method.title()) " (" (made.method.source()) "), for this model of the process, in which the loop is simulated, too:" }
            div class="scroll" role="region" tabindex="0" aria-label="Model of the process" {
                pre { code { (rounded_numbers(&made.plant.to_string())) } }
            }
            @for (result, spec) in analysed.controllers.iter().zip(&scenario.controllers) {
                @match result {
                    Ok(analysis) => (card("summary-numbers", scenario, Some(spec), analysis, &analysis.name, true)),
                    Err((name, why)) => (page::notes(&[format!("{name}: {why}")])),
                }
            }
            (scroll("simulated", &simulated))
        }
    }
}
