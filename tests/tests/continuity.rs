//! Continuity: a loop depends on its law, its state and its inputs, and on nothing else.
//!
//! A loop that is saved to words and restored into a fresh state at random times goes on bit for bit as the one that was
//! left alone; two loops that take turns are the two that run alone; a compensator of a shape known at compile time
//! gives the bits of one whose shape is a number; a law that another thread publishes arrives whole.
//!
//! The same cases on every run; with `SOAK=1` in the environment a hundred times as many, different on every run.

#[path = "totality/built.rs"]
mod built;
#[path = "totality/configs.rs"]
mod configs;
#[path = "totality/draw.rs"]
mod draw;
#[path = "totality/runner.rs"]
mod runner;

use built::{AnyBlock, Block, Built, Checked, accepted, saved};
use configs::{CAPACITY, CONFIG_BYTES, Case};
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Compensator, CompensatorConfig, Controller, ControllerOutput, ControllerState, Estimator,
    EstimatorConfig, NoCompensator, ParamCell, Real,
};
use draw::Draw;
use proptest::collection::vec;
use proptest::prelude::*;
use runner::{config_bytes, for_all, operations, swappable};

/// The bits of an output, all of it.
fn bits<T: Real>(out: &ControllerOutput<T>) -> Vec<u32> {
    let numbers = [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r];
    let flags = u32::from(out.blocked_up) | u32::from(out.blocked_down) << 1 | (out.mode as u32) << 2;
    numbers.iter().flat_map(|x| x.to_words()).chain([flags, out.status.bits()]).collect()
}

/// A loop that does what it is told, without any check.
struct Plain<'a, T: Real, C: Block<T>> {
    laws: &'a [Built<T, C>],
    now: usize,
    state: ControllerState<T, C::State>,
}

impl<'a, T: Real, C: Block<T>> Plain<'a, T, C> {
    fn new(laws: &'a [Built<T, C>]) -> Self {
        Self { laws, now: 0, state: ControllerState::over(laws[0].law.compensator().blank()) }
    }

    /// One operation: mostly a sample, whose output it returns. The inputs are those for the first law.
    fn operate(&mut self, bytes: &[u8]) -> Vec<u32> {
        let mut draw = Draw::new(bytes);
        let law = &self.laws[self.now].law;
        match draw.index(16) {
            13 => law.advance(&mut self.state, draw.pick(&[1, 2, 30, u32::MAX])),
            14 => {
                let [r, y, u] = [0; 3].map(|_| draw.signal(-T::ONE, T::ONE));
                law.settle(&mut self.state, r, y, u);
            }
            15 => {
                let to = draw.index(self.laws.len());
                self.laws[to].law.adopt(law, &mut self.state);
                self.now = to;
            }
            _ => {
                let input = self.laws[0].input(&mut draw);
                return bits(&law.step(&mut self.state, &input));
            }
        }
        Vec::new()
    }

    /// To words and back into a state that knows nothing.
    fn reincarnate(&mut self) -> Checked {
        let law = &self.laws[self.now].law;
        let words = saved(law, &self.state);
        self.state = ControllerState::over(law.compensator().blank());
        law.restore(&mut self.state, &words)
            .map_err(|error| format!("{error}\n{:?}", self.laws[self.now].case))
    }

    fn words(&self) -> Vec<u32> {
        saved(&self.laws[self.now].law, &self.state)
    }
}

fn same(what: &str, k: usize, found: &[u32], expected: &[u32]) -> Checked {
    match found == expected {
        true => Ok(()),
        false => Err(format!("{what}, operation {k}: {found:x?} instead of {expected:x?}")),
    }
}

fn survives_restoring<T: Real, C: Block<T>>(
    cases: &[Case],
    operations: &[Vec<u8>],
    when: &[bool],
) -> Checked {
    let laws = accepted::<T, C>(cases);
    if laws.is_empty() {
        return Ok(());
    }
    let (mut left_alone, mut restored) = (Plain::new(&laws), Plain::new(&laws));
    for (k, bytes) in operations.iter().enumerate() {
        if when.get(k % when.len().max(1)).copied().unwrap_or(true) {
            restored.reincarnate()?;
        }
        same("restored", k, &restored.operate(bytes), &left_alone.operate(bytes))?;
    }
    same("restored", operations.len(), &restored.words(), &left_alone.words())
}

