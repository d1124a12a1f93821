//! Sweeps, included files, recordings and cascades, as the program shows them.

use crate::folder::{BASE, Folder, json};
use std::fs;

/// A design file: one loop, to be included.
const DESIGN: &str = "\
version = 1
ts = 0.01
duration = 20.0
plant = { tf = \"1/(1+s)\" }
event = [{ at = 0, setpoint = 1.0 }]
[[controller]]
name = \"designed\"
pid = { kp = 1.0, ki = 1.0 }
";

#[test]
fn each_case_of_a_sweep_is_a_chapter() {
    let folder = Folder::new("sweep");
    let sweep = format!("{BASE}\n[sweep]\nkey = \"latency\"\nvalues = [0.0, 0.02, 0.1]\n");
    folder.write("s.toml", &sweep);
    folder.write("b.toml", BASE);
    let all = json(&folder.run(&["run", "s.toml", "b.toml", "--json"]));
    let runs = all["runs"].as_array().expect("a list");
    let cases: Vec<Option<&str>> = runs.iter().map(|run| run["case"].as_str()).collect();
    assert_eq!(cases, [Some("latency = 0.0"), Some("latency = 0.02"), Some("latency = 0.1"), None]);
    assert_eq!(runs[0]["controllers"], runs[3]["controllers"]);
    let set = json(&folder.run(&["run", "b.toml", "--json", "--set", "latency=0.1"]));
    assert_eq!(runs[2]["controllers"], set["controllers"]);

    let shown = folder.done(&["run", "s.toml", "--csv", "s.csv", "--svg", "p.svg", "--report", "r.html"]);
    assert!(shown.contains("\n\n== s.toml, latency = 0.02\n"), "{shown}");
    assert_eq!(folder.names(), ["b.toml", "p-1.svg", "p-2.svg", "p-3.svg", "r.html", "s.csv", "s.toml"]);
    let csv = folder.read("s.csv");
    let cases = csv.lines().skip(1).filter(|line| line.starts_with("s.toml,latency = 0.02,PI + DOB,"));
    assert_eq!((cases.count(), csv.lines().count()), (2000, 1 + 3 * 6000));
}

/// Same bytes for every number of threads, when there are more cases than threads and when there are fewer.
#[test]
fn a_sweep_has_the_same_bytes_for_every_number_of_threads() {
    let folder = Folder::new("sweep-threads");
    folder.write(
        "s.toml",
        &format!("{BASE}\n[noise]\nstd = 0.01\n[sweep]\nkey = \"noise.std\"\nvalues = [0.0, 0.1, 0.2]\n"),
    );
    let run = |threads| folder.done(&["run", "s.toml", "--json", "--threads", threads]);
    let (one, two, seven) = (run("1"), run("2"), run("7"));
    assert!(one == two && two == seven);
}

#[test]
fn a_fault_in_an_included_file_has_its_place_there() {
    let folder = Folder::new("include");
    fs::create_dir(folder.0.join("sub")).expect("a folder");
    folder.write("sub/loop.toml", DESIGN);
    folder.write("sub/s.toml", "version = 1\ninclude = \"loop.toml\"\n");
    let run = json(&folder.run(&["run", "sub/s.toml", "--json"]));
    assert_eq!(run["controllers"][0]["name"], "designed");

    for output in ["--csv", "--parquet", "--svg", "--report"] {
        let shown = folder.refused(&["run", "sub/s.toml", output, "./sub/loop.toml", "--force"]);
        assert!(
            shown.contains("`./sub/loop.toml` is read by the scenario and is not overwritten"),
            "{shown}"
        );
    }
    assert_eq!(folder.read("sub/loop.toml"), DESIGN);

    folder.write("sub/loop.toml", &DESIGN.replacen("kp = 1.0", "kpp = 1.0", 1));
    let shown = folder.refused(&["run", "sub/s.toml"]);
    assert!(shown.contains("loop.toml:8:9") && shown.contains("did you mean `kp`?"), "{shown}");
    let error = &json(&folder.run(&["run", "sub/s.toml", "--json"]))["error"];
    let place = &error["places"][0];
    assert_eq!((&place["line"], &place["column"], &place["text"]), (&8.into(), &9.into(), &"kpp".into()));
    assert_eq!(place["file"], "loop.toml");
}

#[test]
fn a_recording_that_a_scenario_plays_is_not_overwritten() {
    let folder = Folder::new("recording");
    folder.write("load.csv", "t,d\n0,0\n5,1\n10,0.5\n");
    let change = "disturbance = { csv = \"load.csv\", column = \"d\" }";
    folder.write("s.toml", &BASE.replacen("disturbance = 1.0", change, 1));
    folder.done(&["run", "s.toml"]);
    let shown = folder.refused(&["run", "s.toml", "--csv", "load.csv", "--force"]);
    assert!(shown.contains("`load.csv` is read by the scenario"), "{shown}");
    assert!(folder.read("load.csv").starts_with("t,d\n"));
}

/// The columns of the loop inside are there when any run has one, and empty for controllers without.
#[test]
fn samples_of_a_cascade() {
    let folder = Folder::new("cascade");
    let cascade = "\n[[controller]]\nname = \"cascade\"\npid = { kp = 1.0, ki = 0.5 }\n\
                   [controller.secondary]\npid = { kp = 2.0, ki = 1.0 }\n";
    let text = BASE.replacen("[plant]\n", "[plant]\ninner = \"1/(1+0.2*s)\"\n", 1);
    folder.write("c.toml", &format!("{text}{cascade}"));
    folder.done(&["run", "c.toml", "--csv", "c.csv", "--parquet", "c.parquet"]);
    let csv = folder.read("c.csv");
    assert_eq!(
        csv.lines().next(),
        Some("controller,t,r,y,u,applied,u_f,d_hat,d,inner_r,inner_y,mode,status")
    );
    for line in csv.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields.len(), 13);
        let has_inner = fields[9].parse::<f64>().is_ok() && fields[10].parse::<f64>().is_ok();
        assert_eq!(has_inner, fields[0] == "cascade", "{line}");
        assert!(has_inner || fields[9..11] == ["", ""], "{line}");
    }
    crate::parquet::same_rows(&folder, "c.csv", "c.parquet");
}
