//! Loops of every shape, everything that is not a default in some of them.

use crate::drive::Chance;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, ControllerConfig, EstimatorConfig, FallbackAction, FallbackConfig,
    FallbackReturn, IntegralRule, LimitConfig, ObserverConfig, PidConfig, SetpointConfig,
};
use controller_sim_host::scenario::{CompensatorSpec, ControllerSpec, NoFiles, Scenario, read_with};
use controller_sim_host::simulate::Precision;

/// Sampling period of all of them \[s\].
pub(crate) const TS: f64 = 0.01;

/// A scenario with these controllers.
pub(crate) fn scenario(controllers: Vec<ControllerSpec>) -> Scenario {
    let text = "version = 1\nts = 0.01\nduration = 1.0\nlatency = 0.003\n[plant]\ntf = \"1/(1+s)\"\n\
                [[controller]]\nname = \"any\"\npid = { kp = 1.0, ki = 1.0 }\n";
    let read = read_with("any.toml", text, Precision::F64, &NoFiles);
    let read = read.unwrap_or_else(|faults| panic!("{faults:?}"));
    let scenario = read.cases.into_iter().next().expect("one case").scenario;
    Scenario { controllers, ..scenario }
}

fn spec(name: &str, config: ControllerConfig, compensator: CompensatorSpec) -> ControllerSpec {
    ControllerSpec { config, compensator, ..ControllerSpec::pid(name, config.pid) }
}

fn pid(kp: f64, ki: f64, kd: f64, tf: f64) -> PidConfig {
    PidConfig { kp, ki, kd, tf, ..PidConfig::default() }
}

fn estimator(a2: f64, dead_time: f64) -> CompensatorSpec {
    let config = EstimatorConfig { gain: 1.0, a1: 1.2, a2, dead_time, kfd: 0.69, tfd: 0.06 };
    CompensatorSpec::Estimator(config)
}

fn observer(model: PlantModel, alpha: f64, order: Option<usize>) -> CompensatorSpec {
    CompensatorSpec::Observer(ObserverConfig { model, alpha, order })
}

/// One loop of every kind.
pub(crate) fn all() -> Vec<ControllerSpec> {
    let rich = ControllerConfig {
        pid: PidConfig { b: 0.7, c: 0.2, integral_rule: IntegralRule::Trapezoid, ..pid(2.0, 1.5, 0.3, 0.1) },
        limits: LimitConfig { lo: -3.0, hi: 5.0, rate_up: Some(40.0), rate_down: Some(70.0) },
        setpoint: SetpointConfig { lo: -1.5, hi: 2.0, rate_up: Some(1.7), rate_down: Some(3.0), track: true },
        anti_windup: AntiWindupConfig::Conditional,
        deadband: 0.01,
        measurement_lo: -4.0,
        measurement_hi: 4.0,
        offset_lo: -0.5,
        offset_hi: 0.75,
        fallback: FallbackConfig {
            hold_samples: 3,
            action: FallbackAction::Ramp { output: 0.5, rate: 2.0 },
            back: FallbackReturn::Acknowledged,
        },
        alarms: AlarmConfig {
            hi_hi: Some(1.4),
            hi: Some(1.1),
            lo: Some(-0.2),
            lo_lo: Some(-0.7),
            deviation: Some(0.6),
            hysteresis: 0.13,
        },
        off_output: Some(-0.25),
        initial_output: 0.1,
    };
    let plain = |pid| ControllerConfig {
        pid,
        limits: LimitConfig::range(-10.0, 10.0),
        ..ControllerConfig::default()
    };
    let third = PlantModel::default()
        .with_gain(1.3)
        .with_dead_time(0.2047)
        .with_pole(Factor::first(1.0))
        .with_pole(Factor::first(0.5))
        .with_pole(Factor::first(0.2))
        .with_zero(Factor::first(0.1));
    let integrating = PlantModel { integrators: 1, ..PlantModel::default() }
        .with_gain(0.4)
        .with_dead_time(0.1)
        .with_pole(Factor::second(0.3, 0.2));
    vec![
        spec("pid rich", rich, CompensatorSpec::None),
        spec("PI default", plain(pid(0.8, 0.7, 0.0, 0.0)), CompensatorSpec::None),
        spec(
            "P only",
            ControllerConfig { anti_windup: AntiWindupConfig::None, ..plain(pid(1.5, 0.0, 0.0, 0.0)) },
            CompensatorSpec::None,
        ),
        spec(
            "PD direct",
            plain(PidConfig { action: Action::Direct, ..pid(1.5, 0.0, 0.2, 0.05) }),
            CompensatorSpec::None,
        ),
        spec("I only", plain(pid(0.0, 1.0, 0.0, 0.02)), CompensatorSpec::None),
        spec(
            "PID negative, held at once",
            ControllerConfig {
                fallback: FallbackConfig {
                    hold_samples: 0,
                    action: FallbackAction::Substitute { output: 1.0 },
                    back: FallbackReturn::Automatic,
                },
                alarms: AlarmConfig { hi: Some(0.7), ..AlarmConfig::default() },
                ..plain(pid(-2.0, -1.0, -0.4, 0.2))
            },
            CompensatorSpec::None,
        ),
        spec(
            "DE second order",
            ControllerConfig {
                limits: LimitConfig::range(-2.0, 2.0),
                ..plain(PidConfig { c: 1.0, ..pid(2.35, 1.88, 0.48, 0.119) })
            },
            estimator(0.2, 0.2),
        ),
        spec(
            "DE rich",
            ControllerConfig { anti_windup: AntiWindupConfig::BackCalculation { tt: Some(0.3) }, ..rich },
            estimator(0.2, 0.2371),
        ),
        spec("DE first order", plain(pid(0.8, 0.7, 0.0, 0.03)), estimator(0.0, 0.1043)),
        spec(
            "DOB first order",
            plain(PidConfig { integral_rule: IntegralRule::Trapezoid, ..pid(0.8, 0.7, 0.0, 0.0) }),
            observer(PlantModel::first_order(1.0, 1.0, 0.3333), 0.1, None),
        ),
        spec(
            "DOB third order",
            ControllerConfig { pid: pid(0.8, 0.7, 0.1, 0.05), ..rich },
            observer(third, 0.15, Some(3)),
        ),
        spec("DOB integrating", plain(pid(1.0, 0.1, 0.0, 0.0)), observer(integrating, 0.2, None)),
        spec(
            "DOB without delay",
            plain(pid(0.8, 0.7, 0.0, 0.0)),
            observer(PlantModel::first_order(2.0, 1.0, 0.0), 0.05, Some(2)),
        ),
    ]
}

