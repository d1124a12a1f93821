//! The file of a card: every figure as it was, with the bounds that it must keep.

use super::{Better, KEYS, LoopCard};
use crate::output::precision_name;
use crate::scenario::{Fault, closest, code, shortened, show_short, to_f64, type_name};
use crate::simulate::Precision;
use controller_pil::board::{BOARDS, Board, named};
use std::fmt::Write;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The version of the format.
const VERSION: f64 = 1.0;
const TOP: [&str; 5] = ["version", "controller", "precision", "board", "figures"];
const INSIDE: [&str; 3] = ["was", "min", "max"];
/// What a figure may lose before it counts as worse, as a share; per cent of overshoot, in points.
const SHARE: f64 = 0.05;
const POINTS: f64 = 5.0;

/// A card that was saved.
#[derive(Debug, Clone, PartialEq)]
pub struct CardFile {
    /// Name of the controller.
    pub controller: String,
    /// Number type of the law.
    pub precision: Precision,
    /// The board of memory and instructions.
    pub board: &'static Board,
    /// The figures that are checked, in the order of [`KEYS`].
    pub bounds: Vec<Bounds>,
}

/// What one figure was and must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// One of [`KEYS`].
    pub key: &'static str,
    /// Its value when the card was saved.
    pub was: Option<f64>,
    /// The least that it may be.
    pub min: Option<f64>,
    /// The most that it may be.
    pub max: Option<f64>,
}

impl CardFile {
    /// The text that [`read`](Self::read) reads: the figures of `card`, each with a bound a twentieth to its worse side;
    /// memory and instructions may not grow at all. A figure without limit must stay good. `command` is what made it.
    #[must_use]
    pub fn text(card: &LoopCard, command: &str) -> String {
        let mut text = String::new();
        let mut push = |line: std::fmt::Arguments<'_>| {
            // Writing to a text cannot fail.
            let _ = writeln!(text, "{line}");
        };
        push(format_args!("# The loop card of a controller, made by"));
        push(format_args!("# {}", command.replace(['\n', '\r'], " ")));
        push(format_args!("# `was` is for people; the check holds `min` and `max`, which may be changed."));
        push(format_args!("version = 1"));
        push(format_args!("controller = {}", toml::Value::String(card.name.clone())));
        push(format_args!("precision = \"{}\"", precision_name(card.precision)));
        push(format_args!("board = \"{}\"", card.board.name));
        push(format_args!("\n[figures]"));
        for figure in &card.figures {
            let unit = if figure.unit.is_empty() { String::new() } else { format!(" [{}]", figure.unit) };
            let bound = match (figure.better, bound(figure.key, figure.value, figure.better, card)) {
                (_, None) => String::new(),
                (Better::Smaller, Some(most)) => format!(", max = {}", number(most)),
                (Better::Larger, Some(least)) => format!(", min = {}", number(least)),
            };
            let line = format!("{} = {{ was = {}{bound} }}", figure.key, number(figure.value));
            push(format_args!("{line:60} # {}{unit}", figure.title));
        }
        for (key, why) in card.absent.iter().filter(|(key, _)| KEYS.contains(key)) {
            push(format_args!("# {key}: {why}"));
        }
        text
    }

    /// Reads a card.
    ///
    /// # Errors
    /// Everything that is wrong, in the order of the text: no TOML, unknown and missing keys, values of the wrong type,
    /// bounds that exclude each other.
    pub fn read(text: &str) -> Result<Self, Vec<Fault>> {
        let (document, errors) = DeTable::parse_recoverable(text);
        let mut faults: Vec<Fault> = errors
            .iter()
            .map(|error| {
                let span = error.span().unwrap_or(text.len()..text.len());
                Fault::new(code::SYNTAX, clamped(text, span), error.message().replace('\n', "; "))
            })
            .collect();
        // What stands beside a mistake of the syntax may not be what was meant.
        let file = if faults.is_empty() { read_root(document.get_ref(), &mut faults) } else { None };
        faults.sort_by_key(|fault| (fault.span.start, fault.span.end));
        match file {
            Some(file) if faults.is_empty() => Ok(file),
            _ => Err(faults),
        }
    }
}

/// The bound that a figure is saved with; none where there is nothing to hold.
fn bound(key: &str, value: f64, better: Better, card: &LoopCard) -> Option<f64> {
    let exact = matches!(key, "ram" | "instructions");
    let ts = card.trials.first().map_or(f64::NAN, |trial| trial.scenario.ts);
    match better {
        Better::Smaller if !value.is_finite() => None,
        Better::Smaller if exact => Some(value),
        Better::Smaller if key == "limit_overshoot" => Some(outward(value + POINTS, true)),
        Better::Smaller => Some(outward(value * (1.0 + SHARE), true)),
        Better::Larger if value.is_finite() => Some(outward(value * (1.0 - SHARE), false)),
        // From no limit to a good one is no loss.
        Better::Larger => match key {
            "gm" => Some(5.0),
            "pm_deg" => Some(60.0),
            "delay_margin" => Some(10.0 * ts).filter(|bound| bound.is_finite()),
            "jitter_margin" => Some(ts).filter(|bound| bound.is_finite()),
            _ => None,
        },
    }
}

/// Three digits, on the far side of `x`, which is not negative.
fn outward(x: f64, up: bool) -> f64 {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    let is_outside = if up { rounded >= x } else { rounded <= x };
    if is_outside || x == 0.0 {
        return rounded;
    }
    let digit = libm::pow(10.0, libm::floor(libm::log10(x)) - 2.0);
    let next = if up { rounded + digit } else { rounded - digit };
    format!("{next:.2e}").parse().unwrap_or(x)
}

