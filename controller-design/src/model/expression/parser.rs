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
use super::repair::Repairs;
use super::report::{LONGEST_HELP, described};
use super::token::{Kind, Token};
use super::{MAX_EXPONENT, MAX_NESTING};
use crate::model::error::{ExpressionError, Span};
use crate::model::factored::{Factored, Fault};
use crate::model::number::rounded;

/// A part of the expression: its value unless there is a mistake in it, and its text.
pub(super) struct Operand {
    value: Option<Factored>,
    span: Span,
    /// Of a product: the factors after its last `/`.
    divisor: Option<Span>,
}

impl Operand {
    pub(super) const fn new(value: Option<Factored>, span: Span) -> Self {
        Self { value, span, divisor: None }
    }
}

pub(super) struct Parser<'t> {
    pub(super) text: &'t str,
    pub(super) tokens: &'t [Token],
    pub(super) at: usize,
    depth: usize,
    /// Set when the nesting is too deep: the rest is not read.
    pub(super) gave_up: bool,
    pub(super) errors: Vec<ExpressionError>,
    /// Which of the errors are about a computed value: they follow from another mistake when one is found.
    pub(super) computed: Vec<usize>,
    repairs: Repairs,
}

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t str, tokens: &'t [Token]) -> Self {
        Self {
            text,
            tokens,
            at: 0,
            depth: 0,
            gave_up: false,
            errors: Vec::new(),
            computed: Vec::new(),
            repairs: Repairs::default(),
        }
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

    pub(super) fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    pub(super) fn peek_kind(&self) -> Option<Kind> {
        self.peek().map(|t| t.kind)
    }

    pub(super) fn previous(&self) -> Option<Token> {
        self.at.checked_sub(1).and_then(|k| self.tokens.get(k)).copied()
    }

    fn sum(&mut self) -> Operand {
        let mut left = self.product();
        let (start, divisor, count) = (left.span, left.divisor, self.errors.len());
        while let Some(sign @ (Kind::Plus | Kind::Minus)) = self.peek_kind() {
            self.at += 1;
            let mut right = self.product();
            if sign == Kind::Minus {
                right.value = right.value.map(Factored::neg);
            }
            let span = left.span.to(right.span);
            left = self.combine(left, right, span, Factored::add);
        }
        if let Some(divisor) = divisor {
            self.suggest_denominator(count, start, divisor.to(left.span));
        }
        left
    }

    fn product(&mut self) -> Operand {
        let mut left = self.signed();
        let mut last = left.span;
        let mut divisor = None;
        while let Some(kind) = self.peek_kind() {
            let right = match kind {
                Kind::Star | Kind::Slash => {
                    self.at += 1;
                    self.signed()
                }
                Kind::Junk => self.junk(),
                _ if kind.begins_value() => self.after_missing_operator(left.span, last, divisor.is_some()),
                _ => break,
            };
            last = right.span;
            let before = left.span;
            left = if kind == Kind::Slash {
                divisor = Some(last);
                self.combine(left, right, last, Factored::div)
            } else {
                if kind == Kind::Star {
                    divisor = None;
                }
                let span = left.span.to(right.span);
                self.combine(left, right, span, Factored::mul)
            };
            left.span = before.to(last);
        }
        left.divisor = divisor;
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
        Operand::new(self.settle(result, place), span)
    }

    /// Reports the fault, if it is one.
    fn settle(&mut self, result: Option<Result<Factored, Fault>>, place: Span) -> Option<Factored> {
        match result? {
            Ok(value) => Some(value),
            Err(fault) => {
                self.report_value(described(fault, place));
                None
            }
        }
    }

    /// The factor after a value without an operator in between. `last` is the factor before, `all` everything from
    /// the start of the product to it, `divides` whether `last` is divided by.
    fn after_missing_operator(&mut self, all: Span, last: Span, divides: bool) -> Operand {
        let (before, after) = (self.previous(), self.peek());
        let mut right = self.power();
        let (Some(before), Some(after)) = (before, after) else { return right };
        if before.kind == Kind::Unknown || after.kind == Kind::Unknown {
            return right;
        }
        let message =
            format!("an operator is missing between `{}` and `{}`", self.shown(before), self.shown(after));
        self.repairs.product(before.span.end, after.span.start);
        let mut whole = last;
        if divides {
            // Everything that stands side by side after a `/` was meant to be below it: one mistake.
            whole = all;
            while self.peek_kind().is_some_and(Kind::begins_value) {
                if let (Some(before), Some(after)) = (self.previous(), self.peek()) {
                    self.repairs.product(before.span.end, after.span.start);
                }
                let next = self.power();
                right = Operand::new(None, right.span.to(next.span));
            }
            self.repairs.parentheses(last.start, right.span.end);
        }
        let repaired = self.repairs.apply(self.text, whole.to(right.span));
        let help = match (repaired.len() <= LONGEST_HELP && !repaired.is_empty(), divides) {
            (true, _) => format!("write `{repaired}`"),
            (false, false) => String::from("put `*` between them"),
            (false, true) => {
                String::from("put `*` between them, and the whole denominator in parentheses: `.../(a*b)`")
            }
        };
        self.report(ExpressionError::new(before.span.to(after.span), message).with_help(help));
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
        Operand::new(None, span)
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
            return Operand::new(None, span);
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
            return Operand::new(None, span);
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
                return Operand::new(value, span);
            }
        };
        self.report_value(ExpressionError::new(exponent.span, message));
        Operand::new(None, span)
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
        Operand::new(value, token.span)
    }

    /// `( sum )`, and the sum by itself.
    fn group(&mut self) -> (Operand, Operand) {
        let open = self.here();
        let count = self.errors.len();
        self.at += 1;
        let mut inner = self.sum();
        let mut outer = Operand::new(inner.value.clone(), open.to(inner.span));
        if let Some(close) = self.peek().filter(|t| t.kind == Kind::Close) {
            outer.span = open.to(close.span);
            self.at += 1;
        } else {
            // It took in more than was meant: what its value is says nothing.
            self.take_back_values(count);
            let error = ExpressionError::new(open, "this parenthesis is never closed");
            self.report(error.with_help("add the `)` that belongs to it"));
            (inner.value, outer.value) = (None, None);
        }
        (outer, inner)
    }

    /// A name or number that was reported; after a name, parentheses are taken for those of a function.
    fn unknown(&mut self, mut span: Span) -> Operand {
        self.at += 1;
        if self.peek_kind() == Some(Kind::Open) {
            span = span.to(self.group().0.span);
        }
        Operand::new(None, span)
    }

    fn exponential(&mut self, name: Span) -> Operand {
        self.at += 1;
        if self.peek_kind() == Some(Kind::Open) {
            let (outer, inner) = self.group();
            let value = inner.value.and_then(|argument| match delay(&argument, inner.span) {
                Ok(value) => Some(value),
                Err(error) => {
                    self.report_value(error);
                    None
                }
            });
            return Operand::new(value, name.to(outer.span));
        }
        let error = ExpressionError::new(name, "`exp` needs its argument in parentheses");
        self.report(error.with_help("write `exp(-T*s)`, T being the dead time in seconds"));
        let mut span = name;
        if self.peek_kind().is_some_and(Kind::begins_value) {
            span = span.to(self.power().span);
        }
        Operand::new(None, span)
    }

    /// The token to be read, or the one before at the end.
    pub(super) fn here(&self) -> Span {
        self.peek().or_else(|| self.tokens.last().copied()).map_or(Span::new(0, 0), |t| t.span)
    }
}
