//! Numbers in messages, and the ranges they must be in.

/// A number as people write it: 0.05, 20, 1e12.
pub(crate) fn show(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (1e-4..1e6).contains(&size) || !x.is_finite() { format!("{x}") } else { format!("{x:e}") }
}

/// A number that was computed, with as many digits as a message needs.
pub(crate) fn show_short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    show(rounded)
}

/// Help for a number with its unit, such as `100ms`: a unit of time is turned into seconds.
pub(super) fn without_unit(text: &str) -> Option<String> {
    // The longest beginning that is a number: `1e-3 s` ends before the blank, `5eggs` before the `e`.
    let ends = (1..=text.len().min(40)).rev().filter(|&end| text.is_char_boundary(end));
    let (number, rest) = ends.filter_map(|end| text.split_at_checked(end)).find(|(number, _)| {
        number.ends_with(|c: char| c.is_ascii_digit() || c == '.') && number.parse::<f64>().is_ok()
    })?;
    if !rest.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '\u{b0}') {
        return None;
    }
    let factor = match rest.trim() {
        "s" | "sec" | "second" | "seconds" => 1.0,
        "ms" | "msec" => 1e-3,
        "us" | "\u{b5}s" | "\u{3bc}s" => 1e-6,
        "ns" => 1e-9,
        "min" | "minutes" => 60.0,
        "h" => 3600.0,
        _ => return Some(format!("write the number alone: `{number}`")),
    };
    let value: f64 = number.parse().ok()?;
    // Times in seconds stay as they are written.
    let shown = if factor == 1.0 { number.to_owned() } else { show_short(value * factor) };
    Some(format!("write the number alone, in seconds: `{shown}`"))
}

/// The allowed range `min..=max` as text. A bound that only keeps 0 or infinity out is said so.
pub(super) fn range_text(min: f64, max: f64, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    if min > 0.0 && min <= f64::MIN_POSITIVE {
        return format!("above 0, at most {}{unit}", show(max));
    }
    if max == f64::INFINITY {
        return format!("{}{unit} or more", show_short(min));
    }
    format!("{} to {}{unit}", show_short(min), show_short(max))
}

/// What a number must be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowed {
    /// Smallest value.
    pub(super) min: f64,
    /// Largest value.
    pub(super) max: f64,
    /// Unit for messages.
    pub(super) unit: &'static str,
}

impl Allowed {
    pub(super) const fn new(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, unit }
    }

    /// Any signal: the size that the runtime allows for ranges.
    pub(super) const SIGNAL: Self = Self::new(-1e12, 1e12, "");

    /// Above 0, in seconds.
    pub(super) const TIME: Self = Self::new(f64::MIN_POSITIVE, 1e12, "s");

    pub(super) fn text(self) -> String {
        range_text(self.min, self.max, self.unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.01, 20.0, 1e12, -1e-9].map(show), ["0.01", "20", "1e12", "-1e-9"]);
        assert_eq!(show_short(0.1 + 0.2), "0.3");
        assert_eq!(range_text(f64::MIN_POSITIVE, 1e15, "s"), "above 0, at most 1e15 s");
        assert_eq!(range_text(0.0, 2.0, ""), "0 to 2");
    }

    #[test]
    fn units_are_taken_off() {
        for (text, number) in
            [("100ms", "0.1"), ("20 s", "20"), ("1e-3 s", "1e-3"), ("1.5 min", "90"), ("2 bar", "2")]
        {
            let help = without_unit(text).unwrap_or_default();
            assert!(help.ends_with(&format!("`{number}`")), "{text}: {help}");
        }
        assert_eq!([without_unit("ms"), without_unit("12"), without_unit("0,5")], [None, None, None]);
    }
}
