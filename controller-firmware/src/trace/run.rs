//! One loop from its first sample to its last.

use super::chance::Chance;
use super::hash::Hash;
use super::laws::LAWS;
use controller_core::{
    Compensate, Controller, ControllerInput, ControllerOutput, ControllerState, Mode, Quality, Real,
    Regulator, Status,
};

/// Two lags and a gain, `x <- x + g*(input - x)`.
struct Plant<T> {
    first: T,
    second: T,
    g: [T; 2],
}

impl<T: Real> Plant<T> {
    fn new() -> Self {
        Self { first: T::ZERO, second: T::ZERO, g: [T::from_f64(0.01), T::from_f64(0.05)] }
    }

    fn step(&mut self, u: T) -> T {
        self.first = self.first + self.g[0] * (u - self.first);
        self.second = self.second + self.g[1] * (self.first - self.second);
        self.second
    }
}

/// What the loop meets: its inputs and the load on the plant.
struct Surroundings<T> {
    chance: Chance,
    input: ControllerInput<T>,
    load: T,
    /// Bad samples that are still to come.
    bad: u32,
}

impl<T: Real> Surroundings<T> {
    fn new() -> Self {
        Self { chance: Chance::new(), input: ControllerInput::default(), load: T::ZERO, bad: 0 }
    }

    /// The inputs of the next sample, `y` being what the plant gives.
    fn next(&mut self, y: T) -> &ControllerInput<T> {
        let Self { chance, input, load, bad } = self;
        if chance.once_in(400) {
            input.r = chance.number(2);
            input.r_remote = chance.number(4);
            *load = chance.number(1);
        }
        if chance.once_in(300) {
            let requests =
                [Mode::Auto, Mode::Cascade, Mode::Auto, Mode::Manual, Mode::Track, Mode::Hold, Mode::Off];
            input.mode = requests[chance.below(7) as usize];
            input.manual = if chance.once_in(3) { None } else { Some(chance.number(8)) };
            input.track = chance.number(8);
            input.offset = chance.number(1);
            input.compensate = !chance.once_in(4);
            input.inhibit_up = chance.once_in(6);
            input.inhibit_down = chance.once_in(6);
        }
        if chance.once_in(250) {
            *bad = chance.below(40);
        }
        input.acknowledge = chance.once_in(20);
        input.quality = if chance.once_in(50) { Quality::Uncertain } else { Quality::Good };
        // Noise of two units in 4096, so that the last bits live.
        input.y = y + chance.number::<T>(1) * T::from_f64(1.0 / 512.0);
        if *bad > 0 {
            *bad -= 1;
            input.y = T::from_f64([f64::NAN, f64::INFINITY, 51.0][chance.below(3) as usize]);
        }
        input.u_applied = if chance.once_in(30) { Some(chance.number(8)) } else { None };
        input
    }
}

/// What a loop went through: a hash over samples that meet nothing would say nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Met {
    /// Every status bit that a sample had.
    pub status: u32,
    /// The modes in force, bit `n` for the mode numbered `n`.
    pub modes: u32,
    /// Laws taken over from another one.
    pub swaps: u32,
    /// Times that samples were lost.
    pub losses: u32,
    /// States saved and restored.
    pub restored: u32,
}

impl Met {
    /// Whether everything came that comes to each of the loops: every mode, limits and rates, a set-point limited and on its
    /// way, samples bad, held, uncertain, the fallback and the wait for its end, lost samples, three alarms, swaps, snapshots.
    #[must_use]
    pub fn everything(&self) -> bool {
        let bits = [
            Status::LIMITED_HIGH,
            Status::LIMITED_LOW,
            Status::RATE_LIMITED,
            Status::SETPOINT_LIMITED,
            Status::SETPOINT_RAMPING,
            Status::BAD_INPUT,
            Status::UNCERTAIN,
            Status::HELD,
            Status::FALLBACK,
            Status::AWAITING_ACKNOWLEDGEMENT,
            Status::OVERRUN,
            Status::ALARM_HI,
            Status::ALARM_LO,
            Status::ALARM_DEVIATION,
        ];
        let modes = Mode::REQUESTS.into_iter().chain([Mode::Fallback]);
        bits.into_iter().all(|bit| Status::from_bits(self.status).has(bit))
            && modes.into_iter().all(|mode| self.modes & 1 << (mode as u32) != 0)
            && [self.swaps, self.losses, self.restored].iter().all(|&count| count > 0)
    }
}

/// A loop's trace as one number, and what was in it.
pub(super) struct Traced {
    pub(super) hash: u64,
    pub(super) met: Met,
}

/// Runs one loop through [`LAWS`] laws.
///
/// # Panics
/// When a law cannot be built or a snapshot not be read back.
pub(super) fn trace<T: Real, C: Compensate<T>, L: Regulator<T>>(
    samples: u32,
    blank: C::State,
    law: impl Fn(usize) -> Option<Controller<T, C, L>>,
) -> Traced {
    // One after the other into their places: there is stack for one besides them.
    let mut laws = [const { None }; LAWS];
    for (i, place) in laws.iter_mut().enumerate() {
        *place = law(i);
    }
    let law = |i: usize| laws[i].as_ref().expect("a valid loop");
    let mut state = ControllerState::over(blank);
    let mut around = Surroundings::new();
    let mut plant = Plant::new();
    let mut hash = Hash::default();
    let mut met = Met::default();
    let mut now = 0;
    let mut y = T::ZERO;
    for _ in 0..samples {
        around.next(y);
        let chance = &mut around.chance;
        if chance.once_in(1500) {
            let next = chance.below(LAWS as u32) as usize;
            law(next).adopt(law(now), &mut state);
            met.swaps += u32::from(next != now);
            now = next;
        }
        if chance.once_in(1200) {
            law(now).advance(&mut state, 1 + chance.below(30));
            met.losses += 1;
        }
        if chance.once_in(2500) {
            save_and_restore(law(now), &mut state, &mut hash);
            met.restored += 1;
        }
        let out = law(now).step(&mut state, &around.input);
        add(&mut hash, &out);
        met.status |= out.status.bits();
        met.modes |= 1 << (out.mode as u32);
        y = plant.step(out.u + around.load);
    }
    Traced { hash: hash.value(), met }
}

/// Everything that a sample gave.
fn add<T: Real>(hash: &mut Hash, out: &ControllerOutput<T>) {
    [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].into_iter().for_each(|x| hash.number(x));
    hash.word(out.status.bits());
    hash.word(out.mode as u32 | u32::from(out.blocked_up) << 8 | u32::from(out.blocked_down) << 9);
}

/// A memory of its own only while it lasts: stack is scarce on a small target.
#[inline(never)]
fn save_and_restore<T: Real, C: Compensate<T>, L: Regulator<T>>(
    law: &Controller<T, C, L>,
    state: &mut ControllerState<T, C::State, L::State>,
    hash: &mut Hash,
) {
    let mut words = [0; 256];
    let used = law.save(state, &mut words).expect("room for all words");
    words[..used].iter().for_each(|&word| hash.word(word));
    law.restore(state, &words[..used]).expect("a snapshot of this state");
}
