//! `design`, and what can be done with its file.

use crate::folder::{BASE, Folder, json, text};
use crate::schema::check;
use serde_json::Value;

const PLANT: &str = "exp(-0.2*s)/((1+0.2*s)*(1+s))";
const METHODS: [&str; 10] =
    ["momi", "drmo", "de-momi", "pi-ms", "dob", "pi-iae", "ah", "adrc", "amigo", "simc"];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Equations (35), (37) of Vrančić & Huba 2021.
#[test]
fn the_chapters_example_comes_out() {
    let folder = Folder::new("design-example");
    let arguments = ["design", "--plant", PLANT, "--method", "de-momi", "--ts", "0.01", "--kpidn", "4"];
    let shown = folder.done(&arguments);
    for part in
        ["kp                    2.35449 u/y", "tf                    0.118698 s", "tfd        0.0599694 s"]
    {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    assert!(shown.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{shown}");
    let made = json(&folder.run(&[&arguments[..], &["--json"]].concat()));
    check(&made);
    assert!((number(&made["estimator"]["kfd"]) - 0.68867).abs() < 1e-5, "{made}");
    assert!((number(&made["areas"][1]) - 1.4).abs() < 1e-12);
}

/// The margins of `analyze` are those of the design; the run gives the predicted integrals.
#[test]
fn every_design_is_saved_run_and_analysed() {
    let folder = Folder::new("design-save");
    for method in METHODS {
        let file = format!("{method}.toml");
        let made = json(&folder.run(&[
            "design", "--plant", PLANT, "--method", method, "--ts", "0.01", "--save", &file, "--json",
        ]));
        check(&made);
        assert_eq!(made["saved"], file, "{made}");
        let run = json(&folder.run(&["run", &file, "--json"]));
        assert!(run["warnings"].as_array().is_some_and(Vec::is_empty), "{method}: {}", run["warnings"]);
        let events = &run["controllers"][0]["events"];
        for (event, key) in [(0, "ie_setpoint"), (1, "ie_load")] {
            let metrics = &events[event]["metrics"];
            let (ie, expected) = (number(&metrics["ie"]), number(&made["predicted"][key]));
            assert!(
                (ie - expected).abs() <= 3e-4 * number(&metrics["iae"]),
                "{method}, {key}: {ie}, {expected}"
            );
        }
        let analysed = json(&folder.run(&["analyze", &file, "--json"]));
        let loop_ = &analysed["controllers"][0];
        for (form, own) in
            [("continuous", &made["robustness"]), ("discrete", &made["discrete"]["robustness"])]
        {
            for margin in ["ms", "gm", "delay_margin"] {
                let (one, two) = (&loop_[form]["robustness"][margin], &own[margin]);
                let same = one == two || (number(one) / number(two) - 1.0).abs() < 1e-9;
                assert!(same, "{method}, {form}, {margin}: {one}, {two}");
            }
        }
    }
    let shown = folder.refused(&["design", "--plant", PLANT, "--method", "momi", "--save", "momi.toml"]);
    assert!(shown.contains("`momi.toml` exists and is not overwritten"), "{shown}");
}

#[test]
fn mistakes_and_refusals_are_told_apart() {
    let folder = Folder::new("design-wrong");
    let refused = |plant: &str, method: &str, more: &[&str], code: i32, part: &str| {
        let arguments = [&["design", "--plant", plant, "--method", method][..], more].concat();
        let output = folder.run(&arguments);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(code), ""), "{plant} {method}");
        assert!(text(&output.stderr).contains(part), "`{part}` is not in:\n{}", text(&output.stderr));
        let output = folder.run(&[&arguments[..], &["--json"]].concat());
        let error = json(&output);
        check(&error);
        assert_eq!(output.status.code(), Some(code));
        assert!(error["error"]["help"].is_string() || code == 2, "{error}");
    };
    refused("1/(1+S)", "momi", &[], 2, "--plant:1:6");
    refused("1/(1+s)", "pi-ms", &[], 3, "no design by pi-ms");
    refused("1/s", "momi", &[], 3, "no design by momi");
    refused("1/(1+s)^2", "momi", &["--kpidn", "0.1", "--ts", "0.01"], 3, "least attainable");
    refused("1/(1+s)^2", "momi", &["--tfd", "0.1"], 2, "it belongs to de-momi");
    refused("1/(1+s)^2", "momi", &["--limits", "5:1"], 2, "lower and the upper");
    refused("1/(1+s)^2", "advise", &["--save", "a.toml"], 2, "needs one method");
    refused("1/(s-1)", "momi", &[], 3, "no design by momi");
    assert!(folder.names().is_empty());
}

