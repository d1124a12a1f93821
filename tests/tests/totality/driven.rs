//! A loop that is driven by bytes: samples with any input, lost samples, swaps, settling, saving and restoring, each
//! followed by the checks of what must always hold.

use super::built::{Block, Built, Checked, accepted, saved};
use super::configs::Case;
use super::draw::Draw;
use controller_core::{
    ControllerInput, ControllerOutput, ControllerState, FallbackReturn, Mode, Quality, Real, Status,
};

macro_rules! ensure {
    ($holds:expr, $($message:tt)+) => {
        if !$holds {
            return Err(format!($($message)+));
        }
    };
}

/// What the documentation says of bad samples in a row.
#[derive(Clone, Default)]
struct Expected {
    bad: u32,
    fallback: bool,
    settle: bool,
}

/// A loop with its state, and what is known of it from outside.
pub(crate) struct Driven<'a, T: Real, C: Block<T>> {
    laws: &'a [Built<T, C>],
    now: usize,
    pub(crate) state: ControllerState<T, C::State>,
    last: T,
    awake: bool,
    expected: Expected,
}

impl<'a, T: Real, C: Block<T>> Driven<'a, T, C> {
    /// A zeroed state under the first of the laws.
    pub(crate) fn new(laws: &'a [Built<T, C>]) -> Self {
        let state = ControllerState::over(laws[0].law.compensator().blank());
        Self { laws, now: 0, state, last: T::ZERO, awake: false, expected: Expected::default() }
    }

