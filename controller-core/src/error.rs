//! What is wrong with a configuration: every fault at once, each with its parameter, value and range.

use core::fmt;
use heapless::Vec;

/// How many faults one [`ConfigErrors`] can hold: more than one loop has parameters; without an operating system 12. A
/// fault takes 32 bytes, and several lists of them lie on the stack of the caller of `new`: with 48 it would need most of a
/// small controller's memory (15 KB on a Cortex-M0).
pub const MAX_FAULTS: usize = if cfg!(target_os = "none") { 12 } else { 48 };

macro_rules! params {
    ($($(#[$doc:meta])* $name:ident = $number:literal, $text:literal;)*) => {
        /// The parameter a fault is about. The numbers are stable: they are what C and PLC programs see.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        #[repr(u8)]
        pub enum Param { $($(#[$doc])* $name = $number,)* }

        impl Param {
            /// The parameter's name as it is written in a configuration, for example `limits.rate_up`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }
        }

        #[cfg(feature = "defmt")]
        impl defmt::Format for Param {
            fn format(&self, f: defmt::Formatter<'_>) {
                match self { $(Self::$name => defmt::write!(f, $text),)* }
            }
        }
    };
}

params! {
    /// Sampling period.
    Ts = 1, "ts";
    /// Proportional gain.
    Kp = 2, "pid.kp";
    /// Integral gain.
    Ki = 3, "pid.ki";
    /// Derivative gain.
    Kd = 4, "pid.kd";
    /// Filter time constant.
    Tf = 5, "pid.tf";
    /// Set-point weight of the proportional term.
    B = 6, "pid.b";
    /// Set-point weight of the derivative term.
    C = 7, "pid.c";
    /// Tracking time constant.
    Tt = 8, "anti_windup.tt";
    /// Lower output limit.
    OutputLo = 9, "limits.lo";
    /// Upper output limit.
    OutputHi = 10, "limits.hi";
    /// Output rate limit, upwards.
    OutputRateUp = 11, "limits.rate_up";
    /// Output rate limit, downwards.
    OutputRateDown = 12, "limits.rate_down";
    /// Lower set-point limit.
    SetpointLo = 13, "setpoint.lo";
    /// Upper set-point limit.
    SetpointHi = 14, "setpoint.hi";
    /// Set-point rate limit, upwards.
    SetpointRateUp = 15, "setpoint.rate_up";
    /// Set-point rate limit, downwards.
    SetpointRateDown = 16, "setpoint.rate_down";
    /// Half width of the error deadband.
    Deadband = 17, "deadband";
    /// Lower end of the measurement range.
    MeasurementLo = 18, "measurement.lo";
    /// Upper end of the measurement range.
    MeasurementHi = 19, "measurement.hi";
    /// Lower end of the offset input's range.
    OffsetLo = 20, "offset.lo";
    /// Upper end of the offset input's range.
    OffsetHi = 21, "offset.hi";
    /// Output value of the fallback.
    FallbackOutput = 22, "fallback.output";
    /// Rate towards the fallback's output.
    FallbackRate = 23, "fallback.rate";
    /// Output in mode Off.
    OffOutput = 24, "off_output";
    /// Output before anything else is known.
    InitialOutput = 25, "initial_output";
    /// Alarm level, measurement very high.
    AlarmHiHi = 26, "alarms.hi_hi";
    /// Alarm level, measurement high.
    AlarmHi = 27, "alarms.hi";
    /// Alarm level, measurement low.
    AlarmLo = 28, "alarms.lo";
    /// Alarm level, measurement very low.
    AlarmLoLo = 29, "alarms.lo_lo";
    /// Alarm level, deviation.
    AlarmDeviation = 30, "alarms.deviation";
    /// Alarm hysteresis.
    AlarmHysteresis = 31, "alarms.hysteresis";
    /// Model gain.
    ModelGain = 32, "model.gain";
    /// Model denominator.
    ModelPoles = 33, "model.poles";
    /// Model numerator.
    ModelZeros = 34, "model.zeros";
    /// Order of the model.
    ModelOrder = 35, "model.order";
    /// Dead time of the model.
    DeadTime = 36, "dead_time";
    /// Latency from reading `y` to acting `u`.
    Latency = 37, "latency";
    /// Gain of the disturbance estimator.
    Kfd = 38, "estimator.kfd";
    /// Filter time constant of the disturbance estimator.
    Tfd = 39, "estimator.tfd";
    /// Filter time constant of the disturbance observer.
    Alpha = 40, "observer.alpha";
    /// Filter order of the compensator.
    FilterOrder = 41, "observer.order";
    /// Delay memory.
    Capacity = 42, "capacity";
    /// Proportional band.
    ProportionalBand = 43, "proportional_band";
    /// Span of the measurement or of the output.
    Span = 44, "span";
    /// High-frequency gain times signal range: what would overflow.
    Overflow = 45, "gain times range";
    /// Input gain of an ADRC's model.
    B0 = 46, "adrc.b0";
    /// Gain of an ADRC's feedback from the output.
    AdrcKp = 47, "adrc.kp";
    /// Gain of an ADRC's feedback from the slope.
    AdrcKd = 48, "adrc.kd";
    /// Observer gain of an ADRC into the output.
    Beta1 = 49, "adrc.beta1";
    /// Observer gain of an ADRC into the slope.
    Beta2 = 50, "adrc.beta2";
    /// Observer gain of an ADRC into the disturbance.
    Beta3 = 51, "adrc.beta3";

    // From 64 on: sensors, actuators and signal blocks of `controller-hal`.
    /// Counts of a converter at the ends of a span.
    Counts = 64, "counts";
    /// Counts between which a sensor is in order.
    GoodCounts = 65, "good";
    /// Counts between which a sensor may still be used.
    UsableCounts = 66, "usable";
    /// Output that an actuator goes to when it is given none.
    SafeOutput = 67, "safe";
    /// Window of a time-proportioned output.
    Window = 68, "window";
    /// Shortest time for which a time-proportioned output is on.
    MinimumOn = 69, "minimum_on";
    /// Shortest time for which a time-proportioned output is off.
    MinimumOff = 70, "minimum_off";
    /// Flow signal: full scale of the flow.
    FlowFull = 71, "flow";
    /// Flow signal: where the root becomes a line.
    LinearBelow = 72, "linear_below";
    /// Flow signal: below this there is no flow.
    CutOff = 73, "cut_off";
    /// Schedule: an operating point.
    OperatingPoint = 74, "operating point";
    /// Schedule: hysteresis.
    Hysteresis = 75, "hysteresis";
}

/// Why a value is refused. The numbers are stable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
#[repr(u8)]
pub enum Reason {
    /// Infinite or not a number.
    NotFinite = 1,
    /// Outside the allowed range.
    OutOfRange = 2,
    /// The lower bound is not below the upper bound.
    Inverted = 3,
    /// The sign contradicts another parameter (`ki * model.gain > 0` is required).
    SignMismatch = 4,
    /// A derivative needs a filter: `kd != 0` requires `tf > 0`.
    NeedsFilter = 5,
    /// The pole is not stable.
    Unstable = 6,
    /// The block has no place for this many states or samples.
    TooLarge = 7,
    /// The transfer function must have more poles than zeros.
    NotProper = 8,
    /// The blocks were built for different sampling periods.
    Mismatch = 9,
}

impl Reason {
    /// The reason as the end of a sentence.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::NotFinite => "is not a finite number",
            Self::OutOfRange => "is out of range",
            Self::Inverted => "leaves no room between the lower and the upper bound",
            Self::SignMismatch => "has the wrong sign: ki * model gain must be positive",
            Self::NeedsFilter => "needs a filter: set tf, or kd = 0",
            Self::Unstable => "is not a stable factor",
            Self::TooLarge => "is too large for this block",
            Self::NotProper => "makes a transfer function with no more poles than zeros",
            Self::Mismatch => "differs from what another block was built for",
        }
    }
}

/// One fault of a configuration.
///
/// ```
/// use controller_core::{Pid, PidConfig, Param, Reason};
/// let faults = Pid::<f32>::new(&PidConfig { kp: f64::NAN, tf: -1.0, ..PidConfig::default() }, 0.01).unwrap_err();
/// assert_eq!(faults.len(), 2); // all at once
/// assert_eq!((faults[0].param, faults[0].reason), (Param::Kp, Reason::NotFinite));
/// assert_eq!(faults[1].param, Param::Tf);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConfigError {
    /// Which parameter.
    pub param: Param,
    /// What is wrong with it.
    pub reason: Reason,
    /// Its value.
    pub value: f64,
    /// Smallest allowed value; equal to `max` when there is no range to name.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} {}", self.param.name(), self.value, self.reason.text())?;
        if self.min < self.max {
            write!(f, " (allowed: {} to {})", self.min, self.max)?;
        }
        Ok(())
    }
}

impl core::error::Error for ConfigError {}

#[cfg(feature = "defmt")]
impl defmt::Format for ConfigError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} = {}: {}", self.param, self.value, self.reason);
        if self.min < self.max {
            defmt::write!(f, " (allowed: {} to {})", self.min, self.max);
        }
    }
}

