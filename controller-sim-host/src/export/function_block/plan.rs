//! The numbers of a loop as the block needs them, of the number type it runs in but held in double precision.

use super::super::Export;
use super::outputs::{ALARMS, Alarm};
use crate::simulate::{AnyLaw, Precision};
use controller_core::{
    AntiWindup, AntiWindupConfig, Compensate, ControllerConfig, ControllerNumbers, IntegralRule,
    PidCoefficients, PidConfig, Real,
};

/// Everything that is written into the block.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) precision: Precision,
    /// As configured, rounded to the number type.
    pub(super) config: ControllerConfig,
    pub(super) numbers: ControllerNumbers<f64>,
    pub(super) pid: PidCoefficients<f64>,
    pub(super) compensator: Option<Chains>,
    /// Gain of the anti-windup as it is with integral action.
    pub(super) anti_windup_share: f64,
    pub(super) tuning: Option<Tuning>,
    /// Largest and smallest normal number of the number type.
    pub(super) largest: f64,
    pub(super) smallest: f64,
}

/// The coefficients of a compensator.
#[derive(Debug, Clone)]
pub(super) struct Chains {
    pub(super) g: Vec<f64>,
    pub(super) y_feed: Vec<f64>,
    pub(super) y_lead: Vec<f64>,
    pub(super) y_dc: Vec<f64>,
    pub(super) u_lead: Vec<f64>,
    pub(super) e_gain: Vec<f64>,
    /// `g/2` of the shared lags, halved in the number type.
    pub(super) e_half: Vec<f64>,
    pub(super) inv_gain: f64,
    pub(super) gain: f64,
    pub(super) delay: usize,
    pub(super) capacity: usize,
    /// Largest numbers of a step per unit of measurement and of output.
    pub(super) bounds: (f64, f64),
}

/// What can be tuned on site, and the values that the block starts with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tuning {
    /// Size of the gain.
    pub(super) kp: f64,
    /// 0: there is no integral action.
    pub(super) tn: f64,
    pub(super) tv: f64,
    pub(super) tf: f64,
}

impl Plan {
    /// `None` for an ADRC.
    pub(super) fn new(export: &Export<'_>) -> Option<Self> {
        match export.precision {
            Precision::F32 => Self::of::<f32>(export),
            Precision::F64 => Self::of::<f64>(export),
        }
    }

    fn of<T: Real>(export: &Export<'_>) -> Option<Self> {
        let (scenario, spec) = (export.scenario, export.spec);
        // It was built when the export was checked.
        let law = AnyLaw::<T>::new(spec, scenario.ts, scenario.latency, export.capacity).ok()?;
        let PidCoefficients { ki_now, ki_before, g, p_r, h_r, p_y, h_y } = law.pid()?;
        let [ki_now, ki_before, g, p_r, h_r, p_y, h_y] =
            [ki_now, ki_before, g, p_r, h_r, p_y, h_y].map(T::to_f64);
        let compensator = law.compensator().map(|compensator| {
            let c = compensator.coefficients();
            let list = |of: &[T]| of.iter().map(|x| x.to_f64()).collect();
            Chains {
                g: list(c.g),
                y_feed: list(c.y_feed),
                y_lead: list(c.y_lead),
                y_dc: list(c.y_dc),
                u_lead: list(c.u_lead),
                e_gain: list(c.e_gain),
                e_half: c.e_gain.iter().map(|&g| (g * T::from_f64(0.5)).to_f64()).collect(),
                inv_gain: c.inv_gain.to_f64(),
                gain: c.gain.to_f64(),
                delay: c.delay,
                capacity: export.capacity,
                bounds: compensator.bounds(),
            }
        });
        let config = spec.config.rounded::<T>();
        let integral = PidConfig { kp: 1.0, ki: 1.0, ..config.pid };
        let anti_windup = AntiWindup::<T>::new(&config.anti_windup, &integral, scenario.ts).ok()?;
        Some(Self {
            precision: export.precision,
            anti_windup_share: anti_windup.gain().to_f64(),
            tuning: Tuning::of::<T>(&config),
            config,
            numbers: widened(&law.numbers()),
            pid: PidCoefficients { ki_now, ki_before, g, p_r, h_r, p_y, h_y },
            compensator,
            largest: T::LARGEST,
            smallest: T::SMALLEST_NORMAL,
        })
    }

    pub(super) fn trapezoid(&self) -> bool {
        self.config.pid.integral_rule == IntegralRule::Trapezoid
    }

    /// Whether the gains are below 0 unless tuning makes them 0: whether the output falls with the set-point is then a
    /// question.
    pub(super) fn turns(&self) -> bool {
        self.tuning.is_some() && self.config.pid.signed_gains()[0] < 0.0
    }

