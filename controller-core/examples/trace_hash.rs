//! One line per loop and number type: a 64-bit hash over the bits of everything the loop gave in 100 000 samples.
//!
//! Equal lines from two builds mean equal bits. The loops go through saturation, rate limits, every mode, bad and lost
//! samples, swaps of their law, saving and restoring. Inputs come from an integer generator and a small recursive
//! plant in `+ - *`; nothing here asks the platform for a mathematical function.
//!
//! ```text
//! cargo run -p controller-core --example trace_hash
//! ```

// A program for the host: the rules against panics are those of the library.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::integer_division,
    clippy::modulo_arithmetic,
    clippy::panic,
    clippy::unwrap_used
)]

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, AnyCompensator, Compensate, Compensator, CompensatorConfig,
    Controller, ControllerConfig, ControllerInput, ControllerState, EstimatorConfig, FallbackAction,
    FallbackConfig, FallbackReturn, IntegralRule, LimitConfig, Mode, NoCompensator, ObserverConfig,
    PidConfig, Quality, Real, SetpointConfig,
};

/// Samples of one trace.
const SAMPLES: u32 = 100_000;
/// Sampling period of the first law of every loop \[s\].
const TS: f64 = 0.01;
/// Delay memory \[samples\].
const CAPACITY: usize = 64;
/// Laws that one loop goes through.
const LAWS: usize = 4;

/// FNV-1a over 32-bit words, low byte first.
struct Hash(u64);

impl Hash {
    fn word(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
    }

    fn number<T: Real>(&mut self, x: T) {
        x.to_words().into_iter().take(T::WORDS).for_each(|word| self.word(word));
    }
}

/// An integer generator (Knuth's 64-bit congruence); its high bits are what is used.
struct Chance(u64);

impl Chance {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    fn below(&mut self, n: u32) -> u32 {
        self.bits() % n
    }

    fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }

    /// A multiple of 1/4096 in `-size..size`: exact in both number types.
    fn number<T: Real>(&mut self, size: i32) -> T {
        let range = 8192 * size;
        let units = (self.bits() & 0x00FF_FFFF) as i32 % range - range / 2;
        T::from_f64(f64::from(units) / 4096.0)
    }
}

/// Two lags and a gain, `x <- x + g*(input - x)`.
struct Plant<T> {
    first: T,
    second: T,
    g: [T; 2],
}

impl<T: Real> Plant<T> {
    fn step(&mut self, u: T) -> T {
        self.first = self.first + self.g[0] * (u - self.first);
        self.second = self.second + self.g[1] * (self.first - self.second);
        self.second
    }
}

/// The configuration of the law with this number: other gains, filters, limits, policies in each.
fn config(number: usize) -> ControllerConfig {
    let pids = [
        PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, c: 1.0, ..PidConfig::default() },
        PidConfig { kp: 0.8, ki: 0.7, integral_rule: IntegralRule::Trapezoid, ..PidConfig::default() },
        PidConfig { kp: -1.5, ki: -0.9, b: 0.3, action: Action::Direct, ..PidConfig::default() },
        PidConfig { kp: 1.1, ki: 0.0, kd: 0.02, tf: 0.02, ..PidConfig::default() },
    ];
    let rules = [
        AntiWindupConfig::BackCalculation { tt: None },
        AntiWindupConfig::Conditional,
        AntiWindupConfig::BackCalculation { tt: Some(0.3) },
        AntiWindupConfig::None,
    ];
    let actions = [
        FallbackAction::Hold,
        FallbackAction::Ramp { output: 0.5, rate: 2.0 },
        FallbackAction::Substitute { output: -0.25 },
        FallbackAction::Ramp { output: -1.0, rate: 0.7 },
    ];
    let size = [4.0, 10.0, 2.5, 1.0][number];
    let slow = [None, Some(50.0), Some(6.0), None][number];
    ControllerConfig {
        pid: pids[number],
        limits: LimitConfig { lo: -size, hi: 1.5 * size, rate_up: slow, rate_down: slow.map(|r| 0.7 * r) },
        setpoint: SetpointConfig {
            lo: -3.0,
            hi: 3.0,
            rate_up: [None, Some(1.7), None, Some(0.9)][number],
            rate_down: [None, None, Some(2.3), Some(0.4)][number],
            track: number & 1 == 1,
        },
        anti_windup: rules[number],
        deadband: [0.0, 0.0, 0.01, 0.003][number],
        measurement_lo: -50.0,
        measurement_hi: 50.0,
        fallback: FallbackConfig {
            hold_samples: [3, 0, 10, 25][number],
            action: actions[number],
            back: if number == 2 { FallbackReturn::Acknowledged } else { FallbackReturn::Automatic },
        },
        alarms: AlarmConfig {
            hi: Some(1.5),
            lo: Some(-1.5),
            deviation: Some(0.7),
            hysteresis: 0.1,
            ..AlarmConfig::default()
        },
        off_output: if number == 0 { Some(0.1) } else { None },
        ..ControllerConfig::default()
    }
}

/// Another sampling period for the last law.
fn period(number: usize) -> f64 {
    if number == 3 { 1.3 * TS } else { TS }
}

fn estimator(number: usize, a2: f64) -> CompensatorConfig {
    let dead_time = [0.2, 0.05, 0.333, 0.0][number];
    let kfd = [0.69, 1.0, 0.4, 0.9][number];
    EstimatorConfig { gain: 1.0, a1: 1.2, a2, dead_time, kfd, tfd: 0.06 }.to_compensator(0.0)
}

