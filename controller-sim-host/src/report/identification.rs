//! The page of an identified process.

use super::drawing::{COLUMNS, LEFT, percent, pixel, time_axis};
use super::page::document;
use super::path::{Between, Pen, hundredths};
use super::scale::Axis;
use crate::output::Identification;
use crate::output::table::format_number;
use maud::{Markup, html};

/// Height of a panel's title \[px\].
const TITLE: f64 = 27.0;

/// A line of a panel.
struct Line<'a> {
    values: &'a [f64],
    between: Between,
    class: &'static str,
}

/// A level from when to when.
struct Level {
    time: (f64, f64),
    value: f64,
    label: &'static str,
}

struct Panel<'a> {
    title: String,
    height: f64,
    lines: Vec<Line<'a>>,
    levels: Vec<Level>,
}

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
            (notes(finding))
            section aria-labelledby="record" {
                h2 id="record" { "Record and model" }
                (picture(finding, simulated.as_deref()))
            }
            section aria-labelledby="areas" {
                h2 id="areas" { "Areas" }
                p { "Chosen: " (finding.choice()) "." }
                (areas(finding))
            }
            section aria-labelledby="model" {
                h2 id="model" { "Model" }
                (model(finding))
            }
    }
}

fn notes(finding: &Identification<'_>) -> Markup {
    let of_log = finding
        .log
        .remarks
        .iter()
        .map(|remark| format!("line {}: {}", remark.place(finding.source.text).line, remark.message));
    let all: Vec<String> = finding.found.warnings.iter().map(ToString::to_string).chain(of_log).collect();
    html! {
        @if !all.is_empty() {
            div class="notes" role="note" {
                ul { @for note in &all { li { (note) } } }
            }
        }
    }
}

fn areas(finding: &Identification<'_>) -> Markup {
    let found = finding.found;
    let columns =
        [found.areas.values(), found.area_interval, found.raw_areas.values(), found.raw_area_interval];
    html! {
        div class="scroll" role="region" tabindex="0" aria-labelledby="areas" {
            table class="areas" {
                thead {
                    tr {
                        th scope="col" class="text" { "area" }
                        @for title in ["chosen", "\u{b1} (90 %)", "raw", "\u{b1} (90 %)"] {
                            th scope="col" { (title) }
                        }
                    }
                }
                tbody {
                    @for k in 0..6 {
                        tr {
                            th scope="row" {
                                "A" (k) " "
                                span class="unit" { (if k == 0 { "y/u".to_owned() } else { format!("y/u s^{k}") }) }
                            }
                            @for column in &columns { td { (format_number(column[k])) } }
                        }
                    }
                }
            }
        }
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
    html! {
        div class="scroll" role="region" tabindex="0" aria-labelledby="model" {
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
                            th scope="row" { (name) " " span class="unit" { (unit) } }
                            td { (format_number(value)) }
                            td { (format_number(half)) }
                        }
                    }
                }
            }
        }
        p { "Residuals: " (format_number(found.fit_rms)) " rms; noise of the record: " (format_number(found.sigma)) "." }
        @if let Some(expression) = finding.expression() {
            div class="scroll" role="region" tabindex="0" aria-labelledby="model" { pre { code { (expression) } } }
        }
    }
}

fn picture(finding: &Identification<'_>, simulated: Option<&[f64]>) -> Markup {
    let found = finding.found;
    let (t, u, y) = (finding.recording.t, finding.recording.u, finding.recording.y);
    let time = (t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(1.0));
    let residuals: Vec<f64> =
        simulated.map_or(Vec::new(), |model| y.iter().zip(model).map(|(y, m)| y - m).collect());
    let line = |values, between, class| Line { values, between, class };
    let mut output = vec![line(y, Between::Moves, "c0")];
    output.extend(simulated.map(|model| line(model, Between::Moves, "c1 k1")));
    let levels = vec![
        Level { time: (time.0, found.change_at), value: found.y0, label: "baseline" },
        Level { time: (found.tail_from, time.1), value: found.y_inf, label: "tail" },
    ];
    let panel = |title: String, height, lines, levels| Panel { title, height, lines, levels };
    let mut panels = vec![
        panel(format!("Output {}", finding.column(2, "y")), 260.0, output, levels),
        panel(
            format!("Input {}", finding.column(1, "u")),
            110.0,
            vec![line(u, Between::Held, "c0")],
            Vec::new(),
        ),
    ];
    if !residuals.is_empty() {
        let zero = vec![Level { time, value: 0.0, label: "no residual" }];
        let title = "Residual: record less model".to_owned();
        panels.push(panel(title, 110.0, vec![line(&residuals, Between::Moves, "c0")], zero));
    }
    let axis = Axis::of_time(time.0, time.1, 9);
    let mut at = 22.0;
    let mut parts = Vec::new();
    for panel in &panels {
        at += TITLE;
        parts.push(draw(panel, t, time, &axis, at));
        at += panel.height;
    }
    let end = at + 6.0;
    let marks = [("change", found.change_at), ("settled", found.settled_at), ("tail", found.tail_from)];
    let height = end + 34.0;
    html! {
        figure {
            ul class="legend" {
                @for (class, text) in [("c0", "record"), ("c1 k1", "model"), ("level", "baseline and tail")] {
                    li {
                        svg class="plot" width="30" height="10" aria-hidden="true" {
                            line class={ "l " (class) } x1="0" x2="30" y1="5" y2="5" {}
                        }
                        (text)
                    }
                }
            }
            svg class="plot canvas" height=(pixel(height)) role="img" aria-labelledby="picture" {
                title id="picture" {
                    "Output, input and residual from " (format_number(time.0)) " s to " (format_number(time.1)) " s"
                }
                g class="events" {
                    @for (index, (name, t)) in marks.into_iter().enumerate() {
                        @let x = percent(axis.share(t));
                        line x1=(x) x2=(x) y1="14" y2=(pixel(end)) {}
                        svg class="p" x=(x) {
                            // The tail may begin where the output is settled: its name goes to the left.
                            text class={ "name" @if index == 1 { " n" } } x=(if index == 1 { "-4" } else { "4" }) y="11" { (name) }
                        }
                    }
                }
                @for part in &parts { (part) }
                (time_axis(&axis, end))
            }
            figcaption {
                "The areas integrate the record from the change to the beginning of the tail, whose mean is the final value. "
                "The model is simulated with the recorded input."
            }
        }
    }
}

