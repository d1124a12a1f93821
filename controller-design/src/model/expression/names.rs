//! What the writer of an unknown name may have meant.

use std::borrow::ToOwned;
use std::string::String;

/// Help for a name that is neither `s` nor `exp`.
pub(super) fn suggestion(name: &str) -> String {
    let fixed = match name {
        "S" => "the Laplace variable is a lower-case `s`",
        "p" | "P" | "D" => "the Laplace variable is written `s`",
        "z" | "Z" | "q" => {
            "a plant is a function of `s`; convert a discrete-time model to continuous time first"
        }
        "e" | "E" => "write `exp(-T*s)` for a dead time and `1e3` for a power of ten",
        "Exp" | "EXP" => "write `exp` in lower case",
        "j" | "i" | "J" | "I" => "coefficients are real; a complex pair of poles is written `1+a1*s+a2*s^2`",
        "pi" | "PI" | "Pi" | "\u{3c0}" => "write the number, 3.141592653589793",
        "inf" | "Inf" | "infinity" | "nan" | "NaN" => "a number must be finite",
        "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" | "sqrt" | "ln" | "log" | "log10" | "pow"
        | "abs" => "the only function is `exp`, and it stands for a dead time: `exp(-T*s)`",
        _ => "",
    };
    if !fixed.is_empty() {
        return fixed.to_owned();
    }
    let after_s = name.strip_prefix('s');
    if name.starts_with("exp") {
        "write `exp(-T*s)`".to_owned()
    } else if name.bytes().all(|b| b == b's') {
        format!("write `s^{}`", name.len())
    } else if let Some(power) =
        after_s.filter(|rest| rest.len() <= 2 && rest.bytes().all(|b| b.is_ascii_digit()))
    {
        format!("write `s^{power}` for a power and `{power}*s` for a product")
    } else if after_s == Some("exp") {
        "write `s*exp`".to_owned()
    } else {
        "only `s` and `exp` have a meaning; write the number itself".to_owned()
    }
}
