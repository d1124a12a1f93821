//! Whether the law runs at the period it was built for, by what the task measures.

use controller_core::snapshot::Words;

/// A measured period this far off TS is shown.
const SHOWN: f64 = 0.1;
/// Beyond this the compensator is not used: its model and its dead time are in samples.
const TOLERABLE: f64 = 0.3;
/// So many periods in a row within [`SHOWN`] bring it back.
const CALM: u32 = 10;
/// Added to both bounds, so that the rounding of REAL does not decide about 0.11 s for TS = 0.1 s.
const ROUNDING: f64 = 1e-6;

/// What has been measured, and what follows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Watch {
    /// Sum of TCYC since the law ran \[s\].
    elapsed: f64,
    /// Calls since the law ran without a measurement, and with one that is no time.
    unmeasured: u32,
    unusable: u32,
    /// Periods in a row that were in time while the compensator is out of use.
    calm: u32,
    /// The compensator is out of use.
    out: u32,
    /// The last measured period was far off.
    far: u32,
}

/// What a measured period means for this sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Timing {
    /// The period \[s\]; 0: not measured.
    pub(crate) period: f64,
    /// It is more than 10 % off.
    pub(crate) off: bool,
    /// The compensator must not be used.
    pub(crate) compensator_out: bool,
    /// Whole samples that are missing.
    pub(crate) lost: u32,
    /// A measured time was no time.
    pub(crate) rejected: bool,
}

impl Watch {
    /// A call of the block, `tcyc` \[s\] after the last one; 0: not measured.
    pub(crate) fn call(&mut self, tcyc: f64) {
        if tcyc == 0.0 {
            self.unmeasured = self.unmeasured.saturating_add(1);
        } else if tcyc > 0.0 && tcyc < f64::INFINITY {
            self.elapsed += tcyc;
        } else {
            self.unusable = self.unusable.saturating_add(1);
        }
    }

    /// The law runs: judges the calls since it ran before. A first run has nothing before it.
    ///
    /// Unmeasured: no check; ten in a row take back the last verdict on the compensator. Not usable: the last verdict on the compensator stays. One long period after a good one is a
    /// task that was late: samples are lost. Period after period too long is a task of another period: the law runs as it
    /// is, as a loop that counted every sample as lost would never close.
    pub(crate) fn judge(&mut self, ts: f64, first: bool) -> Timing {
        let Self { elapsed, unmeasured, unusable, .. } = *self;
        (self.elapsed, self.unmeasured, self.unusable) = (0.0, 0, 0);
        let mut timing = Timing { rejected: unusable > 0, ..Timing::default() };
        if unusable > 0 || first {
            timing.compensator_out = self.out != 0;
            return timing;
        }
        if unmeasured > 0 || elapsed == f64::INFINITY {
            // A task that is not measured is not checked; one measurement that is missing excuses nothing.
            self.calm = self.calm.saturating_add(1);
            if self.calm >= CALM {
                *self = Self::default();
            }
            timing.compensator_out = self.out != 0;
            return timing;
        }
        let error = elapsed - ts;
        let size = if error < 0.0 { -error } else { error };
        let far = size > (TOLERABLE + ROUNDING) * ts;
        timing.period = elapsed;
        timing.off = size > (SHOWN + ROUNDING) * ts;
        if far && self.far == 0 && elapsed >= 1.5 * ts {
            // Saturates.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let whole = (elapsed / ts + 0.5) as u32;
            timing.lost = whole.saturating_sub(1);
        }
        self.far = u32::from(far);
        if far {
            self.out = 1;
        }
        self.calm = if timing.off { 0 } else { self.calm.saturating_add(1) };
        if self.calm >= CALM {
            self.out = 0;
        }
        timing.compensator_out = self.out != 0;
        timing
    }

    /// All of it.
    pub(crate) fn write(&self, words: &mut impl Words) {
        words.number(self.elapsed);
        [self.unmeasured, self.unusable, self.calm, self.out, self.far].iter().for_each(|&n| words.word(n));
    }

