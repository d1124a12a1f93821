//! Plants in all their forms, and what lies around them.

use controller_core::Mode;
use controller_core::plant_model::PlantModel;
use controller_design::model::{TransferFunction, parse};
use controller_sim_host::plant::{Heater, Nonlinear, TankLoad, TwoTank};
use controller_sim_host::scenario::{Actuator, CompensatorSpec, Scenario, Sensor, Stiction, code, read};
use controller_sim_host::simulate::Precision;

fn scenario(middle: &str) -> Scenario {
    let text = format!(
        "version = 1\nts = 0.1\nduration = 10\n{middle}\n[[controller]]\nname = \"PI\"\npid = {{ kp = 0.1, ki = 0.1 }}\n"
    );
    read(&text, Precision::F64).unwrap_or_else(|faults| panic!("{middle}: {faults:?}")).scenario
}

fn plant(keys: &str) -> TransferFunction {
    scenario(&format!("[plant]\n{keys}")).plant
}

/// A written form and the expression it stands for.
#[test]
fn every_form_is_an_expression() {
    for (keys, expression) in [
        ("tf = \"2*exp(-s)/(1+10*s)\"", "2*exp(-s)/(1+10*s)"),
        // Descending powers: (2 s + 4)/(s^2 + 3 s + 2).
        ("num = [2, 4]\nden = [1, 3, 2]", "(4+2*s)/(2+3*s+s^2)"),
        ("num = [1.5]\nden = [0, 2.0, 0.0]\ndead_time = 0.25", "1.5*exp(-0.25*s)/(2*s)"),
        ("fopdt = { gain = -1.98, tau = 80.3, dead_time = 3.2 }", "-1.98*exp(-3.2*s)/(1+80.3*s)"),
        ("fopdt = { gain = 0.1, tau = 1e-3 }", "0.1/(1+0.001*s)"),
        ("sopdt = { gain = 3, tau1 = 2, tau2 = 0.5, dead_time = 1 }", "3*exp(-s)/((1+2*s)*(1+0.5*s))"),
        ("sopdt = { gain = 3, tau1 = 2, tau2 = 2, beta = -0.3 }", "3*(1-0.3*s)/(1+2*s)^2"),
        ("sopdt = { gain = 2, omega = 2, zeta = 0.25 }", "2/(1+0.25*s+0.25*s^2)"),
        ("ipdt = { gain = 0.5, dead_time = 2 }", "0.5*exp(-2*s)/s"),
        ("ipdt = { gain = -0.5, tau = 3 }", "-0.5/(s*(1+3*s))"),
    ] {
        assert_eq!(Ok(plant(keys)), parse(expression), "{keys}");
    }
}

#[test]
fn a_plant_of_two_parts_is_their_product() {
    for (keys, inner) in [
        ("tf = \"exp(-2*s)/(1+10*s)\"\ninner = \"3*exp(-0.5*s)/(1+s)^2\"", "3*exp(-0.5*s)/(1+s)^2"),
        (
            "fopdt = { gain = 1, tau = 10, dead_time = 2 }\ninner = { sopdt = { gain = 3, tau1 = 1, tau2 = 1, dead_time = 0.5 } }",
            "3*exp(-0.5*s)/(1+s)^2",
        ),
        (
            "num = [1]\nden = [10, 1]\ndead_time = 2\n[plant.inner]\nnum = [3]\nden = [1, 2, 1]\ndead_time = 0.5",
            "3*exp(-0.5*s)/(1+2*s+s^2)",
        ),
    ] {
        let scenario = scenario(&format!("[plant]\n{keys}"));
        assert_eq!(scenario.inner_plant, parse(inner).ok(), "{keys}");
        assert_eq!(Ok(scenario.plant), parse(&format!("({inner})*exp(-2*s)/(1+10*s)")), "{keys}");
    }
}

#[test]
fn a_model_of_an_observer_takes_the_same_forms() {
    for model in [
        "\"2*exp(-1*s)/(1+5*s)\"",
        "{ tf = \"2*exp(-1*s)/(1+5*s)\" }",
        "{ fopdt = { gain = 2, tau = 5, dead_time = 1 } }",
        "{ num = [2], den = [5, 1], dead_time = 1 }",
    ] {
        let scenario = scenario(&format!(
            "[plant]\ntf = \"1/(1+s)\"\n[[controller]]\nname = \"DOB\"\npid = {{ kp = 1, ki = 1 }}\nobserver = {{ alpha = 1, model = {model} }}"
        ));
        let CompensatorSpec::Observer(config) = &scenario.controllers[0].compensator else {
            panic!("an observer")
        };
        assert_eq!(config.model, PlantModel::first_order(2.0, 5.0, 1.0), "{model}");
    }
}

