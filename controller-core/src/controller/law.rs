//! The loop itself.

use super::config::ControllerConfig;
use crate::adrc::{Adrc, AdrcConfig};
use crate::alarm::Alarms;
use crate::anti_windup::{AntiWindup, AntiWindupConfig};
use crate::compensator::{Compensate, NoCompensator};
use crate::deadband::Deadband;
use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::limit::{Limit, RANGE_LIMIT};
use crate::pid::Pid;
use crate::real::{Real, coefficient};
use crate::regulator::Regulator;
use crate::sample::SampleGuard;
use crate::setpoint::Setpoint;
use crate::stored::{Flag, Optional};

/// A whole control loop for one sampling period: the law `L` ([`Pid`], or [`Adrc`]), compensator `C`, limits, set-point, anti-windup, modes, bad
/// samples, alarms, in the order of the [module](crate::controller).
///
/// Difference equation: `v[k] = I[k] + pd[k] + offset[k] + u_f[k]`, `u[k] = limit(v[k])`, the parts as their blocks say.
/// Source: the signal flow of both papers (eqs (8)-(10) and fig. 2 of Tena et al. 2022; section 4 of Vrančić & Huba 2021).
/// A step is total: for every bit pattern of every input the output is finite and in its range, the state finite.
/// Cost: its blocks plus about 40 compares and selects; no loop but those of the compensator's fixed order, so that the
/// bound depends on the law alone. The first good sample of a zeroed state also fills the delay line.
///
/// ```
/// use controller_core::{Controller, ControllerConfig, ControllerInput, LimitConfig, PidConfig};
/// let config = ControllerConfig {
///     pid: PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() },
///     limits: LimitConfig::range(0.0, 100.0),
///     ..ControllerConfig::default()
/// };
/// let law = Controller::<f32>::new(&config, 0.1).unwrap();
/// let mut state = law.zeroed();
/// law.settle(&mut state, 20.0, 20.0, 30.0);
/// let out = law.step(&mut state, &ControllerInput { r: 25.0, y: 20.0, ..ControllerInput::default() });
/// assert_eq!(out.u, 30.0 + 2.0 * 5.0 + 0.25);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Controller<T, C = NoCompensator, L = Pid<T>> {
    pub(super) law: L,
    pub(super) compensator: C,
    pub(super) limit: Limit<T>,
    pub(super) setpoint: Setpoint<T>,
    pub(super) anti_windup: AntiWindup<T>,
    pub(super) deadband: Deadband<T>,
    pub(super) guard: SampleGuard<T>,
    pub(super) alarms: Alarms<T>,
    pub(super) offset_lo: T,
    pub(super) offset_hi: T,
    pub(super) off_output: Optional<T>,
    pub(super) initial_output: T,
    pub(super) integral_bound: T,
    pub(super) reversed: Flag,
    pub(super) ts: T,
}

impl<T: Real> Controller<T, NoCompensator> {
    /// A loop without a compensator.
    ///
    /// # Errors
    /// As [`with_compensator`](Self::with_compensator).
    pub fn new(config: &ControllerConfig, ts: f64) -> Result<Self, ConfigErrors> {
        Self::with_compensator(config, NoCompensator, ts)
    }
}

impl<T: Real, C: Compensate<T>> Controller<T, C> {
    /// A loop with the compensator law `compensator`, built for the same sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every fault of every part, all at once: see each part's `new`. Gains and ranges whose product could overflow
    /// `T` on the way are refused as [`Param::Overflow`].
    pub fn with_compensator(
        config: &ControllerConfig,
        compensator: C,
        ts: f64,
    ) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        let pid = check.merge(|| Pid::new(&config.pid, ts));
        let [kp, ki, _] = config.pid.signed_gains();
        let reversed = ki < 0.0 || (ki == 0.0 && kp < 0.0);
        Self::compose(check, config, pid, reversed, compensator, ts)
    }

    /// The PID law.
    #[must_use]
    pub fn pid(&self) -> &Pid<T> {
        &self.law
    }
}

impl<T: Real> Controller<T, NoCompensator, Adrc<T>> {
    /// A loop with an ADRC in place of the PID, for the sampling period `ts` \[s\]. Everything else of `config` means
    /// the same: limits, set-point, modes, bad samples, alarms.
    ///
    /// The observer runs in every mode on what was applied; an offset is known to it. Saturation needs no anti-windup
    /// rule, `config.anti_windup` has no effect, nor do `inhibit_up` and `inhibit_down`: give the read-back. On a bad
    /// sample the estimates hold. Closing the loop begins at the output that is there: what the feedback would jump by
    /// goes into the estimate of the disturbance, which the observer then corrects.
    ///
    /// Cost: as a PID loop; the law 35 operations in place of 29, 5 compares more for the bounds of its states.
    ///
    /// # Errors
    /// As [`with_compensator`](Self::with_compensator); `config.pid` must be left at its default gains of 0, and
    /// `config.deadband` at 0: an observer would take the band for the plant.
    ///
    /// ```
    /// use controller_core::{AdrcConfig, Controller, ControllerConfig, ControllerInput, LimitConfig};
    /// let config = ControllerConfig { limits: LimitConfig::range(-2.0, 2.0), ..ControllerConfig::default() };
    /// let law = Controller::<f32, _, _>::with_adrc(&config, &AdrcConfig::from_bandwidths(5.0, 10.0, 40.0), 0.001).unwrap();
    /// let mut state = law.zeroed();
    /// law.settle(&mut state, 1.0, 1.0, 0.5);
    /// let out = law.step(&mut state, &ControllerInput { r: 1.01, y: 1.0, ..ControllerInput::default() });
    /// assert!((out.u - (0.5 + 20.0 * 0.01)).abs() < 1e-4);
    /// ```
    pub fn with_adrc(config: &ControllerConfig, adrc: &AdrcConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let mut check = Checker::default();
        let law = check.merge(|| Adrc::new(adrc, ts));
        let pid = &config.pid;
        for (param, gain) in [(Param::Kp, pid.kp), (Param::Ki, pid.ki), (Param::Kd, pid.kd)] {
            check.range(param, gain, 0.0, 0.0);
        }
        check.range(Param::Deadband, config.deadband, 0.0, 0.0);
        let config = ControllerConfig { anti_windup: AntiWindupConfig::None, deadband: 0.0, ..*config };
        Self::compose(check, &config, law, adrc.b0 < 0.0, NoCompensator, ts)
    }

