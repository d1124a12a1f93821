//! The processor and its stack.

use controller_core::{
    Compensator, ConfigErrors, Controller, ControllerConfig, ControllerInput, ControllerOutput,
    EstimatorConfig, Law, LimitConfig, PidConfig,
};
use controller_firmware::image::print;
use controller_firmware::stack;
use core::hint::black_box;

/// Before anything else has run.
pub(crate) const FIRST: &[(&str, fn())] = &[("the floating-point unit rounds as IEEE 754 does", rounding)];
/// After all others.
pub(crate) const LAST: &[(&str, fn())] = &[
    ("the stack is large enough", whole_stack),
    ("a step needs little stack", stack_of_a_step),
    ("building a law fits into a small stack", stack_of_new),
];

/// No flush-to-zero, no default NaN, rounding to nearest: with any of these bits set the results would have other bits than
/// on the host.
#[cfg(target_abi = "eabihf")]
fn rounding() {
    const MODES: u32 = 0xF << 22;
    let now = cortex_m::register::fpscr::read().bits();
    assert_eq!(now & MODES, 0, "FPSCR = {now:#010x}");
    // SAFETY: a read without a side effect of a register that every processor with this unit has; interrupts begin with it.
    let in_interrupts = unsafe { (*cortex_m::peripheral::FPU::PTR).fpdscr.read() };
    assert_eq!(in_interrupts & MODES, 0, "FPDSCR = {in_interrupts:#010x}");
    subnormals();
}

/// Without the unit the arithmetic is a library's.
#[cfg(not(target_abi = "eabihf"))]
fn rounding() {
    subnormals();
}

fn subnormals() {
    let smallest = black_box(f32::MIN_POSITIVE);
    assert_eq!((smallest * black_box(0.5)).to_bits(), 0x0040_0000);
    // Half a unit in the last place: to even.
    assert_eq!((black_box(1.0_f32) + black_box(f32::EPSILON * 0.5)).to_bits(), 0x3F80_0000);
}

fn whole_stack() {
    let (used, size) = (stack::high_water(), stack::size());
    print!("{used} of {size} bytes ... ");
    assert!(used < size);
}

type Loop = Controller<f32>;
type Estimating = Controller<f32, Compensator<f32, 2, 1, 32>>;

#[inline(never)]
fn step(
    law: &Loop,
    state: &mut <Loop as Law>::State,
    input: &ControllerInput<f32>,
    output: &mut ControllerOutput<f32>,
) {
    *output = law.step(state, input);
}

fn stack_of_a_step() {
    let config = ControllerConfig {
        pid: PidConfig { kp: 2.0, ki: 0.5, kd: 0.3, tf: 0.05, ..PidConfig::default() },
        limits: LimitConfig { rate_up: Some(5.0), ..LimitConfig::range(-10.0, 10.0) },
        ..ControllerConfig::default()
    };
    let law = Loop::new(&config, 0.01).unwrap();
    let mut state = law.zeroed();
    let mut output = ControllerOutput::default();
    let mut most = 0;
    for k in 0_u8..60 {
        // The start, the run, bad samples with hold and fallback, the return.
        let y = if (20..50).contains(&k) { f32::NAN } else { 0.1 * f32::from(k) };
        let input = black_box(ControllerInput { r: 1.0, y, ..ControllerInput::default() });
        most = most.max(stack::used_by(|| step(&law, &mut state, &input, &mut output)));
        assert!(output.u.is_finite());
    }
    let nothing = stack::used_by(|| {
        black_box(());
    });
    print!("{most} bytes, of which {nothing} for the call ... ");
    // A kibibyte is what small operating systems give a task; the table of costs has the exact figures.
    assert!(nothing <= 32 && most > nothing && most <= 1024);
}

/// A law is built where there is time, but perhaps not much memory: the faults it could have take most of it.
fn stack_of_new() {
    let config = black_box(ControllerConfig::default());
    let mut law = None;
    let used = stack::used_by(|| law = Loop::new(black_box(&config), 0.01).ok());
    print!("{used} bytes ... ");
    assert!(law.is_some() && used <= 6 * 1024);
    let block =
        black_box(EstimatorConfig { gain: 1.2, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.32, tfd: 0.315 });
    let mut law = None;
    let used = stack::used_by(|| law = estimating(black_box(&config), black_box(&block)).ok());
    print!("with an estimator {used} bytes ... ");
    assert!(law.is_some() && used <= 11 * 1024);
}

#[inline(never)]
fn estimating(config: &ControllerConfig, block: &EstimatorConfig) -> Result<Estimating, ConfigErrors> {
    let compensator = Compensator::new(&block.to_compensator(0.0), 0.01)?;
    Controller::with_compensator(config, compensator, 0.01)
}
