//! The page of an identified process.

use super::drawing::{BELOW, pixel, time_axis};
use super::frame::{Frame, Line, TITLE, moments, range};
use super::legend;
use super::page::{document, notes, scroll};
use super::path::Between;
use super::scale::Axis;
use crate::output::Identification;
use crate::output::table::{format_number, rounded_numbers};
use maud::{Markup, html};

/// Height of the panels \[px\].
const OUTPUT: f64 = 260.0;
const OTHER: f64 = 110.0;

pub(super) fn page(finding: &Identification<'_>, command: &str) -> String {
    let name = finding.source.name;
    let content = html! { main { (sections(finding)) } };
    document("Identification of a process", &format!("Process of {name}"), &content, command)
}

/// Record, areas and model.
pub(super) fn sections(finding: &Identification<'_>) -> Markup {
    let found = finding.found;
    let simulated = found.simulate(&finding.recording);
    html! {
        p {
            (finding.recording.t.len()) " rows; at " (format_number(found.change_at)) " s the input "
            (finding.column(1, "u")) " goes from " (format_number(found.u0)) " to " (format_number(found.u_inf))
            ", the output " (finding.column(2, "y")) " from " (format_number(found.y0)) " to "
            (format_number(found.y_inf)) "; it is settled at " (format_number(found.settled_at)) " s."
        }
        (notes(&remarks(finding)))
        h2 id="record" { "Record and model" }
        (picture(finding, simulated.as_deref()))
        h2 id="areas" { "Areas" }
        p {
            "Used: " (finding.choice()) ". Raw areas are integrals of the record itself; where they do not tell K_P well "
            "enough, those of a fitted model take their place."
        }
        (areas(finding))
        h2 id="model" { "Model" }
        (model(finding))
    }
}

fn remarks(finding: &Identification<'_>) -> Vec<String> {
    let of_log = finding
        .log
        .remarks
        .iter()
        .map(|remark| format!("line {}: {}", remark.place(finding.source.text).line, remark.message));
    finding.warnings().map(|text| rounded_numbers(&text)).chain(of_log).collect()
}

/// The units of the areas, in those of input and output.
const AREA_UNITS: [&str; 6] =
    ["y/u", "y/u s", "y/u s\u{b2}", "y/u s\u{b3}", "y/u s\u{2074}", "y/u s\u{2075}"];

fn areas(finding: &Identification<'_>) -> Markup {
    let found = finding.found;
    let columns =
        [found.areas.values(), found.area_interval, found.raw_areas.values(), found.raw_area_interval];
    let table = html! {
        table class="areas" {
            thead {
                tr {
                    th scope="col" class="text" { "area" }
                    @for title in ["used", "\u{b1} (90 %)", "raw", "\u{b1} (90 %)"] {
                        th scope="col" { (title) }
                    }
                }
            }
            tbody {
                @for (k, unit) in AREA_UNITS.iter().enumerate() {
                    tr {
                        th scope="row" { "A" (k) " " span class="unit" { "[" (unit) "]" } }
                        @for column in &columns { td { (format_number(column[k])) } }
                    }
                }
            }
        }
    };
    html! {
        (scroll("areas", &table))
        p {
            "K_P of the magnitude optimum with a filter of " (format_number(found.tf)) " s: "
            (format_number(found.kp)) " \u{b1} " (format_number(found.kp_interval)) " (90 %)."
        }
        p {
            "The intervals cover noise, quantisation, the end of the record and the distance to the next richer model. "
            "They do not cover a disturbance during the record or a process that is not linear."
        }
    }
}

fn model(finding: &Identification<'_>) -> Markup {
    let found = finding.found;
    let (Some(model), Some(half)) = (found.model, found.model_interval) else {
        return html! { p { "No second-order model could be fitted." } };
    };
    let rows = [
        ("gain", "y/u", model.gain, half.gain),
        ("a1", "s", model.a1, half.a1),
        ("a2", "s\u{b2}", model.a2, half.a2),
        ("dead time", "s", model.dead_time, half.dead_time),
    ];
    let table = html! {
        table class="model" {
            thead {
                tr {
                    th scope="col" class="text" { "parameter" }
                    th scope="col" { "value" }
                    th scope="col" { "\u{b1} (90 %)" }
                }
            }
            tbody {
                @for (name, unit, value, half) in rows {
                    tr {
                        th scope="row" { (name) " " span class="unit" { "[" (unit) "]" } }
                        td { (format_number(value)) }
                        td { (format_number(half)) }
                    }
                }
            }
        }
    };
    html! {
        p { "gain*exp(-dead_time*s)/(1 + a1*s + a2*s\u{b2}), with intervals as those of the areas." }
        (scroll("model", &table))
        p { "Residuals: " (format_number(found.fit_rms)) " rms; noise of the record: " (format_number(found.sigma)) "." }
        @if let Some(expression) = finding.expression() {
            p id="expression" { "As the plant of a scenario:" }
            (scroll("expression", &html! { pre { code { (expression) } } }))
        }
    }
}

