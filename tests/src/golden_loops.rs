//! Reader of `golden/loops.json`: closed sampled loops from 50-digit arithmetic, as the product's own scenarios.
//!
//! The generator `golden/make_loops.py` stands beside the file and says how they were computed and checked. Numbers are
//! written as decimals that the generator takes as exact; here they become doubles.

use crate::cases::{from_rest, model, transfer_function};
use crate::oracle::state_space::PlantFactors;
use controller_core::{
    AntiWindupConfig, EstimatorConfig, IntegralRule, LimitConfig, Mode, ObserverConfig, PidConfig,
};
use controller_design::model::TransferFunction;
use controller_sim_host::scenario::{
    Actuator, Between, Change, ControllerSpec, Event, Initial, Recording, Scenario, Sensor, Signal,
};
use serde_json::Value;
use std::sync::Arc;

/// Instants between two samples at which the outputs are tabulated, as tenths of a sample.
pub const BETWEEN: [usize; 2] = [3, 7];

const TABLE: &str = include_str!("../golden/loops.json");

/// A loop with some of its samples.
#[derive(Clone, Debug)]
pub struct GoldenLoop {
    /// What is special about it.
    pub name: String,
    /// Order of the plant.
    pub order: usize,
    /// The loop as a scenario with one controller.
    pub scenario: Scenario,
    /// Exact signals.
    pub rows: Vec<Row>,
}

/// Exact signals of one sample.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Number of the sample.
    pub k: usize,
    /// Measurement \[y\].
    pub y: f64,
    /// Output of the controller \[u\].
    pub u: f64,
    /// Output of the plant at [`BETWEEN`] \[y\].
    pub between: [f64; 2],
    /// Set-point and measurement of the inner loop of a cascade.
    pub inner: Option<(f64, f64)>,
}

impl GoldenLoop {
    /// Largest size of the plant's and the controller's output in the table.
    #[must_use]
    pub fn scales(&self) -> (f64, f64) {
        self.rows.iter().fold((0.0, 0.0), |(y, u), row| (y.max(row.y.abs()), u.max(row.u.abs())))
    }

    /// The disturbances with their times \[s\].
    #[must_use]
    pub fn disturbances(&self) -> Vec<(f64, Signal)> {
        let changes = self.scenario.events.iter().flat_map(|e| e.changes.iter().map(move |c| (e.at, c)));
        changes
            .filter_map(|(at, c)| if let Change::Disturbance(d) = c { Some((at, d.clone())) } else { None })
            .collect()
    }
}

/// All loops of the table, in its order.
///
/// # Panics
/// When the file is damaged.
#[must_use]
pub fn loops() -> Vec<GoldenLoop> {
    let table: Value = serde_json::from_str(TABLE).expect("valid JSON");
    table.as_array().expect("a list").iter().map(read).collect()
}

/// A decimal in quotes, or `default` when the key is missing.
fn number(of: &Value, key: &str, default: f64) -> f64 {
    of.get(key).map_or(default, decimal)
}

fn decimal(value: &Value) -> f64 {
    value.as_str().and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("no decimal: {value}"))
}

fn list<T>(of: &Value, key: &str, item: impl Fn(&Value) -> T) -> Vec<T> {
    of.get(key).and_then(Value::as_array).map_or_else(Vec::new, |list| list.iter().map(item).collect())
}

/// A plant's factors with the lists they borrow.
struct Owned {
    lags: Vec<f64>,
    pairs: Vec<(f64, f64)>,
    zeros: Vec<(f64, f64)>,
    gain: f64,
    integrators: usize,
    dead_time: f64,
}

impl Owned {
    fn read(from: &Value) -> Self {
        let two = |pair: &Value| (decimal(&pair[0]), decimal(&pair[1]));
        Self {
            lags: list(from, "lags", decimal),
            pairs: list(from, "pairs", two),
            zeros: list(from, "zeros", two),
            gain: number(from, "gain", 1.0),
            integrators: from.get("integrators").and_then(Value::as_u64).unwrap_or(0) as usize,
            dead_time: number(from, "dead_time", 0.0),
        }
    }

    fn factors(&self) -> PlantFactors<'_> {
        PlantFactors {
            gain: self.gain,
            integrators: self.integrators,
            lags: &self.lags,
            pairs: &self.pairs,
            zeros: &self.zeros,
            dead_time: self.dead_time,
        }
    }

    fn transfer_function(&self) -> TransferFunction {
        transfer_function(&self.factors())
    }
}