    /// The ADRC law.
    #[must_use]
    pub fn adrc(&self) -> &Adrc<T> {
        &self.law
    }
}

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// The loop around `law`, whose faults are in `check` when there is none.
    fn compose(
        mut check: Checker,
        config: &ControllerConfig,
        law: Option<L>,
        reversed: bool,
        compensator: C,
        ts: f64,
    ) -> Result<Self, ConfigErrors> {
        let limit = check.merge(|| Limit::new(&config.limits, ts));
        let setpoint = check.merge(|| Setpoint::new(&config.setpoint, ts));
        let anti_windup = check.merge(|| AntiWindup::new(&config.anti_windup, &config.pid, ts));
        let deadband = check.merge(|| Deadband::new(config.deadband));
        let guard = check
            .merge(|| SampleGuard::new(&config.fallback, config.measurement_lo, config.measurement_hi, ts));
        let alarms = check.merge(|| Alarms::new(&config.alarms));
        let offsets = ((Param::OffsetLo, config.offset_lo), (Param::OffsetHi, config.offset_hi));
        check.bounds(offsets.0, offsets.1, RANGE_LIMIT);
        let (lo, hi) = (config.limits.lo, config.limits.hi);
        check.optional(Param::OffOutput, config.off_output, lo, hi);
        check.optional(Param::FallbackOutput, config.fallback.action.output(), lo, hi);
        check.range(Param::InitialOutput, config.initial_output, -RANGE_LIMIT, RANGE_LIMIT);
        let [_, ki, _] = config.pid.signed_gains();
        let inv_gain = compensator.inv_gain().to_f64();
        if ki * inv_gain < 0.0 {
            check.fault(Param::ModelGain, Reason::SignMismatch, 1.0 / inv_gain, 0.0, 0.0);
        }
        if let Some(other) = compensator.ts().filter(|&other| other != coefficient::<T>(ts)) {
            check.fault(Param::Ts, Reason::Mismatch, ts, other.to_f64(), other.to_f64());
        }
        if let (true, Some(law)) = (check.is_clean(), &law) {
            Self::check_overflow(&mut check, config, law, &compensator);
        }
        let parts = (law, limit, setpoint, anti_windup, deadband, guard, alarms);
        let (
            Some(law),
            Some(limit),
            Some(setpoint),
            Some(anti_windup),
            Some(deadband),
            Some(guard),
            Some(alarms),
        ) = parts
        else {
            // A part is missing only when its faults are in `check`; this says so to the type system.
            check.into_result()?;
            return Err(ConfigErrors::default());
        };
        check.finish(Self {
            law,
            compensator,
            limit,
            setpoint,
            anti_windup,
            deadband,
            guard,
            alarms,
            offset_lo: coefficient(config.offset_lo),
            offset_hi: coefficient(config.offset_hi),
            off_output: Optional::new(config.off_output.map(coefficient)),
            initial_output: limit.into_range(coefficient(config.initial_output)),
            integral_bound: T::from_f64(1e-3 * T::LARGEST),
            reversed: Flag::new(reversed),
            ts: coefficient(ts),
        })
    }

    /// No product or sum of a step may leave a millionth of the number type's range.
    fn check_overflow(check: &mut Checker, config: &ControllerConfig, law: &L, compensator: &C) {
        let larger = |a: f64, b: f64| if a.abs() > b.abs() { a.abs() } else { b.abs() };
        let y = larger(config.measurement_lo, config.measurement_hi);
        let r = larger(config.setpoint.lo, config.setpoint.hi);
        let u = larger(config.limits.lo, config.limits.hi);
        let signal = y + r + config.deadband.abs();
        let offset = larger(config.offset_lo, config.offset_hi);
        let (from_y, from_u) = compensator.bounds();
        let worst = law.bound(signal, u + offset) + from_y * y + from_u * u + offset;
        let most = 1e-6 * T::LARGEST;
        if worst.is_nan() || worst > most {
            check.fault(Param::Overflow, Reason::OutOfRange, worst, 0.0, most);
        }
    }

    /// The compensator law.
    #[must_use]
    pub fn compensator(&self) -> &C {
        &self.compensator
    }

    /// The output's range \[u\].
    #[must_use]
    pub fn output_range(&self) -> (T, T) {
        (self.limit.lo(), self.limit.hi())
    }
}
