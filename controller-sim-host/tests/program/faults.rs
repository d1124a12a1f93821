//! Mistakes in scenarios and arguments.

use crate::folder::{BASE, Folder, json, text};
use serde_json::Value;
use std::fs;
use std::process::Command;

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
        "file": "s.toml", "line": 18, "column": 9, "length": 2, "text": "Kp", "code": "unknown-key",
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
}

#[test]
fn a_near_miss_is_named() {
    let folder = Folder::new("near-miss");
    for (arguments, meant) in [
        (&["run", "s.toml", "--reprot", "r.html"][..], "'--report'"),
        (&["demo", "--lst"], "'--list'"),
        (&["rum", "s"], "'run'"),
        (&["completions", "bsh"], "'bash'"),
    ] {
        let shown = folder.refused(arguments);
        assert!(shown.contains(meant), "{shown}");
        let error = &json(&folder.run(&[arguments, &["--json"]].concat()))["error"];
        assert!(error["help"].as_str().is_some_and(|help| help.contains(meant)), "{error}");
    }
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
        (&["export"], "--format <FORMAT>"),
        (&["batch", "--json"], "--set <SET>"),
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
