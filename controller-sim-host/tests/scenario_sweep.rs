//! Sweeps: several cases of one text.

use controller_sim_host::scenario::{
    Case, Fault, Files, NoFiles, ReadAll, Scenario, code, override_key, read, read_with,
};
use controller_sim_host::simulate::Precision;

const TEXT: &str = r#"version = 1
ts = 0.1
duration = 10
[plant]
tf = "exp(-0.5*s)/(1+s)"
[[event]]
at = 0
setpoint = 1.0
[[controller]]
name = "PI + D"
pid = { kp = 1.0, ki = 0.5, kd = 0.1, tf = 0.2 }
limits = { lo = -10, hi = 10 }
[[controller]]
name = "DOB"
pid = { kp = 0.5, ki = 0.5 }
observer = { alpha = 0.5, model = "exp(-0.5*s)/(1+s)" }
"#;

fn swept(sweep: &str) -> String {
    format!("{TEXT}[sweep]\n{sweep}\n")
}

fn all(text: &str, files: &dyn Files) -> Result<ReadAll, Vec<Fault>> {
    read_with("s.toml", text, Precision::F64, files)
}

fn cases(sweep: &str) -> Vec<Case> {
    let all = all(&swept(sweep), &NoFiles).unwrap_or_else(|faults| panic!("{sweep}: {faults:?}"));
    assert_eq!(all.warnings, [], "{sweep}");
    all.cases
}

/// The place in the sweep's text, the code, the message and the help.
fn faults(text: &str, files: &dyn Files) -> Vec<(usize, usize, &'static str, String)> {
    let shown = |fault: Fault| {
        let place = fault.place(text);
        (
            place.line,
            place.column,
            fault.code,
            format!("{} | {}", fault.message, fault.help.unwrap_or_default()),
        )
    };
    all(text, files).expect_err(text).into_iter().map(shown).collect()
}

fn labels(cases: &[Case]) -> Vec<&str> {
    cases.iter().map(|case| case.label.as_deref().unwrap_or("")).collect()
}

/// Each case is the scenario with the value written in place of the old one.
#[test]
fn a_case_is_the_scenario_with_that_value() {
    for (key, values) in [
        ("ts", vec!["0.1", "0.05"]),
        ("latency", vec!["0", "0.05", "1e-1"]),
        ("plant.tf", vec!["\"1/(1+s)\"", "'2/(1+2*s)'"]),
        ("event.1.setpoint", vec!["2", "{ ramp = 1, duration = 2 }", "{ step = 3 }"]),
        ("controller.'PI + D'.pid.kp", vec!["1.5", "2.5"]),
        (
            "controller.DOB.observer",
            vec!["{ alpha = 1, model = \"1/(1+s)\" }", "{ alpha = 2, model = \"1/(1+s)\" }"],
        ),
        ("controller.2.observer.model", vec!["\"1/(1+s)\"", "{ fopdt = { gain = 1, tau = 2 } }"]),
        ("noise.std", vec!["0", "0.5"]),
        ("actuator", vec!["{ rate = 3 }", "{ lo = -2, read_back = true }"]),
    ] {
        let found = cases(&format!("key = \"{key}\"\nvalues = [{}]", values.join(", ")));
        let expected: Vec<Scenario> = values
            .iter()
            .map(|value| {
                let text = override_key(TEXT, key, value).unwrap_or_else(|fault| panic!("{key}: {fault:?}"));
                read(&text, Precision::F64).unwrap_or_else(|faults| panic!("{key}: {faults:?}")).scenario
            })
            .collect();
        let scenarios: Vec<Scenario> = found.iter().map(|case| case.scenario.clone()).collect();
        assert_eq!(scenarios, expected, "{key}");
        assert!(expected[0] != expected[1], "{key}");
        let expected: Vec<String> = values.iter().map(|value| format!("{key} = {value}")).collect();
        assert_eq!(labels(&found), expected);
    }
}

