//! ADRC parameters against Table 7 of Vrančić & Huba 2021 and the poles they promise.

use controller_design::areas::Areas;
use controller_design::model::Polynomial;
use controller_design::rules::adrc::AdrcDesign;
use controller_design::rules::reduction::Reduced;

#[test]
fn table_7_comes_out() {
    for (b0, settling_time, [kp, kd, beta1, beta2, printed], beta3) in [
        (5.0, 1.0, [100.0, 20.0, 120.0, 4800.0, 19_200.0], 64_000.0),
        (3.0, 25.0, [0.16, 0.8, 4.8, 7.68, 30.72], 4.096),
    ] {
        let design = AdrcDesign::for_settling_time(b0, settling_time).unwrap();
        let rows = [
            (design.kc, 1.0 / b0),
            (design.kp, kp),
            (design.kd, kd),
            (design.beta1, beta1),
            (design.beta2, beta2),
            (design.beta3, beta3),
            (design.with_beta3_as_printed().beta3, printed),
        ];
        for (ours, expected) in rows {
            assert!((ours / expected - 1.0).abs() < 1e-14, "{ours}, expected {expected}");
        }
    }
}

#[test]
fn poles_are_where_the_bandwidths_say() {
    for (omega_c, omega_o) in [(3.0, 12.0), (1e-5, 7e-5), (2e6, 5e6)] {
        let d = AdrcDesign::new(-0.7, omega_c, omega_o).unwrap();
        for root in Polynomial::new([d.kp, d.kd, 1.0]).roots() {
            assert!((root.re / omega_c + 1.0).abs() < 1e-12 && root.im.abs() < 1e-7 * omega_c);
        }
        for root in Polynomial::new([d.beta3, d.beta2, d.beta1, 1.0]).roots() {
            assert!((root.re / omega_o + 1.0).abs() < 1e-12);
        }
        assert!(d.kc < 0.0);
    }
}

#[test]
fn the_gain_of_a_model_is_that_at_high_frequencies() {
    let areas = Areas::of_model(-3.0, &[1.0], &[1.0, 1.2, 0.2], 0.1).unwrap();
    let design = AdrcDesign::for_model(&Reduced::new(&areas).unwrap(), 2.0).unwrap();
    assert!((design.b0 + 15.0).abs() < 1e-9 && design.omega_c == 5.0 && design.omega_o == 20.0);
    let lag = Areas::of_model(1.0, &[1.0], &[1.0, 1.0], 0.1).unwrap();
    assert!(AdrcDesign::for_model(&Reduced::new(&lag).unwrap(), 2.0).is_err());
}

#[test]
fn what_is_no_design_is_refused() {
    for (b0, omega_c, omega_o) in [
        (0.0, 1.0, 4.0),
        (f64::NAN, 1.0, 4.0),
        (1.0, 0.0, 4.0),
        (1.0, 1.0, -4.0),
        (1.0, f64::INFINITY, 4.0),
        (1.0, 1.0, 1e103),
        (1.0, 1e-200, 1.0),
        (1e-320, 1.0, 1.0),
    ] {
        assert!(AdrcDesign::new(b0, omega_c, omega_o).is_err(), "{b0} {omega_c} {omega_o}");
    }
    assert!(AdrcDesign::for_settling_time(1.0, 0.0).is_err());
}
