//! The steepest tangent of a step response.

use core::f64::consts::PI;

use crate::Refusal;
use crate::model::{Complex, Polynomial, TransferFunction};

/// Where the step response of a plant is steepest towards its final value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inflexion {
    /// When, after the step \[s\]; dead time included.
    pub time: f64,
    /// How far the response has come by then, as a share of the final value.
    pub value: f64,
    /// The slope there, as a share of the final value [1/s].
    pub slope: f64,
}

impl Inflexion {
    /// The apparent dead time: where the tangent crosses the initial value \[s\].
    ///
    /// ```
    /// use controller_design::{model::parse, rules::inflexion::Inflexion};
    /// // The response of 1/(1+s)^2 is steepest at t = 1: value 1 - 2/e, slope 1/e.
    /// let tangent = Inflexion::of(&parse("1/(1+s)^2").expect("a valid plant")).expect("a tangent");
    /// assert!((tangent.dead_time() - (3.0 - core::f64::consts::E)).abs() < 1e-8);
    /// ```
    #[must_use]
    pub fn dead_time(&self) -> f64 {
        self.time - self.value / self.slope
    }

    /// The steepest tangent of the step response of a self-regulating plant. Relative error about 1e-8 for plants
    /// whose response does not swing more than a few times before.
    ///
    /// Computed by numerical inversion of the Laplace transform (Abate & Valkó 2004, fixed Talbot contour) on a
    /// logarithmic scale of time. Cost: about a millisecond.
    ///
    /// # Errors
    /// What has no areas ([`TransferFunction::areas6`]); `A_1/A_0` not above 0; as many zeros as poles.
    pub fn of(plant: &TransferFunction) -> Result<Self, Refusal> {
        let areas = plant.areas6()?;
        if !plant.is_strictly_proper() {
            return Err(Refusal::Plant {
                must: "have more poles than zeros: its step response begins with a jump",
                help: "add the lag of the actuator or of the sensor",
            });
        }
        let total = areas.of(1) / areas.of(0) - plant.dead_time();
        if total.is_nan() || total <= 0.0 {
            return Err(Refusal::Plant {
                must: "have a positive A_1/A_0: its output must on the whole follow its input",
                help: "use a rule for the shape of the frequency response",
            });
        }
        let slope = |t: f64| inverse(t, |s| shape(plant, s));
        let (low, high) = (SHORTEST * total, LONGEST * total);
        let mut best = (low, slope(low));
        let mut t = low;
        while t < high {
            t *= STEP;
            let here = slope(t);
            if here > best.1 {
                best = (t, here);
            }
        }
        let (time, slope) = if best.0 > low { top(&slope, best.0 / STEP, best.0 * STEP) } else { best };
        let value = inverse(time, |s| shape(plant, s) / s);
        // With one more pole than zeros the response may be steepest at its very beginning.
        let (time, value) = if best.0 > low { (time, value) } else { (0.0, 0.0) };
        if slope > 0.0 && slope.is_finite() && value.is_finite() {
            Ok(Self { time: time + plant.dead_time(), value, slope })
        } else {
            Err(Refusal::NoSolution {
                why: "the steepest tangent of the step response could not be found",
                help: "give the rule a gain, a time constant and a dead time",
            })
        }
    }
}

/// Range of the search in units of the residence time, and its step.
const SHORTEST: f64 = 1e-9;
const LONGEST: f64 = 30.0;
const STEP: f64 = 1.1;
/// Points of the contour: more would cost digits by cancellation.
const POINTS: u32 = 22;

/// The plant without gain and dead time.
fn shape(plant: &TransferFunction, s: Complex) -> Complex {
    let (mut num, mut den) = (plant.num().iter(), plant.den().iter());
    let mut value = Complex::real(1.0);
    loop {
        let (top, bottom) = (num.next(), den.next());
        if top.is_none() && bottom.is_none() {
            return value;
        }
        let at = |p: &Polynomial| p.at(s);
        value = top.map_or(value, |p| value * at(p));
        value = bottom.map_or(value, |p| value / at(p));
    }
}

/// The function of time at `t` whose Laplace transform is `f`.
fn inverse(t: f64, f: impl Fn(Complex) -> Complex) -> f64 {
    let radius = 0.4 * f64::from(POINTS) / t;
    let mut sum = 0.5 * libm::exp(radius * t) * f(Complex::real(radius)).re;
    for k in 1..POINTS {
        let angle = f64::from(k) * PI / f64::from(POINTS);
        let cotangent = libm::cos(angle) / libm::sin(angle);
        let s = Complex::new(radius * angle * cotangent, radius * angle);
        let weight = Complex::new(1.0, angle + (angle * cotangent - 1.0) * cotangent);
        sum += ((s * t).exp() * f(s) * weight).re;
    }
    radius / f64::from(POINTS) * sum
}

/// The top of a curve between two times: golden section. It need not be found to the last digit, for the tangent
/// hardly changes there.
fn top(curve: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut at_c, mut at_d) = (curve(c), curve(d));
    for _ in 0..40 {
        if at_c >= at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - GOLDEN * (b - a);
            at_c = curve(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + GOLDEN * (b - a);
            at_d = curve(d);
        }
    }
    if at_c >= at_d { (c, at_c) } else { (d, at_d) }
}
