//! Single values of a TOML text.

use super::number::{show, without_unit};
use toml::de::DeValue;

/// Text from the scenario as it may stand in a message: not too long, on one line.
pub(crate) fn shortened(text: &str) -> String {
    let clean: String = text.chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().count() > 60 { format!("{clean}...") } else { clean }
}

/// The number that a value is, infinite when it is larger than any.
pub(crate) fn to_f64(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(n) => match i128::from_str_radix(n.as_str(), n.radix()) {
            #[allow(clippy::cast_precision_loss)] // the nearest number is what is meant
            Ok(n) => Some(n as f64),
            Err(_) if n.radix() == 10 => n.as_str().parse().ok(),
            Err(_) => Some(f64::INFINITY),
        },
        DeValue::Float(x) => x.as_str().parse().ok(),
        _ => None,
    }
}

/// Help for a number that was written as a text.
pub(super) fn number_in_text(key: &str, text: &str) -> Option<String> {
    if let Some(help) = without_unit(text.trim()) {
        return Some(help);
    }
    let with_point = text.trim().replace(',', ".");
    let number: f64 = with_point.parse().ok()?;
    let quotes = if text.contains(',') { "without quotes and with a point" } else { "without quotes" };
    Some(format!("write it {quotes}: `{key} = {}`", show(number)))
}

/// What a value is, for messages.
pub(crate) fn type_name(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(true) => "`true`",
        DeValue::Boolean(false) => "`false`",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
