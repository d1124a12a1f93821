//! From the text of a plant to its transfer function, or to everything that is wrong with the text.

mod delay;
mod names;
mod parser;
mod repair;
mod report;
mod token;

use std::vec;
use std::vec::Vec;

use super::error::{ExpressionError, Span};
use super::factored::MAX_DEGREE;
use super::model_error::ModelError;
use super::transfer_function::TransferFunction;
use parser::Parser;

/// The longest text that is read, in bytes.
pub const MAX_LENGTH: usize = 4096;

/// The deepest nesting of parentheses and exponents.
pub const MAX_NESTING: usize = 64;

/// The largest exponent in size.
pub const MAX_EXPONENT: i32 = MAX_DEGREE as i32;

/// The largest number of mistakes reported for one text.
pub const MAX_ERRORS: usize = 20;

/// Reads a plant: a rational expression in `s` with real numbers, `+ - * / ^ ( )` and dead times `exp(-T*s)`, `T`
/// in seconds.
///
/// `^` binds more strongly than a sign and takes whole exponents; `*` and `/` go from left to right, so
/// `1/2*s` is `s/2`. A multiplication is always written out. The argument of `exp` may be any expression that
/// comes to `-T*s`. Dead times of the two sides of a `+` or `-` must be equal.
///
/// Products, quotients and powers keep their factors; a sum is written out over the common denominator of its
/// terms. Coefficients that cancel in a sum up to rounding are 0.
///
/// # Errors
/// Every mistake found, in the order of the text, at most [`MAX_ERRORS`]: unknown characters and names, missing
/// operators, operands and parentheses, arguments of `exp` that are no dead time, exponents that are not whole or
/// above [`MAX_EXPONENT`], divisions by zero, and of the whole: a function that is zero, has more zeros than
/// poles, a negative dead time, or an order above [`MAX_DEGREE`]. A text above [`MAX_LENGTH`] is not read.
///
/// ```
/// use controller_design::model::parse;
///
/// let tank = parse("1.98*exp(-3.2*s)/(1+80.3*s)").expect("a valid plant");
/// assert_eq!((tank.gain(), tank.dead_time()), (1.98, 3.2));
///
/// let errors = parse("1/(1+S)").expect_err("a capital letter");
/// assert_eq!(errors[0].to_string(), "unknown name `S`");
/// assert_eq!(errors[0].help.as_deref(), Some("the Laplace variable is a lower-case `s`"));
/// ```
pub fn parse(text: &str) -> Result<TransferFunction, Vec<ExpressionError>> {
    if text.len() > MAX_LENGTH {
        let start = (0..=MAX_LENGTH).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
        let message = format!("the text has {} bytes; at most {MAX_LENGTH} are read", text.len());
        return Err(vec![ExpressionError::new(Span::new(start, text.len()), message)]);
    }
    let (tokens, mut errors) = token::tokenise(text);
    let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else {
        if errors.is_empty() {
            errors.push(
                ExpressionError::new(Span::new(0, text.len()), "there is no expression")
                    .with_help("write a plant such as `2*exp(-0.5*s)/(1+3*s)`"),
            );
        }
        return Err(in_order(errors));
    };
    let whole = first.span.to(last.span);
    let (value, mistakes) = Parser::new(text, &tokens).run();
    errors.extend(mistakes);
    match value {
        Some(value) if errors.is_empty() => {
            TransferFunction::from_factored(value).map_err(|e| vec![refused(e, whole)])
        }
        _ => Err(in_order(errors)),
    }
}

fn in_order(mut errors: Vec<ExpressionError>) -> Vec<ExpressionError> {
    errors.sort_by_key(|e| (e.span.start, e.span.end));
    errors.truncate(MAX_ERRORS);
    errors
}

/// The error of an expression that can be read but is no plant.
fn refused(error: ModelError, whole: Span) -> ExpressionError {
    let plain = ExpressionError::new(whole, error.to_string());
    match error {
        ModelError::ZeroGain => {
            ExpressionError::new(whole, "this expression is 0 for every s").with_help("a plant has a gain")
        }
        ModelError::NegativeDeadTime { .. } => {
            plain.with_help("write `exp(-T*s)` as a factor of the numerator")
        }
        ModelError::Improper { .. } => plain.with_help(
            "put a denominator of several factors in parentheses, `1/((1+s)*(1+2*s))`, and give a derivative \
             its filter, `s/(1+0.1*s)`",
        ),
        _ => plain,
    }
}