fn read(case: &Value) -> GoldenLoop {
    let plant = Owned::read(&case["plant"]);
    let ts = number(case, "ts", f64::NAN);
    let samples = case["samples"].as_u64().expect("a count") as f64;
    let initial = case.get("initial").unwrap_or(&Value::Null);
    let events = list(case, "events", event);
    let spec = controller(case);
    let unused = Change::Setpoint(Signal::Step(0.0));
    let mut scenario = from_rest(&plant.factors(), ts, samples * ts, unused, vec![spec]);
    scenario.plant = plant.transfer_function();
    scenario.latency = number(case, "latency", 0.0);
    scenario.initial = Initial {
        setpoint: number(initial, "setpoint", 0.0),
        disturbance: number(initial, "disturbance", 0.0),
    };
    scenario.events = events;
    scenario.inner_plant = case.get("inner_plant").map(|part| Owned::read(part).transfer_function());
    scenario.sensor = sensor(case.get("sensor").unwrap_or(&Value::Null));
    scenario.actuator = actuator(case.get("actuator").unwrap_or(&Value::Null));
    let number_at = |row: &Value, index: usize| row[index].as_f64().expect("a number");
    let rows = list(case, "rows", |row| Row {
        k: row[0].as_u64().expect("a sample") as usize,
        y: number_at(row, 1),
        u: number_at(row, 2),
        between: [number_at(row, 3), number_at(row, 4)],
        inner: row.get(5).map(|_| (number_at(row, 5), number_at(row, 6))),
    });
    let name = case["name"].as_str().expect("a name").to_owned();
    GoldenLoop { name, order: plant.factors().order(), scenario, rows }
}

fn controller(case: &Value) -> ControllerSpec {
    let mut spec = ControllerSpec::pid("PID", pid(&case["pid"]));
    if let Some(limits) = case.get("limits") {
        spec.config.limits = LimitConfig::range(number(limits, "lo", -1e6), number(limits, "hi", 1e6));
        let rate = limits.get("rate").map(decimal);
        (spec.config.limits.rate_up, spec.config.limits.rate_down) = (rate, rate);
    }
    spec.config.anti_windup = match case.get("anti_windup").and_then(Value::as_str) {
        Some("conditional") => AntiWindupConfig::Conditional,
        Some(other) => panic!("{other}: unknown"),
        None => AntiWindupConfig::BackCalculation { tt: case.get("tt").map(decimal) },
    };
    if let Some(inner) = case.get("secondary") {
        spec.secondary = Some(Box::new(ControllerSpec { mode: Mode::Cascade, ..controller(inner) }));
    }
    if let Some(e) = case.get("estimator") {
        let of = |key| number(e, key, f64::NAN);
        let (gain, dead_time) = (of("gain"), of("dead_time"));
        let [a1, a2, kfd, tfd] = [of("a1"), of("a2"), of("kfd"), of("tfd")];
        spec = spec.with_estimator(EstimatorConfig { gain, a1, a2, dead_time, kfd, tfd });
    }
    if let Some(o) = case.get("observer") {
        let model = model(&Owned::read(o).factors());
        spec = spec.with_observer(ObserverConfig { model, alpha: number(o, "alpha", f64::NAN), order: None });
    }
    spec
}

fn sensor(from: &Value) -> Sensor {
    Sensor {
        lo: number(from, "lo", f64::NEG_INFINITY),
        hi: number(from, "hi", f64::INFINITY),
        resolution: number(from, "resolution", 0.0),
    }
}

fn actuator(from: &Value) -> Actuator {
    Actuator {
        lo: number(from, "lo", f64::NEG_INFINITY),
        hi: number(from, "hi", f64::INFINITY),
        rate: number(from, "rate", f64::INFINITY),
        resolution: number(from, "resolution", 0.0),
        deadband: number(from, "deadband", 0.0),
        stiction: None,
        read_back: from.get("read_back").and_then(Value::as_bool).unwrap_or(false),
    }
}

fn pid(from: &Value) -> PidConfig {
    let rule = match from.get("rule").and_then(Value::as_str) {
        Some("trapezoid") => IntegralRule::Trapezoid,
        _ => IntegralRule::Backward,
    };
    let [kp, ki, kd, tf] = ["kp", "ki", "kd", "tf"].map(|key| number(from, key, 0.0));
    let (b, c) = (number(from, "b", 1.0), number(from, "c", 0.0));
    PidConfig { kp, ki, kd, tf, b, c, integral_rule: rule, ..PidConfig::default() }
}

fn event(from: &Value) -> Event {
    let change = match (from.get("setpoint"), from.get("disturbance")) {
        (Some(signal), _) => Change::Setpoint(read_signal(signal)),
        (_, Some(signal)) => Change::Disturbance(read_signal(signal)),
        _ => panic!("{from}: no change"),
    };
    Event { at: number(from, "at", f64::NAN), label: String::new(), changes: vec![change], controller: None }
}

fn read_signal(from: &Value) -> Signal {
    let duration = number(from, "duration", f64::INFINITY);
    if let Some(value) = from.get("step") {
        Signal::Step(decimal(value))
    } else if let Some(slope) = from.get("ramp") {
        Signal::Ramp { slope: decimal(slope), duration }
    } else if let Some(height) = from.get("pulse") {
        Signal::Pulse { height: decimal(height), duration }
    } else if let Some(amplitude) = from.get("sine") {
        let (period, phase) = (number(from, "period", f64::NAN), number(from, "phase", 0.0));
        Signal::Sine { amplitude: decimal(amplitude), period, phase, duration }
    } else {
        let between = match from["between"].as_str() {
            Some("line") => Between::Line,
            Some("hold") => Between::Hold,
            _ => panic!("{from}: no signal"),
        };
        let (times, values) = (list(from, "times", decimal), list(from, "values", decimal));
        Signal::Recorded(Arc::new(Recording { name: "golden".to_owned(), times, values, between }))
    }
}
