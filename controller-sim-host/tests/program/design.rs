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
                // As in `designs.rs`: what is left after the window.
                (ie - expected).abs() <= 2e-5 * number(&metrics["iae"]),
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

/// Plants that many rules refuse, most of them for a reason of their own.
const AWKWARD: [&str; 16] = [
    "1/(1+s)",
    "exp(-2*s)",
    "1/((1+s)*(1+0.2*s))",
    "-3e4/(1+0.1*s+s^2)",
    "1/(s-1)",
    "exp(-0.2*s)/(s-1)",
    "-2/s",
    "exp(-s)/s",
    "1/s^2",
    "s/(1+s)^2",
    "(1+s)/(1+2*s)",
    "3*exp(-50*s)/(1+s)",
    "exp(-1e-7*s)/(1+2e-7*s+1e-12*s^2)",
    "(1+10*s)*exp(-0.1*s)/((1+s)*(1+0.2*s))",
    "exp(-0.01*s)/(1+s)",
    "(1-3*s)/(1+s)^2",
];
/// What no rule can do anything with.
const HOPELESS: [&str; 4] = ["1/(s-1)", "exp(-0.2*s)/(s-1)", "1/s^2", "s/(1+s)^2"];

/// What the help of a refusal names, in the words of the command line.
fn named(help: &str) -> Vec<Vec<&str>> {
    let quoted = help.split('`').skip(1).step_by(2);
    quoted.filter(|part| part.starts_with("--method ")).map(|part| part.split(' ').collect()).collect()
}

/// Every method and option that a refusal names gives a robust loop; nothing is named otherwise.
#[test]
fn the_help_of_a_refusal_helps() {
    let folder = Folder::new("design-help");
    let mut followed = 0;
    let mut known: Vec<(&str, Vec<String>)> = Vec::new();
    for plant in AWKWARD {
        for (method, more) in METHODS.map(|method| (method, None)).into_iter().chain([("momi", Some("4"))]) {
            let kpidn = more.map_or(vec![], |gain| vec!["--kpidn", gain]);
            let base = ["design", "--plant", plant, "--json"];
            let output = folder.run(&[&base[..], &["--method", method], &kpidn].concat());
            if output.status.code() == Some(0) {
                continue;
            }
            assert_eq!(output.status.code(), Some(3), "{plant} {method}");
            let error = json(&output);
            let (message, help) = (&error["error"]["message"], error["error"]["help"].as_str().unwrap_or(""));
            assert!(!message.to_string().contains("tau = -"), "{message}");
            let ways = named(help);
            assert_eq!(ways.is_empty(), HOPELESS.contains(&plant), "{plant} {method}: {help}");
            // The words before speak of no method by its name.
            let words = help.split("; on this plant").next().unwrap_or("").replace([',', ';', ':'], " ");
            assert!(words.split(' ').all(|word| !METHODS.contains(&word)), "{plant} {method}: {help}");
            for way in ways {
                let way: Vec<String> = way.into_iter().map(str::to_owned).collect();
                if known.contains(&(plant, way.clone())) {
                    continue;
                }
                let way_str: Vec<&str> = way.iter().map(String::as_str).collect();
                let made = folder.run(&[&base[..], &way_str].concat());
                assert_eq!(made.status.code(), Some(0), "{plant} {method}: {help}");
                let ms = number(&json(&made)["discrete"]["robustness"]["ms"]);
                assert!(ms <= 2.0, "{plant} {method}: {way:?} gives {ms}");
                followed += 1;
                known.push((plant, way));
            }
        }
    }
    assert!(followed >= 20, "{followed}");
}

/// The least index that can be had, or a little more, is named in the words of the command line.
#[test]
fn a_wish_that_is_refused_comes_back_as_one_that_works() {
    let folder = Folder::new("design-want");
    let base = ["design", "--plant", "exp(-s)/(1+2*s)^2", "--method", "dob", "--json"];
    for index in ["iae", "ise", "e_max", "ramp_ie"] {
        let error = json(&folder.run(&[&base[..], &["--want", &format!("{index}=0.0001")]].concat()));
        let help = error["error"]["help"].as_str().unwrap_or("");
        let ways = named(help);
        let way =
            ways.iter().find(|way| way.contains(&"--want")).unwrap_or_else(|| panic!("{index}: {error}"));
        assert!(way[3].starts_with(&format!("{index}=")), "{help}");
        let made = folder.run(&[&["design", "--plant", "exp(-s)/(1+2*s)^2", "--json"][..], way].concat());
        assert_eq!(made.status.code(), Some(0), "{help}");
        assert!(number(&json(&made)["discrete"]["robustness"]["ms"]) <= 2.0, "{help}");
    }
}

