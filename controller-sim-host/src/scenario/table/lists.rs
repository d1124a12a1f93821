//! Lists in a table: of tables, of numbers, of anything.

use super::super::fault::{Fault, code};
use super::super::value::to_f64;
use super::{Located, Table};
use toml::de::DeValue;

impl<'a> Table<'a> {
    /// The tables of `[[key]]`, none when there is no such key.
    pub(in crate::scenario) fn tables(&self, key: &'static str) -> Vec<Table<'a>> {
        let Some((_, value, span)) = self.entry(key) else {
            return Vec::new();
        };
        let help = format!("each {key} begins with a line `[[{key}]]`");
        let Some(list) = value.as_array() else {
            self.wrong_type(key, value, span, "a list of tables", Some(help));
            return Vec::new();
        };
        let mut tables = Vec::new();
        for item in list.iter() {
            match item.get_ref().as_table() {
                // Keys of a list element are called by their own names: the place says which element it is.
                Some(entries) => {
                    let place = self.shift(item.span());
                    tables.push(Table::new(entries, self.offset, place, String::new(), self.log));
                }
                None => {
                    let place = self.shift(item.span());
                    self.wrong_type(key, item.get_ref(), place, "a table", Some(help.clone()));
                }
            }
        }
        tables
    }

    /// The items of a list, each with its place; a value that is no list is taken as the only one.
    pub(in crate::scenario) fn items(&self, key: &'static str) -> Vec<Located<&'a DeValue<'a>>> {
        match self.entry(key) {
            None => Vec::new(),
            Some((_, DeValue::Array(list), _)) => list
                .iter()
                .map(|item| Located { value: item.get_ref(), span: self.shift(item.span()) })
                .collect(),
            Some((_, value, span)) => vec![Located { value, span }],
        }
    }

    /// The items of a list; `example` says how to write one.
    pub(in crate::scenario) fn list(
        &self,
        key: &'static str,
        example: &str,
    ) -> Option<Vec<Located<&'a DeValue<'a>>>> {
        let (_, value, span) = self.entry(key)?;
        if value.is_array() {
            return Some(self.items(key));
        }
        self.wrong_type(key, value, span, "a list", Some(format!("write {example}")));
        None
    }

    /// The finite numbers of a list of `1..=most`; `example` says how to write one.
    pub(in crate::scenario) fn numbers(
        &self,
        key: &'static str,
        most: usize,
        example: &str,
    ) -> Option<Located<Vec<f64>>> {
        let (_, value, span) = self.entry(key)?;
        if !value.is_array() {
            self.wrong_type(key, value, span, "a list of numbers", Some(format!("write {example}")));
            return None;
        }
        let items = self.items(key);
        if items.is_empty() || items.len() > most {
            let message = format!("`{}` has {} numbers; allowed: 1 to {most}", self.name(key), items.len());
            self.log.fault(Fault::new(code::OUT_OF_RANGE, span, message).help(format!("write {example}")));
            return None;
        }
        let numbers = items.into_iter().map(|item| match to_f64(item.value) {
            Some(value) => self.finite(key, Located { value, span: item.span }, None),
            None => {
                self.wrong_type(key, item.value, item.span, "a number", Some(format!("write {example}")));
                None
            }
        });
        // All of them, for all faults at once.
        let numbers: Vec<Option<Located<f64>>> = numbers.collect();
        let value = numbers.into_iter().map(|number| number.map(|n| n.value)).collect::<Option<_>>()?;
        Some(Located { value, span })
    }
}
