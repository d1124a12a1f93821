//! The picture of a load-response experiment: the response with its features, the output below it.

use super::drawing::{LEFT, percent, pixel, time_axis};
use super::path::{Pen, hundredths};
use super::scale::Axis;
use super::words;
use controller_design::assessment::{Acceptance, Marks, Place};
use maud::{Markup, html};

/// Columns that a panel is divided into, whatever its width.
const COLUMNS: f64 = 1000.0;
/// Height of the panels and of a panel's title \[px\].
const RESPONSE: f64 = 280.0;
const OUTPUT: f64 = 130.0;
const TITLE: f64 = 27.0;
/// What is shown before and after the step, in times of the first peak.
const BEFORE: f64 = 1.0;
const AFTER: f64 = 6.0;

/// The signals of the experiment, as they were recorded.
#[derive(Debug, Clone, Copy)]
pub struct Signals<'a> {
    /// Time \[s\].
    pub t: &'a [f64],
    /// Set-point; empty when it was not recorded.
    pub setpoint: &'a [f64],
    /// Measurement.
    pub output: &'a [f64],
    /// Output of the controller.
    pub input: &'a [f64],
    /// Names of measurement and output in the record.
    pub names: (&'a str, &'a str),
}

/// A picture without its frame.
pub(super) struct Picture {
    pub(super) content: Markup,
    pub(super) height: f64,
    /// The time it shows \[s\].
    pub(super) time: (f64, f64),
}

/// Draws the part of the record that tells something.
pub(super) fn draw(signals: &Signals<'_>, marks: &Marks, acceptance: &Acceptance) -> Picture {
    let time = shown(signals, marks);
    let axis = Axis::of_time(time.0, time.1, 9);
    let seen = |t: f64| t >= time.0 && t <= time.1;
    let target = target(marks, acceptance);
    let pick = |t: &[f64], y: &[f64]| -> Vec<(f64, f64)> {
        let both = t.iter().copied().zip(y.iter().copied());
        both.filter(|(t, y)| seen(*t) && y.is_finite()).collect()
    };
    let output = pick(signals.t, signals.output);
    let setpoint = pick(signals.t, signals.setpoint);
    let input = pick(signals.t, signals.input);
    let smoothed: Vec<(f64, f64)> =
        marks.smoothed.iter().map(|place| (place.t, place.y)).filter(|(t, _)| seen(*t)).collect();
    let extra = target.iter().flat_map(|target| [(0.0, target.y.0), (0.0, target.y.1)]);
    let values: Vec<(f64, f64)> = output.iter().chain(&setpoint).copied().chain(extra).collect();

    let top = TITLE;
    let response = Frame::new(time, &axis, range(&values), top, RESPONSE);
    let below = Frame::new(time, &axis, range(&input), top + RESPONSE + TITLE, OUTPUT);
    let end = below.top + OUTPUT + 6.0;
    let title = |what: &str, name: &str| match words::cut(name.trim(), 30) {
        name if name.is_empty() || name.len() <= 1 => what.to_owned(),
        name => format!("{what}: {name}"),
    };
    let content = html! {
        (response.grid(&title("Measurement y, set-point r", signals.names.0)))
        (response.manual(marks))
        @if let Some(target) = &target { (response.target(target)) }
        (response.lines(&[("faint c0", &output, false), ("ref", &setpoint, true), ("c0", &smoothed, false)]))
        (response.baseline(marks))
        @for (name, place) in [("P1", marks.peak), ("dip", marks.dip), ("P3", marks.third)] {
            @if let Some(place) = place.filter(|place| seen(place.t)) { (response.mark(name, place)) }
        }
        (below.grid(&title("Controller output u", signals.names.1)))
        (below.manual(marks))
        (below.lines(&[("c0", &input, true)]))
        (time_axis(&axis, end))
    };
    Picture { content, height: end + 34.0, time }
}

/// From a peak time before the step until the response has told all.
fn shown(signals: &Signals<'_>, marks: &Marks) -> (f64, f64) {
    let ends = (signals.t.first().copied().unwrap_or(0.0), signals.t.last().copied().unwrap_or(1.0));
    let Some(peak) = marks.peak else { return ends };
    let t1 = peak.t - marks.step;
    let last = marks.third.or(marks.dip).map_or(marks.step, |place| place.t + t1);
    let (from, to) = (marks.step - BEFORE * t1, (marks.step + AFTER * t1).max(last));
    (from.max(ends.0), to.min(ends.1))
}

/// Where the dip of a near-optimal loop is.
struct Target {
    t: (f64, f64),
    y: (f64, f64),
}

fn target(marks: &Marks, acceptance: &Acceptance) -> Option<Target> {
    let peak = marks.peak?;
    let (t1, p1) = (peak.t - marks.step, peak.y - marks.baseline);
    let (t, y) = (|ratio: f64| marks.step + ratio * t1, |share: f64| marks.baseline + share * p1);
    Some(Target {
        t: (t(acceptance.t_ratio.0), t(acceptance.t_ratio.1)),
        y: (y(acceptance.dip.0), y(acceptance.dip.1)),
    })
}

fn range(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let join = |a: Option<(f64, f64)>, y: f64| Some(a.map_or((y, y), |(lo, hi)| (lo.min(y), hi.max(y))));
    points.iter().map(|point| point.1).fold(None, join)
}

/// Class, points, whether the value is held to the next point.
type Line<'a> = (&'a str, &'a [(f64, f64)], bool);

