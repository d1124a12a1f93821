//! From the shape of the response to the verdict.

use std::vec;
use std::vec::Vec;

use super::reason::Reason;
use crate::refusal::Refusal;

/// How a loop is tuned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The IAE after a load step is within some 15 % of the least a PI can have.
    NearOptimal,
    /// It acts too strongly: it swings.
    Aggressive,
    /// It acts too weakly.
    Sluggish,
    /// The record does not tell.
    Inconclusive,
}

impl Verdict {
    /// Its name in results: `near-optimal`, `aggressive`, `sluggish`, `inconclusive`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NearOptimal => "near-optimal",
            Self::Aggressive => "aggressive",
            Self::Sluggish => "sluggish",
            Self::Inconclusive => "inconclusive",
        }
    }
}

/// The ranges of a near-optimal response, in first peaks and times of the first peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Acceptance {
    /// Least and largest dip.
    pub dip: (f64, f64),
    /// Least and largest time of the dip.
    pub t_ratio: (f64, f64),
    /// Largest third peak.
    pub r3: f64,
    /// Largest rise from a dip above 0 to the third peak.
    pub rise: f64,
}

impl Default for Acceptance {
    fn default() -> Self {
        Self { dip: (-0.18, 0.0), t_ratio: (1.85, 2.30), r3: 0.30, rise: 0.20 }
    }
}

impl Acceptance {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let range = |parameter, (lo, hi): (f64, f64), min: f64, max: f64| {
            let good = lo >= min && hi <= max && lo <= hi;
            if good {
                Ok(())
            } else {
                Err(Refusal::OutOfRange { parameter, value: lo, min, max: hi.min(max) })
            }
        };
        range("dip", self.dip, -1.0, 1.0)?;
        range("t_ratio", self.t_ratio, 1.0, 6.0)?;
        range("r3", (self.r3, self.r3), 0.0, 1.0)?;
        range("rise", (self.rise, self.rise), 0.0, 1.0)
    }
}

/// Which way to change a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Change {
    /// Make it larger.
    Raise,
    /// Make it smaller.
    Lower,
}

/// What to change in the controller: a step of 10 to 30 % at a time, then repeat the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Changes {
    /// The gain, in size.
    pub kp: Option<Change>,
    /// The integral time.
    pub ti: Option<Change>,
}

impl Changes {
    pub(super) fn of(reasons: &[Reason]) -> Self {
        let mut changes = Self::default();
        for reason in reasons {
            let (kp, ti) = match reason {
                Reason::DipTooDeep(_) => (None, Some(Change::Raise)),
                Reason::Rings(_) | Reason::DipTooEarly(_) => (Some(Change::Lower), None),
                Reason::Oscillates => (Some(Change::Lower), Some(Change::Raise)),
                Reason::NoDip => (Some(Change::Raise), Some(Change::Lower)),
                Reason::DipTooShallow(_) => (None, Some(Change::Lower)),
                Reason::DipTooLate(_) => (Some(Change::Raise), None),
                _ => (None, None),
            };
            changes.kp = changes.kp.or(kp);
            changes.ti = changes.ti.or(ti);
        }
        changes
    }
}

/// Most noise: four standard deviations after smoothing, in first peaks.
pub(super) const MOST_NOISE: f64 = 0.06;

/// The response in first peaks and times of the first peak.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Dip, its time, third peak.
    pub(super) dip: Option<(f64, f64, f64)>,
    /// Lowest value after the first peak.
    pub(super) lowest: f64,
    /// Four standard deviations of the smoothed noise.
    pub(super) noise: f64,
    /// Three swings or more of comparable size.
    pub(super) oscillates: bool,
}

