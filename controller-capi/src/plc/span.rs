//! Engineering units, counts and per cent. Computed in `f64` and rounded once.

/// Two values that belong to 0 and to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

impl Span {
    pub(crate) fn of_counts(lo: i32, hi: i32) -> Self {
        Self { lo: f64::from(lo), hi: f64::from(hi) }
    }

    /// Where `x` is: 0 at `lo`, 1 at `hi`.
    pub(crate) fn fraction(self, x: f64) -> f64 {
        (x - self.lo) / (self.hi - self.lo)
    }

    /// What is at this fraction; exact at both ends.
    pub(crate) fn at(self, fraction: f64) -> f64 {
        self.lo * (1.0 - fraction) + self.hi * fraction
    }

    pub(crate) fn width(self) -> f64 {
        let width = self.hi - self.lo;
        if width < 0.0 { -width } else { width }
    }

    /// The same with `lo` below `hi`.
    pub(crate) fn sorted(self) -> Self {
        if self.lo <= self.hi { self } else { Self { lo: self.hi, hi: self.lo } }
    }

    /// `x`, or the nearer end.
    pub(crate) fn clamp(self, x: f64) -> f64 {
        let Self { lo, hi } = self.sorted();
        if x < lo {
            lo
        } else if x > hi {
            hi
        } else {
            x
        }
    }
}

/// The nearest whole number, halves away from zero; saturates.
#[allow(clippy::cast_possible_truncation)]
pub(crate) fn round(x: f64) -> i32 {
    let whole = x as i32;
    let rest = x - f64::from(whole);
    if rest >= 0.5 {
        whole.saturating_add(1)
    } else if rest <= -0.5 {
        whole.saturating_sub(1)
    } else {
        whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact_in_both_directions() {
        for (lo, hi) in [(0.1, 0.3), (0.3, 0.1), (-50.0, 150.0), (1e12, -1e12)] {
            let span = Span { lo, hi };
            assert_eq!((span.at(0.0), span.at(1.0)), (lo, hi));
            assert_eq!((span.fraction(lo), span.fraction(hi)), (0.0, 1.0));
        }
        assert_eq!(Span { lo: 100.0, hi: 0.0 }.at(0.25), 75.0);
        assert_eq!(Span::of_counts(i32::MIN, i32::MAX).width(), 4294967295.0);
    }

    #[test]
    fn halves_go_away_from_zero() {
        for (x, whole) in
            [(0.5, 1), (-0.5, -1), (0.49999999999999994, 0), (13823.5, 13824), (2.0, 2), (-2.4, -2)]
        {
            assert_eq!(round(x), whole, "{x}");
        }
        assert_eq!((round(1e300), round(-1e300), round(f64::NAN)), (i32::MAX, i32::MIN, 0));
    }
}
