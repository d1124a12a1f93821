//! What is wrong with a scenario, and where.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// The codes of faults and warnings. They are stable: a program may act on them.
pub mod code {
    /// The text is not TOML.
    pub const SYNTAX: &str = "syntax";
    /// A key that means nothing here.
    pub const UNKNOWN_KEY: &str = "unknown-key";
    /// A key that must be there is not.
    pub const MISSING_KEY: &str = "missing-key";
    /// A value of another type than the key takes.
    pub const WRONG_TYPE: &str = "wrong-type";
    /// A number outside its range, a text too long or too short.
    pub const OUT_OF_RANGE: &str = "out-of-range";
    /// A text that is none of those allowed.
    pub const UNKNOWN_CHOICE: &str = "unknown-choice";
    /// Something that may be there once is there twice.
    pub const DUPLICATE: &str = "duplicate";
    /// Two values that exclude each other.
    pub const CONFLICT: &str = "conflict";
    /// A mistake in a plant or model expression.
    pub const EXPRESSION: &str = "expression";
    /// A name that nothing has.
    pub const UNKNOWN_NAME: &str = "unknown-name";
    /// A design that a rule refuses; as a warning, what there is to know about one.
    pub const DESIGN: &str = "design";
    /// Something this version of the program cannot do.
    pub const NOT_SUPPORTED: &str = "not-supported";
    /// A file that a scenario names and that cannot be read.
    pub const FILE: &str = "file";
    /// A recording with a mistake in it; as a warning, one that is shorter or longer than the run.
    pub const RECORDING: &str = "recording";
    /// More samples or a longer dead time than the program handles.
    pub const TOO_LARGE: &str = "too-large";
    /// Warning: a filter so fast that it filters little.
    pub const FAST_FILTER: &str = "fast-filter";
    /// Warning: signs that make the loop drive away from the set-point.
    pub const SIGN: &str = "sign";
    /// Warning: a set-point or an output outside the range of a controller, which moves it there.
    pub const CLAMPED: &str = "clamped";
    /// Warning: a set-point outside the range of valid measurements or of the sensor.
    pub const OUT_OF_MEASUREMENT: &str = "out-of-measurement";
    /// Warning: a signal that the sampling does not show as it is.
    pub const ALIASING: &str = "aliasing";
    /// Warning: an integral term that goes on where the actuator has stopped.
    pub const WIND_UP: &str = "wind-up";
    /// Warning: a change without any effect.
    pub const NO_EFFECT: &str = "no-effect";
}

/// One fault, or one warning, of a scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// What kind it is, one of [`code`].
    pub code: &'static str,
    /// The bytes of the text it is about: inside the text and on character boundaries. May be empty: the
    /// place where something is missing.
    pub span: Range<usize>,
    /// What is wrong: the key, its value, what is allowed; one line without a full stop.
    pub message: String,
    /// What to write instead, when that can be told.
    pub help: Option<String>,
    /// A second place that belongs to it, for example the first of two equal names.
    pub related: Option<Related>,
    /// The text that `span` and `related` are places of, when it is not the scenario itself but a file it includes.
    pub source: Option<Arc<SourceText>>,
    /// The only controller that a warning is about: its index in the scenario.
    pub controller: Option<usize>,
}

/// A text with its name, for messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceText {
    /// As the scenario names it.
    pub name: String,
    /// All of it.
    pub text: String,
}

/// The second place of a [`Fault`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Related {
    /// The bytes of the text.
    pub span: Range<usize>,
    /// What is there.
    pub message: String,
}

impl Fault {
    /// A fault without help.
    #[must_use]
    pub fn new(code: &'static str, span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            help: None,
            related: None,
            source: None,
            controller: None,
        }
    }

    /// The same fault with help.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same fault with a second place.
    #[must_use]
    pub fn related(mut self, span: Range<usize>, message: impl Into<String>) -> Self {
        self.related = Some(Related { span, message: message.into() });
        self
    }

    /// The same fault of a text that begins at `offset` of a longer one.
    #[must_use]
    pub(super) fn shifted(mut self, offset: usize) -> Self {
        let shift = |span: &Range<usize>| span.start + offset..span.end + offset;
        self.span = shift(&self.span);
        if let Some(related) = &mut self.related {
            related.span = shift(&related.span);
        }
        self
    }

    /// Where it is: in `text`, the text that was read, unless the fault has a [source](Self::source) of its own.
    #[must_use]
    pub fn place(&self, text: &str) -> Place {
        Place::of(self.source.as_ref().map_or(text, |source| &source.text), &self.span)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Fault {}

/// A place as people count: lines and columns from 1, columns and length in characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column of the first character, from 1.
    pub column: usize,
    /// Number of characters, on the first line only; 0: something is missing there.
    pub length: usize,
    /// These characters.
    pub text: String,
}

impl Place {
    /// The place of `span` in `text`. A span that does not fit is cut to what does.
    ///
    /// ```
    /// use controller_sim_host::scenario::Place;
    /// let place = Place::of("ts = 1\nduration = -3\n", &(18..20));
    /// assert_eq!((place.line, place.column, place.length, &*place.text), (2, 12, 2, "-3"));
    /// ```
    #[must_use]
    pub fn of(text: &str, span: &Range<usize>) -> Self {
        let start = boundary(text, span.start);
        let end = boundary(text, span.end).max(start);
        let (before, from) = text.split_at(start);
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let marked = from.get(..end - start).unwrap_or("");
        let first_line = marked.split(['\r', '\n']).next().unwrap_or("");
        Self {
            line: 1 + before.matches('\n').count(),
            column: 1 + before.get(line_start..).unwrap_or("").chars().count(),
            length: first_line.chars().count(),
            text: first_line.to_owned(),
        }
    }
}

/// The last character boundary of `text` at or before `at`.
pub(crate) fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_not_bytes() {
        let place = Place::of("a\nname = \"Å\" # x", &(14..16));
        assert_eq!((place.line, place.column), (2, 12));
    }

    #[test]
    fn a_span_outside_the_text_is_cut() {
        let place = Place::of("äb", &(1..99));
        assert_eq!((place.line, place.column, &*place.text), (1, 1, "äb"));
    }
}
