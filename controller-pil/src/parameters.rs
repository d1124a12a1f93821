//! A controller's configuration as bytes: the board builds from it what the host builds from it.
//!
//! All numbers are `f64`, as a person writes them; each side rounds them to its number type itself.

use crate::frame::{Reader, Writer};
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AdrcConfig, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, FallbackAction,
    FallbackConfig, FallbackReturn, FilterNames, IntegralRule, LimitConfig, PidConfig, SetpointConfig,
};

/// The number type a controller runs in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Precision {
    /// `f32`.
    Single = 4,
    /// `f64`.
    Double = 8,
}

/// What is in the place of the compensated PID.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one of them, and no heap to box it on")]
pub enum Kind {
    /// A PID without a compensator.
    Pid,
    /// A PID with a disturbance estimator or observer.
    Compensated(CompensatorConfig),
    /// An ADRC.
    Adrc(AdrcConfig),
}

/// All that a controller is built from.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// Its number type.
    pub precision: Precision,
    /// Its kind, with what only this kind has.
    pub kind: Kind,
    /// Everything else.
    pub config: ControllerConfig,
    /// Sampling period \[s\].
    pub ts: f64,
    /// Samples of delay memory.
    pub capacity: u32,
}

impl Parameters {
    /// Into a frame.
    pub fn write(&self, to: &mut Writer<'_>) {
        to.u8(self.precision as u8);
        to.u32(self.capacity);
        to.f64(self.ts);
        write_config(&self.config, to);
        match &self.kind {
            Kind::Pid => to.u8(0),
            Kind::Compensated(config) => {
                to.u8(1);
                write_compensator(config, to);
            }
            Kind::Adrc(AdrcConfig { b0, kp, kd, beta1, beta2, beta3 }) => {
                to.u8(2);
                [b0, kp, kd, beta1, beta2, beta3].into_iter().for_each(|&x| to.f64(x));
            }
        }
    }

    /// Out of a frame; `None`: too short, or a number that stands for nothing.
    pub fn read(from: &mut Reader<'_>) -> Option<Self> {
        let precision = match from.u8()? {
            4 => Precision::Single,
            8 => Precision::Double,
            _ => return None,
        };
        let capacity = from.u32()?;
        let ts = from.f64()?;
        let config = read_config(from)?;
        let kind = match from.u8()? {
            0 => Kind::Pid,
            1 => Kind::Compensated(read_compensator(from)?),
            2 => {
                let [b0, kp, kd, beta1, beta2, beta3] = numbers(from)?;
                Kind::Adrc(AdrcConfig { b0, kp, kd, beta1, beta2, beta3 })
            }
            _ => return None,
        };
        Some(Self { precision, kind, config, ts, capacity })
    }
}

fn numbers<const N: usize>(from: &mut Reader<'_>) -> Option<[f64; N]> {
    let mut list = [0.0; N];
    for x in &mut list {
        *x = from.f64()?;
    }
    Some(list)
}

fn write_config(config: &ControllerConfig, to: &mut Writer<'_>) {
    let PidConfig { kp, ki, kd, tf, b, c, action, integral_rule } = config.pid;
    [kp, ki, kd, tf, b, c].into_iter().for_each(|x| to.f64(x));
    to.u8(u8::from(action == Action::Direct));
    to.u8(u8::from(integral_rule == IntegralRule::Trapezoid));

    let LimitConfig { lo, hi, rate_up, rate_down } = config.limits;
    to.f64(lo);
    to.f64(hi);
    to.optional(rate_up);
    to.optional(rate_down);

    let SetpointConfig { lo, hi, rate_up, rate_down, track } = config.setpoint;
    to.f64(lo);
    to.f64(hi);
    to.optional(rate_up);
    to.optional(rate_down);
    to.u8(u8::from(track));

    let (rule, tt) = match config.anti_windup {
        AntiWindupConfig::None => (0, None),
        AntiWindupConfig::BackCalculation { tt } => (1, tt),
        AntiWindupConfig::Conditional => (2, None),
    };
    to.u8(rule);
    to.optional(tt);

    let c = config;
    let ranges = [c.deadband, c.measurement_lo, c.measurement_hi, c.offset_lo, c.offset_hi];
    ranges.into_iter().for_each(|x| to.f64(x));

    let FallbackConfig { hold_samples, action, back } = config.fallback;
    to.u16(hold_samples);
    let (number, output, rate) = match action {
        FallbackAction::Hold => (0, 0.0, 0.0),
        FallbackAction::Substitute { output } => (1, output, 0.0),
        FallbackAction::Ramp { output, rate } => (2, output, rate),
    };
    to.u8(number);
    to.f64(output);
    to.f64(rate);
    to.u8(u8::from(back == FallbackReturn::Acknowledged));

    let AlarmConfig { hi_hi, hi, lo, lo_lo, deviation, hysteresis } = config.alarms;
    [hi_hi, hi, lo, lo_lo, deviation].into_iter().for_each(|level| to.optional(level));
    to.f64(hysteresis);
    to.optional(config.off_output);
    to.f64(config.initial_output);
}

