//! The picture of a run: panels over one time axis, events across all of them, modes and status below.
//!
//! Places along the time axis are shares of the width, everything else is in pixels: the same drawing fits a telephone, a
//! wide page and paper, with letters of one size.

use super::Chapter;
use super::bands::{Bands, Block, bands};
use super::marks::{Mark, marks, rows};
use super::panels::{Level, Look, Loop, Panel, panels};
use super::path::{Pen, Plane};
use super::scale::Axis;
use super::words;
use maud::{Markup, html};

/// Space for the numbers of the value axes \[px\].
pub(super) const LEFT: f64 = 66.0;
/// Space for half a number of the time axis \[px\].
pub(super) const RIGHT: f64 = 14.0;
/// Columns that a panel is divided into, whatever its width.
pub(super) const COLUMNS: f64 = 1000.0;
/// Height of a line of event numbers \[px\].
const MARK: f64 = 18.0;
/// Height of a panel's title \[px\].
const TITLE: f64 = 30.0;
/// Height of the numbers and the name of the axis of time \[px\].
pub(super) const BELOW: f64 = 40.0;
/// Height of a line with the name of a controller \[px\].
const NAME: f64 = 19.0;
/// Height of a band of modes and of one of status \[px\].
const MODE: f64 = 15.0;
const STATUS: f64 = 9.0;
/// From one band of status to the next \[px\].
const STATUS_PITCH: f64 = 14.0;
/// Width of a character in a band \[px\], and the widths of a telephone and of a wide page.
const CHARACTER: f64 = 6.2;
const NARROW: f64 = 300.0;
const WIDE: f64 = 590.0;

/// A picture without its frame.
pub(super) struct Drawing {
    /// What stands inside an `svg` that is as wide as the panels and shows what lies beside them.
    pub(super) content: Markup,
    /// Its height \[px\].
    pub(super) height: f64,
}

/// The controllers of a chapter that were recorded.
pub(super) fn loops<'a>(chapter: &Chapter<'a>) -> Vec<Loop<'a>> {
    let both = chapter.scenario.controllers.iter().zip(&chapter.result.controllers);
    let recorded = both.enumerate().filter_map(|(index, (spec, result))| {
        let record = result.record.as_ref().filter(|record| !record.is_empty())?;
        Some(Loop { index, spec, record, inner: result.inner.as_ref() })
    });
    recorded.collect()
}

/// The time that a picture shows \[s\].
pub(super) fn shown(chapter: &Chapter<'_>, loops: &[Loop<'_>]) -> (f64, f64) {
    let first = loops.first().map(|l| l.record);
    let (from, to) = first.map_or((0.0, 1.0), |r| (r.time(0), r.time(r.len())));
    (
        from,
        if to > chapter.scenario.duration && from < chapter.scenario.duration {
            chapter.scenario.duration
        } else {
            to
        },
    )
}

/// Draws a run.
pub(super) fn draw(chapter: &Chapter<'_>, loops: &[Loop<'_>]) -> Drawing {
    let time = shown(chapter, loops);
    let axis = Axis::of_time(time.0, time.1, 9);
    let marks = marks(chapter.scenario, axis.range());
    let panels = panels(chapter.scenario, loops);
    let bands: Vec<Bands> = loops.iter().flat_map(bands).collect();

    let top = MARK * rows(&marks) as f64;
    let mut y = top + 2.0;
    let mut parts = Vec::new();
    for panel in &panels {
        y += TITLE;
        parts.push(draw_panel(panel, loops, time, &axis, y));
        y += panel.height;
    }
    y += 6.0;
    for one in &bands {
        parts.push(draw_bands(one, loops, time, y));
        y += height_of(one);
    }
    let end = y;
    y += BELOW;
    Drawing {
        content: html! {
            (draw_marks(&marks, end))
            @for part in &parts { (part) }
            (time_axis(&axis, end))
        },
        height: y,
    }
}

