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
}
