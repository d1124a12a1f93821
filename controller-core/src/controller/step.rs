//! One sample of the loop.

use super::io::{ControllerInput, ControllerOutput};
use super::law::Controller;
use super::state::ControllerState;
use crate::compensator::{Compensate, CompensatorOutput};
use crate::mode::Mode;
use crate::pid::PidInput;
use crate::real::Real;
use crate::sample::{Quality, Verdict};
use crate::status::Status;

/// What a sample works with once its inputs are checked.
struct Checked<T> {
    y: T,
    u_f: T,
    applied: T,
    was: Mode,
    mode: Mode,
}

impl<T: Real, C: Compensate<T>> Controller<T, C> {
    /// One sample. See the type and the [module](crate::controller) for what it computes and costs.
    pub fn step(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
    ) -> ControllerOutput<T> {
        let mut status = Status::OVERRUN.when(state.overrun);
        state.overrun = false;

        // 1. Inputs.
        let verdict = self.guard.judge(&mut state.guard, input.y, input.quality, input.acknowledge);
        let usable = matches!(verdict, Verdict::Use | Verdict::UseAfterSettling);
        status |= verdict_status(verdict, input.quality);
        status |= self.take_setpoint_and_offset(state, input);
        if !state.awake {
            state.awake = true;
            state.u = self.initial_output;
        }
        let (applied, replaced) = self.applied(state.u, input.u_applied);
        status |= replaced;
        if !state.started {
            if !usable {
                return self.without_measurement(state, input, applied, status);
            }
            self.start(state, input, applied);
        }
        let y = if usable { input.y } else { state.y };
        state.y = y;

        // 2, 3. The applied output goes into the compensator, the disturbance comes out of it.
        let mut estimate = self.compensator.sample(&mut state.compensator, y, applied);
        if verdict == Verdict::UseAfterSettling {
            self.resettle(state, y, applied);
            estimate = CompensatorOutput::default();
        }
        let u_f = self.use_compensator(state, input.compensate, estimate.u_f);

        // 4-6. The mode decides who gives the output; range and rate hold in all of them.
        let was = state.mode;
        let requested = input.mode.in_force(state.guard.fallback);
        let held = verdict == Verdict::Hold && requested.is_automatic();
        let mode = match (held, was.is_automatic()) {
            (false, _) => requested,
            (true, true) => was,
            (true, false) => Mode::Hold,
        };
        let sample = Checked { y, u_f, applied, was, mode };
        if mode.is_automatic() {
            if held {
                state.v = state.u;
            } else {
                status |= self.close(state, input, &sample);
            }
        } else {
            status |= self.open(state, input, &sample);
        }
        let limited = self.limit.apply(state.u, state.v);
        state.u = limited.u;
        if !mode.is_automatic() {
            // The integral term follows, so that closing the loop moves nothing.
            state.pid.set_integral(limited.u - state.pd - u_f - state.offset);
        }
        state.mode = mode;

        // 7. Alarms, status, output.
        if usable {
            state.alarms = self.alarms.check(state.alarms, state.r, y);
        }
        status |= Status::COMPENSATING.when(C::PRESENT && input.compensate && mode.is_automatic())
            | Status::LIMITED_HIGH.when(limited.high)
            | Status::LIMITED_LOW.when(limited.low)
            | Status::RATE_LIMITED.when(limited.rate)
            | Status::SETPOINT_RAMPING.when(state.r != state.r_asked)
            | state.alarms;
        self.output(state, estimate, status)
    }

    /// The automatic output of this sample, into `state.v`.
    ///
    /// Entering from another mode, the integral term is set so that the output begins where that mode would have put
    /// it; between Auto and Cascade, where the old set-point would have put it.
    #[inline(always)]
    fn close(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
    ) -> Status {
        let begin = if !sample.was.is_automatic() {
            let there = self.target(sample.was, state.u, input).unwrap_or(state.u);
            Some(self.limit.apply(state.u, there).u)
        } else if sample.was != sample.mode {
            let r = self.setpoint.advance(state.r, self.asked_by(sample.was, state, input));
            let seen = self.seen(r, sample.y);
            let i = state.pid.integral() + self.pid.increment(&state.pid, seen) + self.unwind(state, sample);
            Some(i + self.pid.preview(&state.pid, seen) + state.offset + sample.u_f)
        } else {
            None
        };
        state.r = self.setpoint.ramp(state.r, state.r_asked);
        self.automatic(state, input, sample, begin)
    }

