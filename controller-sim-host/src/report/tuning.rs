//! The page of a tuned loop: from the record to the loop that is put into service.

use super::page::document;
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
    let heading = format!("{} for the process of {}", tuning.made.method.title(), tuning.finding.source.name);
    let content = html! {
        main {
            (summary(tuning))
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
                (analysis::chapter(0, analysed, false))
            }
        }
    };
    document("Tuning of a control loop", &heading, &content, command)
}

/// What was chosen, what it promises, and what to know.
fn summary(tuning: &Tuning<'_>) -> Markup {
    let groups = tuning.groups();
    let notes = tuning.notes();
    let made = tuning.made;
    html! {
        @if !notes.is_empty() {
            div class="notes" role="note" { ul { @for note in &notes { li { (note) } } } }
        }
        section {
            h2 id="summary" { "For the commissioning file" }
            p { (made.method.title()) " (" (made.method.source()) "), for this model of the process, in which the loop is simulated, too:" }
            div class="scroll" role="region" tabindex="0" aria-label="Model of the process" {
                pre { code { (rounded_numbers(&made.plant.to_string())) } }
            }
            @for (title, rows) in &groups {
                div class="scroll" role="region" tabindex="0" aria-label=(title) {
                    table class="areas" {
                        thead { tr { th scope="col" class="text" { (title) } th scope="col" { "value" } } }
                        tbody {
                            @for (name, value) in rows {
                                tr { th scope="row" class="text" { (name) } td { (value) } }
                            }
                        }
                    }
                }
            }
        }
    }
}
