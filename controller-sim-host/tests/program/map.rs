//! `batch map`: its numbers against independent ones, files that do not depend on how they were made, holes, mistakes, pictures.

use crate::folder::{Folder, json, text};
use serde_json::Value;

/// Made by `tests/golden/make_map.py`, which shares nothing with this library.
const GOLDEN: &str = include_str!("../data/map.csv");

/// The maps of the golden points: ratios over the PI alone.
const METRICS: [&str; 7] = ["load_iae", "load_ise", "load_itae", "load_e_max", "load_tv", "ms", "a_n"];

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[test]
fn points_are_those_of_an_independent_computation() {
    let folder = Folder::new("map-golden");
    let metrics = METRICS.join(",");
    let base = [
        "batch",
        "map",
        "--x",
        "L=0.05,0.2,0.5,0.9",
        "--y",
        "alpha_ratio=0.1,1,10:log",
        "--each",
        "ms=1.2,2",
        "--over",
        "pi-ms",
        "--metric",
        &metrics,
        "--json",
    ];
    let mut compared = 0;
    for horizon in [None, Some("4")] {
        let more: Vec<&str> = horizon.iter().flat_map(|end| ["--horizon", end]).collect();
        let made = json(&folder.run(&[&base[..], &more].concat()));
        assert_eq!(made["counts"], serde_json::json!({ "ok": 48, "refused": 0, "failed": 0 }));
        let wanted = horizon.unwrap_or("0");
        let rows = GOLDEN.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
        for row in rows.filter(|row| row[3] == wanted) {
            let at = |axis: &str, cell: &str| {
                let wanted: f64 = cell.parse().expect("a number");
                let values = numbers(&made[axis]["values"]);
                values.iter().position(|x| (x - wanted).abs() < 1e-12).expect("on the grid")
            };
            let (x, y, each) = (at("x", row[0]), at("y", row[1]), at("each", row[2]));
            for (k, name) in METRICS.iter().enumerate() {
                let panel = &made["panels"][2 * k + each];
                assert_eq!(panel["metric"], *name);
                let ours = panel["values"][y][x].as_f64().expect("a number");
                let truth: f64 = row[6 + k].parse().expect("a number");
                // Of the reference: indices 0.3 %, TV 0.5 %, Ms 0.05 % of two; kp is flat around the optimum, A_n goes with it.
                let tolerance = [3e-3, 3e-3, 3e-3, 3e-3, 5e-3, 1e-3, 5e-3][k];
                let name = format!("{row:?} {name}");
                assert!((ours / truth - 1.0).abs() <= tolerance, "{name}: {ours} against {truth}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 7 * (GOLDEN.lines().count() - 1));
}

const STUDY: [&str; 12] = [
    "batch",
    "map",
    "--plant",
    "exp(-T*s)/(1+s)^n",
    "--x",
    "T=0.1:0.9:3",
    "--y",
    "n=1:3:3",
    "--each",
    "ms=1.3,1.8",
    "--over",
    "pi-ms",
];

/// Threads, shards and interruptions change no byte of the rows, and pictures come from a file as from a computation.
#[test]
fn files_do_not_depend_on_how_they_were_made() {
    let folder = Folder::new("map-bytes");
    let run = |more: &[&str]| folder.done(&[&STUDY[..], more].concat());
    for kind in ["csv", "parquet"] {
        let name = |stem: &str| format!("{stem}.{kind}");
        run(&["--jobs", "1", "--out", &name("one"), "--svg", &format!("one-{kind}.svg")]);
        run(&["--jobs", "3", "--out", &name("two")]);
        let whole = folder.bytes(&name("one"));
        assert!(whole == folder.bytes(&name("two")), "{kind}: threads");
        let parts: Vec<String> = (1..=5).map(|i| name(&format!("part{i}"))).collect();
        for (i, part) in parts.iter().enumerate() {
            run(&["--shard", &format!("{}/5", i + 1), "--out", part]);
        }
        let order = [&parts[3], &parts[0], &parts[4], &parts[2], &parts[1]];
        let merged = name("merged");
        let mut command = vec!["batch", "merge", "--out", &merged];
        command.extend(order.map(|part| part.as_str()));
        folder.done(&command);
        assert!(whole == folder.bytes(&merged), "{kind}: shards");
        let again = format!("again-{kind}.svg");
        let shown = run(&["--out", &merged, "--resume", "--svg", &again]);
        assert!(shown.contains("36 rows, 36 of them kept"), "{shown}");
        assert!(folder.bytes(&again) == folder.bytes(&format!("one-{kind}.svg")), "{kind}: pictures");
    }
    let whole = folder.read("one.csv");
    let head = whole.lines().next().expect("a line");
    assert!(head.ends_with("load_tv,x_name,x,y_name,y,each_name,each,horizon"), "{head}");
    let mut reader = csv::Reader::from_reader(whole.as_bytes());
    let first = reader.records().next().expect("a row").expect("cells");
    assert_eq!((&first[2], &first[4], &first[39], &first[40]), ("exp(-(0.1)*s)/(1+s)^1", "dob", "T", "0.1"));
    for cut in [0, 7, whole.len() / 2, whole.len() - 1] {
        folder.write("cut.csv", &whole[..cut]);
        run(&["--out", "cut.csv", "--resume"]);
        assert!(whole == folder.read("cut.csv"), "cut at {cut}");
    }
    // Neither another map nor a study of plants goes on with it.
    for wrong in [&["--horizon", "3"][..], &["--at", "latency=1"], &["--ts", "0.01"]] {
        let output = folder.run(&[&STUDY[..], wrong, &["--out", "one.csv", "--resume"]].concat());
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
        assert!(whole == folder.read("one.csv"));
    }
    let study = ["batch", "--set", "ah134", "--methods", "simc", "--out", "one.csv", "--resume"];
    assert!(folder.refused(&study).contains("another study"));
}

/// The axes of the plant and of the rule may stand in any order: the same points have the same values.
#[test]
fn axes_may_be_exchanged() {
    let folder = Folder::new("map-axes");
    let (plant, rule) = ("L=0.2,0.5,0.7", "noise_ratio=1.5,3");
    let values = |x: &str, y: &str| -> Vec<Vec<f64>> {
        let made = json(&folder.run(&["batch", "map", "--x", x, "--y", y, "--at", "ms=1.4", "--json"]));
        made["panels"][0]["values"].as_array().expect("rows").iter().map(numbers).collect()
    };
    let (one, other) = (values(plant, rule), values(rule, plant));
    assert_eq!((one.len(), other.len()), (2, 3));
    for (j, row) in one.iter().enumerate() {
        row.iter().enumerate().for_each(|(i, value)| assert_eq!(*value, other[i][j]));
    }
    // A map is a batch: one of its points by `batch`.
    folder.write("list.csv", "name,plant\na,exp(-0.5*s)/(1+0.5*s)\n");
    let list = ["batch", "--processes", "list.csv", "--methods", "dob", "--noise-ratio", "3", "--json"];
    let row = &json(&folder.run(&list))["results"][0];
    assert_eq!(row["load_iae"].as_f64(), Some(one[1][1]));
}

/// What a rule refuses is a hole, with its reason, and the map goes on.
#[test]
fn holes_are_counted_and_explained() {
    let folder = Folder::new("map-holes");
    let base = ["batch", "map", "--method", "pi-ms", "--metric", "load_iae,gm", "--at", "ms=1.5"];
    let plant = ["--plant", "exp(-T*s)/(1+s)^n", "--x", "T=0,0.5", "--y", "n=1,1.5,2"];
    let made = json(
        &folder.run(&[&base[..], &plant, &["--json", "--report", "map.html", "--svg", "map.svg"]].concat()),
    );
    // Without dead time and with one lag ki is unbounded; 1.5 lags are no plant.
    assert_eq!(made["counts"], serde_json::json!({ "ok": 3, "refused": 3, "failed": 0 }), "{made}");
    let iae = &made["panels"][0];
    assert_eq!(iae["holes"], 3);
    assert!(iae["values"][0][0].is_null() && iae["values"][1][1].is_null() && iae["values"][2][0].is_f64());
    let reasons: Vec<&str> = made["holes"]
        .as_array()
        .expect("reasons")
        .iter()
        .map(|h| h["reason"].as_str().expect("a text"))
        .collect();
    assert!(reasons.iter().any(|why| why.contains("without bound")), "{reasons:?}");
    assert!(reasons.iter().any(|why| why.starts_with("the plant cannot be read: ")), "{reasons:?}");
    let (page, picture) = (folder.read("map.html"), folder.read("map.svg"));
    for part in
        ["3 holes (grey)", "class=\"hole\"", "the plant cannot be read", "infinite horizon", "ms = 1.5"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(picture.contains("3 holes (grey)") && picture.contains("infinite horizon"), "{picture}");
    roxmltree::Document::parse(&picture).expect("XML");
    // Nowhere a result: the exit code says so.
    let output = folder.run(&[
        "batch",
        "map",
        "--method",
        "pi-ms",
        "--plant",
        "exp(-T*s)/(1-s)",
        "--x",
        "T=1,2",
        "--y",
        "ms=1.2,1.5",
    ]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("4 rows: 0 ok, 4 refused"), "{}", text(&output.stdout));
    // A horizon is for laws with exact responses.
    let output = folder.run(&[
        "batch",
        "map",
        "--method",
        "adrc",
        "--x",
        "L=0.3,0.5",
        "--y",
        "ms=1.5,1.7",
        "--horizon",
        "5",
        "--json",
    ]);
    assert_eq!((output.status.code(), json(&output)["counts"]["failed"].as_u64()), (Some(3), Some(4)));
}

/// The picture: lines with numbers, axes with names, legible without colours.
#[test]
fn lines_have_numbers_and_axes_have_names() {
    let folder = Folder::new("map-picture");
    folder.done(&[
        "batch",
        "map",
        "--x",
        "L=0.1:0.9:9",
        "--y",
        "alpha_ratio=0.01:10:9:log",
        "--at",
        "ms=1.2",
        "--over",
        "pi-ms",
        "--levels",
        "0.4,0.8,1,1.2",
        "--y-label",
        "filter/(dead time + lag)",
        "--svg",
        "map.svg",
    ]);
    let picture = folder.read("map.svg");
    let tree = roxmltree::Document::parse(&picture).expect("XML");
    let texts: Vec<String> = tree
        .descendants()
        .filter(|n| n.has_tag_name("text"))
        .map(|n| n.text().unwrap_or("").to_owned())
        .collect();
    for part in ["0.4", "0.8", "1", "1.2", "normalised dead time T/(T+\u{3c4})", "filter/(dead time + lag)"] {
        assert!(texts.iter().any(|text| text == part), "{part}: {texts:?}");
    }
    let lines = |class: &str| {
        let is_it =
            |n: &roxmltree::Node<'_, '_>| n.has_tag_name("path") && n.attribute("class") == Some(class);
        tree.descendants().filter(is_it).filter(|n| n.attribute("d").is_some_and(|d| d.contains('L'))).count()
    };
    // Thin below 1, thick at 1, dashed above.
    assert_eq!([lines("l c0"), lines("l one"), lines("l c1 k1")], [2, 1, 1]);
}

#[test]
fn mistakes_are_told_before_anything_is_computed() {
    let folder = Folder::new("map-mistakes");
    let (x, y) = (["--x", "L=0.1:0.9:3"], ["--y", "alpha_ratio=0.1:1:3"]);
    for (arguments, part) in [
        (&["--x", "L=0.1:0.9:3"][..], "--y"),
        (&["--x", "L=0.1:0.9", "--y", "ms=1.2,2"], "NAME=FROM:TO:COUNT"),
        (&["--x", "L=0.9:0.1:3", "--y", "ms=1.2,2"], "the end, 0.1, must be above the beginning, 0.9"),
        (&["--x", "L=0:0.9:3:log", "--y", "ms=1.2,2"], "must begin above 0"),
        (&["--x", "L=0.1:0.9:3", "--y", "ms=0.5,2"], "ms = 0.5 is out of range: 1.001 to 100"),
        (&["--x", "L=0.1:0.9:3", "--y", "L=1,2"], "`L` is given twice"),
        (&["--x", "L=0.1:0.9:3", "--y", "ms=2"], "`ms` has one value only"),
        (&["--x", "q=0.1:0.9:3", "--y", "ms=1.2,2"], "the plant has no `q`; it has L"),
        (&["--x", "q=0.1:0.9:3", "--y", "ms=1.2,2"], "`L` in the plant has no value"),
        (&["--x", "L=0.1:0.9:3", "--y", "kpidn=1,2"], "`kpidn` means nothing to dob"),
        (&["--x", "alpha=1,2", "--y", "noise_ratio=2,3", "--at", "L=0.5"], "set the same filter"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--over", "dob"], "1 everywhere"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--metric", "iae"], "possible values"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--metric", "ms,ms"], "`--metric` has ms twice"),
        (
            &["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--ts", "0.1", "--horizon", "3"],
            "a horizon is for continuous loops",
        ),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--horizon", "0"], "above 0"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--at", "b=1,2"], "one value is the same everywhere"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--at", "b"], "write NAME=VALUE"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--each", "alpha=1:99:99"], "at most 24 maps"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--shard", "1/2", "--svg", "a.svg"], "needs all rows"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--svg", "a.svg", "--report", "a.svg"], "asked for twice"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--out", "a.txt"], "must end with .csv or .parquet"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--force"], "--out"),
        (
            &["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--plant", "exp(-L*s)/(1+q*q"],
            "`q` in the plant has no value",
        ),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--plant", "exp(-L*s)/(1+s"], "exp(-(0.1)*s)/(1+s"),
        (&["--x", "L=0.1,0.2", "--y", "ms=1.2,2", "--plant", "exp(-ms*s)/(1+s*L)"], "name of an option"),
        (&["--x", "L=0.1:0.9:1000", "--y", "ms=1.2:2:1000", "--each", "alpha=1,2"], "at most 1000000"),
    ] {
        let message = folder.refused(&[&["batch", "map"], arguments].concat());
        assert!(message.contains(part), "{arguments:?}: {message}");
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
    folder.done(&[&["batch", "map"], &x[..], &y, &["--svg", "a.svg"]].concat());
    let message = folder.refused(&[&["batch", "map"], &x[..], &y, &["--svg", "a.svg"]].concat());
    assert!(message.contains("a.svg") && message.contains("exists"), "{message}");
    folder.done(&[&["batch", "map"], &x[..], &y, &["--svg", "a.svg", "--force"]].concat());
}
