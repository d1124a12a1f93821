//! Texts for people: title, description, units, labels.

use super::Units;
use super::fault::{Fault, code};
use super::table::Table;
use super::value::shortened;

/// Longest title, in characters.
const LONGEST_TITLE: usize = 120;

/// Longest description, in characters: a page or two.
const LONGEST_DESCRIPTION: usize = 10_000;

/// Longest unit, in characters: it stands at an axis.
const LONGEST_UNIT: usize = 20;

/// Longest label of an event, in characters: it stands in a picture.
const LONGEST_LABEL: usize = 60;

/// `title`: what heads the report.
pub(super) fn title(root: &Table<'_>) -> String {
    line(root, "title", LONGEST_TITLE)
}

/// `description`: paragraphs divided by empty lines.
pub(super) fn description(root: &Table<'_>) -> String {
    let Some(text) = root.text("description") else { return String::new() };
    let length = text.value.chars().count();
    let odd = text.value.chars().any(|c| c.is_control() && !matches!(c, '\n' | '\r' | '\t'));
    if length > LONGEST_DESCRIPTION || odd {
        let problem = if odd { "has a character that cannot be printed" } else { "is too long" };
        let message = format!(
            "`description` {problem}; allowed: at most {LONGEST_DESCRIPTION} characters and line breaks, here {length}"
        );
        root.log.fault(Fault::new(code::OUT_OF_RANGE, text.span, message));
        return String::new();
    }
    text.value.replace("\r\n", "\n").trim().to_owned()
}

/// `[units] y, u`.
pub(super) fn units(root: &Table<'_>) -> Units {
    let Some(table) = root.table("units", "`[units]` and below it `y = \"degC\"` and `u = \"%\"`") else {
        return Units::default();
    };
    let units = Units { y: line(&table, "y", LONGEST_UNIT), u: line(&table, "u", LONGEST_UNIT) };
    table.finish();
    units
}

/// `label` of an event.
pub(super) fn label(event: &Table<'_>) -> String {
    line(event, "label", LONGEST_LABEL)
}

/// A text of at most `longest` characters on one line; empty when it is not written.
fn line(table: &Table<'_>, key: &'static str, longest: usize) -> String {
    let Some(text) = table.text(key) else { return String::new() };
    let problem = if text.value.chars().any(char::is_control) {
        "has a line break or a character that cannot be printed"
    } else if text.value.chars().count() > longest {
        "is too long"
    } else {
        return text.value.trim().to_owned();
    };
    let message = format!(
        "`{} = \"{}\"` {problem}; allowed: at most {longest} characters on one line",
        table.name(key),
        shortened(text.value)
    );
    table.log.fault(Fault::new(code::OUT_OF_RANGE, text.span, message));
    String::new()
}
