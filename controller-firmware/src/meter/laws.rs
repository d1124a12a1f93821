//! Laws on their own: no modes, no checks, the same cost whatever they are given.

use super::clock::Clock;
use super::range::Range;
use super::report::Report;
use super::signals::Chance;
use controller_core::{ConfigErrors, Real};

/// A law as it is measured.
pub(super) struct Bare<C, L, S, I, O> {
    pub(super) name: &'static str,
    /// Its configuration, as it is and retuned.
    pub(super) config: fn(bool) -> C,
    pub(super) new: fn(&C) -> Result<L, ConfigErrors>,
    pub(super) rest: fn(&L) -> S,
    pub(super) step: fn(&L, &mut S, &I) -> O,
    pub(super) adopt: fn(&L, &mut S, &L),
}

/// Samples of one class.
const SAMPLES: u32 = 200;

impl<C, L, S: Clone, I, O> Bare<C, L, S, I, O> {
    /// Measures it. `input` makes an input of a set-point, a measurement and an applied output.
    #[inline(never)]
    pub(super) fn measure<T: Real>(&self, clock: &Clock, input: fn(T, T, T) -> I) -> Option<()> {
        let Some(report) = Report::new::<T>(clock, self.name) else { return Some(()) };
        report.bytes::<L, S>();
        report.code("step", self.step as usize);
        report.code("adopt", self.adopt as usize);
        report.code("new", self.new as usize);
        let [first, second] = [false, true].map(self.config);
        let law = self.build(&report, &first)?;
        let other = self.build(&report, &second)?;

        let mut adopt = Range::NONE;
        let mut chance = Chance::new(1);
        for (class, level) in [("nominal", 0.0), ("high", 1e3), ("low", -1e3)] {
            let mut range = Range::NONE;
            let mut state = (self.rest)(&law);
            for _ in 0..SAMPLES {
                let near = chance.number::<T>(1.0) + T::from_f64(level);
                let sample = input(near, chance.number(1.0), chance.number(10.0));
                range.note(clock.count(self.step, &law, &mut state, &sample).1);
                adopt.note(clock.count(self.adopt, &other, &mut state.clone(), &law).1);
            }
            report.count("step", class, range);
        }
        let mut range = Range::NONE;
        let rest = (self.rest)(&law);
        for _ in 0..SAMPLES {
            let mut state = rest.clone();
            // The second one meets what the first has left.
            for _ in 0..2 {
                let sample = input(chance.anything(), chance.anything(), chance.anything());
                range.note(clock.count(self.step, &law, &mut state, &sample).1);
            }
        }
        report.count("step", "random", range);
        report.count("adopt", "all", adopt);
        Some(())
    }

    /// Builds the law.
    #[inline(never)]
    fn build(&self, report: &Report<'_>, config: &C) -> Option<L> {
        // A list of errors is large: it goes no further than this.
        let build = |new: &fn(&C) -> Result<L, ConfigErrors>, law: &mut Option<L>, config: &C| {
            *law = new(config).ok();
        };
        let mut law = None;
        let ((), count) = report.clock.count(build, &self.new, &mut law, config);
        let mut range = Range::NONE;
        range.note(count);
        report.count("new", "all", range);
        law
    }
}
