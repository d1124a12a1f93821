//! The built-in scenarios.

use crate::folder::{Folder, json, text};

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
        assert_eq!(folder.read(wrote), include_str!("../../scenarios/demo.toml"));
    }
    let output = folder.run(&["demo", "--save", "a.toml", "--json"]);
    assert_eq!(json(&output)["saved"], "a.toml");
    assert_eq!(folder.run(&["run", "a.toml"]).status.code(), Some(0));
}

#[test]
fn the_gallery_is_listed_and_everything_in_it_runs() {
    let folder = Folder::new("gallery");
    let listed = folder.done(&["demo", "--list"]);
    let list = json(&folder.run(&["demo", "--list", "--json"]));
    let scenarios = list["scenarios"].as_array().expect("a list");
    assert_eq!(listed.lines().count(), scenarios.len());
    for (line, one) in listed.lines().zip(scenarios) {
        let (name, title) = (one["name"].as_str().expect("a name"), one["title"].as_str().expect("a title"));
        assert!(line.starts_with(&format!("{name} ")) && line.ends_with(title), "{line}");
        let run = json(&folder.run(&["demo", name, "--json"]));
        let first = if run["runs"].is_array() { &run["runs"][0] } else { &run };
        assert_eq!(first["scenario"], name);
        // Saved with all that it reads, it is the same.
        let saved = Folder::new(&format!("gallery-{name}"));
        let paths = json(&saved.run(&["demo", name, "--save", "s.toml", "--json"]));
        assert_eq!(saved.names().len(), 1 + paths["files"].as_array().map_or(0, Vec::len));
        let again = json(&saved.run(&["run", "s.toml", "--json"]));
        let again = if again["runs"].is_array() { &again["runs"][0] } else { &again };
        assert_eq!(first["controllers"], again["controllers"], "{name}");
        assert_eq!(first["plant"], again["plant"], "{name}");
    }
    assert_eq!(folder.names(), [] as [&str; 0]);
}

#[test]
fn a_built_in_scenario_by_name() {
    let folder = Folder::new("gallery-name");
    let shown = folder.refused(&["demo", "windap"]);
    assert!(
        shown.contains("no built-in scenario is called `windap`") && shown.contains("did you mean `windup`?"),
        "{shown}"
    );
    let error = &json(&folder.run(&["demo", "nothing like it", "--json"]))["error"];
    assert_eq!(
        (&error["code"], &error["help"]),
        (&"unknown-name".into(), &"see `controller-sim demo --list`".into())
    );

    let shown = folder.done(&["demo", "windup", "--report", "w.html", "--svg", "w.svg", "--csv", "w.csv"]);
    assert!(shown.contains("wrote w.html: ") && !shown.contains("Try next"), "{shown}");
    folder.done(&["demo", "windup", "--save", "windup.toml"]);
    folder.done(&["run", "windup.toml", "--csv", "again.csv", "--svg", "again.svg"]);
    assert!(folder.read("w.csv") == folder.read("again.csv"));
    for (arguments, part) in [
        (&["demo", "--list", "windup"][..], "cannot be used with"),
        (&["demo", "--save", "a.toml", "--csv", "a.csv"], "cannot be used with"),
    ] {
        let shown = folder.refused(arguments);
        assert!(shown.contains(part), "{shown}");
    }
}
