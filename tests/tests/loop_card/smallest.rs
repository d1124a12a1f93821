//! The smallest error on a card, with the law of the core in single precision.

use crate::cases::Case;
use controller_core::{Pid, PidConfig, PidInput, PidState};
use controller_sim_host::scenario::ControllerSpec;
use controller_sim_host::simulate::Precision;
use controller_tests::oracle::state_space::PlantFactors;

/// So slow an integral term that its compensated sum decides, not the measurement: at 1 the sum loses increments below
/// `2^-46/4`, and `ki*ts` is 1e-9. The figure is that bound rounded up to a number that the measurement can take; the sum
/// itself loses nothing above it and everything at a quarter of it, for its carry is then half a unit at most.
#[test]
fn a_slow_sum_moves_by_the_smallest_error_and_stalls_at_a_quarter_of_it() {
    let pid = PidConfig { kp: 1.0, ki: 1e-6, ..PidConfig::default() };
    let case = Case {
        name: "slow".to_owned(),
        plant: PlantFactors { lags: &[1000.0], ..PlantFactors::UNITY },
        spec: ControllerSpec::pid("slow", pid),
        ts: 1e-3,
        latency: 0.0,
    };
    let eps = f64::from(f32::EPSILON);
    let error = case.card(Precision::F32).value("smallest_error").expect("a figure");
    let bound = 0.25 * eps * eps / 1e-9;
    assert!(error >= bound * (1.0 - 1e-6) && error < bound * (1.0 + 1e-6) + eps, "{error:e} for {bound:e}");

    let law = Pid::<f32>::new(&pid, 1e-3).expect("valid");
    let moves = |error: f64, samples: u64| {
        let mut state = PidState::default();
        law.settle(&mut state, PidInput { r: 1.0, y: 1.0 }, 1.0);
        #[allow(clippy::cast_possible_truncation)] // rounded to the measurement's type is what is meant
        let y = (1.0 - error) as f32;
        (0..samples).any(|_| law.step(&mut state, PidInput { r: 1.0, y }).i != 1.0)
    };
    // From 1 to the next number are eps, half of it until the sum is rounded up.
    let due = (0.5 * eps / (1e-9 * error)) as u64;
    assert!(moves(error, due + due / 8), "{error:e} does not move the sum");
    assert!(!moves(error / 4.0, 8 * due), "{:e} moves the sum", error / 4.0);
}