fn restores<T: Real, C: Block<T>>(number: u32) {
    let strategy = (vec(config_bytes(), 1..=3), operations(), vec(any::<bool>(), 1..20));
    for_all(number, &strategy, |(bytes, operations, when)| {
        survives_restoring::<T, C>(&swappable(&bytes), &operations, &when)
    });
}

#[test]
fn a_restored_loop_goes_on_bit_for_bit() {
    restores::<f32, NoCompensator>(1000);
    restores::<f64, NoCompensator>(1000);
    restores::<f32, AnyBlock<f32>>(1000);
    restores::<f64, AnyBlock<f64>>(1000);
}

fn take_turns<T: Real, C: Block<T>>(number: u32) {
    let strategy = (vec(config_bytes(), 1..=3), operations(), operations());
    for_all(number, &strategy, |(bytes, first, second)| {
        let laws = accepted::<T, C>(&swappable(&bytes));
        if laws.is_empty() {
            return Ok(());
        }
        let alone = |operations: &[Vec<u8>]| {
            let mut plain = Plain::new(&laws);
            let outputs: Vec<_> = operations.iter().map(|bytes| plain.operate(bytes)).collect();
            (outputs, plain.words())
        };
        let expected = [alone(&first), alone(&second)];
        let (mut a, mut b) = (Plain::new(&laws), Plain::new(&laws));
        for k in 0..first.len().max(second.len()) {
            if let Some(bytes) = first.get(k) {
                same("first", k, &a.operate(bytes), &expected[0].0[k])?;
            }
            if let Some(bytes) = second.get(k) {
                same("second", k, &b.operate(bytes), &expected[1].0[k])?;
            }
        }
        same("first", first.len(), &a.words(), &expected[0].1)?;
        same("second", second.len(), &b.words(), &expected[1].1)
    });
}

#[test]
fn loops_that_take_turns_do_not_see_each_other() {
    take_turns::<f32, NoCompensator>(500);
    take_turns::<f64, NoCompensator>(500);
    take_turns::<f32, AnyBlock<f32>>(500);
    take_turns::<f64, AnyBlock<f64>>(500);
}

/// The same operations under both kinds of compensator; the number of loops compared.
fn same_bits_as_any<T: Real, C: Block<T>>(cases: &[Case], operations: &[Vec<u8>]) -> Result<usize, String> {
    let (fixed, any) = (accepted::<T, C>(cases), accepted::<T, AnyBlock<T>>(cases));
    if fixed.len() != any.len() {
        return Err(format!("{} laws of a fixed shape, {} of any: {cases:?}", fixed.len(), any.len()));
    }
    if fixed.is_empty() {
        return Ok(0);
    }
    let (mut a, mut b) = (Plain::new(&fixed), Plain::new(&any));
    for (k, bytes) in operations.iter().enumerate() {
        same("fixed shape", k, &a.operate(bytes), &b.operate(bytes))?;
    }
    same("fixed shape", operations.len(), &a.words(), &b.words())?;
    Ok(fixed.len())
}

