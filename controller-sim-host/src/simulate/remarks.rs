//! What a person should know of a run besides its figures.

use controller_core::Status;

/// A sentence about the run of one controller: that its figures are not those of a loop that works.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// The sentence.
    pub text: String,
}

/// Counts what remarks are made of.
#[derive(Debug, Default)]
pub(super) struct Watch {
    fallback: (u64, f64),
    rejected: (u64, f64),
    limited: u64,
    /// Largest error in each tenth of the run, of the present one when it is over.
    tenths: [f64; 10],
    tenth: usize,
    largest: f64,
    /// Largest error of the last fiftieth, which an event shortly before the end does not reach.
    end: f64,
    /// The sample with which the next tenth begins, that with which the last fiftieth does, and the length of the run.
    next_tenth: u64,
    last_part: u64,
    count: u64,
    automatic: bool,
}

/// The bits that are counted.
const TROUBLE: u32 = Status::FALLBACK.bits()
    | Status::REJECTED.bits()
    | Status::LIMITED_HIGH.bits()
    | Status::LIMITED_LOW.bits();

impl Watch {
    /// Of a run of `count` samples.
    pub(super) fn new(count: u64) -> Self {
        let last_part = (count - count / 50).saturating_sub(1);
        Self { count, next_tenth: count.div_ceil(10), last_part, ..Self::default() }
    }

    /// The sample `k` at the time `t`.
    #[inline]
    pub(super) fn sample(&mut self, t: f64, k: u64, e: f64, status: Status, automatic: bool) {
        if k >= self.next_tenth {
            self.begin_tenth();
        }
        self.automatic = automatic;
        let e = e.abs();
        if e > self.largest {
            self.largest = e;
        }
        if k >= self.last_part && e > self.end {
            self.end = e;
        }
        if status.bits() & TROUBLE != 0 {
            self.trouble(t, status);
        }
    }

    #[cold]
    #[inline(never)]
    fn begin_tenth(&mut self) {
        self.tenths[self.tenth] = self.largest;
        self.tenth = (self.tenth + 1).min(9);
        self.largest = self.tenths[self.tenth];
        self.next_tenth = (self.count * (self.tenth as u64 + 1)).div_ceil(10);
    }

    #[inline(never)]
    fn trouble(&mut self, t: f64, status: Status) {
        let count = |(n, first): &mut (u64, f64), yes: bool| {
            if yes {
                *first = if *n == 0 { t } else { *first };
                *n += 1;
            }
        };
        count(&mut self.fallback, status.has(Status::FALLBACK));
        count(&mut self.rejected, status.has(Status::REJECTED));
        self.limited += u64::from(status.has(Status::LIMITED_HIGH) || status.has(Status::LIMITED_LOW));
    }

    /// The remarks; `noise` is the standard deviation of the measurement noise \[y\].
    pub(super) fn finish(mut self, noise: f64) -> Vec<Remark> {
        self.tenths[self.tenth] = self.largest;
        let mut list = Vec::new();
        let mut say = |text: String| list.push(Remark { text });
        let (n, first) = self.fallback;
        if n > 0 {
            say(format!("in fallback for {n} samples, from {first} s on: the measurement was bad"));
        }
        let (n, first) = self.rejected;
        if n > 0 {
            say(format!("{n} samples with an unusable input (not finite), from {first} s on"));
        }
        let share = 100.0 * self.limited as f64 / self.count.max(1) as f64;
        if share >= 25.0 {
            say(format!("at an output limit for {share:.0} % of the run"));
        }
        let last = self.tenths[9];
        let before = self.tenths[7].min(self.tenths[8]);
        if self.automatic
            && last > 0.9 * before
            && self.end > 0.5 * last
            && last > 6.0 * noise
            && last > 0.05 * self.tenths.iter().fold(0.0_f64, |a, b| a.max(*b))
        {
            // A ramp makes an error grow, too, but ever slower; an unstable loop by a factor from tenth to tenth.
            let grows = self.tenths[6..].windows(2).all(|pair| pair[1] > 1.5 * pair[0]);
            say(if grows {
                format!("the error grows to the end, to {last:.3}: the loop is unstable")
            } else {
                format!("the error does not die out: still {last:.3} at the end")
            });
        }
        list
    }
}
