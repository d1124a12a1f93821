//! Models of first and second order: the half rule against the worked examples of Skogestad 2003.

use controller_design::model::{HalfRule, Keep, half_rule, parse};

/// What the rule makes of `plant`: gain, time constants, dead time.
fn reduced(plant: &str, keep: Keep) -> (f64, Vec<f64>, f64) {
    let plant = parse(plant).expect("a valid plant");
    match half_rule(&plant, keep, 0.0).expect("a model") {
        HalfRule::First(m) => (m.gain, vec![m.tau], m.dead_time),
        HalfRule::Second(m) => {
            let (slow, fast) = m.time_constants().expect("real poles");
            (m.gain, vec![slow, fast], m.dead_time)
        }
        HalfRule::Integrating(m) => (m.gain, vec![], m.dead_time),
        HalfRule::IntegratingLag(m, tau) => (m.gain, vec![tau], m.dead_time),
    }
}

/// Examples E1 to E6, table 2 of the paper: plant, then for one and two lags the gain, the lags (slower first) and the
/// dead time. E6 is printed with three digits.
#[test]
fn the_half_rule_gives_the_papers_models() {
    type Model<'a> = (f64, &'a [f64], f64);
    let cases: [(&str, Model<'_>, Model<'_>); 6] = [
        ("1/((1+s)*(1+0.2*s))", (1.0, &[1.1], 0.1), (1.0, &[1.0, 0.2], 0.0)),
        (
            "(1-0.3*s)*(1+0.08*s)/((1+2*s)*(1+s)*(1+0.4*s)*(1+0.2*s)*(1+0.05*s)^3)",
            (1.0, &[2.5], 1.47),
            (1.0, &[2.0, 1.2], 0.77),
        ),
        ("2*(1+15*s)/((1+20*s)*(1+s)*(1+0.1*s)^2)", (1.5, &[1.05], 0.15), (1.5, &[1.0, 0.15], 0.05)),
        ("1/(1+s)^4", (1.0, &[1.5], 2.5), (1.0, &[1.5, 1.0], 1.5)),
        ("1/((1+s)*(1+0.2*s)*(1+0.04*s)*(1+0.008*s))", (1.0, &[1.1], 0.148), (1.0, &[1.0, 0.22], 0.028)),
        ("(1+0.17*s)^2/(s*(1+s)^2*(1+0.028*s))", (1.0, &[], 1.688), (1.0, &[1.245], 0.443)),
    ];
    for (plant, one, two) in cases {
        for (keep, expected) in [(Keep::One, one), (Keep::Two, two)] {
            let (gain, taus, dead_time) = reduced(plant, keep);
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs().max(1.0);
            assert!(close(gain, expected.0) && close(dead_time, expected.2), "{plant}: {gain} {dead_time}");
            assert_eq!(taus.len(), expected.1.len(), "{plant}");
            assert!(taus.iter().zip(expected.1).all(|(a, b)| close(*a, *b)), "{plant}: {taus:?}");
        }
    }
}

#[test]
fn plants_without_real_lags_are_refused() {
    for plant in
        ["1/(1+0.2*s+s^2)", "1/(s-1)", "1/s^2", "s/(1+s)^2", "(1+0.1*s+s^2)/(1+s)^3", "(1+9*s)/(s*(1+s))"]
    {
        let plant = parse(plant).expect("a valid plant");
        for keep in [Keep::One, Keep::Two] {
            let refusal = half_rule(&plant, keep, 0.0).expect_err("no model");
            assert!(refusal.to_string().starts_with("the plant must "), "{refusal}");
        }
    }
}
