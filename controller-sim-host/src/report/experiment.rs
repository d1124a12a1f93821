//! The picture of a load-response experiment: the response with its features, the output below it.

use super::drawing::{BELOW, percent, pixel, time_axis};
use super::frame::{Frame, Line, TITLE, range};
use super::path::Between;
use super::scale::Axis;
use super::words;
use crate::output::table::format_number;
use controller_design::assessment::{Acceptance, Marks, Place};
use maud::{Markup, html};

/// Height of the panels and of a line of times between them \[px\].
const RESPONSE: f64 = 280.0;
const OUTPUT: f64 = 130.0;
const SPAN: f64 = 17.0;
/// What is shown before and after the step, in times of the first peak.
const BEFORE: f64 = 1.0;
const AFTER: f64 = 6.0;
/// Smallest feature that is marked, in standard deviations of the noise.
const NOISE: f64 = 2.0;
/// Room for the name of a mark, as a share of the range.
const ROOM: f64 = 0.09;

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
    /// It shows where a near-optimal loop has its dip.
    pub(super) target: bool,
    /// A dip or a third peak is so small that it is not marked.
    pub(super) hidden: bool,
}

/// Draws the part of the record that tells something.
/// `sigma` is the noise of a sample: what it alone could have drawn is not marked.
pub(super) fn draw(signals: &Signals<'_>, marks: &Marks, acceptance: &Acceptance, sigma: f64) -> Picture {
    let stands_out = |place: &Place| (place.y - marks.baseline).abs() >= NOISE * sigma;
    let (dip, third) = (marks.dip.filter(stands_out), marks.third.filter(stands_out));
    let hidden = (dip, third) != (marks.dip, marks.third);
    let time = shown(signals, marks);
    let axis = Axis::of_time(time.0, time.1, 9);
    let seen = |t: f64| t >= time.0 && t <= time.1;
    let target = target(marks, acceptance).filter(|target| target.t.0 < time.1);
    let pick = |t: &[f64], y: &[f64]| -> Vec<(f64, f64)> {
        let both = t.iter().copied().zip(y.iter().copied());
        both.filter(|(t, y)| seen(*t) && y.is_finite()).collect()
    };
    let output = pick(signals.t, signals.output);
    let setpoint = pick(signals.t, signals.setpoint);
    let input = pick(signals.t, signals.input);
    let smoothed: Vec<(f64, f64)> =
        marks.smoothed.iter().map(|place| (place.t, place.y)).filter(|(t, _)| seen(*t)).collect();
    let extra = target.iter().flat_map(|target| [target.y.0, target.y.1, target.third]);
    let values = range(output.iter().chain(&setpoint).map(|point| point.1).chain(extra));
    let room = |(lo, hi): (f64, f64)| (lo - ROOM * (hi - lo), hi + ROOM * (hi - lo));
    let values = if marks.peak.is_some() { values.map(room) } else { values };

    let response = Frame::new(&axis, values, TITLE, RESPONSE);
    let spans: Vec<(&str, Place)> =
        [("t1", marks.peak), ("t_dip", dip)].into_iter().filter_map(|(name, p)| Some((name, p?))).collect();
    let gap = spans.len() as f64 * SPAN + 4.0;
    let below = Frame::new(&axis, range(input.iter().map(|p| p.1)), response.bottom() + gap + TITLE, OUTPUT);
    let end = below.bottom() + 6.0;
    let title = |what: &str, name: &str| match words::cut(name.trim(), 30) {
        name if name.is_empty() || name.len() <= 1 => what.to_owned(),
        name => format!("{what}: {name}"),
    };
    let line = |class, points, between| Line { class, points, between };
    let content = html! {
        (response.grid(&title("Measurement y, set-point r", signals.names.0)))
        (manual(&response, marks, time.1))
        @if let Some(target) = &target { (near_optimal(&response, target)) }
        (response.lines(&[
            line("faint c0", &output, Between::Moves),
            line("ref", &setpoint, Between::Held),
            line("c0", &smoothed, Between::Moves),
        ]))
        (response.level("level", time, marks.baseline, "mean before the step"))
        @for (name, place) in [("P1", marks.peak), ("dip", dip), ("P3", third)] {
            @if let Some(place) = place.filter(|place| seen(place.t)) {
                (mark(&response, name, place, outwards(marks, place)))
            }
        }
        @for (row, (name, place)) in spans.iter().enumerate() {
            (span(&response, name, marks.step, *place, row))
        }
        (below.grid(&title("Controller output u", signals.names.1)))
        (manual(&below, marks, time.1))
        (below.lines(&[line("c0", &input, Between::Held)]))
        (time_axis(&axis, end))
    };
    Picture { content, height: end + BELOW, time, target: target.is_some(), hidden }
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
    /// The largest that the third peak is.
    third: f64,
}