fn draw_panel(panel: &Panel<'_>, loops: &[Loop<'_>], time: (f64, f64), axis: &Axis, top: f64) -> Markup {
    let most = (panel.height / 33.0) as usize;
    let values = Axis::of_values(panel.range(), most.max(2));
    let bottom = top + panel.height;
    let Some(record) = loops.first().map(|l| l.record) else { return html! {} };
    let size = (COLUMNS, panel.height);
    let plane = Plane { record, time, share: &|value| values.share(value), size };
    html! {
        (grid(&values, axis, (top, panel.height), panel.title, &panel.unit))
        svg class="p" y=(pixel(top)) width="100%" height=(pixel(panel.height))
            viewBox={ "0 0 " (COLUMNS) " " (panel.height) } preserveAspectRatio="none" {
            @for level in &panel.levels { (draw_level(level, &plane)) }
            @for trace in &panel.traces {
                @let share = |value: f64| values.share(value - trace.origin);
                @let paths = Plane { record, time, share: &share, size }.draw(trace.envelope, trace.between);
                @if !paths.area.is_empty() { path class={ "a " (tint(trace.look)) } d=(paths.area) {} }
                path class={ "l " (look(trace.look)) } d=(paths.line) {}
            }
        }
        line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
    }
}

/// The lines of both axes, the title and the numbers of the upright one, in a panel given by its top and its height.
pub(super) fn grid(values: &Axis, axis: &Axis, (top, height): (f64, f64), title: &str, unit: &str) -> Markup {
    let bottom = top + height;
    let place = |share: f64| pixel(bottom - share * height);
    html! {
        g class="grid" {
            @for tick in &values.ticks {
                line x1="0" x2="100%" y1=(place(tick.share)) y2=(place(tick.share)) {}
            }
            @for tick in &axis.ticks {
                line x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(top)) y2=(pixel(bottom)) {}
            }
        }
        text class="title" x=(pixel(-LEFT)) y=(pixel(top - 11.0)) { (title) (values.unit(unit)) }
        @for tick in &values.ticks {
            text class="n" x="-7" y=(pixel(bottom - tick.share * height + 4.0)) { (tick.label) }
        }
    }
}

fn draw_level(level: &Level, plane: &Plane<'_>) -> Markup {
    let (from, to) = (level.time.0.max(plane.time.0), level.time.1.min(plane.time.1));
    if from >= to {
        return html! {};
    }
    let mut pen = Pen::default();
    pen.to(plane.x(from), plane.y(level.value));
    pen.to(plane.x(to), plane.y(level.value));
    let owner = level.owner.map(colour);
    html! {
        path class={ "level " (owner.unwrap_or_default()) } d=(pen.finish()) { title { (level.label) } }
    }
}

fn draw_marks(marks: &[Mark], bottom: f64) -> Markup {
    let top = |row: usize| MARK * row as f64;
    html! {
        g class="events" {
            @for mark in marks {
                @let x = percent(mark.share);
                line x1=(x) x2=(x) y1=(pixel(mark.row.map_or(0.0, |row| top(row) + MARK))) y2=(pixel(bottom)) {}
            }
            @for (mark, row) in marks.iter().filter_map(|mark| mark.row.map(|row| (mark, row))) {
                @let y = top(row) + 9.0;
                circle class=[mark.wide.then_some("wide")] cx=(percent(mark.share)) cy=(pixel(y)) r="8" {}
                text class={ "number" @if mark.wide { " wide" } } x=(percent(mark.share)) y=(pixel(y + 4.0)) { (mark.number) }
                @if mark.named {
                    svg class="p" x=(percent(mark.share)) {
                        text class="name wide" x="13" y=(pixel(y + 4.0)) { (mark.text) }
                    }
                }
            }
        }
    }
}

pub(super) fn time_axis(axis: &Axis, y: f64) -> Markup {
    below(axis, y, "time t", "s")
}

/// The axis below the panels: its ticks, their numbers, what it is.
pub(super) fn below(axis: &Axis, y: f64, name: &str, unit: &str) -> Markup {
    html! {
        line class="axis" x1="0" x2="100%" y1=(pixel(y)) y2=(pixel(y)) {}
        @for tick in &axis.ticks {
            line class="axis" x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(y)) y2=(pixel(y + 4.0)) {}
            text class={ "t" @if tick.minor { " wide" } } x=(percent(tick.share)) y=(pixel(y + 17.0)) {
                (tick.label)
            }
        }
        @for share in &axis.between {
            line class="axis" x1=(percent(*share)) x2=(percent(*share)) y1=(pixel(y)) y2=(pixel(y + 2.5)) {}
        }
        text class="title t" x="50%" y=(pixel(y + 36.0)) { (name) (axis.unit(unit)) }
    }
}

fn height_of(bands: &Bands) -> f64 {
    if bands.always.is_some() {
        return NAME;
    }
    NAME + MODE + 4.0 + STATUS_PITCH * bands.status.len() as f64
}

