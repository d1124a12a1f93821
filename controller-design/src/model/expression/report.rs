//! What the parser says of mistakes.

use std::string::String;

use super::parser::{Operand, Parser};
use super::token::{Kind, Token, shown};
use crate::model::error::{ExpressionError, Span};
use crate::model::factored::{Fault, MAX_DEGREE};
use crate::model::number::rounded;

/// The longest text that a help repeats, in bytes.
pub(super) const LONGEST_HELP: usize = 80;

/// How the message on a sum of terms with different dead times begins.
const DEAD_TIMES_DIFFER: &str = "the terms of this sum have different dead times";

impl Parser<'_> {
    pub(super) fn report(&mut self, error: ExpressionError) {
        if !self.gave_up {
            self.errors.push(error);
        }
    }

    /// Reports what is wrong with a value, not with the way it is written.
    pub(super) fn report_value(&mut self, error: ExpressionError) {
        self.computed.push(self.errors.len());
        self.report(error);
    }

    /// Takes back what was reported of values since there were `count` errors.
    pub(super) fn take_back_values(&mut self, count: usize) {
        let mut index = 0;
        let computed = &self.computed;
        self.errors.retain(|_| {
            index += 1;
            index <= count || !computed.contains(&(index - 1))
        });
        self.computed.retain(|&index| index < count);
    }

    /// The token as it stands in the text, short.
    pub(super) fn shown(&self, token: Token) -> String {
        shown(token.span.of(self.text))
    }

    /// `2*exp(-s)/1+10*s` is a sum whose dead times differ, but was meant to be a quotient: adds that to the errors
    /// from number `count` on. `numerator` begins the sum, `denominator` is all that follows its `/`.
    pub(super) fn suggest_denominator(&mut self, count: usize, numerator: Span, denominator: Span) {
        let before = Span::new(numerator.start, denominator.start).of(self.text);
        let after = denominator.of(self.text);
        if before.len() + after.len() > LONGEST_HELP {
            return;
        }
        for error in self.errors.iter_mut().skip(count).filter(|e| e.message.starts_with(DEAD_TIMES_DIFFER)) {
            if let Some(help) = error.help.as_mut().filter(|_| error.span.start == numerator.start) {
                help.push_str(&format!(
                    "; a denominator with several terms needs parentheses: `{before}({after})`"
                ));
            }
        }
    }

    /// Reports that a value should stand here. Nothing is read.
    pub(super) fn missing(&mut self) -> Operand {
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
        Operand::new(None, span)
    }
}

pub(super) fn described(fault: Fault, place: Span) -> ExpressionError {
    match fault {
        Fault::DivisionByZero => ExpressionError::new(place, "division by zero"),
        Fault::ZeroToTheZero => ExpressionError::new(place, "0^0 has no value"),
        Fault::DeadTimesDiffer(a, b) => {
            ExpressionError::new(place, format!("{DEAD_TIMES_DIFFER}, {} s and {} s", rounded(a), rounded(b)))
                .with_help("a plant has one dead time for all of it: `exp(-T*s)*(...)`")
        }
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