fn target(marks: &Marks, acceptance: &Acceptance) -> Option<Target> {
    let peak = marks.peak?;
    let (t1, p1) = (peak.t - marks.step, peak.y - marks.baseline);
    let (t, y) = (|ratio: f64| marks.step + ratio * t1, |share: f64| marks.baseline + share * p1);
    Some(Target {
        t: (t(acceptance.t_ratio.0), t(acceptance.t_ratio.1)),
        y: (y(acceptance.dip.0), y(acceptance.dip.1)),
        third: y(acceptance.r3),
    })
}

/// Whether the load lowers the measurement: the picture is upside down.
pub(super) fn downwards(marks: &Marks) -> bool {
    marks.peak.is_some_and(|peak| peak.y < marks.baseline)
}

/// Whether the name of a mark belongs above it: outside of the curve.
fn outwards(marks: &Marks, place: Place) -> bool {
    let rises = !downwards(marks);
    let is_dip = marks.dip.is_some_and(|dip| dip.t == place.t);
    rises != is_dip
}

/// The time in manual, or at least the step.
fn manual(frame: &Frame<'_>, marks: &Marks, end: f64) -> Markup {
    let x = percent(frame.share(marks.step));
    html! {
        (frame.window("window", (marks.step, marks.auto.unwrap_or(end)), "output held by hand"))
        g class="events" { line x1=(x) x2=(x) y1=(pixel(frame.top)) y2=(pixel(frame.bottom())) {} }
    }
}

/// Where the dip of a near-optimal loop is, and how large its third peak is at most.
fn near_optimal(frame: &Frame<'_>, target: &Target) -> Markup {
    html! {
        (frame.area("target", target.t, target.y, "where the dip of a near-optimal loop is"))
        (frame.level("bound", (target.t.1, f64::MAX), target.third, "largest third peak of a near-optimal loop"))
    }
}

/// A feature: a circle on the response, its name outside of it, a hairline down to the times.
fn mark(frame: &Frame<'_>, name: &str, place: Place, above: bool) -> Markup {
    let (x, y) = (percent(frame.share(place.t)), frame.place(place.y));
    html! {
        g class="events" { line x1=(x) x2=(x) y1=(pixel(y)) y2=(pixel(frame.bottom())) {} }
        circle class="point c1" cx=(x) cy=(pixel(y)) r="4.5" { title { (name) } }
        text class="t feature" x=(x) y=(pixel(if above { y - 9.0 } else { y + 18.0 })) { (name) }
    }
}

/// A time from the step to a feature, below the panel.
fn span(frame: &Frame<'_>, name: &str, step: f64, place: Place, row: usize) -> Markup {
    let y = frame.bottom() + SPAN * (row as f64 + 0.75);
    let (from, to) = (frame.share(step), frame.share(place.t));
    let ends = to > 0.6;
    let tick = |share: f64| {
        html! { line class="span" x1=(percent(share)) x2=(percent(share)) y1=(pixel(y - 4.0)) y2=(pixel(y + 4.0)) {} }
    };
    html! {
        g class="ref" {
            line class="span" x1=(percent(from)) x2=(percent(to)) y1=(pixel(y)) y2=(pixel(y)) {}
            (tick(from))
            (tick(to))
        }
        // On the side where there is room.
        svg class="p" x=(percent(if ends { from } else { to })) y=(pixel(y)) {
            text class={ "feature" @if ends { " n" } } x=(if ends { "-6" } else { "6" }) y="4" {
                (name) " = " (format_number(place.t - step)) " s"
            }
        }
    }
}
