//! Properties over random texts and random plants.

use controller_design::model::{Complex, MAX_LENGTH, Polynomial, TransferFunction, parse};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// Errors keep their promises: inside the text, on character boundaries, in order.
fn assert_sound(text: &str) -> Result<(), TestCaseError> {
    if let Err(errors) = parse(text) {
        prop_assert!(!errors.is_empty());
        for e in &errors {
            prop_assert!(e.span.start <= e.span.end && e.span.end <= text.len(), "{e:?}");
            prop_assert!(text.get(e.span.clone()).is_some(), "{e:?}");
            prop_assert!(text.is_empty() || !e.span.is_empty(), "{e:?}");
            prop_assert!(!e.message.is_empty());
        }
        prop_assert!(errors.is_sorted_by_key(|e| e.span.start));
    }
    Ok(())
}

const PIECES: &[&str] = &[
    "s",
    "1",
    "0",
    "2.5",
    "1e-3",
    "1e300",
    "exp",
    "exp(-s)",
    "(",
    ")",
    "+",
    "-",
    "*",
    "/",
    "^",
    "^2",
    "^-1",
    "^20",
    ",",
    "0,5",
    " ",
    "S",
    "e",
    "=",
    "\u{b2}",
    "\u{b7}",
    "\u{2212}",
    "\u{3c4}",
    "1.2.3",
    "1e",
    "**",
    "(1+s)",
    "s^3",
    "\u{1f600}",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_unicode_text_panics(text in any::<String>()) {
        assert_sound(&text)?;
    }

    #[test]
    fn no_ascii_text_panics(text in "[ -~\t\n]{0,60}") {
        assert_sound(&text)?;
    }

    #[test]
    fn no_heap_of_fragments_panics(pieces in vec(select(PIECES), 0..30)) {
        assert_sound(&pieces.concat())?;
    }

    /// Whatever is read prints as an expression that is read as the same function.
    #[test]
    fn what_is_read_prints_and_reads_back(pieces in vec(select(PIECES), 1..12)) {
        if let Ok(g) = parse(&pieces.concat()) {
            prop_assert_eq!(parse(&g.to_string()), Ok(g));
        }
    }
}

/// A plant by its factors `1 + a1*s + a2*s^2`, in this file's own arithmetic.
#[derive(Debug, Clone)]
struct Plant {
    gain: f64,
    integrators: usize,
    num: Vec<[f64; 2]>,
    den: Vec<[f64; 2]>,
    dead_time: f64,
}

fn number() -> impl Strategy<Value = f64> {
    (-4.0..4.0_f64, any::<bool>()).prop_map(|(x, plus)| if plus { 10f64.powf(x) } else { -(10f64.powf(x)) })
}

fn factors(max: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    vec((number(), prop_oneof![Just(0.0), number()]).prop_map(|(a, b)| [a, b]), 0..=max)
}

fn plant() -> impl Strategy<Value = Plant> {
    let dead_time = prop_oneof![Just(0.0), 0.0..5.0];
    // Up to two quadratics above up to four below plus integrators; improper ones are left out.
    (number(), 0..3_usize, factors(2), factors(4), dead_time)
        .prop_map(|(gain, integrators, num, den, dead_time)| Plant { gain, integrators, num, den, dead_time })
        .prop_filter("proper", |p| degree(&p.num) <= p.integrators + degree(&p.den))
}

fn degree(list: &[[f64; 2]]) -> usize {
    list.iter().map(|f| if f[1] == 0.0 { 1 } else { 2 }).sum()
}

impl Plant {
    fn text(&self) -> String {
        let mut text = format!("({:e})*exp(-{:e}*s)", self.gain, self.dead_time);
        for f in &self.num {
            text += &format!("*(1+({:e})*s+({:e})*s^2)", f[0], f[1]);
        }
        text += &format!("/s^{}", self.integrators);
        for f in &self.den {
            // Written the other way round and not normalised: a common factor of 2 is exact.
            text += &format!("*2/(({:e})*s^2+({:e})*s+2)", 2.0 * f[1], 2.0 * f[0]);
        }
        text
    }

