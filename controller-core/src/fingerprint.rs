//! Numbers that must not change on their way into an image.

use crate::adrc::AdrcConfig;
use crate::alarm::AlarmConfig;
use crate::anti_windup::AntiWindupConfig;
use crate::compensator::EstimatorConfig;
use crate::controller::ControllerConfig;
use crate::limit::LimitConfig;
use crate::pid::{Action, IntegralRule, PidConfig};
use crate::plant_model::Factor;
use crate::sample::{FallbackAction, FallbackConfig, FallbackReturn};
use crate::setpoint::SetpointConfig;

/// A fingerprint of a configuration, taken while the program is compiled.
///
/// An export writes it beside the constants it writes; a constant that was changed by hand since, and so never went
/// through the checks of the export, then stops the compiler. It tells slips from intent, it is no protection.
///
/// FNV-1a with 64 bits over the bits of every number, in the order of the fields; a missing value counts as such.
///
/// ```
/// use controller_core::{Action, Fingerprint, IntegralRule, PidConfig};
/// const PID: PidConfig = PidConfig {
///     kp: 2.0, ki: 0.5, kd: 0.0, tf: 0.0, b: 1.0, c: 0.0,
///     action: Action::Reverse, integral_rule: IntegralRule::Backward,
/// };
/// const TAKEN: u64 = Fingerprint::new().pid(&PID).value();
/// assert_ne!(TAKEN, Fingerprint::new().pid(&PidConfig { kp: 2.000_000_000_000_000_4, ..PID }).value());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self::new()
    }
}

impl Fingerprint {
    /// Of nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    /// What has come together.
    #[must_use]
    pub const fn value(self) -> u64 {
        self.0
    }

    /// One more whole number.
    #[must_use]
    pub const fn word(mut self, word: u64) -> Self {
        let bytes = word.to_le_bytes();
        let mut rest: &[u8] = &bytes;
        while let [byte, others @ ..] = rest {
            self.0 = (self.0 ^ *byte as u64).wrapping_mul(0x0000_0100_0000_01B3);
            rest = others;
        }
        self
    }

    /// One more number.
    #[must_use]
    pub const fn number(self, x: f64) -> Self {
        self.word(x.to_bits())
    }

    /// More numbers.
    #[must_use]
    pub const fn numbers(mut self, numbers: &[f64]) -> Self {
        let mut rest = numbers;
        while let [x, others @ ..] = rest {
            self = self.number(*x);
            rest = others;
        }
        self
    }

    /// A number that may be missing.
    #[must_use]
    pub const fn option(self, x: Option<f64>) -> Self {
        match x {
            Some(x) => self.word(1).number(x),
            None => self.word(0),
        }
    }

    /// The factors of a numerator or denominator, and how many there are.
    #[must_use]
    pub const fn factors(mut self, factors: &[Factor]) -> Self {
        let mut count = 0;
        let mut rest = factors;
        while let [factor, others @ ..] = rest {
            self = self.number(factor.a1).number(factor.a2);
            count += 1;
            rest = others;
        }
        self.word(count)
    }

    /// The parameters of a PID.
    #[must_use]
    pub const fn pid(self, pid: &PidConfig) -> Self {
        let PidConfig { kp, ki, kd, tf, b, c, action, integral_rule } = *pid;
        let action = match action {
            Action::Reverse => 0,
            Action::Direct => 1,
        };
        let rule = match integral_rule {
            IntegralRule::Backward => 0,
            IntegralRule::Trapezoid => 1,
        };
        self.numbers(&[kp, ki, kd, tf, b, c]).word(action).word(rule)
    }

    /// The parameters of a disturbance estimator.
    #[must_use]
    pub const fn estimator(self, estimator: &EstimatorConfig) -> Self {
        let EstimatorConfig { gain, a1, a2, dead_time, kfd, tfd } = *estimator;
        self.numbers(&[gain, a1, a2, dead_time, kfd, tfd])
    }

    /// The parameters of an ADRC.
    #[must_use]
    pub const fn adrc(self, adrc: &AdrcConfig) -> Self {
        let AdrcConfig { b0, kp, kd, beta1, beta2, beta3 } = *adrc;
        self.numbers(&[b0, kp, kd, beta1, beta2, beta3])
    }

    /// The parameters of a whole loop, every field of every part.
    #[must_use]
    pub const fn controller(self, config: &ControllerConfig) -> Self {
        let LimitConfig { lo, hi, rate_up, rate_down } = config.limits;
        let own = self.pid(&config.pid).number(lo).number(hi).option(rate_up).option(rate_down);
        let SetpointConfig { lo, hi, rate_up, rate_down, track } = config.setpoint;
        let own = own.number(lo).number(hi).option(rate_up).option(rate_down).word(track as u64);
        let own = match config.anti_windup {
            AntiWindupConfig::BackCalculation { tt } => own.word(0).option(tt),
            AntiWindupConfig::Conditional => own.word(1),
            AntiWindupConfig::None => own.word(2),
        };
        let own = own
            .number(config.deadband)
            .number(config.measurement_lo)
            .number(config.measurement_hi)
            .number(config.offset_lo)
            .number(config.offset_hi);
        let FallbackConfig { hold_samples, action, back } = config.fallback;
        let own = own.word(hold_samples as u64);
        let own = match action {
            FallbackAction::Hold => own.word(0),
            FallbackAction::Substitute { output } => own.word(1).number(output),
            FallbackAction::Ramp { output, rate } => own.word(2).number(output).number(rate),
        };
        let own = match back {
            FallbackReturn::Automatic => own.word(0),
            FallbackReturn::Acknowledged => own.word(1),
        };
        let AlarmConfig { hi_hi, hi, lo, lo_lo, deviation, hysteresis } = config.alarms;
        own.option(hi_hi)
            .option(hi)
            .option(lo)
            .option(lo_lo)
            .option(deviation)
            .number(hysteresis)
            .option(config.off_output)
            .number(config.initial_output)
    }
}
