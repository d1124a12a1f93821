//! A recursive-descent parser that computes as it reads and goes on after a mistake.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = { "+" | "-" } power
//! power   = primary [ "^" signed ]
//! primary = number | "s" | "exp" "(" sum ")" | "(" sum ")"
//! ```
//!
//! An operand without a value is one whose mistake was reported; whatever is computed from it has no value
//! either and is not reported again.

use std::string::String;
use std::vec::Vec;

use super::delay::delay;
use super::token::{Kind, Token, shown};
use super::{MAX_EXPONENT, MAX_NESTING};
use crate::model::error::{ExpressionError, Span};
use crate::model::factored::{Factored, Fault, MAX_DEGREE};
use crate::model::number::rounded;

/// A part of the expression: its value unless there is a mistake in it, and its text.
struct Operand {
    value: Option<Factored>,
    span: Span,
}

pub(super) struct Parser<'t> {
    text: &'t str,
    tokens: &'t [Token],
    at: usize,
    depth: usize,
    /// Set when the nesting is too deep: the rest is not read.
    gave_up: bool,
    errors: Vec<ExpressionError>,
}

impl<'t> Parser<'t> {
    pub(super) const fn new(text: &'t str, tokens: &'t [Token]) -> Self {
        Self { text, tokens, at: 0, depth: 0, gave_up: false, errors: Vec::new() }
    }

    /// The value of the whole text, if it has one, and the mistakes.
    pub(super) fn run(mut self) -> (Option<Factored>, Vec<ExpressionError>) {
        let mut value = self.sum().value;
        // A sum ends at the end or at a parenthesis that nobody opened. What follows it is read for its mistakes.
        while let Some(token) = self.peek() {
            value = None;
            self.report(
                ExpressionError::new(token.span, "this parenthesis was never opened")
                    .with_help("remove it, or add the `(` that belongs to it"),
            );
            self.at += 1;
            match self.peek_kind() {
                None | Some(Kind::Close) => {}
                Some(kind) => {
                    self.at += usize::from(kind.is_operator());
                    self.sum();
                }
            }
        }
        (value, self.errors)
    }

    fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    fn peek_kind(&self) -> Option<Kind> {
        self.peek().map(|t| t.kind)
    }

    fn previous(&self) -> Option<Token> {
        self.at.checked_sub(1).and_then(|k| self.tokens.get(k)).copied()
    }

    fn report(&mut self, error: ExpressionError) {
        if !self.gave_up {
            self.errors.push(error);
        }
    }

    /// The token as it stands in the text, short.
    fn shown(&self, token: Token) -> String {
        shown(token.span.of(self.text))
    }

    fn sum(&mut self) -> Operand {
        let mut left = self.product();
        while let Some(sign @ (Kind::Plus | Kind::Minus)) = self.peek_kind() {
            self.at += 1;
            let mut right = self.product();
            if sign == Kind::Minus {
                right.value = right.value.map(Factored::neg);
            }
            let span = left.span.to(right.span);
            left = self.combine(left, right, span, Factored::add);
        }
        left
    }

    fn product(&mut self) -> Operand {
        let mut left = self.signed();
        let mut last = left.span;
        while let Some(kind) = self.peek_kind() {
            let right = match kind {
                Kind::Star | Kind::Slash => {
                    self.at += 1;
                    self.signed()
                }
                Kind::Junk => self.junk(),
                _ if kind.begins_value() => self.after_missing_operator(last),
                _ => break,
            };
            last = right.span;
            left = if kind == Kind::Slash {
                self.combine(left, right, last, Factored::div)
            } else {
                let span = left.span.to(right.span);
                self.combine(left, right, span, Factored::mul)
            };
        }
        left
    }

    /// `left operation right`; a fault is reported at `place`.
    fn combine(
        &mut self,
        left: Operand,
        right: Operand,
        place: Span,
        operation: impl FnOnce(Factored, Factored) -> Result<Factored, Fault>,
    ) -> Operand {
        let span = left.span.to(right.span);
        let result = left.value.zip(right.value).map(|(a, b)| operation(a, b));
        Operand { value: self.settle(result, place), span }
    }

    /// Reports the fault, if it is one.
    fn settle(&mut self, result: Option<Result<Factored, Fault>>, place: Span) -> Option<Factored> {
        match result? {
            Ok(value) => Some(value),
            Err(fault) => {
                self.report(described(fault, place));
                None
            }
        }
    }

