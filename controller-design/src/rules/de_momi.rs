//! DE-MOMI: a MOMI controller with a disturbance estimator.

use controller_core::{EstimatorConfig, PidConfig};

use super::checks::positive;
use super::momi::Momi;
use super::noise_limit::{high_frequency, kden};
use super::reduction::Reduced;
use crate::areas::Areas;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// A PID for set-points with an estimator that takes away most of a load disturbance (Vrančić & Huba 2021, section
/// 4): eqs (6), (7) for the PID, (14) for the model, (18), (19) for the gain of the estimator, (29), (31) for the
/// filters.
#[derive(Debug, Clone, PartialEq)]
pub struct DeMomi {
    /// The gains, those of [`Momi`].
    pub pid: PidConfig,
    /// The estimator; `None` where it must stay off: see the warnings.
    pub estimator: Option<EstimatorConfig>,
    /// The model that the estimator uses.
    pub model: Reduced,
    /// What to know about it.
    pub warnings: Warnings,
}

impl DeMomi {
    /// The parameters for given filter time constants: `tf` of the PID, 0 or more, and `tfd` of the estimator, above
    /// 0, both in seconds (Fig. 5 of the paper).
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::de_momi::DeMomi;
    /// // exp(-0.5*s)/(1+s)^2, eq. (23) of Vrančić & Huba 2021: 0.57
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 2.0, 1.0], 0.5).expect("a stable plant");
    /// let design = DeMomi::new(&areas, 0.1, 0.1).expect("a design");
    /// assert!((design.estimator.expect("an estimator").kfd - 0.5725510579).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    /// As for [`Momi::new`] and [`Reduced::new`]; a `tfd` that is not above 0.
    pub fn new(areas: &Areas, tf: f64, tfd: f64) -> Result<Self, Refusal> {
        positive("tfd", tfd)?;
        Ok(Self::with(Momi::new(areas, tf)?, Reduced::new(areas)?, |_| tfd))
    }

    /// The parameters with the shortest filters, at least `ts`, that keep the gains for measurement noise of the PID
    /// and of the estimator at `w_HF = pi/(2*ts)` within `kpidn` and `kden` \[u/y\]; `ts` in seconds (Figs 9, 10 of
    /// the paper, searched for between brackets).
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::de_momi::DeMomi;
    /// // exp(-0.2*s)/((1+0.2*s)*(1+s)), eqs (35), (37): T_F 0.119, T_FD 0.06, K_FD 0.69
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 1.2, 0.2], 0.2).expect("a stable plant");
    /// let design = DeMomi::with_noise_limits(&areas, 4.0, 4.0, 0.01).expect("a design");
    /// let estimator = design.estimator.expect("an estimator");
    /// assert!((design.pid.tf - 0.1187).abs() < 1e-4);
    /// assert!((estimator.tfd - 0.05997).abs() < 1e-5 && (estimator.kfd - 0.6887).abs() < 1e-4);
    /// ```
    ///
    /// # Errors
    /// As for [`Momi::with_noise_limit`] and [`Reduced::new`]; a `kden` that is not above 0.
    pub fn with_noise_limits(areas: &Areas, kpidn: f64, kden: f64, ts: f64) -> Result<Self, Refusal> {
        positive("kden", kden)?;
        Self::limited(areas, Momi::with_noise_limit(areas, kpidn, ts)?, kden, ts)
    }

    /// The parameters for a given filter time constant `tf` of the PID \[s\] and the shortest filter of the estimator, at
    /// least `ts`, that keeps its noise gain at `w_HF` within `kden` \[u/y\].
    ///
    /// # Errors
    /// As for [`Momi::new`] and [`Reduced::new`]; a `kden` or `ts` that is not above 0.
    pub fn with_estimator_limit(areas: &Areas, tf: f64, kden: f64, ts: f64) -> Result<Self, Refusal> {
        positive("kden", kden)?;
        positive("ts", ts)?;
        Self::limited(areas, Momi::new(areas, tf)?, kden, ts)
    }

    fn limited(areas: &Areas, momi: Momi, kden: f64, ts: f64) -> Result<Self, Refusal> {
        let model = Reduced::new(areas)?;
        let pid = momi.pid;
        let mut design = Self::with(momi, model, |model| shortest_tfd(&pid, model, kden, ts));
        if let Some(estimator) = &design.estimator {
            let reached = super::noise_limit::kden(&design.model, estimator.kfd, estimator.tfd, ts);
            if reached < kden * (1.0 - 1e-6) {
                let text = "below the limit already with the shortest filter, tfd = ts";
                warn(&mut design.warnings, Warning::Value { about: "kden", value: reached, text });
            }
        }
        Ok(design)
    }

    fn with(momi: Momi, model: Reduced, tfd: impl Fn(&Reduced) -> f64) -> Self {
        let Momi { pid, mut warnings } = momi;
        for warning in &model.warnings {
            warn(&mut warnings, *warning);
        }
        let mut off = |text| warn(&mut warnings, Warning::Text { about: "estimator", text });
        let estimator = if model.fallback {
            off("off: its model would be too rough");
            None
        } else if model.a1 <= 0.0 {
            off("off: a pure dead time has nothing that could be estimated");
            None
        } else {
            let tfd = tfd(&model);
            let kfd = kfd(&pid, &model, tfd);
            let Reduced { gain, a1, a2, dead_time, .. } = model;
            if kfd > 0.0 {
                Some(EstimatorConfig { gain, a1, a2, dead_time, kfd, tfd })
            } else {
                off("off: no gain of it improves the rejection of disturbances here");
                None
            }
        };
        Self { pid, estimator, model, warnings }
    }
}

