//! One panel over the frequency: lines, marks and both axes.

use super::curves::{At, Curves};
use crate::output::table::format_number;
use crate::report::drawing::{LEFT, controller, percent, pixel};
use crate::report::scale::Axis;
use maud::{Markup, html};

/// Columns that a panel is divided into.
const COLUMNS: f64 = 1000.0;
/// Height of a panel and the space around it \[px\].
const HEIGHT: f64 = 210.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 38.0;
/// Smallest and largest phase that is drawn \[deg\]: a dead time turns for ever.
const PHASES: (f64, f64) = (-540.0, 180.0);
/// Smallest part of the largest value that is drawn.
const DEPTH: f64 = 1e-4;

/// A line of a panel.
struct Line {
    class: String,
    points: Vec<(f64, f64)>,
}

/// A marked point.
struct Mark {
    index: usize,
    at: (f64, f64),
    text: String,
}

/// What a panel shows.
pub(super) struct Panel {
    title: &'static str,
    unit: String,
    omega: Axis,
    values: Axis,
    lines: Vec<Line>,
    marks: Vec<Mark>,
    /// Heights of thin lines across.
    levels: Vec<f64>,
    /// Frequencies of thin lines upright.
    ends: Vec<f64>,
    caption: &'static str,
}

/// The classes of the continuous line of a controller.
pub(super) fn continuous(index: usize) -> String {
    format!("l asked c{}", index % 8)
}

/// The classes of the sampled line of a controller.
pub(super) fn sampled(index: usize) -> String {
    let class = controller(index);
    format!("l {class}")
}

pub(super) fn magnitude(curves: &[Curves]) -> Panel {
    let mut panel = panel(curves, "|L|, size of the loop gain", String::new(), |p| p.open.abs(), Kind::Ratio);
    panel.levels = vec![1.0];
    panel
}

pub(super) fn phase(curves: &[Curves]) -> Panel {
    let mut panel = panel(curves, "Phase of L", "\u{b0}".to_owned(), |p| p.phase, Kind::Phase);
    panel.levels = vec![-180.0];
    panel
}

pub(super) fn sensitivity(curves: &[Curves]) -> Panel {
    let mut panel = panel(curves, "|S|, sensitivity", String::new(), |p| p.sensitivity, Kind::Ratio);
    panel.marks = marks(curves, "Ms", 0);
    panel.levels = vec![1.0];
    panel.caption = "Where |S| is above 1, the loop amplifies disturbances. Ms is its largest value.";
    panel
}

pub(super) fn complementary(curves: &[Curves]) -> Panel {
    let title = "|T|, complementary sensitivity";
    let mut panel = panel(curves, title, String::new(), |p| p.complementary, Kind::Ratio);
    panel.marks = marks(curves, "Mt", 1);
    panel.levels = vec![1.0];
    panel
}

pub(super) fn noise(curves: &[Curves], [u, y]: &[String; 2]) -> Panel {
    let name = |unit: &str, other: &str| if unit.is_empty() { other.to_owned() } else { unit.to_owned() };
    let unit = format!("{}/{}", name(u, "u"), name(y, "y"));
    let mut panel = panel(curves, "|u/n|, noise to output", unit, |p| p.noise, Kind::Ratio);
    panel.ends.extend(curves.iter().map(|c| 0.5 * c.nyquist));
    panel.caption = "The upright line in the middle is pi/(2 ts), for which noise gains are requested.";
    panel
}

fn marks(curves: &[Curves], name: &str, which: usize) -> Vec<Mark> {
    let peak = |c: &Curves| {
        let at = *c.peaks.as_ref()?.get(which)?;
        Some(Mark {
            index: c.index,
            at,
            text: format!("{}: {name} = {} at {} rad/s", c.name, format_number(at.1), format_number(at.0)),
        })
    };
    curves.iter().filter_map(peak).collect()
}

/// How values stand on their axis.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Ratio,
    Phase,
}

fn panel(
    curves: &[Curves],
    title: &'static str,
    unit: String,
    value: impl Fn(&At) -> f64,
    kind: Kind,
) -> Panel {
    let drawn = |points: &[At]| -> Vec<(f64, f64)> {
        let all = points.iter().map(|p| (p.omega, value(p)));
        all.filter(|(w, x)| w.is_finite() && x.is_finite()).collect()
    };
    let mut lines = Vec::new();
    for c in curves {
        lines.push(Line { class: continuous(c.index), points: drawn(&c.continuous) });
        lines.push(Line { class: sampled(c.index), points: drawn(&c.sampled) });
    }
    let numbers = || lines.iter().flat_map(|line| line.points.iter().map(|p| p.1));
    let omega = range(lines.iter().flat_map(|line| line.points.iter().map(|p| p.0)));
    let (lo, hi) = range(numbers()).unwrap_or((0.1, 1.0));
    let shown = match kind {
        Kind::Ratio => (lo.max(hi.min(10.0) * DEPTH), hi.max(1e-99)),
        Kind::Phase => (lo.max(PHASES.0).min(-200.0), hi.min(PHASES.1).max(-90.0)),
    };
    for line in &mut lines {
        line.points.retain(|p| p.1 >= shown.0 && p.1 <= shown.1);
    }
    let values = if kind == Kind::Ratio { Axis::of_sizes(Some(shown), 5) } else { Axis::degrees(shown) };
    Panel {
        title,
        unit,
        omega: Axis::of_frequencies(omega.unwrap_or((0.1, 10.0))),
        values,
        lines,
        marks: Vec::new(),
        levels: Vec::new(),
        ends: curves.iter().map(|c| c.nyquist).collect(),
        caption: "",
    }
}