#[test]
fn values_between_two_ends() {
    let found = cases("key = \"latency\"\nfrom = 0\nto = 0.3\ncount = 4");
    assert_eq!(labels(&found), ["latency = 0", "latency = 0.1", "latency = 0.2", "latency = 0.3"]);
    let latencies: Vec<f64> = found.iter().map(|case| case.scenario.latency).collect();
    assert_eq!(latencies, [0.0, 0.1, 0.2, 0.3]);
    let found = cases("key = \"noise.std\"\nfrom = 1e-3\nto = 10\ncount = 5\nscale = \"log\"");
    assert_eq!(labels(&found)[1..4], ["noise.std = 0.01", "noise.std = 0.1", "noise.std = 1"]);
    let found = cases("key = \"substeps\"\nfrom = 10\nto = 1\ncount = 10\nscale = \"linear\"");
    assert_eq!(found[9].scenario.substeps, 1);
}

#[test]
fn what_one_value_causes_is_told_at_that_value() {
    let end = TEXT.lines().count();
    // In what was put in.
    let found = faults(&swept("key = \"latency\"\nvalues = [0, -1, 2, \"x\"]"), &NoFiles);
    let said: Vec<_> = found.iter().map(|(line, column, code, _)| (*line - end, *column, *code)).collect();
    assert_eq!(said, [(3, 14, code::OUT_OF_RANGE), (3, 21, code::WRONG_TYPE)]);
    assert!(found[0].3.starts_with("`latency = -1` is out of range; allowed: 0 to 1e12 s"), "{found:?}");
    // Elsewhere, and only with that value.
    let text = swept("key = \"ts\"\nvalues = [0.1, 0.5]");
    let found = all(&text, &NoFiles).expect_err("the filter is too short");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].message, "with `ts = 0.5`: `pid.tf = 0.2` is out of range; allowed: 0.25 to 1e12 s");
    assert_eq!((found[0].place(&text).line - end, found[0].place(&text).column), (3, 16));
    let related = found[0].related.as_ref().expect("where it is");
    assert_eq!(text.get(related.span.clone()), Some("0.2"));
    // With a value that is not written.
    let found = faults(&swept("key = \"latency\"\nfrom = -1\nto = 1\ncount = 5"), &NoFiles);
    let said: Vec<_> =
        found.iter().map(|(line, column, _, message)| (line - end, *column, &**message)).collect();
    assert_eq!(said[0].0, 3);
    assert_eq!((said[1].0, said[1].1), (5, 9));
    assert!(said[1].2.starts_with("with `latency = -0.5`: `latency = -0.5` is out of range"), "{said:?}");
}

#[test]
fn what_all_values_have_in_common_is_told_once() {
    let text = swept("key = \"controller.DOB.pid.kp\"\nvalues = [1, 2, 3]").replace("lo = -10", "lo = 20");
    let found = faults(&text, &NoFiles);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, found[0].1, found[0].2), (12, 17, code::CONFLICT));
    // A place behind a value that is longer than the old one.
    let text =
        swept("key = \"plant.tf\"\nvalues = [\"1/(1+s)\", \"1/(1+s)^3\"]").replace("hi = 10", "Hi = 10");
    let found = faults(&text, &NoFiles);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, found[0].1, found[0].2), (12, 22, code::UNKNOWN_KEY));
    // A key that nobody knows, with every value.
    let found = faults(&swept("key = \"plant.gain\"\nvalues = [1, 2]"), &NoFiles);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].1 == 7 && found[0].3.starts_with("unknown key `gain` in `plant`"), "{found:?}");
    // Syntax is that of the whole text.
    let found = faults(&swept("key = \"ts\"\nvalues = [1, 2]").replace("ts = 0.1", "ts = 0,1"), &NoFiles);
    assert_eq!((found.len(), found[0].2), (1, code::SYNTAX));
}

