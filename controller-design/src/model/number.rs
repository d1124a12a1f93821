//! One way of writing numbers, short and exact.

use std::format;
use std::string::String;

/// The shortest decimal text that reads back as `value`, with a power of ten where plain digits grow long.
pub(crate) fn decimal(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        // No sign on a zero.
        String::from("0")
    } else if (1e-4..1e7).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// `value` with six significant digits, for messages about computed values.
pub(crate) fn rounded(value: f64) -> String {
    // The shortest text of the number nearest to the six digits, not the six digits with their zeros.
    format!("{value:.5e}").parse().map_or_else(|_| decimal(value), decimal)
}
