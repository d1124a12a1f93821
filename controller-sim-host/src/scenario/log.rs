//! Where faults and warnings are collected while a text is read.

use super::fault::Fault;
use std::cell::RefCell;
use std::ops::Range;

/// More faults than anyone reads; a text of a million wrong keys must not take for ever.
pub(super) const MOST: usize = 100;

/// The text that is read, and what was found in it so far.
///
/// Shared by everything that reads, hence the cells.
#[derive(Debug)]
pub(super) struct Log<'a> {
    /// The text.
    pub(super) text: &'a str,
    faults: RefCell<Vec<Fault>>,
    warnings: RefCell<Vec<Fault>>,
}

impl<'a> Log<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, faults: RefCell::default(), warnings: RefCell::default() }
    }

    /// Adds a fault; a second equal one is dropped.
    pub(super) fn fault(&self, fault: Fault) {
        push(&self.faults, fault);
    }

    /// Adds a warning; a second equal one is dropped.
    pub(super) fn warn(&self, warning: Fault) {
        push(&self.warnings, warning);
    }

    /// Number of faults so far.
    pub(super) fn count(&self) -> usize {
        self.faults.borrow().len()
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
    let known = list.iter().any(|f| f.span == fault.span && f.message == fault.message);
    if !known && list.len() < MOST {
        list.push(fault);
    }
}
