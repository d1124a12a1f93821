//! A plant on paper: a rational function in factors, with dead time.

use core::fmt;
use std::vec;
use std::vec::Vec;

use controller_core::plant_model::{MAX_ORDER, PlantModel};

use super::complex::Complex;
use super::factored::{Factored, Fault};
use super::model_error::ModelError;
use super::number::decimal;
use super::polynomial::Polynomial;

/// `G(s) = gain * s^differentiators * prod(num) * exp(-s*dead_time) / (s^integrators * prod(den))`, proper, with
/// every polynomial of degree 1 or more and a constant term of 1.
///
/// Poles and zeros at `s = 0` have cancelled each other; other common factors stay. The factors are those that
/// were given: see [`parse`](super::parse).
///
/// ```
/// use controller_design::model::parse;
/// let g = parse("6*(1-0.3*s)/(2+s)^3").expect("a valid plant");
/// assert_eq!(g.gain(), 0.75);
/// assert_eq!(g.den().len(), 3);
/// assert_eq!(g.to_string(), "0.75*(1-0.3*s)/(1+0.5*s)^3");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFunction {
    value: Factored,
}

impl TransferFunction {
    /// `num * exp(-s*dead_time) / den`, each polynomial kept as one factor (up to its powers of `s`). `dead_time`
    /// in seconds.
    ///
    /// # Errors
    /// A number that is not finite, a zero polynomial, a negative dead time, more zeros than poles, or a degree
    /// above [`MAX_DEGREE`](super::MAX_DEGREE).
    ///
    /// ```
    /// use controller_design::model::{Polynomial, TransferFunction};
    /// let (num, den) = (Polynomial::new([4.0]), Polynomial::new([0.0, 2.0, 1.0]));
    /// let g = TransferFunction::from_polynomials(&num, &den, 0.1).expect("proper");
    /// assert_eq!(g.to_string(), "2*exp(-0.1*s)/(s*(1+0.5*s))");
    /// ```
    pub fn from_polynomials(num: &Polynomial, den: &Polynomial, dead_time: f64) -> Result<Self, ModelError> {
        for (what, list) in
            [("a coefficient of the numerator", num), ("a coefficient of the denominator", den)]
        {
            if let Some(&value) = list.coefficients().iter().find(|c| !c.is_finite()) {
                return Err(ModelError::NotFinite { what, value });
            }
        }
        if den.is_zero() {
            return Err(ModelError::ZeroDenominator);
        }
        let quotient = Factored::polynomial(num).div(Factored::polynomial(den));
        let mut value = quotient.map_err(ModelError::from)?;
        value.dead_time = finite("the dead time", dead_time)?;
        Self::from_factored(value)
    }

    /// `gain * exp(-s*dead_time) / (1 + tau*s)`; times in seconds. `tau = 0` leaves a static gain.
    ///
    /// # Errors
    /// A number that is not finite, a gain of 0, a negative dead time.
    ///
    /// ```
    /// use controller_design::model::{TransferFunction, parse};
    /// let tank = TransferFunction::first_order(1.98, 80.3, 3.2).expect("a valid plant");
    /// assert_eq!(Ok(tank), parse("1.98*exp(-3.2*s)/(1+80.3*s)"));
    /// ```
    pub fn first_order(gain: f64, tau: f64, dead_time: f64) -> Result<Self, ModelError> {
        Self::over(gain, [1.0, finite("tau", tau)?], dead_time)
    }

    /// `gain * exp(-s*dead_time) / (1 + a1*s + a2*s^2)`; `a1` in s, `a2` in s^2, `dead_time` in s.
    ///
    /// # Errors
    /// As for [`first_order`](Self::first_order).
    ///
    /// ```
    /// use controller_design::model::TransferFunction;
    /// let g = TransferFunction::second_order(1.0, 0.4, 1.0, 0.0).expect("a valid plant");
    /// assert!((g.poles()[0].re + 0.2).abs() < 1e-15);
    /// ```
    pub fn second_order(gain: f64, a1: f64, a2: f64, dead_time: f64) -> Result<Self, ModelError> {
        Self::over(gain, [1.0, finite("a1", a1)?, finite("a2", a2)?], dead_time)
    }

    /// `gain * exp(-s*dead_time) / s`; `dead_time` in seconds.
    ///
    /// # Errors
    /// As for [`first_order`](Self::first_order).
    ///
    /// ```
    /// use controller_design::model::TransferFunction;
    /// let g = TransferFunction::integrating(0.5, 2.0).expect("a valid plant");
    /// assert_eq!((g.integrators(), g.to_string()), (1, "0.5*exp(-2*s)/s".to_string()));
    /// ```
    pub fn integrating(gain: f64, dead_time: f64) -> Result<Self, ModelError> {
        Self::over(gain, [0.0, 1.0], dead_time)
    }

