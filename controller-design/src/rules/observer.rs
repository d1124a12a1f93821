//! The time constant of a disturbance observer's filter.

use controller_core::PidConfig;
use controller_core::compensator::ObserverConfig;
use controller_core::plant_model::{Factor, PlantModel};

use crate::margins::{ContinuousLoop, Margins, lead, split_zeros};
use crate::model::{ModelError, TransferFunction};
use crate::{Refusal, Warning, Warnings};

/// Least and largest filter time constant \[s\].
const ALPHA_RANGE: (f64, f64) = (1e-12, 1e12);
/// Least and largest noise ratio.
const RATIO_RANGE: (f64, f64) = (1.0 + 1e-6, 1e12);
/// Least and largest sensitivity peak that can be a limit.
const MS_RANGE: (f64, f64) = (1.0, 100.0);
/// The scan for a sensitivity limit: steps of a decade of `ratio - 1`, and decades.
const PER_DECADE: u32 = 24;
const DECADES: u32 = 5;
/// Halvings of the last step of the scan.
const HALVINGS: usize = 40;
/// Sensitivity peak above which the design carries a warning.
const HIGH_MS: f64 = 2.0;

/// A disturbance observer (DOB) for a plant and a controller that is already tuned, Tena et al. 2022, sections 3 and
/// 6.
///
/// The plant is `K*prod(1+beta*s)*prod(1-delta*s)*exp(-T*s)/(s^k*prod(1+tau*s))`. The filter `1/(1+alpha*s)^d` has
/// the order `d = poles - number of beta`: the real zeros of the left half-plane move into the `y` path, all others
/// stay. Fast noise then meets the gain (eqs (36), (43), (46), with the factor `1/K` they lack in print)
///
/// ```text
/// A_n = |kp + prod(tau)/(K*prod(beta)*alpha^d)|.
/// ```
///
/// For a PID with the filter `tf` its gain at high frequency, `kd/tf`, takes the place of `kp`.
///
/// `observer.order` is `None`: the law that runs chooses the least order for its sampling period. That is `d`, unless
/// a zero `beta` is shorter than the period: such a zero stays in the `u` path and raises the order by one.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::model::parse;
/// use controller_design::rules::ObserverDesign;
///
/// // Tena et al. 2022, eq. (48), the tank, with the controller of table 6.
/// let tank = parse("1.98*exp(-3.2*s)/(1+80.3*s)").expect("a valid plant");
/// let pid = PidConfig { kp: 2.2, ki: 2.2 / 24.6, ..PidConfig::default() };
/// let design = ObserverDesign::with_alpha(&tank, &pid, 8.35).expect("a stable loop");
/// assert_eq!(design.order, 1);
/// assert!((design.an - (2.2 + 80.3 / (1.98 * 8.35))).abs() < 1e-12);
/// assert!((design.ms - 1.46808).abs() < 1e-5);
/// // A ramp of the load: what is left is (d*alpha + T)/ki.
/// assert!((design.predicted_ie_ramp(&pid) - (8.35 + 3.2) * 24.6 / 2.2).abs() < 1e-9);
///
/// let same = ObserverDesign::with_noise_ratio(&tank, &pid, design.an / pid.kp).expect("a stable loop");
/// assert!((same.observer.alpha - 8.35).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ObserverDesign {
    /// The plant's model and `alpha`.
    pub observer: ObserverConfig,
    /// The filter order `d` of the continuous design.
    pub order: usize,
    /// The noise gain `A_n` [u/y].
    pub an: f64,
    /// The sensitivity peak of the loop with the observer.
    pub ms: f64,
    /// Margins of the loop with the observer.
    pub margins: Margins,
    /// What to know about the design.
    pub warnings: Warnings,
}

impl ObserverDesign {
    /// The observer with the filter time constant `alpha` \[s\], 1e-12 to 1e12.
    ///
    /// # Errors
    /// An `alpha` outside its range; a plant that an observer cannot model (unstable, without more poles than zeros,
    /// of too high an order, with a zero at `s = 0`); a loop that is not stable, with the controller alone or with
    /// the observer.
    pub fn with_alpha(plant: &TransferFunction, pid: &PidConfig, alpha: f64) -> Result<Self, Refusal> {
        Setting::new(plant, pid)?.design(alpha)
    }

