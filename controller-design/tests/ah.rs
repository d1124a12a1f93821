//! The kappa-tau rule against Table 5 of Vrančić & Huba 2021 and against its own aim, and the tangent it needs.

mod sensitivity;

use controller_design::model::parse;
use controller_design::rules::ah::{AhMs, AhPid};
use controller_design::rules::inflexion::Inflexion;
use sensitivity::ms;

#[test]
fn table_5_comes_out() {
    for (plant, unrounded, printed, units) in [
        (
            "1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))",
            [21.354_516_19, 53.047_898_1, 2.215_752_104, 0.238_483_239_3],
            [21.35, 53.05, 2.22, 0.24],
            [0.01, 0.01, 0.01, 0.01],
        ),
        (
            "exp(-5*s)/(1+s)^3",
            [0.521_879_062_1, 0.136_150_950_8, 0.520_558_730_5, 0.362_193_871_4],
            [0.52, 0.136, 0.52, 0.36],
            [0.01, 0.001, 0.01, 0.01],
        ),
    ] {
        let pid = AhPid::of_plant(&parse(plant).unwrap(), AhMs::Ms20).unwrap().pid;
        for (k, ours) in [pid.kp, pid.ki, pid.kd, pid.b].into_iter().enumerate() {
            assert!((ours - printed[k]).abs() <= 0.501 * units[k], "{plant}: {ours}");
            assert!((ours / unrounded[k] - 1.0).abs() < 1e-6, "{plant}: {ours}, expected {}", unrounded[k]);
        }
        assert_eq!(pid.c, 0.0);
    }
}

/// `n` equal lags are steepest at `n - 1`: value and slope are those of a gamma distribution.
#[test]
fn tangents_of_equal_lags_are_exact() {
    for (gain, unit, delay) in [(1.0, 1.0, 0.0), (-3e6, 1e-6, 2e-6), (0.2, 1e6, 3e5)] {
        for n in 2..=9_i32 {
            let (gain, unit, delay): (f64, f64, f64) = (gain, unit, delay);
            let plant = parse(&format!("{gain:e}*exp(-{delay:e}*s)/(1+{unit:e}*s)^{n}")).unwrap();
            let tangent = Inflexion::of(&plant).unwrap();
            let time = f64::from(n - 1);
            let (mut term, mut sum) = (libm::exp(-time), 0.0);
            for k in 1..n {
                sum += term;
                term *= time / f64::from(k);
            }
            // `term` is now the slope.
            let value = 1.0 - sum - term;
            assert!((tangent.slope * unit / term - 1.0).abs() < 1e-7, "{n}: {tangent:?}");
            assert!((tangent.value / value - 1.0).abs() < 1e-4, "{n}: {tangent:?}, {value}");
            let dead_time = delay + unit * (time - value / term);
            assert!((tangent.dead_time() / dead_time - 1.0).abs() < 1e-7, "{n}: {}", tangent.dead_time());
        }
    }
}

/// Two different lags: closed form; the faster one up to a million times.
#[test]
fn tangents_of_two_lags_are_exact() {
    for fast in [0.9, 0.3, 1e-2, 1e-4, 1e-6] {
        let plant = parse(&format!("1/((1+s)*(1+{fast:e}*s))")).unwrap();
        let time = fast * libm::log(fast) / (fast - 1.0);
        let slope = (libm::exp(-time) - libm::exp(-time / fast)) / (1.0 - fast);
        let value = 1.0 - (libm::exp(-time) - fast * libm::exp(-time / fast)) / (1.0 - fast);
        let tangent = Inflexion::of(&plant).unwrap();
        assert!((tangent.slope / slope - 1.0).abs() < 1e-7, "{fast}: {tangent:?}, {slope}");
        let (ours, exact) = (tangent.dead_time(), time - value / slope);
        assert!((ours / exact - 1.0).abs() < 1e-4, "{fast}: {ours}, {exact}");
    }
}

