//! The files that a run writes.

use crate::folder::{BASE, Folder, json, text};
use std::fs;
#[cfg(target_os = "linux")]
use std::process::Command;

#[test]
fn a_csv_file_has_every_sample_and_is_not_overwritten() {
    let folder = Folder::new("csv");
    folder.write("s.toml", BASE);
    let output = folder.run(&["run", "s.toml", "--csv", "out.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("wrote out.csv: 6000 samples"));
    let csv = folder.read("out.csv");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("controller,t,r,y,u,applied,u_f,d_hat,d,mode,status"));
    assert_eq!(csv.lines().count(), 1 + 3 * 2000);
    assert!(csv.lines().skip(1).all(|line| line.split(',').count() == 11));
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

/// The check comes before the run: nothing is computed for a file that cannot be written.
#[test]
fn a_csv_file_that_cannot_be_written() {
    let folder = Folder::new("csv-bad");
    folder.write("s.toml", BASE);
    folder.write("bad.toml", &BASE.replacen("kfd = 0.69", "kfd = 1.5", 1));
    for (scenario, csv) in [("s.toml", "none/out.csv"), ("s.toml", "."), ("bad.toml", "out.csv")] {
        for option in ["--csv", "--parquet", "--report", "--svg"] {
            folder.refused(&["run", scenario, option, csv, "--force"]);
        }
    }
    assert_eq!(folder.names(), ["bad.toml", "s.toml"]);
}

/// Two names of one file: whichever was written last would be left.
#[test]
fn two_outputs_are_two_files() {
    let folder = Folder::new("twice");
    folder.write("s.toml", BASE);
    let shown = folder.refused(&["run", "s.toml", "--report", "a", "--csv", "./a", "--parquet", "../none/a"]);
    for part in ["`--report` and `--csv` are the same file `./a`", "the folder of `../none/a` does not exist"]
    {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    let shown = folder.refused(&["run", "s.toml", "s.toml", "--svg", "a.svg", "--csv", "a-2.svg"]);
    assert!(shown.contains("`--svg` and `--csv` are the same file `a-2.svg`"), "{shown}");
    assert_eq!(folder.names(), ["s.toml"]);
}

/// The disc is full while samples are written: the run ends, and nothing is left of any file.
#[cfg(target_os = "linux")]
#[test]
fn a_file_that_grows_too_long_leaves_nothing() {
    let folder = Folder::new("full");
    folder.write("s.toml", BASE);
    // The system refuses a file longer than 64 kB; the signal that goes with it is ignored.
    let script = "trap '' XFSZ; ulimit -f 64; exec \"$0\" run s.toml --csv s.csv --report r.html";
    let mut command = Command::new("bash");
    command.args(["-c", script, env!("CARGO_BIN_EXE_controller-sim")]).current_dir(&folder.0);
    let output = command.output().expect("bash is there");
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(1), ""), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("cannot write `s.csv`"), "{}", text(&output.stderr));
    assert_eq!(folder.names(), ["s.toml"]);
}
