//! The page of an analysis: numbers, Bode and Nyquist plots, sensitivities, noise.

mod curves;
mod nyquist;
mod picture;

use super::card;
use super::commissioning;
use super::page::{document, notes};
use super::words;
use crate::analysis::Analysis;
use crate::output::Analysed;
use crate::output::table::{format_number, plant_text, rounded_numbers};
use curves::{Curves, curves, lowest};
use maud::{Markup, html};
use picture::{complementary, figure, magnitude, noise, phase, sensitivity};

/// The page as text.
pub(super) fn page(list: &[Analysed<'_>], command: &str) -> String {
    let heading = match list {
        [only] => title(only),
        several => format!("Loop analysis: {} cases", several.len()),
    };
    let several = list.len() > 1;
    let content = html! {
        main { @for (index, one) in list.iter().enumerate() { (chapter(index, one, several, true)) } }
    };
    document("Analysis of control loops", &heading, &content, command)
}

fn title(one: &Analysed<'_>) -> String {
    let title = match one.scenario.title.trim() {
        // Typed, or from the standard input.
        "" if one.name.starts_with('<') => {
            format!("Loop of the plant {}", rounded_numbers(&plant_text(one.scenario)))
        }
        "" => one.name.to_owned(),
        title => title.to_owned(),
    };
    one.case.map_or_else(|| title.clone(), |case| format!("{title}: {case}"))
}

/// The analysis of one case. The numbers are left out where they stand elsewhere.
pub(super) fn chapter(index: usize, one: &Analysed<'_>, several: bool, with_numbers: bool) -> Markup {
    let id = format!("loop-{}", index + 1);
    let numbers = with_numbers.then(|| format!("{id}-table"));
    let good: Vec<(usize, &Analysis)> = one
        .controllers
        .iter()
        .enumerate()
        .filter_map(|(i, result)| Some((i, result.as_ref().ok()?)))
        .collect();
    let low = good.iter().map(|(_, a)| lowest(a)).fold(f64::INFINITY, f64::min);
    let curves: Vec<Curves> = good.iter().map(|(i, a)| curves(*i, a, low)).collect();
    let units = [&one.scenario.units.u, &one.scenario.units.y].map(|unit| words::unit(unit));
    let heading = |text: &str| {
        if several {
            html! { h3 { (text) } }
        } else {
            html! { h2 { (text) } }
        }
    };
    let sub_heading = |text: &str| {
        if several {
            html! { h4 { (text) } }
        } else {
            html! { h3 { (text) } }
        }
    };
    let of = |name: &str| if several { format!("{name}, {}", title(one)) } else { name.to_owned() };
    let picture = |name: &str, panels: &[picture::Panel]| figure(&format!("{id}-{name}"), &curves, panels);
    html! {
        section class="run" {
            @if several { h2 { (title(one)) } }
            dl class="loop" {
                div { dt { "plant" } dd { (rounded_numbers(&plant_text(one.scenario))) } }
                div { dt { "ts" } dd { (words::number(one.scenario.ts)) " s" } }
                div { dt { "latency" } dd { (words::number(one.scenario.latency)) " s" } }
                div { dt { "Nyquist frequency" } dd { (format_number(core::f64::consts::PI / one.scenario.ts)) " rad/s" } }
            }
            @for (at, result) in one.controllers.iter().enumerate() {
                @match result {
                    Ok(a) => {
                        (heading(&a.name))
                        (notes(&a.warnings))
                        @let loop_card = one.cards.get(at).and_then(|card| card.as_ref().ok());
                        @match one.cards.get(at) {
                            Some(Ok(loop_card)) => (card::table(&format!("{id}-card-{}", at + 1), loop_card, &of(&a.name))),
                            Some(Err(why)) => (notes(&[format!("no loop card: {why}")])),
                            None => {}
                        }
                        @if let Some(numbers) = &numbers {
                            (commissioning::card(
                                &format!("{numbers}-{}", at + 1), one.scenario, one.scenario.controllers.get(at), a,
                                &of(&a.name), loop_card.is_none(),
                            ))
                        }
                        @if let Some(loop_card) = loop_card.filter(|_| !several) {
                            (card::trials(&format!("{id}-trial-{}", at + 1), loop_card, &|text| sub_heading(text)))
                        }
                    }
                    Err((name, why)) => (notes(&[format!("{name}: {why}")])),
                }
            }
            @if !curves.is_empty() {
                (heading("Loop gain"))
                (picture("bode", &[magnitude(&curves), phase(&curves)]))
                (heading("Nyquist plot"))
                (nyquist::plot(&format!("{id}-nyquist"), &curves))
                (heading("Sensitivity"))
                (picture("sensitivity", &[sensitivity(&curves), complementary(&curves)]))
                (heading("From measurement noise to the controller's output"))
                (picture("noise", &[noise(&curves, &units)]))
            }
        }
    }
}
