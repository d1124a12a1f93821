//! What is wrong with an expression, and where.

use core::fmt;
use core::ops::Range;
use std::string::String;

/// A stretch of the text, in bytes. `Copy`, unlike `Range`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Span {
    pub(crate) const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// From the start of `self` to the end of `other`.
    pub(crate) const fn to(self, other: Self) -> Self {
        Self { start: self.start, end: other.end }
    }

    /// The text under the span; empty should it not lie on character boundaries.
    pub(crate) fn of(self, text: &str) -> &str {
        text.get(self.start..self.end).unwrap_or("")
    }
}

/// One mistake in a plant expression.
///
/// ```
/// use controller_design::model::parse;
/// let errors = parse("1/(1+0,2*s)").expect_err("a decimal comma");
/// assert_eq!(errors[0].span, 6..7);
/// assert_eq!(errors[0].to_string(), "a decimal comma; numbers are written with a point");
/// assert_eq!(errors[0].help.as_deref(), Some("write `0.2`"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpressionError {
    /// The bytes of the text the message is about: always inside the text and on character boundaries. Empty
    /// only when the text is empty.
    pub span: Range<usize>,
    /// What is wrong, one line without a full stop.
    pub message: String,
    /// What to write instead, when that can be told.
    pub help: Option<String>,
}

impl ExpressionError {
    pub(crate) fn new(span: Span, message: impl Into<String>) -> Self {
        Self { span: span.start..span.end, message: message.into(), help: None }
    }

    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl core::error::Error for ExpressionError {}
