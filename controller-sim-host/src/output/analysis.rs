//! What `analyze` prints: tables and JSON.

use super::card::{Card, Checked, Held, card_object, check_object};
use super::json::{Place, Written, places, text};
use super::table::{format_number, plant_text};
use crate::analysis::{Analysis, Noise, Side};
use crate::card::LoopCard;
use crate::scenario::{Fault, Scenario};
use controller_design::margins::Margins;
use serde::Serialize;

/// The analysis of one case of a scenario.
#[derive(Debug)]
pub struct Analysed<'a> {
    /// Name of the file.
    pub name: &'a str,
    /// Which case of its sweep.
    pub case: Option<&'a str>,
    /// Text of the file.
    pub text: &'a str,
    /// The scenario.
    pub scenario: &'a Scenario,
    /// What is odd about it.
    pub warnings: &'a [Fault],
    /// Of each controller, or its name and why there is none.
    pub controllers: Vec<Result<Analysis, (String, String)>>,
    /// The card of each controller, or why there is none; empty when nobody asked for cards.
    pub cards: Vec<Result<LoopCard, String>>,
    /// What the check of a card found.
    pub checked: Option<Checked>,
}

#[derive(Serialize)]
struct Several<'a> {
    analyses: Vec<Object<'a>>,
}

#[derive(Serialize)]
struct Object<'a> {
    version: &'static str,
    scenario: &'a str,
    title: &'a str,
    case: Option<&'a str>,
    plant: String,
    ts: f64,
    latency: f64,
    files: Vec<&'a Written>,
    controllers: Vec<Controller<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    check: Option<Held<'a>>,
    warnings: Vec<Place<'a>>,
}

#[derive(Serialize)]
struct Controller<'a> {
    name: &'a str,
    refused: Option<&'a str>,
    stable: Option<bool>,
    unstable_poles: Option<usize>,
    continuous: Option<Form>,
    discrete: Option<Form>,
    #[serde(skip_serializing_if = "Option::is_none")]
    card: Option<Card<'a>>,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Form {
    robustness: Option<Robustness>,
    noise: Gains,
}

/// Infinite margins are null.
#[derive(Serialize)]
struct Robustness {
    ms: f64,
    omega_ms: f64,
    mt: f64,
    omega_mt: f64,
    gm: f64,
    gm_low: f64,
    pm_deg: f64,
    delay_margin: f64,
    delay_margin_samples: f64,
}

#[derive(Serialize)]
struct Gains {
    kpidn: f64,
    kden: f64,
    controller: f64,
    an: f64,
    white: f64,
}

impl From<&Noise> for Gains {
    fn from(n: &Noise) -> Self {
        Self { kpidn: n.kpidn, kden: n.kden, controller: n.controller, an: n.an, white: n.white }
    }
}

fn form(side: &Side, ts: f64) -> Form {
    let robustness = side.margins.as_ref().ok().map(|m| Robustness {
        ms: m.ms,
        omega_ms: m.omega_ms,
        mt: m.mt,
        omega_mt: m.omega_mt,
        gm: m.gm,
        gm_low: m.gm_low,
        pm_deg: m.pm_deg,
        delay_margin: m.delay_margin,
        delay_margin_samples: m.delay_margin / ts,
    });
    Form { robustness, noise: Gains::from(&side.noise) }
}

/// The analyses as JSON: of one case its object, of several `{"analyses": [...]}`.
#[must_use]
pub fn analysis_json(list: &[Analysed<'_>], files: &[Written]) -> String {
    let object = |one| object(one, files);
    match list {
        [only] => text(&object(only)),
        several => text(&Several { analyses: several.iter().map(object).collect() }),
    }
}

fn object<'a>(one: &'a Analysed<'_>, files: &'a [Written]) -> Object<'a> {
    let ts = one.scenario.ts;
    let card = |index: usize| one.cards.get(index).and_then(|card| card.as_ref().ok()).map(card_object);
    let controllers = one.controllers.iter().enumerate().map(|(index, result)| match result {
        Ok(a) => Controller {
            name: &a.name,
            refused: None,
            stable: Some(a.is_stable()),
            unstable_poles: Some(a.unstable_poles),
            continuous: Some(form(&a.continuous, ts)),
            discrete: Some(form(&a.discrete, ts)),
            card: card(index),
            warnings: &a.warnings,
        },
        Err((name, why)) => Controller {
            name,
            refused: Some(why),
            stable: None,
            unstable_poles: None,
            continuous: None,
            discrete: None,
            card: None,
            warnings: &[],
        },
    });
    Object {
        version: env!("CARGO_PKG_VERSION"),
        scenario: one.name,
        title: &one.scenario.title,
        case: one.case,
        plant: plant_text(one.scenario),
        ts,
        latency: one.scenario.latency,
        files: files.iter().collect(),
        controllers: controllers.collect(),
        check: one.checked.as_ref().map(check_object),
        warnings: places(one.name, one.text, one.warnings).collect(),
    }
}

