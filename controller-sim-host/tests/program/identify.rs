//! `identify`: logs in, areas and a model out.

use crate::folder::{Folder, json, text};
use std::fmt::Write;
use std::path::Path;

/// `2*exp(-1.5*s)/(1+8*s)`, a step of the input from 10 to 30 at 20 s, sampled every 0.25 s; in the hand of a spreadsheet.
fn step() -> String {
    let mut log = String::from("Zeit;Ventil;Temperatur\ns;%;\u{b0}C\n");
    for row in 0..600 {
        let t = 0.25 * f64::from(row);
        let u = if t < 20.0 { 10 } else { 30 };
        let y = 25.0 + 40.0 * (1.0 - (-(t - 21.5).max(0.0) / 8.0).exp());
        let _ =
            writeln!(log, "{};{u};{}", t.to_string().replace('.', ","), format!("{y:.6}").replace('.', ","));
    }
    log
}

#[test]
fn a_clean_step_gives_its_process() {
    let folder = Folder::new("identify-step");
    folder.write("step.csv", &step());
    let value = json(&folder.run(&["identify", "step.csv", "--json"]));
    let near = |path: &str, expected: f64, tolerance: f64| {
        let found = value.pointer(path).and_then(serde_json::Value::as_f64).expect(path);
        assert!((found - expected).abs() <= tolerance, "{path}: {found}, not {expected}");
    };
    // Printed to 1e-6 of 40.
    near("/model/gain", 2.0, 1e-5);
    near("/model/a1", 8.0, 1e-3);
    near("/model/dead_time", 1.5, 1e-3);
    near("/areas/0", 2.0, 1e-5);
    near("/areas/1", 19.0, 1e-2);
    near("/change_at", 20.0, 0.0);
    near("/before/u", 10.0, 0.0);
    near("/after/y", 65.0, 1e-4);
    assert_eq!(value["columns"], serde_json::json!(["Zeit", "Ventil", "Temperatur"]));
    let shown = folder.done(&["identify", "step.csv"]);
    for part in ["input Ventil [%], output Temperatur [\u{b0}C]", "A5", "chosen: ", "dead_time", "plant \"2"]
    {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    // Columns by name and number, and rows without their times.
    let other = json(&folder.run(&[
        "identify",
        "step.csv",
        "--json",
        "--ts",
        "0.25",
        "--input",
        "2",
        "--output",
        "temperatur",
    ]));
    assert_eq!(other["areas"], value["areas"]);
    let columns = ["identify", "step.csv", "--json", "--input", "2", "--output", "3"];
    let same = json(&folder.run(&[&columns[..], &["--log-ts", "0.25"]].concat()));
    assert_eq!(same["areas"], value["areas"]);
    let refused = folder.refused(&["identify", "step.csv", "--log-ts", "0.25", "--ts", "0.25"]);
    assert!(refused.contains("cannot be used with"), "{refused}");
}

#[test]
fn the_page_shows_record_and_model_and_replaces_nothing() {
    let folder = Folder::new("identify-page");
    folder.write("step.csv", &step());
    let shown = folder.done(&["identify", "step.csv", "--report", "step.html"]);
    assert!(shown.contains("wrote step.html"), "{shown}");
    let page = folder.read("step.html");
    for part in
        ["Record and model", "Residual", "controller-sim identify step.csv --report step.html", "baseline"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("NaN") && !page.contains("inf\"") && !page.contains("http:"), "a broken page");
    let parsed = page.split_once("<html").expect("a page").1;
    roxmltree::Document::parse(&xml(parsed)).unwrap_or_else(|error| panic!("{error}"));
    let refused = folder.refused(&["identify", "step.csv", "--report", "step.html"]);
    assert!(refused.contains("exists and is not overwritten"), "{refused}");
    assert!(folder.refused(&["identify", "step.csv", "--report", "step.csv"]).contains("the log itself"));
    folder.done(&["identify", "step.csv", "--report", "step.html", "--force"]);
}

/// The tags of a page that stand alone, as XML wants them.
fn xml(page: &str) -> String {
    let mut text = format!("<html{page}");
    for tag in ["<meta charset=\"utf-8\">", "<br>"] {
        text = text.replace(tag, "");
    }
    let mut out = String::new();
    for piece in text.split_inclusive('>') {
        let alone = piece.contains("<meta ");
        out.push_str(&if alone { piece.replace('>', "/>") } else { piece.to_owned() });
    }
    out
}

#[test]
fn what_is_wrong_has_its_place_and_its_code() {
    let folder = Folder::new("identify-wrong");
    folder.write("back.csv", "time,u,y\n0,0,1\n1,0,1\n0.5,0,1\n");
    let shown = folder.refused(&["identify", "back.csv"]);
    assert!(shown.contains("back.csv:4:1") && shown.contains("0.5 is before 1"), "{shown}");
    let output = folder.run(&["identify", "back.csv", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(json(&output)["error"]["places"][0]["line"].as_u64(), Some(4));
    assert!(folder.refused(&["identify", "none.csv"]).contains("cannot read `none.csv`"));
    folder.write("wide.csv", "time,a,b,c\n0,1,2,3\n1,2,3,4\n");
    assert!(folder.refused(&["identify", "wide.csv"]).contains("--input"));
    assert!(folder.refused(&["identify", "wide.csv", "--ts", "0"]).contains("above 0"));

    folder.write("untimed.csv", "u,y\n0,1\n0,1\n1,1\n");
    let shown = folder.refused(&["identify", "untimed.csv"]);
    assert!(shown.contains("`--log-ts S`"), "{shown}");

    // Well formed, but nothing can be concluded.
    let rows: String = (0..100).map(|i| format!("{i},1,{}\n", i % 3)).collect();
    folder.write("still.csv", &format!("time,u,y\n{rows}"));
    let output = folder.run(&["identify", "still.csv"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(3), ""));
    let shown = text(&output.stderr);
    assert!(
        shown.contains("(input `u`, output `y`): the input does not change") && shown.contains("help"),
        "{shown}"
    );
    let output = folder.run(&["identify", "still.csv", "--json"]);
    assert_eq!((output.status.code(), json(&output)["error"]["code"].as_str()), (Some(3), Some("refused")));
}

#[test]
fn an_integrating_process_is_refused_with_what_to_do() {
    let folder = Folder::new("identify-tank");
    let rows: String = (0..300)
        .map(|i| {
            format!("{i},{},{}\n", if i < 30 { 20 } else { 25 }, 3.0 + 0.04 * f64::from((i - 33).max(0)))
        })
        .collect();
    folder.write("tank.csv", &format!("time,valve,level\n{rows}"));
    let output = folder.run(&["identify", "tank.csv"]);
    let shown = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{shown}");
    assert!(shown.contains("the process integrates") && shown.contains("K*exp(-L*s)/s"), "{shown}");
}

/// A real log, where there is one beside the source tree: 10-bit steps, a doubled first stamp, gaps of 1.01 s.
#[test]
fn the_recorded_heater() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/heater-step.csv");
    let Ok(log) = std::fs::read_to_string(&data) else {
        println!("no recorded heater here: not checked");
        return;
    };
    let folder = Folder::new("identify-heater");
    folder.write("heater.csv", &log);
    let value = json(&folder.run(&["identify", "heater.csv", "--json", "--report", "heater.html"]));
    let number = |path: &str| value.pointer(path).and_then(serde_json::Value::as_f64).expect(path);
    let (gain, a1, a2) = (number("/model/gain"), number("/model/a1"), number("/model/a2"));
    let dead_time = number("/model/dead_time");
    // The model's step by itself: two real lags, from the recorded baseline.
    let root = (a1 * a1 - 4.0 * a2).sqrt();
    let (p, q) = (0.5 * (a1 + root), 0.5 * (a1 - root));
    let mut worst = 0.0_f64;
    for line in log.lines().skip(2) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let t = (cells[0] - dead_time).max(0.0);
        let response = 1.0 - (p * (-t / p).exp() - q * (-t / q.max(1e-9)).exp()) / (p - q);
        worst = worst.max((number("/before/y") + 50.0 * gain * response - cells[2]).abs());
    }
    assert!(worst <= 1.0, "{worst} degC, model {}", value["model"]);
    assert!((number("/noise/quantisation") - 0.322).abs() < 0.005);
    println!("{worst} degC\n{value:#}");
}