    /// The factor after a value without an operator in between. `last` is the factor before.
    fn after_missing_operator(&mut self, last: Span) -> Operand {
        let (before, after) = (self.previous(), self.peek());
        let right = self.power();
        let (Some(before), Some(after)) = (before, after) else { return right };
        if before.kind != Kind::Unknown && after.kind != Kind::Unknown {
            let message = format!(
                "an operator is missing between `{}` and `{}`",
                self.shown(before),
                self.shown(after)
            );
            let (a, b) = (last.of(self.text), right.span.of(self.text));
            let help = if a.len() + b.len() <= 40 && !a.is_empty() && !b.is_empty() {
                format!("write `{a}*{b}`")
            } else {
                String::from("put `*` between them")
            };
            self.report(ExpressionError::new(before.span.to(after.span), message).with_help(help));
        }
        right
    }

    /// Characters that were reported, and the value after them if there is one.
    fn junk(&mut self) -> Operand {
        let mut span = self.here();
        while self.peek_kind() == Some(Kind::Junk) {
            self.at += 1;
        }
        if self.peek_kind().is_some_and(Kind::begins_value) {
            span = span.to(self.power().span);
        } else if self.peek_kind() == Some(Kind::Caret) {
            self.at += 1;
            span = span.to(self.signed().span);
        }
        Operand { value: None, span }
    }

    /// Reads signs; whether they come to a minus.
    fn signs(&mut self) -> bool {
        let mut negative = false;
        while let Some(sign @ (Kind::Plus | Kind::Minus)) = self.peek_kind() {
            negative ^= sign == Kind::Minus;
            self.at += 1;
        }
        negative
    }

    fn signed(&mut self) -> Operand {
        let start = self.here();
        let negative = self.signs();
        let mut operand = self.power();
        if negative {
            operand.value = operand.value.map(Factored::neg);
        }
        operand.span = start.to(operand.span);
        operand
    }

    /// All recursion passes here: this is where its depth is bounded.
    fn power(&mut self) -> Operand {
        if self.depth >= MAX_NESTING {
            let span = self.here();
            let message = format!("the nesting is too deep; at most {MAX_NESTING} levels are read");
            self.report(ExpressionError::new(span, message));
            self.gave_up = true;
            self.at = self.tokens.len();
            return Operand { value: None, span };
        }
        self.depth += 1;
        let mut operand = self.primary();
        if self.peek_kind() == Some(Kind::Caret) {
            self.at += 1;
            let exponent = self.signed();
            operand = self.raised(operand, exponent);
        }
        self.depth -= 1;
        operand
    }

    fn raised(&mut self, base: Operand, exponent: Operand) -> Operand {
        let span = base.span.to(exponent.span);
        let Some((value, power)) = base.value.zip(exponent.value) else {
            return Operand { value: None, span };
        };
        let message = match power.as_constant() {
            None => String::from("the exponent must be a number"),
            Some(n) if n != libm::trunc(n) => {
                format!("the exponent must be a whole number; it is {}", rounded(n))
            }
            Some(n) if n.abs() > f64::from(MAX_EXPONENT) => {
                format!(
                    "the exponent {} is too large; at most {MAX_EXPONENT} in size are allowed",
                    rounded(n)
                )
            }
            Some(n) => {
                let value = self.settle(Some(value.pow(n as i32)), span);
                return Operand { value, span };
            }
        };
        self.report(ExpressionError::new(exponent.span, message));
        Operand { value: None, span }
    }

    fn primary(&mut self) -> Operand {
        let Some(token) = self.peek() else { return self.missing() };
        let value = match token.kind {
            Kind::Number(value) => Some(Factored::constant(value)),
            Kind::S => Some(Factored::s()),
            Kind::Unknown => return self.unknown(token.span),
            Kind::Exp => return self.exponential(token.span),
            Kind::Open => return self.group().0,
            Kind::Junk => return self.junk(),
            _ => return self.missing(),
        };
        self.at += 1;
        Operand { value, span: token.span }
    }

