//! No area, however wild, makes a rule panic or give a number that is none.

use controller_core::PidConfig;
use controller_design::areas::{Areas, areas_into};
use controller_design::rules::de_momi::DeMomi;
use controller_design::rules::drmo::Drmo;
use controller_design::rules::momi::Momi;
use controller_design::rules::noise_limit::{PidRule, kpidn, least_kpidn};
use controller_design::rules::reduction::Reduced;
use proptest::prelude::*;

/// Any bits; half of them of a size that occurs.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        (-12.0..12.0_f64, any::<bool>())
            .prop_map(|(e, minus)| libm::exp10(e) * if minus { -1.0 } else { 1.0 }),
        Just(0.0),
        Just(1.0),
    ]
}

/// Areas of no process at all, and of processes with a touch of nonsense.
fn wild_areas() -> impl Strategy<Value = Areas> {
    let any_six = prop::array::uniform6(number()).prop_map(Areas::new);
    let bent = (process(), prop::array::uniform6(0.2..2.0_f64)).prop_map(|(areas, bend)| {
        let mut values = areas.values();
        for (value, factor) in values.iter_mut().zip(bend) {
            *value *= factor;
        }
        Areas::new(values)
    });
    prop_oneof![any_six, bent, process()]
}

fn process() -> impl Strategy<Value = Areas> {
    let lag = (-6.0..6.0_f64).prop_map(libm::exp10);
    let parts =
        (number(), prop::collection::vec(lag.clone(), 1..6), prop_oneof![Just(0.0), lag], -3.0..3.0_f64);
    parts.prop_map(|(gain, lags, dead_time, zero)| {
        let mut den = vec![1.0];
        for lag in &lags {
            den.push(0.0);
            for k in (1..den.len()).rev() {
                den[k] += den[k - 1] * lag;
            }
        }
        let num = [1.0, zero * lags[0]];
        Areas::of_model(gain, &num, &den, dead_time)
            .unwrap_or_else(|_| Areas::new([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))
    })
}

fn is_sound(pid: &PidConfig, areas: &Areas) -> Result<(), TestCaseError> {
    prop_assert!(pid.kp.is_finite() && pid.ki.is_finite() && pid.kd.is_finite() && pid.tf.is_finite());
    prop_assert!(pid.ki * areas.of(0).signum() > 0.0 && pid.kp * areas.of(0).signum() > 0.0);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_210_604),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn rules_give_sound_numbers_or_refuse(areas in wild_areas(), tf in number(), tfd in number()) {
        if let Ok(Momi { pid, .. }) = Momi::new(&areas, tf) {
            is_sound(&pid, &areas)?;
        }
        if let Ok(Drmo { pid, .. }) = Drmo::new(&areas, tf) {
            is_sound(&pid, &areas)?;
        }
        if let Ok(model) = Reduced::new(&areas) {
            prop_assert!(model.a1.is_finite() && model.a1 >= 0.0 && model.a2.is_finite() && model.a2 >= 0.0);
            prop_assert!(model.dead_time.is_finite() && model.dead_time >= 0.0);
        }
        if let Ok(design) = DeMomi::new(&areas, tf, tfd) {
            is_sound(&design.pid, &areas)?;
            if let Some(e) = design.estimator {
                prop_assert!(e.kfd > 0.0 && e.kfd < 1.0 && e.tfd > 0.0 && e.a1 > 0.0);
            }
        }
    }

    #[test]
    fn areas_are_finite_or_refused(
        gain in number(),
        num in prop::collection::vec(number(), 0..6),
        den in prop::collection::vec(number(), 0..6),
        dead_time in number(),
        count in 0_usize..70,
    ) {
        let first = |list: &[f64]| [&[1.0][..], list].concat();
        let mut out = vec![0.0; count];
        if areas_into(gain, &first(&num), &first(&den), dead_time, &mut out).is_ok() {
            prop_assert!(out.iter().all(|a| a.is_finite()));
        }
        let _ = Areas::of_model(gain, &num, &den, dead_time);
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_210_605),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn noise_limits_hold_or_are_refused(
        areas in wild_areas(),
        limit in number(),
        estimators in number(),
        ts in number(),
    ) {
        for rule in [PidRule::Momi, PidRule::Drmo] {
            prop_assert!(least_kpidn(&areas, rule, ts) >= 0.0);
        }
        if let Ok(Momi { pid, .. }) = Momi::with_noise_limit(&areas, limit, ts) {
            is_sound(&pid, &areas)?;
            prop_assert!(pid.tf >= ts && kpidn(&pid, ts) <= limit * (1.0 + 1e-9));
        }
        if let Ok(Drmo { pid, .. }) = Drmo::with_noise_limit(&areas, limit, ts) {
            is_sound(&pid, &areas)?;
            prop_assert!(pid.tf >= ts && kpidn(&pid, ts) <= limit * (1.0 + 1e-9));
        }
        if let Ok(design) = DeMomi::with_noise_limits(&areas, limit, estimators, ts)
            && let Some(e) = design.estimator
        {
            prop_assert!(e.tfd >= ts && e.tfd.is_finite() && e.kfd > 0.0 && e.kfd < 1.0);
        }
    }
}
