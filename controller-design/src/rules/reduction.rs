//! A second-order model with dead time from the areas of any process.

use super::magnitude_optimum::Normalised;
use crate::areas::Areas;
use crate::double::Double;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// `gain * exp(-s*dead_time) / (1 + a1*s + a2*s^2)` with the areas `A_0..A_3` of a process (Vrančić & Huba 2021,
/// eq. (14), in a form that has none of its traps).
///
/// With `n_i = A_i/A_0`, `kappa = 2*n2/n1^2 - 1` and `w = a1/n1 = 1 - dead_time/n1`, eq. (14) reads
/// `w^3 - 3*kappa*w = 6*n2/n1^2 - 6*n3/n1^3 - 2`, `a2 = n1^2*(w^2 - kappa)/2`: of its roots the one from
/// `sqrt(kappa)` to 1 has `a2 >= 0` and `dead_time >= 0`, and there is only one. Processes that are of this form
/// themselves come out unchanged.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduced {
    /// Static gain [y/u].
    pub gain: f64,
    /// Coefficient of `s` \[s\]; 0 only for a pure dead time.
    pub a1: f64,
    /// Coefficient of `s^2` [s^2], 0 or more.
    pub a2: f64,
    /// Dead time \[s\], 0 or more.
    pub dead_time: f64,
    /// Whether no model of this form has the area `A_3` (or `A_2`) of the process, so that the nearest one was taken:
    /// from fine to useless, not fit for an estimator without a look at the margins.
    pub fallback: bool,
    /// What to know about it.
    pub warnings: Warnings,
}

/// A third area that is off by this share of itself changes no loop visibly.
const NEGLIGIBLE: f64 = 1e-3;

impl Reduced {
    /// The model for the unfiltered areas of a process.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::reduction::Reduced;
    /// // exp(-0.2*s)/(1+s)^3, eq. (22) of Vrančić & Huba 2021: 0.616, 2.58, 1.84
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 3.0, 3.0, 1.0], 0.2).expect("a stable plant");
    /// let model = Reduced::new(&areas).expect("a model");
    /// assert!((model.dead_time - 0.6157745568).abs() < 1e-9);
    /// assert!((model.a1 - 2.584225443).abs() < 1e-8 && (model.a2 - 1.839110571).abs() < 1e-8);
    /// ```
    ///
    /// # Errors
    /// Areas that are not finite, a gain of 0, `A_1/A_0 <= 0`, `A_2*A_0 > A_1^2` (no stable model of this form has
    /// such areas).
    pub fn new(areas: &Areas) -> Result<Self, Refusal> {
        let normalised = Normalised::new(areas, 0.0)?;
        let shape = Shape::of(&normalised)?;
        let time = normalised.time;
        let mut warnings = Warnings::new();
        if let Some(warning) = shape.warning {
            warn(&mut warnings, warning);
        }
        let model = Self {
            gain: normalised.gain,
            a1: shape.a1 * time,
            a2: shape.a2 * time * time,
            dead_time: shape.dead_time * time,
            fallback: shape.fallback,
            warnings,
        };
        if model.a2.is_finite() && (shape.a2 == 0.0 || model.a2 >= f64::MIN_POSITIVE) {
            Ok(model)
        } else {
            Err(Refusal::NoSolution {
                why: "the coefficients of the model do not fit into double precision",
                help: "write the plant in a unit of time in which its time constants are near 1",
            })
        }
    }
}

/// The model for `A_0 = A_1 = 1`.
struct Shape {
    a1: f64,
    a2: f64,
    dead_time: f64,
    fallback: bool,
    warning: Option<Warning>,
}

