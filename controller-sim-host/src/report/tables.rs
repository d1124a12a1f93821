//! The metrics of a run, with the numbers and the marks of the table on the terminal.

use super::Chapter;
use crate::output::table::{Block, COLUMNS, best, blocks, format_number, values};
use crate::scenario::Units;
use maud::{Markup, html};

/// Most windows that are listed; a run with more is read from its JSON.
const MOST: usize = 60;

/// The windows from event to event, and the whole run, in one table.
pub(super) fn metrics(chapter: &Chapter<'_>, heading: &str) -> Markup {
    let all = blocks(chapter.result);
    let (windows, whole) = match all.split_last() {
        Some((whole, windows)) if !windows.is_empty() => (windows, Some(whole)),
        _ => (&all[..], None),
    };
    let left_out = windows.len().saturating_sub(MOST);
    let units = &chapter.scenario.units;
    html! {
        p {
            "From event to event"
            @if whole.is_some() { ", then the whole run" }
            ". "
            @if chapter.result.controllers.len() > 1 { "The best of each column is bold and has a star. " }
            "IE is the sum over the samples, the others are of the error between the samples, too."
        }
        div class="scroll" role="region" tabindex="0" aria-labelledby=(heading) {
            table class="metrics" {
                thead {
                    tr {
                        th scope="col" class="text" { "controller" }
                        @for column in COLUMNS {
                            th scope="col" { (column) br; span class="unit" { (unit(column, units)) } }
                        }
                    }
                }
                @for block in windows.iter().take(MOST).chain(whole) { (body(block)) }
            }
        }
        @if left_out > 0 {
            p { (left_out) " more windows are not shown; the JSON output has them." }
        }
    }
}

fn body(block: &Block<'_>) -> Markup {
    let best = best(block);
    let mut title = block.title.clone();
    if let Some(first) = title.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    html! {
        tbody {
            tr { th scope="rowgroup" colspan=(COLUMNS.len() + 1) class="window" { span { (title) } } }
            @for (name, metrics) in &block.lines {
                tr {
                    th scope="row" { (name) }
                    @for (value, best) in values(metrics).into_iter().zip(&best) {
                        @let text = format_number(value);
                        @if best.as_ref() == Some(&text) {
                            td class="best" {
                                strong { (text) }
                                span aria-hidden="true" { "*" }
                                span class="spoken" { " best" }
                            }
                        } @else {
                            td { (text) }
                        }
                    }
                }
            }
        }
    }
}

/// The unit of a column, from those of the scenario.
pub(super) fn unit(column: &str, units: &Units) -> String {
    let name = |unit: &str, symbol: &str| {
        if unit.trim().is_empty() { symbol.to_owned() } else { super::words::unit(unit) }
    };
    let (y, u) = (name(&units.y, "y"), name(&units.u, "u"));
    match column {
        "IAE" | "IE" => format!("{y} s"),
        "ISE" => format!("{y}\u{b2} s"),
        "ITAE" => format!("{y} s\u{b2}"),
        "e_max" => y,
        _ => u,
    }
}
