//! `assess`: verdicts on simulated experiments, records of other shapes, the page.

use crate::folder::{Folder, json, keys, text};
use serde_json::Value;

/// A folder with the record of the built-in experiment.
fn experiment(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.done(&["demo", "load-experiment", "--csv", "loop.csv", "--quiet"]);
    folder
}

fn assess(folder: &Folder, arguments: &[&str]) -> (Option<i32>, Value) {
    let output = folder.run(&[&["assess"], arguments, &["--json"]].concat());
    assert_eq!(text(&output.stderr), "");
    (output.status.code(), json(&output))
}

/// Time, set-point, measurement and output of one controller, from the record of several.
fn rows(folder: &Folder, controller: &str) -> Vec<[String; 4]> {
    let record = folder.read("loop.csv");
    let own = record.lines().filter(|line| line.starts_with(&format!("{controller},")));
    own.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        [1, 2, 3, 4].map(|k| cells[k].to_owned())
    })
    .collect()
}

#[test]
fn the_built_in_experiment_from_the_run_to_the_verdict() {
    let folder = experiment("assess-chain");
    for (controller, verdict, advice) in [
        ("well tuned", "near-optimal", [Value::Null, Value::Null]),
        ("ti too short", "aggressive", [Value::Null, "raise".into()]),
        ("gain too low", "sluggish", ["raise".into(), Value::Null]),
    ] {
        let (code, found) = assess(&folder, &["loop.csv", "--controller", controller]);
        assert_eq!((code, &found["verdict"]), (Some(0), &verdict.into()), "{found:#}");
        let expected = "version data verdict reasons advice features step_at auto_at files warnings";
        assert_eq!(keys(&found).join(" "), expected);
        assert_eq!(keys(&found["features"]), ["p1", "t1", "dip", "t_ratio", "r3", "sigma"]);
        assert_eq!((&found["step_at"], &found["auto_at"]), (&60.0.into(), &70.0.into()));
        assert_eq!(found["data"], format!("loop.csv, {controller}"));
        let sigma = found["features"]["sigma"].as_f64().expect("a number");
        assert!((0.025..0.035).contains(&sigma), "{sigma}");
        // An aggressive loop may have a high third peak, too, a sluggish one a dip that is none.
        let found = [&found["advice"]["kp"], &found["advice"]["ti"]];
        assert!(advice.iter().zip(found).all(|(asked, own)| asked.is_null() || asked == own), "{found:?}");
        let shown = folder.done(&["assess", "loop.csv", "--controller", controller]);
        assert!(shown.starts_with(&format!("loop.csv, {controller}: {verdict}\n")), "{shown}");
        assert!(shown.lines().all(|line| line.chars().count() <= 110), "{shown}");
    }
    assert_eq!(folder.names(), ["loop.csv"]);
}

#[test]
fn one_controller_of_several_has_to_be_chosen() {
    let folder = experiment("assess-several");
    let shown = folder.refused(&["assess", "loop.csv"]);
    assert!(shown.contains("3 controllers") && shown.contains("\"gain too low\""), "{shown}");
    let shown = folder.refused(&["assess", "loop.csv", "--controller", "wel tuned"]);
    assert!(shown.contains("did you mean \"well tuned\"?"), "{shown}");
}

/// As a logger writes it: other names, decimal commas, a line of units, the columns in another order.
#[test]
fn records_of_loggers() {
    let folder = experiment("assess-logger");
    let mut log = String::from("Zeit;Ventil OP;Temperatur PV;Sollwert\ns;%;degC;degC\n");
    for [t, r, y, u] in rows(&folder, "well tuned") {
        log.push_str(&format!("{t};{u};{y};{r}\n").replace('.', ","));
    }
    folder.write("log.csv", &log);
    let (code, found) = assess(&folder, &["log.csv"]);
    assert_eq!((code, &found["verdict"]), (Some(0), &"near-optimal".into()), "{found:#}");
    assert_eq!((&found["data"], &found["step_at"]), (&"log.csv".into(), &60.0.into()));
    let columns = ["--time", "1", "--input", "Ventil OP", "--output", "3", "--setpoint", "Sollwert"];
    let said = ["--step-at", "61", "--auto-at", "70"];
    let (code, same) = assess(&folder, &[&["log.csv"][..], &columns, &said].concat());
    assert_eq!((code, &same["features"]), (Some(0), &found["features"]));
    let shown = folder.refused(&["assess", "log.csv", "--output", "Temperature"]);
    assert!(shown.contains("no column `Temperature`"), "{shown}");
    let shown = folder.refused(&["assess", "log.csv", "--step-at", "6000"]);
    assert!(shown.contains("it lasts from 0 s to"), "{shown}");
    let shown = folder.refused(&["assess", "none.csv"]);
    assert!(shown.contains("cannot read `none.csv`"), "{shown}");
    let shown = folder.refused(&["assess", "log.csv", "--controller", "PI"]);
    assert!(shown.contains("no controllers"), "{shown}");
}

