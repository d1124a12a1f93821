//! The PI with the least integral of the absolute error after a step of the load.

use core::cell::Cell;

use controller_core::PidConfig;

use crate::margins::ContinuousLoop;
use crate::model::{Complex, ModelError, TransferFunction};
use crate::response::{ContinuousResponse, sign_of_ki};
use crate::{Refusal, Warning, Warnings};

/// Accuracy of each IAE: well below what the flat optimum makes of 0.1 % in `kp`.
const ACCURACY: f64 = 1e-7;
/// Sensitivity peak from which the design is called fragile.
const FRAGILE: f64 = 2.0;
/// Evaluations of one descent at most.
const MAX_TRIALS: usize = 300;
/// Elements of all responses at most: a second or two, some hundred times what most plants take. A plant that rings for
/// thousands of periods has more.
const MAX_ELEMENTS: usize = 1_000_000;

/// The PI controller with the least IAE after a unit step of the load at the plant input, over an infinite horizon,
/// found by optimisation on the exact response (Airikka 2021 fits formulas to such optima; they are off by up to 16 %
/// in `kp`, and below `dead_time/tau = 0.15` by more than half in `ti`, so they are not used here).
///
/// The optimum is flat: 1 % in `kp` or `ti` costs 0.02 to 0.04 % of IAE. It is also fragile: for a plant of first order
/// with dead time Ms is 2.05 at `dead_time/tau = 3` and 3.6 at 0.05.
///
/// Cost: one to five milliseconds for a plant with one lag. Accuracy: IAE to 1e-6, `kp` and `ki` to about 0.1 %.
///
/// ```
/// use controller_design::rules::PiIae;
/// let design = PiIae::fopdt(1.0, 1.0, 1.0)?;
/// assert!((design.pid.kp / 1.01937 - 1.0).abs() < 2e-3);
/// assert!((design.pid.kp / design.pid.ki / 1.45096 - 1.0).abs() < 2e-3);
/// assert!((design.iae / 1.519593 - 1.0).abs() < 1e-5);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PiIae {
    /// The gains; `b = 1`.
    pub pid: PidConfig,
    /// Its IAE for a unit step of the load at the plant input, `e = r - y`.
    pub iae: f64,
    /// Sensitivity peak of the loop.
    pub ms: f64,
    /// What to know about the design.
    pub warnings: Warnings,
}

impl PiIae {
    /// The optimum for `gain*exp(-s*dead_time)/(1 + tau*s)`; times in seconds.
    ///
    /// # Errors
    /// As for [`new`](Self::new); a number that makes no plant.
    pub fn fopdt(gain: f64, tau: f64, dead_time: f64) -> Result<Self, Refusal> {
        Self::of(TransferFunction::first_order(gain, tau, dead_time))
    }

    /// The optimum for `gain*exp(-s*dead_time)/s`: `kp = 0.911/(gain*dead_time)`, `ti = 4.10*dead_time`.
    ///
    /// # Errors
    /// As for [`fopdt`](Self::fopdt).
    ///
    /// ```
    /// use controller_design::rules::PiIae;
    /// let design = PiIae::ipdt(-0.2, 3.0)?;
    /// assert!((design.pid.kp * -0.2 * 3.0 / 0.910984 - 1.0).abs() < 2e-3);
    /// assert!((design.iae / (4.890781 * 0.2 * 9.0) - 1.0).abs() < 1e-5);
    /// # Ok::<(), controller_design::Refusal>(())
    /// ```
    pub fn ipdt(gain: f64, dead_time: f64) -> Result<Self, Refusal> {
        Self::of(TransferFunction::integrating(gain, dead_time))
    }

    fn of(plant: Result<TransferFunction, ModelError>) -> Result<Self, Refusal> {
        let plant = plant.map_err(|_| Refusal::Plant {
            must: "have a gain that is not 0 and a dead time of 0 or more, all numbers finite",
            help: "check the parameters of the model",
        })?;
        Self::new(&plant)
    }

