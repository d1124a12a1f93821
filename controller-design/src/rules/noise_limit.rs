//! What a controller makes of measurement noise, and the filter for a wanted noise gain.
//!
//! The frequency that counts is a quarter of the sampling frequency, `w_HF = pi/(2*ts)` (Vrančić & Huba 2021,
//! eq. (26)). These are gains of the continuous design; a sampled controller differs from them by up to a fifth.

use core::f64::consts::FRAC_PI_2;

use controller_core::PidConfig;

use super::reduction::Reduced;
use super::{checks, drmo, momi};
use crate::areas::Areas;
use crate::warning::warn;
use crate::{Refusal, Warning, Warnings};

/// A rule that gives a PID for every filter time constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PidRule {
    /// [`Momi`](super::momi::Momi).
    Momi,
    /// [`Drmo`](super::drmo::Drmo).
    Drmo,
}

impl PidRule {
    fn gains(self, areas: &Areas, tf: f64) -> Result<PidConfig, Refusal> {
        match self {
            Self::Momi => momi::gains(areas, tf),
            Self::Drmo => drmo::gains(areas, tf),
        }
    }
}

/// `w_HF = pi/(2*ts)` in rad/s (Vrančić & Huba 2021, eq. (26)); `ts` in seconds.
///
/// ```
/// assert!((controller_design::rules::noise_limit::high_frequency(0.01) - 157.0796).abs() < 1e-4);
/// ```
#[must_use]
pub fn high_frequency(ts: f64) -> f64 {
    FRAC_PI_2 / ts
}

/// The gain of a PID at `w_HF` (Vrančić & Huba 2021, eq. (28)), 0 or more, in \[u/y\]; `ts` in seconds, above 0:
/// `|ki - kd*w^2 + j*kp*w| / (w*sqrt(1 + (w*tf)^2))`. Where a number is out of range the result is not finite.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::rules::noise_limit::kpidn;
/// let pid = PidConfig { kp: -3.0, ..PidConfig::default() };
/// assert_eq!(kpidn(&pid, 0.1), 3.0);
/// ```
#[must_use]
pub fn kpidn(pid: &PidConfig, ts: f64) -> f64 {
    let w = high_frequency(ts);
    libm::hypot(pid.ki / w - pid.kd * w, pid.kp) / libm::hypot(1.0, pid.tf * w)
}

/// The gain of a disturbance estimator at `w_HF` (Vrančić & Huba 2021, eq. (30)), in \[u/y\]; `tfd` and `ts` in
/// seconds: `kfd * |1 + a1*s + a2*s^2| / (|gain| * |1 + tfd*s|^3)` at `s = j*w_HF`.
///
/// ```
/// use controller_design::areas::Areas;
/// use controller_design::rules::{noise_limit::kden, reduction::Reduced};
/// // Vrančić & Huba 2021, eqs (36), (37)
/// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 1.2, 0.2], 0.2).expect("a stable plant");
/// let model = Reduced::new(&areas).expect("a model");
/// assert!((kden(&model, 0.6887, 0.05997, 0.01) - 4.0).abs() < 1e-3);
/// ```
#[must_use]
pub fn kden(model: &Reduced, kfd: f64, tfd: f64, ts: f64) -> f64 {
    let w = high_frequency(ts);
    let numerator = libm::hypot(1.0 - model.a2 * w * w, model.a1 * w);
    let filter = libm::hypot(1.0, tfd * w);
    kfd * (numerator / filter / filter / filter) / model.gain.abs()
}

/// The least [`kpidn`] that a rule can have for a plant, over all filter time constants from `ts` to 100 times the
/// longer of `A_1/A_0` and `ts`; infinite where the rule gives no controller at all. `ts` in seconds. Cost: as
/// [`Momi::with_noise_limit`](super::momi::Momi::with_noise_limit).
///
/// Often it is approached only by filters much slower than the plant, which are no good: ask for a few percent more.
///
/// ```
/// use controller_design::areas::Areas;
/// use controller_design::rules::noise_limit::{PidRule, least_kpidn};
/// // 1/((1+s)*(1+0.2*s)): no filter brings the gain below 2.6
/// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 1.2, 0.2], 0.0).expect("a stable plant");
/// assert!((least_kpidn(&areas, PidRule::Momi, 0.01) - 2.6).abs() < 0.001);
/// ```
#[must_use]
pub fn least_kpidn(areas: &Areas, rule: PidRule, ts: f64) -> f64 {
    Search { areas, rule, ts, limit: 0.0 }.run().least
}

