//! Random scripts for `tests/c/replay.c`, and the outputs of the core for them.

use super::cases::{self, TS};
use controller_core::{
    AnyCompensator, AnyCompensatorState, Controller, ControllerInput, ControllerOutput, ControllerState,
    Mode, Quality, Real, Status,
};
use std::fmt::Write;

/// Cells of delay memory that `replay.c` has room for.
const CELLS: usize = 10;

type Compensated<T> = AnyCompensator<T, Vec<T>>;

/// A loop of the core, with a compensator or without.
enum Loop<T: Real> {
    Plain(Controller<T>, ControllerState<T, ()>),
    Compensated(Controller<T, Compensated<T>>, ControllerState<T, AnyCompensatorState<T, Vec<T>>>),
}

impl<T: Real> Loop<T> {
    fn new(case: usize) -> Self {
        let (config, compensator, _) = cases::case(case);
        let (config, ts) = (config.rounded::<T>(), T::from_f64(TS).to_f64());
        match compensator {
            None => {
                let law = Controller::new(&config, ts).unwrap();
                let state = law.zeroed();
                Self::Plain(law, state)
            }
            Some(compensator) => {
                let compensator = Compensated::new(&compensator.rounded::<T>(), ts, CELLS).unwrap();
                let state = ControllerState::over(compensator.state(vec![T::ZERO; CELLS]).unwrap());
                Self::Compensated(Controller::with_compensator(&config, compensator, ts).unwrap(), state)
            }
        }
    }

    fn step(&mut self, input: &ControllerInput<T>) -> ControllerOutput<T> {
        match self {
            Self::Plain(law, state) => law.step(state, input),
            Self::Compensated(law, state) => law.step(state, input),
        }
    }

    fn advance(&mut self, n: u32) {
        match self {
            Self::Plain(law, state) => law.advance(state, n),
            Self::Compensated(law, state) => law.advance(state, n),
        }
    }

    fn settle(&mut self, [r, y, u]: [T; 3]) {
        match self {
            Self::Plain(law, state) => law.settle(state, r, y, u),
            Self::Compensated(law, state) => law.settle(state, r, y, u),
        }
    }

    fn adopt(self, case: usize) -> Self {
        match (self, Self::new(case)) {
            (Self::Plain(old, mut state), Self::Plain(law, _)) => {
                law.adopt(&old, &mut state);
                Self::Plain(law, state)
            }
            (Self::Compensated(old, mut state), Self::Compensated(law, _)) => {
                law.adopt(&old, &mut state);
                Self::Compensated(law, state)
            }
            (Self::Plain(old, state), Self::Compensated(law, fresh)) => {
                let state = law.adopt_from(&old, state, fresh.compensator().clone());
                Self::Compensated(law, state)
            }
            (Self::Compensated(old, state), Self::Plain(law, _)) => {
                let state = law.adopt_from(&old, state, ());
                Self::Plain(law, state)
            }
        }
    }
}

/// An integer generator (Knuth's 64-bit congruence); its high bits are used.
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }
    fn pick<X: Copy>(&mut self, list: &[X]) -> X {
        list[self.below(list.len() as u64) as usize]
    }
    /// From -1 to 1.
    fn signed(&mut self) -> f64 {
        self.below(1 << 20) as f64 / f64::from(1 << 19) - 1.0
    }
}

/// Numbers that are no signal.
const ODD: [f64; 6] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30, -0.0];

/// A script: its commands as text, and for each of them what C must print, if it prints.
pub(crate) struct Script<T> {
    pub(crate) commands: String,
    pub(crate) outputs: Vec<Option<String>>,
    /// Status bits that some output had.
    pub(crate) seen: u32,
    /// Outputs in each mode.
    pub(crate) modes: [u32; 7],
    /// Adoptions of each case.
    pub(crate) adoptions: [u32; cases::COUNT],
    number: std::marker::PhantomData<T>,
}

/// What C sees of a step beside the numbers.
#[derive(Clone, Copy)]
struct Flags {
    mode: i32,
    quality: i32,
}

fn bits<T: Real>(x: T) -> String {
    let [low, high] = x.to_words();
    if T::WORDS == 1 { format!("{low:08x}") } else { format!("{high:08x}{low:08x}") }
}

fn mode_of(number: i32) -> Option<Mode> {
    let modes = [Mode::Off, Mode::Manual, Mode::Auto, Mode::Cascade, Mode::Track, Mode::Hold];
    usize::try_from(number - 1).ok().and_then(|at| modes.get(at)).copied()
}

impl<T: Real> Script<T> {
    fn push(&mut self, command: &str, output: Option<String>) {
        let _ = writeln!(self.commands, "{command}");
        self.outputs.push(output);
    }