fn read_config(from: &mut Reader<'_>) -> Option<ControllerConfig> {
    let [kp, ki, kd, tf, b, c] = numbers(from)?;
    let action = if from.flag()? { Action::Direct } else { Action::Reverse };
    let integral_rule = if from.flag()? { IntegralRule::Trapezoid } else { IntegralRule::Backward };
    let pid = PidConfig { kp, ki, kd, tf, b, c, action, integral_rule };

    let [lo, hi] = numbers(from)?;
    let limits = LimitConfig { lo, hi, rate_up: from.optional()?, rate_down: from.optional()? };
    let [lo, hi] = numbers(from)?;
    let (rate_up, rate_down) = (from.optional()?, from.optional()?);
    let setpoint = SetpointConfig { lo, hi, rate_up, rate_down, track: from.flag()? };

    let anti_windup = match (from.u8()?, from.optional()?) {
        (0, _) => AntiWindupConfig::None,
        (1, tt) => AntiWindupConfig::BackCalculation { tt },
        (2, _) => AntiWindupConfig::Conditional,
        _ => return None,
    };
    let [deadband, measurement_lo, measurement_hi, offset_lo, offset_hi] = numbers(from)?;

    let hold_samples = from.u16()?;
    let number = from.u8()?;
    let [output, rate] = numbers(from)?;
    let action = match number {
        0 => FallbackAction::Hold,
        1 => FallbackAction::Substitute { output },
        2 => FallbackAction::Ramp { output, rate },
        _ => return None,
    };
    let back = if from.flag()? { FallbackReturn::Acknowledged } else { FallbackReturn::Automatic };

    let (hi_hi, hi, lo, lo_lo) = (from.optional()?, from.optional()?, from.optional()?, from.optional()?);
    let (deviation, hysteresis) = (from.optional()?, from.f64()?);
    Some(ControllerConfig {
        pid,
        limits,
        setpoint,
        anti_windup,
        deadband,
        measurement_lo,
        measurement_hi,
        offset_lo,
        offset_hi,
        fallback: FallbackConfig { hold_samples, action, back },
        alarms: AlarmConfig { hi_hi, hi, lo, lo_lo, deviation, hysteresis },
        off_output: from.optional()?,
        initial_output: from.f64()?,
    })
}

fn write_compensator(config: &CompensatorConfig, to: &mut Writer<'_>) {
    let PlantModel { gain, integrators, poles, zeros, dead_time } = &config.model;
    to.f64(*gain);
    to.u8(short(*integrators));
    for factors in [poles, zeros] {
        to.u8(short(factors.len()));
        for factor in factors {
            to.f64(factor.a1);
            to.f64(factor.a2);
        }
    }
    to.f64(*dead_time);
    to.f64(config.gain);
    to.f64(config.time_constant);
    to.u8(u8::from(config.order.is_some()));
    to.u8(config.order.map_or(0, short));
    to.f64(config.latency);
    to.u8(u8::from(config.names == FilterNames::Estimator));
}

/// Orders are at most 8; larger ones, which no law accepts, stay too large.
fn short(n: usize) -> u8 {
    u8::try_from(n).unwrap_or(u8::MAX)
}

fn read_compensator(from: &mut Reader<'_>) -> Option<CompensatorConfig> {
    let mut model = PlantModel { gain: from.f64()?, integrators: from.u8()?.into(), ..PlantModel::default() };
    for list in [&mut model.poles, &mut model.zeros] {
        for _ in 0..from.u8()? {
            let [a1, a2] = numbers(from)?;
            list.push(Factor { a1, a2 }).ok()?;
        }
    }
    model.dead_time = from.f64()?;
    let [gain, time_constant] = numbers(from)?;
    let (fixed, order) = (from.flag()?, from.u8()?);
    Some(CompensatorConfig {
        model,
        gain,
        time_constant,
        order: fixed.then_some(order.into()),
        latency: from.f64()?,
        names: if from.flag()? { FilterNames::Estimator } else { FilterNames::Observer },
    })
}
