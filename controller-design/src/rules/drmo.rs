//! DRMO: a PID for disturbances by the magnitude optimum.

use controller_core::PidConfig;

use super::magnitude_optimum::{Gains, Normalised, WRONG_SIGN};
use super::momi::warn_about;
use super::noise_limit::{self, PidRule};
use crate::areas::Areas;
use crate::double::Double;
use crate::{Refusal, Warnings};

/// The PID whose response to a load step has `|Y/(D*s)|` flat up to `w^4` (Vrančić & Huba 2021, eqs (7), (9), (10)).
///
/// `kd` is that of [`Momi`](super::momi::Momi). `b = c = 0`: set-points are followed slowly and without overshoot. The
/// printed eq. (10) has a misprint, the factor 2 before `K_D` in `beta`; this is the corrected form, which alone
/// gives the paper's own tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Drmo {
    /// The gains; their sign is that of the plant's gain.
    pub pid: PidConfig,
    /// What to know about it.
    pub warnings: Warnings,
}

impl Drmo {
    /// The gains for a filter time constant `tf` \[s\], 0 or more.
    ///
    /// ```
    /// use controller_design::areas::Areas;
    /// use controller_design::rules::drmo::Drmo;
    /// // exp(-0.5*s)/(1+s)^2, Table 2 of Vrančić & Huba 2021: 2.25, 1.49, 0.93
    /// let areas = Areas::of_model(1.0, &[1.0], &[1.0, 2.0, 1.0], 0.5).expect("a stable plant");
    /// let pid = Drmo::new(&areas, 0.1).expect("a PID").pid;
    /// assert!((pid.kp - 2.246876).abs() < 1e-6 && (pid.ki - 1.491530).abs() < 1e-6);
    /// ```
    ///
    /// # Errors
    /// As for [`Momi::new`](super::momi::Momi::new); eq. (9) without a real root.
    pub fn new(areas: &Areas, tf: f64) -> Result<Self, Refusal> {
        let pid = gains(areas, tf)?;
        let mut warnings = Warnings::new();
        warn_about(&pid, areas, &mut warnings);
        Ok(Self { pid, warnings })
    }

    /// The gains for the shortest filter, as for [`Momi::with_noise_limit`](super::momi::Momi::with_noise_limit).
    ///
    /// # Errors
    /// As for [`new`](Self::new); `kpidn` or `ts` not above 0; a `kpidn` below the least that any filter can give.
    pub fn with_noise_limit(areas: &Areas, kpidn: f64, ts: f64) -> Result<Self, Refusal> {
        let (pid, mut warnings) = noise_limit::shortest_filter(areas, PidRule::Drmo, kpidn, ts)?;
        warn_about(&pid, areas, &mut warnings);
        Ok(Self { pid, warnings })
    }
}

pub(super) fn gains(areas: &Areas, tf: f64) -> Result<PidConfig, Refusal> {
    let normalised = Normalised::new(areas, tf)?;
    let kd = normalised.gains()?.kd;
    let [one, _, n2, n3, _, _] = normalised.n;
    // Eq. (10) with A_0 = A_1 = 1.
    let alpha = one.add(n3).sub(n2.times(2.0));
    let beta = n2.sub(n3).add(kd.mul(one.sub(n2)));
    let square = kd.mul(kd);
    let gamma = square.mul(kd).add(square.times(3.0)).add(kd.mul(n2.times(2.0).add(one))).add(n3);
    let radicand = beta.mul(beta).sub(alpha.mul(gamma));
    if radicand.hi < 0.0 {
        return Err(Refusal::NoSolution {
            why: "the equations of DRMO have no real solution for this plant and filter",
            help: "choose another filter",
        });
    }
    // The second form of eq. (9) does not cancel and holds for alpha = 0 as well.
    let divisor = beta.add(radicand.sqrt());
    let all = one.add(kd);
    if !(gamma.hi > 0.0 && divisor.hi > 0.0 && all.hi > 0.0) {
        return Err(WRONG_SIGN);
    }
    let kp = gamma.div(divisor);
    let both: Double = one.add(kp);
    let ki = both.mul(both).div(all.times(2.0));
    let gains = Gains { kp: kp.value(), ki: ki.value(), kd: kd.value() };
    let Gains { kp, ki, kd } = normalised.with_units(gains)?;
    Ok(PidConfig { kp, ki, kd, tf, b: 0.0, c: 0.0, ..PidConfig::default() })
}