fn observer(number: usize, model: PlantModel, order: Option<usize>) -> CompensatorConfig {
    let dead_time = [0.2, 0.123, 0.0, 0.31][number];
    let alpha = [0.1, 0.3, 0.05, 0.2][number];
    let config = ObserverConfig { model: model.with_dead_time(dead_time), alpha, order };
    config.to_compensator([0.0, 0.004, 0.0, 0.01][number])
}

/// A lag and a complex pair, a zero on each side of the imaginary axis.
fn third_order() -> PlantModel {
    PlantModel::first_order(1.0, 0.9, 0.0)
        .with_pole(Factor::second(0.1, 0.04))
        .with_zero(Factor::first(0.15))
        .with_zero(Factor::first(-0.08))
}

/// An integrator, lags from slow to fast, a pair, and complex zeros.
fn fifth_order() -> PlantModel {
    PlantModel::integrating(0.5, 0.0)
        .with_pole(Factor::first(2.0))
        .with_pole(Factor::second(0.3, 0.02))
        .with_pole(Factor::first(0.011))
        .with_zero(Factor::second(0.02, 0.01))
}

/// Runs the loop of four laws and prints the hash of its trace.
fn trace<T: Real, C: Compensate<T>>(name: &str, blank: C::State, compensator: impl Fn(usize, f64) -> C) {
    let laws: [Controller<T, C>; LAWS] = core::array::from_fn(|i| {
        let ts = period(i);
        Controller::with_compensator(&config(i), compensator(i, ts), ts).expect("a valid loop")
    });
    let mut hash = Hash(0xCBF2_9CE4_8422_2325);
    let mut chance = Chance(20_210_331);
    let mut state = ControllerState::over(blank);
    let mut plant = Plant { first: T::ZERO, second: T::ZERO, g: [T::from_f64(0.01), T::from_f64(0.05)] };
    let mut input = ControllerInput::default();
    let (mut now, mut y, mut d, mut bad) = (0, T::ZERO, T::ZERO, 0);
    let mut words = [0; 512];
    for _ in 0..SAMPLES {
        if chance.once_in(400) {
            input.r = chance.number(2);
            input.r_remote = chance.number(4);
            d = chance.number(1);
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
            bad = chance.below(40);
        }
        input.acknowledge = chance.once_in(20);
        input.quality = if chance.once_in(50) { Quality::Uncertain } else { Quality::Good };
        // Noise of two units in 4096, so that the last bits live.
        input.y = y + chance.number::<T>(1) * T::from_f64(1.0 / 512.0);
        if bad > 0 {
            bad -= 1;
            input.y = T::from_f64([f64::NAN, f64::INFINITY, 51.0][chance.below(3) as usize]);
        }
        input.u_applied = if chance.once_in(30) { Some(chance.number(8)) } else { None };
        if chance.once_in(1500) {
            let next = chance.below(LAWS as u32) as usize;
            laws[next].adopt(&laws[now], &mut state);
            now = next;
        }
        if chance.once_in(1200) {
            laws[now].advance(&mut state, 1 + chance.below(30));
        }
        if chance.once_in(2500) {
            let used = laws[now].save(&state, &mut words).expect("room for all words");
            words[..used].iter().for_each(|&word| hash.word(word));
            laws[now].restore(&mut state, &words[..used]).expect("a snapshot of this state");
        }
        let out = laws[now].step(&mut state, &input);
        [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].into_iter().for_each(|x| hash.number(x));
        hash.word(out.status.bits());
        hash.word(out.mode as u32 | u32::from(out.blocked_up) << 8 | u32::from(out.blocked_down) << 9);
        y = plant.step(out.u + d);
    }
    println!("{name} f{} {:016x}", 32 * T::WORDS, hash.0);
}

/// All loops in one number type.
fn traces<T: Real>() {
    trace::<T, _>("pid", (), |_, _| NoCompensator);
    trace::<T, Compensator<T, 2, 1, CAPACITY>>("pid-de", Default::default(), |i, ts| {
        Compensator::new(&estimator(i, 0.2), ts).expect("a valid estimator")
    });
    trace::<T, Compensator<T, 1, 2, CAPACITY>>("pid-de-first-order", Default::default(), |i, ts| {
        Compensator::new(&estimator(i, 0.0), ts).expect("a valid estimator")
    });
    trace::<T, Compensator<T, 1, 0, CAPACITY>>("pi-dob-order-1", Default::default(), |i, ts| {
        let model = PlantModel::first_order(1.0, 1.2, 0.0);
        Compensator::new(&observer(i, model, None), ts).expect("a valid observer")
    });
    trace::<T, Compensator<T, 3, 0, CAPACITY>>("dob-order-3-pair-zeros", Default::default(), |i, ts| {
        Compensator::new(&observer(i, third_order(), None), ts).expect("a valid observer")
    });
    let any = |i: usize, ts: f64| {
        AnyCompensator::<T, Vec<T>>::new(&observer(i, fifth_order(), Some(7)), ts, CAPACITY)
            .expect("a valid observer")
    };
    let blank = any(0, period(0)).state(vec![T::ZERO; CAPACITY]).expect("the delay fits");
    trace::<T, AnyCompensator<T, Vec<T>>>("any-order-5-integrating", blank, any);
}

fn main() {
    traces::<f32>();
    traces::<f64>();
}