/// The filter time constant with which a PID of given gains has the noise gain `kpidn`, at least `ts` \[s\] (Vrančić &
/// Huba 2021, eq. (29)); 0 for a PI that has no more than that without a filter.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::rules::noise_limit::{filter_time, kpidn};
/// let pid = PidConfig { kp: 2.0, ki: 1.0, kd: 0.5, ..PidConfig::default() };
/// let tf = filter_time(&pid, 3.0, 0.01)?;
/// assert!((kpidn(&PidConfig { tf, ..pid }, 0.01) - 3.0).abs() < 1e-12);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
///
/// # Errors
/// `kpidn` or `ts` not above 0.
pub fn filter_time(pid: &PidConfig, kpidn: f64, ts: f64) -> Result<f64, Refusal> {
    checks::positive("kpidn", kpidn)?;
    checks::positive("ts", ts)?;
    let ratio = self::kpidn(&PidConfig { tf: 0.0, ..*pid }, ts) / kpidn;
    if ratio <= 1.0 {
        return Ok(if pid.kd == 0.0 { 0.0 } else { ts });
    }
    let tf = libm::sqrt((ratio - 1.0) * (ratio + 1.0)) / high_frequency(ts);
    if tf.is_finite() { Ok(tf.max(ts)) } else { Err(checks::OUT_OF_RANGE) }
}

/// The PID with the shortest filter that keeps the noise limit.
pub(super) fn shortest_filter(
    areas: &Areas,
    rule: PidRule,
    kpidn: f64,
    ts: f64,
) -> Result<(PidConfig, Warnings), Refusal> {
    checks::positive("kpidn", kpidn)?;
    checks::positive("ts", ts)?;
    let found = Search { areas, rule, ts, limit: kpidn }.run();
    let Some(tf) = found.tf else {
        if found.least.is_finite() {
            let what = "the noise gain kpidn";
            return Err(Refusal::Unattainable { what, asked: kpidn, least: found.least });
        }
        // No filter gives a controller: say why, for the one that is most likely to.
        let typical = areas.of(1) / areas.of(0);
        let tf = if typical > 0.0 && typical.is_finite() { 0.1 * typical } else { ts };
        return Err(rule.gains(areas, tf).err().unwrap_or(Refusal::NoSolution {
            why: "no filter gives a controller for this plant",
            help: "use a rule for the shape of the frequency response",
        }));
    };
    let pid = rule.gains(areas, tf)?;
    let mut warnings = Warnings::new();
    let reached = self::kpidn(&pid, ts);
    if reached < kpidn * (1.0 - 1e-6) {
        let text = if tf == ts {
            "below the limit already with the shortest filter, tf = ts"
        } else {
            "below the limit: a shorter filter gives no controller"
        };
        warn(&mut warnings, Warning::Value { about: "kpidn", value: reached, text });
    }
    Ok((pid, warnings))
}

/// The search over the filter time constant.
struct Search<'a> {
    areas: &'a Areas,
    rule: PidRule,
    ts: f64,
    limit: f64,
}

/// What was found.
struct Found {
    /// The shortest filter within the limit, if there is one \[s\].
    tf: Option<f64>,
    /// The least gain met on the way; of all filters, where none is within the limit.
    least: f64,
}

/// Steps of the search: ten a decade. The gain varies with the filter over no less than a factor of two.
const STEP: f64 = 1.258_925_411_794_167_2;
/// Range of the search in units of the plant's residence time: beyond it the gain is constant to 1e-4.
const RANGE: f64 = 100.0;
/// Most steps: those over the whole range of `f64`.
const MOST: usize = 6200;

