//! Areas against exact values, and what is refused.

mod golden;

use controller_design::Refusal;
use controller_design::areas::{Areas, MAX_AREAS, areas_into};
use controller_design::model::parse;
use golden::{close, rows};

#[test]
fn areas_agree_with_sixty_digits() {
    let rows = rows();
    assert_eq!(rows.len(), 40);
    for row in &rows {
        let areas = row.plant().areas(9).unwrap();
        for (k, &area) in areas.iter().enumerate() {
            close(&format!("{}: A_{k}", row.name()), area, row.number(&format!("a{k}")), 1e-12);
        }
        let six = row.plant().areas6().unwrap();
        assert_eq!(six.values()[..], areas[..6]);
    }
}

/// Tables 1 and 3 of Vrančić & Huba 2021; ties are rounded half up there.
#[test]
fn printed_areas_come_out() {
    let tables: [(&str, f64, [f64; 6], [f64; 6]); 4] = [
        (
            "exp(-0.5*s)/(1+s)^2",
            0.1,
            [1.0, 2.50, 4.13, 5.77, 7.42, 9.07],
            [1.0, 2.60, 4.39, 6.21, 8.04, 9.87],
        ),
        (
            "exp(-0.2*s)/(1+s)^3",
            0.1,
            [1.0, 3.20, 6.62, 11.26, 17.12, 24.21],
            [1.0, 3.30, 6.95, 11.96, 18.32, 26.04],
        ),
        (
            "exp(-0.2*s)/((1+0.2*s)*(1+s))",
            0.118_698_154_8,
            [1.0, 1.40, 1.50, 1.52, 1.53, 1.53],
            [1.0, 1.52, 1.68, 1.72, 1.73, 1.73],
        ),
        (
            "exp(-s)/(1+s)^4",
            0.191_747_132_2,
            [1.0, 5.00, 14.50, 32.17, 60.71, 102.8],
            [1.0, 5.19, 15.50, 35.14, 67.45, 115.8],
        ),
    ];
    for (plant, tf, plain, filtered) in tables {
        let areas = parse(plant).unwrap().areas6().unwrap();
        for (printed, ours) in [(plain, areas), (filtered, areas.filtered(tf))] {
            for (k, &digit) in printed.iter().enumerate() {
                let half_unit = if digit > 100.0 { 0.0501 } else { 0.005_01 };
                assert!((ours.of(k) - digit).abs() <= half_unit, "{plant}: A_{k} = {}", ours.of(k));
            }
        }
    }
}

/// `A_k` of `n` equal lags is a binomial coefficient, of a dead time a power over a factorial.
#[test]
fn closed_forms_come_out_at_any_scale() {
    for exponent in [-60, -6, -1, 0, 3, 6, 60] {
        let unit = 10_f64.powi(exponent);
        let lags = parse(&format!("-3e7/(1+{unit:e}*s)^20")).unwrap().areas(12).unwrap_or_else(|r| {
            // 1e-60^6 is still a number, 1e-60^11 is not.
            assert_eq!(exponent.abs(), 60, "{r}");
            Vec::new()
        });
        let mut binomial = 1.0;
        for (k, area) in (0_i32..).zip(lags) {
            close("lags", area, -3e7 * binomial * unit.powi(k), 1e-13);
            binomial *= f64::from(20 + k) / f64::from(k + 1);
        }
        let delay = Areas::of_model(2.0, &[1.0], &[1.0], 7.0 * unit);
        let mut factorial = 1.0;
        if let Ok(delay) = delay {
            for k in 0..6 {
                close("delay", delay.of(k as usize), 2.0 * (7.0 * unit).powi(k) / factorial, 1e-13);
                factorial *= f64::from(k + 1);
            }
        } else {
            assert_eq!(exponent.abs(), 60);
        }
    }
}

/// A zero on a pole cancels to the last digit, also where the two are written in another order.
#[test]
fn areas_that_cancel_are_accurate() {
    let plant = parse("(1+0.7*s)*(1+0.2*s)/((1+0.2*s)*(1+0.5*s)*(1+0.7*s))").unwrap();
    let areas = plant.areas(7).unwrap();
    for (k, &area) in (0_i32..).zip(&areas) {
        close("cancelled", area, 0.5_f64.powi(k), 1e-14);
    }
    let near = Areas::of_model(1.0, &[1.0, 1.0 + f64::EPSILON], &[1.0, 1.0], 0.0).unwrap();
    assert_eq!(near.of(1), -f64::EPSILON);
}

