//! Loop cards on the command line: printed, on a page, saved, held against a loop.

use crate::folder::{Folder, json, keys, text};
use serde_json::Value;

const LOOP: &str = r#"version = 1
ts = 0.05
duration = 40.0
latency = 0.01
[plant]
tf = "2*exp(-0.5*s)/((1+0.2*s)*(1+5*s))"
[[event]]
at = 0.0
setpoint = 10.0
[[event]]
at = 20.0
disturbance = 2.0
[[controller]]
name = "PI"
pid = { kp = 1.5, ki = 0.35 }
limits = { lo = 0.0, hi = 30.0 }
"#;

/// Every figure that this loop has.
const FIGURES: &str = "ms mt gm pm_deg delay_margin jitter_margin ki noise_gain noise_std noise_tv smallest_error limit_recovery limit_overshoot ram instructions";

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("loop.toml", LOOP);
    folder
}

fn list<'a>(value: &'a Value, key: &str) -> Vec<&'a str> {
    value.as_array().expect("a list").iter().map(|one| one[key].as_str().expect("a text")).collect()
}

#[test]
fn a_card_is_printed_and_documented() {
    let folder = folder("card-printed");
    let shown = folder.done(&["analyze", "loop.toml", "--card"]);
    assert!(shown.contains("loop card of PI, f32, mps2-an386 (Cortex-M4F): "), "{shown}");
    assert!(shown.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{shown}");
    let analysis = json(&folder.run(&["analyze", "loop.toml", "--card", "--json"]));
    let card = &analysis["controllers"][0]["card"];
    assert_eq!(keys(card).join(" "), "precision board core good look bad figures absent");
    assert_eq!(list(&card["figures"], "key").join(" "), FIGURES);
    for figure in card["figures"].as_array().expect("a list") {
        assert!(!figure["practice"].as_str().expect("a text").is_empty(), "{figure}");
    }
    let lights = list(&card["figures"], "light");
    assert_eq!(card["good"], lights.iter().filter(|light| **light == "good").count());
    // Without being asked for there is none.
    assert!(json(&folder.run(&["analyze", "loop.toml", "--json"]))["controllers"][0].get("card").is_none());
}

/// The number type and the board change what they must, and nothing else.
#[test]
fn precision_and_board_are_those_asked_for() {
    let folder = folder("card-boards");
    let card = |more: &[&str]| {
        let arguments = [&["analyze", "loop.toml", "--card", "--json"], more].concat();
        json(&folder.run(&arguments))["controllers"][0]["card"].clone()
    };
    let value = |card: &Value, key: &str| {
        let figures = card["figures"].as_array().expect("a list");
        let figure = figures.iter().find(|figure| figure["key"] == key).expect("a figure");
        figure["value"].as_f64().expect("a number")
    };
    let (single, double) = (card(&[]), card(&["--precision", "f64"]));
    assert_eq!((value(&single, "ram"), value(&double, "ram")), (252.0, 488.0));
    assert!((value(&single, "ms") / value(&double, "ms") - 1.0).abs() < 1e-6);
    // A unit in the last place of the set-point, 10, in either type.
    let places = [(&single, f64::from(f32::EPSILON)), (&double, f64::EPSILON)];
    for (card, eps) in places {
        assert_eq!(value(card, "smallest_error"), 8.0 * eps);
    }
    let small = card(&["--board", "microbit"]);
    // The table of instructions, which its own rung measures, has them in the fifth column.
    let costs = include_str!("../../src/card/costs.csv");
    let row = costs.lines().find(|row| row.starts_with("microbit,loop-pid,f32,")).expect("a row");
    let most: f64 = row.split(',').nth(4).expect("a column").parse().expect("a number");
    assert_eq!((small["core"].as_str(), value(&small, "instructions")), (Some("Cortex-M0"), most));
    assert!(folder.refused(&["analyze", "loop.toml", "--card", "--board", "mps2"]).contains("mps2-an386"));
}

#[test]
fn a_saved_card_holds_until_the_loop_gets_worse() {
    let folder = folder("card-held");
    let shown = folder.done(&["analyze", "loop.toml", "--save-card", "card.toml"]);
    assert!(shown.contains("wrote card.toml"), "{shown}");
    assert!(folder.refused(&["analyze", "loop.toml", "--save-card", "card.toml"]).contains("--force"));
    let shown = folder.done(&["analyze", "loop.toml", "--check", "card.toml"]);
    assert!(shown.ends_with("the loop keeps its card\n"), "{shown}");
    let held = json(&folder.run(&["analyze", "loop.toml", "--check", "card.toml", "--json"]));
    assert_eq!(keys(&held["check"]).join(" "), "card holds figures unchecked");
    assert_eq!(list(&held["check"]["figures"], "key").join(" "), FIGURES);
    assert_eq!(held["check"]["unchecked"], Value::Array(Vec::new()));

    // A tenth of a second later: the margins shrink.
    let late = ["analyze", "loop.toml", "--check", "card.toml", "--set", "latency=0.1"];
    let output = folder.run(&late);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(4), ""));
    let shown = text(&output.stdout);
    let line = |key: &str| shown.lines().find(|line| line.trim_start().starts_with(key)).expect("a line");
    assert!(line("delay_margin").ends_with("WORSE") && line("ram").ends_with("holds"), "{shown}");
    assert!(shown.lines().all(|line| line.chars().count() <= 100), "{shown}");
    let output = folder.run(&[&late[..], &["--json"]].concat());
    assert_eq!((output.status.code(), json(&output)["check"]["holds"].as_bool()), (Some(4), Some(false)));
    // A loop without stability has no figures to be held.
    let output =
        folder.run(&["analyze", "loop.toml", "--check", "card.toml", "--set", "controller.PI.pid.kp=20"]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
}

