//! A walker over a TOML table: it hands out values with their places and notes everything that is wrong.

mod lists;

use super::fault::{Fault, code};
use super::log::Log;
use super::number::Allowed;
use super::suggest::closest;
use super::value::{number_in_text, shortened, to_f64, type_name};
use std::cell::RefCell;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The keys that stand above the first table.
const ABOVE_TABLES: [&str; 8] =
    ["version", "ts", "duration", "latency", "substeps", "title", "description", "include"];

/// A value and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Located<T> {
    pub(super) value: T,
    pub(super) span: Range<usize>,
}

/// A table that is being read. Every key that is asked for is known; [`finish`](Self::finish) reports the
/// others.
#[derive(Debug)]
pub(super) struct Table<'a> {
    entries: &'a DeTable<'a>,
    /// Where its text begins among all texts.
    offset: usize,
    /// Where to point at for what is missing: the header, or the whole inline table.
    pub(super) place: Range<usize>,
    path: String,
    is_root: bool,
    asked: RefCell<Vec<&'static str>>,
    /// Keys that must be there and are not, with their faults: a misspelt key takes its own away.
    missing: RefCell<Vec<(Vec<&'static str>, Fault)>>,
    pub(super) log: &'a Log<'a>,
}

impl<'a> Table<'a> {
    /// The whole of a text that begins at `offset` among all texts.
    pub(super) fn root(entries: &'a DeTable<'a>, offset: usize, log: &'a Log<'a>) -> Self {
        // What an included text lacks may stand in the other one.
        for key in ABOVE_TABLES.into_iter().filter(|&key| offset == 0 && !entries.contains_key(key)) {
            log.absent_above(key);
        }
        Self { is_root: true, ..Self::new(entries, offset, offset..offset, String::new(), log) }
    }

    fn new(
        entries: &'a DeTable<'a>,
        offset: usize,
        place: Range<usize>,
        path: String,
        log: &'a Log<'a>,
    ) -> Self {
        Self {
            entries,
            offset,
            place,
            path,
            is_root: false,
            asked: RefCell::default(),
            missing: RefCell::default(),
            log,
        }
    }

