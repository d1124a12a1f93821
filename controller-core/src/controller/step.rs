//! One sample of the loop.

use super::io::{ControllerInput, ControllerOutput};
use super::law::Controller;
use super::state::ControllerState;
use crate::compensator::{Compensate, CompensatorOutput};
use crate::limit::Limited;
use crate::mode::Mode;
use crate::pid::PidInput;
use crate::real::Real;
use crate::regulator::Regulator;
use crate::sample::{Quality, Verdict};
use crate::status::Status;
use crate::stored::{Flag, StoredMode};

/// What a sample works with once its inputs are checked.
pub(super) struct Checked<T> {
    pub(super) y: T,
    pub(super) u_f: T,
    pub(super) applied: T,
    /// The part of `applied` that the law itself has moved.
    pub(super) own: T,
    pub(super) was: Mode,
    pub(super) mode: Mode,
}

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// One sample. See the type and the [module](crate::controller) for what it computes and costs.
    #[inline]
    pub fn step(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> ControllerOutput<T> {
        if self.goes_on(state, input) {
            let (estimate, status) = self.go_on(state, input);
            self.output(state, estimate, status)
        } else {
            self.step_rare(state, input)
        }
    }

    /// A sample that does not go on: a function of its own, so that a usual sample does not save the registers it needs.
    #[cold]
    #[inline(never)]
    fn step_rare(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> ControllerOutput<T> {
        let (estimate, status) = self.step_any(state, input);
        self.output(state, estimate, status)
    }

    /// Any sample.
    pub(super) fn step_any(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> (CompensatorOutput<T>, Status) {
        let mut status = Status::OVERRUN.when(state.overrun.is_set());
        state.overrun = Flag::default();
        let offset = state.offset;

        // 1. Inputs.
        let verdict = self.guard.judge(&mut state.guard, input.y, input.quality, input.acknowledge);
        let usable = matches!(verdict, Verdict::Use | Verdict::UseAfterSettling);
        status |= verdict_status(verdict, input.quality);
        status |= self.take_setpoint_and_offset(state, input);
        if !state.awake.is_set() {
            state.awake = Flag::new(true);
            state.u.set(self.initial_output);
        }
        let (applied, replaced) = self.applied(state.u.value(), input.u_applied);
        status |= replaced;
        let mut own = applied - offset;
        if !state.started.is_set() {
            if !usable {
                return self.without_measurement(state, input, applied, status);
            }
            self.start(state, input, applied);
            own = applied;
        }
        // Good measurements are followed while a latched fallback waits, too.
        let y = if usable || verdict == Verdict::Await { input.y } else { state.y };
        state.y = y;

        // 2, 3. The applied output goes into the compensator, the disturbance comes out of it.
        let mut estimate = self.compensator.sample(&mut state.compensator, y, applied);
        if verdict == Verdict::UseAfterSettling {
            self.resettle(state, y, applied, own);
            estimate = CompensatorOutput::default();
        }
        let u_f = self.use_compensator(state, input.compensate, estimate.u_f);

        // 4-6. The mode decides who gives the output; range and rate hold in all of them.
        let was = state.mode.get();
        let requested = input.mode.in_force(state.guard.fallback.is_set());
        let held = verdict == Verdict::Hold && requested.is_automatic();
        let mode = match (held, was.is_automatic()) {
            (false, _) => requested,
            (true, true) => was,
            (true, false) => Mode::Hold,
        };
        let sample = Checked { y, u_f, applied, own, was, mode };
        let mut slowest = None;
        let mut wanted = state.u.value();
        if held {
            // Output and terms stay; what the last sample wanted is still to be judged by the anti-windup.
        } else if mode.is_automatic() {
            status |= self.close(state, input, &sample);
            wanted = state.v;
        } else {
            let (opened, step) = self.open(state, input, &sample, verdict);
            status |= opened;
            slowest = step;
            wanted = state.v;
        }
        let limited = self.limit_output(state, wanted, slowest);
        if !mode.is_automatic() {
            // The integral term follows, so that closing the loop moves nothing.
            L::follow(&mut state.law, limited.u - state.pd - u_f - state.offset);
        }
        state.mode = StoredMode::new(mode);

        // 7. Alarms, status, output.
        if usable || verdict == Verdict::Await {
            state.alarms = self.alarms.check(state.alarms, state.r.value(), y);
        }
        status |= Status::COMPENSATING.when(C::PRESENT && input.compensate && mode.is_automatic());
        (estimate, status | self.last_bits(state, limited))
    }

    /// The automatic output of this sample, into `state.v`.
    ///
    /// Entering from another mode, the integral term is set so that the output begins where that mode would have put
    /// it; between Auto and Cascade, where the old set-point would have put it.
    #[inline(always)]
    fn close(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
    ) -> Status {
        let begin = if !sample.was.is_automatic() {
            let u = state.u.value();
            let there = self.target(sample.was, input).unwrap_or(u);
            let mut last = state.u;
            Some((self.limit.apply(&mut last, there).u, T::ZERO))
        } else if sample.was != sample.mode {
            let mut r = state.r;
            self.setpoint.advance(&mut r, self.asked_by(sample.was, state, input));
            let seen = self.seen(r.value(), sample.y);
            let increment = self.allowed(input, self.law.increment(&state.law, seen));
            let there = self.law.preview(&state.law, seen, sample.own);
            let i = there.i + increment + self.unwind(state, sample);
            Some((i + there.pd + state.offset + sample.u_f, increment))
        } else {
            None
        };
        self.setpoint.ramp(&mut state.r, state.r_asked);
        self.automatic(state, input, sample, begin)
    }

    /// Law + offset + compensator; with `begin`, the integral term is set so that the sum is its first number, of which
    /// the second is the increment that the next sample may still take back.
    #[inline(always)]
    pub(super) fn automatic(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
        begin: Option<(T, T)>,
    ) -> Status {
        let seen = self.seen(state.r.value(), sample.y);
        let increment = self.law.increment(&state.law, seen);
        let (allowed, inhibited) = if input.inhibit_up | input.inhibit_down {
            let allowed = self.allowed(input, increment);
            (allowed, Status::INHIBITED.when(allowed != increment))
        } else {
            (increment, Status::NONE)
        };
        state.pd = self.law.filter(&mut state.law, seen, sample.own);
        match begin {
            Some((v, increment)) => {
                L::begin(&mut state.law, v - state.pd - sample.u_f - state.offset, increment);
            }
            None => {
                let correction = self.unwind(state, sample);
                self.law.integrate(&mut state.law, correction, allowed);
            }
        }
        self.law.bound_integral(&mut state.law, self.integral_bound);
        state.v = L::integral(&state.law) + state.pd + state.offset + sample.u_f;
        inhibited
    }

    /// The increment that a secondary loop lets through.
    #[inline(always)]
    fn allowed(&self, input: &ControllerInput<T>, increment: T) -> T {
        let inhibited =
            (input.inhibit_up && increment > T::ZERO) || (input.inhibit_down && increment < T::ZERO);
        if inhibited { T::ZERO } else { increment }
    }

    /// The output that a mode other than Auto and Cascade gives, into `state.v`, and the longest step towards it.
    ///
    /// A mode that keeps the output keeps what the automatic law gives in the sample of the change; on a bad sample, what
    /// is there.
    fn open(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
        verdict: Verdict,
    ) -> (Status, Option<T>) {
        let target = self.target(sample.mode, input);
        let good = matches!(verdict, Verdict::Use | Verdict::UseAfterSettling);
        if sample.was.is_automatic() && target.is_none() && good {
            let asked = self.asked_by(sample.was, state, input);
            self.setpoint.advance(&mut state.r, asked);
            return (self.automatic(state, input, sample, None), None);
        }
        if sample.mode.releases_setpoint() && self.setpoint.tracks() {
            state.r.set(self.setpoint.into_range(sample.y));
        } else {
            self.setpoint.ramp(&mut state.r, state.r_asked);
        }
        state.pd = self.law.filter(&mut state.law, self.seen(state.r.value(), sample.y), sample.own);
        state.v = target.unwrap_or(state.u.value());
        let step = if sample.mode == Mode::Fallback { Some(self.guard.fallback_output().1) } else { None };
        (Status::NONE, step)
    }

    /// The output within range and rate, and within `slowest` per sample.
    #[inline(always)]
    fn limit_output(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        wanted: T,
        slowest: Option<T>,
    ) -> Limited<T> {
        match slowest {
            None => self.limit.apply(&mut state.u, wanted),
            Some(step) => self.limit.no_faster_than(step).apply(&mut state.u, wanted),
        }
    }

    /// Where a mode wants the output \[u\]; `None`: where it is.
    fn target(&self, mode: Mode, input: &ControllerInput<T>) -> Option<T> {
        let finite = |x: &T| x.is_finite_number();
        let within = |x: T| self.limit.into_range(x);
        match mode {
            Mode::Off => self.off_output.get(),
            Mode::Manual => input.manual.filter(finite).map(within),
            Mode::Track => Some(input.track).filter(finite).map(within),
            Mode::Fallback => self.guard.fallback_output().0,
            Mode::Hold | Mode::Auto | Mode::Cascade => None,
        }
    }

    /// The anti-windup correction for the sample before \[u\].
    #[inline(always)]
    fn unwind(&self, state: &ControllerState<T, C::State, L::State>, sample: &Checked<T>) -> T {
        self.anti_windup.correction(L::last_increment(&state.law), state.v, sample.applied)
    }

    /// What the law sees of a set-point and a measurement.
    #[inline(always)]
    pub(super) fn seen(&self, r: T, y: T) -> PidInput<T> {
        PidInput { r, y: self.deadband.apply(r, y) }
    }

    /// The set-point that `mode` uses, unless it is not finite.
    #[inline(always)]
    fn setpoint_of(&self, mode: Mode, input: &ControllerInput<T>) -> Option<T> {
        let r = if mode == Mode::Cascade { input.r_remote } else { input.r };
        Some(r).filter(|r| r.is_finite_number())
    }

    /// The set-point as `mode` asks for it in this sample.
    fn asked_by(
        &self,
        mode: Mode,
        state: &ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> T {
        self.setpoint_of(mode, input).unwrap_or(state.r_asked)
    }

    #[inline(always)]
    pub(super) fn take_setpoint_and_offset(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> Status {
        let mut status = Status::NONE;
        let r = if input.mode == Mode::Cascade { input.r_remote } else { input.r };
        if self.setpoint.is_inside(r) {
            state.r_asked = r;
        } else if r.is_finite_number() {
            state.r_asked = self.setpoint.into_range(r);
            status |= Status::SETPOINT_LIMITED.when(state.r_asked != r);
        } else {
            status |= Status::REJECTED;
        }
        if input.offset >= self.offset_lo && input.offset <= self.offset_hi {
            state.offset = input.offset;
        } else {
            status |= Status::REJECTED.when(!input.offset.is_finite_number());
            let offset = if input.offset.is_finite_number() { input.offset } else { state.offset };
            state.offset = offset.clamp_to(self.offset_lo, self.offset_hi);
        }
        let unusable = match input.mode {
            Mode::Manual => input.manual.is_some_and(|x| !x.is_finite_number()),
            Mode::Track => !input.track.is_finite_number(),
            _ => false,
        };
        status | Status::REJECTED.when(unusable)
    }

    /// What was applied since the last sample \[u\].
    #[inline(always)]
    pub(super) fn applied(&self, own: T, read_back: Option<T>) -> (T, Status) {
        match read_back {
            Some(a) if a.is_finite_number() => (self.limit.into_range(a), Status::NONE),
            Some(_) => (own, Status::REJECTED),
            None => (own, Status::NONE),
        }
    }

    /// Takes the compensator in or out of the sum without a bump; gives what it adds.
    #[inline(always)]
    fn use_compensator(&self, state: &mut ControllerState<T, C::State, L::State>, wanted: bool, u_f: T) -> T {
        if state.compensating.is_set() != wanted {
            state.compensating = Flag::new(wanted);
            L::shift(&mut state.law, if wanted { -u_f } else { u_f });
        }
        state.u_f = if wanted { u_f } else { T::ZERO };
        state.u_f
    }

    /// The first good sample of a zeroed state. Without a usable set-point the loop stays at the measurement.
    fn start(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
        applied: T,
    ) {
        let asked = self.setpoint_of(input.mode, input).map_or(input.y, |r| self.setpoint.into_range(r));
        self.settle(state, self.setpoint.start(asked, input.y), input.y, applied);
        state.r_asked = self.setpoint.into_range(asked);
        state.mode = StoredMode::new(Mode::Hold);
        state.compensating = Flag::new(input.compensate);
        let _ = self.take_setpoint_and_offset(state, input);
    }

    /// The first good sample after a long time without: everything at rest at the measurement and the applied output.
    fn resettle(&self, state: &mut ControllerState<T, C::State, L::State>, y: T, applied: T, own: T) {
        self.compensator.resettle(&mut state.compensator, y);
        let seen = self.seen(state.r.value(), y);
        self.law.settle(&mut state.law, seen, own);
        state.u.set(applied);
        state.v = applied;
        state.mode = StoredMode::new(Mode::Hold);
    }

    /// A zeroed state that has not seen a good measurement: the modes that need none work, the others hold.
    fn without_measurement(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
        applied: T,
        status: Status,
    ) -> (CompensatorOutput<T>, Status) {
        let requested = input.mode.in_force(state.guard.fallback.is_set());
        let mode = if requested.is_automatic() { Mode::Hold } else { requested };
        state.v = self.target(mode, input).unwrap_or(applied);
        state.u.set(applied);
        let slowest = if mode == Mode::Fallback { Some(self.guard.fallback_output().1) } else { None };
        let limited = self.limit_output(state, state.v, slowest);
        state.r.set(state.r_asked);
        state.mode = StoredMode::new(mode);
        let status = status | limited_status(limited) | Status::UNINITIALISED;
        (CompensatorOutput::default(), status)
    }

    /// The bits that every sample ends with.
    #[inline(always)]
    pub(super) fn last_bits(
        &self,
        state: &ControllerState<T, C::State, L::State>,
        limited: Limited<T>,
    ) -> Status {
        limited_status(limited)
            | Status::SETPOINT_RAMPING.when(state.r.value() != state.r_asked)
            | state.alarms
    }

    #[inline(always)]
    pub(super) fn output(
        &self,
        state: &ControllerState<T, C::State, L::State>,
        estimate: CompensatorOutput<T>,
        status: Status,
    ) -> ControllerOutput<T> {
        let r = state.r.value();
        let (mut up, mut down) = (false, false);
        // Both questions are rarely answered with yes.
        if !self.setpoint.is_inside(r) {
            let (lo, hi) = self.setpoint.range();
            (up, down) = (r >= hi, r <= lo);
        }
        if status.has_any(Status::LIMITED_HIGH | Status::LIMITED_LOW) {
            let full = status.has(Status::LIMITED_HIGH);
            let empty = status.has(Status::LIMITED_LOW);
            up |= if self.reversed.is_set() { empty } else { full };
            down |= if self.reversed.is_set() { full } else { empty };
        }
        ControllerOutput {
            u: state.u.value(),
            v: state.v,
            i: L::integral(&state.law),
            pd: state.pd,
            u_f: estimate.u_f,
            d_hat: estimate.d_hat,
            r,
            blocked_up: up,
            blocked_down: down,
            mode: state.mode.get(),
            status,
        }
    }
}

#[inline(always)]
fn limited_status<T>(limited: Limited<T>) -> Status {
    Status::LIMITED_HIGH.when(limited.high)
        | Status::LIMITED_LOW.when(limited.low)
        | Status::RATE_LIMITED.when(limited.rate)
}

fn verdict_status(verdict: Verdict, quality: Quality) -> Status {
    match verdict {
        Verdict::Use | Verdict::UseAfterSettling => Status::UNCERTAIN.when(quality == Quality::Uncertain),
        Verdict::Hold => Status::BAD_INPUT | Status::HELD,
        Verdict::Fallback => Status::BAD_INPUT | Status::FALLBACK,
        Verdict::Await => Status::FALLBACK | Status::AWAITING_ACKNOWLEDGEMENT,
    }
}
