//! Transfer functions from numbers, and their conversion to the plant model of the run-time blocks.

use controller_core::plant_model::{Factor, MAX_ORDER, PlantModel};
use controller_design::model::{Complex, ModelError, Polynomial, TransferFunction, parse};

fn model(text: &str) -> Result<PlantModel, ModelError> {
    parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")).to_plant_model()
}

#[test]
fn factors_go_over_as_they_are() {
    let m = model("2*(1-0.3*s)*exp(-0.1*s)/(s*(1+s)^2*(1+0.4*s+s^2))").expect("a stable plant");
    assert_eq!((m.gain, m.integrators, m.dead_time), (2.0, 1, 0.1));
    assert_eq!(m.poles, [Factor::first(1.0), Factor::first(1.0), Factor::second(0.4, 1.0)]);
    assert_eq!(m.zeros, [Factor::first(-0.3)]);
    assert_eq!(model("1/(1+3*s+2*s^2)").expect("stable").poles, [Factor::second(3.0, 2.0)]);
    assert_eq!(model("exp(-s)/(1+1.2*s+0.2*s^2)"), Ok(PlantModel::second_order(1.0, 1.2, 0.2, 1.0)));
    assert_eq!(model("0.5*exp(-2*s)/s"), Ok(PlantModel::integrating(0.5, 2.0)));
}

#[test]
fn written_out_polynomials_are_split() {
    // (1+s)(1+2s)(1+3s)
    let m = model("1/(1+6*s+11*s^2+6*s^3)").expect("a stable plant");
    for (factor, time) in m.poles.iter().zip([3.0, 2.0, 1.0]) {
        assert!(factor.a2 == 0.0 && (factor.a1 - time).abs() < 1e-14, "{factor:?}");
    }
    // (1+s)^8, recognised as such
    let p = (0..8).fold(Polynomial::constant(1.0), |p, _| &p * &Polynomial::new([1.0, 1.0]));
    let m = model(&format!("1/({p})")).expect("a stable plant");
    assert_eq!(m.poles, [Factor::first(1.0); 8]);
    // (1-s)(1+s+s^2) in the numerator
    let m = model("(1-s^3)/(1+s)^4").expect("a stable plant");
    assert_eq!(m.zeros.len(), 2);
}

#[test]
fn what_the_blocks_cannot_take_is_refused_by_name() {
    let unstable = |re: f64, im: f64| Err(ModelError::Unstable { pole: Complex::new(re, im) });
    assert_eq!(model("2*exp(-s)"), Err(ModelError::StaticGain));
    assert_eq!(model("1/(1+s)^9"), Err(ModelError::OrderTooHigh { order: 9, max: MAX_ORDER }));
    assert_eq!(model("1/(s*(1+s)^8)"), Err(ModelError::OrderTooHigh { order: 9, max: MAX_ORDER }));
    assert_eq!(model("s^2/(1+s)^3"), Err(ModelError::ZeroAtOrigin { count: 2 }));
    assert_eq!(model("1/(s-2)"), unstable(2.0, 0.0));
    assert_eq!(model("1/((1+s)*(1-s)*(1-2*s))"), unstable(1.0, 0.0));
    assert_eq!(model("1/(1+4*s^2)"), unstable(0.0, 0.5));
    // (1+s)(1+s^2) written out: the pair is on the axis although it is found by iteration.
    assert_eq!(model("1/(1+s+s^2+s^3)"), unstable(0.0, 1.0));
    // s^2 - s - 2 = (s-2)(s+1)
    assert_eq!(model("1/(s^2-s-2)"), unstable(2.0, 0.0));
    let text = |e: Result<PlantModel, ModelError>| e.expect_err("refused").to_string();
    assert!(text(model("1/(s-2)")).starts_with("the pole at s = 2 is not stable"));
    assert!(text(model("1/(1+s)^9")).contains("order is 9; allowed are at most 8"));
    assert!(text(model("s/(1+s)")).starts_with("1 zero at s = 0"));
}

