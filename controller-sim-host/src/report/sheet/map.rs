//! A map: contour lines with their numbers, holes, marked points.

use super::super::drawing::{COLUMNS, percent, pixel};
use super::super::scale::{Axis, step};
use super::super::words;
use super::exact;
use super::labels::{Label, half_width, place_labels};
use crate::contour::Field;
use crate::output::table::format_digits;
use maud::{Markup, html};

/// Values that differ by more than this factor have levels by ratios.
const RATIO: f64 = 30.0;
/// Levels between the least and the largest value, about.
const LEVELS: usize = 9;
/// A value this near to a level is at it, relative to the level: the indices are as accurate.
const MARGIN: f64 = 1e-5;

/// Values over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Places from left to right, rising.
    pub x: Vec<f64>,
    /// Places from below, rising.
    pub y: Vec<f64>,
    /// The values of the first y, in the order of x, then of the second; what is not finite is a hole.
    pub values: Vec<f64>,
    /// Values of the lines; none: round ones.
    pub levels: Vec<f64>,
    /// The values are ratios: the line of 1 is thick, those above it are dashed.
    pub is_ratio: bool,
    /// Points with a sign.
    pub marks: Vec<Mark>,
}

/// How a marked point looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// Filled.
    Triangle,
    /// Filled.
    Square,
    /// Filled.
    Disc,
    /// Not filled.
    Ring,
}

/// A marked point.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its place on the axes.
    pub at: (f64, f64),
    /// How it looks.
    pub sign: Sign,
    /// What it stands for.
    pub name: String,
}

impl Map {
    fn range(&self) -> Option<(f64, f64)> {
        super::super::frame::range(self.values.iter().copied())
    }

    /// Points without a value.
    #[must_use]
    pub fn holes(&self) -> usize {
        self.values.iter().filter(|value| !value.is_finite()).count()
    }

    /// The values in words.
    #[must_use]
    pub fn summary(&self) -> String {
        let range = match self.range() {
            Some((lo, hi)) => format!("{} to {}", format_digits(lo, 3), format_digits(hi, 3)),
            None => "no values".to_owned(),
        };
        match self.holes() {
            0 => range,
            1 => format!("{range}; 1 hole (grey)"),
            n => format!("{range}; {n} holes (grey)"),
        }
    }

    /// The values of the lines: those that are given, or round numbers.
    #[must_use]
    pub fn lines_at(&self) -> Vec<f64> {
        let Some((lo, hi)) = self.range() else { return Vec::new() };
        let inside = |x: &f64| *x > lo && *x < hi;
        if !self.levels.is_empty() {
            return self.levels.iter().copied().filter(inside).collect();
        }
        if lo > 0.0 && hi >= RATIO * lo {
            let decades = libm::log10(lo).floor() as i32..=libm::log10(hi).ceil() as i32;
            let parts: &[i32] = match decades.clone().count() {
                0..=4 => &[1, 2, 5],
                5..=6 => &[1, 3],
                _ => &[1],
            };
            let all = decades.flat_map(|e| parts.iter().map(move |m| format!("{m}e{e}")));
            return all.filter_map(|text| text.parse().ok()).filter(inside).collect();
        }
        // No more than rounding: one value everywhere.
        if hi - lo <= 1e-6 * lo.abs().max(hi.abs()) {
            return Vec::new();
        }
        let (mantissa, e) = step(hi - lo, LEVELS);
        let size: f64 = format!("{mantissa}e{e}").parse().unwrap_or(hi - lo);
        let round = |k: i64| format!("{}e{e}", k * mantissa).parse().unwrap_or(k as f64 * size);
        ((lo / size).floor() as i64..=(hi / size).ceil() as i64).map(round).filter(inside).collect()
    }
}

/// A contour line in pixels.
pub(super) struct Line {
    pub(super) level: f64,
    pub(super) points: Vec<(f64, f64)>,
}

