//! DRMO against 60 digits, the printed tables, and what it promises of the loop.

mod golden;

use controller_design::areas::Areas;
use controller_design::model::{Complex, parse};
use controller_design::rules::drmo::Drmo;
use controller_design::rules::noise_limit::{PidRule, kpidn, least_kpidn};
use golden::{close, rows};

#[test]
fn gains_agree_with_sixty_digits() {
    for row in rows() {
        match (row.get("drmo_kp"), Drmo::new(&row.areas(), row.number("tf"))) {
            (Some(kp), Ok(Drmo { pid, .. })) => {
                close(row.name(), pid.kp, kp, 1e-12);
                close(row.name(), pid.ki, row.number("drmo_ki"), 1e-12);
                close(row.name(), pid.kd, row.number("drmo_kd"), 1e-12);
                assert_eq!((pid.tf, pid.b, pid.c), (row.number("tf"), 0.0, 0.0));
            }
            (None, Err(refusal)) => assert!(!refusal.help().is_empty()),
            (expected, ours) => panic!("{}: {ours:?}, expected {expected:?}", row.name()),
        }
    }
}

#[test]
fn filters_for_a_noise_limit_agree() {
    for row in rows() {
        let Some(tf) = row.get("drmo_tf") else { continue };
        let (limit, ts) = (row.number("kpidn"), row.number("ts"));
        let pid = Drmo::with_noise_limit(&row.areas(), limit, ts).unwrap().pid;
        close(row.name(), pid.tf, tf, 1e-6);
        close(row.name(), kpidn(&pid, ts), limit, 1e-6);
    }
}

/// Tables 2, 4 and 5 of Vrančić & Huba 2021. The noise limit is MOMI's there: DRMO takes over its filter.
#[test]
fn printed_gains_come_out() {
    for (plant, tf, kp, ki, unit) in [
        ("exp(-0.5*s)/(1+s)^2", 0.1, 2.25, 1.49, 0.01),
        ("exp(-0.2*s)/(1+s)^3", 0.1, 1.93, 0.98, 0.01),
        ("exp(-0.2*s)/((1+0.2*s)*(1+s))", 0.118_698_154_8, 2.91, 3.83, 0.01),
        ("exp(-s)/(1+s)^4", 0.191_747_132_2, 0.94, 0.32, 0.01),
        ("exp(-5*s)/(1+s)^3", 0.165_234_985_5, 0.57, 0.140, 0.01),
        ("1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))", 0.054_578_771_83, 9.485_382_083, 22.960_107_01, 1e-6),
    ] {
        let pid = Drmo::new(&parse(plant).unwrap().areas6().unwrap(), tf).unwrap().pid;
        for (ours, printed) in [(pid.kp, kp), (pid.ki, ki)] {
            assert!((ours - printed).abs() <= 0.501 * unit, "{plant}: {ours}, printed {printed}");
        }
    }
}

/// `|Y/(D*s)|`, without the lag of the filter in the numerator, is flat up to `w^4`.
#[test]
fn the_load_response_is_flat() {
    for row in rows() {
        let Ok(Drmo { pid, .. }) = Drmo::new(&row.areas(), row.number("tf")) else { continue };
        let plant = row.plant();
        let size = |w: f64| {
            let s = Complex::new(0.0, w);
            let filter = s * pid.tf + Complex::real(1.0);
            let law = s * s * pid.kd + s * pid.kp + Complex::real(pid.ki);
            let inverse = s * filter / plant.at(s) + law;
            (inverse.abs() / pid.ki.abs()).powi(2) - 1.0
        };
        let mut w = 1.0 / (row.areas().of(1) / row.areas().of(0)).abs();
        while size(w).abs() > 1e-3 {
            w *= 0.8;
        }
        // c*w^6 falls by 64, c*w^4 would by 16.
        let ratio = size(w) / size(0.5 * w);
        assert!(ratio > 32.0, "{}: {ratio}", row.name());
    }
}

#[test]
fn unattainable_limits_name_the_least() {
    let areas = Areas::of_model(-2.0, &[1.0], &[1.0, 1.2, 0.2], 0.0).unwrap();
    let least = least_kpidn(&areas, PidRule::Drmo, 0.01);
    let refusal = Drmo::with_noise_limit(&areas, 0.5 * least, 0.01).unwrap_err();
    assert!(refusal.to_string().contains("least attainable"), "{refusal}");
    let pid = Drmo::with_noise_limit(&areas, 1.1 * least, 0.01).unwrap().pid;
    close("gain", kpidn(&pid, 0.01), 1.1 * least, 1e-9);
    assert!(pid.kp < 0.0 && pid.ki < 0.0 && pid.kd < 0.0);
}
