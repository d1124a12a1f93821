//! No model, however wild, makes a rule panic or give a number that is none.

use controller_core::PidConfig;
use controller_design::Refusal;
use controller_design::rules::adrc::AdrcDesign;
use controller_design::rules::ah::{AhMs, AhPid};
use controller_design::rules::amigo::Amigo;
use controller_design::rules::fits::AirikkaPi;
use controller_design::rules::simc::Simc;
use proptest::prelude::*;

/// Any bits; half of them of a size that occurs.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        (-12.0..12.0_f64, any::<bool>())
            .prop_map(|(e, minus)| libm::exp10(e) * if minus { -1.0 } else { 1.0 }),
        Just(0.0),
    ]
}

fn is_sound(pid: Result<PidConfig, Refusal>, gain: f64) -> Result<(), TestCaseError> {
    let Ok(pid) = pid else { return Ok(()) };
    prop_assert!(pid.kp.is_finite() && pid.ki.is_finite() && pid.kd.is_finite());
    prop_assert!(
        pid.ki * gain.signum() > 0.0 && pid.kp * gain.signum() >= 0.0 && pid.kd * gain.signum() >= 0.0
    );
    prop_assert!(pid.tf.is_finite() && pid.tf >= 0.0 && (0.0..=2.0).contains(&pid.b) && pid.c == 0.0);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_210_606),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn rules_give_sound_numbers_or_refuse(
        gain in number(),
        tau in number(),
        tau2 in number(),
        dead_time in number(),
        tau_c in prop::option::of(number()),
    ) {
        is_sound(AirikkaPi::power(gain, tau, dead_time).map(|d| d.pid), gain)?;
        is_sound(AirikkaPi::linear(gain, tau, dead_time).map(|d| d.pid), gain)?;
        is_sound(AirikkaPi::integrating(gain, dead_time).map(|d| d.pid), gain)?;
        is_sound(AhPid::new(gain, tau, dead_time, AhMs::Ms14).map(|d| d.pid), gain)?;
        is_sound(AhPid::new(gain, tau, dead_time, AhMs::Ms20).map(|d| d.pid), gain)?;
        is_sound(Amigo::pi(gain, tau, dead_time).map(|d| d.pid), gain)?;
        is_sound(Amigo::pid(gain, tau, dead_time).map(|d| d.pid), gain)?;
        is_sound(Amigo::integrating_pi(gain, dead_time).map(|d| d.pid), gain)?;
        is_sound(Amigo::integrating_pid(gain, dead_time).map(|d| d.pid), gain)?;
        is_sound(Simc::pi(gain, tau, dead_time, tau_c).map(|d| d.pid), gain)?;
        is_sound(Simc::pid(gain, tau, tau2, dead_time, tau_c).map(|d| d.pid), gain)?;
        is_sound(Simc::integrating_pi(gain, dead_time, tau_c).map(|d| d.pid), gain)?;
        is_sound(Simc::integrating_pid(gain, tau2, dead_time, tau_c).map(|d| d.pid), gain)?;
        if let Ok(design) = AdrcDesign::new(gain, tau, tau2) {
            prop_assert!(design.kc.is_finite() && design.kp.is_finite() && design.beta3.is_finite());
        }
    }
}