/// A given option is used or named as not used, and ADRC's searched gain can be had alone.
#[test]
fn advise_says_who_used_an_option() {
    let folder = Folder::new("advise-options");
    let base = ["design", "--plant", PLANT, "--ts", "0.01", "--method"];
    let shown = folder.done(&[&base[..], &["advise", "--kpidn", "3", "--ms", "1.4"]].concat());
    assert!(shown.contains("kpidn is used by momi, drmo, de-momi, ah, amigo, simc only"), "{shown}");
    assert!(shown.contains("ms is used by pi-ms, dob, ah, adrc only"), "{shown}");
    let advice = json(&folder.run(&[&base[..], &["advise", "--kpidn", "3", "--json"]].concat()));
    for row in advice["methods"].as_array().expect("rows") {
        let method = row["method"].as_str().expect("a name");
        if ["momi", "ah", "amigo", "simc"].contains(&method) {
            let kpidn = number(&row["design"]["noise"]["kpidn"]);
            assert!((kpidn / 3.0 - 1.0).abs() < 1e-6, "{method}: {kpidn}");
        }
    }
    let row = &advice["methods"][7];
    let alone = |more: &[&str]| json(&folder.run(&[&base[..], &["adrc", "--json"], more].concat()));
    let (searched, plain) = (alone(&["--b0", "search"]), alone(&[]));
    assert_eq!(row["design"]["adrc"], searched["adrc"]);
    // The model's: 1/0.2.
    assert!((number(&plain["adrc"]["b0"]) - 5.0).abs() < 1e-9, "{plain}");
    let load = |made: &Value| number(&made["predicted"]["ie_load"]).abs();
    assert!(load(&searched) < 0.2 * load(&plain));
    assert!(number(&searched["robustness"]["ms"]) <= 1.6);
    let again = alone(&["--b0", &searched["adrc"]["b0"].to_string()]);
    assert!((number(&again["adrc"]["kp"]) / number(&searched["adrc"]["kp"]) - 1.0).abs() < 0.25);
    let shown = folder.refused(&[&base[..], &["adrc", "--b0", "-5"]].concat());
    assert!(shown.contains("b0 = -5 is outside"), "{shown}");
}

#[test]
fn advise_has_a_row_for_every_method() {
    let folder = Folder::new("advise");
    let arguments = ["design", "--plant", PLANT, "--method", "advise", "--ts", "0.01"];
    let shown = folder.done(&arguments);
    assert!(shown.contains("ts = 0.01 s fits") && !shown.contains("refused"), "{shown}");
    assert!(shown.contains("times the noise gain of pi-ms, the least"), "{shown}");
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

/// The rule's optimum is that of the continuous loop; the design says the figure of the run, too.
#[test]
fn the_least_iae_is_that_of_the_run() {
    let folder = Folder::new("design-iae");
    for (index, plant) in ["2*exp(-0.3*s)/(1+0.9*s)", "-0.5*exp(-s)/s"].into_iter().enumerate() {
        let file = format!("{index}.toml");
        let arguments = ["design", "--plant", plant, "--method", "pi-iae", "--ts", "0.02"];
        let made = json(&folder.run(&[&arguments[..], &["--save", &file, "--json"]].concat()));
        check(&made);
        let run = json(&folder.run(&["run", &file, "--json"]));
        let iae = number(&run["controllers"][0]["events"][1]["metrics"]["iae"]);
        assert!((number(&made["predicted"]["iae_load"]) / iae - 1.0).abs() < 1e-3, "{made}");
        let more = iae / number(&made["predicted"]["iae_load_continuous"]);
        assert!(more > 1.005 && more < 1.2, "{plant}: {more}");
        let shown = folder.done(&arguments);
        assert!(shown.contains("of the continuous loop"), "{shown}");
    }
}

/// What is compared after a cut window is marked.
#[test]
fn a_comparison_of_cut_windows_says_so() {
    let folder = Folder::new("design-cut");
    let arguments = ["design", "--plant", "1/((1+s)*(1+0.5*s))", "--ts", "5e-5", "--method", "advise"];
    let made = json(&folder.run(&[&arguments[..], &["--json"]].concat()));
    check(&made);
    let methods = made["methods"].as_array().expect("methods");
    let cut = methods.iter().filter(|row| row["warnings"].to_string().contains("is simulated for"));
    assert!(cut.count() > 0, "{made}");
    let shown = folder.done(&arguments);
    assert!(shown.contains("* may lack a part"), "{shown}");
}
