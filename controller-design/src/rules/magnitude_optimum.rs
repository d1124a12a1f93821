//! What MOMI and DRMO share: areas without units, and the gains of eq. (6).

use super::checks;
use crate::Refusal;
use crate::areas::Areas;
use crate::double::{Double, exponent};

/// The filtered areas `A*` of eq. (7) without units: `n_k = A*_k / (A_0*t^k)` with `t = A*_1/A_0`, so that
/// `n_0 = n_1 = 1`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Normalised {
    /// `A_0`.
    pub(super) gain: f64,
    /// `t` in seconds.
    pub(super) time: f64,
    /// `n_0..n_5`.
    pub(super) n: [Double; 6],
    /// Relative error of each by rounding.
    pub(super) error: f64,
}

/// What a process without usable areas is told.
const NOT_SELF_REGULATING: Refusal = Refusal::Plant {
    must: "have a positive A_1/A_0: its output must on the whole follow its input",
    help: "use a rule for the shape of the frequency response; recorded areas: check the record",
};

impl Normalised {
    /// `tf` in seconds, 0 or more.
    pub(super) fn new(areas: &Areas, tf: f64) -> Result<Self, Refusal> {
        checks::not_negative("tf", tf)?;
        let values = areas.values();
        if !values.iter().all(|a| a.is_finite()) {
            return Err(Refusal::Plant {
                must: "have finite areas",
                help: "check the model or the record they come from",
            });
        }
        checks::gain(values[0])?;
        if values[1] * values[0].signum() <= 0.0 {
            return Err(NOT_SELF_REGULATING);
        }
        // Powers of two first: nothing is rounded and no power of a time leaves the range.
        let unit_gain = exponent(values[0]);
        let own_unit = exponent(values[1]).saturating_sub(unit_gain);
        let unit = if tf == 0.0 { own_unit } else { own_unit.max(exponent(tf)) };
        let filter = libm::scalbn(tf, -unit);
        let gain = Double { hi: areas.double(0).hi, lo: areas.double(0).lo }.scaled(-unit_gain);
        let mut n = [Double::default(); 6];
        let mut last = Double::default();
        for (k, item) in (0_i32..).zip(n.iter_mut()) {
            let index = usize::try_from(k).unwrap_or(0);
            let shift = unit.saturating_mul(k).saturating_add(unit_gain).saturating_neg();
            let own = areas.double(index).scaled(shift).div(gain);
            last = own.add(last.times(filter));
            *item = last;
        }
        let time = n[1];
        let mut power = Double::new(1.0);
        for item in &mut n {
            *item = item.div(power);
            power = power.mul(time);
        }
        let result =
            Self { gain: values[0], time: libm::scalbn(time.value(), unit), n, error: areas.error() };
        let usable = result.time.is_finite() && result.time >= f64::MIN_POSITIVE;
        if usable && result.n.iter().all(|n| n.hi.is_finite()) {
            Ok(result)
        } else {
            Err(Refusal::Plant {
                must: "have areas whose ratios fit into double precision",
                help: "write the plant in a unit of time in which its time constants are near 1",
            })
        }
    }

    /// Gains with units from those without: `kp/A_0`, `ki/(A_0*t)`, `kd*t/A_0`.
    pub(super) fn with_units(&self, gains: Gains) -> Result<Gains, Refusal> {
        let Gains { kp, ki, kd } = gains;
        let gains =
            Gains { kp: kp / self.gain, ki: ki / self.time / self.gain, kd: kd * (self.time / self.gain) };
        let fine = |x: f64| x.is_finite() && x.abs() >= f64::MIN_POSITIVE;
        if fine(gains.kp) && fine(gains.ki) && gains.kd.is_finite() {
            Ok(gains)
        } else {
            Err(checks::OUT_OF_RANGE)
        }
    }

    /// The gains of eq. (6), without units.
    ///
    /// With `p = n4 - n2*n3` and `q = n5 - n3^2` the three equations give `ki = p/(2(p-q))`, `kp = q/(2(p-q))`,
    /// `kd = (n2*q - n3*p)/(2(p-q))`.
    pub(super) fn gains(&self) -> Result<DoubleGains, Refusal> {
        let [_, _, n2, n3, n4, n5] = self.n;
        let (n23, n33) = (n2.mul(n3), n3.mul(n3));
        let (p, q) = (n4.sub(n23), n5.sub(n33));
        let divisor = p.sub(q);
        let terms = n4.hi.abs() + n23.hi.abs() + n5.hi.abs() + n33.hi.abs();
        if divisor.hi.is_nan() || divisor.hi.abs() <= 64.0 * self.error * terms {
            return Err(Refusal::NoSolution {
                why: "the process and its filter are no more than two lags: the magnitude optimum has no largest gain",
                help: "give the plant the dead time or the fast lags that were left out",
            });
        }
        let twice = divisor.times(2.0);
        Ok(DoubleGains { kp: q.div(twice), ki: p.div(twice), kd: n2.mul(q).sub(n3.mul(p)).div(twice) })
    }
}

/// Gains of a PID.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gains {
    pub(super) kp: f64,
    pub(super) ki: f64,
    pub(super) kd: f64,
}

/// Gains of a PID with all their digits.
#[derive(Debug, Clone, Copy)]
pub(super) struct DoubleGains {
    pub(super) kp: Double,
    pub(super) ki: Double,
    pub(super) kd: Double,
}

/// What is said when a gain acts in the wrong direction.
pub(super) const WRONG_SIGN: Refusal = Refusal::NoSolution {
    why: "the magnitude optimum has gains of the wrong sign for this plant and filter",
    help: "choose another filter, or a rule for the shape of the frequency response",
};
