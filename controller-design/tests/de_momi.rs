//! DE-MOMI and its model against 60 digits, the printed tables, and what they promise.

mod golden;

use controller_design::Refusal;
use controller_design::areas::Areas;
use controller_design::model::{Complex, TransferFunction, parse};
use controller_design::rules::de_momi::{DeMomi, kfd};
use controller_design::rules::momi::Momi;
use controller_design::rules::noise_limit::kden;
use controller_design::rules::reduction::Reduced;
use golden::{close, rows};

fn areas(plant: &str) -> Areas {
    parse(plant).unwrap().areas6().unwrap()
}

#[test]
fn models_agree_with_sixty_digits() {
    for row in rows() {
        match (row.get("model_a1"), Reduced::new(&row.areas())) {
            (Some(a1), Ok(model)) => {
                let name = row.name();
                assert!(!model.fallback, "{name}");
                close(name, model.gain, row.number("a0"), 1e-15);
                close(name, model.a1, a1, 1e-10);
                close(name, model.a2, row.number("model_a2"), 1e-10);
                close(name, model.dead_time, row.number("model_dead_time"), 1e-10);
            }
            (None, Ok(model)) => {
                assert!(model.fallback && model.a2 >= 0.0 && model.dead_time >= 0.0, "{}", row.name());
            }
            (None, Err(refusal)) => assert!(!refusal.help().is_empty()),
            (expected, ours) => panic!("{}: {ours:?}, expected {expected:?}", row.name()),
        }
    }
}

/// A process of the model's own form comes out unchanged, its limits (no second lag, no dead time) included.
#[test]
fn models_of_models_are_unchanged() {
    for scale in [1e-6, 1.0, 1e6] {
        for a1 in [0.0, 0.3, 1.0, 7.0] {
            for a2 in [0.0, 1e-6, 0.05, 0.25 * a1 * a1, 2.0] {
                for dead_time in [0.0, 1e-5, 0.2, 4.0] {
                    if a1 == 0.0 && (a2 > 0.0 || dead_time == 0.0) {
                        continue;
                    }
                    let den = [1.0, a1 * scale, a2 * scale * scale];
                    let areas = Areas::of_model(-4.0, &[1.0], &den, dead_time * scale);
                    let model = Reduced::new(&areas.unwrap()).unwrap();
                    let what = format!("a1 {a1}, a2 {a2}, dead time {dead_time}, scale {scale}");
                    assert!(!model.fallback && model.warnings.is_empty(), "{what}");
                    close(&what, model.a1, den[1], 1e-10);
                    close(&what, model.a2, den[2], 1e-10);
                    close(&what, model.dead_time, dead_time * scale, 1e-10);
                }
            }
        }
    }
}

/// Where the model is not a fallback, its first four areas are those of the process.
#[test]
fn models_keep_the_areas() {
    for row in rows() {
        let Ok(model) = Reduced::new(&row.areas()) else { continue };
        if model.fallback || !model.warnings.is_empty() {
            continue;
        }
        let second = TransferFunction::second_order(model.gain, model.a1, model.a2, model.dead_time).unwrap();
        for (k, area) in second.areas(4).unwrap().into_iter().enumerate() {
            close(row.name(), area, row.number(&format!("a{k}")), 1e-12);
        }
    }
}

#[test]
fn estimators_agree_with_sixty_digits() {
    for row in rows() {
        let design = DeMomi::new(&row.areas(), row.number("tf"), row.number("tfd"));
        let Some(expected) = row.get("kfd") else {
            assert!(
                design.map_or(true, |d| d.estimator.is_none() && !d.warnings.is_empty()),
                "{}",
                row.name()
            );
            continue;
        };
        let design = design.unwrap();
        match design.estimator {
            Some(estimator) => {
                close(row.name(), estimator.kfd, expected, 1e-10);
                assert_eq!(estimator.tfd, row.number("tfd"));
                assert_eq!(estimator.a1, design.model.a1);
                // What is designed can be run.
                let config = estimator.to_compensator(0.0);
                assert_eq!(config.validate(row.number("ts"), 10_000), Ok(()), "{}", row.name());
            }
            None => {
                assert_eq!(expected, 0.0, "{}", row.name());
                assert!(design.warnings.iter().any(|w| w.to_string().starts_with("estimator: off")));
            }
        }
    }
}

#[test]
fn filters_for_noise_limits_agree() {
    let mut count = 0;
    for row in rows() {
        let Some(tfd) = row.get("limit_tfd") else { continue };
        let (limit, ts) = (row.number("kden"), row.number("ts"));
        let design = DeMomi::with_noise_limits(&row.areas(), row.number("kpidn"), limit, ts).unwrap();
        let estimator = design.estimator.unwrap();
        close(row.name(), design.pid.tf, row.number("momi_tf"), 1e-6);
        close(row.name(), estimator.tfd, tfd, 1e-6);
        close(row.name(), estimator.kfd, row.number("limit_kfd"), 1e-6);
        close(row.name(), kden(&design.model, estimator.kfd, estimator.tfd, ts), limit, 1e-9);
        count += 1;
    }
    assert!(count >= 30, "{count}");
}