    /// The name of `key` in messages, for example `limits.lo`.
    pub(super) fn name(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// The name of the table itself.
    pub(super) fn whole_name(&self) -> String {
        self.path.clone()
    }

    /// The place of something in this table's text among all texts.
    fn shift(&self, span: Range<usize>) -> Range<usize> {
        span.start + self.offset..span.end + self.offset
    }

    /// The place of the key, its value and the place of that.
    fn entry(&self, key: &'static str) -> Option<(Range<usize>, &'a DeValue<'a>, Range<usize>)> {
        {
            let mut asked = self.asked.borrow_mut();
            if !asked.contains(&key) {
                asked.push(key);
            }
        }
        // The map borrows the key as text, which loses the place of the key: look it up together with the
        // value.
        self.entries
            .get_key_value(key)
            .map(|(k, v)| (self.shift(k.span()), v.get_ref(), self.shift(v.span())))
    }

    /// The value's place, when the key is there.
    pub(super) fn span(&self, key: &'static str) -> Option<Range<usize>> {
        self.entry(key).map(|(_, _, span)| span)
    }

    /// The key's own place, when it is there.
    pub(super) fn key_span(&self, key: &'static str) -> Option<Range<usize>> {
        self.entry(key).map(|(key, ..)| key)
    }

    /// Reports that `key` is not there; `example` says how to write it.
    pub(super) fn missing(&self, key: &'static str, example: &str) {
        self.missing_one_of(&[key], example);
    }

    /// Reports that none of `keys` is there, of which the first is the usual one.
    pub(super) fn missing_one_of(&self, keys: &[&'static str], example: &str) {
        let Some(first) = keys.first() else { return };
        let message = format!("`{}` is missing", self.name(first));
        let fault = Fault::new(code::MISSING_KEY, self.place.clone(), message);
        self.missing_fault(keys, fault.help(format!("write {example}")));
    }

    /// A fault that [`finish`](Self::finish) reports unless an unknown key was meant to be one of `keys`.
    pub(super) fn missing_fault(&self, keys: &[&'static str], fault: Fault) {
        self.missing.borrow_mut().push((keys.to_vec(), fault));
    }

    /// Reports that a value, that of `key` or one in it, is of the wrong type.
    pub(super) fn wrong_type(
        &self,
        key: &'static str,
        value: &DeValue<'_>,
        span: Range<usize>,
        needed: &str,
        help: Option<String>,
    ) {
        let message = format!("`{}` is {}; {needed} is needed", self.name(key), type_name(value));
        let mut fault = Fault::new(code::WRONG_TYPE, span, message);
        fault.help = help;
        self.log.fault(fault);
    }

    /// A number, infinite ones and NaN included.
    pub(super) fn any_number(&self, key: &'static str) -> Option<Located<f64>> {
        let (_, value, span) = self.entry(key)?;
        if let Some(value) = to_f64(value) {
            return Some(Located { value, span });
        }
        let help = value.as_str().and_then(|text| number_in_text(key, text));
        self.wrong_type(key, value, span, "a number", help);
        None
    }

    /// A finite number; `allowed` is what the message on another one says, when it is known here.
    pub(super) fn number(&self, key: &'static str, allowed: Option<Allowed>) -> Option<Located<f64>> {
        let number = self.any_number(key)?;
        self.finite(key, number, allowed)
    }

    /// Reports a number that is not finite.
    fn finite(
        &self,
        key: &'static str,
        number: Located<f64>,
        allowed: Option<Allowed>,
    ) -> Option<Located<f64>> {
        if number.value.is_finite() {
            return Some(number);
        }
        let raw = self.log.slice(&number.span);
        let problem = match raw {
            _ if raw.contains("inf") || raw.contains("nan") => "is not a finite number",
            _ => "is too large for a number",
        };
        let allowed =
            allowed.map_or("the largest is 1.8e308".to_owned(), |a| format!("allowed: {}", a.text()));
        let message = format!("`{} = {raw}` {problem}; {allowed}", self.name(key));
        self.log.fault(Fault::new(code::OUT_OF_RANGE, number.span, message));
        None
    }

    /// A number within a range.
    pub(super) fn number_in(&self, key: &'static str, allowed: Allowed) -> Option<Located<f64>> {
        let number = self.number(key, Some(allowed))?;
        if number.value >= allowed.min && number.value <= allowed.max {
            return Some(number);
        }
        self.out_of_range(key, &number.span, self.log.slice(&number.span), &allowed.text());
        None
    }

    /// Reports that a value is not one of those allowed.
    pub(super) fn out_of_range(&self, key: &str, span: &Range<usize>, value: &str, allowed: &str) {
        let message = format!("`{} = {value}` is out of range; allowed: {allowed}", self.name(key));
        self.log.fault(Fault::new(code::OUT_OF_RANGE, span.clone(), message));
    }

    /// A whole number within `min..=max`.
    pub(super) fn integer_in(&self, key: &'static str, min: u64, max: u64) -> Option<Located<u64>> {
        let (_, value, span) = self.entry(key)?;
        let Some(integer) = value.as_integer() else {
            let number = to_f64(value).or_else(|| value.as_str()?.parse().ok());
            let help = number
                .filter(|x| x.fract() == 0.0 && x.abs() < 1e15)
                .map(|x| format!("write `{key} = {x:.0}`"));
            self.wrong_type(key, value, span, "a whole number", help);
            return None;
        };
        match u64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(n) if n >= min && n <= max => Some(Located { value: n, span }),
            _ => {
                let shown = self.log.slice(&span);
                self.out_of_range(key, &span, shown, &format!("{min} to {max}"));
                None
            }
        }
    }

    /// A text.
    pub(super) fn text(&self, key: &'static str) -> Option<Located<&'a str>> {
        let (_, value, span) = self.entry(key)?;
        if let Some(value) = value.as_str() {
            return Some(Located { value, span });
        }
        self.wrong_type(key, value, span, "a text", Some(format!("write it in quotes: `{key} = \"...\"`")));
        None
    }

    /// `true` or `false`.
    pub(super) fn flag(&self, key: &'static str) -> Option<Located<bool>> {
        let (_, value, span) = self.entry(key)?;
        if let Some(value) = value.as_bool() {
            return Some(Located { value, span });
        }
        self.wrong_type(key, value, span, "`true` or `false`", Some("without quotes".to_owned()));
        None
    }

    /// One of a few words.
    pub(super) fn choice<T: Copy>(&self, key: &'static str, words: &[(&str, T)]) -> Option<Located<T>> {
        let text = self.text(key)?;
        if let Some(&(_, value)) = words.iter().find(|(word, _)| *word == text.value) {
            return Some(Located { value, span: text.span });
        }
        let names: Vec<&str> = words.iter().map(|&(word, _)| word).collect();
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let help = closest(text.value, &names).map(|name| format!("did you mean \"{name}\"?"));
        self.unknown_choice(key, &text, &quoted.join(", "), help);
        None
    }

    /// Reports a text that is none of those `allowed`.
    pub(super) fn unknown_choice(
        &self,
        key: &'static str,
        text: &Located<&str>,
        allowed: &str,
        help: Option<String>,
    ) {
        let message =
            format!("`{} = \"{}\"` is not known; allowed: {allowed}", self.name(key), shortened(text.value));
        let mut fault = Fault::new(code::UNKNOWN_CHOICE, text.span.clone(), message);
        fault.help = help;
        self.log.fault(fault);
    }

    /// Whether the value of `key` is a text; says nothing about another type.
    pub(super) fn is_text(&self, key: &'static str) -> bool {
        self.entry(key).is_some_and(|(_, value, _)| value.is_str())
    }

    /// Whether the value of `key` is a table; says nothing about another type.
    pub(super) fn is_table(&self, key: &'static str) -> bool {
        self.entry(key).is_some_and(|(_, value, _)| value.is_table())
    }

    /// A table; `example` says how to write one.
    pub(super) fn table(&self, key: &'static str, example: &str) -> Option<Table<'a>> {
        let (_, value, span) = self.entry(key)?;
        if let Some(entries) = value.as_table() {
            return Some(Table::new(entries, self.offset, span, self.name(key), self.log));
        }
        self.wrong_type(key, value, span, "a table", Some(format!("write {example}")));
        None
    }

    /// Its keys and values, whoever asks for them.
    pub(super) const fn entries(&self) -> &'a DeTable<'a> {
        self.entries
    }

    /// The keys that are there, in the order they were written, each with the key's and the value's place.
    pub(super) fn written(&self) -> Vec<(&'a str, Range<usize>, Range<usize>)> {
        let mut keys: Vec<_> = self
            .entries
            .iter()
            .map(|(key, value)| (&**key.get_ref(), self.shift(key.span()), self.shift(value.span())))
            .collect();
        keys.sort_by_key(|(_, span, _)| span.start);
        keys
    }

    /// Reports every key that was not asked for, and every one that is missing.
    pub(super) fn finish(self) {
        self.finish_here();
    }

    /// As [`finish`](Self::finish), for one who holds the table for somebody else.
    pub(super) fn finish_here(&self) {
        let asked = self.asked.borrow();
        for (key, span, _) in self.written() {
            if asked.contains(&key) {
                continue;
            }
            if self.log.is_full() {
                break;
            }
            let place = if self.path.is_empty() { String::new() } else { format!(" in `{}`", self.path) };
            let message = format!("unknown key `{}`{place}", shortened(key));
            let absent: Vec<&str> =
                asked.iter().copied().filter(|known| !self.entries.contains_key(*known)).collect();
            if !self.is_root && self.log.is_misplaced(key) {
                let help = format!("`{key}` belongs above the first `[table]`");
                self.log.fault(Fault::new(code::UNKNOWN_KEY, span, message).help(help));
                continue;
            }
            let meant = closest(key, &absent).or_else(|| closest(key, &asked));
            self.missing.borrow_mut().retain(|(keys, _)| meant.is_none_or(|meant| !keys.contains(&meant)));
            let help = match meant {
                Some(meant @ ("event" | "controller")) => format!("did you mean `[[{meant}]]`?"),
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("known keys: {}", asked.join(", ")),
            };
            self.log.fault(Fault::new(code::UNKNOWN_KEY, span, message).help(help));
        }
        for (keys, fault) in self.missing.take() {
            // One that stands below a table is reported there.
            let below = |key: &&str| ABOVE_TABLES.contains(key) && !self.log.is_wanted_above(key);
            let is_own_root = self.is_root && self.offset == 0;
            if !(is_own_root && keys.iter().any(below)) {
                self.log.fault(fault);
            }
        }
    }
}
