//! What a loop may meet: set-points, modes, bad samples, limits, read-back, other parameters, at random.

use controller_core::{ControllerInput, ControllerOutput, Mode, PidConfig, Quality, Real, Status};
use controller_sim_host::export::block::{Block, Role};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::AnyLaw;

/// An integer generator (Knuth's 64-bit congruence); its high bits are used.
pub(crate) struct Chance(pub(crate) u64);

impl Chance {
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
    pub(crate) fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }
    pub(crate) fn pick<X: Copy>(&mut self, list: &[X]) -> X {
        list[usize::try_from(self.below(list.len() as u64)).expect("an index")]
    }
    /// Between -1 and 1.
    pub(crate) fn noise(&mut self) -> f64 {
        self.below(2_000_001) as f64 / 1e6 - 1.0
    }
}

/// What the block is given in a sample, beyond what the core's step takes.
#[derive(Clone, Copy)]
pub(crate) struct Sample<T> {
    pub(crate) input: ControllerInput<T>,
    /// `KP, TN, TV, TF`.
    pub(crate) tuning: [T; 4],
    /// Wishes for modes that come behind the one that counts: their bits.
    pub(crate) more: u8,
    /// The number for a bad quality.
    pub(crate) bad: f64,
}

/// The first of the block's flags that asks for each mode; a mode without one is asked for by none of them.
pub(crate) fn asks(mode: Mode) -> Option<&'static str> {
    match mode {
        Mode::Off => Some("OFF"),
        Mode::Track => Some("TRK"),
        Mode::Manual => Some("MAN"),
        Mode::Cascade => Some("CAS"),
        Mode::Auto => Some("AUTO"),
        Mode::Hold => Some("HOLD"),
        Mode::Fallback => None,
    }
}

/// In the order of their priority.
const WISHES: [&str; 6] = ["OFF", "TRK", "MAN", "HOLD", "CAS", "AUTO"];

impl<T: Real> Sample<T> {
    /// The record of this sample for the inputs of `block`.
    pub(crate) fn record(&self, block: &Block) -> Vec<f64> {
        let i = &self.input;
        let flag = |is: bool| f64::from(u8::from(is));
        let inputs = block.variables.iter().filter(|v| v.role == Role::Input);
        let first = asks(i.mode).and_then(|name| WISHES.iter().position(|wish| *wish == name));
        let value = |name: &str| match name {
            "SP" => i.r.to_f64(),
            "SP_REMOTE" => i.r_remote.to_f64(),
            "PV" => i.y.to_f64(),
            "PV_QUALITY" => match i.quality {
                Quality::Good => 2.0,
                Quality::Uncertain => 1.0,
                Quality::Bad => self.bad,
            },
            "OP_MAN" => i.manual.unwrap_or_default().to_f64(),
            "TRK_VALUE" => i.track.to_f64(),
            "FF" => i.offset.to_f64(),
            "OP_READBACK" => i.u_applied.unwrap_or_default().to_f64(),
            "RB_USE" => flag(i.u_applied.is_some()),
            "COMPENSATE" => flag(i.compensate),
            "INHIBIT_UP" => flag(i.inhibit_up),
            "INHIBIT_DN" => flag(i.inhibit_down),
            "ACK" => flag(i.acknowledge),
            "KP" => self.tuning[0].to_f64(),
            "TN" => self.tuning[1].to_f64(),
            "TV" => self.tuning[2].to_f64(),
            "TF" => self.tuning[3].to_f64(),
            // Those that come behind the first one do not count.
            wish => match (WISHES.iter().position(|other| *other == wish), first) {
                (None, _) => panic!("the block has an input {wish} that nobody knows"),
                (Some(at), Some(first)) if at >= first => flag(at == first || self.more & (1 << at) != 0),
                _ => 0.0,
            },
        };
        inputs.map(|v| value(&v.name)).collect()
    }
}

/// The outputs that the block gives for what the core gives.
pub(crate) fn outputs<T: Real>(block: &Block, out: &ControllerOutput<T>, more: &More<T>) -> Vec<f64> {
    let flag = |is: bool| f64::from(u8::from(is));
    let alarm = |bit: Status| flag(out.status.has(bit));
    let value = |name: &str| match name {
        "OP" => out.u.to_f64(),
        "OP_UNLIM" => out.v.to_f64(),
        "I_TERM" => out.i.to_f64(),
        "PD_TERM" => out.pd.to_f64(),
        "UF" => out.u_f.to_f64(),
        "D_HAT" => out.d_hat.to_f64(),
        "SP_WORKING" | "BKCAL_OUT" => out.r.to_f64(),
        "PV_ENG" => more.pv_eng.to_f64(),
        "DEV" => (out.r - more.pv_eng).to_f64(),
        "BLOCKED_UP" => flag(out.blocked_up),
        "BLOCKED_DN" => flag(out.blocked_down),
        "IN_AUTO" => flag(matches!(out.mode, Mode::Auto | Mode::Cascade)),
        "IN_CAS" => flag(out.mode == Mode::Cascade),
        "HH_ALM" => alarm(Status::ALARM_HI_HI),
        "H_ALM" => alarm(Status::ALARM_HI),
        "L_ALM" => alarm(Status::ALARM_LO),
        "LL_ALM" => alarm(Status::ALARM_LO_LO),
        "DEV_ALM" => alarm(Status::ALARM_DEVIATION),
        "MODE" => match out.mode {
            Mode::Off => 1.0,
            Mode::Manual => 2.0,
            Mode::Auto => 3.0,
            Mode::Cascade => 4.0,
            Mode::Track => 5.0,
            Mode::Hold => 6.0,
            Mode::Fallback => 7.0,
        },
        "STATUS" => f64::from(out.status.bits() | u32::from(more.refused) << 26 | u32::from(more.lost) << 27),
        other => panic!("the block has an output {other} that nobody knows"),
    };
    block.variables.iter().filter(|v| v.role == Role::Output).map(|v| value(&v.name)).collect()
}

