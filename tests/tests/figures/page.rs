//! A built-in scenario with its result.

use controller_sim_host::demo::{self, BuiltIn};
use controller_sim_host::scenario::{Case, Scenario, read_with};
use controller_sim_host::simulate::{Metrics, Precision, RunOptions, RunResult, Sample, run};

/// All cases of a built-in scenario, whose text may have been changed; there must be nothing to warn of.
pub(crate) fn cases(built_in: &BuiltIn, text: &str, precision: Precision) -> Vec<Case> {
    let name = built_in.name();
    let read = read_with(name, text, precision, &built_in.files());
    let read = read.unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
    assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
    read.cases
}

/// A scenario and what came out of it.
pub(crate) struct Page {
    pub(crate) scenario: Scenario,
    pub(crate) result: RunResult,
}

impl Page {
    /// The scenario of this name, run in double precision with every sample kept.
    pub(crate) fn new(name: &str) -> Self {
        Self::of(Self::scenario(name))
    }

    /// The scenario of this name, such as `windup` or `de-fig-06`.
    pub(crate) fn scenario(name: &str) -> Scenario {
        Self::edited(name, &[])
    }

    /// The scenario of this name after replacing text, each of which must be there.
    pub(crate) fn edited(name: &str, replace: &[(&str, &str)]) -> Scenario {
        let mut cases = Self::swept(name, replace);
        assert_eq!(cases.len(), 1, "{name} is a sweep");
        cases.remove(0)
    }

    /// The scenarios of a sweep, in order.
    pub(crate) fn swept(name: &str, replace: &[(&str, &str)]) -> Vec<Scenario> {
        let built_in =
            demo::all().find(|one| one.name() == name).unwrap_or_else(|| panic!("no scenario {name}"));
        let mut text = built_in.text.to_owned();
        for (from, to) in replace {
            assert!(text.contains(from), "{name}: {from} is not in the file");
            text = text.replace(from, to);
        }
        cases(&built_in, &text, Precision::F64).into_iter().map(|case| case.scenario).collect()
    }

    /// A scenario that was changed, run.
    pub(crate) fn of(scenario: Scenario) -> Self {
        Self::in_precision(scenario, Precision::F64)
    }

    /// A scenario run in this precision.
    pub(crate) fn in_precision(scenario: Scenario, precision: Precision) -> Self {
        let options = RunOptions { precision, trace: true, ..RunOptions::default() };
        let result = run(&scenario, options).expect("valid");
        Self { scenario, result }
    }

    fn index(&self, controller: &str) -> usize {
        let names: Vec<_> = self.result.controllers.iter().map(|c| c.name.as_str()).collect();
        names
            .iter()
            .position(|name| *name == controller)
            .unwrap_or_else(|| panic!("{controller} in {names:?}"))
    }

    /// The metrics of a controller after the event of this label.
    pub(crate) fn after(&self, label: &str, controller: &str) -> Metrics {
        let events = &self.scenario.events;
        let at = events.iter().find(|e| e.label == label).unwrap_or_else(|| panic!("no event {label}")).at;
        let stretches = &self.result.controllers[self.index(controller)].events;
        stretches.iter().rfind(|s| (s.at - at).abs() <= self.scenario.ts).expect("a stretch").metrics
    }

    /// The samples of a controller from `from` to before `to`.
    pub(crate) fn samples(&self, controller: &str, from: f64, to: f64) -> &[Sample] {
        let trace = &self.result.controllers[self.index(controller)].trace;
        let place = |t: f64| trace.partition_point(|s| s.t < t - 1e-9);
        &trace[place(from)..place(to)]
    }

    /// The last sample of a controller.
    pub(crate) fn last(&self, controller: &str) -> &Sample {
        self.result.controllers[self.index(controller)].trace.last().expect("samples")
    }

    /// The description has these figures, one after the other, and they are these values, rounded.
    pub(crate) fn says(&self, figures: &[(&str, f64)]) {
        let text = &self.scenario.description;
        for (figure, value) in figures {
            let stands_alone = |at: usize| {
                let digit = |c: char| c.is_ascii_digit();
                let before = text[..at].trim_end_matches('.').len();
                let behind = text[at + figure.len()..].trim_start_matches('.');
                !text[..before].ends_with(digit) && !behind.starts_with(digit)
            };
            assert!(
                text.match_indices(figure).any(|(at, _)| stands_alone(at)),
                "{}: {figure} ({value}) is not in the description",
                self.scenario.title
            );
            let decimals = figure.split_once('.').map_or(0, |(_, behind)| behind.len());
            let half_unit = 0.5 * 0.1_f64.powi(i32::try_from(decimals).expect("few"));
            let printed: f64 = figure.parse().expect("a number");
            assert!(
                (printed - value).abs() <= half_unit * 1.000_001,
                "{}: the description says {figure}, the run {value}",
                self.scenario.title
            );
        }
    }
}

/// The same scenario without noise.
pub(crate) fn quiet(mut scenario: Scenario) -> Scenario {
    scenario.noise = None;
    scenario
}

/// The text is there: a sentence that a test stands for.
pub(crate) fn mentions(scenario: &Scenario, words: &str) {
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat(&scenario.description).contains(&flat(words)), "{}: {words}", scenario.title);
}

/// `ours` is `expected` within `tolerance`, relative.
pub(crate) fn near(what: &str, ours: f64, expected: f64, tolerance: f64) {
    let error = (ours / expected - 1.0).abs();
    assert!(error <= tolerance, "{what}: {ours} against {expected} ({error:.2e} > {tolerance:.2e})");
}