/// All faults of a configuration, in the order they were found; at most [`MAX_FAULTS`] are kept.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ConfigErrors {
    faults: Vec<ConfigError, MAX_FAULTS>,
}

impl ConfigErrors {
    /// The faults as a slice.
    #[must_use]
    pub fn as_slice(&self) -> &[ConfigError] {
        &self.faults
    }

    /// These faults and then those of `other`.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let mut all = self.clone();
        for fault in &other.faults {
            let _ = all.faults.push(*fault);
        }
        all
    }
}

impl From<ConfigError> for ConfigErrors {
    fn from(fault: ConfigError) -> Self {
        let mut errors = Self::default();
        let _ = errors.faults.push(fault);
        errors
    }
}

impl core::ops::Deref for ConfigErrors {
    type Target = [ConfigError];
    fn deref(&self) -> &[ConfigError] {
        &self.faults
    }
}

impl fmt::Display for ConfigErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.faults.iter().enumerate() {
            if i > 0 {
                f.write_str("; ")?;
            }
            fault.fmt(f)?;
        }
        Ok(())
    }
}

impl core::error::Error for ConfigErrors {}

#[cfg(feature = "defmt")]
impl defmt::Format for ConfigErrors {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", self.as_slice());
    }
}

/// Collects faults while a configuration is read.
#[derive(Debug, Default)]
pub(crate) struct Checker {
    errors: ConfigErrors,
}