/// Bounds are a person's: changed, taken away, left alone.
#[test]
fn bounds_are_what_the_file_says() {
    let folder = folder("card-bounds");
    let head = "version = 1\ncontroller = \"PI\"\nprecision = \"f32\"\nboard = \"mps2-an386\"\n[figures]\n";
    let check = |figures: &str| {
        folder.write("card.toml", &format!("{head}{figures}"));
        let output = folder.run(&["analyze", "loop.toml", "--check", "card.toml", "--json"]);
        (output.status.code(), json(&output)["check"].clone())
    };
    let (code, held) = check("ms = { max = 1.9 }\n");
    assert_eq!((code, &held["figures"][0]["was"]), (Some(0), &Value::Null));
    assert_eq!(held["unchecked"].as_array().expect("a list").len(), FIGURES.split(' ').count() - 1);
    assert_eq!(check("ms = { max = 1.1 }\n").0, Some(4));
    assert_eq!(check("ms = { min = 1.9 }\n").0, Some(4));
    assert_eq!(check("ms = { was = 3.0 }\ngm = { min = 2, max = inf }\n").0, Some(0));
    // The loop is stable with every smaller gain: what the card asks for is missing, and is named.
    let (code, held) = check("gm_low = { max = 0.5 }\nms = { max = 1.9 }\n");
    assert_eq!((code, &held["figures"][1]["key"]), (Some(4), &Value::String("gm_low".into())));
    assert!(held["figures"][1]["is"].is_null() && held["figures"][1]["why"].is_string(), "{held}");
}

