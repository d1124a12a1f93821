//! Faults and warnings with the line they are in and a caret under it.

use super::{Source, count};
use crate::scenario::{Fault, SourceText};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The scenario cannot be run.
    Error,
    /// It can be run, but is probably not meant so.
    Warning,
}

/// A problem without a place in a text: a file that cannot be read, a run that is refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// What kind it is; stable.
    pub code: &'static str,
    /// What is wrong, one line without a full stop.
    pub message: String,
    /// What to do instead, when that can be told.
    pub help: Option<String>,
}

impl Problem {
    /// A problem without help.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), help: None }
    }

    /// The same problem with help.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same as a warning, for a terminal.
    #[must_use]
    pub fn as_warning(&self) -> String {
        self.shown("warning")
    }

    fn shown(&self, level: &str) -> String {
        let help = self.help.as_ref().map_or(String::new(), |help| format!("\n  = help: {help}"));
        format!("{level}[{}]: {}{help}", self.code, self.message)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.shown("error"))
    }
}

impl std::error::Error for Problem {}

/// What keeps a run from being made: one of possibly several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trouble {
    /// Something without a place in a text.
    Problem(Problem),
    /// The faults of a scenario.
    Scenario(SourceText, Vec<Fault>),
}

impl From<Problem> for Trouble {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

/// All that is wrong as text for a terminal, in order; ends with a line break. `colours` adds escape sequences.
#[must_use]
pub fn render_all(troubles: &[Trouble], colours: bool) -> String {
    let mut text = String::new();
    for trouble in troubles {
        // One empty line between two of them.
        if !text.is_empty() && !text.ends_with("\n\n") {
            text.push('\n');
        }
        match trouble {
            Trouble::Problem(problem) => text.push_str(&format!("{problem}\n")),
            Trouble::Scenario(source, faults) => {
                text.push_str(&render(source.into(), faults, Severity::Error, colours));
            }
        }
    }
    text
}

/// The faults as text for a terminal, each with its line of `source` and a caret; ends with a line break.
/// `colours` adds escape sequences.
#[must_use]
pub fn render(source: Source<'_>, faults: &[Fault], severity: Severity, colours: bool) -> String {
    let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
    let renderer = renderer.decor_style(DecorStyle::Ascii);
    let mut text = String::new();
    for fault in faults {
        text.push_str(&renderer.render(&[group(source, fault, severity)]));
        text.push_str("\n\n");
    }
    if severity == Severity::Error && faults.len() > 1 {
        text.push_str(&format!("{} in {}\n", count(faults), source.name));
    }
    text
}

/// A fault with the text it is in: that of the scenario, or of a file it includes.
fn group<'a>(source: Source<'a>, fault: &'a Fault, severity: Severity) -> Group<'a> {
    let level = match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let source = fault.source.as_deref().map_or(source, Source::from);
    let window = Window::around(source.text, fault);
    let mut snippet = Snippet::source(window.text)
        .path(source.name)
        .line_start(window.first_line)
        .annotation(AnnotationKind::Primary.span(window.shift(&fault.span)));
    if let Some(related) = &fault.related {
        snippet = snippet
            .annotation(AnnotationKind::Context.span(window.shift(&related.span)).label(&*related.message));
    }
    let group = level.primary_title(&*fault.message).id(fault.code).element(snippet);
    match &fault.help {
        Some(help) => group.element(Level::HELP.message(&**help)),
        None => group,
    }
}

/// The lines of the text that a fault is about: handing the whole text to the renderer for each of many
/// faults would cost their product.
struct Window<'a> {
    text: &'a str,
    first_line: usize,
    offset: usize,
}

impl<'a> Window<'a> {
    fn around(text: &'a str, fault: &Fault) -> Self {
        let spans = std::iter::once(&fault.span).chain(fault.related.as_ref().map(|related| &related.span));
        let (mut start, mut end) = (text.len(), 0);
        for span in spans {
            start = start.min(span.start);
            end = end.max(span.end);
        }
        let offset = text.get(..start).and_then(|before| before.rfind('\n')).map_or(0, |i| i + 1);
        let end = text.get(end..).and_then(|after| after.find('\n')).map_or(text.len(), |i| end + i);
        let first_line = 1 + text.get(..offset).map_or(0, |before| before.matches('\n').count());
        Self { text: text.get(offset..end).unwrap_or(""), first_line, offset }
    }

    /// The part of `span` on its first line, in this window: a caret under one line says enough.
    fn shift(&self, span: &Range<usize>) -> Range<usize> {
        let start = span.start.saturating_sub(self.offset).min(self.text.len());
        let end = span.end.saturating_sub(self.offset).min(self.text.len()).max(start);
        let line_end =
            self.text.get(start..end).and_then(|s| s.find(['\r', '\n'])).map_or(end, |i| start + i);
        start..line_end
    }
}
