//! Three loops in HAL, through everything that can happen to a loop, against the reference sample by sample.

use crate::record::{Row, SAMPLES, TYPES, record, text};
use crate::reference::{Reference, TS};
use crate::session::Session;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    AntiWindupConfig, AnyCompensator, Compensate, CompensatorConfig, ConfigErrors, Controller,
    ControllerConfig, ControllerOutput, EstimatorConfig, FallbackAction, FallbackConfig, FallbackReturn,
    IntegralRule, LimitConfig, NoCompensator, ObserverConfig, PidConfig, SetpointConfig, Status,
};

/// The sampler prints six decimals of a number; of one that is so many times as large, they are all it has.
const SCALE: f64 = 1e9;
/// Gain of HAL's `lowpass` for a plant of 0.1 s: `1 - exp(-TS/0.1)`.
const PLANT_GAIN: f64 = 0.009950166250831947;
/// Range of the actuator of the loop that has a read-back.
const ACTUATOR: f64 = 0.8;

/// The numbers of a loop that are sampled, in the order of the columns.
const NUMBERS: [&str; 8] = [
    "output",
    "output-unlimited",
    "integral",
    "compensation",
    "disturbance",
    "working-setpoint",
    "error",
    "",
];
/// The others, with their types.
const OTHERS: [(&str, char); 13] = [
    ("mode", 's'),
    ("status", 'u'),
    ("adopted", 'u'),
    ("fault-code", 's'),
    ("fault-field", 's'),
    ("refused", 'b'),
    ("saturated", 'b'),
    ("bad-feedback", 'b'),
    ("in-fallback", 'b'),
    ("compensating", 'b'),
    ("blocked-up", 'b'),
    ("blocked-down", 'b'),
    ("ready", 'b'),
];

/// The parameters that stay, in HAL ..
const SETTINGS: [&[(&str, &str)]; 3] = [
    &[
        ("kd", "0.02"),
        ("tf", "0.008"),
        ("b", "0.7"),
        ("c", "0.2"),
        ("integral-rule", "1"),
        ("anti-windup", "1"),
        ("deadband", "0.002"),
        ("output-lo", "-1.5"),
        ("output-rate-up", "60"),
        ("output-rate-down", "90"),
        ("setpoint-lo", "-0.9"),
        ("setpoint-hi", "0.95"),
        ("setpoint-rate-up", "40"),
        ("setpoint-track", "1"),
        ("off-output", "0.05"),
        ("hold-samples", "4"),
        ("fallback", "2"),
        ("fallback-output", "-0.1"),
        ("fallback-rate", "5"),
        ("fallback-latched", "1"),
    ],
    &[
        ("output-lo", "-2"),
        ("tt", "0.05"),
        ("off-output", "nan"),
        ("initial-output", "0.1"),
        ("hold-samples", "0"),
        ("fallback", "1"),
        ("fallback-output", "0.3"),
        ("compensator", "2"),
        ("alpha", "0.02"),
        ("model-gain", "1.1"),
        ("model-dead-time", "0.0023"),
        ("latency", "0.0011"),
        ("model-pole-a1-0", "0.1"),
        ("model-pole-a1-1", "0.02"),
        ("model-zero-a1-0", "-0.001"),
    ],
    &[
        ("kd", "0.01"),
        ("tf", "0.006"),
        ("c", "1"),
        ("anti-windup", "2"),
        ("setpoint-rate-down", "3"),
        ("feedback-lo", "-3"),
        ("feedback-hi", "3"),
        ("hold-samples", "8"),
        ("compensator", "1"),
        ("kfd", "0.7"),
        ("tfd", "0.012"),
        ("model-gain", "0.9"),
        ("model-dead-time", "0.0065"),
        // The place of a factor does not matter.
        ("model-pole-a1-3", "0.11"),
        ("model-pole-a2-3", "0.0009"),
    ],
];