fn draw(panel: &Panel<'_>, t: &[f64], time: (f64, f64), axis: &Axis, top: f64) -> Markup {
    let all = panel.lines.iter().flat_map(|line| line.values.iter().copied());
    let all = all.chain(panel.levels.iter().map(|level| level.value)).filter(|x| x.is_finite());
    let range = all.fold(None, |range: Option<(f64, f64)>, x| {
        Some(range.map_or((x, x), |(lo, hi)| (lo.min(x), hi.max(x))))
    });
    let values = Axis::of_values(range, ((panel.height / 33.0) as usize).max(2));
    let bottom = top + panel.height;
    let place = |share: f64| pixel(bottom - share * panel.height);
    let x = |t: f64| hundredths((t - time.0) / (time.1 - time.0).max(f64::MIN_POSITIVE) * COLUMNS);
    let y = |value: f64| hundredths((1.0 - values.share(value)) * panel.height);
    html! {
        g class="grid" {
            @for tick in &values.ticks {
                line x1="0" x2="100%" y1=(place(tick.share)) y2=(place(tick.share)) {}
            }
            @for tick in &axis.ticks {
                line x1=(percent(tick.share)) x2=(percent(tick.share)) y1=(pixel(top)) y2=(pixel(bottom)) {}
            }
        }
        text class="title" x=(pixel(-LEFT)) y=(pixel(top - 9.0)) { (panel.title) (values.unit("")) }
        @for tick in &values.ticks {
            text class="n" x="-7" y=(pixel(bottom - tick.share * panel.height + 4.0)) { (tick.label) }
        }
        svg class="p" y=(pixel(top)) width="100%" height=(pixel(panel.height))
            viewBox={ "0 0 " (COLUMNS) " " (panel.height) } preserveAspectRatio="none" {
            @for line in &panel.lines {
                path class={ "l " (line.class) } d=(path(line, t, &x, &y)) {}
            }
            @for level in &panel.levels {
                @let (from, to) = (x(level.time.0), x(level.time.1));
                @if from < to {
                    path class="level" d={ "M" (from as f64 / 100.0) " " (y(level.value) as f64 / 100.0) "H" (to as f64 / 100.0) } {
                        title { (level.label) }
                    }
                }
            }
        }
        line class="axis" x1="0" x2="100%" y1=(pixel(bottom)) y2=(pixel(bottom)) {}
    }
}

/// The rows as a line; of the many rows of a column of the picture the first, the extremes and the last.
fn path(line: &Line<'_>, t: &[f64], x: &dyn Fn(f64) -> i64, y: &dyn Fn(f64) -> i64) -> String {
    let mut pen = Pen::default();
    let rows: Vec<(i64, i64)> = t.iter().zip(line.values).map(|(t, v)| (x(*t), y(*v))).collect();
    let crowded = rows.len() > 2 * COLUMNS as usize;
    let same = |a: &(i64, i64), b: &(i64, i64)| crowded && a.0 / 100 == b.0 / 100;
    for group in rows.chunk_by(same) {
        let low = group.iter().min_by_key(|point| point.1);
        let high = group.iter().max_by_key(|point| point.1);
        let points = if group.len() > 4 {
            [group.first(), low, high, group.last()].into_iter().flatten().copied().collect()
        } else {
            group.to_vec()
        };
        for (x, y) in points {
            if line.between == Between::Held {
                pen.across(x);
            }
            pen.to(x, y);
        }
    }
    pen.finish()
}
