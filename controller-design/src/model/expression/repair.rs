//! The text as it was meant: with the operators and parentheses that are missing in it.

use std::string::String;
use std::vec::Vec;

use crate::model::error::Span;

/// What is missing, each with the bytes it replaces.
#[derive(Debug, Default)]
pub(super) struct Repairs {
    list: Vec<(Span, char)>,
}

impl Repairs {
    /// A `*` is missing in place of the spaces from `from` to `to`.
    pub(super) fn product(&mut self, from: usize, to: usize) {
        self.list.push((Span::new(from, to), '*'));
    }

    /// What stands from `from` to `to` needs parentheses.
    pub(super) fn parentheses(&mut self, from: usize, to: usize) {
        self.list.push((Span::new(from, from), '('));
        self.list.push((Span::new(to, to), ')'));
    }

    /// The text of `span` with everything that is known to be missing in it.
    pub(super) fn apply(&self, text: &str, span: Span) -> String {
        let inside = |place: &Span| place.start >= span.start && place.end <= span.end;
        let mut list: Vec<&(Span, char)> = self.list.iter().filter(|(place, _)| inside(place)).collect();
        // Of two at one place the `)` belongs to what ends there.
        list.sort_by_key(|(place, c)| (place.start, *c != ')'));
        let mut repaired = String::new();
        let mut at = span.start;
        for (place, c) in list {
            repaired.push_str(Span::new(at, place.start).of(text));
            repaired.push(*c);
            at = place.end;
        }
        repaired.push_str(Span::new(at, span.end).of(text));
        repaired
    }
}