/// What the block shows beyond what the core gives.
#[derive(Clone, Copy, Default)]
pub(crate) struct More<T> {
    /// Parameters are refused.
    pub(crate) refused: bool,
    /// The memory was of another design.
    pub(crate) lost: bool,
    /// The last finite measurement.
    pub(crate) pv_eng: T,
}

/// The loop of the core beside its plant, and what is asked of it.
pub(crate) struct Driven<T: Real> {
    law: AnyLaw<T>,
    spec: ControllerSpec,
    chance: Chance,
    plant: f64,
    before: Sample<T>,
    pv_eng: T,
    /// Values that the block starts with; `None` for a loop that cannot be tuned.
    taken: Option<[T; 4]>,
    with_tuning: bool,
    /// How often parameters were taken and refused.
    pub(crate) tuned: [u32; 2],
    pub(crate) modes: [u32; 7],
    pub(crate) status: u32,
}

/// Values of `KP, TN, TV, TF` that an export starts with; `None` where it has no such inputs.
pub(crate) fn initial<T: Real>(block: &Block) -> Option<[T; 4]> {
    use controller_sim_host::export::block::Initial;
    block.variable("KP")?;
    Some(["KP", "TN", "TV", "TF"].map(|name| match block.variable(name).map(|v| &v.initial) {
        Some(Initial::Number(value)) => T::from_f64(*value),
        _ => T::ZERO,
    }))
}

impl<T: Real> Driven<T> {
    pub(crate) fn new(
        scenario: &Scenario,
        spec: &ControllerSpec,
        block: &Block,
        capacity: usize,
        seed: u64,
        with_tuning: bool,
    ) -> Self {
        let law = AnyLaw::new(spec, scenario.ts, scenario.latency, capacity).expect("a valid law");
        let taken = initial(block);
        let input =
            ControllerInput { r: T::from_f64(0.5), manual: Some(T::ZERO), ..ControllerInput::default() };
        let before = Sample { input, tuning: taken.unwrap_or_default(), more: 0, bad: 0.0 };
        Self {
            law,
            spec: spec.clone(),
            chance: Chance(seed),
            plant: 0.0,
            before,
            pv_eng: T::ZERO,
            taken,
            with_tuning,
            tuned: [0; 2],
            modes: [0; 7],
            status: 0,
        }
    }

    /// Before the first sample: a plant that is somewhere, inputs that are something. What settles itself has to do it there.
    pub(crate) fn scatter(&mut self) {
        self.plant = 1.5 * self.chance.noise();
        for _ in 0..100 {
            self.before = self.next(1000);
        }
    }

    /// The next sample: what the block is given, what the core gives, what the block shows beyond it.
    pub(crate) fn sample(&mut self, k: u32) -> (Sample<T>, ControllerOutput<T>, More<T>) {
        self.sample_tuned(k, None)
    }

    /// The same with these values of `KP, TN, TV, TF` from here on.
    pub(crate) fn sample_tuned(
        &mut self,
        k: u32,
        tuning: Option<[T; 4]>,
    ) -> (Sample<T>, ControllerOutput<T>, More<T>) {
        let mut next = self.next(k);
        next.tuning = tuning.unwrap_or(next.tuning);
        if self.with_tuning && self.taken.is_some() {
            self.tune(&mut next);
        }
        let refused = self.take(&next);
        let out = self.law.step(&next.input);
        self.plant += 0.01 * (self.gain() * out.u.to_f64() - self.plant);
        self.modes[out.mode as usize] += 1;
        self.status |= out.status.bits();
        self.before = next;
        if next.input.y.is_finite_number() {
            self.pv_eng = next.input.y;
        }
        (next, out, More { refused, lost: false, pv_eng: self.pv_eng })
    }

    /// A plant that the loop can hold: its sign.
    fn gain(&self) -> f64 {
        let [kp, ki, _] = self.spec.config.pid.signed_gains();
        if kp < 0.0 || ki < 0.0 { -1.0 } else { 1.0 }
    }