    /// `( sum )`, and the sum by itself.
    fn group(&mut self) -> (Operand, Operand) {
        let open = self.here();
        self.at += 1;
        let inner = self.sum();
        let mut outer = Operand { value: inner.value.clone(), span: open.to(inner.span) };
        if let Some(close) = self.peek().filter(|t| t.kind == Kind::Close) {
            outer.span = open.to(close.span);
            self.at += 1;
        } else {
            let error = ExpressionError::new(open, "this parenthesis is never closed");
            self.report(error.with_help("add the `)` that belongs to it"));
            outer.value = None;
        }
        (outer, inner)
    }

    /// A name or number that was reported; after a name, parentheses are taken for those of a function.
    fn unknown(&mut self, mut span: Span) -> Operand {
        self.at += 1;
        if self.peek_kind() == Some(Kind::Open) {
            span = span.to(self.group().0.span);
        }
        Operand { value: None, span }
    }

    fn exponential(&mut self, name: Span) -> Operand {
        self.at += 1;
        if self.peek_kind() == Some(Kind::Open) {
            let (outer, inner) = self.group();
            let value = inner.value.and_then(|argument| match delay(&argument, inner.span) {
                Ok(value) => Some(value),
                Err(error) => {
                    self.report(error);
                    None
                }
            });
            return Operand { value, span: name.to(outer.span) };
        }
        let error = ExpressionError::new(name, "`exp` needs its argument in parentheses");
        self.report(error.with_help("write `exp(-T*s)`, T being the dead time in seconds"));
        let mut span = name;
        if self.peek_kind().is_some_and(Kind::begins_value) {
            span = span.to(self.power().span);
        }
        Operand { value: None, span }
    }

    /// Reports that a value should stand here. Nothing is read.
    fn missing(&mut self) -> Operand {
        let span = self.here();
        let before = self.previous();
        // Inside parentheses only what stands in them counts.
        let operator_before = before.filter(|t| t.kind.is_operator());
        let error = match (operator_before, self.peek()) {
            (Some(a), Some(b)) if b.kind.is_operator() => {
                let message =
                    format!("a value is missing between `{}` and `{}`", self.shown(a), self.shown(b));
                Some(ExpressionError::new(a.span.to(b.span), message))
            }
            (Some(a), _) => {
                let operator = self.shown(a);
                let error = ExpressionError::new(a.span, format!("`{operator}` has nothing to its right"));
                Some(error.with_help(format!("add a value after `{operator}`, or remove it")))
            }
            (None, Some(b)) if b.kind.is_operator() => {
                let operator = self.shown(b);
                let error = ExpressionError::new(b.span, format!("`{operator}` has nothing to its left"));
                Some(error.with_help(format!("add a value before `{operator}`, or remove it")))
            }
            (None, Some(b)) => before.filter(|a| a.kind == Kind::Open).map(|a| {
                let error = ExpressionError::new(a.span.to(b.span), "there is nothing in these parentheses");
                let name = self.at.checked_sub(2).and_then(|k| self.tokens.get(k)).map(|t| t.kind);
                error.with_help(match name {
                    Some(Kind::Exp) => "a dead time of T seconds is `exp(-T*s)`",
                    _ => "write a value in them, or remove them",
                })
            }),
            // An opening parenthesis at the end is reported as never closed.
            (None, None) => None,
        };
        if let Some(error) = error {
            self.report(error);
        }
        Operand { value: None, span }
    }

    /// The token to be read, or the one before at the end.
    fn here(&self) -> Span {
        self.peek().or_else(|| self.tokens.last().copied()).map_or(Span::new(0, 0), |t| t.span)
    }
}

fn described(fault: Fault, place: Span) -> ExpressionError {
    match fault {
        Fault::DivisionByZero => ExpressionError::new(place, "division by zero"),
        Fault::ZeroToTheZero => ExpressionError::new(place, "0^0 has no value"),
        Fault::DeadTimesDiffer(a, b) => ExpressionError::new(
            place,
            format!("the terms of this sum have different dead times, {} s and {} s", rounded(a), rounded(b)),
        )
        .with_help("a plant has one dead time for all of it: `exp(-T*s)*(...)`"),
        Fault::OutOfRange => ExpressionError::new(
            place,
            "a number computed here is too large or too small for double precision",
        ),
        Fault::DegreeTooHigh(degree) => ExpressionError::new(
            place,
            format!("the order here is {degree}; allowed are at most {MAX_DEGREE}"),
        ),
    }
}
