//! Runs for pages and pictures. Not every test uses all of it.
#![allow(dead_code)]

use controller_sim_host::report::{Chapter, figure, page};
use controller_sim_host::scenario::{Scenario, read};
use controller_sim_host::simulate::{Precision, RunOptions, RunResult, View, run};
use std::fs;
use std::path::Path;

/// A scenario with its run.
pub(crate) struct Ran {
    pub(crate) name: String,
    pub(crate) case: Option<String>,
    pub(crate) text: String,
    pub(crate) scenario: Scenario,
    pub(crate) result: RunResult,
}

impl Ran {
    pub(crate) fn chapter(&self) -> Chapter<'_> {
        Chapter {
            name: &self.name,
            case: self.case.as_deref(),
            text: &self.text,
            scenario: &self.scenario,
            precision: Precision::F64,
            result: &self.result,
            warnings: &[],
        }
    }
}

/// Runs a text after a change to what was read.
pub(crate) fn ran(name: &str, text: &str, change: impl Fn(&mut Scenario)) -> Ran {
    ran_in(name, text, change, |scenario| View::whole(scenario.duration))
}

pub(crate) fn ran_in(
    name: &str,
    text: &str,
    change: impl Fn(&mut Scenario),
    view: impl Fn(&Scenario) -> View,
) -> Ran {
    let mut scenario = read(text, Precision::F64).expect("valid").scenario;
    change(&mut scenario);
    let options = RunOptions { record: Some(view(&scenario)), ..RunOptions::default() };
    let result = run(&scenario, options).expect("runs");
    Ran { name: name.to_owned(), case: None, text: text.to_owned(), scenario, result }
}

/// Writes a page, and the picture of its first chapter, to where a person can look at them.
pub(crate) fn write(name: &str, runs: &[Ran]) {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let chapters: Vec<Chapter<'_>> = runs.iter().map(Ran::chapter).collect();
    let html = page(&chapters, &format!("controller-sim run {name} --report {name}.html"));
    fs::write(out.join(format!("{name}.html")), html).expect("writable");
    fs::write(out.join(format!("{name}.svg")), figure(&chapters[0])).expect("writable");
}
