//! Figures that are not runs: curves over any axis, and maps with contour lines, one or several panels of them.
//!
//! Panels are drawn as the pictures of runs are: shares of the width from left to right, pixels from above.

mod curves;
mod labels;
mod map;
mod page;
mod svg;

pub use curves::{Curve, Look};
pub use map::{Map, Mark, Sign};
pub(crate) use page::page;
pub(crate) use svg::svg;

use super::drawing::{BELOW, Drawing, LEFT, RIGHT, below, grid, pixel};
use super::scale::Axis;
use super::words;
use maud::{Markup, html};

/// Height of a line of text \[px\].
const LINE: f64 = 16.0;
/// Space between the title or the legend and the panel \[px\].
const GAP: f64 = 10.0;

/// A figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// What it is.
    pub title: String,
    /// What to know of it: sentences.
    pub text: Vec<String>,
    /// How many panels stand side by side where there is room, 1 to 3.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// An axis as it is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scale {
    /// What it is.
    pub name: String,
    /// Its unit; may be empty.
    pub unit: String,
    /// Equal ratios are equally long, where all numbers are above 0.
    pub log: bool,
}

impl Scale {
    /// An axis with equal steps.
    #[must_use]
    pub fn linear(name: &str, unit: &str) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), log: false }
    }

    /// An axis with equal ratios.
    #[must_use]
    pub fn log(name: &str, unit: &str) -> Self {
        Self { log: true, ..Self::linear(name, unit) }
    }
}

/// A panel of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Its axis from left to right.
    pub x: Scale,
    /// Its upright axis.
    pub y: Scale,
    /// What is drawn.
    pub content: Content,
}

/// What a panel shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Lines and points.
    Curves(Vec<Curve>),
    /// Contour lines.
    Map(Map),
}

/// The width that a panel has at least, by the number of columns \[px\]; on a telephone less, for one column.
fn nominal(columns: usize) -> f64 {
    match columns {
        0 | 1 => 700.0,
        2 => 330.0,
        _ => 200.0,
    }
}

fn height_of(columns: usize) -> f64 {
    match columns {
        0 | 1 => 320.0,
        2 => 250.0,
        _ => 200.0,
    }
}

/// The axis from the least to the largest of these numbers, exactly.
fn exact(range: (f64, f64), log: bool, most: usize) -> Axis {
    if log && range.0 > 0.0 { Axis::of_frequencies(range) } else { Axis::of_time(range.0, range.1, most) }
}

/// Draws the panels of a sheet, their legends of equal height so that they stand side by side.
fn drawings(sheet: &Sheet) -> Vec<Drawing> {
    let lines = |panel: &Panel| match &panel.content {
        Content::Curves(list) => curves::legend(list).len(),
        Content::Map(_) => 0,
    };
    let most = sheet.panels.iter().map(lines).max().unwrap_or(0);
    sheet.panels.iter().map(|panel| draw(panel, sheet.columns, most)).collect()
}

/// Draws a panel for as many columns, below room for a legend of `lines`.
fn draw(panel: &Panel, columns: usize, lines: usize) -> Drawing {
    let size = (nominal(columns), height_of(columns));
    let most = if columns > 2 { 5 } else { 9 };
    let x = exact(panel.horizontal().unwrap_or((0.0, 1.0)), panel.x.log, most);
    let (inner, y, legend, caption) = match &panel.content {
        Content::Curves(list) => {
            let (y, inner) = curves::inner(list, &x, panel.y.log, size.1);
            (inner, y, curves::legend(list), String::new())
        }
        Content::Map(map) => {
            let (y, inner, caption) = map::inner(map, &x, panel.y.log, size);
            (inner, y, Vec::new(), caption)
        }
    };
    let is_map = matches!(panel.content, Content::Map(_));
    let top = 14.0 + LINE * lines as f64 + GAP;
    let bottom = top + size.1;
    let y_name = format!("{}{}", panel.y.name, y.unit(&panel.y.unit));
    let title = if is_map || panel.title.is_empty() {
        panel.title.clone()
    } else {
        format!("{}: {y_name}", panel.title)
    };
    let title = if title.is_empty() { y_name.clone() } else { title };
    let content = html! {
        (grid(&y, &x, (top, size.1), "", ""))
        text class="title" x=(pixel(-LEFT)) y="13" { (words::cut(&title, ((size.0 + BESIDE) / 6.6) as usize)) }
        @for (row, (class, marker, name)) in legend.iter().enumerate() {
            @let at = 14.0 + LINE * (row as f64 + 1.0);
            @if *marker != Look::Points { line class={ "l " (class) } x1="0" x2="30" y1=(pixel(at - 4.0)) y2=(pixel(at - 4.0)) {} }
            @if *marker != Look::Line { circle class={ "point " (class) } cx="15" cy=(pixel(at - 4.0)) r="3.5" {} }
            text x="36" y=(pixel(at)) { (words::cut(name, ((size.0 + RIGHT - 36.0) / 5.8) as usize)) }
        }
        svg class="p" y=(pixel(top)) width="100%" height=(pixel(size.1)) { (inner) }
        @if is_map {
            text class="title t" transform={ "translate(-52," (pixel(top + 0.5 * size.1)) ") rotate(-90)" } {
                (words::cut(&y_name, (size.1 / 6.0) as usize))
            }
            line class="axis" x1="0" x2="0" y1=(pixel(top)) y2=(pixel(bottom)) {}
        }
        (below(&x, bottom, &panel.x.name, &panel.x.unit))
        @if !caption.is_empty() {
            text class="small" x="0" y=(pixel(bottom + BELOW + 10.0)) { (caption) }
        }
    };
    let caption = if caption.is_empty() { 0.0 } else { LINE };
    Drawing { content, height: bottom + BELOW + caption + 4.0 }
}

impl Panel {
    /// What the axis from left to right covers.
    fn horizontal(&self) -> Option<(f64, f64)> {
        match &self.content {
            Content::Curves(list) => {
                let all = list.iter().flat_map(|curve| curve.points.iter().map(|p| p.0));
                super::frame::range(all.filter(|x| !self.x.log || *x > 0.0))
            }
            Content::Map(map) => Some((*map.x.first()?, *map.x.last()?)),
        }
    }

    /// What is seen, in words.
    fn described(&self) -> String {
        let what = match &self.content {
            Content::Curves(list) => {
                let names: Vec<&str> =
                    list.iter().map(|curve| &*curve.name).filter(|name| !name.is_empty()).collect();
                format!("{} against {}: {}", self.y.name, self.x.name, names.join(", "))
            }
            Content::Map(map) => {
                format!("contour lines over {} and {}; {}", self.x.name, self.y.name, map.summary())
            }
        };
        format!("{}: {what}.", self.title)
    }
}

/// The space that a panel takes besides its width \[px\].
const BESIDE: f64 = LEFT + RIGHT;

/// One panel as an element of its own, `width` px wide or as wide as there is room.
fn framed(drawing: &Drawing, place: Option<(f64, f64, f64)>) -> Markup {
    match place {
        Some((x, y, width)) => html! {
            svg class="p" x=(pixel(x)) y=(pixel(y)) width=(pixel(width)) height=(pixel(drawing.height)) { (drawing.content) }
        },
        None => html! { (drawing.content) },
    }
}
