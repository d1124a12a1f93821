//! The state of a loop.

use crate::accumulator::Accumulator;
use crate::adrc::AdrcState;
use crate::mode::Mode;
use crate::pid::PidState;
use crate::real::Real;
use crate::sample::SampleGuardState;
use crate::snapshot::{Reader, Words};
use crate::status::Status;
use crate::stored::{Flag, StoredMode};

/// State of a [`Controller`](crate::Controller) with compensator state `S` and the state `P` of its law.
///
/// A default (zeroed) state settles itself on its first good sample; an explicit start is
/// [`Controller::settle`](crate::Controller::settle).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerState<T, S, P = PidState<T>> {
    pub(super) law: P,
    pub(super) compensator: S,
    pub(super) guard: SampleGuardState,
    /// Mode in force in the last sample.
    pub(super) mode: StoredMode,
    /// Last output, limited.
    pub(super) u: Accumulator<T>,
    /// Last output before the limits.
    pub(super) v: T,
    /// Last filtered terms.
    pub(super) pd: T,
    /// Last output of the compensator that was in use.
    pub(super) u_f: T,
    /// Last good measurement.
    pub(super) y: T,
    /// Working set-point.
    pub(super) r: Accumulator<T>,
    /// Last usable set-point as asked for, moved into its range.
    pub(super) r_asked: T,
    /// Last usable offset.
    pub(super) offset: T,
    pub(super) alarms: Status,
    pub(super) compensating: Flag,
    pub(super) overrun: Flag,
    /// The state has taken a sample: `u` says something.
    pub(super) awake: Flag,
    /// The state has taken a good sample or was settled.
    pub(super) started: Flag,
}

impl<T: Real, S: Default, P: Default> Default for ControllerState<T, S, P> {
    fn default() -> Self {
        Self::over(S::default())
    }
}

/// The part of the state that has the same size in every loop, in numbers and in flags.
const NUMBERS: usize = 10;
const FLAGS: usize = 3;

impl<T: Real, S, P: Default> ControllerState<T, S, P> {
    /// A zeroed state over the compensator's state.
    #[must_use]
    pub fn over(compensator: S) -> Self {
        Self {
            law: P::default(),
            compensator,
            guard: SampleGuardState::default(),
            mode: StoredMode::new(Mode::Hold),
            u: Accumulator::new(T::ZERO),
            v: T::ZERO,
            pd: T::ZERO,
            u_f: T::ZERO,
            y: T::ZERO,
            r: Accumulator::new(T::ZERO),
            r_asked: T::ZERO,
            offset: T::ZERO,
            alarms: Status::NONE,
            compensating: Flag::default(),
            overrun: Flag::default(),
            awake: Flag::default(),
            started: Flag::default(),
        }
    }
}

impl<T: Real, S> ControllerState<T, S> {
    /// The state of the PID.
    #[must_use]
    pub fn pid(&self) -> &PidState<T> {
        &self.law
    }
}

impl<T: Real, S> ControllerState<T, S, AdrcState<T>> {
    /// The state of the ADRC.
    #[must_use]
    pub fn adrc(&self) -> &AdrcState<T> {
        &self.law
    }
}

impl<T: Real, S, P> ControllerState<T, S, P> {
    /// The last output \[u\].
    #[must_use]
    pub fn u(&self) -> T {
        self.u.value()
    }

    /// The mode in force in the last sample.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode.get()
    }

    /// Whether the state has seen a good sample or has been settled.
    #[must_use]
    pub fn is_started(&self) -> bool {
        self.started.is_set()
    }

    /// The compensator's state.
    #[must_use]
    pub fn compensator(&self) -> &S {
        &self.compensator
    }

    /// The compensator's state, to say where its delay memory is now
    /// ([`AnyCompensatorState::replace_memory`](crate::AnyCompensatorState::replace_memory)).
    pub fn compensator_mut(&mut self) -> &mut S {
        &mut self.compensator
    }

    /// The same state around that of another compensator.
    pub(super) fn with_compensator<O>(self, compensator: O) -> ControllerState<T, O, P> {
        let Self { law, compensator: _, guard, mode, u, v, pd, u_f, y, r, r_asked, offset, .. } = self;
        let Self { alarms, compensating, overrun, awake, started, .. } = self;
        ControllerState {
            law,
            compensator,
            guard,
            mode,
            u,
            v,
            pd,
            u_f,
            y,
            r,
            r_asked,
            offset,
            alarms,
            compensating,
            overrun,
            awake,
            started,
        }
    }

    /// The flags as one word, which they are in memory, too.
    #[inline(always)]
    pub(super) fn flags(&self) -> u32 {
        u32::from_le_bytes([self.compensating, self.overrun, self.awake, self.started].map(Flag::byte))
    }

    /// Words of everything but the compensator, `law` being the numbers of the law's state.
    pub(super) const fn own_words(law: usize) -> usize {
        (law + NUMBERS) * T::WORDS + FLAGS
    }

    /// Everything but the law's and the compensator's state.
    pub(super) fn save_own(&self, words: &mut impl Words) {
        let (u, r) = (&self.u, &self.r);
        words.numbers(&[u.value(), u.carry(), r.value(), r.carry()]);
        words.numbers(&[self.v, self.pd, self.u_f, self.y, self.r_asked, self.offset]);
        let g = &self.guard;
        let flags = [g.fallback, g.settle, self.compensating, self.overrun, self.awake, self.started];
        let bits = flags.iter().enumerate().fold(0, |word, (i, flag)| word | u32::from(flag.is_set()) << i);
        words.word(bits | u32::from(self.mode.get() as u8) << 8);
        words.word(u32::from(self.guard.bad));
        words.word(self.alarms.bits());
    }

    pub(super) fn restore_own(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let [u, u_carry, r, r_carry] = reader.numbers()?;
        self.u = Accumulator::from_parts(u, u_carry);
        self.r = Accumulator::from_parts(r, r_carry);
        [self.v, self.pd, self.u_f, self.y, self.r_asked, self.offset] = reader.numbers()?;
        let word = reader.word()?;
        let flag = |i: u32| Flag::new(word >> i & 1 == 1);
        self.guard.fallback = flag(0);
        self.guard.settle = flag(1);
        self.compensating = flag(2);
        self.overrun = flag(3);
        self.awake = flag(4);
        self.started = flag(5);
        self.mode = StoredMode::new(Mode::from_number(u8::try_from(word >> 8).ok()?)?);
        self.guard.bad = u16::try_from(reader.word()?).ok()?;
        self.alarms = Status::from_bits(reader.word()?);
        Some(())
    }
}
