//! Alarms on the measurement and on the deviation, with hysteresis.

use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::limit::RANGE_LIMIT;
use crate::real::{Real, coefficient};
use crate::snapshot::Words;
use crate::status::Status;
use crate::stored::Flag;

/// Alarm levels \[y\]; `None`: no such alarm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AlarmConfig {
    /// Measurement very high.
    pub hi_hi: Option<f64>,
    /// Measurement high.
    pub hi: Option<f64>,
    /// Measurement low.
    pub lo: Option<f64>,
    /// Measurement very low.
    pub lo_lo: Option<f64>,
    /// Size of the deviation `|r - y|`, above 0.
    pub deviation: Option<f64>,
    /// How far a signal must come back before its alarm clears, 0 or more.
    pub hysteresis: f64,
}

impl AlarmConfig {
    /// The same configuration with every number rounded to `T`.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            hi_hi: self.hi_hi.map(round),
            hi: self.hi.map(round),
            lo: self.lo.map(round),
            lo_lo: self.lo_lo.map(round),
            deviation: self.deviation.map(round),
            hysteresis: round(self.hysteresis),
        }
    }
}

/// The alarms of a loop. Their state is the set of active alarms ([`Status`] bits 16 to 20).
///
/// Law: a high alarm comes when `y > level` and goes when `y <= level - hysteresis`; low alarms likewise; the
/// deviation alarm watches `|r - y|`. Cost: 5 compares and selects, or one branch when no alarm is configured.
///
/// ```
/// use controller_core::{AlarmConfig, Alarms, Status};
/// let alarms = Alarms::<f32>::new(&AlarmConfig { hi: Some(80.0), hysteresis: 2.0, ..AlarmConfig::default() }).unwrap();
/// let active = alarms.check(Status::NONE, 50.0, 81.0);
/// assert!(active.has(Status::ALARM_HI));
/// assert!(alarms.check(active, 50.0, 79.0).has(Status::ALARM_HI)); // still
/// assert!(!alarms.check(active, 50.0, 78.0).has(Status::ALARM_HI));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alarms<T> {
    hi_hi: T,
    hi: T,
    lo: T,
    lo_lo: T,
    deviation: T,
    hysteresis: T,
    any: Flag,
}

impl<T: Real> Alarms<T> {
    /// The alarms of `config`.
    ///
    /// # Errors
    /// A level that is not finite or larger than 1e12; levels in the wrong order; a deviation or hysteresis below 0.
    pub fn new(config: &AlarmConfig) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        let levels = [
            (Param::AlarmHiHi, config.hi_hi),
            (Param::AlarmHi, config.hi),
            (Param::AlarmLo, config.lo),
            (Param::AlarmLoLo, config.lo_lo),
        ];
        let mut above: Option<f64> = None;
        for (param, level) in levels {
            if let Some(level) = level
                && check.range(param, level, -RANGE_LIMIT, RANGE_LIMIT)
            {
                if let Some(limit) = above.filter(|&limit| level >= limit) {
                    check.fault(param, Reason::Inverted, level, -RANGE_LIMIT, limit);
                }
                above = Some(level);
            }
        }
        check.optional(Param::AlarmDeviation, config.deviation, f64::MIN_POSITIVE, RANGE_LIMIT);
        check.range(Param::AlarmHysteresis, config.hysteresis, 0.0, RANGE_LIMIT);
        // Beyond every range: an alarm that never comes.
        let never = 8.0 * RANGE_LIMIT;
        check.finish(Self {
            hi_hi: coefficient(config.hi_hi.unwrap_or(never)),
            hi: coefficient(config.hi.unwrap_or(never)),
            lo: coefficient(config.lo.unwrap_or(-never)),
            lo_lo: coefficient(config.lo_lo.unwrap_or(-never)),
            deviation: coefficient(config.deviation.unwrap_or(never)),
            hysteresis: coefficient(config.hysteresis),
            any: Flag::new(levels.iter().any(|(_, level)| level.is_some()) || config.deviation.is_some()),
        })
    }

    /// Levels hi hi, hi, lo, lo lo, deviation \[y\] (one that cannot be reached where no alarm is configured) and the
    /// hysteresis; `None` without any alarm.
    #[must_use]
    pub fn levels(&self) -> Option<([T; 5], T)> {
        let levels = [self.hi_hi, self.hi, self.lo, self.lo_lo, self.deviation];
        self.any.is_set().then_some((levels, self.hysteresis))
    }

    /// The active alarms after this sample; `active` is the set after the last one.
    #[must_use]
    #[inline]
    pub fn check(&self, active: Status, r: T, y: T) -> Status {
        if !self.any.is_set() {
            return Status::NONE;
        }
        let over = |bit: Status, x: T, level: T| {
            let release = if active.has(bit) { level - self.hysteresis } else { level };
            bit.when(x > release)
        };
        over(Status::ALARM_HI_HI, y, self.hi_hi)
            | over(Status::ALARM_HI, y, self.hi)
            | over(Status::ALARM_LO, -y, -self.lo)
            | over(Status::ALARM_LO_LO, -y, -self.lo_lo)
            | over(Status::ALARM_DEVIATION, (r - y).magnitude(), self.deviation)
    }

    /// Its numbers.
    #[inline(always)]
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.hi_hi);
        words.number(self.hi);
        words.number(self.lo);
        words.number(self.lo_lo);
        words.number(self.deviation);
        words.number(self.hysteresis);
        words.word(u32::from(self.any.byte()));
    }
}