    /// The law in force.
    pub(crate) fn built(&self) -> &'a Built<T, C> {
        &self.laws[self.now]
    }

    /// One operation, chosen by bytes.
    pub(crate) fn operate(&mut self, bytes: &[u8]) -> Checked {
        let mut draw = Draw::new(bytes);
        match draw.index(16) {
            12 => self.lose(&mut draw),
            13 => self.swap(draw.index(self.laws.len()))?,
            14 => self.settle(&mut draw)?,
            15 => self.refuse(&mut draw)?,
            _ => {
                let input = self.built().input(&mut draw);
                self.step(&input)?;
            }
        }
        self.check_state()
    }

    /// One sample.
    pub(crate) fn step(&mut self, input: &ControllerInput<T>) -> Checked<ControllerOutput<T>> {
        let Built { case, law } = self.built();
        let (lo, hi) = law.output_range();
        let (good, usable, settles) = self.judge(input);
        let own = match self.awake {
            true => self.last,
            false => T::from_f64(case.config.initial_output).clamp_to(lo, hi),
        };
        let read_back = input.u_applied.filter(|a| a.is_finite_number()).map(|a| a.clamp_to(lo, hi));
        // A loop that settles begins where the actuator is, in the range; otherwise its own last output counts.
        let base = match settles || !self.state.is_started() {
            true => read_back.unwrap_or(own).clamp_to(lo, hi),
            false => own,
        };
        let out = law.step(&mut self.state, input);
        let context = || format!("{case:?}\nfrom {base:?} by {input:?}\nto {out:?}");

        let numbers = [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r];
        ensure!(numbers.iter().all(|x| x.is_finite_number()), "an output is not finite\n{}", context());
        ensure!(lo <= out.u && out.u <= hi, "the output is outside {lo:?}..{hi:?}\n{}", context());
        let u = out.u.to_f64();
        let (least, most) = self.reachable(base.to_f64(), u);
        ensure!(least <= u && u <= most, "faster than {least:?}..{most:?}\n{}", context());
        let same = self.state.u().to_words() == out.u.to_words() && self.state.mode() == out.mode;
        ensure!(same, "state and output disagree\n{}", context());

        ensure!(out.status.has(Status::BAD_INPUT) != good, "judged wrong\n{}", context());
        let waits = Status::HELD | Status::FALLBACK | Status::AWAITING_ACKNOWLEDGEMENT;
        ensure!((out.status.bits() & waits.bits() == 0) == usable, "used or not\n{}", context());
        let uninitialised = out.status.has(Status::UNINITIALISED);
        ensure!(uninitialised != self.state.is_started(), "started or not\n{}", context());
        let closed = !usable || !input.mode.is_automatic() || out.mode == input.mode;
        ensure!(closed, "a good sample does not close the loop\n{}", context());
        (self.last, self.awake) = (out.u, true);
        Ok(out)
    }

    /// Where the output may be one sample after `base`, up to rounding.
    fn reachable(&self, base: f64, u: f64) -> (f64, f64) {
        let Built { case, law } = self.built();
        let (lo, hi) = law.output_range();
        let step = |rate: Option<f64>| rate.map_or(f64::INFINITY, |rate| rate * case.ts);
        let (up, down) = (step(case.config.limits.rate_up), step(case.config.limits.rate_down));
        let inside = |x: f64| x.clamp(lo.to_f64(), hi.to_f64());
        let rounding = |step: f64| {
            T::EPS * (base.abs() + u.abs() + if step.is_finite() { step } else { 0.0 }) + T::SMALLEST_NORMAL
        };
        (inside(base - down) - rounding(down), inside(base + up) + rounding(up))
    }

    /// Whether the measurement is good, may be used, and whether the loop settles at it.
    fn judge(&mut self, input: &ControllerInput<T>) -> (bool, bool, bool) {
        let built = self.built();
        let policy = &built.case.config.fallback;
        let (lo, hi) = built.measurement();
        let good = input.y >= lo && input.y <= hi && input.quality != Quality::Bad;
        let waiting =
            self.expected.fallback && policy.back == FallbackReturn::Acknowledged && !input.acknowledge;
        if good && !waiting {
            let settles = self.expected.fallback || self.expected.settle;
            self.expected = Expected::default();
            return (good, true, settles);
        }
        if !good {
            self.expected.fallback |= self.expected.bad >= u32::from(policy.hold_samples);
            self.expected.bad = self.expected.bad.saturating_add(1);
        }
        (good, false, false)
    }

    fn lose(&mut self, draw: &mut Draw<'_>) {
        let n = draw.pick(&[1, 0, 2, 3, 30, 70_000, u32::MAX]);
        let Built { case, law } = self.built();
        law.advance(&mut self.state, n);
        if self.state.is_started() {
            // Lost samples are bad samples.
            self.expected.bad = self.expected.bad.saturating_add(n);
            self.expected.settle |= self.expected.bad > u32::from(case.config.fallback.hold_samples);
        }
    }

    pub(crate) fn swap(&mut self, to: usize) -> Checked {
        let u = self.state.u();
        self.laws[to].law.adopt(&self.laws[self.now].law, &mut self.state);
        ensure!(self.state.u().to_words() == u.to_words(), "a swap moved the output from {u:?}");
        self.now = to;
        Ok(())
    }

    fn settle(&mut self, draw: &mut Draw<'_>) -> Checked {
        let Built { case, law } = self.built();
        let (lo, hi) = law.output_range();
        let (r, y, u) = (draw.signal(lo, hi), draw.signal(lo, hi), draw.signal(lo, hi));
        law.settle(&mut self.state, r, y, u);
        let settled = self.state.u();
        ensure!(lo <= settled && settled <= hi, "settling at {u:?} gave {settled:?}\n{case:?}");
        (self.last, self.awake, self.expected) = (settled, true, Expected::default());
        Ok(())
    }

    /// Words that are no snapshot of this state are refused and change nothing.
    fn refuse(&mut self, draw: &mut Draw<'_>) -> Checked {
        let law = &self.built().law;
        let before = saved(law, &self.state);
        let mut words = before.clone();
        match draw.index(4) {
            0 => words = (0..draw.index(64)).map(|_| draw.word()).collect(),
            1 => words.truncate(draw.index(words.len())),
            2 => {
                let at = usize::from(draw.short()) % words.len();
                words[at] ^= 1 << draw.index(32);
            }
            _ => {
                let last = words.len() - 1;
                words[2..last].fill_with(|| draw.word());
                words[last] ^= 1;
            }
        }
        ensure!(law.restore(&mut self.state, &words).is_err(), "a damaged snapshot was taken\n{words:x?}");
        ensure!(saved(law, &self.state) == before, "a refused snapshot changed the state");
        Ok(())
    }

    /// A state that could be saved but not restored would hold a number that is not finite.
    pub(crate) fn check_state(&self) -> Checked {
        let Built { case, law } = self.built();
        let words = saved(law, &self.state);
        let mut copy = ControllerState::over(law.compensator().blank());
        let result = law.restore(&mut copy, &words);
        ensure!(result.is_ok(), "the state cannot be restored: {result:?}\n{case:?}\n{words:x?}");
        ensure!(saved(law, &copy) == words, "restored to something else\n{case:?}");
        Ok(())
    }

    /// Good samples end whatever went before: the first of them closes the loop.
    pub(crate) fn recover(&mut self) -> Checked {
        let input = self.built().good();
        for k in 0..40 {
            let out = self.step(&input)?;
            ensure!(out.mode == Mode::Auto, "not closed after {k} good samples: {input:?} {out:?}");
            self.check_state()?;
        }
        Ok(())
    }
}

/// Everything at once: the loops of all accepted cases, all operations, recovery.
pub(crate) fn drive<T: Real, C: Block<T>>(cases: &[Case], operations: &[Vec<u8>]) -> Checked {
    let laws = accepted::<T, C>(cases);
    if laws.is_empty() {
        return Ok(());
    }
    let mut driven = Driven::new(&laws);
    for bytes in operations {
        driven.operate(bytes)?;
    }
    driven.recover()
}