impl Search<'_> {
    /// The noise gain; infinite where there is no controller.
    fn gain(&self, tf: f64) -> f64 {
        match self.rule.gains(self.areas, tf).map(|pid| kpidn(&pid, self.ts)) {
            Ok(gain) if gain.is_finite() => gain,
            _ => f64::INFINITY,
        }
    }

    fn run(&self) -> Found {
        let mut found = Found { tf: None, least: f64::INFINITY };
        let longest = RANGE * (self.areas.of(1) / self.areas.of(0)).max(self.ts);
        if !(self.ts > 0.0 && longest.is_finite()) {
            return found;
        }
        // The last two points and their gains.
        let mut before = (self.ts, f64::INFINITY);
        let mut last = (self.ts, self.gain(self.ts));
        found.least = last.1;
        if last.1 <= self.limit {
            found.tf = Some(self.ts);
            return found;
        }
        for _ in 0..MOST {
            if last.0 >= longest {
                break;
            }
            let tf = (last.0 * STEP).min(longest);
            let here = (tf, self.gain(tf));
            found.least = found.least.min(here.1);
            if last.1 <= before.1 && last.1 < here.1 && last.1.is_finite() {
                let bottom = self.bottom(before.0, tf);
                found.least = found.least.min(bottom.1);
                if bottom.1 <= self.limit {
                    found.tf = Some(self.crossing(before.0, bottom.0));
                    return found;
                }
            }
            if here.1 <= self.limit {
                found.tf = Some(self.crossing(last.0, tf));
                return found;
            }
            (before, last) = (last, here);
        }
        found
    }

    /// The shortest filter within the limit between one that is not and one that is: false position on logarithmic
    /// scales (Illinois), halving in every third step.
    fn crossing(&self, out: f64, within: f64) -> f64 {
        let excess = |tf: f64| libm::log(self.gain(tf) / self.limit);
        let (mut out, mut within) = ((out, excess(out)), (within, excess(within)));
        // Of each end; halved when the other end has moved twice in a row.
        let mut weights = (1.0, 1.0);
        let mut last_moved_out = None;
        for step in 0..200 {
            if within.0 <= out.0 * (1.0 + 4.0 * f64::EPSILON) || within.1 >= -2.0 * f64::EPSILON {
                break;
            }
            let (up, down) = (weights.0 * out.1, weights.1 * within.1);
            let part = if step % 3 == 2 { 0.5 } else { up / (up - down) };
            let mut tf = out.0 * libm::exp(part * libm::log(within.0 / out.0));
            if !(out.0 < tf && tf < within.0) {
                tf = out.0 * libm::sqrt(within.0 / out.0);
            }
            let here = (tf, excess(tf));
            let moves_out = here.1.is_nan() || here.1 > 0.0;
            let twice = last_moved_out == Some(moves_out);
            if moves_out {
                out = here;
                weights = (1.0, if twice { 0.5 * weights.1 } else { 1.0 });
            } else {
                within = here;
                weights = (if twice { 0.5 * weights.0 } else { 1.0 }, 1.0);
            }
            last_moved_out = Some(moves_out);
        }
        within.0
    }

    /// The least gain between two filters: golden section on a logarithmic scale.
    fn bottom(&self, low: f64, high: f64) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let at = |part: f64| low * libm::exp(part * libm::log(high / low));
        let (mut a, mut b) = (0.0, 1.0);
        let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        let (mut at_c, mut at_d) = (self.gain(at(c)), self.gain(at(d)));
        for _ in 0..40 {
            if at_c <= at_d {
                (b, d, at_d) = (d, c, at_c);
                c = b - GOLDEN * (b - a);
                at_c = self.gain(at(c));
            } else {
                (a, c, at_c) = (c, d, at_d);
                d = a + GOLDEN * (b - a);
                at_d = self.gain(at(d));
            }
        }
        if at_c <= at_d { (at(c), at_c) } else { (at(d), at_d) }
    }
}