    /// Other parameters: what was measured for the old ones says nothing.
    pub(crate) fn forget(&mut self) {
        *self = Self { out: self.out, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(watch: &mut Watch, tcyc: f64) -> Timing {
        watch.call(tcyc);
        watch.judge(0.1, false)
    }

    #[test]
    fn shown_beyond_a_tenth_and_out_beyond_three() {
        let mut watch = Watch::default();
        for (tcyc, off, out) in [
            (0.1, false, false),
            (0.11, false, false),
            (0.0901, false, false),
            (0.1101, true, false),
            (0.0899, true, false),
        ] {
            let timing = run(&mut watch, tcyc);
            assert_eq!((timing.off, timing.compensator_out), (off, out), "{tcyc}");
        }
        assert!(!run(&mut watch, 0.13).compensator_out);
        assert!(!run(&mut watch, 0.07).compensator_out);
        assert!(run(&mut watch, 0.1301).compensator_out);
        assert!(run(&mut Watch::default(), 0.0699).compensator_out);
    }

    #[test]
    fn comes_back_after_ten_calm_periods_in_a_row() {
        let mut watch = Watch::default();
        assert!(run(&mut watch, 0.2).compensator_out);
        for _ in 0..9 {
            assert!(run(&mut watch, 0.1).compensator_out);
        }
        // Within 30 % but not within 10 %: counts anew.
        assert!(run(&mut watch, 0.12).compensator_out);
        for _ in 0..9 {
            assert!(run(&mut watch, 0.105).compensator_out);
        }
        assert!(!run(&mut watch, 0.1).compensator_out);
    }

    #[test]
    fn a_gap_loses_samples_once() {
        let mut watch = Watch::default();
        assert_eq!(run(&mut watch, 0.1).lost, 0);
        // 5 periods since the last sample: 4 are missing.
        assert_eq!(run(&mut watch, 0.5).lost, 4);
        assert_eq!(run(&mut watch, 0.5).lost, 0);
        assert_eq!(run(&mut watch, 0.1).lost, 0);
        assert_eq!(run(&mut watch, 0.149).lost, 0);
        assert_eq!(run(&mut watch, 0.1).lost, 0);
        assert_eq!(run(&mut watch, 1e300).lost, u32::MAX - 1);
    }

    #[test]
    fn what_is_not_measured_is_not_checked() {
        let mut watch = Watch::default();
        assert!(run(&mut watch, 0.2).compensator_out);
        let timing = run(&mut watch, f64::NAN);
        assert!(timing.compensator_out && timing.rejected);
        assert!(run(&mut watch, -0.1).rejected);
        assert!(run(&mut watch, f64::INFINITY).rejected);
        let still_out = Timing { compensator_out: true, ..Timing::default() };
        for _ in 0..9 {
            assert_eq!(run(&mut watch, 0.0), still_out);
        }
        assert_eq!(run(&mut watch, 0.0), Timing::default());
        watch.call(1e308);
        watch.call(1e308);
        assert_eq!(watch.judge(0.1, false), Timing::default());
    }

    #[test]
    fn one_missing_measurement_excuses_nothing() {
        let mut watch = Watch::default();
        let _ = run(&mut watch, 0.1);
        let lost: u32 = (0..20).map(|_| run(&mut watch, 0.2).lost + run(&mut watch, 0.0).lost).sum();
        assert_eq!(lost, 1, "a slow task is late once");
        assert!(run(&mut watch, 0.0).compensator_out);
    }

    #[test]
    fn adds_up_the_scans_between_two_samples() {
        let mut watch = Watch::default();
        for tcyc in [0.02, 0.03, 0.02, 0.03] {
            watch.call(tcyc);
        }
        let timing = watch.judge(0.1, false);
        assert!(!timing.off && (timing.period - 0.1).abs() < 1e-15);
        for _ in 0..4 {
            watch.call(0.05);
        }
        let timing = watch.judge(0.1, false);
        assert_eq!((timing.off, timing.compensator_out, timing.lost), (true, true, 1));
    }

    #[test]
    fn a_first_run_has_nothing_before_it() {
        let mut watch = Watch::default();
        watch.call(7.0);
        assert_eq!(watch.judge(0.1, true), Timing::default());
    }
}
