//! Runs that are stopped from outside.

use crate::folder::{BASE, Folder, json, text};
use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Nobody waits longer for anything here.
const PATIENCE: Duration = Duration::from_secs(60);

/// A scenario that takes hours.
fn endless() -> String {
    BASE.replacen("duration = 20.0", "duration = 9e6", 1)
}

/// The program with the signals of a terminal: whoever runs the tests may have had them ignored (`nohup`).
fn start(folder: &Folder, arguments: &[&str]) -> Child {
    let mut command = folder.command(arguments);
    if cfg!(target_os = "linux") {
        command = Command::new("env");
        command.args(["--default-signal", env!("CARGO_BIN_EXE_controller-sim")]).args(arguments);
        command.current_dir(&folder.0).stdin(Stdio::null());
    }
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let started = Instant::now();
    while !is_so() {
        assert!(started.elapsed() < PATIENCE, "still not: {what}");
        sleep(Duration::from_millis(10));
    }
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill is there");
    assert!(sent.success());
}

fn end(mut child: Child) -> Output {
    wait_until("the end of the program", || child.try_wait().expect("it can be asked").is_some());
    child.wait_with_output().expect("it has ended")
}

/// The size of the temporary file of `name`, when there is one.
fn temporary(folder: &Folder, name: &str) -> Option<u64> {
    let found = folder.names().into_iter().find(|one| one.starts_with(&format!(".{name}.")))?;
    fs::metadata(folder.0.join(found)).ok().map(|file| file.len())
}

#[test]
fn a_file_that_is_being_written_is_gone_and_an_earlier_one_untouched() {
    let folder = Folder::new("interrupt");
    folder.write("s.toml", &endless());
    folder.write("old.csv", "mine");
    for (name, signal_name) in [("new.csv", "-INT"), ("old.csv", "-TERM")] {
        let others = ["--parquet", "p.parquet", "--svg", "p.svg"];
        let child = start(&folder, &[&["run", "s.toml", "--force", "--csv", name], &others[..]].concat());
        wait_until("a temporary file with something in it", || {
            temporary(&folder, name).is_some_and(|n| n > 100_000)
        });
        signal(&child, signal_name);
        let output = end(child);
        let said = (text(&output.stdout), text(&output.stderr));
        assert_eq!((output.status.code(), said), (Some(130), ("", "stopped; nothing was written\n")));
        assert_eq!(
            (folder.names(), &*folder.read("old.csv")),
            (vec!["old.csv".into(), "s.toml".into()], "mine")
        );
    }
}

#[test]
fn runs_side_by_side_are_stopped() {
    let folder = Folder::new("interrupt-json");
    folder.write("s.toml", &endless());
    let child = start(&folder, &["run", "s.toml", "s.toml", "--json"]);
    // There is nothing to be seen of a run without files; were the signal too early, it would end the program otherwise.
    sleep(Duration::from_secs(1));
    signal(&child, "-INT");
    let output = end(child);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(130), ""));
    assert_eq!(json(&output)["error"]["code"], "stopped");
}

/// Started to outlive its terminal, the program does: a hangup does nothing to it.
#[cfg(target_os = "linux")]
#[test]
fn a_hangup_that_is_ignored_stays_so() {
    let folder = Folder::new("hangup");
    folder.write("s.toml", &BASE.replacen("duration = 20.0", "duration = 2e4", 1));
    let mut command = Command::new("env");
    command.args([
        "--ignore-signal=HUP",
        env!("CARGO_BIN_EXE_controller-sim"),
        "run",
        "s.toml",
        "--csv",
        "s.csv",
    ]);
    command.current_dir(&folder.0).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("the program starts");
    wait_until("a temporary file", || temporary(&folder, "s.csv").is_some());
    signal(&child, "-HUP");
    let output = end(child);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
    assert_eq!(folder.names(), ["s.csv", "s.toml"]);
}

/// A study that is stopped, by a person or by a power failure, keeps its rows; `--resume` makes of them the file of a whole run.
#[test]
fn a_study_goes_on_where_it_was_stopped() {
    let folder = Folder::new("interrupt-batch");
    let study = [
        "batch",
        "--set",
        "ah134",
        "--methods",
        "pi-ms,dob",
        "--ms",
        "1.2,1.6,2",
        "--noise-ratio",
        "2",
        "--jobs",
        "1",
    ];
    let run = |more: &[&str]| folder.done(&[&study[..], more].concat());
    for kind in ["csv", "parquet"] {
        let whole = format!("whole.{kind}");
        run(&["--out", &whole]);
        for (name, code, rows) in [("-INT", Some(130), 40), ("-KILL", None, 90)] {
            let part = format!("part{name}.{kind}");
            // Rows of a Parquet file stand in a table beside it until it is whole.
            let journal = if kind == "csv" { part.clone() } else { format!("{part}.rows.csv") };
            let lines = |journal: &str| {
                fs::read_to_string(folder.0.join(journal)).map_or(0, |text| text.lines().count())
            };
            let child = start(&folder, &[&study[..], &["--out", &part]].concat());
            wait_until("some rows", || lines(&journal) > rows);
            signal(&child, name);
            let output = end(child);
            assert_eq!(output.status.code(), code, "{}", text(&output.stderr));
            assert!(code.is_none() || text(&output.stderr).contains("`--resume` goes on"));
            let kept = lines(&journal);
            assert!(kept > rows && kept < 805, "{kept} lines: stopped too late to show anything");
            run(&["--out", &part, "--resume"]);
            assert!(folder.bytes(&whole) == folder.bytes(&part), "{part}");
        }
    }
    assert!(!folder.names().iter().any(|name| name.ends_with(".rows.csv")));
}

/// A study of samples that is stopped, or killed, half-way goes on where it was: the file is that of one that was not.
#[test]
fn samples_go_on_where_they_were_killed() {
    let folder = Folder::new("interrupt-samples");
    // Long enough that there is time to kill it.
    folder.write("s.toml", &BASE.replacen("duration = 20.0", "duration = 400.0", 1));
    let study = ["batch", "sample", "s.toml", "--vary", "gain=+-20%", "-n", "60", "--jobs", "2", "--quiet"];
    let with = |more: &[&'static str]| [&study[..], more].concat();
    folder.done(&with(&["--out", "whole.csv"]));
    folder.done(&with(&["--out", "whole.parquet"]));
    let size = folder.bytes("whole.csv").len() as u64;
    for (kind, begun) in [("csv", "cut.csv"), ("parquet", "cut.parquet.rows.csv")] {
        let out = if kind == "csv" { "cut.csv" } else { "cut.parquet" };
        let mut resume = Vec::new();
        for (name, code) in [("-INT", Some(130)), ("-KILL", None)] {
            let there = || fs::metadata(folder.0.join(begun)).map_or(0, |file| file.len());
            let before = there();
            let child = start(&folder, &[&with(&["--out", out]), &resume[..]].concat());
            wait_until("another row in the file", || there() > before.max(2000));
            signal(&child, name);
            let output = end(child);
            assert_eq!(output.status.code(), code, "{}", text(&output.stderr));
            if code.is_some() {
                let said = text(&output.stderr);
                assert!(said.starts_with("stopped; ") && said.contains("`--resume` goes on"), "{said}");
            }
            assert!(there() < size, "it was stopped before its end");
            resume = vec!["--resume"];
        }
        folder.done(&with(&["--out", out, "--resume"]));
        assert!(folder.bytes(out) == folder.bytes(&format!("whole.{kind}")), "{kind}");
    }
    assert!(!folder.names().contains(&"cut.parquet.rows.csv".to_owned()));
}