    /// The optimum for any plant that a PI controller can hold: more poles than zeros, none of the zeros at `s = 0`.
    /// The search begins at a dozen places around the gain and frequency at which the plant would oscillate under
    /// proportional control; for plants with several minima it may end in one that is not the least.
    ///
    /// # Errors
    /// * A plant that is never at its limit under proportional control, such as one or two lags without dead time:
    ///   the IAE can be made as small as one likes.
    /// * A plant that no PI controller near those places makes stable.
    /// * A plant that rings for so long, thousands of periods, that the search would take many seconds.
    /// * A plant whose loop cannot be computed: see [`ContinuousResponse::new`].
    pub fn new(plant: &TransferFunction) -> Result<Self, Refusal> {
        // Says what is wrong with the plant itself, before any search.
        let probe = PidConfig { kp: 0.0, ki: sign_of_ki(plant), ..PidConfig::default() };
        if let Err(refusal @ Refusal::Plant { .. }) = ContinuousResponse::new(plant, &probe, None) {
            return Err(refusal);
        }
        if plant.integrators() > 1 {
            return Err(Refusal::Plant {
                must: "have at most one integrator for a PI controller",
                help: "close an inner loop around one of them and design for that loop",
            });
        }
        let limit = Limit::of(plant).ok_or(Refusal::NoSolution {
            why: "a PI controller can make the IAE of this plant as small as one likes",
            help: "give the plant the dead time or the fast lags that were left out",
        })?;
        let search = Search { plant, limit, elements: Cell::new(0) };
        let start = search.start();
        search.within_budget()?;
        let mut best = start.ok_or(Refusal::NoSolution {
            why: "no PI controller was found that makes this plant stable",
            help: "a PI is too little for it: damp it first by an inner loop, or use a PID",
        })?;
        // The second descent shows whether the first one got stuck.
        for (size, end) in [(0.12, 4e-3), (0.02, 2e-4)] {
            best = search.descend(best, size, end);
            search.within_budget()?;
        }
        let pid = search.pid(best.place);
        let ms = ContinuousLoop::new(plant, &pid).margins()?.ms;
        let mut warnings = Warnings::new();
        if ms > FRAGILE {
            let text = "the IAE optimum leaves little room for errors of the model";
            let _ = warnings.push(Warning::Value { about: "ms", value: ms, text });
        }
        if best.place[0] < 1e-3 {
            let text = "the optimum is pure integral control; the plant swings on its own";
            let _ = warnings.push(Warning::Text { about: "kp", text });
        }
        Ok(Self { pid, iae: best.iae, ms, warnings })
    }
}

/// Where the plant would oscillate under proportional control.
#[derive(Debug, Clone, Copy)]
struct Limit {
    /// The gain, with its sign.
    gain: f64,
    /// The frequency \[rad/s\].
    omega: f64,
}

impl Limit {
    fn of(plant: &TransferFunction) -> Option<Self> {
        let sign = sign_of_ki(plant);
        let roots = plant.poles().into_iter().chain(plant.zeros());
        let sizes = roots.map(Complex::abs).filter(|w| *w > 0.0);
        let delay = Some(1.0 / plant.dead_time()).filter(|w| w.is_finite());
        let (low, high) = sizes.chain(delay).fold((f64::MAX, 0.0_f64), |(l, h), w| (l.min(w), h.max(w)));
        if high == 0.0 {
            return None;
        }
        let at = |omega: f64| plant.at(Complex::new(0.0, omega));
        // The last crossing of a delay-free plant may lie far above its poles: 8 lags cross at 0.4 of them, 3 at
        // 1.7, two lags and one a thousand times faster at 30 times the geometric mean.
        let (start, end) = (libm::log(low / 30.0), libm::log(100.0 * high));
        let points = 400;
        let place = |i: i32| libm::exp(start + (end - start) * f64::from(i) / f64::from(points));
        let mut best: Option<Self> = None;
        let mut consider = |omega: f64| {
            let g = at(omega);
            let gain = 1.0 / g.abs();
            if g.re * sign < 0.0 && gain.is_finite() && best.is_none_or(|b| gain < b.gain) {
                best = Some(Self { gain, omega });
            }
        };
        for i in 0..points {
            let (mut lo, mut hi) = (place(i), place(i + 1));
            let rising = at(hi).im;
            if (at(lo).im > 0.0) == (rising > 0.0) {
                continue;
            }
            for _ in 0..40 {
                let middle = 0.5 * (lo + hi);
                if (at(middle).im > 0.0) == (rising > 0.0) { hi = middle } else { lo = middle }
            }
            consider(0.5 * (lo + hi));
        }
        best.map(|b| Self { gain: b.gain * sign, ..b })
    }
}

/// A controller: `kp` over the limit gain, and the logarithm of `ki` over limit gain and frequency.
type Place = [f64; 2];

#[derive(Debug, Clone, Copy)]
struct Trial {
    place: Place,
    iae: f64,
}

struct Search<'a> {
    plant: &'a TransferFunction,
    limit: Limit,
    /// Elements of responses so far.
    elements: Cell<usize>,
}

