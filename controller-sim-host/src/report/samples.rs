//! The page of a study of samples: what was drawn, how many loops are unstable, how margins and indices are distributed.

use super::drawing::{BELOW, below, controller, pixel};
use super::frame::{Frame, Line, TITLE, range};
use super::legend;
use super::page::{document, notes, scroll};
use super::path::Between;
use super::scale::Axis;
use crate::batch::sample::{Cause, Group, Measure};
use crate::output::Sampled;
use crate::output::sampled::{HEADS, events, share, statistics};
use crate::output::table::{format_number, rounded_numbers};
use maud::{Markup, html};

/// Height of a panel \[px\].
const HEIGHT: f64 = 150.0;
/// Most measures that are drawn; the tables have all.
const MOST: usize = 60;

/// The page as text; `name` is that of the scenario.
pub(super) fn page(made: &Sampled<'_>, name: &str, command: &str) -> String {
    let title = made.of.map_or("", |study| study.scenario.title.trim());
    let heading = format!("Robustness of {}", if title.is_empty() { name } else { title });
    let groups = made.summary.groups();
    let measures = groups.first().map_or(0, |group| group.measures.len());
    let content = html! {
        main {
            section class="run" {
                p { (made.counts()) "." }
                (notes(made.warnings))
                (drawn(made))
                h2 id="stability" { "Unstable loops" }
                ul { @for group in groups { li { (group.controller) ": " (share(group)) } } }
                p {
                    "A loop is unstable when the sampled closed loop has poles outside the unit circle or on it. What follows is "
                    "of stable loops."
                }
                (causes(made.summary.causes()))
                @for (index, group) in groups.iter().enumerate() {
                    @let id = format!("controller-{}", index + 1);
                    h2 id=(id) { (group.controller) }
                    (table(group, &id))
                }
                h2 id="distributions" { "Distributions" }
                p { "The share of loops up to a value: steep where many loops are, and further left is better, but for margins." }
                (names(groups))
                @for index in 0..measures.min(MOST) { (picture(made, index)) }
                @if measures > MOST { p { (measures - MOST) " more are in the tables only." } }
            }
        }
    };
    document("Robustness of control loops", &heading, &content, command)
}

fn drawn(made: &Sampled<'_>) -> Markup {
    let Some(study) = made.of else { return html! {} };
    let quantities = &study.drawn.quantities;
    html! {
        h2 id="drawn" { "What was drawn" }
        p {
            (study.drawn.samples) " samples from the seed " (study.drawn.seed) " around "
            (rounded_numbers(&study.scenario.plant.to_string())) "."
            @if study.has_noise() { " Each sample has a seed of its own for the noise." }
        }
        @if !quantities.is_empty() {
            (scroll("drawn", &html! {
                table class="metrics" {
                    thead { tr {
                        th scope="col" class="text" { "quantity" }
                        @for head in ["nominal", "from", "to", "distribution"] { th scope="col" { (head) } }
                    } }
                    tbody { @for quantity in quantities { tr {
                        th scope="row" { (quantity.name) }
                        td { (if quantity.nominal.is_finite() { format_number(quantity.nominal) } else { "none".to_owned() }) }
                        td { (format_number(quantity.ends.0)) }
                        td { (format_number(quantity.ends.1)) }
                        td { (quantity.spread.distribution.name()) }
                    } } }
                }
            }))
        }
        p { @for (i, event) in events(study).iter().enumerate() { @if i > 0 { "; " } "e" (i + 1) ": " (event) } "." }
    }
}

fn causes(list: &[Cause]) -> Markup {
    html! {
        @if !list.is_empty() {
            ul { @for cause in list { li {
                (cause.controller) ", " (cause.rows) " " (cause.status) ", first sample " (cause.sample) ": " (cause.reason)
            } } }
        }
    }
}

fn table(group: &Group, id: &str) -> Markup {
    scroll(
        id,
        &html! {
            table class="metrics" {
                thead { tr {
                    th scope="col" class="text" { "stable loops" }
                    @for head in HEADS { th scope="col" { (head) } }
                } }
                tbody { @for measure in &group.measures {
                    @if let Some(numbers) = statistics(measure) { tr {
                        th scope="row" { (measure.name) }
                        @for x in numbers { td { (format_number(x)) } }
                        td { @if let Some(worst) = measure.worst { "#" (worst.sample) } }
                    } }
                } }
            }
        },
    )
}

fn names(groups: &[Group]) -> Markup {
    html! {
        div class="plot" { ul class="legend" {
            @for (index, group) in groups.iter().enumerate() { (legend::line(&controller(index), &group.controller)) }
        } }
    }
}

/// What a column is called.
fn title(name: &str) -> String {
    let known = match name {
        "ms" => "Ms, largest sensitivity",
        "mt" => "Mt, largest complementary sensitivity",
        "gm" => "gain margin",
        "pm_deg" => "phase margin [\u{b0}]",
        "delay_margin" => "delay margin [s]",
        _ => "",
    };
    match name.split_once('_') {
        _ if !known.is_empty() => known.to_owned(),
        Some((event, "e_max")) => format!("{event}: largest error"),
        Some((event, index)) => format!("{event}: {}", index.to_uppercase()),
        None => name.to_owned(),
    }
}

/// The cumulative distributions of one measure.
fn picture(made: &Sampled<'_>, index: usize) -> Markup {
    let groups = made.summary.groups();
    let all: Vec<(usize, &Measure)> =
        groups.iter().enumerate().filter_map(|(i, group)| Some((i, group.measures.get(index)?))).collect();
    let curves: Vec<(String, Vec<(f64, f64)>)> = all
        .iter()
        .filter_map(|(i, measure)| {
            let first = (measure.sketch.min()?, 0.0);
            let rest = measure.sketch.cumulative().into_iter().map(|(x, share)| (x, 100.0 * share));
            let finite = std::iter::once(first).chain(rest).filter(|(x, _)| x.is_finite());
            Some((controller(*i), finite.collect()))
        })
        .collect();
    let ends = range(curves.iter().flat_map(|(_, points)| points.iter().map(|(x, _)| *x)));
    let (Some(ends), Some((_, first))) = (ends, all.first()) else { return html! {} };
    let axis = Axis::of_sizes(Some(ends), 7);
    let frame = Frame::new(&axis, Some((0.0, 100.0)), TITLE, HEIGHT);
    let lines: Vec<Line<'_>> =
        curves.iter().map(|(class, points)| Line { class, points, between: Between::Held }).collect();
    let id = format!("cdf-{}", first.name);
    html! {
        figure class="plot" id=(id) {
            svg class="canvas" height=(pixel(frame.bottom() + BELOW)) role="img" aria-labelledby={ (id) "-title" } {
                title id={ (id) "-title" } { "Share of loops up to a value of " (first.name) }
                (frame.grid("share of loops [%]"))
                (frame.lines(&lines))
                (below(&axis, frame.bottom(), &title(&first.name), ""))
            }
        }
    }
}
