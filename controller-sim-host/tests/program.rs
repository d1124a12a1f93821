//! The program as it is called: exit codes, streams, JSON, files.

use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const BASE: &str = include_str!("data/base.toml");

/// A folder of its own for a test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("writable");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("readable")
    }

    fn names(&self) -> Vec<String> {
        let list = fs::read_dir(&self.0).expect("readable");
        let mut names: Vec<String> =
            list.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the program starts")
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_controller-sim"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", text(&output.stdout)))
}

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
        let keys = |value: &Value| value.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(&run), ["scenario", "ts", "precision", "controllers", "warnings"]);
        assert_eq!((&run["scenario"], &run["precision"]), (&"s.toml".into(), &precision.into()));
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
fn bad_scenarios_end_with_2_and_a_caret() {
    let folder = Folder::new("bad");
    for (from, to, place, word) in [
        ("ts = 0.01", "ts = 0,01", "s.toml:2:7", "decimal comma"),
        ("kp = 2.35", "Kp = 2.35", "s.toml:18:9", "did you mean `kp`?"),
        ("(1+s))\"\n\n", "(1+S))\"\n\n", "s.toml:6:33", "lower-case"),
        ("kfd = 0.69", "kfd = 1.5", "s.toml:29:70", "allowed: 0 to 1"),
    ] {
        folder.write("s.toml", &BASE.replacen(from, to, 1));
        let output = folder.run(&["run", "s.toml"]);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""));
        let shown = text(&output.stderr);
        for part in [place, word, "^", "error["] {
            assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
        }
        assert!(!shown.contains('\u{1b}'), "no colours off a terminal:\n{shown}");
    }
}

#[test]
fn bad_scenarios_as_json() {
    let folder = Folder::new("bad-json");
    folder
        .write("s.toml", &BASE.replacen("kp = 2.35", "Kp = 2.35", 1).replacen("kfd = 0.69", "kfd = 1.5", 1));
    let output = folder.run(&["run", "s.toml", "--json"]);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(2), ""));
    let error = &json(&output)["error"];
    assert_eq!(error["code"], "unknown-key");
    assert_eq!(error["message"], "unknown key `Kp` in `pid` (and 1 more)");
    assert_eq!(error["help"], "did you mean `kp`?");
    let places = error["places"].as_array().expect("a list");
    assert_eq!(places.len(), 2);
    let expected = serde_json::json!({
        "line": 18, "column": 9, "length": 2, "text": "Kp", "code": "unknown-key",
        "message": "unknown key `Kp` in `pid`", "help": "did you mean `kp`?",
    });
    assert_eq!(places[0], expected);
    assert_eq!((&places[1]["line"], &places[1]["column"]), (&29.into(), &70.into()));
}

#[test]
fn files_that_cannot_be_read() {
    let folder = Folder::new("unreadable");
    fs::write(folder.0.join("latin.toml"), b"version = 1\n# \xe9\n").expect("writable");
    for (name, word) in
        [("none.toml", "cannot read `none.toml`"), ("latin.toml", "line 2"), (".", "`.` is a directory")]
    {
        let output = folder.run(&["run", name]);
        assert_eq!(output.status.code(), Some(2), "{name}");
        assert!(text(&output.stderr).contains(word), "{}", text(&output.stderr));
        let error = &json(&folder.run(&["run", name, "--json"]))["error"];
        assert_eq!((&error["code"], &error["places"]), (&"file".into(), &Value::Array(Vec::new())));
    }
}

#[test]
fn wrong_arguments() {
    let folder = Folder::new("arguments");
    let output = folder.run(&["run"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""));
    for arguments in [&["run", "--json"][..], &["run", "a", "--json", "--substeps", "0"], &["rum", "--json"]]
    {
        let output = folder.run(arguments);
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(2), ""), "{arguments:?}");
        assert_eq!(json(&output)["error"]["code"], "usage");
    }
    for arguments in [&["--help"][..], &["run", "--help"], &["demo", "--help"]] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).contains("Examples:"), "{arguments:?}");
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

