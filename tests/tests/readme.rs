//! What the README shows is true: its scenario runs, and the excerpt of the demo's table is what the demo prints.

use controller_sim_host::output::run_table;
use controller_sim_host::report::Chapter;
use controller_sim_host::scenario::read;
use controller_sim_host::simulate::{Precision, RunOptions, run};

const README: &str = include_str!("../../README.md");

/// The first code block of this language behind `heading`.
fn block(heading: &str, language: &str) -> String {
    let behind = README.split_once(heading).unwrap_or_else(|| panic!("no heading {heading}")).1;
    let opening = format!("```{language}\n");
    let inside = behind.split_once(&opening).unwrap_or_else(|| panic!("no {language} block")).1;
    inside.split_once("```").expect("the block ends").0.to_owned()
}

#[test]
fn the_first_scenario_runs_and_the_observer_helps() {
    let text = block("## A first scenario", "toml");
    assert_eq!(text, include_str!("../../controller-sim-host/scenarios/first.toml"));
    let read = read(&text, Precision::F64).unwrap_or_else(|faults| panic!("{faults:?}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let result = run(&read.scenario, RunOptions::default()).expect("valid");
    let load = |i: usize| result.controllers[i].events[1].metrics;
    assert!(load(1).iae < 0.55 * load(0).iae, "{:?} {:?}", load(0), load(1));
    assert!(
        (result.controllers[1].events[0].metrics.iae / result.controllers[0].events[0].metrics.iae - 1.0)
            .abs()
            < 1e-6
    );
}

#[test]
fn the_excerpt_of_the_demo_is_what_the_demo_prints() {
    let shown = block("## The two commands", "text");
    let read = read(controller_sim_host::demo::SCENARIO, Precision::F64).expect("the demo is valid");
    let result = run(&read.scenario, RunOptions::default()).expect("valid");
    let printed = run_table(&Chapter {
        name: "demo",
        case: None,
        text: controller_sim_host::demo::SCENARIO,
        scenario: &read.scenario,
        precision: Precision::F64,
        result: &result,
        warnings: &read.warnings,
    });
    for line in shown.lines() {
        assert!(printed.lines().any(|l| l.trim_end() == line.trim_end()), "not printed: {line}\n{printed}");
    }
}
