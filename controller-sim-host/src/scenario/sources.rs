//! The texts of a scenario, its own and those it includes, after one another: a place in the whole says which text it
//! is in.

use super::fault::{Fault, Related, SourceText};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// The whole, and where its parts begin.
#[derive(Debug)]
pub(super) struct Sources<'a> {
    /// What the scenario itself is called.
    name: &'a str,
    whole: Cow<'a, str>,
    /// The included texts with their offsets, in order.
    included: Vec<(usize, Arc<SourceText>)>,
}

impl<'a> Sources<'a> {
    pub(super) fn new(
        name: &'a str,
        own: &'a str,
        included: impl IntoIterator<Item = Arc<SourceText>>,
    ) -> Self {
        let mut whole = Cow::Borrowed(own);
        let mut parts = Vec::new();
        for source in included {
            let whole = whole.to_mut();
            // A line of its own, so that no line belongs to two texts.
            whole.push('\n');
            parts.push((whole.len(), Arc::clone(&source)));
            whole.push_str(&source.text);
        }
        Self { name, whole, included: parts }
    }

    /// All texts as one.
    pub(super) fn whole(&self) -> &str {
        &self.whole
    }

    /// The included texts and where they begin.
    pub(super) fn included(&self) -> impl Iterator<Item = (usize, &SourceText)> {
        self.included.iter().map(|(offset, source)| (*offset, &**source))
    }

    /// A fault of the whole as one of its text.
    pub(super) fn resolve(&self, mut fault: Fault) -> Fault {
        let part = self.part(&fault.span);
        if let Some(related) = fault.related.take() {
            if self.part(&related.span).map(|(offset, _)| offset) == part.map(|(offset, _)| offset) {
                let offset = part.map_or(0, |(offset, _)| *offset);
                fault.related = Some(Related { span: back(&related.span, offset), ..related });
            } else {
                fault.help = Some(self.elsewhere(&related, fault.help));
            }
        }
        if let Some((offset, source)) = part {
            fault.span = back(&fault.span, *offset);
            fault.source = Some(Arc::clone(source));
        }
        fault
    }

    /// The included text that `span` is in; none: the scenario's own.
    fn part(&self, span: &Range<usize>) -> Option<&(usize, Arc<SourceText>)> {
        self.included.iter().rev().find(|(offset, _)| *offset <= span.start)
    }

    /// A second place in another text, in words: a message shows one text.
    fn elsewhere(&self, related: &Related, help: Option<String>) -> String {
        let part = self.part(&related.span);
        let offset = part.map_or(0, |(offset, _)| *offset);
        let before = self.whole.get(offset..related.span.start).unwrap_or("");
        let line = 1 + before.matches('\n').count();
        let name = part.map_or(self.name, |(_, source)| &source.name);
        let place = format!("{}: line {line} of `{name}`", related.message);
        help.map_or_else(|| place.clone(), |help| format!("{help}; {place}"))
    }
}

fn back(span: &Range<usize>, offset: usize) -> Range<usize> {
    span.start.saturating_sub(offset)..span.end.saturating_sub(offset)
}
