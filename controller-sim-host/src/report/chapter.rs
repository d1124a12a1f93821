//! A run on the page.

use super::describe::{description, title};
use super::drawing::{draw, loops, pixel, shown};
use super::legend::{entries, sample};
use super::panels::estimate_from;
use super::{Chapter, parameters, tables, words};
use crate::output::table::remarks;
use crate::scenario::{ControllerSpec, Fault, show_short};
use maud::{Markup, html};

/// Tallest picture that fits a sheet of paper with its caption \[px\].
const SHEET: f64 = 880.0;
/// Most events that are listed.
const EVENTS: usize = 200;

/// The chapter `index` of a page: one of several is numbered, below the title of the page.
pub(super) fn show(index: usize, chapters: &[Chapter<'_>]) -> Markup {
    let Some(chapter) = chapters.get(index) else { return html! {} };
    let numbered = chapters.len() > 1;
    // The cases of a sweep have one text.
    let shown = chapters.iter().position(|other| (other.name, other.text) == (chapter.name, chapter.text));
    let id = format!("run-{}", index + 1);
    // The headings of a single run stand directly below that of the page.
    // Of several runs, each region is named after its run, too.
    let named = |key: &str| if numbered { format!("{id}-heading {id}-{key}") } else { format!("{id}-{key}") };
    let part = |name: &str, key: &str| heading(if numbered { 3 } else { 2 }, &format!("{id}-{key}"), name);
    html! {
        section id=(id) class="run" aria-label=[(!numbered).then(|| chapter.title())]
            aria-labelledby=[numbered.then(|| format!("{id}-heading"))] {
            @if numbered { (heading(2, &format!("{id}-heading"), &format!("{}. {}", index + 1, chapter.title()))) }
            @for paragraph in paragraphs(&chapter.scenario.description) { p class="lead" { (paragraph) } }
            (notes(chapter))
            (part("Response", "response"))
            (picture(&format!("figure-{}", index + 1), chapter))
            @if !chapter.scenario.events.is_empty() {
                (part("Events", "events"))
                (events(chapter, &named("events")))
            }
            (part("Metrics", "metrics"))
            (tables::metrics(chapter, &named("metrics")))
            (part("Loop and parameters", "parameters"))
            (loop_and_parameters(chapter, &named("parameters")))
            (part("Scenario", "scenario"))
            @if let Some(case) = chapter.case { p { "Run with " code { (case) } "." } }
            @if let Some(earlier) = shown.filter(|shown| *shown < index) {
                p { "The text is that of " a href={ "#run-" (earlier + 1) "-scenario" } { "run " (earlier + 1) } "." }
            } @else {
                details {
                    summary { "Text of " (chapter.name) }
                    div class="scroll" role="region" tabindex="0" aria-labelledby=(named("scenario")) {
                        pre { code { (chapter.text) } }
                    }
                }
            }
        }
    }
}

fn heading(level: u8, id: &str, text: &str) -> Markup {
    match level {
        2 => html! { h2 id=(id) { (text) } },
        _ => html! { h3 id=(id) { (text) } },
    }
}

/// The paragraphs of a text: empty lines divide them.
fn paragraphs(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let parts = lines.split(|line| line.is_empty()).map(|lines| lines.join(" "));
    parts.filter(|part| !part.is_empty()).collect()
}

/// Warnings of the scenario and remarks on the run.
fn notes(chapter: &Chapter<'_>) -> Markup {
    let remarks: Vec<(&str, &str)> = remarks(chapter.result).collect();
    if remarks.is_empty() && chapter.warnings.is_empty() {
        return html! {};
    }
    html! {
        div class="notes" role="note" aria-label="Warnings and remarks" {
            p { strong { "Before you trust the figures" } }
            ul {
                @for warning in chapter.warnings { li { (place(chapter, warning)) ": " (warning.message)
                    @if let Some(help) = &warning.help { " (" (help) ")" } } }
                @for (name, text) in remarks { li { (name) ": " (text) } }
            }
        }
    }
}

fn place(chapter: &Chapter<'_>, fault: &Fault) -> String {
    let line = fault.place(chapter.text).line;
    match &fault.source {
        Some(source) => format!("{}, line {line}", source.name),
        None => format!("Line {line}"),
    }
}

/// The picture of a run with its legend.
pub(super) fn picture(id: &str, chapter: &Chapter<'_>) -> Markup {
    let loops = loops(chapter);
    if loops.is_empty() {
        return html! { p { "The run was not recorded: there is no picture." } };
    }
    let drawing = draw(chapter, &loops);
    let (from, to) = shown(chapter, &loops);
    let part = from > 0.0 || to < chapter.scenario.duration * (1.0 - 1e-9);
    let shrink = (drawing.height > SHEET).then(|| format!("--sheet:{:.3}", SHEET / drawing.height));
    let wide = loops.iter().any(|l| l.record.samples > 1);
    html! {
        figure class="plot" id=(id) {
            ul class="legend" {
                @for entry in entries(chapter.scenario, &loops) {
                    li {
                        svg width="30" height="12" aria-hidden="true" { (sample(&entry, "6")) }
                        span { (entry.text) }
                    }
                }
            }
            svg class="canvas" height=(pixel(drawing.height)) style=[shrink] role="img"
                aria-labelledby={ (id) "-title " (id) "-desc" } {
                title id={ (id) "-title" } { (title(chapter, &loops)) }
                desc id={ (id) "-desc" } { (description(chapter, &loops)) }
                (drawing.content)
            }
            figcaption {
                @if part {
                    strong { "Only " (show_short(from)) " s to " (show_short(to)) " s of " (show_short(chapter.scenario.duration)) " s. " }
                }
                "Set-point, measurement and output are held between the samples."
                @if wide {
                    " Each column stands for "
                    (loops.first().map_or(1, |l| l.record.samples))
                    " samples and covers all of their values."
                }
                @if let Some(at_rest) = estimate_from(chapter.scenario, &loops) {
                    " The disturbance is drawn without that of the operating point, d(0) = "
                    (format!("{} {}", words::number(at_rest), words::unit(&chapter.scenario.units.u)).trim_end())
                    ": the estimate d_hat is counted from the beginning of the run, too."
                }
                @if !chapter.scenario.events.is_empty() { " The numbers above are those of the events." }
            }
        }
    }
}

fn events(chapter: &Chapter<'_>, heading: &str) -> Markup {
    let scenario = chapter.scenario;
    let only =
        |index: Option<usize>| index.and_then(|index| scenario.controllers.get(index)).map(|one| &*one.name);
    let some_only = scenario.events.iter().any(|event| event.controller.is_some());
    let left_out = scenario.events.len().saturating_sub(EVENTS);
    html! {
        div class="scroll" role="region" tabindex="0" aria-labelledby=(heading) {
            table class="events" {
                thead {
                    tr {
                        th scope="col" { "no." }
                        th scope="col" { "time" br; span class="unit" { "s" } }
                        th scope="col" class="text" { "what happens" }
                        @if some_only { th scope="col" class="text" { "to" } }
                    }
                }
                tbody {
                    @for (index, event) in scenario.events.iter().take(EVENTS).enumerate() {
                        tr {
                            th scope="row" { span class="badge" { (index + 1) } }
                            td { (words::number(event.at)) }
                            td class="text" {
                                @let changes = words::changes(scenario, event);
                                @if event.label.trim().is_empty() { (changes) }
                                @else { strong { (event.label.trim()) } ": " (changes) }
                            }
                            @if some_only { td class="text" { (only(event.controller).unwrap_or("all")) } }
                        }
                    }
                }
            }
        }
        @if left_out > 0 { p { (left_out) " more events are not listed." } }
    }
}

fn loop_and_parameters(chapter: &Chapter<'_>, heading: &str) -> Markup {
    let mut specs: Vec<(String, &ControllerSpec)> = Vec::new();
    for spec in &chapter.scenario.controllers {
        specs.push((spec.name.clone(), spec));
        if let Some(inner) = &spec.secondary {
            specs.push((format!("{}, inner loop", spec.name), inner));
        }
    }
    let list: Vec<&ControllerSpec> = specs.iter().map(|(_, spec)| *spec).collect();
    html! {
        dl class="loop" {
            @for (name, value) in parameters::shared(chapter.scenario, chapter.precision) {
                div { dt { (name) } dd { (value) } }
            }
        }
        div class="scroll" role="region" tabindex="0" aria-labelledby=(heading) {
            table class="parameters" {
                caption { "Parameters at the start" }
                thead {
                    tr {
                        th scope="col" class="text" { "parameter" }
                        th scope="col" class="text" { "unit" }
                        @for (name, _) in &specs { th scope="col" { (name) } }
                    }
                }
                tbody {
                    @for line in parameters::lines(&list, chapter.scenario) {
                        tr {
                            th scope="row" { (line.name) }
                            td class="text unit" { (line.unit) }
                            @for value in &line.values { td { (value) } }
                        }
                    }
                }
            }
        }
    }
}
