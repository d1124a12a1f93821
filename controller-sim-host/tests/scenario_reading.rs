//! Good scenarios: every key arrives where it belongs.

use controller_core::plant_model::PlantModel;
use controller_core::{
    Action, AdrcConfig, AlarmConfig, AntiWindupConfig, ControllerConfig, EstimatorConfig, FallbackAction,
    FallbackConfig, FallbackReturn, IntegralRule, LimitConfig, Mode, ObserverConfig, PidConfig,
    SetpointConfig, Status,
};
use controller_design::model::parse;
use controller_sim_host::demo;
use controller_sim_host::scenario::{
    Actuator, Change, CompensatorSpec, ControllerSpec, Event, FolderFiles, Initial, Noise, Scenario, Signal,
    code, read, read_with,
};
use controller_sim_host::simulate::Precision;
use std::path::{Path, PathBuf};

fn everything() -> Scenario {
    let read = read(include_str!("data/everything.toml"), Precision::F64).expect("no faults");
    assert_eq!(read.warnings, []);
    read.scenario
}

#[test]
fn the_run_and_its_surroundings() {
    let s = everything();
    assert_eq!((s.ts, s.duration, s.latency, s.substeps), (0.1, 100.0, 0.05, 4));
    assert_eq!(Ok(s.plant), parse("2*exp(-s)/(1+5*s)"));
    assert_eq!(s.initial, Initial { setpoint: 1.0, disturbance: 0.25 });
    assert_eq!(s.noise, Some(Noise { std: 0.01, seed: 42 }));
    assert_eq!(s.actuator, Actuator { lo: -5.0, hi: 5.0, read_back: true, ..Actuator::default() });
}

#[test]
fn a_controller_with_every_key() {
    let series = &everything().controllers[0];
    assert_eq!((&*series.name, series.mode), ("series", Mode::Manual));
    let expected = ControllerConfig {
        pid: PidConfig {
            kp: 2.5,
            ki: 0.25,
            kd: 4.0,
            tf: 0.5,
            b: 0.5,
            c: 0.25,
            action: Action::Reverse,
            integral_rule: IntegralRule::Trapezoid,
        },
        limits: LimitConfig { lo: -3.0, hi: 3.0, rate_up: Some(1.0), rate_down: Some(2.0) },
        setpoint: SetpointConfig { lo: -2.0, hi: 4.0, rate_up: Some(0.5), rate_down: Some(0.5), track: true },
        anti_windup: AntiWindupConfig::BackCalculation { tt: Some(4.0) },
        deadband: 0.0625,
        measurement_lo: -10.0,
        measurement_hi: 10.0,
        offset_lo: -1.0,
        offset_hi: 1.0,
        fallback: FallbackConfig {
            hold_samples: 5,
            action: FallbackAction::Ramp { output: 0.5, rate: 0.25 },
            back: FallbackReturn::Acknowledged,
        },
        alarms: AlarmConfig {
            hi_hi: Some(8.0),
            hi: Some(6.0),
            lo: Some(-6.0),
            lo_lo: Some(-8.0),
            deviation: Some(3.0),
            hysteresis: 0.5,
        },
        off_output: Some(0.0),
        initial_output: 0.125,
    };
    assert_eq!(series.config, expected);
    let model = EstimatorConfig { gain: 2.0, a1: 5.0, a2: 0.0, dead_time: 1.0, kfd: 0.5, tfd: 0.5 };
    assert_eq!(series.compensator, CompensatorSpec::Estimator(model));
}

#[test]
fn other_forms_and_defaults() {
    let [_, standard, observer] = &everything().controllers[..] else { panic!("three controllers") };
    let pid = PidConfig { kp: 2.0, ki: 0.0, kd: 1.0, tf: 0.5, ..PidConfig::default() };
    let expected = ControllerConfig {
        pid,
        anti_windup: AntiWindupConfig::None,
        fallback: FallbackConfig {
            action: FallbackAction::Substitute { output: 1.0 },
            ..FallbackConfig::default()
        },
        ..ControllerConfig::default()
    };
    let expected =
        ControllerSpec { name: "standard".to_owned(), config: expected, ..ControllerSpec::pid("", pid) };
    assert_eq!(*standard, expected);

    let pid = PidConfig { kp: -1.0, ki: -0.5, action: Action::Direct, ..PidConfig::default() };
    assert_eq!(observer.config.pid, pid);
    assert_eq!((observer.config.limits.rate_up, observer.config.limits.rate_down), (Some(1.0), Some(1.0)));
    let model = PlantModel::first_order(2.0, 5.0, 1.0);
    assert_eq!(
        observer.compensator,
        CompensatorSpec::Observer(ObserverConfig { model, alpha: 1.0, order: Some(2) })
    );
}

