//! Configurations and samples, given and drawn.

use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AdrcConfig, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, ControllerInput,
    ControllerOutput, FallbackAction, FallbackConfig, FallbackReturn, FilterNames, IntegralRule, LimitConfig,
    Mode, PidConfig, Quality, SetpointConfig, Status,
};
use controller_pil::parameters::{Kind, Parameters, Precision};
use proptest::prelude::*;

/// A PI in double precision, sampled every 10 ms.
pub(crate) fn plain() -> Parameters {
    let pid = PidConfig { kp: 2.0, ki: 1.0, ..PidConfig::default() };
    let config =
        ControllerConfig { pid, limits: LimitConfig::range(-5.0, 5.0), ..ControllerConfig::default() };
    Parameters { precision: Precision::Double, kind: Kind::Pid, config, ts: 0.01, capacity: 1 }
}

/// An observer of a first-order plant with this dead time \[s\].
pub(crate) fn observed_kind(dead_time: f64) -> Kind {
    Kind::Compensated(CompensatorConfig {
        model: PlantModel::first_order(1.0, 1.0, dead_time),
        gain: 1.0,
        time_constant: 0.2,
        ..CompensatorConfig::default()
    })
}

/// The PI with an observer and delay memory of `capacity` samples.
pub(crate) fn observed(capacity: u32) -> Parameters {
    Parameters { kind: observed_kind(0.05), capacity, ..plain() }
}

/// The PI with an observer of the highest order.
pub(crate) fn largest(capacity: u32) -> Parameters {
    let poles =
        (0..8).fold(PlantModel::default().with_gain(1.0), |model, _| model.with_pole(Factor::first(1.0)));
    let kind = Kind::Compensated(CompensatorConfig {
        model: poles,
        gain: 1.0,
        time_constant: 0.5,
        order: Some(11),
        ..CompensatorConfig::default()
    });
    Parameters { kind, capacity, ..plain() }
}

/// Any bits, ordinary numbers as often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<u64>().prop_map(f64::from_bits), -100.0..100.0_f64, Just(0.0), Just(-0.0)]
}

fn optional() -> impl Strategy<Value = Option<f64>> {
    prop::option::of(number())
}

fn factors(most: usize) -> impl Strategy<Value = Vec<Factor>> {
    prop::collection::vec((number(), number()).prop_map(|(a1, a2)| Factor { a1, a2 }), 0..=most)
}

/// A compensator with any numbers.
fn compensators() -> BoxedStrategy<CompensatorConfig> {
    let model = (number(), 0..9_usize, factors(9), factors(9), number());
    let filter = (number(), number(), prop::option::of(0..12_usize), number(), any::<bool>());
    (model, filter)
        .prop_map(|((gain, integrators, poles, zeros, dead_time), filter)| CompensatorConfig {
            model: PlantModel {
                gain,
                integrators,
                poles: poles.into_iter().collect(),
                zeros: zeros.into_iter().collect(),
                dead_time,
            },
            gain: filter.0,
            time_constant: filter.1,
            order: filter.2,
            latency: filter.3,
            names: if filter.4 { FilterNames::Estimator } else { FilterNames::Observer },
        })
        .boxed()
}

/// A configuration with any numbers, or one that mostly can be built.
pub(crate) fn configs() -> BoxedStrategy<ControllerConfig> {
    prop_oneof![wild(), tame()].boxed()
}

fn tame() -> BoxedStrategy<ControllerConfig> {
    let gains = (0.0..5.0_f64, 0.0..5.0_f64, 0.0..1.0_f64, 0.02..1.0_f64, any::<bool>());
    (gains, wild(), prop::option::of(0.1..9.0_f64))
        .prop_map(|((kp, ki, kd, tf, track), other, rate)| ControllerConfig {
            pid: PidConfig { kp, ki, kd, tf, ..PidConfig::default() },
            limits: LimitConfig { lo: -3.0, hi: 4.0, rate_up: rate, rate_down: None },
            setpoint: SetpointConfig { rate_up: rate, track, ..SetpointConfig::default() },
            anti_windup: match other.anti_windup {
                AntiWindupConfig::BackCalculation { .. } => AntiWindupConfig::BackCalculation { tt: rate },
                rule => rule,
            },
            fallback: FallbackConfig {
                hold_samples: other.fallback.hold_samples % 8,
                ..FallbackConfig::default()
            },
            alarms: AlarmConfig { hi: rate, ..AlarmConfig::default() },
            ..ControllerConfig::default()
        })
        .boxed()
}

