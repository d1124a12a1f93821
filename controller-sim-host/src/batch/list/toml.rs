//! A list of processes as TOML.

use super::{Cell, Entry};
use crate::scenario::{Fault, code};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const KEYS: [&str; 3] = ["name", "plant", "family"];

/// The entries of the tables that have all they need.
pub(super) fn entries(text: &str, faults: &mut Vec<Fault>) -> Vec<Entry> {
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        faults.push(Fault::new(code::SYNTAX, clamped(text, span), error.message().replace('\n', "; ")));
    }
    if !faults.is_empty() {
        // What stands beside a mistake of the syntax may not be what was meant.
        return Vec::new();
    }
    let mut entries = Vec::new();
    for (key, value) in document.get_ref() {
        if key.get_ref() != "process" {
            let message = format!("`{}` means nothing here", key.get_ref());
            let help = "a list has tables `[[process]]` with `name`, `plant` and, if wanted, `family`";
            faults.push(Fault::new(code::UNKNOWN_KEY, key.span(), message).help(help));
            continue;
        }
        let DeValue::Array(list) = value.get_ref() else {
            let message = "`process` must be a list of tables: write `[[process]]`";
            faults.push(Fault::new(code::WRONG_TYPE, value.span(), message));
            continue;
        };
        entries.extend(list.iter().filter_map(|one| entry(text, one, faults)));
    }
    entries
}

fn entry(text: &str, one: &Spanned<DeValue<'_>>, faults: &mut Vec<Fault>) -> Option<Entry> {
    let DeValue::Table(table) = one.get_ref() else {
        faults.push(Fault::new(code::WRONG_TYPE, one.span(), "a process is a table with `name` and `plant`"));
        return None;
    };
    let mut cells: [Option<Cell>; 3] = [None, None, None];
    let mut is_wrong = false;
    for (key, value) in table {
        let Some(k) = KEYS.iter().position(|known| key.get_ref() == known) else {
            let message = format!("`{}` means nothing in a process", key.get_ref());
            faults.push(
                Fault::new(code::UNKNOWN_KEY, key.span(), message).help("there are name, plant, family"),
            );
            continue;
        };
        let DeValue::String(content) = value.get_ref() else {
            let message = format!("`{}` must be a text in quotes", KEYS[k]);
            faults.push(Fault::new(code::WRONG_TYPE, value.span(), message));
            is_wrong = true;
            continue;
        };
        let span = value.span();
        // Escapes and long texts do not stand in the file as they are.
        let is_plain = text.get(span.start + 1..span.end.saturating_sub(1)) == Some(&**content);
        let inside = is_plain.then_some(span.start + 1);
        cells[k] = Some(Cell { value: content.to_string(), span, inside });
    }
    for k in [0, 1] {
        if cells[k].is_none() && !is_wrong {
            let message = format!("the process has no `{}`", KEYS[k]);
            faults.push(Fault::new(code::MISSING_KEY, clamped(text, one.span()), message));
        }
    }
    let [Some(name), Some(plant), family] = cells else { return None };
    Some(Entry { name, plant, family })
}

fn clamped(text: &str, span: Range<usize>) -> Range<usize> {
    let start = (0..=span.start.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
    let end = (start..=span.end.min(text.len()).max(start)).rev().find(|&i| text.is_char_boundary(i));
    start..end.unwrap_or(start)
}
