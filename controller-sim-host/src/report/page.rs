//! The page: what was run, what came of it, and how to repeat it.

use super::Chapter;
use super::chapter;
use super::glossary;
use super::overview::{Sweep, sweeps};
use super::standalone::STYLE;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const PAGE_STYLE: &str = include_str!("style/page.css");
/// Of what is marked in the pictures of records and of responses over frequency.
const DIAGRAM_STYLE: &str = include_str!("style/diagram.css");
/// Of curves and maps that are no runs.
const SHEET_STYLE: &str = include_str!("style/sheet.css");

/// The page as text.
pub(super) fn page(chapters: &[Chapter<'_>], command: &str) -> String {
    let several = chapters.len() > 1;
    let heading = match chapters {
        [only] => only.title(),
        several => format!("Simulation report: {} runs", several.len()),
    };
    let sweeps = sweeps(chapters);
    let content = html! {
        @if several { (contents(chapters, &sweeps)) }
        main {
            @for (index, sweep) in sweeps.iter().enumerate() {
                @let id = format!("sweep-{}", index + 1);
                section id=(id) aria-labelledby={ (id) "-heading" } {
                    h2 id={ (id) "-heading" } { (sweep.name()) }
                    (sweep.show(chapters, &id))
                }
            }
            @for index in 0..chapters.len() { (chapter::show(index, chapters)) }
        }
    };
    document("Simulation of control loops", &heading, &content, command)
}

/// A page: what kind it is, its heading, what it shows, and the command that made it.
pub(super) fn document(kind: &str, heading: &str, content: &Markup, command: &str) -> String {
    let text = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (heading) }
                style { (PreEscaped(STYLE)) (PreEscaped(PAGE_STYLE)) (PreEscaped(DIAGRAM_STYLE)) (PreEscaped(SHEET_STYLE)) }
            }
            body {
                header {
                    p class="kind" { (kind) }
                    h1 { (heading) }
                }
                (content)
                (glossary::section(&content.0))
                footer {
                    h2 id="command" { "How this page was made" }
                    (scroll("command", &html! { pre { code { (command) } } }))
                    p { "controller-sim " (env!("CARGO_PKG_VERSION")) }
                }
            }
        }
    };
    text.into_string()
}

/// What may be wider than the page, named by the element `heading`, or by several.
pub(super) fn scroll(heading: &str, content: &Markup) -> Markup {
    html! { div class="scroll" role="region" tabindex="0" aria-labelledby=(heading) { (content) } }
}

/// What to know before one trusts the figures; nothing when there is nothing.
pub(super) fn notes(list: &[String]) -> Markup {
    html! {
        @if !list.is_empty() {
            div class="notes" role="note" { ul { @for note in list { li { (note) } } } }
        }
    }
}

fn contents(chapters: &[Chapter<'_>], sweeps: &[Sweep<'_>]) -> Markup {
    html! {
        nav aria-label="Contents" {
            @if !sweeps.is_empty() {
                ul {
                    @for (index, sweep) in sweeps.iter().enumerate() {
                        li { a href={ "#sweep-" (index + 1) } { (sweep.name()) } }
                    }
                }
            }
            ol {
                @for (index, chapter) in chapters.iter().enumerate() {
                    li { a href={ "#run-" (index + 1) } { (chapter.title()) } }
                }
            }
        }
    }
}
