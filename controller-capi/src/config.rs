//! The configuration as C sees it, and its translation.

use crate::fault::{Fault, Faults, choice, number};
use controller_core::plant_model::Factor;
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, FallbackAction,
    FallbackConfig, FallbackReturn, FilterNames, IntegralRule, LimitConfig, Param, PidConfig, PlantModel,
    Reason, SetpointConfig,
};

/// Factors of the model's denominator or numerator that the structure has room for.
pub const MAX_FACTORS: usize = 8;

/// `ctl_config`: the parameters of a loop. Numbers are `double` in both variants; the variant for `float` rounds each of them
/// first. An optional number that is NaN is not given. Meaning, ranges and defaults are those of
/// [`ControllerConfig`], [`PidConfig`] and [`CompensatorConfig`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config {
    /// Size of this structure, as the caller's compiler sees it.
    pub struct_size: u32,
    /// 0 reverse, 1 direct.
    pub action: i32,
    /// 0 backward, 1 trapezoid.
    pub integral_rule: i32,
    /// 0 back-calculation, 1 conditional, 2 none.
    pub anti_windup: i32,
    /// In Off, Manual and Track the working set-point follows the measurement.
    pub setpoint_track: i32,
    /// 0 hold, 1 substitute, 2 ramp.
    pub fallback_action: i32,
    /// 0 automatic, 1 acknowledged.
    pub fallback_return: i32,
    /// Bad samples in a row that are held, 0 to 65535.
    pub hold_samples: i32,
    /// 0 none, 1 disturbance estimator, 2 disturbance observer.
    pub compensator: i32,
    /// Filter order of the observer; 0: the smallest possible.
    pub filter_order: i32,
    /// Pure integrators of the model.
    pub model_integrators: i32,
    /// Factors of the model's denominator.
    pub model_pole_count: i32,
    /// Factors of the model's numerator.
    pub model_zero_count: i32,
    /// Not used; 0.
    pub reserved: i32,
    /// Sampling period \[s\].
    pub ts: f64,
    /// Proportional gain [u/y].
    pub kp: f64,
    /// Integral gain [u/y/s].
    pub ki: f64,
    /// Derivative gain [u/y*s].
    pub kd: f64,
    /// Filter time constant over all terms \[s\].
    pub tf: f64,
    /// Set-point weight of the proportional term.
    pub b: f64,
    /// Set-point weight of the derivative term.
    pub c: f64,
    /// Lowest output \[u\].
    pub output_lo: f64,
    /// Highest output \[u\].
    pub output_hi: f64,
    /// Fastest rise of the output [u/s]; optional.
    pub output_rate_up: f64,
    /// Fastest fall of the output [u/s]; optional.
    pub output_rate_down: f64,
    /// Lowest set-point \[y\].
    pub setpoint_lo: f64,
    /// Highest set-point \[y\].
    pub setpoint_hi: f64,
    /// Fastest rise of the set-point [y/s]; optional.
    pub setpoint_rate_up: f64,
    /// Fastest fall of the set-point [y/s]; optional.
    pub setpoint_rate_down: f64,
    /// Tracking time constant of back-calculation \[s\]; optional.
    pub tt: f64,
    /// Half width of the error deadband \[y\].
    pub deadband: f64,
    /// Lowest valid measurement \[y\].
    pub measurement_lo: f64,
    /// Highest valid measurement \[y\].
    pub measurement_hi: f64,
    /// Lowest offset \[u\].
    pub offset_lo: f64,
    /// Highest offset \[u\].
    pub offset_hi: f64,
    /// Output of the fallback \[u\].
    pub fallback_output: f64,
    /// Rate towards it [u/s].
    pub fallback_rate: f64,
    /// Alarm level, measurement very high \[y\]; optional.
    pub alarm_hi_hi: f64,
    /// Alarm level, measurement high \[y\]; optional.
    pub alarm_hi: f64,
    /// Alarm level, measurement low \[y\]; optional.
    pub alarm_lo: f64,
    /// Alarm level, measurement very low \[y\]; optional.
    pub alarm_lo_lo: f64,
    /// Alarm level, size of the deviation \[y\]; optional.
    pub alarm_deviation: f64,
    /// Alarm hysteresis \[y\].
    pub alarm_hysteresis: f64,
    /// Output in mode Off \[u\]; optional.
    pub off_output: f64,
    /// Output before the first sample \[u\].
    pub initial_output: f64,
    /// Time from reading `y` to acting `u` \[s\].
    pub latency: f64,
    /// Gain of the disturbance estimator, 0 to 1.
    pub kfd: f64,
    /// Filter time constant of the disturbance estimator \[s\].
    pub tfd: f64,
    /// Filter time constant of the disturbance observer \[s\].
    pub alpha: f64,
    /// Gain of the model [y/u/s^integrators].
    pub model_gain: f64,
    /// Dead time of the model \[s\].
    pub model_dead_time: f64,
    /// Coefficients of `s` in the factors of the denominator \[s\].
    pub model_pole_a1: [f64; MAX_FACTORS],
    /// Coefficients of `s^2` in the factors of the denominator [s^2].
    pub model_pole_a2: [f64; MAX_FACTORS],
    /// Coefficients of `s` in the factors of the numerator \[s\].
    pub model_zero_a1: [f64; MAX_FACTORS],
    /// Coefficients of `s^2` in the factors of the numerator [s^2].
    pub model_zero_a2: [f64; MAX_FACTORS],
}