/// .. and in Rust.
fn pid_config() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig {
            kd: 0.02,
            tf: 0.008,
            b: 0.7,
            c: 0.2,
            integral_rule: IntegralRule::Trapezoid,
            ..PidConfig::default()
        },
        limits: LimitConfig { lo: -1.5, hi: 0.0, rate_up: Some(60.0), rate_down: Some(90.0) },
        setpoint: SetpointConfig { lo: -0.9, hi: 0.95, rate_up: Some(40.0), rate_down: None, track: true },
        anti_windup: AntiWindupConfig::Conditional,
        deadband: 0.002,
        fallback: FallbackConfig {
            hold_samples: 4,
            action: FallbackAction::Ramp { output: -0.1, rate: 5.0 },
            back: FallbackReturn::Acknowledged,
        },
        off_output: Some(0.05),
        ..ControllerConfig::default()
    }
}

fn observer_config() -> ControllerConfig {
    ControllerConfig {
        limits: LimitConfig::range(-2.0, 0.0),
        anti_windup: AntiWindupConfig::BackCalculation { tt: Some(0.05) },
        fallback: FallbackConfig {
            hold_samples: 0,
            action: FallbackAction::Substitute { output: 0.3 },
            ..FallbackConfig::default()
        },
        initial_output: 0.1,
        ..ControllerConfig::default()
    }
}

fn estimator_config() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig { kd: 0.01, tf: 0.006, c: 1.0, ..PidConfig::default() },
        setpoint: SetpointConfig { rate_down: Some(3.0), ..SetpointConfig::default() },
        anti_windup: AntiWindupConfig::None,
        measurement_lo: -3.0,
        measurement_hi: 3.0,
        fallback: FallbackConfig { hold_samples: 8, ..FallbackConfig::default() },
        off_output: Some(0.0),
        ..ControllerConfig::default()
    }
}

fn observer() -> CompensatorConfig {
    let model = PlantModel { gain: 1.1, dead_time: 0.0023, ..PlantModel::default() }
        .with_pole(Factor::first(0.1))
        .with_pole(Factor::first(0.02))
        .with_zero(Factor::first(-0.001));
    ObserverConfig { model, alpha: 0.02, order: None }.to_compensator(0.0011)
}

fn estimator() -> CompensatorConfig {
    let config = EstimatorConfig { gain: 0.9, a1: 0.11, a2: 0.0009, dead_time: 0.0065, kfd: 0.7, tfd: 0.012 };
    config.to_compensator(0.0)
}

type Block = AnyCompensator<f64, Vec<f64>>;

fn with(
    compensator: &CompensatorConfig,
    config: &ControllerConfig,
) -> Result<Controller<f64, Block>, ConfigErrors> {
    Controller::with_compensator(config, Block::new(compensator, TS, 64)?, TS)
}

fn compensated(
    base: ControllerConfig,
    compensator: &CompensatorConfig,
    build: fn(&ControllerConfig) -> Result<Controller<f64, Block>, ConfigErrors>,
) -> Reference<Block> {
    let law = Block::new(compensator, TS, 64).expect("a valid model");
    Reference::new(base, build, law.state(vec![0.0; 64]).expect("the delay fits"))
}