fn draw_bands(bands: &Bands, loops: &[Loop<'_>], time: (f64, f64), top: f64) -> Markup {
    let Some(record) = loops.first().map(|l| l.record) else { return html! {} };
    let plane = Plane { record, time, share: &|x| x, size: (COLUMNS, MODE) };
    let mode = top + NAME;
    let mut y = mode + MODE + 4.0;
    let status: Vec<(f64, &super::bands::Row)> = bands
        .status
        .iter()
        .map(|row| {
            let here = y;
            y += STATUS_PITCH;
            (here, row)
        })
        .collect();
    html! {
        line class={ "l " (controller(bands.index)) } x1=(pixel(-LEFT)) x2=(pixel(-LEFT + 24.0))
            y1=(pixel(top + 9.0)) y2=(pixel(top + 9.0)) {}
        text class="title" x=(pixel(-LEFT + 30.0)) y=(pixel(top + 13.0)) {
            (words::cut(&bands.name, 44))
            @if let Some(mode) = bands.always { tspan class="plain" { ": " (mode) " throughout" } }
        }
        @if bands.always.is_none() {
            text class="n small" x="-7" y=(pixel(mode + 11.0)) { "mode" }
        }
        (blocks(&bands.modes, &plane, mode, MODE))
        @for block in &bands.modes {
            @let (left, right) = (plane.span(block.first).0, plane.span(block.end - 1).1);
            @let share = (left as f64 / 100.0 / COLUMNS, right as f64 / 100.0 / COLUMNS);
            @let need = block.text.len() as f64 * CHARACTER + 8.0;
            @if (share.1 - share.0) * WIDE >= need {
                svg class="p" x=(percent(share.0)) {
                    text class={ "mode" @if (share.1 - share.0) * NARROW < need { " wide" } } x="5"
                        y=(pixel(mode + 11.5)) { (block.text) }
                }
            }
        }
        @for (y, row) in &status {
            text class="n small" x="-7" y=(pixel(y + 8.0)) { (row.label) }
            line class="rail" x1="0" x2="100%" y1=(pixel(y + STATUS / 2.0)) y2=(pixel(y + STATUS / 2.0)) {}
            (blocks(&row.blocks, &plane, *y, STATUS))
        }
    }
}

/// Blocks of one height, those of one look as one path.
fn blocks(list: &[Block], plane: &Plane<'_>, top: f64, height: f64) -> Markup {
    let mut paths: Vec<(&str, Pen)> = Vec::new();
    for block in list {
        let (left, right) = (plane.span(block.first).0, plane.span(block.end - 1).1);
        let bottom = super::path::hundredths(height);
        let position = paths.iter().position(|(class, _)| *class == block.class);
        let index = position.unwrap_or_else(|| {
            paths.push((block.class, Pen::default()));
            paths.len() - 1
        });
        let pen = &mut paths[index].1;
        for (x, y) in [(left, 0), (right, 0), (right, bottom), (left, bottom)] {
            pen.to(x, y);
        }
        pen.close();
    }
    html! {
        svg class="p" y=(pixel(top)) width="100%" height=(pixel(height))
            viewBox={ "0 0 " (COLUMNS) " " (height) } preserveAspectRatio="none" {
            @for (class, pen) in paths { path class={ "b " (class) } d=(pen.finish()) {} }
        }
    }
}

/// The classes of a line.
pub(super) fn look(look: Look) -> String {
    match look {
        Look::Reference => "ref".to_owned(),
        Look::Asked(index) => format!("asked {}", colour(index)),
        Look::Controller(index) => controller(index),
        Look::Faint(index) => format!("faint {}", colour(index)),
        Look::Applied(index) => format!("applied {}", colour(index)),
    }
}

/// The classes of an area: without the pattern, which would leave gaps in what is covered.
fn tint(look_of: Look) -> String {
    match look_of {
        Look::Controller(index) => colour(index),
        other => look(other),
    }
}

/// Colour and pattern of a controller's lines: more controllers than colours differ by their patterns.
pub(super) fn controller(index: usize) -> String {
    format!("{} k{}", colour(index), (index + index / 8) % 8)
}

/// The colour of a controller, without its pattern.
pub(super) fn colour(index: usize) -> String {
    format!("c{}", index % 8)
}

/// A share of the width.
pub(super) fn percent(share: f64) -> String {
    let text = format!("{:.3}", share * 100.0);
    let short = text.trim_end_matches('0').trim_end_matches('.');
    format!("{}%", if short == "-0" { "0" } else { short })
}

/// A place \[px\].
pub(super) fn pixel(x: f64) -> String {
    let mut text = String::new();
    super::path::push_number(&mut text, super::path::hundredths(x));
    text
}
