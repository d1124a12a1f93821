//! Collects the faults of a configuration.

use controller_core::{ConfigError, ConfigErrors, Param, Reason};

/// Largest size of a signal's range, as in the core.
pub(crate) const RANGE_LIMIT: f64 = 1e12;

/// All faults found so far.
#[derive(Default)]
pub(crate) struct Faults(ConfigErrors);

impl Faults {
    /// Not inlined: a list of faults is some hundred bytes, and who finds many of them would have room for each on its stack.
    #[inline(never)]
    pub(crate) fn fault(&mut self, param: Param, reason: Reason, value: f64, min: f64, max: f64) {
        self.0 = self.0.and(&ConfigError { param, reason, value, min, max }.into());
    }

    /// `value` must be finite and in `min..=max`; returns whether it is.
    pub(crate) fn range(&mut self, param: Param, value: f64, min: f64, max: f64) -> bool {
        let reason = if !value.is_finite() {
            Reason::NotFinite
        } else if value < min || value > max {
            Reason::OutOfRange
        } else {
            return true;
        };
        self.fault(param, reason, value, min, max);
        false
    }

    /// Two different finite ends of a span, far enough apart for a number of precision `eps`.
    pub(crate) fn ends(&mut self, lo: f64, hi: f64, eps: f64) {
        let both = self.range(Param::Span, lo, -RANGE_LIMIT, RANGE_LIMIT)
            & self.range(Param::Span, hi, -RANGE_LIMIT, RANGE_LIMIT);
        let size = lo.abs().max(hi.abs());
        let least = (16.0 * eps * size).max(1e-24);
        if both && (hi - lo).abs() < least {
            self.fault(Param::Span, Reason::Inverted, hi - lo, least, 2.0 * RANGE_LIMIT);
        }
    }

    /// `value` when nothing was found, else all faults.
    pub(crate) fn finish<V>(self, value: V) -> Result<V, ConfigErrors> {
        if self.0.is_empty() { Ok(value) } else { Err(self.0) }
    }
}