#[test]
fn the_sweep_itself() {
    let long = format!("key = \"ts\"\nvalues = [{}]", "1, ".repeat(1001));
    #[rustfmt::skip]
    let cases: &[(&str, &str, &str)] = &[
        ("values = [1, 2]", code::MISSING_KEY, "`sweep.key` is missing"),
        ("key = \"ts\"", code::MISSING_KEY, "`sweep.values` is missing"),
        ("key = \"ts\"\nvalue = [1, 2]", code::UNKNOWN_KEY, "did you mean `values`?"),
        ("key = 1\nvalues = [1, 2]", code::WRONG_TYPE, "`sweep.key` is a number; a text"),
        ("key = \"ts\"\nvalues = 1", code::WRONG_TYPE, "`sweep.values` is a number; a list is needed"),
        ("key = \"ts\"\nvalues = [1]", code::OUT_OF_RANGE, "`sweep.values` has 1 values; allowed: 2 to 1000"),
        (&long, code::OUT_OF_RANGE, "`sweep.values` has 1001 values"),
        ("key = \"ts\"\nvalues = [0.1, 0.2, 0.1]", code::DUPLICATE, "the value `0.1` is there twice"),
        ("key = \"ts\"\nvalues = [0.1, 0.2]\ncount = 3", code::CONFLICT, "either `values`, or `from`"),
        ("key = \"ts\"\nfrom = 0.1\ncount = 3", code::MISSING_KEY, "`sweep.to` is missing"),
        ("key = \"ts\"\nfrom = 0.1\nto = 0.1\ncount = 3", code::CONFLICT, "`sweep.to = 0.1` is `from`"),
        ("key = \"ts\"\nfrom = 0.1\nto = 0.2\ncount = 1", code::OUT_OF_RANGE, "`sweep.count = 1` is out of range; allowed: 2 to 1000"),
        ("key = \"latency\"\nfrom = 0\nto = 0.2\ncount = 3\nscale = \"log\"", code::OUT_OF_RANGE, "above 0 for `scale = \"log\"`"),
        ("key = \"latency\"\nfrom = 0\nto = 0.2\ncount = 3\nscale = \"lin\"", code::UNKNOWN_CHOICE, "did you mean \"linear\"?"),
        ("key = \"sweep.count\"\nvalues = [1, 2]", code::CONFLICT, "`sweep` cannot be swept"),
        ("key = \"version\"\nvalues = [1, 2]", code::CONFLICT, "`version` cannot be swept"),
        ("key = \"a..b\"\nvalues = [1, 2]", code::UNKNOWN_KEY, "a part of it is empty"),
        ("key = \"plant\"\nvalues = [1, 2]", code::WRONG_TYPE, "`plant` is a table"),
        ("key = \"controller.DOP.pid.kp\"\nvalues = [1, 2]", code::UNKNOWN_NAME, "did you mean \"DOB\"?"),
        ("key = \"ts.x\"\nvalues = [1, 2]", code::UNKNOWN_KEY, "`ts` has no keys"),
    ];
    for (sweep, code, part) in cases {
        let found = faults(&swept(sweep), &NoFiles);
        assert_eq!(found.len(), 1, "{sweep}: {found:?}");
        assert_eq!(found[0].2, *code, "{found:?}");
        assert!(found[0].3.contains(part), "`{part}` is not in {found:?}");
        assert!(found[0].0 > TEXT.lines().count(), "{found:?}");
    }
    // With everything else that is wrong.
    let found = faults(&swept("key = \"ts\"").replace("lo = -10", "lo = 20"), &NoFiles);
    assert_eq!(found.iter().map(|fault| fault.2).collect::<Vec<_>>(), [code::CONFLICT, code::MISSING_KEY]);
    let single = read(&swept("key = \"ts\"\nvalues = [1, 2]"), Precision::F64).expect_err("several cases");
    assert_eq!(single[0].code, code::NOT_SUPPORTED);
}

#[test]
fn warnings_name_the_value_that_brings_them() {
    let text = swept("key = \"controller.1.limits.lo\"\nvalues = [-10, 0.5]");
    let read = all(&text, &NoFiles).expect("no faults");
    assert_eq!(read.cases.len(), 2);
    let said: Vec<_> =
        read.warnings.iter().map(|w| (w.code, text.get(w.span.clone()).unwrap_or(""))).collect();
    assert_eq!(said, [(code::CLAMPED, "0.5")]);
}

/// A thousand cases are read in seconds, of a text with a recording, too.
#[test]
fn a_thousand_cases() {
    struct Log;
    impl Files for Log {
        fn load(&self, _: &str) -> Result<String, String> {
            Ok((0..1000).map(|t| format!("{t},{}\n", t % 7)).collect())
        }
    }
    let text = swept("key = \"latency\"\nfrom = 0\nto = 1\ncount = 1000")
        .replace("setpoint = 1.0", "disturbance = { csv = \"log.csv\" }");
    let start = std::time::Instant::now();
    assert_eq!(all(&text, &Log).expect("no faults").cases.len(), 1000);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}
