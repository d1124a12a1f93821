//! All cases of a scenario.

use super::fault::{Fault, Related, SourceText, code};
use super::files::Files;
use super::library::Library;
use super::log::{Log, MOST as MOST_FAULTS};
use super::override_key::Edit;
use super::read::{Input, read_one};
use super::sweep::{self, Change, Sweep, Value};
use super::table::Table;
use super::{Read, Scenario, include};
use crate::simulate::Precision;
use std::sync::Arc;
use toml::de::DeTable;

/// What a text says: the scenario, or one for each value of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadAll {
    /// At least one, in the order of the values.
    pub cases: Vec<Case>,
    /// What can be run but is probably not meant, in the order of the text.
    pub warnings: Vec<Fault>,
}

/// One case of a sweep, or the only one.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The key that is swept and its value, such as `latency = 0.1`; none without a sweep.
    pub label: Option<String>,
    /// What is run.
    pub scenario: Scenario,
}

/// Reads the scenario `text` for runs in `precision`, with all files it names, and all of its cases: each is read as if
/// its value were written in place of the one there. `name` is what messages call the text.
///
/// # Errors
/// As for [`read`](super::read); those inside an included file have its text as their [source](Fault::source). What
/// only some cases have is told at the value that brings it.
///
/// ```
/// use controller_sim_host::scenario::{NoFiles, read_with};
/// use controller_sim_host::simulate::Precision;
/// let text = r#"
/// version = 1
/// ts = 0.1
/// duration = 60.0
/// [plant]
/// tf = "2*exp(-s)/(1+10*s)"
/// [[controller]]
/// name = "PI"
/// pid = { kp = 2.0, ki = 0.2 }
/// [sweep]
/// key = "controller.PI.pid.kp"
/// values = [1.0, 2.0, 4.0]
/// "#;
/// let all = read_with("gains.toml", text, Precision::F64, &NoFiles).expect("a valid scenario");
/// let gains = all.cases.iter().map(|case| case.scenario.controllers[0].config.pid.kp);
/// assert!(gains.eq([1.0, 2.0, 4.0]));
/// assert_eq!(all.cases[2].label.as_deref(), Some("controller.PI.pid.kp = 4.0"));
/// ```
pub fn read_with(
    name: &str,
    text: &str,
    precision: Precision,
    files: &dyn Files,
) -> Result<ReadAll, Vec<Fault>> {
    let library = Library::new(files);
    let input = Input { name, text, replaced: None, precision, library: &library, takes_sweep: true };
    let (document, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() || !document.get_ref().contains_key("sweep") {
        let Read { scenario, warnings } = read_one(&input)?;
        return Ok(ReadAll { cases: vec![Case { label: None, scenario }], warnings });
    }
    let log = Log::new(text);
    let swept = sweep::read(&Table::root(document.get_ref(), 0, &log));
    let included = included(document.get_ref(), &input);
    let is_good = log.count() == 0;
    let change = swept.as_ref().map(|sweep| change(sweep, document.get_ref(), text, &included));
    match (swept, change) {
        (Some(swept), Some(Ok(change))) if is_good => {
            Cases { input, swept, change, included: &included }.read()
        }
        (_, change) => {
            // Everything at once: the rest is read as if there were no sweep.
            let (mut faults, _) = log.finish();
            faults.extend(change.and_then(|change| change.err()));
            faults.extend(read_one(&input).err().unwrap_or_default());
            faults.sort_by_key(in_order);
            faults.truncate(MOST_FAULTS);
            Err(faults)
        }
    }
}

/// The scenario itself first, then the files in the order of their names.
fn in_order(fault: &Fault) -> (Option<String>, usize, usize) {
    (fault.source.as_ref().map(|source| source.name.clone()), fault.span.start, fault.span.end)
}

fn included(document: &DeTable<'_>, input: &Input<'_>) -> Vec<Arc<SourceText>> {
    let list = include::load(document, input.text, None, input.library);
    list.into_iter().filter_map(|include| include.text.ok()).collect()
}

/// Where the value of the swept key goes: to where it is written, else to where its table is.
fn change<'a>(
    sweep: &Sweep,
    document: &DeTable<'_>,
    text: &str,
    included: &'a [Arc<SourceText>],
) -> Result<Change<'a>, Fault> {
    let key = &sweep.key.value;
    let own = Edit::find(text, document, key);
    let first = key.split('.').next().unwrap_or("").trim();
    let is_own = document.contains_key(first);
    let mut others = Vec::new();
    for source in included {
        let (document, _) = DeTable::parse_recoverable(&source.text);
        if let (true, Ok(edit)) =
            (document.get_ref().contains_key(first), Edit::find(&source.text, document.get_ref(), key))
        {
            others.push(Change { file: Some(&source.name), edit });
        }
    }
    match own {
        Ok(edit) if is_own || others.is_empty() => Ok(Change { file: None, edit }),
        own => match (others.into_iter().next(), own) {
            (Some(other), _) => Ok(other),
            (None, Ok(edit)) => Ok(Change { file: None, edit }),
            // It is the name of the key that is wrong, not the place that it leads to.
            (None, Err(fault)) => Err(Fault { span: sweep.key.span.clone(), ..fault }),
        },
    }
}