/// [`Config`]'s size, the same on every machine.
#[allow(clippy::cast_possible_truncation)]
pub const STRUCT_SIZE: u32 = size_of::<Config>() as u32;

const _: () = {
    use core::mem::offset_of;
    assert!(size_of::<Config>() == 608);
    assert!(offset_of!(Config, struct_size) == 0 && offset_of!(Config, ts) == 56);
    assert!(offset_of!(Config, model_pole_a1) == 352 && offset_of!(Config, model_zero_a2) == 544);
};

impl Default for Config {
    fn default() -> Self {
        let core = ControllerConfig::default();
        let none = f64::NAN;
        Self {
            struct_size: STRUCT_SIZE,
            action: 0,
            integral_rule: 0,
            anti_windup: 0,
            setpoint_track: 0,
            fallback_action: 0,
            fallback_return: 0,
            hold_samples: i32::from(core.fallback.hold_samples),
            compensator: 0,
            filter_order: 0,
            model_integrators: 0,
            model_pole_count: 0,
            model_zero_count: 0,
            reserved: 0,
            ts: 0.0,
            kp: core.pid.kp,
            ki: core.pid.ki,
            kd: core.pid.kd,
            tf: core.pid.tf,
            b: core.pid.b,
            c: core.pid.c,
            output_lo: core.limits.lo,
            output_hi: core.limits.hi,
            output_rate_up: none,
            output_rate_down: none,
            setpoint_lo: core.setpoint.lo,
            setpoint_hi: core.setpoint.hi,
            setpoint_rate_up: none,
            setpoint_rate_down: none,
            tt: none,
            deadband: core.deadband,
            measurement_lo: core.measurement_lo,
            measurement_hi: core.measurement_hi,
            offset_lo: core.offset_lo,
            offset_hi: core.offset_hi,
            fallback_output: none,
            fallback_rate: none,
            alarm_hi_hi: none,
            alarm_hi: none,
            alarm_lo: none,
            alarm_lo_lo: none,
            alarm_deviation: none,
            alarm_hysteresis: core.alarms.hysteresis,
            off_output: none,
            initial_output: core.initial_output,
            latency: 0.0,
            // Gain 0 would be allowed, and do nothing.
            kfd: none,
            tfd: 0.0,
            alpha: 0.0,
            model_gain: 0.0,
            model_dead_time: 0.0,
            model_pole_a1: [0.0; MAX_FACTORS],
            model_pole_a2: [0.0; MAX_FACTORS],
            model_zero_a1: [0.0; MAX_FACTORS],
            model_zero_a2: [0.0; MAX_FACTORS],
        }
    }
}

/// Reads choices and counts; notes those that are none.
struct Choices<'a>(&'a mut Faults);

impl Choices<'_> {
    fn refuse(&mut self, param: i32, value: i32, max: i32) {
        let reason = number(Reason::OutOfRange);
        let [value, max] = [value, max].map(f64::from);
        self.0.add(Fault { param, reason, value, min: 0.0, max });
    }

    /// The entry of `list` with this number, else the first.
    fn of<V: Copy + Default, const N: usize>(&mut self, param: i32, value: i32, list: [V; N]) -> V {
        match usize::try_from(value).ok().and_then(|at| list.get(at)) {
            Some(&choice) => choice,
            None => {
                self.refuse(param, value, i32::try_from(N).unwrap_or(i32::MAX).saturating_sub(1));
                V::default()
            }
        }
    }

    /// A count up to `most`, else 0.
    fn count(&mut self, param: i32, value: i32, most: u16) -> u16 {
        match u16::try_from(value) {
            Ok(count) if count <= most => count,
            _ => {
                self.refuse(param, value, i32::from(most));
                0
            }
        }
    }
}

fn optional(x: f64) -> Option<f64> {
    (!x.is_nan()).then_some(x)
}

