//! Loop cards and their checks: tables and JSON.

use super::precision_name;
use super::table::format_number;
use crate::card::{Check, Figure, Light, LoopCard};
use serde::Serialize;

/// Most columns of a line.
const WIDE: usize = 100;

/// A check and the file it was made with.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// The file of the card.
    pub path: String,
    /// What was found.
    pub check: Check,
}

#[derive(Serialize)]
pub(super) struct Card<'a> {
    precision: &'static str,
    board: &'static str,
    core: &'static str,
    good: usize,
    look: usize,
    bad: usize,
    figures: Vec<Entry<'a>>,
    absent: Vec<Absent<'a>>,
}

/// An infinite value is null, with `unlimited` true.
#[derive(Serialize)]
struct Entry<'a> {
    key: &'static str,
    title: &'static str,
    unit: &'a str,
    value: f64,
    unlimited: bool,
    light: &'static str,
    practice: &'a str,
    note: &'a str,
}

#[derive(Serialize)]
struct Absent<'a> {
    key: &'static str,
    why: &'a str,
}

#[derive(Serialize)]
pub(super) struct Held<'a> {
    card: &'a str,
    holds: bool,
    figures: Vec<Verdict<'a>>,
    unchecked: &'a [&'static str],
}

#[derive(Serialize)]
struct Verdict<'a> {
    key: &'static str,
    was: Option<f64>,
    is: Option<f64>,
    min: Option<f64>,
    max: Option<f64>,
    holds: bool,
    why: Option<&'a str>,
}

pub(super) fn card_object<'a>(card: &'a LoopCard) -> Card<'a> {
    let entry = |figure: &'a Figure| Entry {
        key: figure.key,
        title: figure.title,
        unit: &figure.unit,
        value: figure.value,
        unlimited: figure.value == f64::INFINITY,
        light: figure.light.word(),
        practice: &figure.practice,
        note: &figure.note,
    };
    Card {
        precision: precision_name(card.precision),
        board: card.board.name,
        core: card.board.core,
        good: card.count(Light::Good),
        look: card.count(Light::Look),
        bad: card.count(Light::Bad),
        figures: card.figures.iter().map(entry).collect(),
        absent: card.absent.iter().map(|(key, why)| Absent { key, why }).collect(),
    }
}

pub(super) fn check_object<'a>(checked: &'a Checked) -> Held<'a> {
    let verdict = |v: &'a crate::card::Verdict| Verdict {
        key: v.key,
        was: v.was,
        is: v.is,
        min: v.min,
        max: v.max,
        holds: v.holds,
        why: (!v.why.is_empty()).then_some(&*v.why),
    };
    Held {
        card: &checked.path,
        holds: checked.check.holds(),
        figures: checked.check.verdicts.iter().map(verdict).collect(),
        unchecked: &checked.check.unchecked,
    }
}

/// A value of a card as it is printed.
pub(crate) fn shown(value: f64) -> String {
    if value == f64::INFINITY {
        return "inf".to_owned();
    }
    // Bytes and instructions are counted.
    if value.fract() == 0.0 && value.abs() >= 10.0 && value.abs() < 1e9 {
        return format!("{value}");
    }
    format_number(value)
}

/// The card as text, at most 100 columns wide: each figure with its light, and what practice is where it is not good.
#[must_use]
pub fn card_table(card: &LoopCard) -> String {
    let mut out = format!(
        "\nloop card of {}, {}, {} ({}): {} good, {} look, {} bad\n",
        card.name,
        precision_name(card.precision),
        card.board.name,
        card.board.core,
        card.count(Light::Good),
        card.count(Light::Look),
        card.count(Light::Bad)
    );
    for figure in &card.figures {
        let unit = if figure.unit.is_empty() { String::new() } else { format!("[{}]", figure.unit) };
        let (title, value) = (figure.title, shown(figure.value));
        out.push_str(format!("  {title:42}{unit:14}{value:>11}   {}", figure.light.word()).trim_end());
        out.push('\n');
        if figure.light != Light::Good {
            let practice = format!("practice: {}", figure.practice);
            for text in [&practice, &figure.note].into_iter().filter(|text| !text.is_empty()) {
                push_wrapped(&mut out, text, 8);
            }
        }
    }
    for (key, why) in &card.absent {
        push_wrapped(&mut out, &format!("{key}: {why}"), 2);
    }
    out
}

/// What was, is, and may be, for people.
#[must_use]
pub fn check_table(checked: &Checked) -> String {
    let number = |x: Option<f64>| x.map_or("-".to_owned(), shown);
    let mut out =
        format!("\n{}\n  {:18}{:>12}{:>12}{:>12}{:>12}\n", checked.path, "figure", "was", "is", "min", "max");
    for v in &checked.check.verdicts {
        let word = match (v.holds, v.is) {
            (true, _) => "holds".to_owned(),
            (false, Some(_)) => "WORSE".to_owned(),
            (false, None) => "MISSING".to_owned(),
        };
        let [was, is, min, max] = [v.was, v.is, v.min, v.max].map(number);
        out.push_str(&format!("  {:18}{was:>12}{is:>12}{min:>12}{max:>12}   {word}\n", v.key));
        if !v.why.is_empty() {
            push_wrapped(&mut out, &v.why, 8);
        }
    }
    if !checked.check.unchecked.is_empty() {
        push_wrapped(&mut out, &format!("not in the card: {}", checked.check.unchecked.join(", ")), 2);
    }
    let failed = checked.check.verdicts.iter().filter(|v| !v.holds).count();
    out.push_str(&match failed {
        0 => "the loop keeps its card\n".to_owned(),
        1 => "1 figure does not keep its bounds\n".to_owned(),
        n => format!("{n} figures do not keep their bounds\n"),
    });
    out
}

/// Adds `text` in lines that begin after `indent` spaces.
fn push_wrapped(out: &mut String, text: &str, indent: usize) {
    let mut line = String::new();
    for word in text.split_whitespace() {
        let width = indent + line.chars().count() + 1 + word.chars().count();
        if !line.is_empty() && width > WIDE {
            out.push_str(&format!("{:indent$}{line}\n", ""));
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    out.push_str(&format!("{:indent$}{line}\n", ""));
}