    /// The observer beside a controller whose loop is known to be stable.
    pub(crate) fn beside(plant: &TransferFunction, pid: &PidConfig, choice: Choice) -> Result<Self, Refusal> {
        let setting = Setting::of_stable(plant, pid)?;
        match choice {
            Choice::Time(alpha) => setting.design(alpha),
            Choice::NoiseRatio(ratio) => setting.design(setting.alpha(ratio)?),
        }
    }

    /// The observer that makes the noise gain `ratio` times the controller's own, `ratio` above 1:
    /// `alpha = (prod(tau)/(K*kp*prod(beta)*(ratio-1)))^(1/d)`. The paper's examples are 2 and 10.
    ///
    /// # Errors
    /// As for [`with_alpha`](Self::with_alpha); a ratio outside its range; a controller whose gain at high frequency
    /// is 0 (`tf` without `kd`), infinite (`kd` without `tf`) or of the other sign than the plant's.
    pub fn with_noise_ratio(plant: &TransferFunction, pid: &PidConfig, ratio: f64) -> Result<Self, Refusal> {
        let setting = Setting::new(plant, pid)?;
        setting.design(setting.alpha(ratio)?)
    }

    /// The largest noise ratio up to `ratio_max` whose sensitivity peak is at most `ms_max` (step 5 of section 6).
    ///
    /// The peak is no monotone function of the ratio, as the paper assumes; the ratio is scanned downwards in 24
    /// steps a decade of `ratio - 1`, and the first limit met is refined. Cost: one set of margins for each step.
    ///
    /// # Errors
    /// As for [`with_noise_ratio`](Self::with_noise_ratio); no ratio keeps the limit, with the least peak found.
    pub fn within_ms(
        plant: &TransferFunction,
        pid: &PidConfig,
        ratio_max: f64,
        ms_max: f64,
    ) -> Result<Self, Refusal> {
        let (min, max) = MS_RANGE;
        if !(ms_max > min && ms_max <= max) {
            return Err(Refusal::OutOfRange { parameter: "ms", value: ms_max, min, max });
        }
        let setting = Setting::new(plant, pid)?;
        setting.alpha(ratio_max)?;
        let at = |excess: f64| setting.alpha(1.0 + excess).and_then(|alpha| setting.design(alpha));
        let keeps = |design: &Result<Self, Refusal>| design.as_ref().is_ok_and(|d| d.ms <= ms_max);
        let first = at(ratio_max - 1.0);
        if keeps(&first) {
            return first;
        }
        let step = libm::exp(-core::f64::consts::LN_10 / f64::from(PER_DECADE));
        let (mut above, mut least) = (ratio_max - 1.0, first.map_or(f64::INFINITY, |d| d.ms));
        for _ in 0..PER_DECADE * DECADES {
            let excess = above * step;
            let mut design = at(excess);
            if !keeps(&design) {
                least = least.min(design.map_or(f64::INFINITY, |d| d.ms));
                above = excess;
                continue;
            }
            let mut below = excess;
            for _ in 0..HALVINGS {
                let middle = libm::sqrt(below) * libm::sqrt(above);
                let there = at(middle);
                if keeps(&there) {
                    (below, design) = (middle, there);
                } else {
                    above = middle;
                }
            }
            let text = "lowered from the one asked for, to keep the sensitivity peak";
            if let Ok(design) = &mut design {
                let warning = Warning::Value { about: "noise_ratio", value: 1.0 + below, text };
                let _ = design.warnings.push(warning);
            }
            return design;
        }
        if least.is_finite() {
            return Err(Refusal::Unattainable { what: "ms with the observer", asked: ms_max, least });
        }
        Err(Refusal::NoSolution {
            why: "the loop with the observer is stable at no noise ratio up to the one asked for",
            help: "lower the controller's gains",
        })
    }

    /// The integral of the error after a load that rises by 1 [u/s] for ever: `(d*alpha + T + sum(delta))/ki` (eq.
    /// (33) of Tena et al. 2022 without its stray factor); of `y - r`, signed like `ki`. A ramp that is held for `ts`
    /// adds `ts/2` in the bracket. Without integral action infinite.
    #[must_use]
    pub fn predicted_ie_ramp(&self, pid: &PidConfig) -> f64 {
        let [_, ki, _] = pid.signed_gains();
        let (kept, _) = split_zeros(&self.observer.model);
        let zeros: f64 = kept.iter().map(|zero| -zero.a1).sum();
        let order = u32::try_from(self.order).map_or(f64::INFINITY, f64::from);
        (order * self.observer.alpha + self.observer.model.dead_time + zeros) / ki
    }
}

