//! What a loop may meet: set-points, modes, bad samples, limits, read-back, other parameters, at random.

use controller_core::{ControllerInput, ControllerOutput, Mode, PidConfig, Quality, Real};
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
}

impl<T: Real> Sample<T> {
    /// The record of this sample for the inputs of `block`.
    pub(crate) fn record(&self, block: &Block) -> Vec<f64> {
        let i = &self.input;
        let flag = |is: bool| f64::from(u8::from(is));
        let inputs = block.variables.iter().filter(|v| v.role == Role::Input);
        let value = |name: &str| match name {
            "SP" => i.r.to_f64(),
            "SP_CAS" => i.r_remote.to_f64(),
            "PV" => i.y.to_f64(),
            "PV_QUALITY" => f64::from(i.quality as u8),
            "MODE" => f64::from(i.mode as u8),
            "MAN" => i.manual.unwrap_or_default().to_f64(),
            "MAN_ON" => flag(i.manual.is_some()),
            "TRK" => i.track.to_f64(),
            "FF" => i.offset.to_f64(),
            "BKCAL_IN" => i.u_applied.unwrap_or_default().to_f64(),
            "BKCAL_ON" => flag(i.u_applied.is_some()),
            "COMP_ON" => flag(i.compensate),
            "INHIBIT_UP" => flag(i.inhibit_up),
            "INHIBIT_DOWN" => flag(i.inhibit_down),
            "ACK" => flag(i.acknowledge),
            "KP" => self.tuning[0].to_f64(),
            "TN" => self.tuning[1].to_f64(),
            "TV" => self.tuning[2].to_f64(),
            "TF" => self.tuning[3].to_f64(),
            other => panic!("the block has an input {other} that nobody knows"),
        };
        inputs.map(|v| value(&v.name)).collect()
    }
}

/// The outputs that the block gives for what the core gives.
pub(crate) fn outputs<T: Real>(block: &Block, out: &ControllerOutput<T>, refused: bool) -> Vec<f64> {
    let flag = |is: bool| f64::from(u8::from(is));
    let value = |name: &str| match name {
        "OP" => out.u.to_f64(),
        "OP_UNLIM" => out.v.to_f64(),
        "I_TERM" => out.i.to_f64(),
        "PD_TERM" => out.pd.to_f64(),
        "COMP_OUT" => out.u_f.to_f64(),
        "D_HAT" => out.d_hat.to_f64(),
        "SP_WORK" | "BKCAL_OUT" => out.r.to_f64(),
        "BLOCKED_UP" => flag(out.blocked_up),
        "BLOCKED_DOWN" => flag(out.blocked_down),
        "MODE_ACT" => f64::from(out.mode as u8),
        "STATUS" => f64::from(out.status.bits() | u32::from(refused) << 26),
        other => panic!("the block has an output {other} that nobody knows"),
    };
    block.variables.iter().filter(|v| v.role == Role::Output).map(|v| value(&v.name)).collect()
}

/// The loop of the core beside its plant, and what is asked of it.
pub(crate) struct Driven<T: Real> {
    law: AnyLaw<T>,
    spec: ControllerSpec,
    chance: Chance,
    plant: f64,
    before: Sample<T>,
    /// Values that the block starts with; `None` for a loop that cannot be tuned.
    taken: Option<[T; 4]>,
    with_tuning: bool,
    /// How often parameters were taken and refused.
    pub(crate) tuned: [u32; 2],
    pub(crate) modes: [u32; 7],
    pub(crate) status: u32,
}

/// Values of `KP, TN, TV, TF` that an export starts with; `None` where it has no such inputs.
fn initial<T: Real>(block: &Block) -> Option<[T; 4]> {
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
        let input = ControllerInput { r: T::from_f64(0.5), ..ControllerInput::default() };
        let before = Sample { input, tuning: taken.unwrap_or_default() };
        Self {
            law,
            spec: spec.clone(),
            chance: Chance(seed),
            plant: 0.0,
            before,
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

    /// The next sample: what the block is given, what it must give, whether it refuses parameters.
    pub(crate) fn sample(&mut self, k: u32) -> (Sample<T>, ControllerOutput<T>, bool) {
        let mut next = self.next(k);
        if self.with_tuning && self.taken.is_some() {
            self.tune(&mut next);
        }
        let refused = self.take(&next);
        let out = self.law.step(&next.input);
        self.plant += 0.01 * (self.gain() * out.u.to_f64() - self.plant);
        self.modes[out.mode as usize] += 1;
        self.status |= out.status.bits();
        self.before = next;
        (next, out, refused)
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
            i.manual =
                chance.pick(&[None, Some(0.3), Some(-0.4), Some(77.0), Some(f64::NAN)]).map(T::from_f64);
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
        }
        if chance.one_in(50) {
            i.compensate = !chance.one_in(3);
        }
        i.u_applied = None;
        if chance.one_in(6) {
            i.u_applied = Some(T::from_f64(chance.pick(&[0.3, -0.3, 1.7, 5.0, 1e9, f64::NAN])));
        }
        i.acknowledge = chance.one_in(12);
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
            (_, 1) => chance.pick(&[f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e30, -start[0]]),
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
        let [kp, tn, tv, tf] = next.tuning.map(T::to_f64);
        let integral = self.spec.config.pid.ki != 0.0;
        let [kp_0, ..] = [self.spec.config.pid.kp];
        let refused = !(kp.is_finite() && kp * kp_0 > 0.0)
            || integral && !(tn.is_finite() && tn > 0.0)
            || !(tv.is_finite() && tv >= 0.0)
            || !tf.is_finite();
        let same = next.tuning == taken || !integral && [0, 2, 3].iter().all(|&n| next.tuning[n] == taken[n]);
        if !refused && same {
            return false;
        }
        let new = PidConfig::from_standard(kp, if integral { tn } else { f64::INFINITY }, tv, tf);
        let old = self.spec.config.pid;
        let pid = PidConfig { kp: new.kp, ki: new.ki, kd: new.kd, tf: new.tf, ..old };
        let mut spec = self.spec.clone();
        spec.config.pid = pid;
        let refused = refused || self.law.adopt(&spec).is_err();
        if !refused {
            self.taken = Some(next.tuning);
        }
        self.tuned[usize::from(refused)] += 1;
        refused
    }
}