/// Bandwidths are turned into gains; an event changes those that it names.
#[test]
fn an_adrc_and_its_changes() {
    let text = include_str!("data/base.toml")
        .replace("pid = { kp = 0.8, ki = 0.7 }", "adrc = { b0 = 5.0, omega_c = 10.0, omega_o = 40.0 }")
        .replace("observer = { model", "# observer = { model")
        .replace("disturbance = 1.0", "controller = \"PI + DOB\"\nadrc = { kd = 16.0, omega_o = 30.0 }");
    let scenario = read(&text, Precision::F64).expect("no faults").scenario;
    let adrc = AdrcConfig { b0: 5.0, kp: 100.0, kd: 20.0, beta1: 120.0, beta2: 4800.0, beta3: 64_000.0 };
    let expected = ControllerSpec::adrc("PI + DOB", adrc);
    assert_eq!(scenario.controllers[1], expected);
    let Change::Parameters(list) = &scenario.events[1].changes[0] else { panic!("parameters") };
    let adrc = AdrcConfig { kd: 16.0, beta1: 90.0, beta2: 2700.0, beta3: 27_000.0, ..adrc };
    assert_eq!(*list, [(1, ControllerSpec { adrc: Some(adrc), ..expected })]);
}

#[test]
fn events_in_the_order_of_time_and_changes_in_the_order_written() {
    let events = everything().events;
    let times: Vec<f64> = events.iter().map(|event| event.at).collect();
    assert_eq!(times, [10.0, 10.0, 20.0, 20.0, 30.0, 40.0, 50.0]);
    let expected = vec![
        Change::Setpoint(Signal::Step(2.0)),
        Change::RemoteSetpoint(Signal::Step(3.0)),
        Change::Disturbance(Signal::Ramp { slope: 0.5, duration: 4.0 }),
        Change::Mode(Mode::Cascade),
        Change::Manual(0.5),
        Change::Track(0.75),
        Change::Offset(-0.25),
        Change::Compensator(false),
        Change::BadSamples(3),
        Change::LostSamples(2),
        Change::Acknowledge,
    ];
    assert_eq!(events[0], Event { at: 10.0, label: String::new(), changes: expected, controller: None });
    let disturbances: Vec<&Change> = events[1..4].iter().flat_map(|event| &event.changes).collect();
    let expected = [
        Change::Disturbance(Signal::Step(1.0)),
        Change::Disturbance(Signal::Pulse { height: 1.0, duration: 0.5 }),
        Change::Disturbance(Signal::Ramp { slope: -0.5, duration: f64::INFINITY }),
    ];
    assert_eq!(disturbances, expected.iter().collect::<Vec<_>>());
}

/// The parameters of an event build on what the controller had, earlier events included.
#[test]
fn parameters_are_merged_in_the_order_of_time() {
    let scenario = everything();
    let parameters = |event: &Event| match &event.changes[..] {
        [Change::Parameters(list)] => list.clone(),
        other => panic!("{other:?}"),
    };
    let mut series = scenario.controllers[0].clone();
    // k = 3 in the series form, ti and td as before.
    series.config.pid.kp = 3.75;
    series.config.pid.ki = 0.375;
    series.config.pid.kd = 6.0;
    series.config.pid.tf = 0.6;
    series.config.limits = LimitConfig { lo: -3.0, hi: 9.0, rate_up: None, rate_down: Some(2.0) };
    series.config.setpoint.rate_up = Some(2.0);
    series.config.setpoint.rate_down = Some(2.0);
    series.config.anti_windup = AntiWindupConfig::Conditional;
    series.config.deadband = 0.125;
    let CompensatorSpec::Estimator(model) = &mut series.compensator else { panic!("an estimator") };
    model.kfd = 0.25;
    assert_eq!(scenario.events[4].controller, Some(0));
    assert_eq!(parameters(&scenario.events[4]), [(0, series.clone())]);

    let CompensatorSpec::Estimator(model) = &mut series.compensator else { panic!("an estimator") };
    (model.tfd, model.dead_time) = (0.75, 2.0);
    assert_eq!(parameters(&scenario.events[5]), [(0, series)]);

    let mut observer = scenario.controllers[2].clone();
    observer.compensator = CompensatorSpec::Observer(ObserverConfig {
        model: PlantModel::first_order(3.0, 6.0, 0.0),
        alpha: 2.0,
        order: Some(2),
    });
    assert_eq!(parameters(&scenario.events[6]), [(2, observer)]);
}