fn picture(finding: &Identification<'_>, simulated: Option<&[f64]>) -> Markup {
    let found = finding.found;
    let (t, u, y) = (finding.recording.t, finding.recording.u, finding.recording.y);
    let time = (t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(1.0));
    let axis = Axis::of_time(time.0, time.1, 9);
    let signal =
        |values: &[f64]| -> Vec<(f64, f64)> { t.iter().copied().zip(values.iter().copied()).collect() };
    let (output, input, model) = (signal(y), signal(u), simulated.map(signal));
    let residual =
        simulated.map(|model| signal(&y.iter().zip(model).map(|(y, m)| y - m).collect::<Vec<_>>()));
    let size = |signal: &[(f64, f64)]| range(signal.iter().map(|point| point.1));
    // Steady states, from when to when, and their means.
    let rests = [
        ((time.0, found.change_at), found.y0, found.u0, "baseline"),
        ((found.tail_from, time.1), found.y_inf, found.u_inf, "tail"),
    ];
    let names = [(found.change_at, "change"), (found.settled_at, "settled"), (found.tail_from, "tail")];
    let top = moments(&axis, &names, 0.0).1 + TITLE;
    let all = output.iter().chain(model.iter().flatten()).map(|point| point.1);
    let upper = Frame::new(&axis, range(all.chain([found.y0, found.y_inf])), top, OUTPUT);
    let middle = Frame::new(&axis, size(&input), upper.bottom() + TITLE, OTHER);
    let around_zero = |(lo, hi): (f64, f64)| (lo.min(-hi), hi.max(-lo));
    let lower = residual
        .as_deref()
        .map(|residual| Frame::new(&axis, size(residual).map(around_zero), middle.bottom() + TITLE, OTHER));
    let end = lower.as_ref().unwrap_or(&middle).bottom() + 6.0;
    let line = |class, points, between| Line { class, points, between };
    html! {
        figure class="plot" id="record-figure" {
            ul class="legend" {
                (legend::line("c0", "record"))
                @if model.is_some() { (legend::line("c1 k1", "model")) }
                (legend::area("rest", "at rest: baseline and tail"))
                (legend::line("level", "their means"))
            }
            svg class="canvas" height=(pixel(end + BELOW)) role="img" aria-labelledby="record-title record-desc" {
                title id="record-title" {
                    "Output, input and residual from " (format_number(time.0)) " s to " (format_number(time.1)) " s"
                }
                desc id="record-desc" {
                    "Output from " (format_number(found.y0)) " to " (format_number(found.y_inf)) " after the input went from "
                    (format_number(found.u0)) " to " (format_number(found.u_inf)) " at " (format_number(found.change_at))
                    " s. Residuals of the model: " (format_number(found.fit_rms)) " rms."
                }
                @for frame in [&upper, &middle] {
                    @for (from, _, _, name) in &rests { (frame.window("rest", *from, name)) }
                }
                (upper.grid(&format!("Output {}", finding.column(2, "y"))))
                (middle.grid(&format!("Input {}", finding.column(1, "u"))))
                (moments(&axis, &names, end).0)
                (upper.lines(&[line("c0", &output, Between::Moves)]))
                (middle.lines(&[line("c0", &input, Between::Held)]))
                @if let Some(model) = &model { (upper.lines(&[line("c1 k1", model, Between::Moves)])) }
                @for (from, y, u, name) in &rests {
                    (upper.level("level", *from, *y, name))
                    (middle.level("level", *from, *u, name))
                }
                @if let (Some(lower), Some(residual)) = (&lower, &residual) {
                    (lower.grid("Residual: record less model"))
                    (lower.lines(&[line("c0", residual, Between::Moves)]))
                    (lower.level("axis", time, 0.0, "no residual"))
                }
                (time_axis(&axis, end))
            }
            figcaption {
                "The areas integrate the record from the change to the beginning of the tail, whose mean is the final value. "
                "The model is simulated with the recorded input."
            }
        }
    }
}