/// The upright axis, what stands inside, and what is said below.
pub(super) fn inner(map: &Map, x: &Axis, log: bool, size: (f64, f64)) -> (Axis, Markup, String) {
    let ends = (map.y.first().copied().unwrap_or(0.0), map.y.last().copied().unwrap_or(1.0));
    let y = exact(ends, log, 7);
    let across: Vec<f64> = map.x.iter().map(|value| x.share(*value)).collect();
    let up: Vec<f64> = map.y.iter().map(|value| y.share(*value)).collect();
    let levels = map.lines_at();
    let lines = traced(map, &across, &up, &levels, size);
    let (labels, without) = place_labels(&lines, &levels, size, &marked(map, x, &y, size));
    let mut caption = map.summary();
    if !without.is_empty() {
        let list: Vec<String> = without.iter().map(|level| number(*level)).collect();
        caption.push_str(&format!("; no number on {}", list.join(", ")));
    }
    let content = html! {
        @for (share, width, top, height) in holes(map, &across, &up, size.1) {
            rect class="hole" x=(percent(share)) width=(percent(width)) y=(pixel(top)) height=(pixel(height)) {}
        }
        svg class="p" width="100%" height=(pixel(size.1)) viewBox={ "0 0 " (COLUMNS) " " (pixel(size.1)) } preserveAspectRatio="none" {
            @for level in &levels {
                path class={ "l " (look(map.is_ratio, *level)) } d=(path(&lines, *level, size)) {}
            }
        }
        @for mark in &map.marks {
            svg class="p" x=(percent(x.share(mark.at.0))) {
                (sign(mark, (1.0 - y.share(mark.at.1)) * size.1))
            }
        }
        @for Label { at, level } in &labels {
            svg class="p" x=(percent(at.0 / size.0)) {
                @let half = half_width(*level) - 2.0;
                rect class="paper" x=(pixel(-half)) y=(pixel(at.1 - 6.0)) width=(pixel(2.0 * half)) height="12" {}
                text class={ "t small" @if is_one(map.is_ratio, *level) { " one-number" } } y=(pixel(at.1 + 4.0)) {
                    (number(*level))
                }
            }
        }
    };
    (y, content, caption)
}

/// The sign of a mark at this height \[px\]: a shape, so that two of them may lie on each other.
fn sign(mark: &Mark, at: f64) -> Markup {
    html! {
        @match mark.sign {
            Sign::Triangle => { path class="sign" d={ "M0 " (pixel(at - 5.0)) "l5 9h-10z" } { title { (mark.name) } } }
            Sign::Square => { path class="sign" d={ "M-4 " (pixel(at - 4.0)) "h8v8h-8z" } { title { (mark.name) } } }
            Sign::Disc => { circle class="sign" cy=(pixel(at)) r="4" { title { (mark.name) } } }
            Sign::Ring => { circle class="sign ring" cy=(pixel(at)) r="5" { title { (mark.name) } } }
        }
    }
}

/// Places of the marks \[px\].
fn marked(map: &Map, x: &Axis, y: &Axis, size: (f64, f64)) -> Vec<(f64, f64)> {
    map.marks.iter().map(|mark| (x.share(mark.at.0) * size.0, (1.0 - y.share(mark.at.1)) * size.1)).collect()
}

fn traced(map: &Map, across: &[f64], up: &[f64], levels: &[f64], size: (f64, f64)) -> Vec<Line> {
    // By their logarithms where levels are: between two points a value is taken to change as the levels do.
    let by_ratio = map.range().is_some_and(|(lo, hi)| lo > 0.0 && hi >= RATIO * lo);
    let scaled = |value: f64| if by_ratio { libm::log(value) } else { value };
    let values: Vec<f64> = map.values.iter().map(|value| scaled(*value)).collect();
    let field = Field::new(across, up, &values);
    let mut lines = Vec::new();
    for &level in levels {
        let margin = if by_ratio { MARGIN } else { MARGIN * level.abs() };
        lines.extend(field.lines(scaled(level), margin).into_iter().map(|line| {
            let points = line.into_iter().map(|(a, b)| (a * size.0, (1.0 - b) * size.1)).collect();
            Line { level, points }
        }));
    }
    lines
}