#[test]
fn an_event_without_a_name_changes_all() {
    let text = include_str!("data/base.toml").replace("disturbance = 1.0", "limits = { hi = 5.0 }");
    let scenario = read(&text, Precision::F64).expect("no faults").scenario;
    let Change::Parameters(list) = &scenario.events[1].changes[0] else { panic!("parameters") };
    let limits: Vec<_> =
        list.iter().map(|(index, spec)| (*index, spec.config.limits.lo, spec.config.limits.hi)).collect();
    assert_eq!(limits, [(0, -10.0, 5.0), (1, -1e6, 5.0), (2, -1e6, 5.0)]);
}

/// All scenarios that come with the program, also in the folders below.
fn scenarios(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let mut all: Vec<_> =
        files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    all.extend(folders.iter().flat_map(|folder| scenarios(folder)));
    all.sort();
    all
}

#[test]
fn the_scenarios_have_no_faults_and_no_warnings() {
    let all = scenarios(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios"));
    assert!(all.len() >= 8, "{all:?}");
    for path in all {
        let text = std::fs::read_to_string(&path).expect("a text");
        for precision in [Precision::F32, Precision::F64] {
            let read = read_with("scenario", &text, precision, &FolderFiles::beside(&path));
            let read = read.unwrap_or_else(|faults| panic!("{path:?}: {faults:?}"));
            assert_eq!(read.warnings, [], "{path:?}");
        }
    }
}

#[test]
fn the_demo_is_that_of_the_chapter() {
    let demo = read(demo::SCENARIO, Precision::F64).expect("no faults").scenario;
    let names: Vec<&str> = demo.controllers.iter().map(|c| &*c.name).collect();
    assert_eq!(names, ["MOMI", "DRMO", "DE-MOMI"]);
    assert_eq!((demo.ts, demo.duration), (0.01, 20.0));
    assert_eq!(demo.controllers[0].config.pid, demo.controllers[2].config.pid);
    assert_eq!(demo.controllers[1].config.pid.ki, 3.830_789_08);
    let model = EstimatorConfig {
        gain: 1.0,
        a1: 1.2,
        a2: 0.2,
        dead_time: 0.2,
        kfd: 0.688_669_975,
        tfd: 0.059_969_426_55,
    };
    assert_eq!(demo.controllers[2].compensator, CompensatorSpec::Estimator(model));
}

/// The description names every status bit with its value, and every code.
#[test]
fn the_description_has_every_status_bit_and_code() {
    let format = include_str!("../src/scenario/format.md");
    for (bit, name) in Status::NAMES {
        let row = format!("| {} | {} | {name} |", bit.bits().trailing_zeros(), bit.bits());
        assert!(format.contains(&row), "`{row}` is missing");
    }
    for code in [
        code::SYNTAX,
        code::UNKNOWN_KEY,
        code::MISSING_KEY,
        code::WRONG_TYPE,
        code::OUT_OF_RANGE,
        code::UNKNOWN_CHOICE,
        code::DUPLICATE,
        code::CONFLICT,
        code::EXPRESSION,
        code::UNKNOWN_NAME,
        code::NOT_SUPPORTED,
        code::FILE,
        code::RECORDING,
        code::TOO_LARGE,
        code::FAST_FILTER,
        code::SIGN,
        code::CLAMPED,
        code::OUT_OF_MEASUREMENT,
        code::ALIASING,
        code::WIND_UP,
        code::NO_EFFECT,
    ] {
        assert!(format.contains(&format!("`{code}`")), "`{code}` is missing");
    }
}