fn range(mut list: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let first = list.next()?;
    Some(list.fold((first, first), |(lo, hi), x| (lo.min(x), hi.max(x))))
}

/// The panel with its axes.
pub(super) fn picture(id: &str, panel: &Panel) -> Markup {
    let bottom = TOP + HEIGHT;
    let y = |value: f64| bottom - panel.values.share(value) * HEIGHT;
    let inside = |share: f64| (0.0..=1.0).contains(&share);
    html! {
        figure class="plot" {
            svg class="canvas" height=(pixel(TOP + HEIGHT + BOTTOM)) role="img" aria-labelledby={ (id) "-title" } {
                title id={ (id) "-title" } { (panel.title) " against frequency" }
                g class="grid" {
                    @for tick in &panel.values.ticks {
                        line x1="0" x2="100%" y1=(pixel(bottom - tick.share * HEIGHT)) y2=(pixel(bottom - tick.share * HEIGHT)) {}
                    }
                    @for tick in &panel.omega.ticks {
                        line x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(TOP)) y2=(pixel(bottom)) {}
                    }
                }
                @for level in panel.levels.iter().filter(|level| inside(panel.values.share(**level))) {
                    line class="axis" x1="0" x2="100%" y1=(pixel(y(*level))) y2=(pixel(y(*level))) {}
                }
                @for end in panel.ends.iter().filter(|end| inside(panel.omega.share(**end))) {
                    line class="level" x1=(percent(panel.omega.share(*end))) x2=(percent(panel.omega.share(*end)))
                        y1=(pixel(TOP)) y2=(pixel(bottom)) {}
                }
                svg class="p" y=(pixel(TOP)) width="100%" height=(pixel(HEIGHT))
                    viewBox={ "0 0 " (COLUMNS) " " (HEIGHT) } preserveAspectRatio="none" {
                    @for line in &panel.lines { path class=(line.class) d=(path(panel, line)) {} }
                }
                @for mark in &panel.marks {
                    @let (x, height) = (panel.omega.share(mark.at.0), panel.values.share(mark.at.1));
                    @if inside(x) && inside(height) {
                        svg class="p" x=(percent(x)) y=(pixel(y(mark.at.1))) {
                            circle class={ "point " (controller(mark.index)) } r="4" { title { (mark.text) } }
                        }
                    }
                }
                text class="title" x=(pixel(-LEFT)) y="14" { (panel.title) (panel.values.unit(&panel.unit)) }
                @for tick in &panel.values.ticks {
                    text class="n" x="-7" y=(pixel(bottom - tick.share * HEIGHT + 4.0)) { (tick.label) }
                }
                @for tick in &panel.omega.ticks {
                    text class="t" x=(percent(tick.share)) y=(pixel(bottom + 17.0)) { (tick.label) }
                }
                line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
                text class="title t" x="50%" y=(pixel(bottom + 33.0)) { "frequency" (panel.omega.unit("rad/s")) }
            }
            @if !panel.caption.is_empty() || !panel.marks.is_empty() {
                figcaption {
                    (panel.caption)
                    @for mark in &panel.marks { " " (mark.text) "." }
                }
            }
        }
    }
}

/// The line in the columns of the panel; points nearer than a third of a pixel are left out.
fn path(panel: &Panel, line: &Line) -> String {
    let mut text = String::new();
    let mut last: Option<(f64, f64)> = None;
    for &(omega, value) in &line.points {
        let x = panel.omega.share(omega) * COLUMNS;
        let y = (1.0 - panel.values.share(value)) * HEIGHT;
        if last.is_some_and(|(a, b)| (x - a).abs() < 0.5 && (y - b).abs() < 0.3) {
            continue;
        }
        // A gap where the curve has left the panel.
        let jump = last.is_none_or(|(_, b)| (y - b).abs() > 0.8 * HEIGHT);
        text.push_str(if jump { "M" } else { "L" });
        text.push_str(&format!("{x:.1} {y:.1}"));
        last = Some((x, y));
    }
    text
}

/// Which line is which.
pub(super) fn legend(curves: &[Curves]) -> Markup {
    html! {
        ul class="legend plot" {
            @for c in curves {
                li {
                    svg width="30" height="12" aria-hidden="true" {
                        line class=(sampled(c.index)) x1="0" x2="30" y1="6" y2="6" {}
                    }
                    span { (c.name) ", sampled" }
                }
                li {
                    svg width="30" height="12" aria-hidden="true" {
                        line class=(continuous(c.index)) x1="0" x2="30" y1="6" y2="6" {}
                    }
                    span { (c.name) ", continuous" }
                }
            }
        }
    }
}