#[test]
fn advise_has_a_row_for_every_method() {
    let folder = Folder::new("advise");
    let arguments = ["design", "--plant", PLANT, "--method", "advise", "--ts", "0.01"];
    let shown = folder.done(&arguments);
    assert!(shown.contains("ts = 0.01 s fits") && !shown.contains("refused"), "{shown}");
    assert!(shown.lines().all(|line| line.chars().count() <= 100), "{shown}");
    let advice = json(&folder.run(&[&arguments[..], &["--json"]].concat()));
    check(&advice);
    let rows = advice["methods"].as_array().expect("rows");
    let names: Vec<&str> = rows.iter().filter_map(|row| row["method"].as_str()).collect();
    assert_eq!(names, METHODS);
    // Vrančić & Huba 2021, figure 11 as recomputed: 0.5986/0.1806 and 0.5986/0.5317.
    let iae = |row: usize| (number(&rows[row]["iae_setpoint"]), number(&rows[row]["iae_load"]));
    for (row, expected) in [(0, (0.5986, 0.5317)), (2, (0.5986, 0.1806))] {
        let (setpoint, load) = iae(row);
        assert!((setpoint / expected.0 - 1.0).abs() < 5e-3 && (load / expected.1 - 1.0).abs() < 5e-3);
    }
    let slow = folder.done(&["design", "--plant", PLANT, "--method", "advise", "--ts", "0.1"]);
    assert!(slow.contains("ts = 0.1 s is long for"), "{slow}");
    let refused = folder.done(&["design", "--plant", "exp(-s)/s", "--method", "advise"]);
    assert!(refused.contains("refused: the plant must"), "{refused}");
}

#[test]
fn a_scenario_designs_its_controller() {
    let folder = Folder::new("design-key");
    let plain = BASE.find("[[controller]]").map_or(BASE, |at| &BASE[..at]);
    let with = |design: &str| format!("{plain}[[controller]]\nname = \"made\"\ndesign = {design}\n");
    folder.write("s.toml", &with("{ method = \"momi\", kpidn = 4.0 }"));
    let run = json(&folder.run(&["run", "s.toml", "--json"]));
    let iae = number(&run["controllers"][0]["events"][0]["metrics"]["iae"]);
    assert!((iae / 0.5986 - 1.0).abs() < 5e-3, "{iae}");
    for (design, part) in [
        ("{ method = \"momy\" }", "did you mean \"momi\"?"),
        ("{ kpidn = 4.0 }", "`design.method`"),
        ("{ method = \"momi\", kpidn = 4.0, tf = 0.1 }", "exclude each other"),
        ("{ method = \"momi\", kpidn = 0.01 }", "least attainable"),
        ("{ method = \"momi\" }\npid = { kp = 1.0 }", "exclude each other"),
        ("{ method = \"momi\", gain = 1.0 }", "unknown key `gain`"),
    ] {
        folder.write("wrong.toml", &with(design));
        let shown = folder.refused(&["run", "wrong.toml"]);
        assert!(shown.contains(part) && shown.contains("wrong.toml:"), "`{part}` is not in:\n{shown}");
    }
}
