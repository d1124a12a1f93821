//! The time constant of a disturbance observer for a wanted performance.

use controller_core::PidConfig;

use crate::Refusal;
use crate::model::TransferFunction;
use crate::response::{ContinuousResponse, Indices, Load, Observer};

/// Points of the scan per decade of `alpha`; humps and dips of the indices are several times wider.
const PER_DECADE: i32 = 12;
/// Slowest observer that is looked at, in mean times of the response without observer.
const SLOWEST: f64 = 300.0;
/// Decades of the scan, and as many at most while the index still falls by more than 1 % a decade.
const DECADES: (i32, i32) = (7, 12);

/// What is wanted of the loop with observer, at most. Sizes for a unit load at the plant input; multiply the index of
/// the PI alone ([`ContinuousResponse`]) to ask for a ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Wish {
    /// Integral of |e| after a unit step.
    Iae(f64),
    /// Integral of e^2 after a unit step.
    Ise(f64),
    /// Integral of t*|e| after a unit step, t from the step at the plant input.
    Itae(f64),
    /// Largest |e| after a unit step.
    EMax(f64),
    /// Size of the integral of e under a unit ramp: `(order*alpha + dead_time + sum delta)/|ki|`.
    RampIe(f64),
}

impl Wish {
    fn value(self) -> f64 {
        match self {
            Self::Iae(v) | Self::Ise(v) | Self::Itae(v) | Self::EMax(v) | Self::RampIe(v) => v,
        }
    }

    /// What the index is called on the command line and in files.
    ///
    /// ```
    /// assert_eq!(controller_design::rules::Wish::RampIe(1.0).name(), "ramp_ie");
    /// ```
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Iae(_) => "iae",
            Self::Ise(_) => "ise",
            Self::Itae(_) => "itae",
            Self::EMax(_) => "e_max",
            Self::RampIe(_) => "ramp_ie",
        }
    }

    /// The same index with another value.
    #[must_use]
    pub const fn with(self, value: f64) -> Self {
        match self {
            Self::Iae(_) => Self::Iae(value),
            Self::Ise(_) => Self::Ise(value),
            Self::Itae(_) => Self::Itae(value),
            Self::EMax(_) => Self::EMax(value),
            Self::RampIe(_) => Self::RampIe(value),
        }
    }

    fn what(self) -> &'static str {
        match self {
            Self::Iae(_) => "the IAE",
            Self::Ise(_) => "the ISE",
            Self::Itae(_) => "the ITAE",
            Self::EMax(_) => "the largest error",
            Self::RampIe(_) => "the IE under a ramp",
        }
    }

    fn of(self, indices: &Indices) -> f64 {
        match self {
            Self::Iae(_) => indices.iae,
            Self::Ise(_) => indices.ise,
            Self::Itae(_) => indices.itae,
            Self::EMax(_) => indices.e_max,
            Self::RampIe(_) => indices.ie.abs(),
        }
    }
}

/// The largest `alpha` \[s\], so the least noise, with which the PI loop with a disturbance observer of least order
/// attains the wish (Tena et al. 2022, section 6).
///
/// The indices are not always monotonic in `alpha`: with a tight PI (Ms 1.6 and more) and a dead time that is not
/// short, IAE and ITAE rise at first and may never come below those of the PI alone. Hence a scan from slow to fast,
/// every dip looked into, and a bisection at the first place that will do. Cost: a hundred responses, five to ten
/// milliseconds; the IE under a ramp has a closed form.
///
/// # Errors
/// * A wish that no observer attains, with the least value that can be had (down to an `alpha` so small that
///   nothing changes any more).
/// * A wish that is attained however slow the observer is: then none is needed.
/// * A wish that is not positive, an unstable loop, a plant without response: see [`ContinuousResponse::new`].
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::model::parse;
/// use controller_design::response::{ContinuousResponse, Load};
/// use controller_design::rules::{Wish, alpha_for};
///
/// // Tena et al. 2022, table 3, plant 2, as recomputed: alpha = 10 brings the ISE to 0.1166 of the PI's.
/// let plant = parse("exp(-20*s)/(1+80*s)").expect("a plant");
/// let pid = PidConfig { kp: 0.696075276, ki: 0.011533633, ..PidConfig::default() };
/// let alone = ContinuousResponse::new(&plant, &pid, None)?.indices(Load::Step)?;
/// let alpha = alpha_for(&plant, &pid, Wish::Ise(0.11664 * alone.ise))?;
/// assert!((alpha - 10.0).abs() < 0.01);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
pub fn alpha_for(plant: &TransferFunction, pid: &PidConfig, wish: Wish) -> Result<f64, Refusal> {
    let asked = wish.value();
    if !(asked > 0.0 && asked < f64::INFINITY) {
        let (min, max) = (f64::MIN_POSITIVE, f64::MAX);
        return Err(Refusal::OutOfRange { parameter: wish.what(), value: asked, min, max });
    }
    let alone = ContinuousResponse::new(plant, pid, None)?.indices(Load::Step)?;
    if let Wish::RampIe(_) = wish {
        let observer = Observer::new(plant, 0.0);
        let (_, least) = observer.ramp_ie(plant, pid);
        if asked <= least {
            return Err(Refusal::Unattainable { what: wish.what(), asked, least });
        }
        return Ok((asked - least) * pid.ki.abs() / observer.order as f64);
    }
    let scan = Scan { plant, pid, wish };
    scan.largest(SLOWEST * alone.itae / alone.iae)
}