/// Eqs (22), (23), (36), (37) and Table 6 of Vrančić & Huba 2021; of Table 6 the converged `K_FD` of `G_P6`.
#[test]
fn printed_estimators_come_out() {
    let near = |ours: f64, printed: f64, unit: f64| {
        assert!((ours - printed).abs() <= 0.501 * unit, "{ours}, printed {printed}");
    };
    for (plant, [dead_time, a1, a2, gain]) in
        [("exp(-0.5*s)/(1+s)^2", [0.5, 2.0, 1.0, 0.57]), ("exp(-0.2*s)/(1+s)^3", [0.616, 2.58, 1.84, 0.59])]
    {
        let estimator = DeMomi::new(&areas(plant), 0.1, 0.1).unwrap().estimator.unwrap();
        near(estimator.dead_time, dead_time, 1e-3);
        near(estimator.a1, a1, 0.01);
        near(estimator.a2, a2, 0.01);
        near(estimator.kfd, gain, 0.01);
    }
    for (plant, limit, ts, values, units) in [
        (
            "exp(-0.2*s)/((1+0.2*s)*(1+s))",
            4.0,
            0.01,
            [0.2, 1.2, 0.2, 0.06, 0.69],
            [0.1, 0.1, 0.1, 0.01, 0.01],
        ),
        ("exp(-s)/(1+s)^4", 4.0, 0.01, [1.94, 3.06, 2.69, 0.116, 0.36], [0.01, 0.01, 0.01, 1e-3, 0.01]),
        ("exp(-5*s)/(1+s)^3", 4.0, 0.01, [5.42, 2.58, 1.84, 0.077, 0.1603], [0.01, 0.01, 0.01, 1e-3, 1e-4]),
        (
            "1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))",
            20.0,
            0.001,
            [0.043, 1.205, 0.205, 0.018, 0.909],
            [1e-3; 5],
        ),
    ] {
        let design = DeMomi::with_noise_limits(&areas(plant), limit, limit, ts).unwrap();
        let e = design.estimator.unwrap();
        for ((ours, printed), unit) in
            [e.dead_time, e.a1, e.a2, e.tfd, e.kfd].into_iter().zip(values).zip(units)
        {
            near(ours, printed, unit);
        }
    }
}

/// Eq. (17) with process and model equal: `|Y/(D*s)|` flat at `w^2` is what `K_FD` is chosen for.
#[test]
fn the_load_response_is_flat() {
    for plant in
        ["exp(-0.5*s)/(1+s)^2", "-3*exp(-20*s)/((1+40*s)*(1+9*s))", "2e5*exp(-1e-7*s)/(1+1.2e-6*s+2e-13*s^2)"]
    {
        let plant = parse(plant).unwrap();
        let areas = plant.areas6().unwrap();
        let time = areas.of(1) / areas.of(0);
        let (pid, model) = (Momi::new(&areas, 0.05 * time).unwrap().pid, Reduced::new(&areas).unwrap());
        let tfd = 0.03 * time;
        let kfd = kfd(&pid, &model, tfd);
        let flaw = |w: f64| {
            let s = Complex::new(0.0, w);
            let one = Complex::real(1.0);
            let lag = s * tfd + one;
            let left = one - (s * -model.dead_time).exp() * kfd / (lag * lag * lag);
            let law = (s * s * pid.kd + s * pid.kp + Complex::real(pid.ki)) / (s * (s * pid.tf + one));
            let response = plant.at(s) * left / (one + law * plant.at(s)) / s;
            (response.abs() * pid.ki.abs() / (1.0 - kfd)).powi(2) - 1.0
        };
        let ratio = flaw(0.04 / time) / flaw(0.02 / time);
        assert!(kfd > 0.0 && ratio > 12.0, "{plant}: {ratio}");
    }
}

#[test]
fn a_pure_dead_time_has_a_pid_and_no_estimator() {
    let design = DeMomi::new(&Areas::of_model(2.0, &[1.0], &[1.0], 3.0).unwrap(), 0.2, 0.2).unwrap();
    assert_eq!((design.model.a1, design.model.a2, design.model.dead_time), (0.0, 0.0, 3.0));
    assert!(design.estimator.is_none() && design.pid.ki > 0.0);
}

#[test]
fn what_has_no_estimator_says_so() {
    // No stable model of second order: A_2*A_0 > A_1^2 (a slow zero, so that the residence time is short).
    let dipole = parse("(1+3*s)/((1+4*s)*(1+0.5*s)*(1+0.1*s))").unwrap().areas6().unwrap();
    assert!(matches!(Reduced::new(&dipole), Err(Refusal::Plant { .. })));
    // Weakly damped: the estimator would do harm.
    let design = DeMomi::new(&areas("exp(-0.1*s)/(1+0.4*s+s^2)"), 0.02, 0.02).unwrap();
    assert!(design.estimator.is_none());
    // A large zero in the right half-plane: the nearest model is used for nothing.
    let design = DeMomi::new(&areas("(1-2*s)/(1+s)^3"), 0.2, 0.2).unwrap();
    assert!(design.model.fallback && design.estimator.is_none());
    for tfd in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = DeMomi::new(&areas("exp(-s)/(1+s)"), 0.1, tfd);
        assert!(matches!(refused, Err(Refusal::OutOfRange { parameter: "tfd", .. })));
    }
    for limit in [0.0, -1.0, f64::NAN] {
        let refused = DeMomi::with_noise_limits(&areas("exp(-s)/(1+s)"), 4.0, limit, 0.01);
        assert!(matches!(refused, Err(Refusal::OutOfRange { parameter: "kden", .. })));
    }
    let lag = Areas::of_model(1.0, &[1.0], &[1.0, 1.0], 0.0).unwrap();
    assert!(DeMomi::new(&lag, 0.1, 0.1).is_err());
}

#[test]
fn the_shortest_filter_is_one_sample() {
    let design = DeMomi::with_noise_limits(&areas("exp(-0.5*s)/(1+s)^2"), 10.0, 1e9, 0.01).unwrap();
    assert_eq!(design.estimator.unwrap().tfd, 0.01);
    assert!(design.warnings.iter().any(|w| w.to_string().starts_with("kden")));
}
