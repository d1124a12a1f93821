//! The fits of Airikka 2021 against the true optimum, which was computed by optimisation elsewhere.

use controller_core::PidConfig;
use controller_design::Refusal;
use controller_design::rules::fits::AirikkaPi;

/// `dead_time/tau`, `kp*gain`, `ti/tau` of the PI with the least IAE after a load step.
const OPTIMUM: [[f64; 3]; 6] = [
    [0.2, 4.6057, 0.605_97],
    [0.41, 2.2899, 0.965_34],
    [0.84, 1.1829, 1.3561],
    [1.0, 1.019_37, 1.450_96],
    [1.7, 0.681_47, 1.7680],
    [3.0, 0.497_26, 2.2802],
];

/// Gains in the units of the table: gain 1, `tau` 1.
fn standard(pid: &PidConfig, gain: f64, tau: f64) -> (f64, f64) {
    (pid.kp * gain, pid.kp / pid.ki / tau)
}

/// The errors of the fits were published in whole percent.
#[test]
fn fits_are_as_near_to_the_optimum_as_they_claim() {
    for (gain, tau) in [(1.0, 1.0), (-2e5, 3e-6), (1e-7, 4e6)] {
        for [r, kp, ti] in OPTIMUM {
            let linear = AirikkaPi::linear(gain, tau, r * tau).unwrap();
            let (k, t) = standard(&linear.pid, gain, tau);
            assert!((-0.045..0.035).contains(&(k / kp - 1.0)), "(8) kp at {r}: {}", k / kp - 1.0);
            assert!((-0.095..0.055).contains(&(t / ti - 1.0)), "(8) ti at {r}: {}", t / ti - 1.0);
            assert!(linear.warnings.is_empty());
            let power = AirikkaPi::power(gain, tau, r * tau).unwrap();
            let (k, t) = standard(&power.pid, gain, tau);
            assert!((-0.165..0.085).contains(&(k / kp - 1.0)), "(7) kp at {r}: {}", k / kp - 1.0);
            assert!((-0.095..0.115).contains(&(t / ti - 1.0)), "(7) ti at {r}: {}", t / ti - 1.0);
            assert_eq!(power.warnings.is_empty(), r <= 0.6);
        }
        let integrating = AirikkaPi::integrating(gain, tau).unwrap();
        let (k, t) = standard(&integrating.pid, gain * tau, tau);
        assert!((k / 0.910_98 - 1.0).abs() < 0.015 && (t / 4.0994 - 1.0).abs() < 0.005);
    }
}

#[test]
fn poor_fits_are_told() {
    for r in [0.05, 0.1, 0.149, 3.01, 10.0] {
        let warnings = AirikkaPi::linear(1.0, 2.0, 2.0 * r).unwrap().warnings;
        assert!(warnings[0].to_string().starts_with("dead_time/tau = "));
    }
}

#[test]
fn what_is_no_plant_is_refused() {
    for (gain, tau, dead_time) in [
        (0.0, 1.0, 1.0),
        (f64::NAN, 1.0, 1.0),
        (1.0, 0.0, 1.0),
        (1.0, -1.0, 1.0),
        (1.0, 1.0, 0.0),
        (1.0, 1.0, -1.0),
        (1.0, 1.0, f64::INFINITY),
        (1e-300, 1.0, 1e-300),
    ] {
        assert!(AirikkaPi::linear(gain, tau, dead_time).is_err());
        assert!(AirikkaPi::power(gain, tau, dead_time).is_err());
    }
    assert!(matches!(AirikkaPi::integrating(1.0, 0.0), Err(Refusal::Plant { .. })));
    assert!(AirikkaPi::integrating(f64::INFINITY, 1.0).is_err());
}