pub(super) fn judge(shape: &Shape, limits: &Acceptance) -> (Verdict, Vec<Reason>) {
    // A loop close to instability makes much of little noise: what it does beyond the noise is clear all the same.
    let clear = shape.dip.is_some_and(|(dip, _, r3)| {
        dip < limits.dip.0 - shape.noise || r3 > limits.r3.max(dip + limits.rise) + shape.noise
    });
    if shape.noise > MOST_NOISE && !clear && !shape.oscillates {
        return (Verdict::Inconclusive, vec![Reason::Noise(shape.noise)]);
    }
    let Some((dip, t_ratio, r3)) = shape.dip else {
        return if shape.oscillates {
            (Verdict::Aggressive, vec![Reason::Oscillates])
        } else if shape.lowest < limits.dip.0 {
            (Verdict::Aggressive, vec![Reason::DipTooDeep(shape.lowest)])
        } else {
            (Verdict::Sluggish, vec![Reason::NoDip])
        };
    };
    let mut reasons = Vec::new();
    // Of a response that turns before it is back, the rise from there tells how it swings.
    let swings = if dip > limits.dip.1 { r3 - dip > limits.rise } else { r3 > limits.r3 };
    if dip < limits.dip.0 {
        reasons.push(Reason::DipTooDeep(dip));
    }
    if swings {
        reasons.push(Reason::Rings(r3));
    }
    if t_ratio < limits.t_ratio.0 && dip <= limits.dip.1 {
        reasons.push(Reason::DipTooEarly(t_ratio));
    }
    if reasons.is_empty() && shape.oscillates {
        reasons.push(Reason::Oscillates);
    }
    if !reasons.is_empty() {
        return (Verdict::Aggressive, reasons);
    }
    if dip > limits.dip.1 {
        reasons.push(Reason::DipTooShallow(dip));
    }
    if t_ratio > limits.t_ratio.1 {
        reasons.push(Reason::DipTooLate(t_ratio));
    }
    if reasons.is_empty() {
        return (Verdict::NearOptimal, vec![Reason::WithinRanges]);
    }
    (Verdict::Sluggish, reasons)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(dip: f64, t_ratio: f64, r3: f64) -> (Verdict, Vec<Reason>) {
        let shape = Shape { dip: Some((dip, t_ratio, r3)), lowest: dip, oscillates: false, noise: 0.0 };
        judge(&shape, &Acceptance::default())
    }

    #[test]
    fn the_ends_of_the_ranges_belong_to_them() {
        for (dip, t_ratio, r3) in [(-0.18, 1.85, 0.30), (0.0, 2.30, 0.0), (-0.1, 2.1, 0.1)] {
            assert_eq!(of(dip, t_ratio, r3), (Verdict::NearOptimal, vec![Reason::WithinRanges]));
        }
    }

    #[test]
    fn every_reason_alone() {
        for (shape, verdict, reason) in [
            ((-0.181, 2.1, 0.1), Verdict::Aggressive, Reason::DipTooDeep(-0.181)),
            ((-0.1, 2.1, 0.301), Verdict::Aggressive, Reason::Rings(0.301)),
            ((-0.1, 1.849, 0.1), Verdict::Aggressive, Reason::DipTooEarly(1.849)),
            ((0.001, 2.1, 0.1), Verdict::Sluggish, Reason::DipTooShallow(0.001)),
            ((-0.1, 2.301, 0.1), Verdict::Sluggish, Reason::DipTooLate(2.301)),
            // Above the baseline the rise from the dip counts, and an early dip is no sign of a high gain.
            ((0.3, 1.5, 0.49), Verdict::Sluggish, Reason::DipTooShallow(0.3)),
            ((0.3, 1.5, 0.51), Verdict::Aggressive, Reason::Rings(0.51)),
            ((0.05, 2.1, 0.26), Verdict::Aggressive, Reason::Rings(0.26)),
        ] {
            assert_eq!(of(shape.0, shape.1, shape.2), (verdict, vec![reason]), "{shape:?}");
        }
    }

    #[test]
    fn reasons_of_one_verdict_come_together_and_aggressive_ones_first() {
        let (verdict, reasons) = of(-0.5, 1.5, 0.6);
        assert_eq!(verdict, Verdict::Aggressive);
        assert_eq!(reasons, [Reason::DipTooDeep(-0.5), Reason::Rings(0.6), Reason::DipTooEarly(1.5)]);
        assert_eq!(Changes::of(&reasons), Changes { kp: Some(Change::Lower), ti: Some(Change::Raise) });
        // A deep dip that comes late: the integral action swings slowly.
        assert_eq!(of(-0.3, 3.0, 0.1).0, Verdict::Aggressive);
        let (verdict, reasons) = of(0.1, 3.0, 0.2);
        assert_eq!((verdict, reasons.len()), (Verdict::Sluggish, 2));
        assert_eq!(Changes::of(&reasons), Changes { kp: Some(Change::Raise), ti: Some(Change::Lower) });
    }

    #[test]
    fn much_noise_leaves_only_what_is_clear() {
        let of = |dip, r3| {
            let shape = Shape { dip: Some((dip, 2.0, r3)), lowest: dip, oscillates: false, noise: 0.07 };
            judge(&shape, &Acceptance::default()).0
        };
        assert_eq!([of(-0.1, 0.1), of(-0.2, 0.1), of(0.1, 0.3)], [Verdict::Inconclusive; 3]);
        assert_eq!([of(-0.26, 0.1), of(-0.1, 0.38), of(0.2, 0.48)], [Verdict::Aggressive; 3]);
    }

    #[test]
    fn without_a_dip() {
        let none = |lowest, oscillates| {
            judge(&Shape { dip: None, lowest, oscillates, noise: 0.0 }, &Acceptance::default()).0
        };
        assert_eq!(none(0.01, false), Verdict::Sluggish);
        assert_eq!(none(-0.1, false), Verdict::Sluggish);
        assert_eq!(none(-0.2, false), Verdict::Aggressive);
        assert_eq!(none(-0.1, true), Verdict::Aggressive);
    }

    #[test]
    fn ranges_that_are_none_are_refused() {
        let default = Acceptance::default();
        for wrong in [
            Acceptance { dip: (0.1, 0.0), ..default },
            Acceptance { t_ratio: (f64::NAN, 2.0), ..default },
            Acceptance { r3: f64::INFINITY, ..default },
            Acceptance { rise: -0.1, ..default },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
        assert_eq!(default.check(), Ok(()));
    }
}