impl Search<'_> {
    fn within_budget(&self) -> Result<(), Refusal> {
        if self.elements.get() < MAX_ELEMENTS {
            return Ok(());
        }
        Err(Refusal::NoSolution {
            why: "the plant rings for too long to search for the least IAE",
            help: "damp it first by an inner loop, or use a rule without such a search",
        })
    }

    fn pid(&self, place: Place) -> PidConfig {
        let kp = place[0] * self.limit.gain;
        let ki = libm::exp(place[1]) * self.limit.gain * self.limit.omega;
        PidConfig { kp, ki, b: 1.0, ..PidConfig::default() }
    }

    /// The IAE if it is below `limit`, infinity otherwise.
    fn trial(&self, place: Place, limit: f64) -> Trial {
        // Whoever asked refuses then.
        if self.elements.get() >= MAX_ELEMENTS {
            return Trial { place, iae: f64::INFINITY };
        }
        let response = ContinuousResponse::with_accuracy(self.plant, &self.pid(place), None, ACCURACY);
        let iae = match response {
            Ok(response) if place[0] >= 0.0 => {
                let (iae, elements) = response.iae_below(limit);
                self.elements.set(self.elements.get() + elements);
                iae
            }
            _ => f64::INFINITY,
        };
        Trial { place, iae }
    }

    fn start(&self) -> Option<Trial> {
        // kp over the limit gain, and kp over ki in units of the limit frequency.
        let usual = [0.55, 0.3, 0.1].map(|kp| [6.0, 2.5, 1.0].map(|ti| [kp, libm::log(kp / ti)]));
        let integral = [0.3, 0.06, 0.01].map(|ki| [0.0, libm::log(ki)]);
        // Plants with little phase to spare over a wide range, such as lags far apart.
        let patient =
            [0.2, 0.06, 0.02, 0.006].map(|kp| [20.0, 70.0, 250.0].map(|ti| [kp, libm::log(kp / ti)]));
        self.best_of(usual.into_iter().flatten().chain(integral))
            .or_else(|| self.best_of(patient.into_iter().flatten()))
    }

    fn best_of(&self, places: impl Iterator<Item = Place>) -> Option<Trial> {
        let mut best: Option<Trial> = None;
        for place in places {
            let trial = self.trial(place, best.map_or(f64::INFINITY, |b| b.iae));
            if trial.iae.is_finite() && best.is_none_or(|b| trial.iae < b.iae) {
                best = Some(trial);
            }
        }
        best
    }

    /// Nelder and Mead's simplex around the best trial so far, until it is smaller than `end`.
    fn descend(&self, best: Trial, size: f64, end: f64) -> Trial {
        let corner = |i: usize| {
            let mut place = best.place;
            // A relative step in both: kp may be small against its limit.
            place[i] += if i == 0 { size * best.place[0].max(0.05) } else { -size };
            self.trial(place, f64::INFINITY)
        };
        let mut simplex = [best, corner(0), corner(1)];
        for _ in 0..MAX_TRIALS {
            simplex.sort_by(|a, b| a.iae.total_cmp(&b.iae));
            let [a, b, c] = simplex;
            let across = |i: usize| (a.place[i] - b.place[i]).abs().max((a.place[i] - c.place[i]).abs());
            if across(0) < end * a.place[0].max(0.01) && across(1) < end {
                break;
            }
            let at = |t: f64, limit: f64| {
                let towards = |i: usize| {
                    let middle = 0.5 * (a.place[i] + b.place[i]);
                    middle + t * (middle - c.place[i])
                };
                self.trial([towards(0), towards(1)], limit)
            };
            let reflected = at(1.0, c.iae);
            let next = if reflected.iae < a.iae {
                let expanded = at(2.0, reflected.iae);
                if expanded.iae < reflected.iae { expanded } else { reflected }
            } else if reflected.iae < b.iae {
                reflected
            } else {
                let outside = reflected.iae < c.iae;
                at(if outside { 0.5 } else { -0.5 }, reflected.iae.min(c.iae))
            };
            if next.iae < c.iae {
                simplex[2] = next;
            } else {
                for trial in &mut simplex[1..] {
                    let half = |i: usize| 0.5 * (a.place[i] + trial.place[i]);
                    *trial = self.trial([half(0), half(1)], f64::INFINITY);
                }
            }
        }
        simplex.into_iter().fold(best, |best, t| if t.iae < best.iae { t } else { best })
    }
}