    /// PID + offset + compensator; with `begin`, the integral term is set so that the sum is `begin`.
    #[inline(always)]
    fn automatic(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
        begin: Option<T>,
    ) -> Status {
        let seen = self.seen(state.r, sample.y);
        let increment = self.pid.increment(&state.pid, seen);
        state.pd = self.pid.filter(&mut state.pid, seen);
        let mut status = Status::NONE;
        match begin {
            Some(v) => state.pid.set_integral(v - state.pd - sample.u_f - state.offset),
            None => {
                let correction = self.unwind(state, sample);
                let inhibited =
                    (input.inhibit_up && increment > T::ZERO) || (input.inhibit_down && increment < T::ZERO);
                status = Status::INHIBITED.when(inhibited);
                state.pid.shift_integral(correction);
                state.pid.integrate(if inhibited { T::ZERO } else { increment });
                state.pid.bound_integral(self.integral_bound);
            }
        }
        state.v = state.pid.integral() + state.pd + state.offset + sample.u_f;
        status
    }

    /// The output that a mode other than Auto and Cascade gives, into `state.v`.
    ///
    /// A mode that keeps the output keeps what the automatic law gives in the sample of the change.
    fn open(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
        sample: &Checked<T>,
    ) -> Status {
        let target = self.target(sample.mode, state.u, input);
        let left_now = sample.was.is_automatic();
        if left_now && target.is_none() && sample.mode != Mode::Fallback {
            state.r = self.setpoint.advance(state.r, self.asked_by(sample.was, state, input));
            return self.automatic(state, input, sample, None);
        }
        state.r = if sample.mode.releases_setpoint() && self.setpoint.tracks() {
            self.setpoint.into_range(sample.y)
        } else {
            self.setpoint.ramp(state.r, state.r_asked)
        };
        state.pd = self.pid.filter(&mut state.pid, self.seen(state.r, sample.y));
        state.v = target.unwrap_or(state.u);
        Status::NONE
    }

    /// Where a mode wants the output \[u\]; `None`: where it is.
    fn target(&self, mode: Mode, u: T, input: &ControllerInput<T>) -> Option<T> {
        match mode {
            Mode::Off => self.off_output,
            Mode::Manual => input.manual.filter(|x| x.is_finite_number()),
            Mode::Track => Some(input.track).filter(|x| x.is_finite_number()),
            Mode::Fallback => Some(self.guard.fallback_output(u)),
            Mode::Hold | Mode::Auto | Mode::Cascade => None,
        }
    }

    /// The anti-windup correction for the sample before \[u\].
    #[inline(always)]
    fn unwind(&self, state: &ControllerState<T, C::State>, sample: &Checked<T>) -> T {
        self.anti_windup.correction(state.pid.increment(), state.v, sample.applied)
    }

    /// What the PID sees of a set-point and a measurement.
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
    fn asked_by(&self, mode: Mode, state: &ControllerState<T, C::State>, input: &ControllerInput<T>) -> T {
        self.setpoint_of(mode, input).unwrap_or(state.r_asked)
    }

    fn take_setpoint_and_offset(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
    ) -> Status {
        let mut status = Status::NONE;
        match self.setpoint_of(input.mode, input) {
            Some(r) => {
                state.r_asked = self.setpoint.into_range(r);
                status |= Status::SETPOINT_LIMITED.when(state.r_asked != r);
            }
            None => status |= Status::REJECTED,
        }
        if input.offset >= self.offset_lo && input.offset <= self.offset_hi {
            state.offset = input.offset;
        } else {
            status |= Status::REJECTED.when(!input.offset.is_finite_number());
            let offset = if input.offset.is_finite_number() { input.offset } else { state.offset };
            state.offset = offset.clamp_to(self.offset_lo, self.offset_hi);
        }
        let manual_bad = input.mode == Mode::Manual && input.manual.is_some_and(|x| !x.is_finite_number());
        let track_bad = input.mode == Mode::Track && !input.track.is_finite_number();
        status | Status::REJECTED.when(manual_bad || track_bad)
    }