#[test]
fn sensor_and_actuator() {
    let s = scenario("plant.tf = \"1/(1+s)\"");
    assert_eq!((s.sensor, s.actuator), (Sensor::default(), Actuator::default()));
    let s = scenario(
        "plant.tf = \"1/(1+s)\"\nsensor = { lo = -1, hi = 150.5, resolution = 0.3 }\n[actuator]\nlo = 0\nhi = 100\n\
         rate = 5\nresolution = 0.5\ndeadband = 0.25\nread_back = true",
    );
    assert_eq!(s.sensor, Sensor { lo: -1.0, hi: 150.5, resolution: 0.3 });
    let actuator = Actuator {
        lo: 0.0,
        hi: 100.0,
        rate: 5.0,
        resolution: 0.5,
        deadband: 0.25,
        stiction: None,
        read_back: true,
    };
    assert_eq!(s.actuator, actuator);
}

#[test]
fn a_valve_that_sticks() {
    let stiction = |keys: &str| {
        scenario(&format!("plant.tf = \"1/(1+s)\"\nactuator.stiction = {keys}")).actuator.stiction
    };
    assert_eq!(stiction("{ band = 5, jump = 2.5 }"), Some(Stiction { band: 5.0, jump: 2.5 }));
    assert_eq!(stiction("{ band = 0.5 }"), Some(Stiction { band: 0.5, jump: 0.0 }));
}

#[test]
fn plants_that_are_not_linear() {
    let s = scenario("initial.setpoint = 25.0\nplant.two_tank = {}");
    assert_eq!(s.nonlinear, Some(Nonlinear::TwoTank(TwoTank::default())));
    let s = scenario(
        "initial.setpoint = 9.0\n[plant.two_tank]\narea = 1\nheight = 10.0\ndrop = 3\ndrain = 4\nvalve = 55\nsupply = 6\n\
         pump = 7\npump_start = 0.5\nfeed_area = 8\nfeed_level = 9\ndead_time = 0.25\ndisturbance = \"input\"",
    );
    let tank = TwoTank {
        area: 1.0,
        height: 10.0,
        drop: 3.0,
        drain: 4.0,
        valve: 55.0,
        supply: 6.0,
        pump: 7.0,
        pump_start: 0.5,
        feed_area: 8.0,
        feed_level: 9.0,
        dead_time: 0.25,
        load: TankLoad::Input,
    };
    assert_eq!(s.nonlinear, Some(Nonlinear::TwoTank(tank)));
    let heater = |keys: &str| {
        scenario(&format!("plant.heater = {{ gain = 2, tau_heat = 3, tau_cool = 4{keys} }}")).nonlinear
    };
    let plain = Heater {
        gain: 2.0,
        gain_cool: 2.0,
        tau_heat: 3.0,
        tau_cool: 4.0,
        ambient: 0.0,
        sensor_lag: 0.0,
        dead_time: 0.0,
    };
    assert_eq!(heater(""), Some(Nonlinear::Heater(plain)));
    let full = Heater { gain_cool: 0.0, ambient: -5.0, sensor_lag: 0.5, dead_time: 0.75, ..plain };
    let keys = ", gain_cool = 0, ambient = -5, sensor_lag = 0.5, dead_time = 0.75";
    assert_eq!(heater(keys), Some(Nonlinear::Heater(full)));
}

#[test]
fn texts_for_people() {
    let s = scenario(
        "title = \" A tank \"\ndescription = \"\"\"\nFirst.\r\nStill first.\n\nSecond.\n\"\"\"\nunits = { y = \"°C\", u = \"%\" }\n\
         plant.tf = \"1/(1+s)\"\n[[event]]\nat = 1\nlabel = \"lid off\"\nsetpoint = 1",
    );
    assert_eq!((&*s.title, &*s.description), ("A tank", "First.\nStill first.\n\nSecond."));
    assert_eq!((&*s.units.y, &*s.units.u, &*s.events[0].label), ("°C", "%", "lid off"));
}

