//! Curves over any axis.

use super::super::drawing::{COLUMNS, controller, percent, pixel};
use super::super::frame::range;
use super::super::scale::Axis;
use maud::{Markup, html};

/// How the points of a curve are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Joined by a line.
    Line,
    /// Each by itself.
    Points,
    /// Both.
    Both,
}

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// In the legend; none without.
    pub name: String,
    /// Its points; one that is not finite parts the line.
    pub points: Vec<(f64, f64)>,
    /// How they are shown.
    pub look: Look,
    /// Which colour and pattern, from 0.
    pub index: usize,
}

impl Curve {
    /// A line.
    #[must_use]
    pub fn line(name: &str, index: usize, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.to_owned(), points, look: Look::Line, index }
    }

    /// Points.
    #[must_use]
    pub fn points(name: &str, index: usize, points: Vec<(f64, f64)>) -> Self {
        Self { look: Look::Points, ..Self::line(name, index, points) }
    }
}

/// Class, look and name of those that have one.
pub(super) fn legend(list: &[Curve]) -> Vec<(String, Look, String)> {
    let named = list.iter().filter(|curve| !curve.name.is_empty());
    named.map(|curve| (controller(curve.index), curve.look, curve.name.clone())).collect()
}

/// The upright axis, and what stands inside.
pub(super) fn inner(list: &[Curve], x: &Axis, log: bool, height: f64) -> (Axis, Markup) {
    let all = list.iter().flat_map(|curve| curve.points.iter().map(|p| p.1));
    let reach = range(all.filter(|y| !log || *y > 0.0));
    let most = ((height / 33.0) as usize).max(2);
    let y = if log { Axis::of_sizes(reach, most) } else { Axis::of_values(reach, most) };
    let place = |(a, b): (f64, f64)| (x.share(a), (1.0 - y.share(b)) * height);
    let content = html! {
        svg class="p" width="100%" height=(pixel(height)) viewBox={ "0 0 " (COLUMNS) " " (pixel(height)) } preserveAspectRatio="none" {
            @for curve in list.iter().filter(|curve| curve.look != Look::Points) {
                path class={ "l " (controller(curve.index)) } d=(path(&curve.points, place)) {}
            }
        }
        @for curve in list.iter().filter(|curve| curve.look != Look::Line) {
            @for &(a, b) in curve.points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) {
                @let at = place((a, b));
                circle class={ "point " (controller(curve.index)) } cx=(percent(at.0)) cy=(pixel(at.1)) r="3" {}
            }
        }
    };
    (y, content)
}

/// Points nearer than a third of a pixel are left out.
fn path(points: &[(f64, f64)], place: impl Fn((f64, f64)) -> (f64, f64)) -> String {
    let mut text = String::new();
    let mut last: Option<(f64, f64)> = None;
    for (i, point) in points.iter().enumerate() {
        let (share, y) = place(*point);
        if !(share.is_finite() && y.is_finite()) {
            last = None;
            continue;
        }
        let x = share * COLUMNS;
        let ends = points.get(i + 1).is_none_or(|next| !next.1.is_finite());
        if !ends && last.is_some_and(|(a, b)| (x - a).abs() < 0.4 && (y - b).abs() < 0.3) {
            continue;
        }
        text.push_str(&format!("{}{x:.1} {y:.1}", if last.is_none() { "M" } else { "L" }));
        last = Some((x, y));
    }
    text
}
