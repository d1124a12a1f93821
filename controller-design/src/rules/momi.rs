//! MOMI: a PID for set-points by the magnitude optimum.

use controller_core::PidConfig;

use super::magnitude_optimum::{Gains, Normalised, WRONG_SIGN};
use super::noise_limit::{self, PidRule};
use super::reduction::Reduced;
use crate::areas::Areas;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// The PID whose closed loop has `|G_CL(jw)|` flat up to `w^6` (Vrančić & Huba 2021, eqs (6), (7)).
///
/// For any self-regulating plant. Tuned for set-points; for disturbances see [`Drmo`](super::drmo::Drmo) and
/// [`DeMomi`](super::de_momi::DeMomi). `b = c = 1`. The rule looks at the plant at low frequencies only: check the
/// margins of what it gives for plants with complex poles or zeros in the right half-plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Momi {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// What to know about it.
    pub warnings: Warnings,
}

impl Momi {
    /// The gains for a filter time constant `tf` \[s\], 0 or more. Cost: some 1000 floating-point operations.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::momi::Momi;
    /// // exp(-0.5*s)/(1+s)^2, Table 2 of Vrančić & Huba 2021: 1.81, 0.89, 0.93
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 2.0, 1.0], 0.5).expect("a stable plant");
    /// let pid = Momi::new(&areas, 0.1).expect("a PID").pid;
    /// assert!((pid.kp - 1.814188).abs() < 1e-6);
    /// assert!((pid.ki - 0.890072).abs() < 1e-6);
    /// assert!((pid.kd - 0.934023).abs() < 1e-6);
    /// ```
    ///
    /// # Errors
    /// Areas that are not finite, a gain of 0, `A_1/A_0 <= 0`, a `tf` out of range; process and filter that together
    /// are not more than two lags (eq. (6) is singular); gains whose sign is not that of the plant's gain.
    pub fn new(areas: &Areas, tf: f64) -> Result<Self, Refusal> {
        let pid = gains(areas, tf)?;
        let mut warnings = Warnings::new();
        warn_about(&pid, areas, &mut warnings);
        Ok(Self { pid, warnings })
    }

    /// The gains for the shortest filter time constant, at least `ts`, with which the gain for measurement noise
    /// [`kpidn`](noise_limit::kpidn) is at most `kpidn` \[u/y\]; `ts` in seconds. What Fig. 9 of Vrančić & Huba 2021
    /// iterates for is searched for here between brackets: the iteration may diverge. Cost: some hundred times
    /// [`new`](Self::new).
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::momi::Momi;
    /// // exp(-0.2*s)/((1+0.2*s)*(1+s)), eq. (35): 0.119 after two passes
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 1.2, 0.2], 0.2).expect("a stable plant");
    /// let pid = Momi::with_noise_limit(&areas, 4.0, 0.01).expect("attainable").pid;
    /// assert!((pid.tf - 0.1186981548).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Self::new); `kpidn` or `ts` not above 0; a `kpidn` below the least that any filter can give.
    pub fn with_noise_limit(areas: &Areas, kpidn: f64, ts: f64) -> Result<Self, Refusal> {
        let (pid, mut warnings) = noise_limit::shortest_filter(areas, PidRule::Momi, kpidn, ts)?;
        warn_about(&pid, areas, &mut warnings);
        Ok(Self { pid, warnings })
    }
}

pub(super) fn gains(areas: &Areas, tf: f64) -> Result<PidConfig, Refusal> {
    let normalised = Normalised::new(areas, tf)?;
    let gains = normalised.gains()?;
    if !(gains.kp.hi > 0.0 && gains.ki.hi > 0.0) {
        return Err(WRONG_SIGN);
    }
    let gains = Gains { kp: gains.kp.value(), ki: gains.ki.value(), kd: gains.kd.value() };
    let Gains { kp, ki, kd } = normalised.with_units(gains)?;
    Ok(PidConfig { kp, ki, kd, tf, b: 1.0, c: 1.0, ..PidConfig::default() })
}

/// What holds for every PID of the magnitude optimum.
pub(super) fn warn_about(pid: &PidConfig, areas: &Areas, warnings: &mut Warnings) {
    if pid.kd * areas.of(0) < 0.0 {
        let text = "the derivative acts against the other two terms: look at the margins, or use a PI";
        warn(warnings, Warning::Value { about: "kd", value: pid.kd, text });
    }
    if pid.tf == 0.0 && pid.kd != 0.0 {
        let text = "a derivative without a filter cannot be run: choose tf of at least ts";
        warn(warnings, Warning::Text { about: "tf", text });
    }
    let gain = gain_beyond_dead_time(pid, areas);
    if gain > LARGEST_GAIN {
        let text = "this much loop gain is left beyond the dead time, 1 is unstable: a longer tf, or a PI";
        warn(warnings, Warning::Value { about: "gain", value: gain, text });
    }
    let longest = areas.of(1) / areas.of(0);
    if pid.tf > longest {
        let text = "the filter is slower than the plant: allow more noise, or use a PI";
        warn(warnings, Warning::OutsideValidity { about: "tf", value: pid.tf, min: 0.0, max: longest, text });
    }
}

/// Loop gain beyond the dead time above which `Ms` is 3 by this alone.
const LARGEST_GAIN: f64 = 2.0 / 3.0;

/// The largest loop gain at frequencies from `pi/dead_time`, where the phase is beyond -180 degrees and turns fast; 0
/// without dead time or without a model. Of the reduced model: it is large only for plants that are mostly dead time.
fn gain_beyond_dead_time(pid: &PidConfig, areas: &Areas) -> f64 {
    let Ok(model) = Reduced::new(areas) else { return 0.0 };
    if model.fallback || model.dead_time <= 0.0 {
        return 0.0;
    }
    let mut largest = 0.0_f64;
    let mut w = core::f64::consts::PI / model.dead_time;
    // Seven decades: further out either the lags or the filter have brought the gain down for good.
    for _ in 0..24 {
        let controller = libm::hypot(pid.ki / w - pid.kd * w, pid.kp) / libm::hypot(1.0, pid.tf * w);
        let plant = model.gain / libm::hypot(1.0 - model.a2 * w * w, model.a1 * w);
        largest = largest.max(controller * plant.abs());
        w *= 2.0;
    }
    largest
}