impl Checker {
    pub(crate) fn fault(&mut self, param: Param, reason: Reason, value: f64, min: f64, max: f64) {
        let _ = self.errors.faults.push(ConfigError { param, reason, value, min, max });
    }

    /// `value` must be finite and in `min..=max`; returns whether it is.
    pub(crate) fn range(&mut self, param: Param, value: f64, min: f64, max: f64) -> bool {
        if !value.is_finite() {
            self.fault(param, Reason::NotFinite, value, min, max);
            false
        } else if value < min || value > max {
            self.fault(param, Reason::OutOfRange, value, min, max);
            false
        } else {
            true
        }
    }

    /// As [`range`](Self::range) for a value that may be absent.
    pub(crate) fn optional(&mut self, param: Param, value: Option<f64>, min: f64, max: f64) -> bool {
        value.is_none_or(|v| self.range(param, v, min, max))
    }

    /// Two finite bounds with `lo < hi`, each at most `limit` in size.
    pub(crate) fn bounds(&mut self, lo: (Param, f64), hi: (Param, f64), limit: f64) -> bool {
        let both = self.range(lo.0, lo.1, -limit, limit) & self.range(hi.0, hi.1, -limit, limit);
        if both && lo.1 >= hi.1 {
            self.fault(lo.0, Reason::Inverted, lo.1, -limit, hi.1);
            return false;
        }
        both
    }

    /// Builds a part; takes over its faults. A list of faults is large: on the stack there is one of a part at a time.
    #[inline(never)]
    pub(crate) fn merge<V>(&mut self, part: impl FnOnce() -> Result<V, ConfigErrors>) -> Option<V> {
        match part() {
            Ok(value) => Some(value),
            Err(errors) => {
                for fault in &errors.faults {
                    let _ = self.errors.faults.push(*fault);
                }
                None
            }
        }
    }

    pub(crate) fn is_clean(&self) -> bool {
        self.errors.faults.is_empty()
    }

    /// `value` when nothing was found, else all faults.
    pub(crate) fn finish<V>(self, value: V) -> Result<V, ConfigErrors> {
        if self.is_clean() { Ok(value) } else { Err(self.errors) }
    }

    /// The faults, when there are any.
    pub(crate) fn into_result(self) -> Result<(), ConfigErrors> {
        self.finish(())
    }
}