/// A sweep that is being read.
struct Cases<'a> {
    input: Input<'a>,
    swept: Sweep,
    change: Change<'a>,
    included: &'a [Arc<SourceText>],
}

/// A fault or warning of cases.
struct Found {
    fault: Fault,
    /// What it is about was put in: it is told at the value.
    is_of_value: bool,
    /// The index of the first case that has it, and how many do.
    first: usize,
    count: usize,
}

impl Cases<'_> {
    fn read(&self) -> Result<ReadAll, Vec<Fault>> {
        let original = match self.change.file {
            None => self.input.text,
            Some(file) => {
                self.included.iter().find(|source| source.name == file).map_or("", |source| &source.text)
            }
        };
        let (mut cases, mut faults, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
        for (index, value) in self.swept.values.iter().enumerate() {
            let text = self.change.edit.apply(original, &value.text);
            let input = match self.change.file {
                None => Input { text: &text, ..self.input },
                Some(file) => Input { replaced: Some((file, &text)), ..self.input },
            };
            match read_one(&input) {
                Ok(Read { scenario, warnings: list }) => {
                    cases.push(Case { label: Some(self.swept.label(value)), scenario });
                    list.into_iter().for_each(|warning| self.note(warning, index, value, &mut warnings));
                }
                Err(list) => list.into_iter().for_each(|fault| self.note(fault, index, value, &mut faults)),
            }
        }
        if faults.is_empty() {
            Ok(ReadAll { cases, warnings: self.told(warnings) })
        } else {
            Err(self.told(faults))
        }
    }

    /// Adds a fault of one case to those of all.
    fn note(&self, mut fault: Fault, index: usize, value: &Value, list: &mut Vec<Found>) {
        let length = self.change.edit.length(&value.text);
        let changed = fault.source.as_ref().map(|source| &*source.name) == self.change.file;
        let mut is_of_value = false;
        if changed {
            fault.source =
                self.included.iter().find(|source| Some(&*source.name) == self.change.file).cloned();
            if let Some(related) = fault.related.take() {
                // What was put in is shown in the sweep, when that is in the same text.
                let back = self.change.back(&related.span, length);
                let span = back.or_else(|| self.change.file.is_none().then(|| value.span.clone()));
                fault.related = span.map(|span| Related { span, ..related });
            }
            match self.change.back(&fault.span, length) {
                Some(span) => fault.span = span,
                None => is_of_value = true,
            }
        }
        if is_of_value {
            fault.source = None;
            fault.related = fault.related.filter(|_| self.change.file.is_none());
            // A key that nobody knows is so with every value.
            let is_key = fault.code == code::UNKNOWN_KEY && self.change.edit.adds_key();
            fault.span = if is_key { self.swept.key.span.clone() } else { value.span.clone() };
        }
        let name = |fault: &Fault| fault.source.as_ref().map(|source| source.name.clone());
        let same = |other: &&mut Found| {
            let other = &other.fault;
            other.span == fault.span && other.message == fault.message && name(other) == name(&fault)
        };
        let is_full = list.len() > 10 * MOST_FAULTS;
        match list.iter_mut().find(same) {
            Some(known) => known.count += 1,
            // Nobody reads more.
            None if is_full => {}
            None => list.push(Found { fault, is_of_value, first: index, count: 1 }),
        }
    }

    /// What is told of all cases.
    fn told(&self, list: Vec<Found>) -> Vec<Fault> {
        let mut all: Vec<Fault> = Vec::new();
        for Found { mut fault, is_of_value, first, count } in list {
            let Some(value) = self.swept.values.get(first) else { continue };
            let is_known = fault.span == self.swept.key.span || (is_of_value && value.is_written);
            if count < self.swept.values.len() && !is_known {
                fault.message = format!("with `{}`: {}", self.swept.label(value), fault.message);
                if !is_of_value {
                    let there = fault.source.is_none().then_some(fault.span);
                    fault.source = None;
                    fault.related = there.map(|span| Related { span, message: "here".to_owned() });
                    fault.span = value.span.clone();
                }
            }
            all.push(fault);
        }
        all.sort_by_key(in_order);
        all.truncate(MOST_FAULTS);
        all
    }
}
