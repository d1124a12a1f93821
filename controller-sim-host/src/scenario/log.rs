//! Where faults and warnings are collected while a text is read.

use super::fault::Fault;
use std::cell::{Cell, RefCell};
use std::ops::Range;

/// More faults than anyone reads; a text of a million wrong keys must not take for ever.
pub(super) const MOST: usize = 100;

/// The text that is read, that of all files after one another, and what was found in it so far.
///
/// Shared by everything that reads, hence the cells.
#[derive(Debug)]
pub(super) struct Log<'a> {
    /// The text.
    pub(super) text: &'a str,
    faults: RefCell<Vec<Fault>>,
    warnings: RefCell<Vec<Fault>>,
    /// The controller that is being read or looked at.
    about: Cell<Option<usize>>,
    /// Keys of the run, such as `ts`, that the text has nowhere above its first table.
    absent: RefCell<Vec<&'static str>>,
}

impl<'a> Log<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            text,
            faults: RefCell::default(),
            warnings: RefCell::default(),
            about: Cell::default(),
            absent: RefCell::default(),
        }
    }

    /// Adds a fault; a second equal one is dropped.
    pub(super) fn fault(&self, fault: Fault) {
        push(&self.faults, fault);
    }

    /// Adds a warning; a second equal one is dropped, and the first is about more than one controller if they differ in it.
    pub(super) fn warn(&self, warning: Fault) {
        push(&self.warnings, Fault { controller: warning.controller.or(self.about.get()), ..warning });
    }

    /// What follows is about the controller with this index alone, or about any of them.
    pub(super) fn turn_to(&self, controller: Option<usize>) {
        self.about.set(controller);
    }

    /// `key` belongs above the first table and is not there.
    pub(super) fn absent_above(&self, key: &'static str) {
        self.absent.borrow_mut().push(key);
    }

    /// Whether `key`, found in a table, was meant to stand above the first one. Asked once for each key.
    pub(super) fn is_misplaced(&self, key: &str) -> bool {
        let mut absent = self.absent.borrow_mut();
        let count = absent.len();
        absent.retain(|other| *other != key);
        absent.len() < count
    }

    /// Whether `key` is still wanted above the first table.
    pub(super) fn is_wanted_above(&self, key: &str) -> bool {
        self.absent.borrow().contains(&key)
    }

    /// Number of faults so far.
    pub(super) fn count(&self) -> usize {
        self.faults.borrow().len()
    }

    /// Whether a warning says `message` already.
    pub(super) fn has_warning(&self, message: &str) -> bool {
        self.warnings.borrow().iter().any(|warning| warning.message == message)
    }

    /// Whether no more faults are taken.
    pub(super) fn is_full(&self) -> bool {
        self.count() >= MOST
    }

    /// Whether a fault was found inside `span`.
    pub(super) fn is_faulty(&self, span: &Range<usize>) -> bool {
        let faults = self.faults.borrow();
        faults.iter().any(|f| f.span.start >= span.start && f.span.end <= span.end)
    }

    /// The text under `span`.
    pub(super) fn slice(&self, span: &Range<usize>) -> &'a str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// All faults and all warnings, each in the order of the text.
    pub(super) fn finish(self) -> (Vec<Fault>, Vec<Fault>) {
        let sorted = |list: RefCell<Vec<Fault>>| {
            let mut list = list.into_inner();
            list.sort_by_key(|f| (f.span.start, f.span.end));
            list
        };
        (sorted(self.faults), sorted(self.warnings))
    }
}

fn push(list: &RefCell<Vec<Fault>>, fault: Fault) {
    let mut list = list.borrow_mut();
    let known = list.iter_mut().find(|f| f.span == fault.span && f.message == fault.message);
    if let Some(known) = known {
        known.controller = known.controller.filter(|_| known.controller == fault.controller);
    } else if list.len() < MOST {
        list.push(fault);
    }
}
