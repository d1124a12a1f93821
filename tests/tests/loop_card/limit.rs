//! Loops that are driven until they oscillate.

use crate::cases::Case;
use controller_core::{ControllerInput, Real};
use controller_sim_host::simulate::ClosedLoop;
use controller_tests::cases::transfer_function;

/// Whether the oscillation after a pulse grows with `gain` times the plant and `extra` seconds more of dead time. `period` is
/// about that of the oscillation, in samples.
pub(crate) fn grows<T: Real>(case: &Case, (gain, extra): (f64, f64), period: f64) -> bool {
    let mut law = case.law::<T>();
    let plant = transfer_function(&case.plant);
    let latency = case.latency + extra;
    let (mut plant, _) = ClosedLoop::new(&plant, case.ts, latency, 1, (0.0, 0.0), &[]).expect("rests at 0");
    let block = (30.0 * period).ceil() as usize;
    // From the top to the bottom of a swing: a level that remains or creeps does not count.
    let mut swings: Vec<f64> = Vec::new();
    for n in 0..80 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..block {
            let input = ControllerInput { y: T::from_f64(plant.measure()), ..ControllerInput::default() };
            let u = law.step(&input).u.to_f64();
            (low, high) = (low.min(u), high.max(u));
            let pulse = if n == 0 && k == 0 { 1.0 } else { 0.0 };
            plant.hold(gain * u + pulse, |_| {});
        }
        swings.push(high - low);
        // The first block is the pulse; the output ends at 1e6.
        let (Some(second), last) = (swings.get(1), high - low) else { continue };
        if last > 1e3 * second || high.abs().max(low.abs()) > 1e5 {
            return true;
        }
        // Or down to what rounding leaves of the pulse in single precision.
        if last < 1e-3 * second || last < 1e-5 * swings[0] {
            return false;
        }
    }
    swings[79] > swings[1]
}

/// The least of `list` from which on the loop grows: doubled until it does, then bisected to 0.1 %.
pub(crate) fn limit(start: f64, grows: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, start);
    while !grows(high) {
        (low, high) = (high, 2.0 * high);
        assert!(high < 1e6 * start, "never grows");
    }
    while high - low > 1e-3 * high {
        let middle = 0.5 * (low + high);
        if grows(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}