    /// The same function with another dead time \[s\].
    ///
    /// # Errors
    /// A dead time that is negative or not finite.
    ///
    /// ```
    /// use controller_design::model::parse;
    /// let plant = parse("exp(-s)/(1+s)^4").expect("a valid plant");
    /// assert_eq!(plant.with_dead_time(0.5).expect("a valid plant").to_string(), "exp(-0.5*s)/(1+s)^4");
    /// assert!(plant.with_dead_time(-0.5).is_err());
    /// ```
    pub fn with_dead_time(&self, dead_time: f64) -> Result<Self, ModelError> {
        let mut value = self.value.clone();
        value.dead_time = finite("the dead time", dead_time)?;
        Self::from_factored(value)
    }

    fn over<const N: usize>(gain: f64, den: [f64; N], dead_time: f64) -> Result<Self, ModelError> {
        let num = Polynomial::constant(finite("the gain", gain)?);
        Self::from_polynomials(&num, &Polynomial::new(den), dead_time)
    }

    /// The one gate to the type: what holds of every transfer function is checked here.
    pub(crate) fn from_factored(value: Factored) -> Result<Self, ModelError> {
        if value.is_zero() {
            return Err(ModelError::ZeroGain);
        }
        let mut value = value.normalised()?;
        if value.dead_time < 0.0 {
            return Err(ModelError::NegativeDeadTime { dead_time: value.dead_time });
        }
        // No sign on a zero, so that equal functions print alike.
        value.dead_time = value.dead_time.abs();
        let (zeros, poles) = (value.num_degree(), value.den_degree());
        if zeros > poles {
            return Err(ModelError::Improper { zeros, poles });
        }
        Ok(Self { value })
    }

    /// The gain: the value of the function at `s = 0` once its poles and zeros there are taken away; not 0.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.value.gain
    }

    /// Number of poles at `s = 0`.
    #[must_use]
    pub fn integrators(&self) -> usize {
        self.value.origin.max(0).unsigned_abs()
    }

    /// Number of zeros at `s = 0`.
    #[must_use]
    pub fn differentiators(&self) -> usize {
        self.value.origin.min(0).unsigned_abs()
    }

    /// The factors of the numerator, each with a constant term of 1.
    #[must_use]
    pub fn num(&self) -> &[Polynomial] {
        &self.value.num
    }

    /// The factors of the denominator, each with a constant term of 1.
    #[must_use]
    pub fn den(&self) -> &[Polynomial] {
        &self.value.den
    }

    /// The dead time in seconds, 0 or more.
    #[must_use]
    pub fn dead_time(&self) -> f64 {
        self.value.dead_time
    }

    /// Number of poles.
    #[must_use]
    pub fn order(&self) -> usize {
        self.value.den_degree()
    }

    /// Number of poles less number of zeros; never negative.
    ///
    /// ```
    /// use controller_design::model::parse;
    /// assert_eq!(parse("(1-0.3*s)/(1+s)^3").expect("a valid plant").relative_degree(), 2);
    /// ```
    #[must_use]
    pub fn relative_degree(&self) -> usize {
        self.value.den_degree().saturating_sub(self.value.num_degree())
    }

    /// Whether there are more poles than zeros, so that a step of the input makes no step of the output.
    #[must_use]
    pub fn is_strictly_proper(&self) -> bool {
        self.relative_degree() > 0
    }

    /// The poles in rad/s: those at `s = 0` first, then factor by factor.
    #[must_use]
    pub fn poles(&self) -> Vec<Complex> {
        roots(self.integrators(), self.den())
    }

    /// The zeros in rad/s, in the order of [`poles`](Self::poles). Those of the dead time are not among them.
    #[must_use]
    pub fn zeros(&self) -> Vec<Complex> {
        roots(self.differentiators(), self.num())
    }

    /// The numerator written out, gain included and dead time left out:
    /// `G(s) = num_polynomial * exp(-s*dead_time) / den_polynomial`.
    ///
    /// ```
    /// use controller_design::model::parse;
    /// let g = parse("2*(1-s)/(1+s)^2").expect("a valid plant");
    /// assert_eq!(g.num_polynomial().coefficients(), [2.0, -2.0]);
    /// assert_eq!(g.den_polynomial().coefficients(), [1.0, 2.0, 1.0]);
    /// ```
    #[must_use]
    pub fn num_polynomial(&self) -> Polynomial {
        expanded(self.gain(), self.differentiators(), self.num())
    }

    /// The denominator written out, integrators included.
    #[must_use]
    pub fn den_polynomial(&self) -> Polynomial {
        expanded(1.0, self.integrators(), self.den())
    }

    /// The value `G(s)`, dead time included exactly; `s` in rad/s. At a pole the result is not finite.
    ///
    /// ```
    /// use controller_design::model::{Complex, parse};
    /// let g = parse("2*exp(-s)/(1+s)").expect("a valid plant");
    /// assert!((g.at(Complex::new(0.0, 1.0)).abs() - libm::sqrt(2.0)).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(&self, s: Complex) -> Complex {
        let mut value = Complex::real(self.gain());
        // Numerators and denominators in turn: the partial products stay as moderate as the result is.
        let (mut num, mut den) = (self.num().iter(), self.den().iter());
        loop {
            let (top, bottom) = (num.next(), den.next());
            if top.is_none() && bottom.is_none() {
                break;
            }
            value = top.map_or(value, |p| value * p.at(s));
            value = bottom.map_or(value, |p| value / p.at(s));
        }
        for _ in 0..self.integrators() {
            value = value / s;
        }
        for _ in 0..self.differentiators() {
            value = value * s;
        }
        if self.dead_time() == 0.0 { value } else { value * (s * -self.dead_time()).exp() }
    }

    /// The model in the form the run-time blocks take: factors of order 1 and 2. Factors of order 1 and 2 are
    /// taken over as they are; larger ones are split at their computed roots.
    ///
    /// # Errors
    /// No pole at all, more than [`MAX_ORDER`] poles, zeros at `s = 0`, a pole that is not in the open left
    /// half-plane (those at `s = 0` excepted; of several, the one farthest to the right is named), a coefficient
    /// of a factor out of range.
    ///
    /// ```
    /// use controller_core::plant_model::PlantModel;
    /// use controller_design::model::parse;
    /// let g = parse("1.98*exp(-3.2*s)/(1+80.3*s)").expect("a valid plant");
    /// assert_eq!(g.to_plant_model(), Ok(PlantModel::first_order(1.98, 80.3, 3.2)));
    /// ```
    pub fn to_plant_model(&self) -> Result<PlantModel, ModelError> {
        if self.order() == 0 {
            return Err(ModelError::StaticGain);
        }
        if self.order() > MAX_ORDER {
            return Err(ModelError::OrderTooHigh { order: self.order(), max: MAX_ORDER });
        }
        if self.differentiators() > 0 {
            return Err(ModelError::ZeroAtOrigin { count: self.differentiators() });
        }
        let mut model =
            PlantModel { integrators: self.integrators(), ..PlantModel::default() }.with_gain(self.gain());
        let mut stable = true;
        for factor in self.den().iter().flat_map(Polynomial::factors) {
            stable &= factor.a1 > 0.0 && factor.a2 >= 0.0;
            model = model.with_pole(factor);
        }
        if !stable {
            let pole = roots(0, self.den()).into_iter().reduce(|a, b| if b.re > a.re { b } else { a });
            return Err(ModelError::Unstable { pole: pole.unwrap_or_default() });
        }
        for factor in self.num().iter().flat_map(Polynomial::factors) {
            model = model.with_zero(factor);
        }
        let complete = model.order() == self.order() && model.zeros_order() == self.value.num_degree();
        let mut factors = model.poles.iter().chain(&model.zeros);
        if !complete || !factors.all(|f| f.a1.is_finite() && f.a2.is_finite()) {
            return Err(ModelError::OutOfRange);
        }
        Ok(model.with_dead_time(self.dead_time()))
    }
}

