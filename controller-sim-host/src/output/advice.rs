//! The comparison of all tuning rules, for people and for programs.

use super::design_json::Designed;
use super::json::text;
use super::table::format_number;
use crate::advise::{Advice, Outcome, Row};
use serde::Serialize;
use std::fmt::Write;

/// Largest maximum sensitivity of a robust loop.
const ROBUST: f64 = 2.0;
const COLUMNS: [&str; 6] = ["IAE sp", "IAE load", "Ms", "noise", "delay m.", "samples"];

/// The comparison as text, at most 100 columns wide.
#[must_use]
pub fn advice_table(advice: &Advice) -> String {
    let mut out = format!("{}, ts = {} s\n\n", advice.plant, advice.ts);
    let mut line = |content: String| {
        // Writing to a text cannot fail.
        let _ = writeln!(out, "{}", content.trim_end());
    };
    let cells = |cells: [String; 6]| cells.map(|cell| format!("{cell:>11}")).concat();
    line(format!("  {:<9}{}", "method", cells(COLUMNS.map(str::to_owned))));
    for row in &advice.rows {
        let name = row.method.name();
        match &row.outcome {
            Ok(made) => {
                let mut shown = numbers(made).map(format_number);
                if made.design.sampled.margins.ms > ROBUST {
                    shown[2].push('!');
                }
                if !made.warnings.is_empty() {
                    shown[..2].iter_mut().for_each(|cell| cell.push('*'));
                }
                line(format!("  {name:<9}{}", cells(shown)));
            }
            Err(_) => line(format!("  {name:<9}{:>11}", "refused")),
        }
    }
    line(String::new());
    line(
        "IAE of unit steps of the set-point and of the load, sampled loop [y s]; Ms of the sampled loop;"
            .to_owned(),
    );
    line(
        "noise: std(u)/std(n) for white noise on the measurement [u/y]; delay margin [s], and in samples"
            .to_owned(),
    );
    line(
        "at the same noise gain compare with `--kpidn G`, which the PID rules keep by their filters"
            .to_owned(),
    );
    line("! little robustness: Ms above 2; `--ms-max 2` slows the block of de-momi and dob down".to_owned());
    if advice.rows.iter().flat_map(|row| &row.outcome).any(|made| !made.warnings.is_empty()) {
        line("* may lack a part, see below".to_owned());
    }
    line(format!("\n{}", advice.on_the_period()));
    for note in advice.on_the_options() {
        line(note);
    }
    line("\ntake it when".to_owned());
    for row in &advice.rows {
        let name = row.method.name();
        let said = match &row.outcome {
            Ok(made) => {
                let warnings: String = made.warnings.iter().map(|text| format!("; * {text}")).collect();
                format!("{}{}{warnings}", row.method.when(), noisy(advice, row))
            }
            Err(refusal) => format!("refused: {refusal}; {}", refusal.help()),
        };
        for (index, part) in wrapped(&said, 86).into_iter().enumerate() {
            line(format!("  {:<9}{part}", if index == 0 { name } else { "" }));
        }
    }
    out
}

/// What to add of the noise, if it is much.
fn noisy(advice: &Advice, row: &Row) -> String {
    advice.noise_over_least(row).map_or(String::new(), |(ratio, least)| {
        format!("; {ratio:.0} times the noise gain of {}, the least", least.name())
    })
}

fn numbers(made: &Outcome) -> [f64; 6] {
    let margins = &made.design.sampled.margins;
    [
        made.iae_setpoint,
        made.iae_load,
        margins.ms,
        made.design.sampled.noise.white,
        margins.delay_margin,
        made.delay_margin_samples(),
    ]
}

/// The words in lines of at most `width` characters.
fn wrapped(words: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split(' ') {
        let Some(last) = lines.last_mut() else { break };
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > width {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

#[derive(Serialize)]
struct Comparison<'a> {
    version: &'static str,
    plant: String,
    ts: f64,
    period: String,
    notes: Vec<String>,
    methods: Vec<Entry<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    method: &'static str,
    when: &'static str,
    iae_setpoint: Option<f64>,
    iae_load: Option<f64>,
    delay_margin_samples: Option<f64>,
    noise_over_least: Option<f64>,
    design: Option<Designed<'a>>,
    warnings: &'a [String],
    refused: Option<String>,
    help: Option<&'static str>,
}

/// The comparison as JSON: see `schema.json`.
#[must_use]
pub fn advice_json(advice: &Advice) -> String {
    text(&Comparison {
        version: env!("CARGO_PKG_VERSION"),
        plant: advice.plant.to_string(),
        ts: advice.ts,
        period: advice.on_the_period(),
        notes: advice.on_the_options(),
        methods: advice.rows.iter().map(|row| entry(advice, row)).collect(),
    })
}

fn entry<'a>(advice: &Advice, row: &'a Row) -> Entry<'a> {
    let (made, refusal) = (row.outcome.as_ref().ok(), row.outcome.as_ref().err());
    Entry {
        method: row.method.name(),
        when: row.method.when(),
        iae_setpoint: made.map(|made| made.iae_setpoint),
        iae_load: made.map(|made| made.iae_load),
        delay_margin_samples: made.map(Outcome::delay_margin_samples),
        noise_over_least: advice.noise_over_least(row).map(|(ratio, _)| ratio),
        design: made.map(|made| Designed::new(&made.design, Some(made.iae_load), &[], None)),
        warnings: made.map_or(&[], |made| &made.warnings),
        refused: refusal.map(ToString::to_string),
        help: refusal.map(|refusal| refusal.help()),
    }
}