#[test]
fn a_csv_file_has_every_sample_and_is_not_overwritten() {
    let folder = Folder::new("csv");
    folder.write("s.toml", BASE);
    let output = folder.run(&["run", "s.toml", "--csv", "out.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("wrote out.csv: 6000 samples"));
    let csv = folder.read("out.csv");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("controller,t,r,y,u,u_f,d_hat,d,mode,status"));
    assert_eq!(csv.lines().count(), 1 + 3 * 2000);
    assert!(csv.lines().skip(1).all(|line| line.split(',').count() == 10));
    assert!(csv.contains("\nPI + DOB,0,1,0,"), "{:?}", lines.next());

    folder.write("out.csv", "mine");
    let output = folder.run(&["run", "s.toml", "--csv", "out.csv"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""));
    assert!(text(&output.stderr).contains("`out.csv` exists and is not overwritten"));
    assert!(text(&output.stderr).contains("--force"));
    assert_eq!(folder.read("out.csv"), "mine");
    let output = folder.run(&["run", "s.toml", "--csv", "out.csv", "--json"]);
    assert_eq!(json(&output)["error"]["code"], "file-exists");

    let output = folder.run(&["run", "s.toml", "--csv", "out.csv", "--force"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(folder.read("out.csv"), csv);
    assert_eq!(folder.names(), ["out.csv", "s.toml"], "no other file is left");
}

/// Whatever name it goes by, and even with `--force`.
#[test]
fn a_scenario_is_not_overwritten_by_its_own_csv_file() {
    let folder = Folder::new("csv-itself");
    folder.write("s.toml", BASE);
    fs::create_dir_all(folder.0.join("sub")).expect("a folder");
    let mut names = vec!["s.toml", "./s.toml", "sub/../s.toml"];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("s.toml", folder.0.join("link")).expect("a link");
        fs::hard_link(folder.0.join("s.toml"), folder.0.join("hard")).expect("a link");
        names.extend(["link", "hard"]);
    }
    for (scenario, csv) in names.iter().flat_map(|a| names.iter().map(move |b| (a, b))) {
        let output = folder.run(&["run", scenario, "--csv", csv, "--force"]);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""), "{scenario} {csv}");
        assert!(text(&output.stderr).contains("is the scenario itself"), "{}", text(&output.stderr));
        assert_eq!(folder.read("s.toml"), BASE);
    }
    #[cfg(target_os = "linux")]
    {
        let input = fs::File::open(folder.0.join("s.toml")).expect("readable");
        let mut command = folder.command(&["run", "-", "--csv", "s.toml", "--force"]);
        let output = command.stdin(input).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(folder.read("s.toml"), BASE);
    }
    let output = folder.run(&["run", "s.toml", "--csv", "-"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("give a file: `--csv my.csv`"), "{}", text(&output.stderr));
}

/// What people try first, and what they are told.
#[test]
fn wrong_arguments_have_a_help() {
    let folder = Folder::new("usage-help");
    folder.write("s.toml", BASE);
    folder.write("my file", BASE);
    for (arguments, part) in [
        (&["s.toml"][..], "controller-sim run s.toml"),
        (&["none.toml"], "controller-sim run none.toml"),
        (&["my file"], "controller-sim run 'my file'"),
        (&["design"], "the command `design` is not in this version"),
        (&["reproduce", "--json"], "the command `reproduce` is not in this version"),
        (&["analyze", "s.toml"], "not in this version"),
        (&["run", "s.toml", "--force"], "--csv <FILE>"),
    ] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let shown = [text(&output.stdout), text(&output.stderr)].concat();
        assert!(shown.contains(part), "{arguments:?}: {shown}");
    }
    let output = folder.run(&["run", "--json", "--force", "s.toml"]);
    assert!(json(&output)["error"]["message"].as_str().is_some_and(|m| m.contains("--csv")), "{output:?}");
    let output = folder.run(&["--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(json(&output)["scenario"], "demo");
}

/// A pipe without a writer: the program must not wait for one.
#[cfg(unix)]
#[test]
fn a_pipe_by_name_is_no_scenario() {
    let folder = Folder::new("pipe");
    let made = Command::new("mkfifo").arg(folder.0.join("p")).status();
    if made.is_ok_and(|status| status.success()) {
        let output = folder.run(&["run", "p"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("`p` is not a regular file"), "{}", text(&output.stderr));
    }
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

/// The check comes before the run: nothing is computed for a file that cannot be written.
#[test]
fn a_csv_file_that_cannot_be_written() {
    let folder = Folder::new("csv-bad");
    folder.write("s.toml", BASE);
    folder.write("bad.toml", &BASE.replacen("kfd = 0.69", "kfd = 1.5", 1));
    for (scenario, csv) in [("s.toml", "none/out.csv"), ("s.toml", "."), ("bad.toml", "out.csv")] {
        let output = folder.run(&["run", scenario, "--csv", csv, "--force"]);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""), "{scenario} {csv}");
    }
    let long = BASE.replacen("ts = 0.01", "ts = 1e-6", 1).replacen("tf = 0.119", "tf = 0.2", 1);
    folder.write("long.toml", &long);
    let output = folder.run(&["run", "long.toml", "--csv", "out.csv"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("6.000e7 samples are too many"), "{}", text(&output.stderr));
    assert_eq!(folder.names(), ["bad.toml", "long.toml", "s.toml"]);
}

#[test]
fn the_demo_is_saved_under_the_next_free_name() {
    let folder = Folder::new("demo");
    for (arguments, wrote) in [
        (&["demo", "--save"][..], "demo.toml"),
        (&["demo", "--save"], "demo-2.toml"),
        (&["demo", "--save", "demo.toml"], "demo-3.toml"),
        (&["demo", "--save", "demo.toml", "--force"], "demo.toml"),
        (&["demo", "--save", "my"], "my"),
        (&["demo", "--save", "my"], "my-2"),
    ] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stdout).starts_with(&format!("wrote {wrote};")), "{}", text(&output.stdout));
        assert!(folder.read(wrote).starts_with("# Three controllers"));
    }
    let output = folder.run(&["demo", "--save", "a.toml", "--json"]);
    assert_eq!(json(&output)["saved"], "a.toml");
    assert_eq!(folder.run(&["run", "a.toml"]).status.code(), Some(0));
}
