//! What holds for every built-in scenario.

use super::page::{Page, cases};
use controller_sim_host::demo;
use controller_sim_host::simulate::Precision;

/// Runs whose remarks are what the page is about: scenario, controller.
const INTENDED: [(&str, &str); 19] = [
    ("recorded-load", "PI"),
    ("sensor", "hold, go on"),
    ("sensor", "safe output, wait"),
    ("latency", "not told, alpha = 0.7"),
    ("single-precision", "as if it stalled"),
    ("level", "tight"),
    ("level", "averaging"),
    ("actuator", "PI"),
    ("actuator", "PI, dead band"),
    ("sticky-valve", "PI, slower"),
    ("sticky-valve", "PI, dead band"),
    ("random-walk", "alpha = 10"),
    ("random-walk", "alpha = 1"),
    ("dob-fig-04-05-plant-1-ms-1.2", "PI"),
    ("dob-fig-04-05-plant-1-ms-2.0", "PI"),
    ("dob-fig-04-05-plant-2-ms-1.2", "PI"),
    ("dob-fig-04-05-plant-2-ms-2.0", "PI"),
    ("dob-fig-04-05-plant-3-ms-1.2", "PI"),
    ("dob-fig-04-05-plant-3-ms-2.0", "PI"),
];

#[test]
fn every_scenario_explains_itself_and_runs_in_both_precisions() {
    // At least eight teaching scenarios, and the figures of the papers.
    let figures = demo::all().filter(|one| one.path.starts_with("figures/")).count();
    assert_eq!(
        figures,
        6 + 6 + 3,
        "six of the chapter; two of the paper in one for each of six loops; its rig"
    );
    assert!(demo::all().count() >= figures + 8);
    for built_in in demo::all() {
        let name = built_in.name();
        for precision in [Precision::F64, Precision::F32] {
            for case in cases(&built_in, built_in.text, precision) {
                let scenario = case.scenario;
                assert!(!scenario.title.is_empty() && !scenario.description.is_empty(), "{name}");
                let labelled = scenario.events.iter().all(|e| !e.label.is_empty());
                assert!(labelled || ["demo", "first"].contains(&name), "{name}: an event has no label");
                check(name, &Page::in_precision(scenario, precision));
            }
        }
    }
}

/// Every controller does something, its figures are numbers, and only those that are meant to have remarks have some.
fn check(name: &str, page: &Page) {
    for controller in &page.result.controllers {
        let intended = INTENDED.contains(&(name, controller.name.as_str()));
        let remarks = &controller.remarks;
        assert_eq!(!remarks.is_empty(), intended, "{name}, {}: {remarks:?}", controller.name);
        let m = controller.total;
        let finite = [m.iae, m.ise, m.itae, m.ie, m.e_max, m.tv].iter().all(|v| v.is_finite());
        assert!(finite, "{name}, {}: {m:?}", controller.name);
        assert!(m.iae > 0.0, "{name}, {}: nothing happens", controller.name);
    }
}