/// Loops with a model of order `order` and `excess` excess filter poles, integrators, pairs and zeros included.
fn of_shape(bytes: &[Vec<u8>], order: usize, excess: usize) -> Vec<Case> {
    let mut cases = swappable(bytes);
    for (case, bytes) in cases.iter_mut().zip(bytes) {
        let mut draw = Draw::new(&bytes[CONFIG_BYTES - 48..]);
        let ts = case.ts;
        let mut model = PlantModel {
            gain: draw.decades(-2.0, 2.0).copysign(case.block.model.gain),
            integrators: draw.pick(&[0, 0, 1, 2]).min(order),
            dead_time: ts * draw.between(0.0, 0.9 * CAPACITY as f64),
            ..PlantModel::default()
        };
        while model.order() < order {
            let tau = ts * draw.decades(0.0, 2.5);
            let pole = match draw.index(3) {
                0 if order - model.order() > 1 => Factor::second(draw.between(0.1, 3.0) * tau, tau * tau),
                _ => Factor::first(tau),
            };
            model = model.with_pole(pole);
        }
        // A slow zero in the left half plane replaces a filter pole, one in the right half plane does not.
        let mut moved = 0;
        if order > 1 && draw.flag() {
            let right = draw.flag();
            let tau = ts * draw.decades(0.1, 2.0);
            model = model.with_zero(Factor::first(if right { -tau } else { tau }));
            moved = usize::from(!right);
        }
        case.block = CompensatorConfig {
            gain: draw.share(),
            time_constant: ts * draw.decades(0.0, 2.0),
            order: Some(order - moved + excess),
            model,
            latency: 0.0,
            ..CompensatorConfig::default()
        };
    }
    cases
}

fn shape<T: Real, const N: usize, const E: usize>(number: u32) {
    let compared = std::cell::Cell::new(0);
    let strategy = (vec(config_bytes(), 1..=3), operations());
    for_all(number, &strategy, |(bytes, operations)| {
        let cases = of_shape(&bytes, N, E);
        let count = same_bits_as_any::<T, Compensator<T, N, E, CAPACITY>>(&cases, &operations)?;
        compared.set(compared.get() + count);
        Ok(())
    });
    assert!(compared.get() >= number as usize, "order {N}, excess {E}: only {} loops", compared.get());
}

macro_rules! shapes {
    ($($n:literal)+) => {$(
        shape::<f32, $n, 0>(60);
        shape::<f64, $n, 0>(60);
        shape::<f32, $n, 1>(60);
        shape::<f64, $n, 1>(60);
        shape::<f32, $n, 2>(60);
        shape::<f64, $n, 2>(60);
    )+};
}

#[test]
fn a_shape_known_at_compile_time_changes_no_bit() {
    shapes!(1 2 3 4 5 6 7 8);
}

/// The loop that is handed over; every number of it depends on `version`.
fn handed(version: u32) -> Controller<f32, Estimator<f32, CAPACITY>> {
    let v = f64::from(version + 1);
    let mut config = Case::draw(&[], Some(0.01)).config;
    config.pid.kp = v;
    config.pid.ki = 0.5 * v;
    config.limits.hi = 1e3 * v;
    config.limits.lo = -1e3 * v;
    config.deadband = 1e-3 * v;
    let model = EstimatorConfig { gain: v, a1: 1.0 + 0.01 * v, a2: 0.2, dead_time: 0.1, kfd: 0.7, tfd: 0.06 };
    let estimator = Estimator::estimator(&model, 0.0, 0.01).expect("a valid estimator");
    Controller::with_compensator(&config, estimator, 0.01).expect("a valid loop")
}

/// A writer publishes laws as fast as it can; what the reader gets is one of them, whole, and never an older one.
#[test]
fn a_law_from_another_thread_arrives_whole() {
    const VERSIONS: u32 = 64;
    static CELL: ParamCell<Controller<f32, Estimator<f32, CAPACITY>>> = ParamCell::new();
    let laws: Vec<_> = (0..VERSIONS).map(handed).collect();
    let rounds = if std::env::var_os("SOAK").is_some() { 20_000 } else { 500 };
    let total = rounds * VERSIONS;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for k in 0..total {
                assert_eq!(CELL.publish(laws[(k % VERSIONS) as usize]), k + 1);
            }
        });
        let (mut seen, mut news) = (0, 0);
        while seen < total {
            let before = seen;
            match CELL.take_newer(&mut seen) {
                Some(law) => {
                    assert!(seen > before, "generation {seen} after {before}");
                    let version = (seen - 1) % VERSIONS;
                    assert!(law == laws[version as usize], "generation {seen} is not version {version}");
                    news += 1;
                }
                None => assert_eq!(seen, before),
            }
        }
        println!("{news} of {total} publications seen");
        assert!(CELL.take_newer(&mut seen).is_none());
    });
}