/// A loop of parts drawn at random: rules, ranges, rates, weights, fallback, alarms, compensator.
pub(crate) fn random(number: u64) -> ControllerSpec {
    let mut chance = Chance(number.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let chance = &mut chance;
    let sign = chance.pick(&[1.0, 1.0, -1.0]);
    let scale = chance.pick(&[1.0, 1e-3, 250.0]);
    let tf = chance.pick(&[0.0, 0.005, 0.0137, 0.4]);
    let kd = if tf == 0.0 { 0.0 } else { chance.pick(&[0.0, 0.31]) };
    let rule = chance.pick(&[IntegralRule::Backward, IntegralRule::Trapezoid]);
    let pid = PidConfig {
        b: chance.pick(&[0.0, 0.5, 1.0, 1.3]),
        c: chance.pick(&[0.0, 0.7, 1.0]),
        integral_rule: rule,
        ..pid(1.7 * sign * scale, chance.pick(&[0.0, 0.9, 1.1]) * sign * scale, kd * sign * scale, tf)
    };
    let (lo, hi) = chance.pick(&[(-1e6, 1e6), (-2.0, 2.0), (0.0, 1.5), (-0.7, -0.1)]);
    let some = |chance: &mut Chance, value: f64| (!chance.one_in(2)).then_some(value);
    let within = |x: f64| lo + x * (hi - lo);
    let config = ControllerConfig {
        pid,
        limits: LimitConfig { lo, hi, rate_up: some(chance, 13.7), rate_down: some(chance, 0.9) },
        setpoint: SetpointConfig {
            lo: chance.pick(&[-1e6, 0.0, -1.2]),
            hi: chance.pick(&[1e6, 0.9]),
            rate_up: some(chance, 2.3),
            rate_down: some(chance, 1e-7),
            track: chance.one_in(2),
        },
        anti_windup: chance.pick(&[
            AntiWindupConfig::BackCalculation { tt: None },
            AntiWindupConfig::BackCalculation { tt: Some(0.003) },
            AntiWindupConfig::BackCalculation { tt: Some(0.77) },
            AntiWindupConfig::Conditional,
            AntiWindupConfig::None,
        ]),
        deadband: chance.pick(&[0.0, 0.0, 0.05]),
        measurement_lo: chance.pick(&[-1e6, -0.0, -3.0]),
        measurement_hi: chance.pick(&[1e6, 4.0]),
        offset_lo: chance.pick(&[-1e6, 0.0]),
        offset_hi: chance.pick(&[1e6, 0.05]),
        fallback: FallbackConfig {
            hold_samples: chance.pick(&[0, 1, 4, 25]),
            action: chance.pick(&[
                FallbackAction::Hold,
                FallbackAction::Substitute { output: within(0.25) },
                FallbackAction::Ramp { output: within(0.75), rate: 0.6 },
            ]),
            back: chance.pick(&[FallbackReturn::Automatic, FallbackReturn::Acknowledged]),
        },
        alarms: AlarmConfig {
            hi_hi: some(chance, 1.5),
            hi: some(chance, 1.0),
            lo: some(chance, 0.1),
            lo_lo: some(chance, -0.3),
            deviation: some(chance, 0.4),
            hysteresis: chance.pick(&[0.0, 0.1]),
        },
        off_output: some(chance, within(0.1)),
        initial_output: chance.pick(&[0.0, 0.37, -5.0]),
    };
    let gain = 1.1 * sign;
    let mut model =
        PlantModel::default().with_gain(gain).with_dead_time(chance.pick(&[0.0, 0.004, 0.0351, 0.21]));
    let order = 1 + chance.below(5);
    for n in 0..order {
        model = model.with_pole(Factor::first(0.2 + 0.31 * n as f64));
    }
    if order > 1 && chance.one_in(2) {
        model = model.with_zero(Factor::first(chance.pick(&[0.15, -0.1, 0.002])));
    }
    let compensator = match chance.below(3) {
        0 => CompensatorSpec::None,
        1 => CompensatorSpec::Estimator(EstimatorConfig {
            gain,
            a1: 0.9,
            a2: chance.pick(&[0.0, 0.15, 0.4]),
            dead_time: chance.pick(&[0.0, 0.123]),
            kfd: chance.pick(&[0.0, 0.6, 1.0]),
            tfd: 0.07,
        }),
        _ => observer(model, 0.12, None),
    };
    spec(&format!("random {number}"), config, compensator)
}
