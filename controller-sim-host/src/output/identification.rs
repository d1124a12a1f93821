//! An identified process: text for people, JSON for programs.

use super::json::{Place, places, text};
use super::table::format_number;
use super::{Source, Written};
use crate::log::Log;
use controller_design::identification::{Identified, Recording};
use serde::Serialize;

/// What was found in a log.
#[derive(Debug, Clone, Copy)]
pub struct Identification<'a> {
    /// The file and its text.
    pub source: Source<'a>,
    /// What was read of it.
    pub log: &'a Log,
    /// The columns that it was found from.
    pub recording: Recording<'a>,
    /// The process.
    pub found: &'a Identified,
}

impl Identification<'_> {
    /// The name of a column with its unit, or what it is taken for.
    pub(crate) fn column(&self, index: usize, otherwise: &str) -> String {
        let of = |list: &[String]| list.get(index).filter(|text| !text.is_empty()).cloned();
        let name = of(&self.log.titles).unwrap_or_else(|| otherwise.to_owned());
        match of(&self.log.units) {
            Some(unit) => format!("{name} [{unit}]"),
            None => name,
        }
    }

    /// The way that was chosen, in words.
    pub(crate) fn choice(&self) -> String {
        let found = self.found;
        match found.chosen.name() {
            "fit" => format!(
                "fitted model: K_P has a standard deviation of {} (raw areas: {})",
                per_cent(found.kp_spread),
                per_cent(found.raw_kp_spread)
            ),
            _ => format!("raw areas: K_P has a standard deviation of {}", per_cent(found.kp_spread)),
        }
    }

    /// The warnings; which areas were chosen, and why, is no fault and stands in [`choice`](Self::choice).
    pub(crate) fn warnings(&self) -> impl Iterator<Item = String> {
        let is_choice = |text: &String| text.contains("areas of the fitted model are");
        self.found.warnings.iter().map(ToString::to_string).filter(move |text| !is_choice(text))
    }

    /// The model as an expression that every command takes.
    pub(crate) fn expression(&self) -> Option<String> {
        let model = self.found.model?;
        let short = |x: f64| format!("{}", format!("{x:.5e}").parse::<f64>().unwrap_or(x));
        let delay = if model.dead_time > 0.0 {
            format!("*exp(-{}*s)", short(model.dead_time))
        } else {
            String::new()
        };
        let second = if model.a2 > 0.0 { format!("+{}*s^2", short(model.a2)) } else { String::new() };
        Some(format!("{}{delay}/(1+{}*s{second})", short(model.gain), short(model.a1)))
    }
}

/// A share as a percentage.
pub(crate) fn per_cent(share: f64) -> String {
    if share <= 1.0 { format!("{} %", format_number(100.0 * share)) } else { "more than 100 %".to_owned() }
}

/// The process as a text for people.
#[must_use]
pub fn identify_table(finding: &Identification<'_>) -> String {
    let found = finding.found;
    let number = format_number;
    let mut text = format!(
        "{}: {} rows, input {}, output {}\n",
        finding.source.name,
        finding.recording.t.len(),
        finding.column(1, "u"),
        finding.column(2, "y")
    );
    text.push_str(&format!(
        "at {} s the input goes from {} to {}, the output from {} to {}, settled at {} s\n",
        number(found.change_at),
        number(found.u0),
        number(found.u_inf),
        number(found.y0),
        number(found.y_inf),
        number(found.settled_at)
    ));
    let steps = match found.quantisation {
        0.0 => String::new(),
        q => format!(", in steps of {}", number(q)),
    };
    text.push_str(&format!("noise of the output: {}{steps}\n", number(found.sigma)));
    text.push_str(&format!(
        "\n{:<6}{:>12}{:>12}{:>12}{:>12}\n",
        "area", "chosen", "+/- (90 %)", "raw", "+/- (90 %)"
    ));
    let rows = found.areas.values().into_iter().zip(found.area_interval);
    let raw = found.raw_areas.values().into_iter().zip(found.raw_area_interval);
    for (k, ((a, half), (b, other))) in rows.zip(raw).enumerate() {
        text.push_str(&format!(
            "A{k:<5}{:>12}{:>12}{:>12}{:>12}\n",
            number(a),
            number(half),
            number(b),
            number(other)
        ));
    }
    text.push_str(&format!("chosen: {}\n", finding.choice()));
    text.push_str(&format!(
        "K_P of the magnitude optimum with tf = {} s: {} +/- {} (90 %), a standard deviation of {}\n",
        number(found.tf),
        number(found.kp),
        number(found.kp_interval),
        per_cent(found.kp_spread)
    ));
    if let (Some(model), Some(half)) = (found.model, found.model_interval) {
        text.push_str(&format!("\n{:<10}{:>12}{:>12}\n", "model", "value", "+/- (90 %)"));
        for (name, value, half) in [
            ("gain", model.gain, half.gain),
            ("a1 [s]", model.a1, half.a1),
            ("a2 [s^2]", model.a2, half.a2),
            ("dead_time", model.dead_time, half.dead_time),
        ] {
            text.push_str(&format!("{name:<10}{:>12}{:>12}\n", number(value), number(half)));
        }
        text.push_str(&format!("residuals of the model: {} rms\n", number(found.fit_rms)));
    }
    if let Some(expression) = finding.expression() {
        text.push_str(&format!("plant \"{expression}\"\n"));
    }
    let warnings: Vec<String> = finding.warnings().collect();
    if !warnings.is_empty() {
        text.push_str("\nwarnings:\n");
        for warning in &warnings {
            text.push_str(&format!("  {warning}\n"));
        }
    }
    text
}

