//! The page of an analysis: numbers, Bode and Nyquist plots, sensitivities, noise.

mod curves;
mod nyquist;
mod picture;

use super::standalone::STYLE;
use super::words;
use crate::analysis::Analysis;
use crate::output::Analysed;
use crate::output::analysis::rows;
use curves::{Curves, curves, lowest};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use picture::{legend, picture};

const PAGE_STYLE: &str = include_str!("../style/page.css");

/// The page as text.
pub(super) fn page(list: &[Analysed<'_>], command: &str) -> String {
    let heading = match list {
        [only] => title(only),
        several => format!("Loop analysis: {} cases", several.len()),
    };
    let text = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (heading) }
                style { (PreEscaped(STYLE)) (PreEscaped(PAGE_STYLE)) }
            }
            body {
                header {
                    p class="kind" { "Analysis of control loops" }
                    h1 { (heading) }
                }
                main {
                    @for (index, one) in list.iter().enumerate() { (chapter(index, one, list.len() > 1)) }
                }
                footer {
                    h2 id="command" { "How this page was made" }
                    div class="scroll" role="region" tabindex="0" aria-labelledby="command" {
                        pre { code { (command) } }
                    }
                    p { "controller-sim " (env!("CARGO_PKG_VERSION")) }
                }
            }
        }
    };
    text.into_string()
}

fn title(one: &Analysed<'_>) -> String {
    let title = one.scenario.title.trim();
    let title = if title.is_empty() { one.name } else { title };
    one.case.map_or_else(|| title.to_owned(), |case| format!("{title}: {case}"))
}

pub(super) fn chapter(index: usize, one: &Analysed<'_>, several: bool) -> Markup {
    let id = format!("loop-{}", index + 1);
    let good: Vec<(usize, &Analysis)> = one
        .controllers
        .iter()
        .enumerate()
        .filter_map(|(i, result)| Some((i, result.as_ref().ok()?)))
        .collect();
    let low = good.iter().map(|(_, a)| lowest(a)).fold(f64::INFINITY, f64::min);
    let curves: Vec<Curves> = good.iter().map(|(i, a)| curves(*i, a, low)).collect();
    let units = [&one.scenario.units.u, &one.scenario.units.y].map(|unit| words::unit(unit));
    html! {
        section class="run" {
            @if several { h2 { (title(one)) } }
            dl class="loop" {
                div { dt { "plant" } dd { (one.scenario.plant) } }
                div { dt { "ts" } dd { (one.scenario.ts) " s" } }
                div { dt { "latency" } dd { (one.scenario.latency) " s" } }
                div { dt { "Nyquist frequency" } dd { (words::number(core::f64::consts::PI / one.scenario.ts)) " rad/s" } }
            }
            @for result in &one.controllers {
                @match result {
                    Ok(a) => (numbers(a)),
                    Err((name, why)) => div class="notes" { p { (name) ": " (why) } },
                }
            }
            @if !curves.is_empty() {
                h2 { "Loop gain" }
                (legend(&curves))
                (picture(&format!("{id}-bode"), &picture::magnitude(&curves)))
                (picture(&format!("{id}-phase"), &picture::phase(&curves)))
                p class="unit" { "The loop is broken at the plant input. The sampled law ends at the Nyquist frequency." }
                h2 { "Nyquist plot" }
                (legend(&curves))
                (nyquist::plot(&format!("{id}-nyquist"), &curves))
                h2 { "Sensitivity" }
                (legend(&curves))
                (picture(&format!("{id}-s"), &picture::sensitivity(&curves)))
                (picture(&format!("{id}-t"), &picture::complementary(&curves)))
                h2 { "From measurement noise to the controller's output" }
                (legend(&curves))
                (picture(&format!("{id}-noise"), &picture::noise(&curves, &units)))
            }
        }
    }
}

fn numbers(a: &Analysis) -> Markup {
    html! {
        h2 { (a.name) }
        @if !a.warnings.is_empty() {
            div class="notes" { ul { @for warning in &a.warnings { li { (warning) } } } }
        }
        div class="scroll" role="region" tabindex="0" aria-label={ "Margins and noise of " (a.name) } {
            table {
                thead { tr {
                    th scope="col" class="text" { "Margins and noise" }
                    th scope="col" { "continuous" }
                    th scope="col" { "sampled" }
                } }
                tbody {
                    @for (what, unit, c, d) in rows(a) {
                        tr {
                            th scope="row" {
                                (if what.is_empty() { "delay margin" } else { what })
                                @if !unit.is_empty() { " " span class="unit" { "[" (unit) "]" } }
                            }
                            td { (c) }
                            td { (d) }
                        }
                    }
                }
            }
        }
    }
}