    fn next(&mut self, k: u32) -> Sample<T> {
        const ODD: [f64; 8] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30, -0.0, 5e-324, 4.0];
        let chance = &mut self.chance;
        let mut next = self.before;
        let i = &mut next.input;
        i.y = T::from_f64(self.plant + 1e-3 * chance.noise());
        if chance.one_in(40) {
            i.y = T::from_f64(chance.pick(&ODD));
        }
        i.quality = match chance.below(60) {
            0 => Quality::Bad,
            1 => Quality::Uncertain,
            _ => Quality::Good,
        };
        // Bad for long, so that the fallback comes; also from the very beginning.
        if k < 5 || (k / 97) % 11 == 7 {
            match k % 3 {
                1 => i.y = T::from_f64(f64::NAN),
                _ => i.quality = Quality::Bad,
            }
        }
        if chance.one_in(25) {
            i.r = T::from_f64(chance.pick(&[
                0.0,
                -0.0,
                0.5,
                1.0,
                2.0,
                -1.5,
                3.0,
                1e30,
                f64::NAN,
                f64::INFINITY,
            ]));
            i.r_remote = T::from_f64(chance.pick(&[0.25, 1.0, -0.5, 7.0, f64::NAN]));
            i.offset = T::from_f64(chance.pick(&[0.0, 0.1, -0.1, -0.0, 9.0, 2e6, f64::NAN]));
            i.inhibit_up = chance.one_in(3);
            i.inhibit_down = chance.one_in(3);
            i.manual = Some(T::from_f64(chance.pick(&[0.0, 0.3, -0.4, 77.0, f64::NAN])));
            i.track = T::from_f64(chance.pick(&[0.0, 0.7, -99.0, f64::INFINITY]));
        }
        if chance.one_in(35) {
            i.mode = chance.pick(&[
                Mode::Auto,
                Mode::Auto,
                Mode::Auto,
                Mode::Cascade,
                Mode::Cascade,
                Mode::Manual,
                Mode::Off,
                Mode::Track,
                Mode::Hold,
                Mode::Fallback,
            ]);
            next.more = u8::try_from(chance.below(64)).expect("six bits");
        }
        if chance.one_in(50) {
            i.compensate = !chance.one_in(3);
        }
        i.u_applied = None;
        if chance.one_in(6) {
            i.u_applied = Some(T::from_f64(chance.pick(&[0.3, -0.3, 1.7, 5.0, 1e9, f64::NAN])));
        }
        i.acknowledge = chance.one_in(12);
        next.bad = chance.pick(&[0.0, 3.0, -1.0, 255.0, 2_147_483_647.0, -2_147_483_648.0]);
        next
    }

    /// Sometimes other parameters, sometimes such that cannot be used.
    fn tune(&mut self, next: &mut Sample<T>) {
        let Some(taken) = self.taken else { return };
        let chance = &mut self.chance;
        if !chance.one_in(60) {
            return;
        }
        let start = [self.spec.config.pid.kp, 1.0, 0.1, self.spec.config.pid.tf];
        next.tuning = taken;
        let at = usize::try_from(chance.below(4)).expect("an index");
        let ts = T::from_f64(super::loops::TS).to_f64();
        let value = match (at, chance.below(8)) {
            (_, 0) => f64::NAN,
            (0, 1) => chance.pick(&[0.0, -0.0, 1e-45, -start[0], f64::INFINITY, 1e30, -1e30]),
            (1, 1 | 2) => 0.0,
            (_, 1) => chance.pick(&[f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e30, -0.0]),
            (0, _) => start[0] * (1.0 + 0.3 * chance.noise()),
            (1, _) => 1.5 * (1.1 + chance.noise()),
            (2, _) => 0.2 * (1.0 + chance.noise()),
            _ => chance.pick(&[0.0, 0.49 * ts, 0.5 * ts, 0.05, 0.1, 0.2347]),
        };
        next.tuning[at] = T::from_f64(value);
    }

    /// Adopts the parameters of a sample as the block is to; whether they are refused.
    fn take(&mut self, next: &Sample<T>) -> bool {
        let Some(taken) = self.taken else { return false };
        let mut tuning = next.tuning;
        tuning[0] = tuning[0].magnitude();
        let [kp, tn, tv, tf] = tuning.map(T::to_f64);
        let usable = |x: f64| x.is_finite() && x >= 0.0;
        let refused = !(usable(kp) && usable(tn) && usable(tv) && tf.is_finite());
        if !refused && tuning == taken {
            return false;
        }
        let old = self.spec.config.pid;
        let direction = if old.kp < 0.0 { -1.0 } else { 1.0 };
        let new = PidConfig::from_standard(direction * kp, if tn > 0.0 { tn } else { f64::INFINITY }, tv, tf);
        let pid = PidConfig { kp: new.kp, ki: new.ki, kd: new.kd, tf: new.tf, ..old };
        let mut spec = self.spec.clone();
        spec.config.pid = pid;
        let refused = refused || self.law.adopt(&spec).is_err();
        if !refused {
            self.taken = Some(tuning);
        }
        self.tuned[usize::from(refused)] += 1;
        refused
    }
}