/// A line of the table: what, its unit, and the numbers of both sides.
pub(crate) type Row = (&'static str, &'static str, String, String);

/// A margin: what, its unit, and how to read it.
type Margin = (&'static str, &'static str, fn(&Margins) -> f64);

/// The numbers of one controller, continuous and sampled side by side.
pub(crate) fn rows(a: &Analysis) -> Vec<Row> {
    let ts = a.sampled.ts();
    let margins: [Margin; 6] = [
        ("Ms, largest sensitivity", "", |m| m.ms),
        ("Mt, largest complementary sensitivity", "", |m| m.mt),
        ("gain margin", "", |m| m.gm),
        ("gain margin downwards", "", |m| m.gm_low),
        ("phase margin", "deg", |m| m.pm_deg),
        ("delay margin", "s", |m| m.delay_margin),
    ];
    let of = |side: &Side, value: &dyn Fn(&Margins) -> f64| {
        side.margins.as_ref().map_or_else(|_| "-".to_owned(), |m| shown(value(m)))
    };
    let mut rows: Vec<Row> = margins
        .iter()
        .map(|(what, unit, value)| (*what, *unit, of(&a.continuous, value), of(&a.discrete, value)))
        .filter(|(what, _, c, d)| {
            *what != "gain margin downwards" || [c, d].iter().any(|x| !matches!(&***x, "0" | "-"))
        })
        .collect();
    let samples = |m: &Margins| m.delay_margin / ts;
    rows.push(("", "samples", of(&a.continuous, &samples), of(&a.discrete, &samples)));
    let (c, d) = (&a.continuous.noise, &a.discrete.noise);
    let mut noise = |what, c: f64, d: f64| rows.push((what, "u/y", shown(c), shown(d)));
    noise("K_PIDn, PID at pi/(2 ts)", c.kpidn, d.kpidn);
    if a.sampled.law().compensates() {
        noise("K_DEn, estimator or observer there", c.kden, d.kden);
        noise("whole controller there", c.controller, d.controller);
    }
    noise("A_n, at high frequency; in the same sample", c.an, d.an);
    noise("white noise, std(u)/std(n)", c.white, d.white);
    rows
}

fn shown(x: f64) -> String {
    if x == f64::INFINITY { "inf".to_owned() } else { format_number(x) }
}

/// The analyses as text.
#[must_use]
pub fn analysis_table(one: &Analysed<'_>) -> String {
    let mut out = String::new();
    let title = [one.scenario.title.trim(), one.case.unwrap_or("")];
    let title: Vec<&str> = title.into_iter().filter(|part| !part.is_empty()).collect();
    if !title.is_empty() {
        out.push_str(&format!("{}\n", title.join(": ")));
    }
    let (ts, latency) = (one.scenario.ts, one.scenario.latency);
    out.push_str(&format!("plant {}\nts = {ts} s, latency = {latency} s\n", plant_text(one.scenario)));
    for result in &one.controllers {
        match result {
            Err((name, why)) => out.push_str(&format!("\n{name}\n  {why}\n")),
            Ok(a) => {
                out.push_str(&format!("\n{}\n  {:54}{:>12}{:>12}\n", a.name, "", "continuous", "sampled"));
                for (what, unit, c, d) in rows(a) {
                    let unit = if unit.is_empty() { String::new() } else { format!("[{unit}]") };
                    out.push_str(&format!("  {what:44}{unit:10}{c:>12}{d:>12}\n"));
                }
                for warning in &a.warnings {
                    out.push_str(&format!("  warning: {warning}\n"));
                }
            }
        }
    }
    out
}