    /// What was applied since the last sample \[u\].
    #[inline(always)]
    fn applied(&self, own: T, read_back: Option<T>) -> (T, Status) {
        match read_back {
            Some(a) if a.is_finite_number() => (self.limit.into_range(a), Status::NONE),
            Some(_) => (own, Status::REJECTED),
            None => (own, Status::NONE),
        }
    }

    /// Takes the compensator in or out of the sum without a bump; gives what it adds.
    #[inline(always)]
    fn use_compensator(&self, state: &mut ControllerState<T, C::State>, wanted: bool, u_f: T) -> T {
        if state.compensating != wanted {
            state.compensating = wanted;
            state.pid.shift_integral(if wanted { -u_f } else { u_f });
        }
        state.u_f = if wanted { u_f } else { T::ZERO };
        state.u_f
    }

    /// The first good sample of a zeroed state.
    fn start(&self, state: &mut ControllerState<T, C::State>, input: &ControllerInput<T>, applied: T) {
        self.settle(state, self.setpoint.start(state.r_asked, input.y), input.y, applied);
        state.mode = Mode::Hold;
        state.compensating = input.compensate;
        let _ = self.take_setpoint_and_offset(state, input);
    }

    /// The first good sample after a long time without: everything at rest at the measurement and the applied output.
    fn resettle(&self, state: &mut ControllerState<T, C::State>, y: T, applied: T) {
        self.compensator.resettle(&mut state.compensator, y);
        let seen = self.seen(state.r, y);
        self.pid.settle(&mut state.pid, seen, applied);
        state.u = applied;
        state.v = applied;
        state.mode = Mode::Hold;
    }

    /// A zeroed state that has not seen a good measurement: the modes that need none work, the others hold.
    fn without_measurement(
        &self,
        state: &mut ControllerState<T, C::State>,
        input: &ControllerInput<T>,
        applied: T,
        status: Status,
    ) -> ControllerOutput<T> {
        let requested = input.mode.in_force(state.guard.fallback);
        let mode = if requested.is_automatic() { Mode::Hold } else { requested };
        state.v = self.target(mode, applied, input).unwrap_or(applied);
        state.u = self.limit.apply(applied, state.v).u;
        state.mode = mode;
        self.output(state, CompensatorOutput::default(), status | Status::UNINITIALISED)
    }

    #[inline(always)]
    fn output(
        &self,
        state: &ControllerState<T, C::State>,
        estimate: CompensatorOutput<T>,
        status: Status,
    ) -> ControllerOutput<T> {
        let (lo, hi) = self.setpoint.range();
        let full = status.has(Status::LIMITED_HIGH);
        let empty = status.has(Status::LIMITED_LOW);
        let (up, down) = if self.reversed { (empty, full) } else { (full, empty) };
        ControllerOutput {
            u: state.u,
            v: state.v,
            i: state.pid.integral(),
            pd: state.pd,
            u_f: estimate.u_f,
            d_hat: estimate.d_hat,
            r: state.r,
            blocked_up: up || state.r >= hi,
            blocked_down: down || state.r <= lo,
            mode: state.mode,
            status,
        }
    }
}

fn verdict_status(verdict: Verdict, quality: Quality) -> Status {
    match verdict {
        Verdict::Use | Verdict::UseAfterSettling => Status::UNCERTAIN.when(quality == Quality::Uncertain),
        Verdict::Hold => Status::BAD_INPUT | Status::HELD,
        Verdict::Fallback => Status::BAD_INPUT | Status::FALLBACK,
        Verdict::Await => Status::FALLBACK | Status::AWAITING_ACKNOWLEDGEMENT,
    }
}