#[test]
fn constructors_refuse_what_is_no_plant() {
    use TransferFunction as G;
    let at = |what| move |value| Err(ModelError::NotFinite { what, value });
    assert_eq!(G::first_order(0.0, 1.0, 0.0), Err(ModelError::ZeroGain));
    assert_eq!(G::first_order(f64::INFINITY, 1.0, 0.0), at("the gain")(f64::INFINITY));
    assert_eq!(G::first_order(1.0, f64::INFINITY, 0.0), at("tau")(f64::INFINITY));
    assert_eq!(G::second_order(1.0, f64::INFINITY, 1.0, 0.0), at("a1")(f64::INFINITY));
    assert_eq!(G::second_order(1.0, 1.0, f64::INFINITY, 0.0), at("a2")(f64::INFINITY));
    assert_eq!(G::integrating(1.0, f64::INFINITY), at("the dead time")(f64::INFINITY));
    assert!(matches!(G::integrating(f64::NAN, 0.0), Err(ModelError::NotFinite { .. })));
    assert_eq!(G::integrating(1.0, -1.0), Err(ModelError::NegativeDeadTime { dead_time: -1.0 }));
    let (s, one, none) = (Polynomial::monomial(1.0, 1), Polynomial::constant(1.0), Polynomial::default());
    assert_eq!(G::from_polynomials(&s, &one, 0.0), Err(ModelError::Improper { zeros: 1, poles: 0 }));
    assert_eq!(G::from_polynomials(&one, &none, 0.0), Err(ModelError::ZeroDenominator));
    assert_eq!(G::from_polynomials(&none, &s, 0.0), Err(ModelError::ZeroGain));
    let high = Polynomial::new([1.0; 22]);
    assert_eq!(G::from_polynomials(&one, &high, 0.0), Err(ModelError::OrderTooHigh { order: 21, max: 20 }));
    let wide = Polynomial::new([1e-300, 1e300]);
    assert_eq!(G::from_polynomials(&one, &wide, 0.0), Err(ModelError::OutOfRange));
    assert!(G::from_polynomials(&one, &Polynomial::new([1.0, f64::NAN]), 0.0).is_err());
}

#[test]
fn constructors_agree_with_expressions() {
    use TransferFunction as G;
    assert_eq!(G::first_order(2.0, 3.0, 0.5).ok(), parse("2*exp(-0.5*s)/(1+3*s)").ok());
    assert_eq!(G::second_order(2.0, 3.0, 4.0, 0.0).ok(), parse("2/(1+3*s+4*s^2)").ok());
    assert_eq!(G::integrating(2.0, 1.0).ok(), parse("2*exp(-s)/s").ok());
    assert_eq!(G::first_order(2.0, 0.0, 1.0).ok(), parse("2*exp(-s)").ok());
}

#[test]
fn the_canonical_expression() {
    for (text, canonical) in [
        ("exp(-s/4)", "exp(-0.25*s)"),
        ("-1/(s+1)", "-1/(1+s)"),
        ("-(1+s)/(1+2*s)^2", "-(1+s)/(1+2*s)^2"),
        ("-exp(-s)", "-exp(-s)"),
        ("1/s^3", "1/s^3"),
        ("s*s/(1+s)^2/(1+s)", "s^2/(1+s)^3"),
        ("1e-9/(1+1e12*s)", "1e-9/(1+1e12*s)"),
        ("3*(1-s)/(s*(2+s^2))", "1.5*(1-s)/(s*(1+0.5*s^2))"),
    ] {
        assert_eq!(parse(text).map(|g| g.to_string()).as_deref(), Ok(canonical));
    }
}

#[test]
fn values_at_the_edges() {
    let g = parse("exp(-2*s)/(s*(1+s))").expect("a valid plant");
    assert!(!g.at(Complex::ZERO).is_finite() && !g.at(Complex::real(-1.0)).is_finite());
    // Far in the left half-plane the dead time outgrows everything: exp(2*50)/(50*49) at s = -50.
    let value = g.at(Complex::real(-50.0));
    assert!((value.re / (100f64.exp() / 2450.0) - 1.0).abs() < 1e-13 && value.im == 0.0);
    let bode = parse("2/(1+s)").expect("a valid plant").at(Complex::new(0.0, 1.0));
    assert!((bode - Complex::new(1.0, -1.0)).abs() < 1e-15);
}
