//! Zero-order-hold equivalents against 400-digit arithmetic (`golden/make_hold.py`), closed forms, and what is refused.

use controller_design::Refusal;
use controller_design::hold::HoldEquivalent;
use controller_design::model::{Complex, parse};

/// What is promised, relative to the value itself at every frequency.
const TOLERANCE: f64 = 1e-9;

#[test]
fn responses_agree_with_many_digits() {
    let mut worst = 0.0_f64;
    let mut count = 0;
    for line in include_str!("golden/hold.csv").lines().skip(2) {
        let mut cells = line.split(',');
        let plant = parse(cells.next().expect("a plant")).expect("a valid plant");
        let mut number = || cells.next().expect("a cell").parse::<f64>().expect("a number");
        let (ts, latency, theta) = (number(), number(), number());
        let exact = Complex::new(number(), number());
        let value = HoldEquivalent::new(&plant, ts, latency).expect("in range").at(theta);
        let error = (value - exact).abs() / exact.abs();
        if error > 1e-12 {
            println!("{error:.1e} at {theta}: ts {ts:e} latency {latency} {plant}");
        }
        assert!(error <= TOLERANCE, "{error:e} at {theta}: ts {ts:e} latency {latency} {plant}");
        worst = worst.max(error);
        count += 1;
    }
    assert!(count > 500);
    println!("worst of {count}: {worst:.1e}");
}

/// `1/(1+tau*s)`: `(1-q)/(z-q)`; the delay of a fraction divides `1-q` exactly.
#[test]
fn a_lag_has_its_closed_form() {
    for (tau, ts, fraction) in [(1.0, 1e-6, 0.25), (1.0, 0.1, 0.5), (0.02, 1.0, 0.9), (1e6, 1e4, 0.0)] {
        let plant = parse(&format!("exp(-{}*s)/(1+{tau}*s)", fraction * ts)).expect("a plant");
        let held = HoldEquivalent::new(&plant, ts, 0.0).expect("in range");
        for theta in [1e-5, 0.1, 1.5, 3.0] {
            let h = ts / tau;
            let z = Complex::new(libm::cos(theta), libm::sin(theta));
            let after = -libm::expm1(-h * (1.0 - fraction));
            let before = -libm::expm1(-h) - after;
            let half = libm::sin(theta / 2.0);
            let z_less_q = Complex::new(-2.0 * half * half - libm::expm1(-h), libm::sin(theta));
            let exact = (Complex::real(after) + Complex::real(before) / z) / z_less_q;
            assert!((held.at(theta) - exact).abs() <= 1e-11 * exact.abs(), "{tau} {ts} {theta}");
        }
    }
}

#[test]
fn requests_out_of_range_are_refused() {
    let plant = parse("exp(-s)/(1+s)").expect("a plant");
    for ts in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-10, 1e10] {
        assert!(matches!(
            HoldEquivalent::new(&plant, ts, 0.0),
            Err(Refusal::OutOfRange { parameter: "ts", .. })
        ));
    }
    for latency in [-1e-9, f64::NAN, f64::INFINITY, 2e7] {
        assert!(matches!(
            HoldEquivalent::new(&plant, 1.0, latency),
            Err(Refusal::OutOfRange { parameter: "latency", .. })
        ));
    }
    assert!(HoldEquivalent::new(&plant, 1e-8, 0.0).is_err(), "too many samples of dead time");
    let runaway = parse("1/(1-1e-6*s)").expect("a plant");
    assert!(matches!(HoldEquivalent::new(&runaway, 1.0, 0.0), Err(Refusal::Plant { .. })));
}