/// A panel: two axes and where things are between them.
struct Frame<'a> {
    time: (f64, f64),
    axis: &'a Axis,
    values: Axis,
    top: f64,
    height: f64,
}

impl<'a> Frame<'a> {
    fn new(time: (f64, f64), axis: &'a Axis, range: Option<(f64, f64)>, top: f64, height: f64) -> Self {
        let values = Axis::of_values(range, ((height / 33.0) as usize).max(2));
        Self { time, axis, values, top, height }
    }

    /// The place of a time, as a share of the width.
    fn share(&self, t: f64) -> f64 {
        ((t - self.time.0) / (self.time.1 - self.time.0)).clamp(0.0, 1.0)
    }

    /// The place of a value \[px\].
    fn place(&self, y: f64) -> f64 {
        self.top + (1.0 - self.values.share(y).clamp(0.0, 1.0)) * self.height
    }

    fn grid(&self, title: &str) -> Markup {
        let bottom = self.top + self.height;
        let place = |share: f64| bottom - share * self.height;
        html! {
            g class="grid" {
                @for tick in &self.values.ticks {
                    line x1="0" x2="100%" y1=(pixel(place(tick.share))) y2=(pixel(place(tick.share))) {}
                }
                @for tick in &self.axis.ticks {
                    line x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(self.top)) y2=(pixel(bottom)) {}
                }
            }
            text class="title" x=(pixel(-LEFT)) y=(pixel(self.top - 9.0)) { (title) (self.values.unit("")) }
            @for tick in &self.values.ticks {
                text class="n" x="-7" y=(pixel(place(tick.share) + 4.0)) { (tick.label) }
            }
            line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
        }
    }

    /// Lines over one another.
    fn lines(&self, list: &[Line<'_>]) -> Markup {
        html! {
            svg class="p" y=(pixel(self.top)) width="100%" height=(pixel(self.height))
                viewBox={ "0 0 " (COLUMNS) " " (self.height) } preserveAspectRatio="none" {
                @for (class, points, held) in list {
                    path class={ "l " (class) } d=(self.path(points, *held)) {}
                }
            }
        }
    }

    /// Of many points in a column those that reach farthest stay.
    fn path(&self, points: &[(f64, f64)], held: bool) -> String {
        let mut pen = Pen::default();
        let column = |t: f64| (self.share(t) * COLUMNS) as usize;
        let mut rest = points;
        while let Some(first) = rest.first() {
            let count = rest.iter().take_while(|point| column(point.0) == column(first.0)).count();
            let (here, later) = rest.split_at(count);
            if count <= 4 {
                here.iter().for_each(|point| self.step(&mut pen, *point, held));
            } else {
                let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
                let ends = [here.iter().min_by(by), here.iter().max_by(by)];
                let mut kept: Vec<(f64, f64)> =
                    [here.first(), here.last()].into_iter().chain(ends).flatten().copied().collect();
                kept.sort_by(|a, b| a.0.total_cmp(&b.0));
                kept.iter().for_each(|point| self.step(&mut pen, *point, held));
            }
            rest = later;
        }
        pen.finish()
    }

    fn step(&self, pen: &mut Pen, (t, y): (f64, f64), held: bool) {
        let x = hundredths(self.share(t) * COLUMNS);
        if held {
            pen.across(x);
        }
        pen.to(x, hundredths(self.place(y) - self.top));
    }

    fn area(&self, class: &str, t: (f64, f64), y: (f64, f64), title: &str) -> Markup {
        let (left, right) = (self.share(t.0), self.share(t.1));
        let (a, b) = (self.place(y.0), self.place(y.1));
        html! {
            rect class=(class) x=(percent(left)) width=(percent(right - left)) y=(pixel(a.min(b)))
                height=(pixel((a - b).abs())) { title { (title) } }
        }
    }

    /// The time in manual, or at least the step.
    fn manual(&self, marks: &Marks) -> Markup {
        let (top, bottom) = (self.top, self.top + self.height);
        let x = percent(self.share(marks.step));
        let to = marks.auto.unwrap_or(self.time.1);
        html! {
            @let (left, right) = (self.share(marks.step), self.share(to));
            rect class="window" x=(percent(left)) width=(percent(right - left)) y=(pixel(top)) height=(pixel(bottom - top)) {
                title { "output held by hand" }
            }
            g class="events" { line x1=(x) x2=(x) y1=(pixel(top)) y2=(pixel(bottom)) {} }
        }
    }

    fn target(&self, target: &Target) -> Markup {
        self.area("target", target.t, target.y, "where the dip of a near-optimal loop is")
    }

    fn baseline(&self, marks: &Marks) -> Markup {
        let y = pixel(self.place(marks.baseline));
        html! { line class="level" x1="0" x2="100%" y1=(y) y2=(y) { title { "mean before the step" } } }
    }

    /// A feature: a circle on the response, its name beside it, a hairline down to the time axis.
    fn mark(&self, name: &str, place: Place) -> Markup {
        let (x, y) = (percent(self.share(place.t)), self.place(place.y));
        // Below the circle where there is no room above it.
        let label = if y < self.top + 20.0 { y + 18.0 } else { y - 9.0 };
        html! {
            g class="events" {
                line x1=(x) x2=(x) y1=(pixel(y)) y2=(pixel(self.top + self.height)) {}
            }
            circle class="point c1" cx=(x) cy=(pixel(y)) r="4.5" { title { (name) } }
            svg class="p" x=(x) { text class="feature" x="8" y=(pixel(label)) { (name) } }
        }
    }
}