/// A response that is steepest at its beginning has no dead time but its own.
#[test]
fn first_order_responses_begin_steepest() {
    let tangent = Inflexion::of(&parse("2*exp(-0.5*s)/(1+3*s)").unwrap()).unwrap();
    assert_eq!((tangent.time, tangent.value, tangent.dead_time()), (0.5, 0.0, 0.5));
    assert!((tangent.slope - 1.0 / 3.0).abs() < 1e-7);
    assert!(AhPid::of_plant(&parse("2/(1+3*s)").unwrap(), AhMs::Ms14).is_err());
}

/// Plants of the kind the rule was made for: the wanted `Ms` comes out roughly, as a rule of two numbers can.
#[test]
fn the_wanted_robustness_comes_out() {
    for n in 3..=8 {
        let plant = parse(&format!("1/(1+s)^{n}")).unwrap();
        let calm = ms(&AhPid::of_plant(&plant, AhMs::Ms14).unwrap().pid, &plant, 1.0);
        let fast = ms(&AhPid::of_plant(&plant, AhMs::Ms20).unwrap().pid, &plant, 1.0);
        assert!((1.3..1.6).contains(&calm) && (1.7..2.6).contains(&fast), "{n}: {calm} {fast}");
    }
}

#[test]
fn derivatives_too_large_for_a_lag_are_told() {
    let told = |share: f64| {
        let warnings = AhPid::new(1.0, 1.0 - share, share, AhMs::Ms20).unwrap().warnings;
        warnings.iter().any(|w| w.to_string().contains("first order"))
    };
    assert!(told(0.02) && told(0.1) && told(0.2) && !told(0.6));
    for (gain, tau, dead_time) in [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1.0, f64::NAN, 1.0)] {
        assert!(AhPid::new(gain, tau, dead_time, AhMs::Ms14).is_err());
    }
    let pid = AhPid::new(-2.0, 1.0, 1.0, AhMs::Ms14).unwrap().pid;
    assert!(pid.kp < 0.0 && pid.ki < 0.0 && pid.kd < 0.0 && pid.b > 0.0 && pid.tf > 0.0);
    for plant in ["1/s", "(1+s)/(1+2*s)", "(1+5*s)/((1+s)*(1+2*s))"] {
        assert!(Inflexion::of(&parse(plant).unwrap()).is_err(), "{plant}");
    }
}

/// As a method the rule keeps to plants like those it was fitted to; on a truly first-order plant with a short dead time it
/// would give an `Ms` of 2.3 to 18, or none.
#[test]
fn the_method_refuses_what_the_rule_does_not_fit() {
    use controller_design::design::{Law, Method, Request, design};
    let ask = |plant: &str, ms: f64| {
        design(&parse(plant).unwrap(), &Request { ms: Some(ms), ..Request::new(Method::Ah, 1e-3) })
    };
    for wanted in [1.4, 2.0] {
        for plant in ["exp(-0.1*s)/(1+s)", "exp(-0.3*s)/(1+s)", "1/(1+0.8*s+s^2)", "1/(1+0.1*s+s^2)"] {
            assert!(ask(plant, wanted).is_err(), "{plant}");
        }
        for plant in [
            "exp(-0.6*s)/(1+s)",
            "1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))",
            "exp(-5*s)/(1+s)^3",
            "(1-s)/(1+s)^3",
        ] {
            let made = ask(plant, wanted).unwrap();
            let rule = if wanted < 1.5 { AhMs::Ms14 } else { AhMs::Ms20 };
            let own = AhPid::of_plant(&parse(plant).unwrap(), rule).unwrap().pid;
            assert!(matches!(made.law, Law::Pid { pid, .. } if pid.kp == own.kp && pid.kd == own.kd));
            assert!(made.robustness.ms <= 1.5 * wanted, "{plant}: {}", made.robustness.ms);
        }
    }
}