const CASCADE: &str = r#"version = 1
ts = 0.1
duration = 10
initial = { setpoint = 4 }
[plant]
tf = "exp(-s)/(1+10*s)"
inner = "-2/(1+s)"
[[controller]]
name = "cascade"
pid = { kp = 2, ki = 0.2 }
limits = { lo = -1, hi = 10 }
[controller.secondary]
pid = { kp = -1, ki = -0.5 }
limits = { lo = -5, hi = 5, rate = 3 }
estimator = { gain = -2, a1 = 1, kfd = 0.5, tfd = 0.2 }
"#;

#[test]
fn a_cascade() {
    let read = read(CASCADE, Precision::F64).unwrap_or_else(|faults| panic!("{faults:?}"));
    assert_eq!(read.warnings, []);
    let primary = &read.scenario.controllers[0];
    assert_eq!((primary.mode, primary.config.limits.lo), (Mode::Auto, -1.0));
    let secondary = primary.secondary.as_ref().expect("the loop inside");
    assert_eq!((&*secondary.name, secondary.mode), ("cascade (secondary)", Mode::Cascade));
    assert_eq!((secondary.config.pid.kp, secondary.config.limits.rate_up), (-1.0, Some(3.0)));
    assert!(matches!(secondary.compensator, CompensatorSpec::Estimator(_)));
    assert_eq!(secondary.secondary, None);
}

#[test]
fn what_is_wrong_in_a_cascade() {
    for (old, new, line, code, message) in [
        (
            "inner = \"-2/(1+s)\"",
            "",
            12,
            code::CONFLICT,
            "a secondary controller needs the part of the plant",
        ),
        ("-2/(1+s)", "-2*s/(1+s)", 7, code::CONFLICT, "`plant.inner` has a zero at s = 0"),
        (
            "gain = -2",
            "gain = 2",
            15,
            code::CONFLICT,
            "the model's gain is 2, but the controller's `ki` acts as -0.5",
        ),
        (
            "lo = -5",
            "lo = 50",
            14,
            code::CONFLICT,
            "`secondary.limits.lo = 50` must be below `secondary.limits.hi = 5`",
        ),
        ("kp = -1,", "Kp = -1,", 13, code::UNKNOWN_KEY, "unknown key `Kp` in `secondary.pid`"),
        ("estimator =", "name = \"x\"\nestimator =", 15, code::CONFLICT, "is called after its primary one"),
        ("estimator =", "mode = \"auto\"\nestimator =", 15, code::CONFLICT, "always in mode cascade"),
        ("estimator =", "secondary = {}\nestimator =", 15, code::CONFLICT, "a cascade has two controllers"),
        (
            "[controller.sec",
            "observer = { model = \"1/(1+s)\", alpha = 1 }\n[controller.sec",
            12,
            code::CONFLICT,
            "a primary controller has no `observer`",
        ),
    ] {
        assert!(CASCADE.contains(old));
        let text = CASCADE.replacen(old, new, 1);
        let faults = read(&text, Precision::F64).expect_err(new);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!((faults[0].place(&text).line, faults[0].code), (line, code), "{faults:?}");
        assert!(faults[0].message.contains(message), "{faults:?}");
    }
}

/// Each loop is judged by what it drives: the secondary by the inner part, the primary by the outer one.
#[test]
fn what_is_odd_in_a_cascade() {
    for (old, new, line, code, message) in [
        ("kp = -1, ki = -0.5", "kp = 1, ki = 0.5, action = \"direct\"", 0, "", ""),
        ("pid = { kp = 2, ki = 0.2 }", "pid = { kp = -2, ki = -0.2 }", 10, code::SIGN, "(-0.2 and 1)"),
        // 4 at the end, 4 between the parts, -2 at the actuator.
        (
            "lo = -1, hi = 10",
            "lo = -1, hi = 3",
            11,
            code::CLAMPED,
            "the output 4 that holds the initial state",
        ),
        ("lo = -5, hi", "lo = -1, hi", 14, code::CLAMPED, "the output -2 that holds the initial state"),
    ] {
        assert!(CASCADE.contains(old));
        let text = CASCADE.replacen(old, new, 1);
        let warnings =
            read(&text, Precision::F64).unwrap_or_else(|faults| panic!("{new}: {faults:?}")).warnings;
        let said: Vec<_> = warnings.iter().map(|w| (w.place(&text).line, w.code)).collect();
        assert_eq!(said, if line == 0 { vec![] } else { vec![(line, code)] }, "{warnings:?}");
        assert!(warnings.iter().all(|w| w.message.contains(message)), "{warnings:?}");
    }
}
