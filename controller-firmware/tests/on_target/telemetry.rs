//! Records between the timer's interrupt and the main context.

use controller_core::{
    Controller, ControllerConfig, ControllerInput, Instance, Law, LimitConfig, ParamCell, PidConfig, Trace,
    TraceSample,
};
use controller_firmware::BOARD;
use controller_pil::board;
use core::sync::atomic::{AtomicU8, Ordering};
use cortex_m::peripheral::{SYST, syst::SystClkSource};
use cortex_m_rt::exception;

pub(crate) const TESTS: &[(&str, fn())] = &[
    ("a control task in an interrupt is traced sample by sample", traced),
    ("a full queue drops and counts, and goes on", dropped),
    ("a record is never torn", whole),
];

type Loop = Controller<f32>;
type Running = Instance<Loop, <Loop as Law>::State>;

static LAW: ParamCell<Loop> = ParamCell::new();
static SAMPLES: Trace<TraceSample<f32>, 8> = Trace::new();
static WORDS: Trace<[u32; 9], 3> = Trace::new();

/// What the interrupt does.
static TASK: AtomicU8 = AtomicU8::new(NOTHING);
const NOTHING: u8 = 0;
const CONTROL: u8 = 1;
const COUNT: u8 = 2;

#[exception]
fn SysTick() {
    static mut SEEN: u32 = 0;
    static mut K: u32 = 0;
    static mut RUNNING: Option<Running> = None;
    match TASK.load(Ordering::Relaxed) {
        CONTROL => {
            if let Some(law) = LAW.take_newer(SEEN) {
                *RUNNING = Some(Instance::new(law, law.zeroed()));
                *K = 0;
            }
            if let Some(running) = RUNNING {
                let input = input(*K);
                let output = running.step(&input);
                SAMPLES.push(TraceSample::new(*K, &input, &output));
                *K += 1;
            }
        }
        COUNT => {
            *K = K.wrapping_add(1);
            WORDS.push([*K; 9]);
        }
        _ => {}
    }
}

fn law() -> Loop {
    let config = ControllerConfig {
        pid: PidConfig { kp: 2.0, ki: 3.0, kd: 0.1, tf: 0.05, ..PidConfig::default() },
        limits: LimitConfig { rate_up: Some(2.0), ..LimitConfig::range(-1.5, 1.5) },
        ..ControllerConfig::default()
    };
    Loop::new(&config, 0.01).unwrap()
}

/// A step of the set-point, and a wave that comes from integers.
fn input(k: u32) -> ControllerInput<f32> {
    let phase = k % 64;
    let wave = if phase < 32 { phase } else { 64 - phase };
    let y = 0.03125 * f32::from(u8::try_from(wave).unwrap_or(0));
    ControllerInput { r: if k % 200 < 100 { 0.25 } else { 0.75 }, y, ..ControllerInput::default() }
}

/// Starts the timer with a period in clocks of the board.
fn start(task: u8, clocks: u32) -> SYST {
    // SAFETY: the tests run one after the other and none keeps the timer.
    let mut timer = unsafe { cortex_m::Peripherals::steal() }.SYST;
    TASK.store(task, Ordering::Relaxed);
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(clocks - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
    timer
}

fn stop(mut timer: SYST) {
    timer.disable_interrupt();
    timer.disable_counter();
    TASK.store(NOTHING, Ordering::Relaxed);
}

/// The next record, as soon as there is one.
fn next<R: Copy, const N: usize>(trace: &Trace<R, N>) -> R {
    loop {
        match trace.pop() {
            Some(record) => return record,
            None => cortex_m::asm::wfi(),
        }
    }
}

/// 100 samples per second: enough time for a processor that computes floats by software.
fn hundredth_of_a_second() -> u32 {
    board::named(BOARD).unwrap().clock / 100
}

fn traced() {
    let law = law();
    LAW.publish(law);
    let timer = start(CONTROL, hundredth_of_a_second());
    let mut here = Instance::new(law, law.zeroed());
    for k in 0..1000 {
        let record = next(&SAMPLES);
        let input = input(k);
        // The same law on the same inputs in this context: the same bits.
        assert_eq!(record, TraceSample::new(k, &input, &here.step(&input)));
    }
    stop(timer);
    assert_eq!(SAMPLES.dropped(), 0);
    while SAMPLES.pop().is_some() {}
}

fn dropped() {
    LAW.publish(law());
    let timer = start(CONTROL, hundredth_of_a_second());
    // Nobody reads until 20 samples are over.
    while SAMPLES.len() + usize::try_from(SAMPLES.dropped()).unwrap() < 20 {
        cortex_m::asm::wfi();
    }
    stop(timer);
    assert_eq!((SAMPLES.len(), SAMPLES.dropped()), (8, 12));
    for k in 0..8 {
        // The oldest stay, without a gap.
        assert_eq!(SAMPLES.pop().map(|sample| sample.k), Some(k));
    }
    let timer = start(CONTROL, hundredth_of_a_second());
    assert_eq!(next(&SAMPLES).k, 20);
    stop(timer);
    assert_eq!(SAMPLES.dropped(), 12);
}

/// The interrupt comes at a time that walks through every place of the reader.
fn whole() {
    let timer = start(COUNT, 1499);
    let mut last = 0;
    let mut read = 0_u32;
    while read < 20_000 {
        if let Some(words) = WORDS.pop() {
            let [first, ..] = words;
            assert!(words == [first; 9] && first > last, "{words:?} after {last}");
            last = first;
            read += 1;
        }
    }
    stop(timer);
}