/// The commands of the run.
fn commands() -> String {
    let fields = [
        "setpoint",
        "setpoint-remote",
        "",
        "kp",
        "ki",
        "feed-forward",
        "",
        "output-hi",
        "feedback-quality",
        "enable",
        "manual",
        "track",
        "hold",
        "cascade",
        "compensate",
        "inhibit-up",
        "inhibit-down",
        "acknowledge",
        "param-hold",
    ];
    let types =
        format!("{}{}", "f".repeat(NUMBERS.len()), OTHERS.map(|(_, kind)| kind).iter().collect::<String>());
    // Room for one sample more than there are: one that is full takes no more.
    let depth = SAMPLES + 1;
    let mut text = format!(
        "loadrt threads name1=t period1=1000000 fp1=1
loadrt streamer depth={depth} cfg={TYPES}
loadrt not
loadrt ctl_loop count=3 max_delay=20
loadrt lowpass count=3
loadrt sum2 count=3
loadrt limit1 count=1
loadrt scale count={}
loadrt sampler depth={depth},{depth},{depth} cfg={types},{types},{types}
loadusr -w halstreamer record.txt
net at-end streamer.0.empty => not.0.in
net sampled not.0.out => sampler.0.enable sampler.1.enable sampler.2.enable
addf streamer.0 t
addf not.0 t
setp limit1.0.min -{ACTUATOR}
setp limit1.0.max {ACTUATOR}
",
        3 * NUMBERS.len()
    );
    for (i, field) in fields.iter().enumerate() {
        let to: String = match *field {
            "" => String::new(),
            _ => (0..3).map(|n| format!(" ctl-loop.{n}.{field}")).collect(),
        };
        text += &format!("net in-{i} streamer.0.pin.{i}{to}\n");
    }
    for n in 0..3 {
        text +=
            &format!("net in-6 ctl-loop.{n}.manual-value ctl-loop.{n}.track-value\nnet in-2 sum2.{n}.in1\n");
        text += &format!("setp lowpass.{n}.gain {PLANT_GAIN}\n");
        for (name, value) in SETTINGS[n] {
            text += &format!("setp ctl-loop.{n}.{name} {value}\n");
        }
        text += &format!(
            "net y-{n} lowpass.{n}.out => ctl-loop.{n}.feedback\nnet into-{n} sum2.{n}.out => lowpass.{n}.in\n"
        );
        text += &format!("addf ctl-loop.{n} t\n");
        for (i, name) in NUMBERS.iter().enumerate() {
            let scale = n * NUMBERS.len() + i;
            let from =
                if name.is_empty() { format!("y-{n}") } else { format!("n-{n}-{i} ctl-loop.{n}.{name}") };
            text += &format!("net {from} => scale.{scale}.in\nsetp scale.{scale}.gain {SCALE}\n");
            text += &format!(
                "net scaled-{n}-{i} scale.{scale}.out => sampler.{n}.pin.{i}\naddf scale.{scale} t\n"
            );
        }
        for (i, (name, _)) in OTHERS.iter().enumerate() {
            let pin = NUMBERS.len() + i;
            text += &format!("net o-{n}-{i} ctl-loop.{n}.{name} => sampler.{n}.pin.{pin}\n");
        }
        text += &format!("addf sampler.{n} t\n");
    }
    text += "net n-0-0 => sum2.0.in0\nnet n-1-0 => limit1.0.in\nnet n-2-0 => sum2.2.in0\n";
    text += "net acts limit1.0.out => sum2.1.in0 ctl-loop.1.applied\nsetp ctl-loop.1.has-applied 1\naddf limit1.0 t\n";
    for n in 0..3 {
        text += &format!("addf sum2.{n} t\naddf lowpass.{n} t\n");
    }
    text += "start\n";
    for n in 0..3 {
        text += &format!("loadusr -w halsampler -c {n} -n {SAMPLES} rows-{n}.txt\n");
    }
    text
}

/// Columns that one loop should have in one sample.
fn expected<C: Compensate<f64>>(
    side: &Reference<C>,
    out: &ControllerOutput<f64>,
    error: f64,
    y: f64,
) -> Vec<String> {
    let numbers = [out.u, out.v, out.i, out.u_f, out.d_hat, out.r, error, y];
    // HAL's `scale` adds its offset of 0, which makes 0 of -0.
    let mut columns: Vec<String> = numbers.iter().map(|x| format!("{:.6}", x * SCALE + 0.0)).collect();
    let has = |status: Status| u8::from(out.status.has(status)).to_string();
    let limited = [Status::LIMITED_HIGH, Status::LIMITED_LOW, Status::RATE_LIMITED];
    columns.extend([
        (out.mode as i32 + 1).to_string(),
        out.status.bits().to_string(),
        side.adopted.to_string(),
        (if side.fault.is_some() { 7 } else { 0 }).to_string(),
        side.fault.map_or(0, |fault| fault.param as i32).to_string(),
        u8::from(side.fault.is_some()).to_string(),
        u8::from(limited.iter().any(|&bit| out.status.has(bit))).to_string(),
        has(Status::BAD_INPUT),
        has(Status::FALLBACK),
        has(Status::COMPENSATING),
        u8::from(out.blocked_up).to_string(),
        u8::from(out.blocked_down).to_string(),
        "1".to_string(),
    ]);
    columns
}