    /// A loop on a plant of first order, through changes of everything.
    pub(crate) fn random(seed: u64, samples: usize) -> Self {
        let mut script = Self {
            commands: String::new(),
            outputs: Vec::new(),
            seen: 0,
            modes: [0; 7],
            adoptions: [0; cases::COUNT],
            number: std::marker::PhantomData,
        };
        let mut chance = Chance(seed);
        let mut case = chance.below(cases::COUNT as u64) as usize;
        script.push(&format!("i {case}"), None);
        let mut it = Loop::<T>::new(case);
        let (mut y, mut u, mut set, mut asked, mut bad) = (0.0, 0.0, Mode::Auto, Mode::Auto, 3 * (seed % 2));
        let mut input = ControllerInput::<T>::default();
        let mut flags = Flags { mode: 0, quality: 0 };
        for _ in 0..samples {
            if chance.one_in(60) {
                case = chance.below(cases::COUNT as u64) as usize;
                script.push(&format!("a {case}"), None);
                script.adoptions[case] += 1;
                it = it.adopt(case);
            }
            if chance.one_in(150) {
                let n = chance.pick(&[0, 1, 2, 7, 30, 2000]);
                script.push(&format!("n {n}"), None);
                it.advance(n);
            }
            if chance.one_in(100) {
                script.push("w", None);
            }
            if chance.one_in(400) {
                let rest = [0.3, y, u].map(T::from_f64);
                script.push(&format!("t {}", rest.map(bits).join(" ")), None);
                it.settle(rest);
            }
            if chance.one_in(80) {
                let number = 1 + chance.below(6) as i32;
                script.push(&format!("m {number}"), None);
                set = mode_of(number).unwrap();
            }
            script.choose(&mut chance, &mut input, &mut flags);
            bad = if chance.one_in(60) { chance.below(8) + 1 } else { u64::saturating_sub(bad, 1) };
            input.y = T::from_f64(if bad > 0 && chance.one_in(2) { chance.pick(&ODD) } else { y });
            flags.quality = if bad > 0 { chance.pick(&[2, 2, 7, -1]) } else { flags.quality };
            let wanted = if flags.mode == 0 { Some(set) } else { mode_of(flags.mode) };
            let unknown = wanted.is_none();
            asked = wanted.unwrap_or(asked);
            input.mode = asked;
            input.quality = match flags.quality {
                0 => Quality::Good,
                1 => Quality::Uncertain,
                _ => Quality::Bad,
            };
            let out = it.step(&input);
            script.record(&input, flags, &out, unknown);
            u = out.u.to_f64();
            let (_, _, gain) = cases::case(case);
            y += 0.08 * (gain * u - y) + 0.01 * chance.signed();
        }
        script
    }

    /// The inputs of the next sample but for the measurement.
    fn choose(&mut self, chance: &mut Chance, input: &mut ControllerInput<T>, flags: &mut Flags) {
        let mut number = |often: &[f64]| {
            T::from_f64(if chance.one_in(9) { chance.pick(&ODD) } else { chance.pick(often) })
        };
        let fresh = [
            number(&[0.0, 0.5, 1.0, -0.4, 2.9]),
            number(&[0.2, 0.9, -0.6]),
            number(&[0.4, -0.7, 1.2]),
            number(&[0.1, 0.6, -1.0]),
            number(&[0.0, 0.05, -0.1, 0.3]),
            number(&[0.3, -0.3, 1.5]),
        ];
        let [r, r_remote, manual, track, offset, applied] = fresh;
        if chance.one_in(40) {
            (input.r, input.r_remote, input.track) = (r, r_remote, track);
            input.manual = (!chance.one_in(3)).then_some(manual);
        }
        input.offset = if chance.one_in(50) { offset } else { input.offset };
        input.u_applied = chance.one_in(10).then_some(applied);
        if chance.one_in(30) {
            flags.mode = chance.pick(&[0, 0, 0, 0, 3, 3, 4, 1, 2, 5, 6, 99, -3, 7]);
            input.compensate = !chance.one_in(3);
            input.inhibit_up = chance.one_in(4);
            input.inhibit_down = chance.one_in(4);
        }
        flags.quality = i32::from(chance.one_in(20));
        input.acknowledge = chance.one_in(6);
    }

    fn record(&mut self, input: &ControllerInput<T>, flags: Flags, out: &ControllerOutput<T>, unknown: bool) {
        let or_any = |x: Option<T>| x.unwrap_or(T::from_f64(f64::NAN));
        let numbers = [
            input.r,
            input.r_remote,
            input.y,
            or_any(input.u_applied),
            or_any(input.manual),
            input.track,
            input.offset,
        ];
        let given = [input.u_applied.is_some(), input.manual.is_some(), !input.compensate];
        let switches = [input.inhibit_up, input.inhibit_down, input.acknowledge];
        let mut command = format!("s {} {} {}", numbers.map(bits).join(" "), flags.mode, flags.quality);
        for flag in given.iter().chain(&switches) {
            let _ = write!(command, " {}", i32::from(*flag));
        }
        let status = (out.status | Status::REJECTED.when(unknown)).bits();
        self.seen |= status;
        self.modes[out.mode as usize] += 1;
        let terms = [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].map(bits).join(" ");
        let (mode, up, down) = (out.mode as i32 + 1, i32::from(out.blocked_up), i32::from(out.blocked_down));
        self.push(&command, Some(format!("{terms} {mode} {status:x} {up} {down}")));
    }
}