#[derive(Serialize)]
pub(super) struct Object<'a> {
    version: &'static str,
    log: &'a str,
    rows: usize,
    columns: [&'a str; 3],
    areas: [f64; 6],
    model: Option<Model>,
    plant: Option<String>,
    uncertainty: Uncertainty,
    fit_rms: f64,
    chosen: &'static str,
    kp: f64,
    tf: f64,
    raw_areas: [f64; 6],
    fit: Option<Fit>,
    noise: Noise,
    before: State,
    after: State,
    change_at: f64,
    settled_at: f64,
    tail_from: f64,
    files: &'a [Written],
    warnings: Vec<Place<'a>>,
}

#[derive(Serialize)]
struct Model {
    gain: f64,
    a1: f64,
    a2: f64,
    dead_time: f64,
}

/// Half widths of 90 % intervals; a spread is the same as a relative standard deviation: the half width
/// over 1.8 times the value.
#[derive(Serialize)]
struct Uncertainty {
    areas: [f64; 6],
    raw_areas: [f64; 6],
    model: Option<Model>,
    kp: f64,
    kp_spread: f64,
    raw_kp_spread: f64,
}

#[derive(Serialize)]
struct Fit {
    order: usize,
    gain: f64,
    b1: f64,
    a: [f64; 4],
    dead_time: f64,
    rms: f64,
    areas: [f64; 6],
}

#[derive(Serialize)]
struct Noise {
    sigma: f64,
    quantisation: f64,
}

#[derive(Serialize)]
struct State {
    u: f64,
    y: f64,
}

/// The process as JSON. Warnings are those of the log with their places, then those of the identification with the code
/// `identify` and no place.
#[must_use]
pub fn identify_json(finding: &Identification<'_>, files: &[Written]) -> String {
    text(&Object::new(finding, files))
}

impl<'a> Object<'a> {
    pub(super) fn new(finding: &Identification<'a>, files: &'a [Written]) -> Self {
        let found = finding.found;
        let model = |m: controller_design::identification::SecondOrder| Model {
            gain: m.gain,
            a1: m.a1,
            a2: m.a2,
            dead_time: m.dead_time,
        };
        let title = |index: usize| finding.log.titles.get(index).map_or("", String::as_str);
        let of_log = places(finding.source.name, finding.source.text, &finding.log.remarks);
        let own = found.warnings.iter().map(|warning| Place::nowhere("identify", warning.to_string(), None));
        Self {
            version: env!("CARGO_PKG_VERSION"),
            log: finding.source.name,
            rows: finding.recording.t.len(),
            columns: [title(0), title(1), title(2)],
            areas: found.areas.values(),
            model: found.model.map(model),
            plant: finding.expression(),
            uncertainty: Uncertainty {
                areas: found.area_interval,
                raw_areas: found.raw_area_interval,
                model: found.model_interval.map(model),
                kp: found.kp_interval,
                kp_spread: found.kp_spread,
                raw_kp_spread: found.raw_kp_spread,
            },
            fit_rms: found.fit_rms,
            chosen: found.chosen.name(),
            kp: found.kp,
            tf: found.tf,
            raw_areas: found.raw_areas.values(),
            fit: found.fit.map(|fit| Fit {
                order: fit.order,
                gain: fit.gain,
                b1: fit.b1,
                a: fit.a,
                dead_time: fit.dead_time,
                rms: fit.rms,
                areas: fit.areas.values(),
            }),
            noise: Noise { sigma: found.sigma, quantisation: found.quantisation },
            before: State { u: found.u0, y: found.y0 },
            after: State { u: found.u_inf, y: found.y_inf },
            change_at: found.change_at,
            settled_at: found.settled_at,
            tail_from: found.tail_from,
            files,
            warnings: of_log.chain(own).collect(),
        }
    }
}