/// A float of TOML, six digits.
fn number(x: f64) -> String {
    if x.is_finite() { show_short(x) } else { format!("{x:?}") }
}

fn read_root(root: &DeTable<'_>, faults: &mut Vec<Fault>) -> Option<CardFile> {
    unknown(root, &TOP, "the card", faults);
    for key in TOP.into_iter().filter(|key| !root.contains_key(*key)) {
        let message = format!("the card has no `{key}`");
        let help = "`controller-sim analyze loop.toml --save-card card.toml` writes a whole one";
        faults.push(Fault::new(code::MISSING_KEY, 0..0, message).help(help));
    }
    if let Some((value, span)) = value(root, "version")
        && to_f64(value) != Some(VERSION)
    {
        let message = format!("this version of cards is not known; this program reads version {VERSION}");
        faults.push(Fault::new(code::NOT_SUPPORTED, span, message).help("write `version = 1`"));
    }
    let controller = text(root, "controller", faults).map(|(name, _)| name.trim().to_owned());
    let precision = text(root, "precision", faults).and_then(|(name, span)| {
        let known = [("f32", Precision::F32), ("f64", Precision::F64)];
        choice(name, span, "precision", &known, faults)
    });
    let board = text(root, "board", faults).and_then(|(name, span)| {
        let known = BOARDS.each_ref().map(|board| (board.name, board));
        choice(name, span, "board", &known, faults).and_then(|board| named(board.name))
    });
    let mut bounds = Vec::new();
    match value(root, "figures") {
        Some((DeValue::Table(table), span)) => {
            unknown(table, &KEYS, "the figures", faults);
            bounds.extend(KEYS.into_iter().filter_map(|key| figure(table, key, faults)));
            if table.is_empty() {
                faults.push(Fault::new(code::MISSING_KEY, span, "the card has no figure to check"));
            }
        }
        Some((other, span)) => faults.push(wrong(span, "figures", "a table of figures", other)),
        None => {}
    }
    Some(CardFile { controller: controller?, precision: precision?, board: board?, bounds })
}

fn figure(table: &DeTable<'_>, key: &'static str, faults: &mut Vec<Fault>) -> Option<Bounds> {
    let (content, span) = value(table, key)?;
    let DeValue::Table(inside) = content else {
        let fault = wrong(span, key, "a table with `min` or `max`", content);
        faults.push(fault.help(format!("write `{key} = {{ max = 2.0 }}`")));
        return None;
    };
    unknown(inside, &INSIDE, &format!("`{key}`"), faults);
    let [was, min, max] = INSIDE.map(|name| {
        let (content, span) = value(inside, name)?;
        let number = to_f64(content);
        match number {
            None => faults.push(wrong(span.clone(), &format!("{key}.{name}"), "a number", content)),
            Some(x) if x.is_nan() => {
                let message = format!("`{key}.{name}` is not a number; allowed: every number, `inf`");
                faults.push(Fault::new(code::OUT_OF_RANGE, span.clone(), message));
            }
            Some(_) => {}
        }
        Some((number?, span))
    });
    if let (Some((least, at)), Some((most, _))) = (&min, &max)
        && least > most
    {
        let message = format!("`{key}.min` is above `{key}.max`: nothing fits between them");
        faults.push(Fault::new(code::CONFLICT, at.clone(), message));
    }
    let number = |bound: Option<(f64, Range<usize>)>| bound.map(|(x, _)| x);
    Some(Bounds { key, was: number(was), min: number(min), max: number(max) })
}

/// Keys that mean nothing.
fn unknown(table: &DeTable<'_>, known: &[&str], what: &str, faults: &mut Vec<Fault>) {
    for (key, _) in table.iter().filter(|(key, _)| !known.contains(&&**key.get_ref())) {
        let message = format!("unknown key `{}` in {what}", shortened(key.get_ref()));
        let help = match closest(key.get_ref(), known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are {}", known.join(", ")),
        };
        faults.push(Fault::new(code::UNKNOWN_KEY, key.span(), message).help(help));
    }
}

fn value<'a>(table: &'a DeTable<'a>, key: &str) -> Option<(&'a DeValue<'a>, Range<usize>)> {
    table.get(key).map(|value| (value.get_ref(), value.span()))
}

fn text<'a>(table: &'a DeTable<'a>, key: &str, faults: &mut Vec<Fault>) -> Option<(&'a str, Range<usize>)> {
    match value(table, key)? {
        (DeValue::String(text), span) => Some((&**text, span)),
        (other, span) => {
            faults.push(wrong(span, key, "a text in quotes", other));
            None
        }
    }
}

fn choice<T: Copy>(
    name: &str,
    span: Range<usize>,
    key: &str,
    known: &[(&str, T)],
    faults: &mut Vec<Fault>,
) -> Option<T> {
    let found = known.iter().find(|(word, _)| *word == name);
    if found.is_none() {
        let words: Vec<&str> = known.iter().map(|(word, _)| *word).collect();
        let message = format!("`{}` is no {key}; allowed: {}", shortened(name), words.join(", "));
        faults.push(Fault::new(code::UNKNOWN_CHOICE, span, message));
    }
    found.map(|(_, meant)| *meant)
}

fn wrong(span: Range<usize>, key: &str, wanted: &str, value: &DeValue<'_>) -> Fault {
    Fault::new(code::WRONG_TYPE, span, format!("`{key}` must be {wanted}, and this is {}", type_name(value)))
}

fn clamped(text: &str, span: Range<usize>) -> Range<usize> {
    let inside =
        |at: usize| (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let start = inside(span.start);
    start..inside(span.end).max(start)
}