    /// `(re, im)` of the value at `x + j*w`, with the standard library only. In the logarithm, as modulus and
    /// angle, so that nothing is shared with the code under test.
    fn at(&self, x: f64, w: f64) -> (f64, f64) {
        let polar = |re: f64, im: f64| (re.hypot(im).ln(), im.atan2(re));
        let of = |f: &[f64; 2]| polar(1.0 + f[0] * x + f[1] * (x * x - w * w), f[0] * w + f[1] * 2.0 * x * w);
        let (mut log, mut angle) = polar(self.gain, 0.0);
        for f in &self.num {
            (log, angle) = (log + of(f).0, angle + of(f).1);
        }
        for f in &self.den {
            (log, angle) = (log - of(f).0, angle - of(f).1);
        }
        let s = polar(x, w);
        log -= self.integrators as f64 * s.0 + self.dead_time * x;
        angle -= self.integrators as f64 * s.1 + self.dead_time * w;
        (log.exp() * angle.cos(), log.exp() * angle.sin())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn values_are_those_of_the_factors(plant in plant(), x in -3.0..3.0_f64, w in 0.01..10.0_f64) {
        let g = parse(&plant.text()).expect("a valid plant");
        let (re, im) = plant.at(x, w);
        let value = g.at(Complex::new(x, w));
        // Each factor loses what cancels in it; the logarithm, of size up to 100, loses 100 eps.
        let lost: f64 = plant.num.iter().chain(&plant.den).map(|f| {
            let s = x.hypot(w);
            let sum = (1.0 + f[0] * x + f[1] * (x * x - w * w)).hypot(f[0] * w + f[1] * 2.0 * x * w);
            (1.0 + f[0].abs() * s + f[1].abs() * s * s) / sum
        }).sum();
        let allowed = (8.0 * lost + 500.0) * f64::EPSILON * re.hypot(im);
        prop_assert!((value.re - re).hypot(value.im - im) <= allowed, "{g}: {value} and {re}, {im}");
    }

    #[test]
    fn printed_functions_read_back_equal(plant in plant()) {
        let g = parse(&plant.text()).expect("a valid plant");
        prop_assert_eq!(parse(&g.to_string()), Ok(g));
    }

    /// The factored function and the one given by its written-out polynomials have the same values.
    #[test]
    fn written_out_polynomials_have_the_same_values(plant in plant(), w in 0.01..10.0_f64) {
        let g = parse(&plant.text()).expect("a valid plant");
        let (num, den) = (g.num_polynomial(), g.den_polynomial());
        let h = TransferFunction::from_polynomials(&num, &den, g.dead_time()).expect("proper");
        let s = Complex::new(0.0, w);
        let size = |p: &Polynomial| Polynomial::new(p.coefficients().iter().map(|c| c.abs()).collect::<Vec<_>>()).at_real(w);
        let lost = size(&num) / num.at(s).abs() + size(&den) / den.at(s).abs();
        prop_assert!((g.at(s) - h.at(s)).abs() <= 40.0 * f64::EPSILON * lost * g.at(s).abs());
    }

    /// The longest expression a function can print is still read.
    #[test]
    fn large_functions_print_within_the_limit(num in vec(number(), 21), den in vec(number(), 21)) {
        let long = |c: Vec<f64>| Polynomial::new(c.into_iter().map(|c| c * 1.234567890123456e-100).collect::<Vec<_>>());
        let g = TransferFunction::from_polynomials(&long(num), &long(den), 1.234567890123456e-5).expect("proper");
        let text = g.to_string();
        prop_assert!(text.len() <= MAX_LENGTH, "{}", text.len());
        prop_assert_eq!(parse(&text), Ok(g));
    }
}

/// Sums, products, quotients and powers of positive terms: at a positive real `s` nothing cancels, so the value is
/// exact to rounding whatever is expanded on the way.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    S,
    Add(Box<Tree>, Box<Tree>),
    Mul(Box<Tree>, Box<Tree>),
    Div(Box<Tree>, Box<Tree>),
    Pow(Box<Tree>, i32),
}

impl Tree {
    fn text(&self) -> String {
        match self {
            Self::Number(x) => format!("{x}"),
            Self::S => "s".into(),
            Self::Add(a, b) => format!("({}+{})", a.text(), b.text()),
            Self::Mul(a, b) => format!("{}*{}", a.text(), b.text()),
            Self::Div(a, b) => format!("{}/({})", a.text(), b.text()),
            Self::Pow(a, n) => format!("({})^{n}", a.text()),
        }
    }

    fn at(&self, s: f64) -> f64 {
        match self {
            Self::Number(x) => *x,
            Self::S => s,
            Self::Add(a, b) => a.at(s) + b.at(s),
            Self::Mul(a, b) => a.at(s) * b.at(s),
            Self::Div(a, b) => a.at(s) / b.at(s),
            Self::Pow(a, n) => a.at(s).powi(*n),
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![(1..100_u32).prop_map(|n| Tree::Number(f64::from(n) / 10.0)), Just(Tree::S)];
    leaf.prop_recursive(4, 12, 2, |inner| {
        let pair = || (inner.clone(), inner.clone()).prop_map(|(a, b)| (Box::new(a), Box::new(b)));
        prop_oneof![
            3 => pair().prop_map(|(a, b)| Tree::Add(a, b)),
            2 => pair().prop_map(|(a, b)| Tree::Mul(a, b)),
            2 => pair().prop_map(|(a, b)| Tree::Div(a, b)),
            1 => (inner.clone(), -3..4).prop_map(|(a, n)| Tree::Pow(Box::new(a), n)),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn trees_have_their_values(tree in tree(), s in 0.1..5.0_f64) {
        // The lag makes most trees proper; it is divided out of the value again.
        let Ok(g) = parse(&format!("{}/(1+s)^6", tree.text())) else { return Ok(()) };
        let value = g.at(Complex::real(s)).re * (1.0 + s).powi(6);
        prop_assert!((value - tree.at(s)).abs() <= 1e-12 * tree.at(s), "{}: {value}", tree.text());
    }
}