#[test]
fn mistakes_in_a_card_are_shown_with_their_place() {
    let folder = folder("card-mistakes");
    let good = "version = 1\ncontroller = \"PI\"\nprecision = \"f32\"\nboard = \"mps2-an386\"\n[figures]\nms = { max = 1.9 }\n";
    let refused = |text: &str| {
        folder.write("card.toml", text);
        folder.refused(&["analyze", "loop.toml", "--check", "card.toml"])
    };
    for (old, new, part) in [
        ("ms =", "msx =", "did you mean `ms`?"),
        ("max =", "maxx =", "did you mean `max`?"),
        ("version = 1", "version = 2", "reads version 1"),
        ("version = 1\n", "", "has no `version`"),
        ("\"f32\"", "\"f16\"", "allowed: f32, f64"),
        ("mps2-an386", "arduino", "microbit"),
        ("1.9", "\"1.9\"", "must be a number"),
        ("1.9", "nan", "is not a number"),
        ("{ max = 1.9 }", "1.9", "`min` or `max`"),
        ("max = 1.9", "min = 2.0, max = 1.9", "nothing fits"),
        ("ms = { max = 1.9 }\n", "", "no figure to check"),
        ("[figures]", "figures]", "card.toml"),
        ("ms = { max = 1.9 }", "ms = { max = 1.9 }\nms = { max = 1.8 }", "duplicate"),
        ("\"PI\"", "\"PID\"", "which is not in the file"),
        ("\"PI\"", "7", "a text in quotes"),
    ] {
        let message = refused(&good.replace(old, new));
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
    let message = refused(&good.replace("ms =", "msx ="));
    assert!(message.contains("card.toml:6") && message.contains('^'), "{message}");
    // All of them at once.
    let message = refused(&good.replace("ms =", "msx =").replace("f32", "f16"));
    assert!(message.contains("msx") && message.contains("f16"), "{message}");
    for (arguments, part) in [
        (&["--check", "none.toml"][..], "--save-card"),
        (&["--check", "-"], "--check card.toml"),
        (&["--save-card", "-"], "--save-card card.toml"),
        (&["--save-card", "loop.toml", "--force"], "not overwritten"),
        (&["--save-card", "a.x", "--report", "a.x"], "the same file"),
    ] {
        let message = folder.refused(&[&["analyze", "loop.toml"], arguments].concat());
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
    folder.write("card.toml", good);
    let message = folder.refused(&["analyze", "loop.toml", "--check", "card.toml", "--precision", "f64"]);
    assert!(message.contains("--precision f64"), "{message}");
}

#[test]
fn a_card_is_of_one_loop() {
    let folder = folder("card-several");
    let second = "[[controller]]\nname = \"P\"\npid = { kp = 0.5 }\n";
    folder.write("two.toml", &format!("{LOOP}{second}"));
    let message = folder.refused(&["analyze", "two.toml", "--save-card", "card.toml"]);
    assert!(message.contains("`PI`, `P`") && message.contains("--controller"), "{message}");
    folder.done(&["analyze", "two.toml", "--save-card", "card.toml", "--controller", "P"]);
    let card = folder.read("card.toml");
    assert!(card.contains("controller = \"P\"") && card.contains("# ki: "), "{card}");
    // Nothing limits the phase of a loop gain below 1: its margins have good ones as bounds.
    assert!(card.contains("pm_deg = { was = inf, min = 60 }"), "{card}");
    folder.done(&["analyze", "two.toml", "--check", "card.toml"]);
    folder.write("swept.toml", &format!("{LOOP}[sweep]\nkey = \"latency\"\nvalues = [0.0, 0.1]\n"));
    assert!(folder.refused(&["analyze", "swept.toml", "--save-card", "c.toml"]).contains("sweep"));
    assert!(folder.refused(&["analyze", "swept.toml", "--check", "card.toml"]).contains("sweep"));
}

#[test]
fn the_page_has_the_card_in_words_and_marks() {
    let folder = folder("card-page");
    folder.done(&["analyze", "loop.toml", "--report", "r.html"]);
    let page = folder.read("r.html");
    for part in [
        "Loop card",
        "jitter margin",
        "Step of set-point and load",
        "At the limits of the output",
        "Noise at rest",
        "Nyquist plot",
        "Liu &amp; Layland",
    ] {
        assert!(page.contains(part), "`{part}`");
    }
    let lights = page.matches("class=\"light ").count();
    assert_eq!(lights, FIGURES.split(' ').count());
    for light in page.split("class=\"light ").skip(1) {
        let word = light.split('"').next().expect("a class");
        assert!(light.contains("<path") && light.contains(&format!("</svg>{word}</span>")), "{word}");
    }
}