impl Config {
    /// The loop without its compensator, as the core reads it; faults of choices go into `faults`.
    pub(crate) fn controller(&self, faults: &mut Faults) -> ControllerConfig {
        let mut choices = Choices(faults);
        let pid = PidConfig {
            kp: self.kp,
            ki: self.ki,
            kd: self.kd,
            tf: self.tf,
            b: self.b,
            c: self.c,
            action: choices.of(choice::ACTION, self.action, [Action::Reverse, Action::Direct]),
            integral_rule: choices.of(
                choice::INTEGRAL_RULE,
                self.integral_rule,
                [IntegralRule::Backward, IntegralRule::Trapezoid],
            ),
        };
        let back_calculation = AntiWindupConfig::BackCalculation { tt: optional(self.tt) };
        let anti_windup = choices.of(
            choice::ANTI_WINDUP,
            self.anti_windup,
            [back_calculation, AntiWindupConfig::Conditional, AntiWindupConfig::None],
        );
        let (output, rate) = (self.fallback_output, self.fallback_rate);
        let action = choices.of(
            choice::FALLBACK_ACTION,
            self.fallback_action,
            [
                FallbackAction::Hold,
                FallbackAction::Substitute { output },
                FallbackAction::Ramp { output, rate },
            ],
        );
        let back = choices.of(
            choice::FALLBACK_RETURN,
            self.fallback_return,
            [FallbackReturn::Automatic, FallbackReturn::Acknowledged],
        );
        let hold_samples = choices.count(choice::HOLD_SAMPLES, self.hold_samples, u16::MAX);
        ControllerConfig {
            pid,
            limits: LimitConfig {
                lo: self.output_lo,
                hi: self.output_hi,
                rate_up: optional(self.output_rate_up),
                rate_down: optional(self.output_rate_down),
            },
            setpoint: SetpointConfig {
                lo: self.setpoint_lo,
                hi: self.setpoint_hi,
                rate_up: optional(self.setpoint_rate_up),
                rate_down: optional(self.setpoint_rate_down),
                track: self.setpoint_track != 0,
            },
            anti_windup,
            deadband: self.deadband,
            measurement_lo: self.measurement_lo,
            measurement_hi: self.measurement_hi,
            offset_lo: self.offset_lo,
            offset_hi: self.offset_hi,
            fallback: FallbackConfig { hold_samples, action, back },
            alarms: AlarmConfig {
                hi_hi: optional(self.alarm_hi_hi),
                hi: optional(self.alarm_hi),
                lo: optional(self.alarm_lo),
                lo_lo: optional(self.alarm_lo_lo),
                deviation: optional(self.alarm_deviation),
                hysteresis: self.alarm_hysteresis,
            },
            off_output: optional(self.off_output),
            initial_output: self.initial_output,
        }
    }

    /// The compensator, if there is one; faults of choices go into `faults`.
    pub(crate) fn compensator(&self, faults: &mut Faults) -> Option<CompensatorConfig> {
        let mut choices = Choices(faults);
        let kinds = [None, Some(FilterNames::Estimator), Some(FilterNames::Observer)];
        let names = choices.of(choice::COMPENSATOR, self.compensator, kinds)?;
        let most = MAX_FACTORS as u16;
        let model = PlantModel {
            gain: self.model_gain,
            integrators: choices.count(choice::MODEL_INTEGRATORS, self.model_integrators, most).into(),
            dead_time: self.model_dead_time,
            ..PlantModel::default()
        };
        let poles = choices.count(choice::MODEL_POLE_COUNT, self.model_pole_count, most);
        let zeros = choices.count(choice::MODEL_ZERO_COUNT, self.model_zero_count, most);
        let factors = |a1: &[f64; MAX_FACTORS], a2: &[f64; MAX_FACTORS], count: u16| {
            let pairs = core::array::from_fn::<_, MAX_FACTORS, _>(|i| {
                let at = |list: &[f64; MAX_FACTORS]| list.get(i).copied().unwrap_or_default();
                Factor { a1: at(a1), a2: at(a2) }
            });
            pairs.into_iter().take(count.into())
        };
        let model =
            factors(&self.model_pole_a1, &self.model_pole_a2, poles).fold(model, PlantModel::with_pole);
        let model =
            factors(&self.model_zero_a1, &self.model_zero_a2, zeros).fold(model, PlantModel::with_zero);
        let order = choices.count(Param::FilterOrder as i32, self.filter_order, most);
        Some(match names {
            FilterNames::Estimator => CompensatorConfig {
                model,
                gain: self.kfd,
                time_constant: self.tfd,
                order: Some(3),
                latency: self.latency,
                names,
            },
            FilterNames::Observer => CompensatorConfig {
                model,
                gain: 1.0,
                time_constant: self.alpha,
                order: (order > 0).then_some(order.into()),
                latency: self.latency,
                names,
            },
        })
    }
}
