//! Several runs at once, and values given on the command line.

use crate::folder::{BASE, Folder, json, text};

/// All files are read before anything runs, and all their faults are shown.
#[test]
fn faults_of_all_files_come_at_once() {
    let folder = Folder::new("several-faults");
    folder.write("good.toml", BASE);
    folder.write("a.toml", &BASE.replacen("kp = 2.35", "Kp = 2.35", 1));
    folder
        .write("b.toml", &BASE.replacen("kfd = 0.69", "kfd = 1.5", 1).replacen("ts = 0.01", "ts = -1.0", 1));
    folder.write("out.csv", "mine");
    let before = folder.names();
    let all = ["run", "a.toml", "none.toml", "good.toml", "b.toml", "--csv", "out.csv", "--report", "r.html"];
    let shown = folder.refused(&all);
    let order = ["a.toml:18:9", "cannot read `none.toml`", "b.toml:2:6", "b.toml:29:70", "`out.csv` exists"];
    let places: Vec<Option<usize>> = order.iter().map(|part| shown.find(part)).collect();
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}\n{shown}");
    assert!(!shown.contains("\n\n\n"), "{shown}");
    let error = &json(&folder.run(&[&all[..], &["--json"]].concat()))["error"];
    assert_eq!((&error["code"], error["places"].as_array().map(Vec::len)), (&"unknown-key".into(), Some(5)));
    let files: Vec<Option<&str>> =
        error["places"].as_array().into_iter().flatten().map(|place| place["file"].as_str()).collect();
    assert_eq!(files, [Some("a.toml"), None, Some("b.toml"), Some("b.toml"), None]);
    assert!(error["message"].as_str().is_some_and(|m| m.ends_with("(and 4 more)")), "{error}");
    assert_eq!((folder.names(), &*folder.read("out.csv")), (before, "mine"));
}

#[test]
fn several_files_are_chapters_in_order() {
    let folder = Folder::new("several");
    folder.write("a.toml", BASE);
    folder.write("b.toml", &BASE.replacen("duration = 20.0", "duration = 12.0", 1));
    let one = json(&folder.run(&["run", "b.toml", "--json"]));
    let both = json(&folder.run(&["run", "a.toml", "b.toml", "--json"]));
    let names: Vec<_> = both["runs"].as_array().into_iter().flatten().map(|run| &run["scenario"]).collect();
    assert_eq!(names, ["a.toml", "b.toml"]);
    assert_eq!(both["runs"][1], one, "each is as if it had been run alone");
    let shown = folder.done(&["run", "a.toml", "b.toml"]);
    assert!(shown.starts_with("== a.toml\n") && shown.contains("\n\n== b.toml\n"), "{shown}");

    let shown =
        folder.done(&["run", "b.toml", "a.toml", "--svg", "p.svg", "--csv", "s.csv", "--report", "r.html"]);
    assert_eq!(folder.names(), ["a.toml", "b.toml", "p-1.svg", "p-2.svg", "r.html", "s.csv"]);
    for line in
        ["wrote r.html: open it by: ", "wrote p-1.svg: ", "wrote p-2.svg: ", "wrote s.csv: 9600 samples\n"]
    {
        assert!(shown.contains(line), "`{line}` is not in:\n{shown}");
    }
    let csv = folder.read("s.csv");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("scenario,case,controller,t,r,y,u,applied,u_f,d_hat,d,mode,status"));
    let firsts: Vec<&str> = lines.map(|line| line.split(',').next().unwrap_or("")).collect();
    assert_eq!(firsts, [["b.toml"; 3600].as_slice(), &["a.toml"; 6000]].concat());
    let again = ["run", "b.toml", "a.toml", "--svg", "p.svg", "--csv", "s.csv", "--force", "--json"];
    let files = &json(&folder.run(&again))["runs"][1]["files"];
    let expected =
        serde_json::json!([{ "kind": "svg", "path": "p-2.svg" }, { "kind": "csv", "path": "s.csv" }]);
    assert_eq!(files, &expected);
}

