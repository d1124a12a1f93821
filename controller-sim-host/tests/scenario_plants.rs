//! Plants in all their forms, and what lies around them.

use controller_core::plant_model::PlantModel;
use controller_design::model::{TransferFunction, parse};
use controller_sim_host::scenario::{Actuator, CompensatorSpec, Scenario, Sensor, read};
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
    let actuator =
        Actuator { lo: 0.0, hi: 100.0, rate: 5.0, resolution: 0.5, deadband: 0.25, read_back: true };
    assert_eq!(s.actuator, actuator);
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