/// How the filter is chosen.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Choice {
    /// Its time constant \[s\].
    Time(f64),
    /// The noise gain over the controller's own.
    NoiseRatio(f64),
}

/// Plant and controller, and what follows from them.
struct Setting {
    closed: ContinuousLoop,
    model: PlantModel,
    order: usize,
    /// The controller's gain at high frequency.
    high: f64,
    /// `prod(tau)/(K*prod(beta))`.
    lead: f64,
}

impl Setting {
    fn new(plant: &TransferFunction, pid: &PidConfig) -> Result<Self, Refusal> {
        let setting = Self::of_stable(plant, pid)?;
        // With a model that is the plant the observer changes nothing about stability.
        setting.closed.margins()?;
        Ok(setting)
    }

    fn of_stable(plant: &TransferFunction, pid: &PidConfig) -> Result<Self, Refusal> {
        if !plant.is_strictly_proper() {
            return Err(Refusal::Plant {
                must: "have more poles than zeros for an observer",
                help: "add the fast lag that was left out",
            });
        }
        let model = plant.to_plant_model().map_err(refusal)?;
        let (_, moved) = split_zeros(&model);
        let order = model.integrators + model.poles.iter().map(Factor::order).sum::<usize>() - moved.len();
        let [kp, ki, kd] = pid.signed_gains();
        let high = match (kd == 0.0, pid.tf == 0.0) {
            (true, true) => kp,
            (false, true) => f64::INFINITY,
            (_, false) => kd / pid.tf,
        };
        if ki * model.gain < 0.0 {
            return Err(Refusal::NoSolution {
                why: "ki and the plant's gain have different signs",
                help: "change the sign of the controller's gains",
            });
        }
        let lead = lead(&model.poles, &moved) / model.gain;
        let closed = ContinuousLoop::new(plant, pid);
        Ok(Self { closed, model, order, high, lead })
    }

    fn alpha(&self, ratio: f64) -> Result<f64, Refusal> {
        let (min, max) = RATIO_RANGE;
        if !(ratio >= min && ratio <= max) {
            return Err(Refusal::OutOfRange { parameter: "noise_ratio", value: ratio, min, max });
        }
        if !(self.high.is_finite() && self.high / self.lead > 0.0) {
            return Err(Refusal::NoSolution {
                why: "the controller's gain at high frequency is 0, infinite or of the wrong sign: there is no \
                      noise ratio",
                help: "give alpha instead; kd needs tf, and tf without kd leaves no gain at high frequency",
            });
        }
        let power = self.lead / (self.high * (ratio - 1.0));
        let order = u32::try_from(self.order).map_or(1.0, f64::from);
        Ok(if self.order == 1 { power } else { libm::pow(power, 1.0 / order) })
    }

    fn design(&self, alpha: f64) -> Result<ObserverDesign, Refusal> {
        let (min, max) = ALPHA_RANGE;
        if !(alpha >= min && alpha <= max) {
            return Err(Refusal::OutOfRange { parameter: "alpha", value: alpha, min, max });
        }
        let observer = ObserverConfig { model: self.model.clone(), alpha, order: None };
        let closed = self.closed.clone().with_observer(&observer)?;
        let margins = closed.margins()?;
        let ms = margins.ms;
        let mut warnings = Warnings::new();
        if ms > HIGH_MS {
            let text =
                "little robustness against model errors; raise alpha, or start from a PI with a smaller ms";
            let _ = warnings.push(Warning::Value { about: "ms", value: ms, text });
        }
        Ok(ObserverDesign { observer, order: self.order, an: closed.noise_gain(), ms, margins, warnings })
    }
}

fn refusal(error: ModelError) -> Refusal {
    match error {
        ModelError::StaticGain => Refusal::Plant {
            must: "have at least one pole for an observer",
            help: "add the lag that was left out",
        },
        ModelError::OrderTooHigh { .. } => Refusal::Plant {
            must: "have an order of at most 8 for an observer",
            help: "reduce the model: small lags add up to dead time",
        },
        ModelError::ZeroAtOrigin { .. } => Refusal::Plant {
            must: "have no zero at s = 0: a constant load leaves no trace in its output",
            help: "control another output",
        },
        ModelError::Unstable { .. } => Refusal::Plant {
            must: "be stable or integrating for an observer",
            help: "stabilise it with an inner loop first",
        },
        _ => Refusal::Plant {
            must: "have moderate coefficients",
            help: "use units in which gains and times are moderate",
        },
    }
}
