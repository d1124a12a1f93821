//! What goes into a controller and into its commissioning file: parameters in both forms, limits, margins in words.

use super::page::scroll;
use super::parameters::{Line, lines};
use crate::analysis::Analysis;
use crate::design_file::is_open;
use crate::output::analysis::{Row, rows};
use crate::output::table::format_number;
use crate::quiet::{QUIET, by_noise, share};
use crate::scenario::{ControllerSpec, Scenario, show_short};
use controller_design::margins::Margins;
use maud::{Markup, html};

/// Largest sensitivity, least gain margin, phase margin \[deg\] and delay margin \[samples\] of a good loop.
const MS: f64 = 2.0;
const GAIN: f64 = 2.0;
const PHASE: f64 = 30.0;
const SAMPLES: f64 = 10.0;

/// Parameters and margins of a controller beside each other. `id` is that of the table of the margins, `of` what is spoken;
/// the verdicts are left out where a loop card gives them.
pub(super) fn card(
    id: &str,
    scenario: &Scenario,
    spec: Option<&ControllerSpec>,
    analysis: &Analysis,
    of: &str,
    verdicts: bool,
) -> Markup {
    html! {
        div class="card" {
            @if let Some(spec) = spec { (parameters(&format!("{id}-parameters"), scenario, spec, of)) }
            (margins(id, analysis, of, verdicts))
        }
        @if let Some(text) = spec.and_then(|spec| quiet(scenario, spec, analysis)) { p { (text) } }
    }
}

/// The parameters of a controller, those of the parallel form in the standard form, too.
fn parameters(id: &str, scenario: &Scenario, spec: &ControllerSpec, of: &str) -> Markup {
    let groups = groups(scenario, spec);
    let table = html! {
        table class="areas" {
            thead { tr {
                th scope="col" class="text" id=(id) { "Parameters" span class="spoken" { " of " (of) } }
                th scope="col" { "value" }
                th scope="col" class="text" { "unit" }
            } }
            @for (title, rows) in groups.iter().filter(|(_, rows)| !rows.is_empty()) {
                tbody {
                    tr { th scope="rowgroup" colspan="3" class="window" { span { (title) } } }
                    @for line in rows {
                        tr {
                            th scope="row" { (line.name) }
                            @for value in &line.values { td { (value) } }
                            td class="text unit" { (line.unit) }
                        }
                    }
                }
            }
        }
    };
    scroll(id, &table)
}

fn groups(scenario: &Scenario, spec: &ControllerSpec) -> Vec<(&'static str, Vec<Line>)> {
    let line = |name: &str, unit: &str, value: String| Line {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: vec![value],
    };
    let (parallel, mut rest): (Vec<Line>, Vec<Line>) =
        lines(&[spec], scenario).into_iter().partition(|line| matches!(&*line.name, "kp" | "ki" | "kd"));
    let mut sampling = vec![line("sampling period ts", "s", show_short(scenario.ts))];
    if scenario.latency > 0.0 {
        sampling.push(line("latency", "s", show_short(scenario.latency)));
    }
    if !rest.iter().any(|line| line.name.starts_with("output from") || line.name.starts_with("output to")) {
        rest.push(line("output limits", "", "none set".to_owned()));
    }
    let pid = &spec.config.pid;
    let over = |value: f64| if value.is_finite() { show_short(value) } else { "none".to_owned() };
    let standard = match parallel.first() {
        Some(kp) if pid.kp != 0.0 => vec![
            line("KP, gain", &kp.unit, show_short(pid.kp)),
            line("TN, reset time", "s", over(pid.kp / pid.ki)),
            line("TV, derivative time", "s", over(pid.kd / pid.kp)),
        ],
        _ => Vec::new(),
    };
    let is_pid = !parallel.is_empty();
    vec![
        ("Sampling", sampling),
        ("Parallel form, kp + ki/s + kd s", parallel),
        ("Standard form, KP (1 + 1/(TN s) + TV s)", standard),
        (if is_pid { "Both forms" } else { "Controller" }, rest),
    ]
}

/// The margins of the design and of the law that runs, with a verdict on the latter.
fn margins(id: &str, analysis: &Analysis, of: &str, verdicts: bool) -> Markup {
    let table = html! {
        table {
            thead { tr {
                th scope="col" class="text" id=(id) { "Margins and noise" span class="spoken" { " of " (of) } }
                th scope="col" { "continuous" }
                th scope="col" { "sampled" }
                @if verdicts { th scope="col" class="text" { "verdict" } }
            } }
            tbody {
                @for row in rows(analysis) {
                    @let (what, unit, continuous, sampled) = &row;
                    tr {
                        th scope="row" {
                            (if what.is_empty() { "delay margin" } else { what })
                            @if !unit.is_empty() { " " span class="unit" { "[" (unit) "]" } }
                        }
                        td { (continuous) }
                        td { (sampled) }
                        @if verdicts { td class="text" {
                            @if let Some((good, bound)) = judged(&row, analysis) {
                                @if good { "good" } @else { strong { "poor" } }
                                " " span class="unit" { "(" (bound) ")" }
                            }
                        } }
                    }
                }
            }
        }
    };
    scroll(id, &table)
}

/// Whether the sampled loop is good in this line, and what is.
fn judged((what, unit, ..): &Row, analysis: &Analysis) -> Option<(bool, String)> {
    let m: &Margins = analysis.discrete.margins.as_ref().ok()?;
    let least = |value: f64, bound: f64| (value >= bound, format!("at least {bound}"));
    let most = |value: f64, bound: f64| (value <= bound, format!("at most {bound}"));
    match (*what, *unit) {
        (what, _) if what.starts_with("Ms") => Some(most(m.ms, MS)),
        ("gain margin", _) => Some(least(m.gm, GAIN)),
        ("gain margin downwards", _) => Some(most(m.gm_low, 1.0 / GAIN)),
        ("phase margin", _) => Some(least(m.pm_deg, PHASE)),
        ("", "samples") => Some(least(m.delay_margin / analysis.sampled.ts(), SAMPLES)),
        _ => None,
    }
}

/// How far the noise of the measurement moves the output of the controller.
fn quiet(scenario: &Scenario, spec: &ControllerSpec, analysis: &Analysis) -> Option<String> {
    let noise = scenario.noise.filter(|noise| noise.std > 0.0)?.std;
    let moved = by_noise(analysis.discrete.noise.white, noise);
    if !moved.is_finite() {
        return None;
    }
    let with = |x: f64, unit: &str| format!("{} {unit}", format_number(x)).trim_end().to_owned();
    let [y, u] = [&scenario.units.y, &scenario.units.u].map(|unit| super::words::unit(unit));
    let text = format!(
        "The measurement noise, with a standard deviation of {}, moves the output by {}",
        with(noise, &y),
        with(moved, &u)
    );
    let limits = &spec.config.limits;
    let range = share(moved, (limits.lo, limits.hi)).filter(|_| !is_open(limits));
    let is_known =
        lines(&[spec], scenario).iter().filter(|line| line.name.starts_with("output ")).count() >= 2;
    let Some(share) = range.filter(|_| is_known) else { return Some(format!("{text}.")) };
    let word = if share <= QUIET { "good" } else { "poor" };
    Some(format!(
        "{text}, {} % of its range: {word} (at most {} %).",
        format_number(100.0 * share),
        100.0 * QUIET
    ))
}