#[test]
fn a_folder_is_no_name_for_pictures() {
    let folder = Folder::new("several-svg-folder");
    folder.write("a.toml", BASE);
    std::fs::create_dir_all(folder.0.join("pictures")).expect("a folder");
    for name in ["pictures", "pictures/"] {
        let shown = folder.refused(&["run", "a.toml", "a.toml", "--svg", name]);
        assert!(shown.contains("is a directory") && shown.contains("plot.svg"), "{shown}");
        assert_eq!(folder.names(), ["a.toml", "pictures"]);
    }
}

#[test]
fn values_are_set_on_the_command_line() {
    let folder = Folder::new("set");
    folder.write("s.toml", BASE);
    folder.write("late.toml", &BASE.replacen("duration = 20.0", "duration = 20.0\nlatency = 0.05", 1));
    let arguments = |name| ["run", name, "--json", "--substeps", "3"];
    let set = json(&folder.run(&[&arguments("s.toml")[..], &["--set", "latency=0.05"]].concat()));
    let written = json(&folder.run(&arguments("late.toml")));
    assert_eq!((&set["controllers"], &set["latency"]), (&written["controllers"], &0.05.into()));
    assert_eq!(set["substeps"], 3);

    let shown = folder.refused(&["run", "s.toml", "--set", "noise.std=-1"]);
    let parts = ["--> s.toml with --set noise.std=-1:", "`noise.std = -1` is out of range", "^^"];
    for part in parts {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    let shown = folder.refused(&["run", "s.toml", "--set", "controller.\"PI + DB\".observer.alpha=0.2"]);
    assert!(shown.contains("did you mean \"PI + DOB\"?"), "{shown}");
    let shown = folder.refused(&["run", "s.toml", "--set", "latency"]);
    assert!(shown.contains("write KEY=VALUE"), "{shown}");
    let alpha =
        ["run", "s.toml", "--set", "controller.\"PI + DOB\".observer.alpha=0.2", "--set", "plant.tf=1/(1+s)"];
    assert!(folder.done(&alpha).starts_with("plant 1/(1+s)\n"));
}

#[test]
fn the_time_that_is_drawn() {
    let folder = Folder::new("view");
    folder.write("s.toml", BASE);
    let shown = folder.refused(&["run", "s.toml", "--svg", "p.svg", "--from", "20"]);
    assert!(shown.contains("nothing is left of `s.toml`") && shown.contains("from 0 to 20 s"), "{shown}");
    let shown = folder.refused(&["run", "s.toml", "--from", "2"]);
    assert!(shown.contains("--report <FILE>"), "{shown}");
    for wrong in ["-1", "inf", "NaN", "x"] {
        let shown = folder.refused(&["run", "s.toml", "--svg", "p.svg", &format!("--from={wrong}")]);
        assert!(shown.contains("a time in seconds"), "{shown}");
    }
    folder.done(&["run", "s.toml", "--svg", "a.svg", "--from", "9", "--to", "14"]);
    folder.done(&["run", "s.toml", "--svg", "b.svg", "--from", "9", "--to", "1e9"]);
    folder.done(&["run", "s.toml", "--svg", "c.svg"]);
    let (a, b, c) = (folder.read("a.svg"), folder.read("b.svg"), folder.read("c.svg"));
    assert!(a != b && b != c && c != a);
}

#[test]
fn the_standard_input_is_read_once() {
    let folder = Folder::new("stdin-twice");
    let shown = folder.refused(&["run", "-", "-"]);
    assert!(shown.contains("`-` is given twice"), "{shown}");
}

#[test]
fn quiet_says_nothing_of_files() {
    let folder = Folder::new("quiet");
    folder.write("s.toml", BASE);
    let loud = folder.done(&["run", "s.toml"]);
    let output = folder.run(&["run", "s.toml", "--quiet", "--csv", "s.csv"]);
    assert_eq!((text(&output.stdout), text(&output.stderr)), (&*loud, ""));
    assert_eq!(folder.names(), ["s.csv", "s.toml"]);
}
