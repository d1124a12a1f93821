//! What happens to the integral term when the output that was applied is not the output that was wanted.

use crate::error::{Checker, ConfigErrors, Param};
use crate::pid::PidConfig;
use crate::real::{Real, coefficient};
use crate::snapshot::Words;
use crate::stored::Flag;

/// The anti-windup rule.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AntiWindupConfig {
    /// `I += min(1, ts/tt)*(a - v)` with the applied output `a` and the wanted `v` (offset and estimator
    /// included). `tt` \[s\], above 0; `None`: `max(kp/ki, tf, ts)`.
    BackCalculation {
        /// Tracking time constant \[s\].
        tt: Option<f64>,
    },
    /// Takes back the increment that was just added when it drove further into the limit.
    Conditional,
    /// The integral term is left alone: winds up. For comparison only.
    None,
}

impl Default for AntiWindupConfig {
    fn default() -> Self {
        Self::BackCalculation { tt: None }
    }
}

/// An anti-windup rule for one sampling period.
///
/// Difference equation, evaluated at the start of sample `k` with `a = u_applied[k-1]`, `v = v[k-1]` and the last
/// increment `dI`: back-calculation `I += min(1, ts/tt)*(a - v)`; conditional `I -= dI` if `(v - a)*dI > 0`.
/// Both leave the limit by themselves; the form `I -= ts*e` of the literature can lock up and is not offered.
/// Source: eqs (8)-(10) of Tena et al. 2022, corrected; section 5 of the chapter's reference for the choice.
/// Cost: 4 compares, 2 operations.
///
/// ```
/// use controller_core::{AntiWindup, AntiWindupConfig, PidConfig};
/// let pid = PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() };
/// let rule = AntiWindup::<f32>::new(&AntiWindupConfig::default(), &pid, 0.5).unwrap();
/// assert_eq!(rule.correction(0.1, 3.0, 2.0), -0.25); // tt = kp/ki = 2 s, ts/tt = 0.25
/// let rule = AntiWindup::<f32>::new(&AntiWindupConfig::Conditional, &pid, 0.5).unwrap();
/// assert_eq!(rule.correction(0.1, 3.0, 2.0), -0.1);
/// assert_eq!(rule.correction(-0.1, 3.0, 2.0), 0.0); // leaving the limit is never taken back
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AntiWindup<T> {
    gain: T,
    conditional: Flag,
}

impl<T: Real> AntiWindup<T> {
    /// The rule for a controller `pid` sampled every `ts` \[s\]. Without an integral term (`ki = 0`) the rule does
    /// nothing: the term is a fixed bias.
    ///
    /// # Errors
    /// `tt` not finite, not above 0 or longer than 1e12 s.
    pub fn new(config: &AntiWindupConfig, pid: &PidConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        let (gain, conditional) = match *config {
            AntiWindupConfig::BackCalculation { tt } => {
                check.optional(Param::Tt, tt, f64::MIN_POSITIVE, 1e12);
                let ratio = ts / tt.unwrap_or_else(|| pid.default_tt(ts));
                (if ratio < 1.0 { ratio } else { 1.0 }, false)
            }
            AntiWindupConfig::Conditional => (0.0, true),
            AntiWindupConfig::None => (0.0, false),
        };
        let active = pid.ki != 0.0;
        check.finish(Self {
            gain: coefficient(if active { gain } else { 0.0 }),
            conditional: Flag::new(conditional && active),
        })
    }

    /// Share of `a - v` that back-calculation adds; 0 under another rule.
    #[must_use]
    pub fn gain(&self) -> T {
        self.gain
    }

    /// Whether the rule takes increments back.
    #[must_use]
    pub fn is_conditional(&self) -> bool {
        self.conditional.is_set()
    }

    /// What to add to the integral term \[u\]: `increment` is what the last sample added, `v` the output it wanted,
    /// `applied` the output that was applied.
    #[must_use]
    #[inline(always)]
    pub fn correction(&self, increment: T, v: T, applied: T) -> T {
        let further = || (v > applied && increment > T::ZERO) || (v < applied && increment < T::ZERO);
        if self.conditional.is_set() && further() { -increment } else { self.gain * (applied - v) }
    }

    /// Its numbers.
    #[inline(always)]
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.gain);
        words.word(u32::from(self.conditional.byte()));
    }
}
