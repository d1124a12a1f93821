//! What a person writes for a whole loop.

use crate::alarm::AlarmConfig;
use crate::anti_windup::AntiWindupConfig;
use crate::limit::LimitConfig;
use crate::pid::PidConfig;
use crate::real::Real;
use crate::sample::FallbackConfig;
use crate::setpoint::SetpointConfig;

/// Parameters of a [`Controller`](crate::Controller); every part has a default, so that a plain PID needs only `pid`.
/// Every range is finite: bounds up to 1e12 in size, the lower below the upper; `off_output` and a fallback's output lie
/// within `limits`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ControllerConfig {
    /// The PID.
    pub pid: PidConfig,
    /// Range and rate of the output.
    pub limits: LimitConfig,
    /// Range, rate and tracking of the set-point.
    pub setpoint: SetpointConfig,
    /// Anti-windup rule.
    pub anti_windup: AntiWindupConfig,
    /// Half width of the error deadband \[y\]; default 0.
    pub deadband: f64,
    /// Lowest valid measurement \[y\]; default -1e6.
    pub measurement_lo: f64,
    /// Highest valid measurement \[y\]; default 1e6.
    pub measurement_hi: f64,
    /// Lowest offset \[u\]; default -1e6.
    pub offset_lo: f64,
    /// Highest offset \[u\]; default 1e6.
    pub offset_hi: f64,
    /// Policy for bad measurements.
    pub fallback: FallbackConfig,
    /// Alarms.
    pub alarms: AlarmConfig,
    /// Output in mode Off \[u\]; `None`: it stays where it is.
    pub off_output: Option<f64>,
    /// Output of a zeroed state before its first sample \[u\], taken when no read-back says what is applied; default
    /// 0, moved into the output's range.
    pub initial_output: f64,
}

impl Default for ControllerConfig {
    fn default() -> Self {
        Self {
            pid: PidConfig::default(),
            limits: LimitConfig::default(),
            setpoint: SetpointConfig::default(),
            anti_windup: AntiWindupConfig::default(),
            deadband: 0.0,
            measurement_lo: -1e6,
            measurement_hi: 1e6,
            offset_lo: -1e6,
            offset_hi: 1e6,
            fallback: FallbackConfig::default(),
            alarms: AlarmConfig::default(),
            off_output: None,
            initial_output: 0.0,
        }
    }
}

impl ControllerConfig {
    /// The same configuration with every number rounded to `T`: what a front end that runs in `T` sees. A host that
    /// runs `f32` rounds first, so that it builds the same law as C and Structured Text.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        Self {
            pid: self.pid.rounded::<T>(),
            limits: self.limits.rounded::<T>(),
            setpoint: self.setpoint.rounded::<T>(),
            anti_windup: match self.anti_windup {
                AntiWindupConfig::BackCalculation { tt } => {
                    AntiWindupConfig::BackCalculation { tt: tt.map(round) }
                }
                other => other,
            },
            deadband: round(self.deadband),
            measurement_lo: round(self.measurement_lo),
            measurement_hi: round(self.measurement_hi),
            offset_lo: round(self.offset_lo),
            offset_hi: round(self.offset_hi),
            fallback: self.fallback.rounded::<T>(),
            alarms: self.alarms.rounded::<T>(),
            off_output: self.off_output.map(round),
            initial_output: round(self.initial_output),
        }
    }
}
