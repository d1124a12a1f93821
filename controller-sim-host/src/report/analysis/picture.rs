//! Panels over the frequency: lines, marks and both axes.

use super::curves::{At, Crossing, Curves, Kind};
use crate::output::table::format_number;
use crate::report::drawing::{BELOW, COLUMNS, below, colour, controller, grid, percent, pixel};
use crate::report::legend;
use crate::report::scale::Axis;
use controller_design::margins::Margins;
use maud::{Markup, html};

/// Height of a panel and the space above and below it \[px\].
const HEIGHT: f64 = 210.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = BELOW;
/// Smallest and largest phase that is drawn \[deg\]: a dead time turns for ever.
const PHASES: (f64, f64) = (-540.0, 180.0);
/// Smallest part of the largest value that is drawn.
const DEPTH: f64 = 1e-4;

/// A line of a panel.
struct Line {
    class: String,
    points: Vec<(f64, f64)>,
}

/// A marked point, and the value that it is measured from.
struct Mark {
    index: usize,
    at: (f64, f64),
    from: Option<f64>,
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
    /// Frequencies of thin lines upright, with their names.
    ends: Vec<(f64, &'static str)>,
    caption: &'static str,
}

/// The classes of the continuous line of a controller.
pub(super) fn continuous(index: usize) -> String {
    format!("l asked {}", colour(index))
}

/// The classes of the sampled line of a controller.
pub(super) fn sampled(index: usize) -> String {
    let class = controller(index);
    format!("l {class}")
}

pub(super) fn magnitude(curves: &[Curves]) -> Panel {
    let mut panel =
        panel(curves, "|L|, size of the loop gain", String::new(), |p| p.open.abs(), Scale::Ratio);
    panel.levels = vec![1.0];
    panel.marks = crossings(curves, Kind::Gain, |crossing| Mark {
        index: 0,
        at: (crossing.omega, crossing.open.abs()),
        from: Some(1.0),
        text: format!(
            "gain margin {}{}",
            if crossing.margin < 1.0 { "downwards " } else { "" },
            format_number(crossing.margin)
        ),
    });
    panel.caption =
        "The loop is broken at the plant input. The sampled law ends at the Nyquist frequency, \u{3c0}/ts.";
    panel
}

pub(super) fn phase(curves: &[Curves]) -> Panel {
    let mut panel = panel(curves, "Phase of L", "\u{b0}".to_owned(), |p| p.phase, Scale::Degrees);
    panel.levels = vec![-180.0];
    panel.marks = crossings(curves, Kind::Phase, |crossing| Mark {
        index: 0,
        at: (crossing.omega, crossing.phase),
        from: Some(360.0 * libm::round((crossing.phase + 180.0) / 360.0) - 180.0),
        text: format!("phase margin {}\u{b0}", format_number(crossing.margin)),
    });
    panel
}

pub(super) fn sensitivity(curves: &[Curves]) -> Panel {
    let mut panel = panel(curves, "|S|, sensitivity", String::new(), |p| p.sensitivity, Scale::Ratio);
    panel.marks = peaks(curves, "Ms", |m| (m.omega_ms, m.ms));
    panel.levels = vec![1.0];
    panel.caption =
        "Where |S| is above 1, the loop amplifies disturbances. Ms is its largest value, Mt that of |T|.";
    panel
}

pub(super) fn complementary(curves: &[Curves]) -> Panel {
    let title = "|T|, complementary sensitivity";
    let mut panel = panel(curves, title, String::new(), |p| p.complementary, Scale::Ratio);
    panel.marks = peaks(curves, "Mt", |m| (m.omega_mt, m.mt));
    panel.levels = vec![1.0];
    panel
}

pub(super) fn noise(curves: &[Curves], [u, y]: &[String; 2]) -> Panel {
    let name = |unit: &str, other: &str| if unit.is_empty() { other.to_owned() } else { unit.to_owned() };
    let unit = format!("{}/{}", name(u, "u"), name(y, "y"));
    let mut panel = panel(curves, "|u/n|, noise to output", unit, |p| p.noise, Scale::Ratio);
    panel.ends.extend(curves.first().map(|c| (0.5 * c.nyquist, "\u{3c0}/(2 ts)")));
    panel.caption = "The noise gains K of the table are those at \u{3c0}/(2 ts).";
    panel
}

fn peaks(curves: &[Curves], name: &str, peak: impl Fn(&Margins) -> (f64, f64)) -> Vec<Mark> {
    let mark = |c: &Curves| {
        let at = peak(c.margins.as_ref()?);
        Some(Mark { index: c.index, at, from: None, text: format!("{name} = {}", format_number(at.1)) })
    };
    curves.iter().filter_map(mark).collect()
}

fn crossings(curves: &[Curves], kind: Kind, mark: impl Fn(&Crossing) -> Mark) -> Vec<Mark> {
    let all = curves.iter().flat_map(|c| c.crossings.iter().map(|crossing| (c.index, crossing)));
    let own = all.filter(|(_, crossing)| crossing.kind == kind);
    own.map(|(index, crossing)| Mark { index, ..mark(crossing) }).collect()
}

/// How values stand on their axis.
#[derive(Clone, Copy, PartialEq)]
enum Scale {
    Ratio,
    Degrees,
}

fn panel(
    curves: &[Curves],
    title: &'static str,
    unit: String,
    value: impl Fn(&At) -> f64,
    scale: Scale,
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
    let shown = match scale {
        Scale::Ratio => (lo.max(hi.min(10.0) * DEPTH), hi.max(1e-99)),
        Scale::Degrees => (lo.max(PHASES.0).min(-200.0), hi.min(PHASES.1).max(-90.0)),
    };
    for line in &mut lines {
        line.points.retain(|p| p.1 >= shown.0 && p.1 <= shown.1);
    }
    let values = if scale == Scale::Ratio { Axis::of_sizes(Some(shown), 7) } else { Axis::degrees(shown) };
    Panel {
        title,
        unit,
        omega: Axis::of_frequencies(omega.unwrap_or((0.1, 10.0))),
        values,
        lines,
        marks: Vec::new(),
        levels: Vec::new(),
        ends: curves.first().map(|c| (c.nyquist, "\u{3c0}/ts")).into_iter().collect(),
        caption: "",
    }
}

fn range(mut list: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let first = list.next()?;
    Some(list.fold((first, first), |(lo, hi), x| (lo.min(x), hi.max(x))))
}

/// Panels over one axis of frequency, with the legend above and what is marked below them.
pub(super) fn figure(id: &str, curves: &[Curves], panels: &[Panel]) -> Markup {
    let top = |row: usize| TOP + (TOP + HEIGHT) * row as f64;
    let end = top(panels.len()) - TOP;
    let titles: Vec<&str> = panels.iter().map(|panel| panel.title).collect();
    html! {
        figure class="plot" id=(id) {
            (legend(curves))
            svg class="canvas" height=(pixel(end + BOTTOM)) role="img" aria-labelledby={ (id) "-title" } {
                title id={ (id) "-title" } { (titles.join("; ")) ", against frequency" }
                @for (row, panel) in panels.iter().enumerate() { (draw(panel, top(row))) }
                @if let Some(last) = panels.last() { (below(&last.omega, end, "frequency", "rad/s")) }
            }
            figcaption {
                @for panel in panels.iter().filter(|panel| !panel.caption.is_empty()) { (panel.caption) " " }
                @for c in curves { (said(c, panels)) }
            }
        }
    }
}

/// What is marked of one controller, in words.
fn said(c: &Curves, panels: &[Panel]) -> Markup {
    let own = panels.iter().flat_map(|panel| &panel.marks).filter(|mark| mark.index == c.index);
    let list: Vec<String> =
        own.map(|mark| format!("{} at {} rad/s", mark.text, format_number(mark.at.0))).collect();
    html! { @if !list.is_empty() { (c.name) ": " (list.join(", ")) ". " } }
}

fn draw(panel: &Panel, top: f64) -> Markup {
    let bottom = top + HEIGHT;
    let y = |value: f64| bottom - panel.values.share(value).clamp(0.0, 1.0) * HEIGHT;
    let inside = |share: f64| (0.0..=1.0).contains(&share);
    let seen = |mark: &&Mark| inside(panel.omega.share(mark.at.0)) && inside(panel.values.share(mark.at.1));
    html! {
        (grid(&panel.values, &panel.omega, (top, HEIGHT), panel.title, &panel.unit))
        @for level in panel.levels.iter().filter(|level| inside(panel.values.share(**level))) {
            line class="axis" x1="0" x2="100%" y1=(pixel(y(*level))) y2=(pixel(y(*level))) {}
        }
        @for (row, (end, name)) in panel.ends.iter().enumerate() {
            @let x = percent(panel.omega.share(*end));
            line class="level" x1=(x) x2=(x) y1=(pixel(top)) y2=(pixel(bottom)) {}
            svg class="p" x=(x) {
                text class="n halo" x="-5" y=(pixel(top + 13.0 + 15.0 * row as f64)) { (name) }
            }
        }
        svg class="p" y=(pixel(top)) width="100%" height=(pixel(HEIGHT))
            viewBox={ "0 0 " (COLUMNS) " " (HEIGHT) } preserveAspectRatio="none" {
            @for line in &panel.lines { path class=(line.class) d=(path(panel, line)) {} }
        }
        @for mark in panel.marks.iter().filter(seen) {
            @let (x, at) = (percent(panel.omega.share(mark.at.0)), pixel(y(mark.at.1)));
            @if let Some(from) = mark.from {
                g class=(colour(mark.index)) { line class="span" x1=(x) x2=(x) y1=(pixel(y(from))) y2=(at) {} }
            }
            circle class={ "point " (colour(mark.index)) } cx=(x) cy=(at) r="4" { title { (mark.text) } }
        }
        line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
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
        ul class="legend" {
            @for c in curves { (legend::line(&controller(c.index), &c.name)) }
            @if let Some(first) = curves.first() {
                (legend::line(&format!("asked {}", colour(first.index)), "thin: the continuous design; thick: the sampled law"))
            }
        }
    }
}