#[test]
fn a_record_that_does_not_tell_ends_with_3_and_the_reason() {
    let folder = experiment("assess-unclear");
    let record = folder.read("loop.csv");
    // 40 s after the step.
    let short: String = record.lines().take(1 + 200).map(|line| format!("{line}\n")).collect();
    folder.write("short.csv", &short);
    let (code, found) = assess(&folder, &["short.csv", "--report", "short.html"]);
    assert_eq!((code, &found["verdict"]), (Some(3), &"inconclusive".into()), "{found:#}");
    assert_eq!(found["reasons"][0]["code"], "record-short");
    assert_eq!(
        (&found["error"]["code"], &found["error"]["places"]),
        (&"inconclusive".into(), &Value::Array(vec![]))
    );
    assert_eq!(found["error"]["message"], found["reasons"][0]["message"]);
    assert!(folder.read("short.html").contains("inconclusive"), "the picture helps to see why");
    let output = folder.run(&["assess", "short.csv"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(&output.stdout).starts_with("short.csv: inconclusive\n"), "{}", text(&output.stdout));
    let message = text(&output.stderr);
    assert!(
        message.contains("error[inconclusive]: the record ends") && message.contains("help: record"),
        "{message}"
    );
    // Back in automatic when the measurement has gone: the modes of the record say when.
    let late = ["--set", "event.2.at=115.0", "--csv", "late.csv", "--quiet"];
    folder.done(&[&["demo", "load-experiment"], &late[..]].concat());
    let (code, found) = assess(&folder, &["late.csv", "--controller", "well tuned"]);
    assert_eq!((code, &found["reasons"][0]["code"]), (Some(3), &"auto-too-late".into()), "{found:#}");
    assert_eq!(found["auto_at"], 115.0);
    // No experiment at all.
    folder.write("flat.csv", "t,r,y,u\n0,1,1,2\n1,1,1,2\n2,1,1,2\n");
    assert_eq!(assess(&folder, &["flat.csv"]).1["reasons"][0]["code"], "no-step");
    let rows: String = (0..30).map(|row| format!("1,{},2\n", 1.0 + 0.01 * f64::from(row % 3))).collect();
    folder.write("flat.csv", &format!("r,y,u\n{rows}"));
    let output = folder.run(&["assess", "flat.csv", "--log-ts", "0.5"]);
    assert_eq!(output.status.code(), Some(3));
    let shown = text(&output.stderr);
    assert!(shown.contains("the output of the controller is the same in the whole record"), "{shown}");
    assert!(shown.contains("step the output"), "{shown}");
}

/// A process with negative gain: the same verdict, and the gain is to be changed in size.
#[test]
fn the_words_of_a_reverse_loop() {
    let folder = experiment("assess-reverse");
    let rows: String = rows(&folder, "gain too low")
        .iter()
        .map(|[t, r, y, u]| {
            let y: f64 = y.parse().expect("a number");
            let r: f64 = r.parse().expect("a number");
            format!("{t},{},{},{u}\n", 100.0 - r, 100.0 - y)
        })
        .collect();
    folder.write("reverse.csv", &format!("t,r,y,u\n{rows}"));
    let shown =
        folder.done(&["assess", "reverse.csv", "--step-at", "60", "--auto-at", "70", "--report", "r.html"]);
    assert!(shown.contains("sluggish") && shown.contains("make the negative gain larger in size"), "{shown}");
    let page = folder.read("r.html");
    assert!(
        page.contains("below the mean before the step") != page.contains("above the mean before the step")
    );
}

#[test]
fn the_page_shows_the_response_and_needs_nothing_else() {
    let folder = experiment("assess-page");
    let arguments = ["loop.csv", "--controller", "well tuned", "--report", "my.html"];
    let (code, found) = assess(&folder, &arguments);
    assert_eq!(code, Some(0));
    assert_eq!(found["files"], serde_json::json!([{ "kind": "report", "path": "my.html" }]));
    let page = folder.read("my.html");
    for part in [
        "<h1>loop.csv, well tuned: near-optimal</h1>",
        ">P1<",
        ">dip<",
        ">P3<",
        "class=\"target\"",
        "class=\"window\"",
        "-0.18 to 0.00",
        "1.85 to 2.30",
        "at most 0.30",
        "controller-sim assess loop.csv --controller 'well tuned' --report my.html",
    ] {
        assert!(page.contains(part), "`{part}` is not in the page");
    }
    for outside in ["http://", "https://", "<script", "<link", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.len() < 200_000 && !page.contains("NaN"), "{}", page.len());
    let shown = folder.refused(&[&["assess"], &arguments[..]].concat());
    assert!(shown.contains("exists and is not overwritten"), "{shown}");
    let shown = folder.done(&[&["assess"], &arguments[..], &["--force"]].concat());
    assert!(shown.contains("\nwrote my.html: open it by: "), "{shown}");
    assert_eq!(folder.read("my.html").replace(" --force", " --json"), page, "the same bytes twice");
    let shown = folder.refused(&[
        "assess",
        "loop.csv",
        "--controller",
        "well tuned",
        "--report",
        "loop.csv",
        "--force",
    ]);
    assert!(shown.contains("is the record itself"), "{shown}");
}
