//! A sweep at one glance: the metric of each controller against the value that is swept.

use super::Chapter;
use super::drawing::{BELOW, controller, percent, pixel};
use super::scale::Axis;
use super::tables::unit;
use super::words;
use crate::output::table::format_number;
use crate::scenario::Scenario;
use maud::{Markup, html};

/// Height of the picture without its axis \[px\].
const HEIGHT: f64 = 220.0;
/// Space above and below \[px\].
const TOP: f64 = 30.0;
const BOTTOM: f64 = BELOW;

/// The runs of one file over one key.
#[derive(Debug)]
pub(super) struct Sweep<'a> {
    key: &'a str,
    /// The values with the places of their chapters, values rising.
    points: Vec<(f64, usize)>,
    first: &'a Chapter<'a>,
}

/// The sweeps among the chapters, with at least two numbers each.
pub(super) fn sweeps<'a>(chapters: &'a [Chapter<'a>]) -> Vec<Sweep<'a>> {
    let mut list: Vec<Sweep<'a>> = Vec::new();
    for (index, chapter) in chapters.iter().enumerate() {
        let label = chapter.case.and_then(|case| case.split_once('='));
        let Some((key, value)) = label.map(|(key, value)| (key.trim(), value.trim().parse::<f64>())) else {
            continue;
        };
        let Some(value) = value.ok().filter(|value| value.is_finite()) else { continue };
        match list.iter_mut().find(|sweep| sweep.key == key && sweep.first.name == chapter.name) {
            Some(sweep) => sweep.points.push((value, index)),
            None => list.push(Sweep { key, points: vec![(value, index)], first: chapter }),
        }
    }
    for sweep in &mut list {
        sweep.points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    }
    list.retain(|sweep| sweep.points.len() > 1);
    list
}

impl Sweep<'_> {
    /// What the sweep is called.
    pub(super) fn name(&self) -> String {
        let title = self.scenario().title.trim();
        let title = if title.is_empty() { self.first.name } else { title };
        format!("{title}: {} swept", self.key)
    }

    fn scenario(&self) -> &Scenario {
        self.first.scenario
    }

    fn iae(&self, chapters: &[Chapter<'_>], at: usize, controller: usize) -> f64 {
        let result = chapters.get(at).and_then(|chapter| chapter.result.controllers.get(controller));
        result.map_or(f64::NAN, |one| one.total.iae)
    }

    /// The picture and the table behind it.
    pub(super) fn show(&self, chapters: &[Chapter<'_>], id: &str) -> Markup {
        let controllers = &self.scenario().controllers;
        let unit = unit("IAE", &self.scenario().units);
        html! {
            figure class="plot" {
                ul class="legend" {
                    @for (index, one) in controllers.iter().enumerate() {
                        li {
                            svg width="30" height="12" aria-hidden="true" {
                                line class={ "l " (controller(index)) } x1="0" x2="30" y1="6" y2="6" {}
                                (point(index, "15", 6.0))
                            }
                            span { (one.name) }
                        }
                    }
                }
                svg class="canvas" height=(pixel(TOP + HEIGHT + BOTTOM)) role="img"
                    aria-labelledby={ (id) "-title " (id) "-desc" } {
                    title id={ (id) "-title" } { "IAE against " (self.key) }
                    desc id={ (id) "-desc" } { "The same numbers are in the table below." }
                    (self.draw(chapters, &unit))
                }
                figcaption { "IAE of the whole run against " (self.key) "." }
            }
            div class="scroll" role="region" tabindex="0" aria-labelledby={ (id) "-table" } {
                table {
                    caption id={ (id) "-table" } { "IAE of the whole run [" (unit) "]" }
                    thead { tr {
                        th scope="col" { (self.key) }
                        @for one in controllers { th scope="col" { (one.name) } }
                    } }
                    tbody {
                        @for (value, at) in &self.points {
                            tr {
                                th scope="row" { a href={ "#run-" (at + 1) } { (words::number(*value)) } }
                                @for index in 0..controllers.len() {
                                    td { (format_number(self.iae(chapters, *at, index))) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    fn draw(&self, chapters: &[Chapter<'_>], unit: &str) -> Markup {
        let count = self.scenario().controllers.len();
        let numbers = || {
            let of = |at: usize| (0..count).map(move |index| self.iae(chapters, at, index));
            self.points.iter().flat_map(move |(_, at)| of(*at)).filter(|x| x.is_finite())
        };
        let range = |mut list: Box<dyn Iterator<Item = f64> + '_>| {
            let first = list.next()?;
            Some(list.fold((first, first), |(lo, hi), x| (lo.min(x), hi.max(x))))
        };
        let keys = Axis::of_sizes(range(Box::new(self.points.iter().map(|(value, _)| *value))), 6);
        let values = Axis::of_sizes(range(Box::new(numbers())), 5);
        let bottom = TOP + HEIGHT;
        let y = |share: f64| bottom - share * HEIGHT;
        let places = |index: usize| {
            let of = move |at: usize| self.iae(chapters, at, index);
            let finite = self.points.iter().map(move |(value, at)| (*value, of(*at)));
            finite.filter(|(_, iae)| iae.is_finite()).collect::<Vec<_>>()
        };
        html! {
            g class="grid" {
                @for tick in &values.ticks { line x1="0" x2="100%" y1=(pixel(y(tick.share))) y2=(pixel(y(tick.share))) {} }
                @for tick in &keys.ticks { line x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(TOP)) y2=(pixel(bottom)) {} }
            }
            text class="title" x=(pixel(-super::drawing::LEFT)) y=(pixel(TOP - 11.0)) { "IAE" (values.unit(unit)) }
            @for tick in &values.ticks { text class="n" x="-7" y=(pixel(y(tick.share) + 4.0)) { (tick.label) } }
            @for tick in &keys.ticks { text class="t" x=(percent(tick.share)) y=(pixel(bottom + 17.0)) { (tick.label) } }
            line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
            text class="title t" x="50%" y=(pixel(bottom + 36.0)) { (words::cut(self.key, 40)) (keys.unit("")) }
            @for index in 0..count {
                @for pair in places(index).windows(2) {
                    line class={ "l " (controller(index)) }
                        x1=(percent(keys.share(pair[0].0))) y1=(pixel(y(values.share(pair[0].1))))
                        x2=(percent(keys.share(pair[1].0))) y2=(pixel(y(values.share(pair[1].1)))) {}
                }
                @for (value, iae) in places(index) {
                    (point(index, &percent(keys.share(value)), y(values.share(iae))))
                }
            }
        }
    }
}

/// The mark of a controller: shapes tell what colours may not.
fn point(index: usize, x: &str, y: f64) -> Markup {
    let shape = match index % 4 {
        0 => "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
        1 => "M-3.6-3.6h7.2v7.2h-7.2z",
        2 => "M0-4.8L4.6 3.4H-4.6z",
        _ => "M0-5L5 0L0 5L-5 0z",
    };
    html! {
        svg class="p" x=(x) y=(pixel(y)) { path class={ "point " (controller(index)) } d=(shape) {} }
    }
}
