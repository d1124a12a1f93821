//! Plants as people write them, with the gain, poles, zeros and dead time worked out by hand.

use controller_design::model::{Complex, parse};

struct Case {
    text: &'static str,
    gain: f64,
    /// `(re, im)`; an entry with `im > 0` stands for the conjugate pair.
    poles: &'static [(f64, f64)],
    zeros: &'static [(f64, f64)],
    dead_time: f64,
}

const fn case(
    text: &'static str,
    gain: f64,
    poles: &'static [(f64, f64)],
    zeros: &'static [(f64, f64)],
    dead_time: f64,
) -> Case {
    Case { text, gain, poles, zeros, dead_time }
}

/// Poles of `s^2 + 0.4 s + 1`: `-0.2 +- j sqrt(0.96)`.
const DAMPED: (f64, f64) = (-0.2, 0.979_795_897_113_271_2);
/// Poles of `1 + s + s^2`: `-1/2 +- j sqrt(3)/2`.
const THIRD: (f64, f64) = (-0.5, 0.866_025_403_784_438_6);

#[rustfmt::skip]
const CASES: &[Case] = &[
    // lags, dead times
    case("1.98*exp(-3.2*s)/(1+80.3*s)", 1.98, &[(-1.0 / 80.3, 0.0)], &[], 3.2),
    case("exp(-s)/((1+s)*(1+0.5*s)^2)", 1.0, &[(-1.0, 0.0), (-2.0, 0.0), (-2.0, 0.0)], &[], 1.0),
    case("(1-0.3*s)/(1+s)^3", 1.0, &[(-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)], &[(1.0 / 0.3, 0.0)], 0.0),
    case("exp(-0.1*s)/(s*(1+0.9*s))", 1.0, &[(0.0, 0.0), (-1.0 / 0.9, 0.0)], &[], 0.1),
    case("2*exp(-3*s)", 2.0, &[], &[], 3.0),
    case("1/(s^2+0.4*s+1)", 1.0, &[DAMPED], &[], 0.0),
    case("1e-3/(0.5+2*s)", 0.002, &[(-0.25, 0.0)], &[], 0.0),
    case("exp(-s/4)", 1.0, &[], &[], 0.25),
    // numbers
    case("7", 7.0, &[], &[], 0.0),
    case("1E+2/(1+s)", 100.0, &[(-1.0, 0.0)], &[], 0.0),
    case(".5/(1.+s)", 0.5, &[(-1.0, 0.0)], &[], 0.0),
    case("2.5e-1/(1+4e0*s)", 0.25, &[(-0.25, 0.0)], &[], 0.0),
    case("007/(1+s)", 7.0, &[(-1.0, 0.0)], &[], 0.0),
    case("  3 /\t( 1 +\n2 * s ) ", 3.0, &[(-0.5, 0.0)], &[], 0.0),
    // normalisation
    case("2/(3+6*s)", 2.0 / 3.0, &[(-0.5, 0.0)], &[], 0.0),
    case("6*(1-0.3*s)/(2+s)^3", 0.75, &[(-2.0, 0.0), (-2.0, 0.0), (-2.0, 0.0)], &[(1.0 / 0.3, 0.0)], 0.0),
    case("1/(s-1)", -1.0, &[(1.0, 0.0)], &[], 0.0),
    case("1/(4*s^2)", 0.25, &[(0.0, 0.0), (0.0, 0.0)], &[], 0.0),
    case("(2*s+4)/(s+8)", 0.5, &[(-8.0, 0.0)], &[(-2.0, 0.0)], 0.0),
    // precedence and signs
    case("-2/(1+s)", -2.0, &[(-1.0, 0.0)], &[], 0.0),
    case("-2^2/(1+s)", -4.0, &[(-1.0, 0.0)], &[], 0.0),
    case("(-2)^2/(1+s)", 4.0, &[(-1.0, 0.0)], &[], 0.0),
    case("--3/(1+s)", 3.0, &[(-1.0, 0.0)], &[], 0.0),
    case("+3/(1- -s)", 3.0, &[(-1.0, 0.0)], &[], 0.0),
    case("8/4/2/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 0.0),
    case("8/(4/2)/(1+s)", 4.0, &[(-1.0, 0.0)], &[], 0.0),
    case("5-2-1", 2.0, &[], &[], 0.0),
    case("2^3^2/(1+s)", 512.0, &[(-1.0, 0.0)], &[], 0.0),
    case("2^-1/(1+s)", 0.5, &[(-1.0, 0.0)], &[], 0.0),
    case("(1+s)^-2", 1.0, &[(-1.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    case("(1+s)^(1-3)", 1.0, &[(-1.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    case("3*(1+s)^0/(1+2*s)", 3.0, &[(-0.5, 0.0)], &[], 0.0),
    case("3*s^-1", 3.0, &[(0.0, 0.0)], &[], 0.0),
    case("2*-1/(1+s)", -2.0, &[(-1.0, 0.0)], &[], 0.0),
    case("(((2)))/((1+(s)))", 2.0, &[(-1.0, 0.0)], &[], 0.0),
    // dead times
    case("exp(-(0.2+0.3)*s)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 0.5),
    case("exp(-3.2*s+0*s)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 3.2),
    case("exp(-s*2)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 2.0),
    case("exp(-0*s)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 0.0),
    case("exp(-2*s^2/s)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 2.0),
    case("exp(-s)^3/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 3.0),
    case("exp(-s)*exp(-2*s)/exp(-0.5*s)/(1+s)", 1.0, &[(-1.0, 0.0)], &[], 2.5),
    case("1/(1+s)*exp(-s)", 1.0, &[(-1.0, 0.0)], &[], 1.0),
    case("exp(-s)/(1+s)+2*exp(-s)/(1+s)", 3.0, &[(-1.0, 0.0)], &[], 1.0),
    case("exp(-0.3*s)/(1+s)+exp(-(0.1+0.2)*s)/(1+s)", 2.0, &[(-1.0, 0.0)], &[], 0.3),
    // poles and zeros at s = 0
    case("s/(s*(1+s))", 1.0, &[(-1.0, 0.0)], &[], 0.0),
    case("s^2/(s^3*(1+s))", 1.0, &[(0.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    case("s/(1+s)^2", 1.0, &[(-1.0, 0.0), (-1.0, 0.0)], &[(0.0, 0.0)], 0.0),
    case("1/(s+s^2)", 1.0, &[(0.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    case("1/(2*s+4*s^2+2*s^3)", 0.5, &[(0.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    // sums: 1+1/(2s) = (1+2s)/(2s); 1/(1+s)+1/(1+2s) = (2+3s)/..; 1/(1+s)+1/(1+s)^2 = (2+s)/(1+s)^2
    case("1+1/(2*s)", 0.5, &[(0.0, 0.0)], &[(-0.5, 0.0)], 0.0),
    case("1/(1+s)+1/(1+2*s)", 2.0, &[(-1.0, 0.0), (-0.5, 0.0)], &[(-2.0 / 3.0, 0.0)], 0.0),
    case("1/(1+s)+1/(1+s)^2", 2.0, &[(-1.0, 0.0), (-1.0, 0.0)], &[(-2.0, 0.0)], 0.0),
    case("1/(1+s)-1/(1+2*s)", 1.0, &[(-1.0, 0.0), (-0.5, 0.0)], &[(0.0, 0.0)], 0.0),
    case("1/(1+0.1*s^2+0.2*s^2-0.3*s^2+s)", 1.0, &[(-1.0, 0.0)], &[], 0.0),
    case("(1+s)^2/(1+s)^3", 1.0, &[(-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)], &[(-1.0, 0.0), (-1.0, 0.0)], 0.0),
    // written out: 1+6s+11s^2+6s^3 = (1+s)(1+2s)(1+3s); 1+2s+2s^2+s^3 = (1+s)(1+s+s^2);
    // 1+4s^4 = (1+2s+2s^2)(1-2s+2s^2), its roots (+-1+-j)/2
    case("1/(1+6*s+11*s^2+6*s^3)", 1.0, &[(-1.0, 0.0), (-0.5, 0.0), (-1.0 / 3.0, 0.0)], &[], 0.0),
    case("1/(1+2*s+2*s^2+s^3)", 1.0, &[(-1.0, 0.0), THIRD], &[], 0.0),
    case("1/(1+4*s+6*s^2+4*s^3+s^4)", 1.0, &[(-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)], &[], 0.0),
    case("1/(1+4*s^4)", 1.0, &[(-0.5, 0.5), (0.5, 0.5)], &[], 0.0),
    case("1/(1+2*s+3*s^2+2*s^3+s^4)", 1.0, &[THIRD, THIRD], &[], 0.0),
    case("1/(1+s^2)", 1.0, &[(0.0, 1.0)], &[], 0.0),
    case("1/((1+3*s+3*s^2+s^3)*(1+s))", 1.0, &[(-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)], &[], 0.0),
];

fn listed(entries: &[(f64, f64)]) -> Vec<Complex> {
    let both = |&(re, im): &(f64, f64)| {
        let upper = Complex::new(re, im);
        if im == 0.0 { vec![upper] } else { vec![upper, upper.conj()] }
    };
    entries.iter().flat_map(both).collect()
}

/// Each expected value has a partner of its own within `tolerance` (relative).
fn assert_same(what: &str, text: &str, mut found: Vec<Complex>, expected: &[(f64, f64)], tolerance: f64) {
    let expected = listed(expected);
    assert_eq!(found.len(), expected.len(), "{what} of {text}: {found:?}");
    for e in expected {
        let near = found.iter().position(|f| (*f - e).abs() <= tolerance * e.abs());
        let Some(k) = near else { panic!("{what} of {text}: {e} not among {found:?}") };
        found.remove(k);
    }
}

#[test]
fn plants_mean_what_they_say() {
    for Case { text, gain, poles, zeros, dead_time } in CASES {
        let g = parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert!((g.gain() - gain).abs() <= 1e-15 * gain.abs(), "gain of {text}: {}", g.gain());
        assert!(
            (g.dead_time() - dead_time).abs() <= 1e-15 * dead_time,
            "dead time of {text}: {}",
            g.dead_time()
        );
        // 20 eps: the quoted roots are rounded, and those of written-out polynomials are found by iteration.
        assert_same("poles", text, g.poles(), poles, 20.0 * f64::EPSILON);
        assert_same("zeros", text, g.zeros(), zeros, 20.0 * f64::EPSILON);
        assert_eq!(g.order(), listed(poles).len(), "order of {text}");
        assert_eq!(g.relative_degree(), listed(poles).len() - listed(zeros).len(), "{text}");
    }
}

#[test]
fn the_fifth_example_of_the_documentation_has_the_poles_of_its_denominator() {
    let g = parse("5*(1+0.2*s)/(1+3.2*s+3.6*s^2+1.6*s^3)").expect("a valid plant");
    assert_eq!((g.gain(), g.order(), g.dead_time()), (5.0, 3, 0.0));
    assert_eq!(g.zeros(), [Complex::real(-5.0)]);
    for p in g.poles() {
        // The denominator, term by term, at a computed pole; the sizes of the terms add up to about 5.
        let rest = Complex::ONE + p * 3.2 + p * p * 3.6 + p * p * p * 1.6;
        assert!(rest.abs() < 5e-15, "{p}: {rest}");
    }
}

#[test]
fn factors_are_kept_exactly() {
    let g = parse("(1+s)^3/((1+s)^4*(1+0.3*s+0.2*s^2)*(2+2*s))").expect("a valid plant");
    assert!(g.num().iter().all(|p| p.coefficients() == [1.0, 1.0]) && g.num().len() == 3);
    let den: Vec<&[f64]> = g.den().iter().map(|p| p.coefficients()).collect();
    let lag: &[f64] = &[1.0, 1.0];
    assert_eq!(den, [lag, lag, lag, lag, &[1.0, 0.3, 0.2], lag]);
    // A common factor of the two terms of a sum stays a factor.
    let g = parse("(1+s)^2/(1+2*s)^5 + 3*s*(1+s)^2/(1+2*s)^4").expect("a valid plant");
    assert_eq!(g.to_string(), "(1+s)^2*(1+3*s+6*s^2)/(1+2*s)^5");
}

#[test]
fn coefficients_of_a_written_out_sum_are_those_written() {
    // 1/0.3*0.3 and the like must not come in, in whatever order the terms stand.
    for text in ["1/(s^3+0.7*s^2+0.3*s+1)", "1/(1+0.3*s+0.7*s^2+s^3)", "1/(0.3*s+s^3+1+0.7*s^2)"] {
        let g = parse(text).expect("a valid plant");
        assert_eq!(g.den()[0].coefficients(), [1.0, 0.3, 0.7, 1.0], "{text}");
    }
}

#[test]
fn the_limits_themselves_are_allowed() {
    assert_eq!(parse("1/(1+s)^20").map(|g| g.order()), Ok(20));
    let nested = format!("{}s{}", "(".repeat(60), ")".repeat(60));
    assert_eq!(parse(&format!("1/{nested}")).map(|g| g.integrators()), Ok(1));
    let signs = "-".repeat(4000);
    assert_eq!(parse(&format!("{signs}1/(1+s)")).map(|g| g.gain()), Ok(1.0));
    let long = format!("{}1/(1+s)", "0+".repeat(2044));
    assert_eq!((long.len(), parse(&long).map(|g| g.gain())), (4095, Ok(1.0)));
}
