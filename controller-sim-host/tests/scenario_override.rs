//! Setting one key of a scenario: `override_key`.

use controller_sim_host::scenario::{override_key, read};
use controller_sim_host::simulate::Precision;

const TEXT: &str = r#"version = 1 # first
ts = 0.1
duration = 10

[plant] # the tank
tf = "1/(1+s)"

[[event]]
at = 0
setpoint = 1.0
[[event]]
at = 5
disturbance = { ramp = 1.0, duration = 2 }

[[controller]]
name = "PI + 1.5"
pid.kp = 1.0
pid.ki = 0.5
[controller.limits]
lo = -10

[[controller]]
name = "P"
pid = { kp = 2.0 }
alarms = {}
"#;

/// Key, value, and what the line becomes: the old and the new text of the only place that differs.
const GOOD: &[(&str, &str, &str, &str)] = &[
    ("ts", "0.2", "ts = 0.1", "ts = 0.2"),
    ("plant.tf", "\"2/(1+s)\"", "\"1/(1+s)\"", "\"2/(1+s)\""),
    ("plant.tf", "2/(1+s)", "\"1/(1+s)\"", "\"2/(1+s)\""),
    ("event.1.setpoint", "{ sine = 1, period = 2 }", "setpoint = 1.0", "setpoint = { sine = 1, period = 2 }"),
    ("event.2.disturbance", "0", "{ ramp = 1.0, duration = 2 }", "0"),
    ("event.2.disturbance.ramp", "3", "ramp = 1.0", "ramp = 3"),
    ("controller.\"PI + 1.5\".pid.kp", "3", "pid.kp = 1.0", "pid.kp = 3"),
    ("controller.1.pid.kp", "3", "pid.kp = 1.0", "pid.kp = 3"),
    ("controller.P.pid.kp", "3", "kp = 2.0", "kp = 3"),
    ("controller.P.name", "Q", "name = \"P\"", "name = \"Q\""),
    ("controller.1.limits.lo", "-1", "lo = -10", "lo = -1"),
    // Not written yet: added where its table is.
    ("latency", "0.1", "version = 1 # first\n", "latency = 0.1\nversion = 1 # first\n"),
    ("noise.std", "0.1", "version = 1 # first\n", "noise.std = 0.1\nversion = 1 # first\n"),
    ("plant.dead_time", "1", "[plant] # the tank\n", "[plant] # the tank\ndead_time = 1\n"),
    ("controller.P.pid.ki", "1", "{ kp = 2.0 }", "{ ki = 1, kp = 2.0 }"),
    ("controller.P.alarms.hi", "1", "alarms = {}", "alarms = { hi = 1 }"),
    ("controller.P.limits.hi", "1", "name = \"P\"\n", "limits.hi = 1\nname = \"P\"\n"),
    ("controller.1.limits.hi", "9", "[controller.limits]\n", "[controller.limits]\nhi = 9\n"),
    ("controller.1.pid.kd", "9", "[[controller]]\nname = \"PI", "[[controller]]\npid.kd = 9\nname = \"PI"),
    ("event.2.disturbance.'odd key'", "1", "{ ramp", "{ 'odd key' = 1, ramp"),
];

#[test]
fn one_value_changes_and_nothing_else() {
    for (key, value, old, new) in GOOD {
        let expected = TEXT.replacen(old, new, 1);
        assert_ne!(expected, TEXT, "{key}");
        assert_eq!(override_key(TEXT, key, value), Ok(expected), "{key}");
    }
}

#[test]
fn a_text_without_a_line_break_at_its_end() {
    let set = |text, key| override_key(text, key, "1").expect("it can be added");
    assert_eq!(set("[noise]", "noise.std"), "[noise]\nstd = 1");
    assert_eq!(set("", "ts"), "ts = 1\n");
    assert_eq!(set("\u{feff}[a]", "ts"), "\u{feff}ts = 1\n[a]");
    // The table above has no lines of its own.
    assert_eq!(set("[plant.inner]\ntf = 2", "plant.tf"), "plant.tf = 1\n[plant.inner]\ntf = 2");
}

#[test]
fn texts_are_put_in_quotes() {
    let set = |value| override_key("title = 1", "title", value).expect("it is there");
    assert_eq!(set("a \"b\" \\"), "title = \"a \\\"b\\\" \\\\\"");
    assert_eq!(set("1\nts = 3"), "title = \"1\\u000ats = 3\"");
    assert_eq!(set("'x'"), "title = 'x'");
    assert_eq!(set("[1, 2]"), "title = [1, 2]");
    assert_eq!(set("1 # x"), "title = \"1 # x\"");
    assert_eq!(set(""), "title = \"\"");
}

#[test]
fn what_cannot_be_set() {
    #[rustfmt::skip]
    let cases = [
        ("", "unknown-key", "is no key", "a key is written"),
        ("a..b", "unknown-key", "a part of it is empty", ""),
        ("\"a", "unknown-key", "not closed", ""),
        ("ts.x", "unknown-key", "`ts` has no keys", ""),
        ("plant", "wrong-type", "`plant` is a table", "a single key"),
        ("controller", "wrong-type", "`controller` is a table", ""),
        ("controller.P", "wrong-type", "`controller.P` is a table", ""),
        ("controller.1.pid", "wrong-type", "is a table", ""),
        ("controller.PI + 1.pid.kp", "unknown-name", "there is no `controller` called `PI + 1`", "\"PI + 1.5\""),
        ("controller.7.pid.kp", "unknown-name", "called `7`", "\"P\""),
        ("event.0.at", "unknown-name", "called `0`", "counted from 1; there are 2"),
        ("event.3.at", "unknown-name", "called `3`", ""),
    ];
    for (key, code, message, help) in cases {
        let fault = override_key(TEXT, key, "1").expect_err(key);
        let whole = format!("{} {}", fault.message, fault.help.as_deref().unwrap_or(""));
        assert_eq!(fault.code, code, "{key}: {whole}");
        assert!(whole.contains(message) && whole.contains(help), "{key}: {whole}");
        assert!(TEXT.get(fault.span.clone()).is_some(), "{fault:?}");
    }
}

#[test]
fn the_new_text_is_read_with_the_new_value() {
    let text = override_key(TEXT, "controller.P.pid.kp", "7").expect("it is there");
    let scenario = read(&text, Precision::F64).expect("no faults").scenario;
    assert_eq!(scenario.controllers[1].config.pid.kp, 7.0);
    let text = override_key(TEXT, "substeps", "3").expect("it can be added");
    assert_eq!(read(&text, Precision::F64).expect("no faults").scenario.substeps, 3);
}