#[test]
fn filtered_areas_are_those_of_one_lag_more() {
    let plain = parse("2*exp(-0.3*s)/((1+s)*(1+0.1*s))").unwrap().areas6().unwrap();
    let more = parse("2*exp(-0.3*s)/((1+s)*(1+0.1*s)*(1+0.05*s))").unwrap().areas6().unwrap();
    for k in 0..6 {
        close("filtered", plain.filtered(0.05).of(k), more.of(k), 1e-15);
    }
}

#[test]
fn any_number_of_areas_can_be_had() {
    let mut out = [0.0; MAX_AREAS];
    areas_into(1.0, &[1.0], &[1.0, 2.0, 1.0], 0.0, &mut out).unwrap();
    for (k, area) in out.iter().enumerate() {
        assert_eq!(*area, (k + 1) as f64);
    }
    let long = parse("1/(1+s)^2").unwrap().areas(500).unwrap();
    assert_eq!(long[499], 500.0);
    let refused = areas_into(1.0, &[1.0], &[1.0, 1.0], 0.0, &mut [0.0; MAX_AREAS + 1]);
    assert!(matches!(refused, Err(Refusal::OutOfRange { parameter: "count", .. })));
    areas_into(1.0, &[1.0], &[1.0, 1.0], 0.0, &mut []).unwrap();
}

#[test]
fn what_has_no_areas_is_refused() {
    for (plant, about) in [
        ("1/s", "integrating"),
        ("exp(-s)/(s*(1+s))", "integrating"),
        ("s/(1+s)^2", "zero there"),
        ("1/(1-s)", "unstable"),
        ("1/(s^2+1)", "unstable"),
        ("1/((1+s)*(1-0.1*s+s^2))", "unstable"),
        // (1+s)*(1+s^2) and (1+s)*(1-0.001*s+s^2), written out
        ("1/(1+s+s^2+s^3)", "unstable"),
        ("1/(1+0.999*s+0.999*s^2+s^3)", "unstable"),
    ] {
        let refusal = parse(plant).unwrap().areas6().unwrap_err();
        assert!(refusal.to_string().contains(about), "{plant}: {refusal}");
        assert!(!refusal.help().is_empty());
    }
    for (gain, num, den, delay) in [
        (0.0, &[1.0][..], &[1.0, 1.0][..], 0.0),
        (f64::NAN, &[1.0], &[1.0, 1.0], 0.0),
        (1.0, &[1.0], &[1.0, 1.0], -1.0),
        (1.0, &[1.0], &[1.0, 1.0], f64::INFINITY),
        (1.0, &[2.0], &[1.0, 1.0], 0.0),
        (1.0, &[1.0], &[], 0.0),
        (1.0, &[1.0], &[1.0, -1.0], 0.0),
        (1.0, &[1.0], &[1.0, 0.0, 1.0], 0.0),
        (1.0, &[1.0], &[1.0, f64::NAN], 0.0),
        (1.0, &[1.0, f64::INFINITY], &[1.0, 1.0], 0.0),
        (1.0, &[1.0], &[1.0, 1e100], 0.0),
        (1.0, &[1.0], &[1.0, 1e-100], 0.0),
        (1.0, &[1.0], &[1.0; 40], 0.0),
    ] {
        assert!(Areas::of_model(gain, num, den, delay).is_err(), "{gain} {num:?} {den:?} {delay}");
    }
}

/// Polynomials that are stable by construction and others that are not, against their roots.
#[test]
fn stability_is_that_of_the_roots() {
    for n in 1..=20_u32 {
        let stable = format!("1/(1+0.3*s)^{n}");
        assert!(parse(&stable).unwrap().areas6().is_ok());
    }
    // Chains of pairs, expanded; the damping of the last decides.
    for (damping, stable) in [(0.02, true), (1e-9, true), (0.0, false), (-1e-9, false), (-0.02, false)] {
        let mut den = vec![1.0];
        for pair in [[1.0, 0.4, 1.0], [1.0, 3.0, 0.5], [1.0, damping, 4.0]] {
            let mut product = vec![0.0; den.len() + 2];
            for (i, a) in den.iter().enumerate() {
                for (j, b) in pair.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            den = product;
        }
        let areas = Areas::of_model(1.0, &[1.0], &den, 0.0);
        // Coefficients are rounded: nothing can be known of a damping of exactly 0.
        if damping != 0.0 {
            assert_eq!(areas.is_ok(), stable, "damping {damping}");
        }
    }
}