impl From<Fault> for ModelError {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::DivisionByZero => Self::ZeroDenominator,
            Fault::DegreeTooHigh(order) => Self::OrderTooHigh { order, max: super::MAX_DEGREE },
            // The other two belong to sums and powers, which no transfer function is built from.
            Fault::OutOfRange | Fault::ZeroToTheZero | Fault::DeadTimesDiffer(..) => Self::OutOfRange,
        }
    }
}

fn finite(what: &'static str, value: f64) -> Result<f64, ModelError> {
    if value.is_finite() { Ok(value) } else { Err(ModelError::NotFinite { what, value }) }
}

fn roots(at_origin: usize, factors: &[Polynomial]) -> Vec<Complex> {
    let mut roots = vec![Complex::ZERO; at_origin];
    roots.extend(factors.iter().flat_map(Polynomial::roots));
    roots
}

fn expanded(gain: f64, powers: usize, factors: &[Polynomial]) -> Polynomial {
    factors.iter().fold(Polynomial::monomial(gain, powers), |product, p| &product * p)
}

impl fmt::Display for TransferFunction {
    /// The canonical expression; [`parse`](super::parse) reads it back as an equal function.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut top = bases(self.differentiators(), self.num());
        match self.dead_time() {
            0.0 => {}
            1.0 => top.push(String::from("exp(-s)")),
            t => top.push(format!("exp(-{}*s)", decimal(t))),
        }
        let gain = self.gain();
        if top.is_empty() || gain.abs() != 1.0 {
            top.insert(0, decimal(gain));
        } else if gain < 0.0 {
            f.write_str("-")?;
        }
        f.write_str(&top.join("*"))?;
        let bottom = bases(self.integrators(), self.den());
        match &*bottom {
            [] => Ok(()),
            [only] => write!(f, "/{only}"),
            several => write!(f, "/({})", several.join("*")),
        }
    }
}

/// The factors as text, a power for each run of equal ones.
fn bases(powers: usize, factors: &[Polynomial]) -> Vec<String> {
    let power = |base: String, n: usize| if n == 1 { base } else { format!("{base}^{n}") };
    let mut texts = Vec::new();
    if powers > 0 {
        texts.push(power(String::from("s"), powers));
    }
    let runs = factors.chunk_by(|p, q| p == q);
    texts.extend(runs.filter_map(|run| run.first().map(|p| power(format!("({p})"), run.len()))));
    texts
}
