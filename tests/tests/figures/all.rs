//! What holds for every built-in scenario.

use super::page::{Page, folder};
use controller_sim_host::scenario::read;
use controller_sim_host::simulate::Precision;

/// Runs whose remarks are what the page is about: scenario, controller.
const INTENDED: [(&str, &str); 21] = [
    ("sensor", "hold, go on"),
    ("sensor", "safe output, wait"),
    ("latency", "not told, alpha = 0.7"),
    ("single-precision", "as if it stalled"),
    ("level", "tight"),
    ("level", "averaging"),
    ("actuator", "PI"),
    ("actuator", "PI, dead band"),
    ("sine-disturbance", "PI"),
    ("sine-disturbance", "alpha = 10"),
    ("sine-disturbance", "alpha = 2"),
    ("random-walk", "PI"),
    ("random-walk", "alpha = 100"),
    ("random-walk", "alpha = 10"),
    ("random-walk", "alpha = 1"),
    ("figures/dob-fig-04-05-plant-1-ms-1.2", "PI"),
    ("figures/dob-fig-04-05-plant-1-ms-2.0", "PI"),
    ("figures/dob-fig-04-05-plant-2-ms-1.2", "PI"),
    ("figures/dob-fig-04-05-plant-2-ms-2.0", "PI"),
    ("figures/dob-fig-04-05-plant-3-ms-1.2", "PI"),
    ("figures/dob-fig-04-05-plant-3-ms-2.0", "PI"),
];

/// The names of all scenarios, in order.
fn names() -> Vec<String> {
    let mut names = Vec::new();
    for (sub, prefix) in [("", ""), ("figures", "figures/")] {
        for entry in std::fs::read_dir(folder().join(sub)).expect("the folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|e| e == "toml") {
                names.push(format!("{prefix}{}", path.file_stem().expect("a name").to_string_lossy()));
            }
        }
    }
    names.sort();
    names
}

#[test]
fn every_scenario_explains_itself_and_runs_in_both_precisions() {
    let names = names();
    assert!(names.len() >= 27, "{names:?}");
    for name in &names {
        let text = std::fs::read_to_string(folder().join(format!("{name}.toml"))).expect("text");
        for precision in [Precision::F64, Precision::F32] {
            let read = read(&text, precision).unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
            assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
            let scenario = read.scenario;
            assert!(!scenario.title.is_empty() && !scenario.description.is_empty(), "{name}");
            let described = scenario.events.iter().all(|e| !e.label.is_empty());
            assert!(described || ["demo", "first"].contains(&name.as_str()), "{name}: an event has no label");
            let page = Page::in_precision(scenario, precision);
            for controller in &page.result.controllers {
                let intended = INTENDED.contains(&(name.as_str(), controller.name.as_str()));
                assert_eq!(
                    !controller.remarks.is_empty(),
                    intended,
                    "{name}, {}: {:?}",
                    controller.name,
                    controller.remarks
                );
                let m = controller.total;
                assert!(
                    [m.iae, m.ise, m.itae, m.ie, m.e_max, m.tv].iter().all(|v| v.is_finite()),
                    "{name}, {}: {m:?}",
                    controller.name
                );
                assert!(m.iae > 0.0, "{name}, {}: nothing happens", controller.name);
            }
        }
    }
}