fn wild() -> BoxedStrategy<ControllerConfig> {
    let pid = (number(), number(), number(), number(), (number(), number(), any::<bool>(), any::<bool>()));
    let ranges = prop::array::uniform9(number());
    let rates = prop::array::uniform4(optional());
    let rule = prop_oneof![
        Just(AntiWindupConfig::None),
        Just(AntiWindupConfig::Conditional),
        optional().prop_map(|tt| AntiWindupConfig::BackCalculation { tt }),
    ];
    let action = prop_oneof![
        Just(FallbackAction::Hold),
        number().prop_map(|output| FallbackAction::Substitute { output }),
        (number(), number()).prop_map(|(output, rate)| FallbackAction::Ramp { output, rate }),
    ];
    let fallback = (any::<u16>(), action, any::<bool>(), any::<bool>());
    let alarms = (prop::array::uniform5(optional()), number(), optional(), number());
    (pid, ranges, rates, rule, fallback, alarms)
        .prop_map(|(pid, n, rates, anti_windup, fallback, alarms)| {
            let (kp, ki, kd, tf, (b, c, direct, trapezoid)) = pid;
            let [up, down, r_up, r_down] = rates;
            let (hold_samples, action, acknowledged, track) = fallback;
            let ([hi_hi, hi, lo, lo_lo, deviation], hysteresis, off_output, initial_output) = alarms;
            ControllerConfig {
                pid: PidConfig {
                    kp,
                    ki,
                    kd,
                    tf,
                    b,
                    c,
                    action: if direct { Action::Direct } else { Action::Reverse },
                    integral_rule: if trapezoid { IntegralRule::Trapezoid } else { IntegralRule::Backward },
                },
                limits: LimitConfig { lo: n[0], hi: n[1], rate_up: up, rate_down: down },
                setpoint: SetpointConfig { lo: n[2], hi: n[3], rate_up: r_up, rate_down: r_down, track },
                anti_windup,
                deadband: n[4],
                measurement_lo: n[5],
                measurement_hi: n[6],
                offset_lo: n[7],
                offset_hi: n[8],
                fallback: FallbackConfig {
                    hold_samples,
                    action,
                    back: if acknowledged { FallbackReturn::Acknowledged } else { FallbackReturn::Automatic },
                },
                alarms: AlarmConfig { hi_hi, hi, lo, lo_lo, deviation, hysteresis },
                off_output,
                initial_output,
            }
        })
        .boxed()
}

/// Everything that a controller is built from.
pub(crate) fn parameters() -> BoxedStrategy<Parameters> {
    let adrc = prop::array::uniform6(number()).prop_map(|[b0, kp, kd, beta1, beta2, beta3]| AdrcConfig {
        b0,
        kp,
        kd,
        beta1,
        beta2,
        beta3,
    });
    let kind =
        prop_oneof![Just(Kind::Pid), compensators().prop_map(Kind::Compensated), adrc.prop_map(Kind::Adrc)];
    (kind, configs(), number(), any::<u32>(), any::<bool>())
        .prop_map(|(kind, config, ts, capacity, double)| {
            let precision = if double { Precision::Double } else { Precision::Single };
            Parameters { precision, kind, config, ts, capacity }
        })
        .boxed()
}

/// One sample's input.
pub(crate) fn inputs() -> BoxedStrategy<ControllerInput<f64>> {
    let numbers = prop::array::uniform5(number());
    let flags = prop::array::uniform4(any::<bool>());
    let quality = prop::sample::select(vec![Quality::Good, Quality::Uncertain, Quality::Bad]);
    (numbers, prop::array::uniform2(optional()), flags, 0..7_u8, quality)
        .prop_map(|([r, r_remote, y, track, offset], [manual, u_applied], flags, mode, quality)| {
            ControllerInput {
                r,
                r_remote,
                y,
                quality,
                mode: Mode::from_number(mode).expect("a mode"),
                manual,
                track,
                offset,
                u_applied,
                compensate: flags[0],
                inhibit_up: flags[1],
                inhibit_down: flags[2],
                acknowledge: flags[3],
            }
        })
        .boxed()
}

/// One sample's output.
pub(crate) fn outputs() -> BoxedStrategy<ControllerOutput<f64>> {
    (prop::array::uniform7(number()), any::<bool>(), any::<bool>(), 0..7_u8, any::<u32>())
        .prop_map(|([u, v, i, pd, u_f, d_hat, r], blocked_up, blocked_down, mode, status)| ControllerOutput {
            u,
            v,
            i,
            pd,
            u_f,
            d_hat,
            r,
            blocked_up,
            blocked_down,
            mode: Mode::from_number(mode).expect("a mode"),
            status: Status::from_bits(status),
        })
        .boxed()
}