impl Shape {
    fn of(areas: &Normalised) -> Result<Self, Refusal> {
        let [one, _, n2, n3, _, _] = areas.n;
        // What rounding of the areas may make of a 0.
        let none = 64.0 * areas.error * (1.0 + n2.hi.abs() + n3.hi.abs());
        let kappa = n2.times(2.0).sub(one);
        // The cubic at w = 1 is 6*alpha: 0 for a second-order process without dead time.
        let alpha = one.sub(n2.times(2.0)).add(n3);
        let q = n2.sub(n3).times(6.0).sub(one.times(2.0));
        if kappa.hi - 1.0 > none {
            return Err(Refusal::Plant {
                must: "have A_2*A_0 of at most A_1^2: no stable model of second order has such areas",
                help: "use a rule that needs no model; recorded areas: check the record",
            });
        }
        let without_delay = Self::plain(1.0, one.sub(n2).value().max(0.0));
        if alpha.hi < -none {
            let off = alpha.hi.abs() / n3.hi.abs();
            let fallback = off.is_nan() || off > NEGLIGIBLE;
            let text =
                "share by which the model's third area is off: the process has a zero in the left half-plane";
            let warning = Some(Warning::Value { about: "model", value: off, text });
            return Ok(Self { fallback, warning, ..without_delay });
        }
        if alpha.hi <= none {
            return Ok(without_delay);
        }
        if kappa.hi > none {
            Ok(Self::with_delay(kappa.sqrt(), q, none))
        } else {
            Ok(Self::near_dead_time(if kappa.hi < -none { kappa.neg() } else { Double::default() }, q, none))
        }
    }

    const fn plain(a1: f64, a2: f64) -> Self {
        Self { a1, a2, dead_time: 1.0 - a1, fallback: false, warning: None }
    }

    /// `kappa > 0`: with `w = root + v`, `root = sqrt(kappa)`, the cubic is `v^2*(v + 3*root) = g`.
    fn with_delay(root: Double, q: Double, none: f64) -> Self {
        let one = Double::new(1.0);
        let g = q.add(root.mul(root).mul(root).times(2.0));
        if g.hi <= none {
            // A first-order process with dead time, or as near to one as this form comes.
            let warning = (g.hi < -none).then_some(Warning::Text { about: "model", text: ROUGH });
            let first_order = Self::plain(root.value(), 0.0);
            return Self {
                dead_time: one.sub(root).value().max(0.0),
                fallback: warning.is_some(),
                warning,
                ..first_order
            };
        }
        let mut v = libm::cbrt(g.hi).min(libm::sqrt(g.hi / (3.0 * root.hi)));
        // From above and convex: Newton's steps fall until rounding stops them.
        for _ in 0..60 {
            let next = v - (v * v * (v + 3.0 * root.hi) - g.hi) / (3.0 * v * (v + 2.0 * root.hi));
            if !(next > 0.0 && next < v) {
                break;
            }
            v = next;
        }
        let start = Double::new(v);
        let rest = start.mul(start).mul(start.add(root.times(3.0))).sub(g);
        let v = start.sub(rest.div(start.times(3.0).mul(start.add(root.times(2.0)))));
        Self {
            a1: root.add(v).value(),
            a2: v.mul(v.times(0.5).add(root)).value(),
            dead_time: one.sub(root).sub(v).value().max(0.0),
            fallback: false,
            warning: None,
        }
    }

    /// `kappa <= 0`, `m = -kappa`: the cubic is `w^3 + 3*m*w = q`.
    fn near_dead_time(m: Double, q: Double, none: f64) -> Self {
        let one = Double::new(1.0);
        if q.hi <= none {
            // A pure dead time, or a process that no stable model of this form describes.
            let fallback = q.hi < -none || m.hi > 0.0;
            let warning = fallback.then_some(Warning::Text { about: "model", text: ROUGH });
            return Self { fallback, warning, ..Self::plain(0.0, 0.0) };
        }
        let mut w = libm::cbrt(q.hi);
        if m.hi > 0.0 {
            w = w.min(q.hi / (3.0 * m.hi));
        }
        for _ in 0..60 {
            let next = w - (w * (w * w + 3.0 * m.hi) - q.hi) / (3.0 * (w * w + m.hi));
            if !(next > 0.0 && next < w) {
                break;
            }
            w = next;
        }
        let start = Double::new(w);
        let square = start.mul(start);
        let rest = start.mul(square.add(m.times(3.0))).sub(q);
        let w = start.sub(rest.div(square.add(m).times(3.0)));
        Self {
            a1: w.value(),
            a2: w.mul(w).add(m).times(0.5).value(),
            dead_time: one.sub(w).value().max(0.0),
            fallback: false,
            warning: None,
        }
    }
}

const ROUGH: &str = "no model of second order with dead time has these areas, the nearest is used";