struct Scan<'a> {
    plant: &'a TransferFunction,
    pid: &'a PidConfig,
    wish: Wish,
}

impl Scan<'_> {
    /// The index over the wish.
    fn at(&self, alpha: f64) -> Result<f64, Refusal> {
        let indices = ContinuousResponse::with_alpha(self.plant, self.pid, alpha)?.indices(Load::Step)?;
        Ok(self.wish.of(&indices) / self.wish.value())
    }

    fn largest(&self, slowest: f64) -> Result<f64, Refusal> {
        let alpha = |i: i32| slowest * libm::exp10(-f64::from(i) / f64::from(PER_DECADE));
        let mut values = vec![self.at(alpha(0))?];
        let within = |value: f64| value <= 1.0;
        if values.iter().copied().all(within) {
            return Err(Refusal::NoSolution {
                why: "the wish is attained however slow the observer is",
                help: "run the PI controller alone, or ask for less",
            });
        }
        let mut least = f64::INFINITY;
        for i in 1..=DECADES.1 * PER_DECADE {
            // The smallest ones may be beyond what can be resolved.
            let value = match self.at(alpha(i)) {
                Ok(value) => value,
                Err(refusal) if values.len() < 2 => return Err(refusal),
                Err(_) => break,
            };
            values.push(value);
            if let [.., before, dip, after] = *values.as_slice()
                && dip < before
                && dip <= after
                && dip > 1.0
            {
                let (place, bottom) = self.dip(alpha(i), alpha(i - 2))?;
                least = f64::min(least, bottom);
                if within(bottom) {
                    return self.edge(place, alpha(i - 2));
                }
            }
            if within(value) {
                return self.edge(alpha(i), alpha(i - 1));
            }
            least = f64::min(least, value);
            let decade_ago = values.iter().rev().nth(PER_DECADE.unsigned_abs() as usize);
            let falls = decade_ago.is_some_and(|before| value < 0.99 * before);
            if i >= DECADES.0 * PER_DECADE && !falls {
                break;
            }
        }
        let least = least * self.wish.value();
        Err(Refusal::Unattainable { what: self.wish.what(), asked: self.wish.value(), least })
    }

    /// The least value between two places, by golden section in the logarithm.
    fn dip(&self, low: f64, high: f64) -> Result<(f64, f64), Refusal> {
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        let (mut a, mut b) = (libm::log(low), libm::log(high));
        let value = |x: f64| self.at(libm::exp(x));
        let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        let (mut fc, mut fd) = (value(c)?, value(d)?);
        for _ in 0..24 {
            if fc < fd {
                (b, d, fd) = (d, c, fc);
                c = b - GOLDEN * (b - a);
                fc = value(c)?;
            } else {
                (a, c, fc) = (c, d, fd);
                d = a + GOLDEN * (b - a);
                fd = value(d)?;
            }
        }
        Ok(if fc < fd { (libm::exp(c), fc) } else { (libm::exp(d), fd) })
    }

    /// The largest place that will do between one that does and one that does not.
    fn edge(&self, good: f64, bad: f64) -> Result<f64, Refusal> {
        let (mut good, mut bad) = (libm::log(good), libm::log(bad));
        for _ in 0..36 {
            let middle = 0.5 * (good + bad);
            if self.at(libm::exp(middle))? <= 1.0 { good = middle } else { bad = middle }
        }
        Ok(libm::exp(good))
    }
}
