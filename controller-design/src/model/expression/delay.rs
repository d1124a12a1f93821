//! The argument of `exp`: whether it comes to `-T*s`.

use crate::model::error::{ExpressionError, Span};
use crate::model::factored::Factored;
use crate::model::number::{decimal, rounded};

/// `exp(argument)`, or why it is no dead time.
pub(super) fn delay(argument: &Factored, span: Span) -> Result<Factored, ExpressionError> {
    let fault = |message: String| ExpressionError::new(span, message);
    if argument.is_zero() {
        return Ok(Factored::delay(0.0));
    }
    if argument.dead_time != 0.0 {
        return Err(fault("an `exp` in the argument of `exp`".into()).with_help("a dead time is `exp(-T*s)`"));
    }
    match (argument.origin, &*argument.num, &*argument.den) {
        (-1, [], []) if argument.gain < 0.0 => Ok(Factored::delay(-argument.gain)),
        (-1, [], []) => {
            let t = decimal(argument.gain);
            let sign = format!("a dead time cannot be negative; this is one of -{t} s");
            let product = if argument.gain == 1.0 { String::new() } else { format!("{t}*") };
            Err(fault(sign).with_help(format!("write `exp(-{product}s)`")))
        }
        (0, [], []) => {
            let value = libm::exp(argument.gain);
            let error = fault("`exp` of a constant; it is for dead times only".into());
            Err(error.with_help(if value.is_finite() && value > 0.0 {
                format!("write the number, {}, or `exp(-T*s)` for a dead time", rounded(value))
            } else {
                "write `exp(-T*s)` for a dead time".into()
            }))
        }
        (0, [line], []) if line.degree() == 1 => {
            let constant = argument.gain * line.coefficient(0);
            let message = format!("the argument of `exp` has a constant part, {}", rounded(constant));
            let value = libm::exp(constant);
            Err(fault(message).with_help(if value.is_finite() && value > 0.0 {
                format!("take it out as a factor: `{}*exp(-T*s)`", rounded(value))
            } else {
                "write `exp(-T*s)`".into()
            }))
        }
        _ => Err(fault("the argument of `exp` must come to -T*s with a constant T".into())
            .with_help("a dead time of T seconds is `exp(-T*s)`; a lag is `1/(1+T*s)`")),
    }
}
