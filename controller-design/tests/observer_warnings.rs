//! What is said of a disturbance observer whose filter was slowed down.

use controller_design::Warning;
use controller_design::design::{Law, Method, ObserverFilter, Request, design};
use controller_design::model::parse;

fn values(warnings: &[Warning], name: &str) -> Vec<f64> {
    let of = |warning: &Warning| match warning {
        Warning::Value { about, value, .. } if *about == name => Some(*value),
        _ => None,
    };
    warnings.iter().filter_map(of).collect()
}

/// Wherever the filter is not that of the noise ratio asked for, that is said with the ratio there is.
#[test]
fn a_noise_ratio_that_is_not_kept_is_said() {
    let (mut slowed, mut idle) = (0, 0);
    for plant in ["exp(-s)/(1+2*s)^2", "1.98*exp(-3.2*s)/(1+80.3*s)", "1/(1+s)^4", "exp(-5*s)/(1+s)^2"] {
        for (ms_max, ts) in [(1.401, 0.1), (1.45, 0.1), (1.6, 0.3), (1.6, 0.01)] {
            let plant = parse(plant).expect("a plant");
            let asked = 10.0;
            let request = Request {
                observer_filter: ObserverFilter::NoiseRatio(asked),
                ms_max: Some(ms_max),
                ..Request::new(Method::Dob, ts)
            };
            let Ok(made) = design(&plant, &request) else { continue };
            assert!(made.ms() <= ms_max, "{plant:?}");
            let Law::Pid { pid, observer: Some(observer), .. } = &made.law else { panic!("{made:?}") };
            let ratio = made.noise.an.expect("a noise gain") / pid.kp.abs();
            let said = values(&made.warnings, "noise_ratio");
            assert_eq!(said.is_empty(), (ratio / asked - 1.0).abs() < 1e-6, "{ratio} {:?}", made.warnings);
            assert!(said.iter().all(|said| (said / ratio - 1.0).abs() < 1e-6), "{ratio} {said:?}");
            let alpha = values(&made.warnings, "alpha");
            assert!(alpha.iter().all(|said| *said == observer.alpha), "{alpha:?}");
            slowed += alpha.len();
            let is_idle =
                made.warnings.iter().any(|warning| warning.to_string().contains("hardly does anything"));
            assert_eq!(is_idle, ratio < 1.05, "{ratio} {:?}", made.warnings);
            idle += usize::from(is_idle);
        }
    }
    assert!(slowed > 0 && idle > 0, "{slowed} {idle}");
}

/// The reason is the zero where there is one.
#[test]
fn kappa_tau_names_a_slow_zero() {
    let why = |plant: &str| {
        let refusal = design(&parse(plant).expect("a plant"), &Request::new(Method::Ah, 0.01));
        refusal.expect_err(plant).to_string()
    };
    assert!(why("(1-3*s)/(1+s)^2").contains("zero in the right half-plane"));
    assert!(why("exp(-0.01*s)/(1+s)").contains("single lag"));
}

/// A rule that says itself that it is fragile is not told so twice.
#[test]
fn a_small_margin_is_said_once() {
    let plant = parse("exp(-s)/(1+2*s)^2").expect("a plant");
    for method in Method::ALL {
        if let Ok(made) = design(&plant, &Request::new(method, 0.01)) {
            let told = values(&made.warnings, "ms").len() + values(&made.warnings, "Ms").len();
            assert_eq!(told, usize::from(made.ms() > 2.0), "{method:?} {:?}", made.warnings);
        }
    }
}
