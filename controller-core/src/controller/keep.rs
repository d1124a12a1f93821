//! What happens to a loop's state outside its samples: settling, new laws, lost samples, saving and restoring.

use super::law::Controller;
use super::state::ControllerState;
use crate::anti_windup::AntiWindup;
use crate::compensator::Compensate;
use crate::mode::Mode;
use crate::real::Real;
use crate::regulator::Regulator;
use crate::sample::SampleGuardState;
use crate::snapshot::{self, SnapshotError, Words};
use crate::status::Status;
use crate::stored::{Flag, StoredMode};

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// A zeroed state: it settles itself on its first good sample, at the read-back or at `initial_output`.
    #[must_use]
    pub fn zeroed(&self) -> ControllerState<T, C::State, L::State>
    where
        C::State: Default,
    {
        ControllerState::default()
    }

    /// Puts the loop at rest: set-point `r0`, measurement `y0`, output `u0`. Nothing moves until an input does.
    /// Values that are not finite or out of range are moved into their ranges. Cost: fills the delay line.
    pub fn settle(&self, state: &mut ControllerState<T, C::State, L::State>, r0: T, y0: T, u0: T) {
        let (y_lo, y_hi) = self.guard.range();
        let y0 = y0.clamp_to(y_lo, y_hi);
        let u0 = self.limit.into_range(u0);
        let r0 = self.setpoint.into_range(r0);
        self.compensator.settle(&mut state.compensator, y0, u0);
        let seen = self.seen(r0, y0);
        self.law.settle(&mut state.law, seen, u0);
        state.pd = u0 - L::integral(&state.law);
        state.guard = SampleGuardState::default();
        state.mode = StoredMode::new(Mode::Auto);
        state.u.set(u0);
        state.r.set(r0);
        (state.v, state.u_f, state.y, state.r_asked) = (u0, T::ZERO, y0, r0);
        state.offset = T::ZERO;
        state.alarms = Status::NONE;
        let [no, yes] = [false, true].map(Flag::new);
        (state.compensating, state.overrun, state.awake, state.started) = (yes, no, yes, yes);
    }

    /// Takes `state` over from the loop `old` without a bump: any parameter, limit, dead time or the sampling period
    /// may differ. In the first sample of the new law the output differs from the old one's by at most
    /// `|dki|*ts*|e| + |d(high-frequency gain)|*|y[k]-y[k-1]|` (and likewise for `r`), by what a tighter limit takes away,
    /// and by what another range or rate makes of the set-point and the offset.
    ///
    /// The lags and the delay line are signals and are kept; the integral term absorbs the rest. With another
    /// sampling period the line's samples mean other times: the compensator then settles, its last output going
    /// into the integral term. A state whose signals are too large for the new gains settles where it is.
    /// Cost: two steps of the blocks without their delay line, and one read of every cell of it.
    pub fn adopt(&self, old: &Self, state: &mut ControllerState<T, C::State, L::State>) {
        self.take_over((&old.law, &old.anti_windup), state, |law, state, y, u| {
            (self.ts == old.ts).then(|| law.adopt(&old.compensator, state, y, u))
        });
    }

    /// Takes `state` over from the loop `old` with another compensator, or with one in the place of none: as
    /// [`adopt`](Self::adopt), but what the old compensator knew is lost. The new one, whose state is `compensator`, settles
    /// at the last measurement and output; the last output of the old one goes into the integral term.
    ///
    /// ```
    /// use controller_core::{Controller, ControllerConfig, ControllerInput, Estimator, EstimatorConfig, PidConfig};
    /// let config = ControllerConfig { pid: PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() }, ..ControllerConfig::default() };
    /// let model = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
    /// let estimator = Estimator::<f64, 32>::estimator(&model, 0.0, 0.01).unwrap();
    /// let with = Controller::with_compensator(&config, estimator, 0.01).unwrap();
    /// let without = Controller::<f64>::new(&config, 0.01).unwrap();
    /// let mut state = with.zeroed();
    /// with.settle(&mut state, 1.0, 1.0, 3.0);
    /// let mut state = without.adopt_from(&with, state, ());
    /// let out = without.step(&mut state, &ControllerInput { r: 1.0, y: 1.0, ..ControllerInput::default() });
    /// assert_eq!(out.u, 3.0);
    /// ```
    pub fn adopt_from<D: Compensate<T>>(
        &self,
        old: &Controller<T, D, L>,
        state: ControllerState<T, D::State, L::State>,
        compensator: C::State,
    ) -> ControllerState<T, C::State, L::State> {
        let mut state = state.with_compensator(compensator);
        self.take_over((&old.law, &old.anti_windup), &mut state, |_, _, _, _| None);
        state
    }

    /// What both ways of taking over share. `hand_over` gives by how much `u_f` jumps when the compensator's state can be
    /// kept at a measurement and an output; else it settles there.
    fn take_over(
        &self,
        (law, anti_windup): (&L, &AntiWindup<T>),
        state: &mut ControllerState<T, C::State, L::State>,
        hand_over: impl FnOnce(&C, &mut C::State, T, T) -> Option<T>,
    ) {
        if !state.started.is_set() {
            // Nothing has happened yet; only the shape may have to change.
            self.compensator.settle(&mut state.compensator, T::ZERO, T::ZERO);
            return;
        }
        state.r_asked = self.setpoint.into_range(state.r_asked);
        // What the old anti-windup rule still owes for the last sample.
        let u = state.u.value();
        let owed = if state.mode.get().is_automatic() {
            anti_windup.correction(L::last_increment(&state.law), state.v, u)
        } else {
            T::ZERO
        };
        state.v = u;
        if !self.holds(state, 0.0) {
            self.settle_where_it_is(state);
            return;
        }
        let lost = self.law.convert(law, &mut state.law, self.seen(state.r.value(), state.y));
        let jump = match hand_over(&self.compensator, &mut state.compensator, state.y, u) {
            Some(jump) => jump,
            None => {
                self.compensator.settle(&mut state.compensator, state.y, u);
                -state.u_f
            }
        };
        let jump = if state.compensating.is_set() { jump } else { T::ZERO };
        state.u_f = state.u_f + jump;
        L::shift(&mut state.law, lost + (owed - jump));
        self.law.bound_integral(&mut state.law, self.integral_bound);
        // The last increment has been judged; the new rule must not judge it again.
        L::forget_increment(&mut state.law);
    }

    /// Whether the signals of `state`, which may come from a law with other ranges or from a snapshot, leave room for this
    /// law's gains in the number type. `cell` is the size of a cell that the delay line is still to get.
    fn holds(&self, state: &ControllerState<T, C::State, L::State>, cell: f64) -> bool {
        // The larger of a range and of what the state holds now.
        let size = |(lo, hi): (T, T), now: [T; 2]| {
            let [now, carry] = now.map(|x| x.magnitude().to_f64());
            let ends = [lo, hi].map(|x| x.magnitude().to_f64());
            ends.iter().fold(now + carry, |largest, &x| if x > largest { x } else { largest })
        };
        let r = size(self.setpoint.range(), [state.r.value(), state.r.carry()]);
        let u = size(self.output_range(), [state.u.value(), state.u.carry()]);
        let y = size(self.guard.range(), [state.y, T::ZERO]);
        let seen = y + r + self.deadband.width().to_f64();
        let law = self.law.reach(&state.law, r, seen, u + state.offset.magnitude().to_f64());
        let largest = if cell > u { cell } else { u };
        let signals = law + self.compensator.reach(&state.compensator, y, largest);
        let numbers = [state.u.carry(), state.r.carry(), state.u.value(), state.r.value()];
        let more = [state.v, state.pd, state.u_f, state.y, state.r_asked, state.offset];
        let own: f64 = numbers.iter().chain(&more).map(|x| x.magnitude().to_f64()).sum();
        signals + own <= 1e-2 * T::LARGEST
    }

    /// Everything at rest at the last measurement and output, moved into this law's ranges.
    fn settle_where_it_is(&self, state: &mut ControllerState<T, C::State, L::State>) {
        let (y_lo, y_hi) = self.guard.range();
        state.y = state.y.clamp_to(y_lo, y_hi);
        let u = self.limit.into_range(state.u.value());
        let r = self.setpoint.into_range(state.r.value());
        state.r.set(r);
        self.compensator.settle(&mut state.compensator, state.y, u);
        self.law.settle(&mut state.law, self.seen(r, state.y), u);
        (state.v, state.u_f) = (u, T::ZERO);
    }

    /// Tells the loop that `n` samples were lost while its last output was applied.
    ///
    /// They count like bad ones: up to `hold_samples` in a row the compensator is taken through them with the last
    /// measurement; beyond, only what it knows of the applied output goes on, and the loop settles at its next good
    /// measurement. The next output carries [`Status::OVERRUN`].
    /// Cost: at most `hold_samples` compensator samples, or half of 1000 samples plus the capacity of the delay line.
    pub fn advance(&self, state: &mut ControllerState<T, C::State, L::State>, n: u32) {
        if n > 0 {
            state.overrun = Flag::new(true);
        }
        if !state.started.is_set() {
            return;
        }
        self.guard.lost(&mut state.guard, n);
        if state.guard.settle.is_set() {
            self.compensator.skip(
                &mut state.compensator,
                state.u.value(),
                usize::try_from(n).unwrap_or(usize::MAX),
            );
        } else {
            for _ in 0..n {
                let _ = self.compensator.sample(&mut state.compensator, state.y, state.u.value());
            }
        }
    }

    /// The smallest constant error \[y\] that still moves the output when the integral term is as large as the output
    /// range; see [`Pid::resolution`](crate::Pid::resolution).
    #[must_use]
    pub fn resolution(&self) -> f64 {
        let (lo, hi) = (self.limit.lo().magnitude(), self.limit.hi().magnitude());
        self.law.resolution(if lo > hi { lo } else { hi })
    }

    /// Number of words that [`save`](Self::save) writes for `state`.
    #[must_use]
    pub fn snapshot_words(state: &ControllerState<T, C::State, L::State>) -> usize {
        Self::body_words(state) + snapshot::FRAME
    }

    fn body_words(state: &ControllerState<T, C::State, L::State>) -> usize {
        ControllerState::<T, C::State, L::State>::own_words(L::NUMBERS) + C::words(&state.compensator)
    }

    /// Writes `state` into `words`; returns how many were used. A loop restored from them continues bit for bit.
    ///
    /// # Errors
    /// A buffer shorter than [`snapshot_words`](Self::snapshot_words).
    ///
    /// ```
    /// use controller_core::{Controller, ControllerConfig, ControllerInput, PidConfig, SnapshotError};
    /// let config = ControllerConfig { pid: PidConfig { kp: 1.0, ki: 0.5, ..PidConfig::default() }, ..ControllerConfig::default() };
    /// let law = Controller::<f32>::new(&config, 0.1).unwrap();
    /// let mut state = law.zeroed();
    /// law.step(&mut state, &ControllerInput { r: 1.0, ..ControllerInput::default() });
    /// let mut words = [0; 64];
    /// let n = law.save(&state, &mut words).unwrap();
    /// let mut copy = law.zeroed();
    /// law.restore(&mut copy, &words[..n]).unwrap();
    /// assert_eq!(copy, state);
    /// words[5] ^= 1;
    /// assert_eq!(law.restore(&mut copy, &words[..n]), Err(SnapshotError::Checksum));
    /// ```
    pub fn save(
        &self,
        state: &ControllerState<T, C::State, L::State>,
        words: &mut [u32],
    ) -> Result<usize, SnapshotError> {
        snapshot::write::<T>(words, Self::body_words(state), |writer| Self::write_state(state, writer))
    }

    pub(super) fn write_state(state: &ControllerState<T, C::State, L::State>, words: &mut impl Words) {
        L::save(&state.law, words);
        state.save_own(words);
        C::save(&state.compensator, words);
    }

    /// Reads a state back from `words`. `state` must have the shape of the saved one (same number type, same
    /// compensator) and is left alone when anything is wrong.
    ///
    /// # Errors
    /// Another version or shape, a wrong checksum, a number that is not finite or too large for this law.
    pub fn restore(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        words: &[u32],
    ) -> Result<(), SnapshotError> {
        let mut fresh = state.clone();
        snapshot::read::<T, ()>(words, Self::body_words(state), |reader| {
            fresh.law = L::restore(reader)?;
            fresh.restore_own(reader)?;
            let cell = C::restore(&mut fresh.compensator, reader)?;
            self.holds(&fresh, cell).then_some(())?;
            C::restore_line(&mut fresh.compensator, reader)
        })?;
        *state = fresh;
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::compensator::{AnyCompensator, CompensatorConfig, EstimatorConfig};
    use crate::controller::{ControllerConfig, ControllerInput};
    use crate::pid::PidConfig;

    const TS: f64 = 0.01;
    const CELLS: usize = 32;
    const KI: f64 = 0.5;

    type Estimated = AnyCompensator<f64, [f64; CELLS]>;

    fn config() -> ControllerConfig {
        // Without a filter the terms follow the inputs at once: a sample with the inputs of the last one moves the
        // integral term only.
        ControllerConfig {
            pid: PidConfig { kp: 1.2, ki: KI, ..PidConfig::default() },
            ..ControllerConfig::default()
        }
    }

    fn estimated() -> Controller<f64, Estimated> {
        let model = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
        let compensator: CompensatorConfig = model.to_compensator(0.0);
        let law = Estimated::new(&compensator, TS, CELLS).unwrap();
        Controller::with_compensator(&config(), law, TS).unwrap()
    }

    /// A loop in the middle of a transient, and the output and the input of its last sample.
    fn at_work<C: Compensate<f64>>(
        law: &Controller<f64, C>,
        state: &mut ControllerState<f64, C::State>,
    ) -> (f64, f64, ControllerInput<f64>) {
        let mut input = ControllerInput { r: 1.0, ..ControllerInput::default() };
        let mut last = law.step(state, &input);
        for _ in 0..80 {
            // A plant that the model does not know: a disturbance of 0.7.
            input.y += TS * (last.u + 0.7 - input.y);
            last = law.step(state, &input);
        }
        (last.u, last.u_f, input)
    }

    #[test]
    fn a_compensator_comes_and_goes_without_a_bump() {
        let (with, without) = (estimated(), Controller::<f64>::new(&config(), TS).unwrap());
        let fresh = || with.compensator.state([0.0; CELLS]).unwrap();

        let mut state = ControllerState::over(fresh());
        let (u, u_f, input) = at_work(&with, &mut state);
        assert!(u_f.abs() > 0.1, "{u_f}");
        let mut state = without.adopt_from(&with, state, ());
        let next = without.step(&mut state, &input).u;
        // What is left is the sample's own increment.
        let increment = KI * TS * (input.r - input.y);
        assert!((next - u - increment).abs() < 1e-12, "{next} after {u}");

        let mut state = without.zeroed();
        let (u, _, input) = at_work(&without, &mut state);
        let mut state = with.adopt_from(&without, state, fresh());
        let out = with.step(&mut state, &input);
        let increment = KI * TS * (input.r - input.y);
        assert!((out.u - u - increment).abs() < 1e-12 && out.u_f.abs() < 1e-12, "{out:?} after {u}");
    }
}
