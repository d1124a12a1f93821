//! Help, completions and manual pages.

use crate::folder::{Folder, json, text};

const COMMANDS: [&str; 13] = [
    "export",
    "run",
    "demo",
    "design",
    "tune",
    "identify",
    "analyze",
    "assess",
    "batch",
    "reproduce",
    "completions",
    "man",
    "schema",
];

#[test]
fn every_command_has_a_help_with_examples() {
    let folder = Folder::new("help");
    let all = folder.done(&["--help"]);
    for command in COMMANDS {
        assert!(all.contains(&format!("\n  {command} ")), "{all}");
        let shown = folder.done(&[command, "--help"]);
        assert!(
            shown.contains("Examples:\n") && shown.contains(&format!("controller-sim {command}")),
            "{shown}"
        );
    }
    assert!(all.contains("--report"), "{all}");
}

#[test]
fn completions_know_commands_and_options() {
    let folder = Folder::new("completions");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let shown = folder.done(&["completions", shell]);
        for word in COMMANDS.into_iter().chain(["parquet", "precision", "threads"]) {
            assert!(shown.contains(word), "{shell}: {word}");
        }
        let output = folder.run(&["completions", shell, "--json"]);
        assert_eq!(json(&output)["text"].as_str(), Some(&*shown));
    }
    let shown = folder.refused(&["completions", "bush"]);
    assert!(shown.contains("bash"), "{shown}");
}

#[test]
fn a_manual_page_for_each_command() {
    let folder = Folder::new("man");
    let main = folder.done(&["man"]);
    assert!(main.contains(".TH controller-sim 1") && main.contains("Examples:"), "{main}");
    let shown = folder.done(&["man", "--dir", "."]);
    let mut expected: Vec<String> =
        COMMANDS.iter().map(|command| format!("controller-sim-{command}.1")).collect();
    expected.push("controller-sim.1".to_owned());
    expected.sort();
    assert_eq!(folder.names(), expected);
    assert_eq!((shown.lines().count(), folder.read("controller-sim.1")), (COMMANDS.len() + 1, main));
    let run = folder.read("controller-sim-run.1");
    assert!(run.contains(".TH controller-sim-run 1") && run.contains("\\-\\-parquet"), "{run}");

    folder.write("controller-sim-run.1", "mine");
    let shown = folder.refused(&["man", "--dir", "."]);
    assert_eq!(shown.matches("exists and is not overwritten").count(), COMMANDS.len() + 1, "{shown}");
    assert_eq!(folder.read("controller-sim-run.1"), "mine");
    let output = folder.run(&["man", "--dir", ".", "--force", "--json"]);
    assert_eq!(
        json(&output)["written"].as_array().map(Vec::len),
        Some(COMMANDS.len() + 1),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(folder.read("controller-sim-run.1"), run);
    assert!(folder.refused(&["man", "--dir", "none"]).contains("mkdir -p none"));
}