/// The gain `K_FD` of the estimator for which `|Y/(D*s)|` of the loop is flat at `w^2` (Vrančić & Huba 2021, eqs (18),
/// (19)), from 0 to below 1; `tfd` in seconds, the controller's filter is that in `pid`.
///
/// 0 where no gain between 0 and 1 has this property (`c_0 >= 0`, as for weakly damped processes) and where a number
/// is out of range: the estimator is best left off. The root is taken in the form that does not cancel.
///
/// ```
/// use controller_design::areas::Areas;
/// use controller_design::rules::{de_momi::kfd, momi::Momi, reduction::Reduced};
/// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 3.0, 3.0, 1.0], 0.2).expect("a stable plant");
/// let (momi, model) = (Momi::new(&areas, 0.1).expect("a PID"), Reduced::new(&areas).expect("a model"));
/// assert!((kfd(&momi.pid, &model, 0.1) - 0.5891870397).abs() < 1e-9);
/// ```
#[must_use]
pub fn kfd(pid: &PidConfig, model: &Reduced, tfd: f64) -> f64 {
    // All times in units of the model's residence time.
    let unit = model.a1 + model.dead_time;
    let kp = pid.kp * model.gain;
    let ki = pid.ki * model.gain * unit;
    let kd = pid.kd * model.gain / unit;
    let (tf, tfd, dead_time) = (pid.tf / unit, tfd / unit, model.dead_time / unit);
    let d0 = (1.0 + kp) * (1.0 + kp);
    let f0 = model.a1 / unit + kd + tf + dead_time;
    let base = d0 - 2.0 * f0 * ki;
    let square = ki * ki;
    let a0 = -base + square * (tf * tf - 3.0 * tfd * tfd);
    let b0 = 2.0 * base
        + square * (-2.0 * tf * tf + 12.0 * tfd * tfd + 6.0 * tfd * dead_time + dead_time * dead_time);
    let c0 = -base + square * tf * tf;
    let radicand = b0 * b0 - 4.0 * a0 * c0;
    let kfd = -2.0 * c0 / (b0 + libm::sqrt(radicand.max(0.0)));
    if c0 < 0.0 && kfd > 0.0 && kfd < 1.0 { kfd } else { 0.0 }
}

/// The shortest filter of the estimator, at least `ts`, within its noise limit (Vrančić & Huba 2021, eq. (31) with
/// `K_FD` of eq. (18)).
fn shortest_tfd(pid: &PidConfig, model: &Reduced, limit: f64, ts: f64) -> f64 {
    let within = |tfd: f64| kden(model, kfd(pid, model, tfd), tfd, ts) <= limit;
    if within(ts) {
        return ts;
    }
    // The gain is below 1, so that eq. (31) with a gain of 1 is long enough.
    let w = high_frequency(ts);
    let third = libm::cbrt(kden(model, 1.0, 0.0, ts) / limit);
    let (mut out, mut long) = (ts, (third / w).max(2.0 * ts));
    for _ in 0..1100 {
        let middle = out * libm::sqrt(long / out);
        if !(middle > out && middle < long) {
            break;
        }
        if within(middle) { long = middle } else { out = middle }
    }
    long
}