fn is_one(is_ratio: bool, level: f64) -> bool {
    is_ratio && (level - 1.0).abs() < 1e-12
}

/// The classes of a line.
fn look(is_ratio: bool, level: f64) -> &'static str {
    match is_ratio {
        true if is_one(true, level) => "one",
        true if level > 1.0 => "c1 k1",
        _ => "c0",
    }
}

/// A number on a line.
fn number(level: f64) -> String {
    words::number(level)
}

fn path(lines: &[Line], level: f64, size: (f64, f64)) -> String {
    let mut text = String::new();
    for line in lines.iter().filter(|line| line.level == level) {
        for (i, (x, y)) in line.points.iter().enumerate() {
            text.push_str(&format!("{}{:.1} {y:.1}", if i == 0 { "M" } else { "L" }, x / size.0 * COLUMNS));
        }
    }
    text
}

/// Rectangles around the points without a value, neighbours in a row as one: share and width of the width, top and height.
fn holes(map: &Map, across: &[f64], up: &[f64], height: f64) -> Vec<(f64, f64, f64, f64)> {
    let ends = |places: &[f64], i: usize| {
        let at = |i: usize| places.get(i).copied().unwrap_or(0.5);
        let lo = if i == 0 { at(0) } else { 0.5 * (at(i - 1) + at(i)) };
        let hi = if i + 1 >= places.len() { at(i) } else { 0.5 * (at(i) + at(i + 1)) };
        (lo, hi)
    };
    let mut list = Vec::new();
    for (j, row) in map.values.chunks(across.len().max(1)).enumerate() {
        let (low, high) = ends(up, j);
        let mut i = 0;
        while i < row.len() {
            let run = row[i..].iter().take_while(|value| !value.is_finite()).count();
            if run > 0 {
                let (left, right) = (ends(across, i).0, ends(across, i + run - 1).1);
                list.push((left, right - left, (1.0 - high) * height, (high - low) * height));
            }
            i += run.max(1);
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Map {
        let x = (0..values.len()).map(|i| i as f64).collect();
        Map { x, y: vec![0.0], values: values.to_vec(), levels: vec![], is_ratio: true, marks: vec![] }
    }

    #[test]
    fn levels_are_round_and_inside() {
        assert_eq!(of(&[0.17, 1.42]).lines_at(), [0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4]);
        assert_eq!(of(&[1.0, 116.0]).lines_at(), [2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(of(&[-0.3, 0.25]).lines_at(), [-0.2, -0.1, 0.0, 0.1, 0.2]);
        assert_eq!(of(&[1e-9, 1e3]).lines_at().len(), 11);
        assert_eq!(of(&[1.0, 1.0 + 1e-9]).lines_at(), [0.0; 0]);
        assert_eq!(of(&[f64::NAN, f64::INFINITY]).lines_at(), [0.0; 0]);
        assert_eq!(of(&[2.0]).lines_at(), [0.0; 0]);
        let given = Map { levels: vec![0.1, 0.5, 0.7, 3.0], ..of(&[0.2, 2.0]) };
        assert_eq!(given.lines_at(), [0.5, 0.7]);
    }

    #[test]
    fn holes_are_counted_and_covered() {
        let mut map = of(&[1.0, f64::NAN, f64::NAN, 2.0, f64::INFINITY]);
        map.y = vec![0.0];
        assert_eq!((map.holes(), &*map.summary()), (3, "1.00 to 2.00; 3 holes (grey)"));
        let across: Vec<f64> = map.x.iter().map(|x| x / 4.0).collect();
        let list = holes(&map, &across, &[0.0], 100.0);
        assert_eq!(list, [(0.125, 0.5, 100.0, 0.0), (0.875, 0.125, 100.0, 0.0)]);
    }
}
