//! Runs and what they print.

use crate::folder::{BASE, Folder, json, keys, text};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

#[test]
fn without_arguments_the_demo_runs() {
    let folder = Folder::new("no-arguments");
    let output = folder.run(&[]);
    assert_eq!(output.status.code(), Some(0));
    let shown = text(&output.stdout);
    for part in
        ["set-point at 0 s", "disturbance at 10 s", "whole run", "DE-MOMI", "IAE", "Try next (", "cargo sim"]
    {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    assert!(shown.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{shown}");
    assert_eq!(text(&output.stderr), "");
    assert_eq!(folder.names(), [] as [&str; 0]);
    assert_eq!(folder.run(&[]).stdout, output.stdout, "the same twice");
}

#[test]
fn json_of_a_run_has_its_documented_shape() {
    let folder = Folder::new("shape");
    folder.write("s.toml", BASE);
    for precision in ["f32", "f64"] {
        let output = folder.run(&["run", "s.toml", "--json", "--precision", precision]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(text(&output.stderr), "");
        let run = json(&output);
        let expected = "version scenario title case plant ts duration latency substeps precision files controllers warnings";
        assert_eq!(keys(&run).join(" "), expected);
        assert_eq!((&run["scenario"], &run["precision"]), (&"s.toml".into(), &precision.into()));
        assert_eq!((&run["case"], &run["files"]), (&Value::Null, &Value::Array(Vec::new())));
        assert_eq!(
            (&run["duration"], &run["latency"], &run["substeps"]),
            (&20.0.into(), &0.0.into(), &10.into())
        );
        assert_eq!((&run["title"], &run["version"]), (&"".into(), &env!("CARGO_PKG_VERSION").into()));
        assert!(run["plant"].as_str().is_some_and(|plant| plant.contains("exp(-0.2*s)")), "{run}");
        assert_eq!((&run["ts"], &run["warnings"]), (&0.01.into(), &Value::Array(Vec::new())));
        let controllers = run["controllers"].as_array().expect("a list");
        let names: Vec<&str> = controllers.iter().filter_map(|c| c["name"].as_str()).collect();
        assert_eq!(names, ["PID", "PI + DOB", "DE"]);
        for controller in controllers {
            assert_eq!(keys(controller), ["name", "events", "total"]);
            let events: Vec<_> = controller["events"]
                .as_array()
                .expect("a list")
                .iter()
                .map(|e| (&e["at"], &e["kind"]))
                .collect();
            assert_eq!(
                events,
                [(&0.0.into(), &"setpoint".into()), (&10.0.into(), &"disturbance".into())]
                    as [(&Value, &Value); 2]
            );
            for event in controller["events"].as_array().into_iter().flatten() {
                assert_eq!(keys(event), ["at", "kind", "metrics"]);
                assert_eq!(keys(&event["metrics"]), ["ie", "iae", "ise", "itae", "e_max", "tv"]);
                assert!(event["metrics"]["iae"].as_f64().is_some_and(|iae| iae > 0.0), "{event}");
            }
            assert_eq!(keys(&controller["total"]), ["ie", "iae", "ise", "itae", "e_max", "tv"]);
        }
    }
}

#[test]
fn a_scenario_from_the_standard_input() {
    let folder = Folder::new("stdin");
    let run = |input: &str| {
        let mut child = folder
            .command(&["run", "-", "--json"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("writable");
        child.wait_with_output().expect("the program ends")
    };
    let output = run(BASE);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(json(&output)["scenario"], "<stdin>");
    let output = run("version = 3");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(json(&output)["error"]["places"][0]["line"], 1);
}

/// What is to be known of a run before its figures are trusted.
#[test]
fn remarks_on_a_run_are_shown() {
    let folder = Folder::new("remarks");
    let tight = BASE.replacen("limits = { lo = -10.0, hi = 10.0 }", "limits = { lo = -10.0, hi = 0.5 }", 1);
    folder.write("s.toml", &tight);
    let output = folder.run(&["run", "s.toml"]);
    let shown = text(&output.stdout);
    assert!(shown.contains("\nremarks:\n  PID: at an output limit for "), "{shown}");
    let run = json(&folder.run(&["run", "s.toml", "--json"]));
    let warning = &run["warnings"][0];
    assert_eq!((&warning["line"], &warning["code"]), (&Value::Null, &"run".into()));
    assert!(warning["message"].as_str().is_some_and(|m| m.starts_with("PID: at an output limit")), "{run}");
}