    /// Whether a fallback moves the output more slowly than its own rates.
    pub(super) fn slow_fallback(&self) -> bool {
        let (down, up) = self.numbers.output_steps;
        self.numbers.fallback_step < up || self.numbers.fallback_step < down
    }

    /// The alarms that are configured, with level and the level where each clears.
    pub(super) fn alarms(&self) -> Vec<(&'static Alarm, [f64; 2])> {
        let Some((levels, hysteresis)) = self.numbers.alarms else { return Vec::new() };
        // A level that is not configured is beyond every range.
        let configured = ALARMS.iter().zip(levels).filter(|(_, level)| level.abs() < 4e12);
        let clears = |low: bool, level: f64| {
            let back = if low { -hysteresis } else { hysteresis };
            match self.precision {
                Precision::F32 => (f32::from_f64(level) - f32::from_f64(back)).to_f64(),
                Precision::F64 => level - back,
            }
        };
        configured.map(|(alarm, level)| (alarm, [level, clears(alarm.low, level)])).collect()
    }

    /// Names of the coefficients that tuning changes.
    pub(super) fn tuned(&self) -> Vec<&'static str> {
        let mut names = vec!["KI_NOW", "KI_BEFORE", "G", "P_R", "H_R", "P_Y", "H_Y"];
        match self.config.anti_windup {
            AntiWindupConfig::BackCalculation { .. } => names.push("AW_GAIN"),
            AntiWindupConfig::Conditional => names.push("AW_TAKES_BACK"),
            AntiWindupConfig::None => {}
        }
        if self.turns() {
            names.push("REVERSED");
        }
        names
    }

    /// Whether the anti-windup takes increments back, if there is integral action.
    pub(super) fn conditional(&self) -> bool {
        self.config.anti_windup == AntiWindupConfig::Conditional
    }

    /// The tracking time constant as configured: `None` when another rule holds, `Some(None)` for the default.
    pub(super) fn tracking(&self) -> Option<Option<f64>> {
        match self.config.anti_windup {
            AntiWindupConfig::BackCalculation { tt } => Some(tt),
            AntiWindupConfig::Conditional | AntiWindupConfig::None => None,
        }
    }
}

impl Chains {
    /// Index of the last cell of the delay line.
    pub(super) fn last_cell(&self) -> i32 {
        i32::try_from(self.capacity).unwrap_or(i32::MAX) - 1
    }
}

impl Tuning {
    /// `None` for a controller that the form `KP*(1 + 1/(TN*s) + TV*s)` does not reach with a `TN` above 0 and a `TV` not
    /// below.
    fn of<T: Real>(config: &ControllerConfig) -> Option<Self> {
        let pid = &config.pid;
        let usable = |x: f64| {
            let x = T::from_f64(x).to_f64();
            (T::SMALLEST_NORMAL..=T::LARGEST).contains(&x).then_some(x)
        };
        usable(pid.kp.abs())?;
        let tn = if pid.ki == 0.0 { 0.0 } else { usable(pid.kp / pid.ki)? };
        let tv = if pid.kd == 0.0 { 0.0 } else { usable(pid.kd / pid.kp)? };
        Some(Self { kp: pid.kp.abs(), tn, tv, tf: pid.tf })
    }

    /// Names of the inputs, and what they begin with.
    pub(super) fn inputs(self) -> [(&'static str, f64); 4] {
        [("KP", self.kp), ("TN", self.tn), ("TV", self.tv), ("TF", self.tf)]
    }
}

fn widened<T: Real>(n: &ControllerNumbers<T>) -> ControllerNumbers<f64> {
    let one = T::to_f64;
    let two = |(a, b): (T, T)| (a.to_f64(), b.to_f64());
    ControllerNumbers {
        ts: one(n.ts),
        measurement: two(n.measurement),
        hold_samples: n.hold_samples,
        acknowledged: n.acknowledged,
        fallback_output: n.fallback_output.map(one),
        fallback_step: one(n.fallback_step),
        setpoint: two(n.setpoint),
        setpoint_steps: two(n.setpoint_steps),
        setpoint_ramps: n.setpoint_ramps,
        setpoint_tracks: n.setpoint_tracks,
        deadband: one(n.deadband),
        offset: two(n.offset),
        output: two(n.output),
        output_steps: two(n.output_steps),
        off_output: n.off_output.map(one),
        initial_output: one(n.initial_output),
        anti_windup_gain: one(n.anti_windup_gain),
        conditional: n.conditional,
        integral_bound: one(n.integral_bound),
        alarms: n.alarms.map(|(levels, hysteresis)| (levels.map(one), one(hysteresis))),
        reversed: n.reversed,
    }
}
