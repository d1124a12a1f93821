//! A panel of a record: signals over time, marks and areas between its two axes.

use super::drawing::{COLUMNS, grid, percent, pixel};
use super::path::{Between, Pen, hundredths};
use super::scale::Axis;
use maud::{Markup, html};

/// Height of a panel's title \[px\].
pub(super) const TITLE: f64 = 30.0;
/// Height of a line of names \[px\].
pub(super) const NAME: f64 = 15.0;
/// Width of a character of a name \[px\], and of the picture on a telephone.
const CHARACTER: f64 = 6.6;
const NARROW: f64 = 300.0;

/// A signal: when it had which value.
pub(super) struct Line<'a> {
    pub(super) class: &'a str,
    pub(super) points: &'a [(f64, f64)],
    pub(super) between: Between,
}

/// A panel, placed.
pub(super) struct Frame<'a> {
    axis: &'a Axis,
    values: Axis,
    pub(super) top: f64,
    pub(super) height: f64,
}

/// The smallest and the largest of these values; those that are none are left out.
pub(super) fn range(list: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    list.filter(|x| x.is_finite()).fold(None, |range: Option<(f64, f64)>, x| {
        Some(range.map_or((x, x), |(lo, hi)| (lo.min(x), hi.max(x))))
    })
}

impl<'a> Frame<'a> {
    /// A panel over the time of `axis` for values within `range`.
    pub(super) fn new(axis: &'a Axis, range: Option<(f64, f64)>, top: f64, height: f64) -> Self {
        Self { axis, values: Axis::of_values(range, ((height / 33.0) as usize).max(2)), top, height }
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The place of a time, as a share of the width.
    pub(super) fn share(&self, t: f64) -> f64 {
        self.axis.share(t).clamp(0.0, 1.0)
    }

    /// The place of a value \[px\].
    pub(super) fn place(&self, y: f64) -> f64 {
        self.top + (1.0 - self.values.share(y).clamp(0.0, 1.0)) * self.height
    }

    pub(super) fn grid(&self, title: &str) -> Markup {
        html! {
            (grid(&self.values, self.axis, (self.top, self.height), title, ""))
            line class="axis" x1="0" x2="100%" y1=(pixel(self.bottom())) y2=(pixel(self.bottom())) {}
        }
    }

    /// Lines over one another.
    pub(super) fn lines(&self, list: &[Line<'_>]) -> Markup {
        html! {
            svg class="p" y=(pixel(self.top)) width="100%" height=(pixel(self.height))
                viewBox={ "0 0 " (COLUMNS) " " (self.height) } preserveAspectRatio="none" {
                @for line in list { path class={ "l " (line.class) } d=(self.path(line)) {} }
            }
        }
    }

    /// Of many points in a column the first, those that reach farthest and the last stay.
    fn path(&self, line: &Line<'_>) -> String {
        let mut pen = Pen::default();
        let column = |t: f64| (self.share(t) * COLUMNS) as usize;
        let finite = line.points.iter().copied().filter(|(t, y)| t.is_finite() && y.is_finite());
        let points: Vec<(f64, f64)> = finite.collect();
        for here in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
            if here.len() <= 4 {
                here.iter().for_each(|point| self.step(&mut pen, *point, line.between));
                continue;
            }
            let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
            let ends = [here.first(), here.iter().min_by(by), here.iter().max_by(by), here.last()];
            let mut kept: Vec<(f64, f64)> = ends.into_iter().flatten().copied().collect();
            kept.sort_by(|a, b| a.0.total_cmp(&b.0));
            kept.iter().for_each(|point| self.step(&mut pen, *point, line.between));
        }
        pen.finish()
    }

    fn step(&self, pen: &mut Pen, (t, y): (f64, f64), between: Between) {
        let x = hundredths(self.share(t) * COLUMNS);
        if between == Between::Held {
            pen.across(x);
        }
        pen.to(x, hundredths(self.place(y) - self.top));
    }

    /// An area between two times and two values.
    pub(super) fn area(&self, class: &str, t: (f64, f64), y: (f64, f64), title: &str) -> Markup {
        let (a, b) = (self.place(y.0), self.place(y.1));
        self.block(class, t, (a.min(b), (a - b).abs()), title)
    }

    /// An area between two times, of full height.
    pub(super) fn window(&self, class: &str, t: (f64, f64), title: &str) -> Markup {
        self.block(class, t, (self.top, self.height), title)
    }

    fn block(&self, class: &str, t: (f64, f64), (y, height): (f64, f64), title: &str) -> Markup {
        let (left, right) = (self.share(t.0), self.share(t.1));
        html! {
            rect class=(class) x=(percent(left)) width=(percent((right - left).max(0.0))) y=(pixel(y))
                height=(pixel(height)) { title { (title) } }
        }
    }

    /// A value between two times.
    pub(super) fn level(&self, class: &str, t: (f64, f64), value: f64, title: &str) -> Markup {
        let y = pixel(self.place(value));
        html! {
            line class=(class) x1=(percent(self.share(t.0))) x2=(percent(self.share(t.1))) y1=(y) y2=(y) {
                title { (title) }
            }
        }
    }
}

/// Hairlines at times, from their names above the panels down to `bottom`; those of NaN are left out. Gives the height of the
/// names, too.
pub(super) fn moments(axis: &Axis, list: &[(f64, &str)], bottom: f64) -> (Markup, f64) {
    // What a line of names is taken by, on a narrow page.
    let mut rows: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut placed = Vec::new();
    for &(t, name) in list.iter().filter(|(t, _)| axis.range().contains(t)) {
        let share = axis.share(t);
        let (at, width) = (share * NARROW, name.chars().count() as f64 * CHARACTER + 8.0);
        let ends = at + width > NARROW;
        let place = if ends { (at - width, at) } else { (at, at + width) };
        let free = |row: &Vec<(f64, f64)>| row.iter().all(|other| place.1 <= other.0 || other.1 <= place.0);
        let row = rows.iter().position(free).unwrap_or_else(|| {
            rows.push(Vec::new());
            rows.len() - 1
        });
        rows[row].push(place);
        placed.push((percent(share), NAME * row as f64, ends, name));
    }
    let height = NAME * rows.len() as f64;
    let content = html! {
        g class="events" {
            @for (x, y, ends, name) in &placed {
                line x1=(x) x2=(x) y1=(pixel(y + 3.0)) y2=(pixel(bottom)) {}
                svg class="p" x=(x) {
                    text class={ "name" @if *ends { " n" } } x=(if *ends { "-4" } else { "4" }) y=(pixel(y + 11.0)) { (name) }
                }
            }
        }
    };
    (content, height)
}
