//! `[uncertainty]`: how far the plant may be from the one that is written; `batch sample` draws from it, a run does not.

use super::fault::{Fault, code};
use super::log::Log;
use super::table::Table;
use crate::batch::sample::{EXAMPLES, Spread, check_name};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const EXAMPLE: &str = "`[uncertainty]` and below it `gain = \"+-20 %\"`";

/// A quantity that is spread, and where that is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    /// Its name: `gain`, `lag`, `actuator.hi` and so on.
    pub name: String,
    /// How far.
    pub spread: Spread,
    /// Where.
    pub span: Range<usize>,
}

/// The section `[uncertainty]` of a scenario, or of a file that has nothing else, with or without its header. Nothing is
/// there: an empty list.
///
/// # Errors
/// Text that is no TOML; names and ranges that are none.
pub fn uncertainty(text: &str, is_alone: bool) -> Result<Vec<Uncertain>, Vec<Fault>> {
    let document = DeTable::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        vec![Fault::new(code::SYNTAX, span, error.message().to_owned())]
    })?;
    let root = document.get_ref();
    let (mut list, mut faults) = (Vec::new(), Vec::new());
    match (root.get_key_value("uncertainty"), is_alone) {
        (Some((_, section)), alone) => {
            for (key, _) in root.iter().filter(|(key, _)| alone && key.get_ref() != "uncertainty") {
                let message = format!("`{}` does not belong beside `[uncertainty]`", key.get_ref());
                faults.push(Fault::new(code::UNKNOWN_KEY, key.span(), message));
            }
            match section.get_ref() {
                DeValue::Table(section) => gather(section, "", &mut list, &mut faults),
                _ => faults.push(Fault::new(code::WRONG_TYPE, section.span(), format!("write {EXAMPLE}"))),
            }
        }
        (None, true) => gather(root, "", &mut list, &mut faults),
        (None, false) => {}
    }
    if faults.is_empty() { Ok(list) } else { Err(faults) }
}

/// Reports what is wrong with the section of a scenario.
pub(super) fn check(own: &Table<'_>) {
    let log: &Log<'_> = own.log;
    let Some(table) = own.table("uncertainty", EXAMPLE) else { return };
    let (mut list, mut faults) = (Vec::new(), Vec::new());
    gather(table.entries(), "", &mut list, &mut faults);
    faults.into_iter().for_each(|fault| log.fault(fault));
}

fn gather(table: &DeTable<'_>, path: &str, list: &mut Vec<Uncertain>, faults: &mut Vec<Fault>) {
    for (key, value) in table.iter() {
        let name =
            if path.is_empty() { key.get_ref().to_string() } else { format!("{path}.{}", key.get_ref()) };
        match value.get_ref() {
            DeValue::Table(inner) if path.is_empty() => gather(inner, &name, list, faults),
            DeValue::String(text) => match check_name(&name) {
                Err(why) => faults.push(Fault::new(code::UNKNOWN_KEY, key.span(), why)),
                Ok(()) => match Spread::parse(text) {
                    Ok(spread) => list.push(Uncertain { name, spread, span: value.span() }),
                    Err(why) => faults.push(wrong(&name, &why, value)),
                },
            },
            _ => faults.push(wrong(&name, "it is no text", value)),
        }
    }
    faults.sort_by_key(|fault| fault.span.start);
    list.sort_by_key(|uncertain| uncertain.span.start);
}

fn wrong(name: &str, why: &str, value: &Spanned<DeValue<'_>>) -> Fault {
    let message = format!("the range of `{name}` cannot be read: {why}");
    Fault::new(code::OUT_OF_RANGE, value.span(), message).help(EXAMPLES)
}