/// One loop of the reference on its plant.
struct Plant<C: Compensate<f64>> {
    side: Reference<C>,
    x: f64,
    error: f64,
    applied: Option<f64>,
}

impl<C: Compensate<f64>> Plant<C> {
    fn new(side: Reference<C>, applied: Option<f64>) -> Self {
        Self { side, x: 0.0, error: 0.0, applied }
    }

    fn sample(&mut self, row: &Row) -> (Vec<String>, ControllerOutput<f64>) {
        let out = self.side.step(row, self.x, self.applied);
        if !out.status.has(Status::BAD_INPUT) {
            self.error = out.r - self.x;
        }
        let columns = expected(&self.side, &out, self.error, self.x);
        let acts = match &mut self.applied {
            Some(applied) => {
                *applied = out.u.clamp(-ACTUATOR, ACTUATOR);
                *applied
            }
            None => out.u,
        };
        self.x += ((acts + row.load) - self.x) * PLANT_GAIN;
        (columns, out)
    }
}

/// What a record must have reached, or the comparison would say little.
#[derive(Debug, Default)]
struct Reached {
    modes: [usize; 8],
    refused: usize,
    limited_high: usize,
    limited_low: usize,
    compensating: usize,
}

fn compare<C: Compensate<f64>>(
    n: usize,
    mut plant: Plant<C>,
    rows: &[Row],
    sampled: &[Vec<String>],
) -> Reached {
    let mut reached = Reached::default();
    assert_eq!(sampled.len(), rows.len());
    let names: Vec<&str> = NUMBERS.into_iter().chain(OTHERS.map(|(name, _)| name)).collect();
    for (k, (row, sample)) in rows.iter().zip(sampled).enumerate() {
        let (columns, out) = plant.sample(row);
        for ((name, ours), theirs) in names.iter().zip(&columns).zip(sample) {
            assert_eq!(theirs, ours, "ctl-loop.{n}.{name}, sample {k} {row:?}");
        }
        assert_eq!(sample.len(), columns.len());
        reached.modes[out.mode as usize] += 1;
        reached.refused += usize::from(plant.side.fault.is_some());
        reached.limited_high += usize::from(out.status.has(Status::LIMITED_HIGH));
        reached.limited_low += usize::from(out.status.has(Status::LIMITED_LOW));
        reached.compensating += usize::from(out.status.has(Status::COMPENSATING));
    }
    reached
}

#[test]
fn the_trace_equals_the_reference_to_all_printed_digits() {
    let Some(session) = Session::open("trace") else { return };
    let rows = record();
    session.write("record.txt", &text(&rows));
    session.run(&commands());
    let plain: Reference<NoCompensator> = Reference::new(pid_config(), |c| Controller::new(c, TS), ());
    let with_observer = compensated(observer_config(), &observer(), |c| with(&observer(), c));
    let with_estimator = compensated(estimator_config(), &estimator(), |c| with(&estimator(), c));
    let all = [
        compare(0, Plant::new(plain, None), &rows, &session.rows("rows-0.txt")),
        compare(1, Plant::new(with_observer, Some(0.0)), &rows, &session.rows("rows-1.txt")),
        compare(2, Plant::new(with_estimator, None), &rows, &session.rows("rows-2.txt")),
    ];
    for (n, reached) in all.iter().enumerate() {
        println!("ctl-loop.{n}: {reached:?}");
        assert!(reached.modes[..7].iter().all(|&samples| samples >= 10), "loop {n}: {reached:?}");
        assert!(reached.refused >= 100 && reached.limited_high >= 20, "loop {n}: {reached:?}");
        assert!(n == 0 || reached.compensating >= 1000, "loop {n}: {reached:?}");
    }
}
