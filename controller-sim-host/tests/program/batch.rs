//! `batch`: the statements about the 134 processes, and that files do not depend on how they were made.

use crate::folder::{Folder, json, text};
use serde_json::Value;
use std::collections::BTreeMap;

/// Made by `tests/bench/batch_python.py`, which shares nothing with this library.
const GOLDEN: &str = include_str!("../../../controller-design/tests/golden/batch134.csv");

/// Rows of a table by names of their columns.
fn table(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|e| panic!("{column}: {e} {row:?}"))
}

/// By process, `Ms` and case: the numbers from `kp` on.
fn golden() -> BTreeMap<[String; 3], Vec<f64>> {
    let lines = GOLDEN.lines().filter(|line| !line.starts_with(['#']) && !line.starts_with("process,"));
    let parsed = lines.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let numbers = cells[3..].iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        ([cells[0], cells[1], cells[2]].map(str::to_owned), numbers)
    });
    parsed.collect()
}

/// Tena et al. 2022, section 5.2, as recomputed: the exceptions to "the observer improves everything", and every index and
/// ratio against the independent values.
#[test]
fn the_statements_about_the_134_processes() {
    let folder = Folder::new("batch-statements");
    let arguments =
        ["batch", "--set", "ah134", "--methods", "pi-ms,dob", "--ms", "1.2,1.4,2", "--noise-ratio", "2,10"];
    let shown = folder.done(&[&arguments[..], &["--out", "rows.csv"]].concat());
    assert!(shown.starts_with("1206 rows: 1206 ok, 0 refused, 0 failed\n"), "{shown}");
    let (golden, rows) = (golden(), table(&folder.read("rows.csv")));
    assert_eq!(rows.len(), 1206);
    const INDICES: [&str; 5] = ["load_iae", "load_ise", "load_itae", "load_e_max", "load_tv"];
    let mut above = BTreeMap::<[String; 2], [usize; 3]>::new();
    let mut worst = 0.0_f64;
    let mut base: BTreeMap<[String; 2], [f64; 5]> = BTreeMap::new();
    for row in &rows {
        let case = if row["method"] == "pi-ms" { "1".to_owned() } else { row["noise_ratio"].clone() };
        let key = [row["process"].clone(), row["ms0"].clone(), case.clone()];
        let want = golden.get(&key).unwrap_or_else(|| panic!("{key:?}"));
        let ours = INDICES.map(|name| number(row, name));
        let pi = [key[0].clone(), key[1].clone()];
        if case == "1" {
            base.insert(pi.clone(), ours);
        }
        let alone = &golden[&[key[0].clone(), key[1].clone(), "1".to_owned()]];
        for i in 0..5 {
            // Both designs have their own gains: the optimum is flat in kp.
            let ratio = (ours[i] / base[&pi][i]) / (want[3 + i] / alone[3 + i]);
            let tolerance = if i == 4 { 5e-3 } else { 3e-3 };
            assert!((ratio - 1.0).abs() < tolerance, "{key:?} {}: {ratio}", INDICES[i]);
            assert!((ours[i] / want[3 + i] - 1.0).abs() < tolerance, "{key:?} {}", INDICES[i]);
            worst = worst.max((ratio - 1.0).abs());
        }
        assert!((number(row, "ki") / want[1] - 1.0).abs() < 2e-4, "{key:?}");
        // The grid of the golden values sees max|S| to 5e-4.
        assert!((number(row, "ms") / want[8] - 1.0).abs() < 1e-3, "{key:?}: {}", row["ms"]);
        if case != "1" {
            let counts = above.entry([key[1].clone(), case]).or_default();
            (0..3).for_each(|i| counts[i] += usize::from(ours[i] > base[&pi][i]));
        }
    }
    println!("worst ratio off by {worst:.1e}");
    let of = |ms: &str, ratio: &str| above[&[ms.to_owned(), ratio.to_owned()]];
    assert_eq!([of("1.2", "2"), of("1.2", "10")], [[0, 0, 32], [0, 0, 0]]);
    for (ms, ratio, want, by) in [
        ("1.4", "2", [45, 0, 96], 1),
        ("1.4", "10", [0, 0, 0], 1),
        ("2", "2", [85, 51, 114], 2),
        ("2", "10", [25, 12, 49], 2),
    ] {
        let counts = of(ms, ratio);
        assert!(counts.iter().zip(want).all(|(n, w)| n.abs_diff(w) <= by), "{ms} {ratio}: {counts:?}");
    }
    // The summary says the same.
    let made = json(&folder.run(&[&arguments[..], &["--json"]].concat()));
    let group = made["groups"]
        .as_array()
        .expect("groups")
        .iter()
        .find(|group| group["ms0"] == 1.2 && group["noise_ratio"] == 2.0);
    let itae = &group.expect("a group")["itae"];
    assert_eq!(
        (itae["above_one"].as_u64(), made["results"].as_array().map(Vec::len)),
        (Some(32), Some(1206))
    );
}

const LIST: &str = "name,plant,family\n\
    a,exp(-s)/(1+2*s),one\n\
    \"b, with a comma\",1/(1+s)^4,one\n\
    no PI,1/(1+s),two\n\
    unstable,exp(-s)/(1-s),two\n\
    c,1.98*exp(-3.2*s)/(1+80.3*s),\n";
const METHODS: &str = "pi-ms,dob,momi,simc";

/// Threads, shards, and interruptions change no byte of either kind of file.
#[test]
fn files_do_not_depend_on_how_they_were_made() {
    let folder = Folder::new("batch-bytes");
    folder.write("list.csv", LIST);
    let study =
        ["batch", "--processes", "list.csv", "--methods", METHODS, "--ms", "1.2,2", "--noise-ratio", "2"];
    // Some rules refuse some plants: the exit code says so, of a whole as of a part.
    let some = |arguments: &[&str]| {
        let output = folder.run(arguments);
        assert_eq!(text(&output.stderr), "", "{arguments:?}");
        assert!(matches!(output.status.code(), Some(0 | 3)), "{arguments:?}");
        text(&output.stdout).to_owned()
    };
    let run = |more: &[&str]| some(&[&study[..], more].concat());
    for kind in ["csv", "parquet"] {
        let name = |stem: &str| format!("{stem}.{kind}");
        run(&["--jobs", "1", "--out", &name("one")]);
        run(&["--jobs", "2", "--out", &name("two")]);
        let whole = folder.bytes(&name("one"));
        assert!(whole == folder.bytes(&name("two")), "{kind}: threads");
        let parts: Vec<String> = (1..=3).map(|i| name(&format!("part{i}"))).collect();
        for (i, part) in parts.iter().enumerate() {
            run(&["--shard", &format!("{}/3", i + 1), "--out", part]);
        }
        let shuffled = ["batch", "merge", &parts[2], &parts[0], &parts[1], "--out", &name("merged")];
        some(&shuffled);
        assert!(whole == folder.bytes(&name("merged")), "{kind}: shards");
        let missing = folder.refused(&["batch", "merge", &parts[2], &parts[0], "--out", &name("x")]);
        assert!(missing.contains("of 30 are in none of the files"), "{missing}");
        let twice = folder.refused(&[
            "batch",
            "merge",
            &parts[0],
            &parts[0],
            &parts[1],
            &parts[2],
            "--out",
            &name("x"),
        ]);
        assert!(twice.contains("rows 1 to 10 are in"), "{twice}");
        assert!(!folder.names().contains(&name("x")));
    }
    // Tables and Parquet files mix.
    some(&["batch", "merge", "part1.csv", "part2.parquet", "part3.csv", "--out", "mixed.csv"]);
    let whole = folder.read("one.csv");
    assert!(whole == folder.read("mixed.csv"));
    // Cut anywhere: in the first line, in the middle of a row, at the end of one, inside of a name.
    let end_of_row = whole.match_indices('\n').nth(7).map_or(0, |(i, _)| i + 1);
    for cut in [0, 5, whole.len() / 3, end_of_row, end_of_row + 1, whole.len() - 1, whole.len()] {
        folder.write("cut.csv", &whole[..cut]);
        let shown = run(&["--out", "cut.csv", "--resume"]);
        assert!(shown.contains("wrote cut.csv: 30 rows"), "{shown}");
        assert!(whole == folder.read("cut.csv"), "cut at {cut}");
        // The rows of an interrupted Parquet file are in a table beside it.
        folder.write("cut.parquet.rows.csv", &whole[..cut]);
        run(&["--out", "cut.parquet", "--resume"]);
        assert!(folder.bytes("one.parquet") == folder.bytes("cut.parquet"), "cut at {cut}");
        std::fs::remove_file(folder.0.join("cut.parquet")).expect("removable");
    }
    assert!(!folder.names().iter().any(|name| name.ends_with(".rows.csv")));
    // A file of another study, or of another shard, is not touched.
    for wrong in [&["--ts", "0.1"][..], &["--shard", "1/3"]] {
        let message = folder.refused(&[&study[..], wrong, &["--out", "one.csv", "--resume"]].concat());
        assert!(message.contains("another s"), "{message}");
        assert!(whole == folder.read("one.csv"));
    }
    let message = folder.refused(&[&study[..], &["--out", "one.csv"]].concat());
    assert!(message.contains("exists"), "{message}");
    run(&["--out", "one.csv", "--force"]);
}

/// Plants that a rule refuses have a row that says why; the others go on.
#[test]
fn refused_plants_say_why() {
    let folder = Folder::new("batch-refused");
    folder.write("list.csv", LIST);
    let list = ["batch", "--processes", "list.csv"];
    let made = json(&folder.run(&[&list[..], &["--methods", "pi-ms,momi", "--json"]].concat()));
    assert_eq!(made["counts"], serde_json::json!({ "ok": 6, "refused": 4, "failed": 0 }), "{made}");
    let rows = made["results"].as_array().expect("rows");
    let refused = rows.iter().filter(|row| row["status"] == "refused");
    let reasons: Vec<[&str; 3]> = refused
        .map(|row| ["process", "method", "reason"].map(|key| row[key].as_str().expect("a text")))
        .collect();
    assert_eq!(reasons.len(), 4);
    assert!(
        reasons.iter().any(|[p, m, why]| (*p, *m) == ("no PI", "pi-ms") && why.contains("without bound"))
    );
    assert!(reasons.iter().filter(|[p, ..]| *p == "unstable").count() == 2, "{reasons:?}");
    for row in rows.iter().filter(|row| row["status"] == "refused") {
        assert!(row["kp"].is_null() && row["load_iae"].is_null());
    }
    // All of them refused: the exit code says so, and the rows are there.
    folder.write("bad.toml", "[[process]]\nname = \"u\"\nplant = \"exp(-s)/(1-s)\"\n");
    let output = folder.run(&["batch", "--processes", "bad.toml", "--methods", "pi-ms", "--out", "bad.csv"]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("refused pi-ms, u: "), "{}", text(&output.stdout));
    assert!(folder.read("bad.csv").contains(",refused,"));
}

/// A plant that means nothing has rows that say why, and its place is told; those of the others are as without it.
#[test]
fn plants_that_mean_nothing_stop_nobody() {
    let folder = Folder::new("batch-meaningless");
    folder.write(
        "list.csv",
        "name,plant\na,exp(-s)/(1+2*s)\nb,1/(1+s\nc,exp(-s)/(1+s)*q\nd,2*exp(-s)/(1+s)^2\n",
    );
    let study = ["batch", "--processes", "list.csv", "--methods", "pi-ms,simc"];
    let output = folder.run(&[&study[..], &["--out", "rows.csv"]].concat());
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    for part in ["list.csv:3", "list.csv:4", "never closed", "`q`"] {
        assert!(text(&output.stderr).contains(part), "{part}: {}", text(&output.stderr));
    }
    assert!(
        text(&output.stdout).starts_with("8 rows: 4 ok, 0 refused, 4 failed"),
        "{}",
        text(&output.stdout)
    );
    let rows = table(&folder.read("rows.csv"));
    for row in &rows {
        let is_wrong = ["b", "c"].contains(&&*row["process"]);
        assert_eq!(row["status"], if is_wrong { "failed" } else { "ok" }, "{row:?}");
        assert_eq!(row["reason"].starts_with("the plant means nothing: "), is_wrong, "{row:?}");
        assert_eq!(row["kp"].is_empty(), is_wrong, "{row:?}");
    }
    let json = json(&folder.run(&[&study[..], &["--json"]].concat()));
    assert_eq!(json["counts"], serde_json::json!({ "ok": 4, "refused": 0, "failed": 4 }));
    // None that means something: nothing to do.
    folder.write("none.csv", "name,plant\nb,1/(1+s\n");
    assert!(folder.refused(&["batch", "--processes", "none.csv", "--out", "x.csv"]).contains("none.csv:2"));
    assert!(!folder.names().contains(&"x.csv".to_owned()));
}

/// What is wrong with a list is told at once, with lines; nothing is written.
#[test]
fn bad_lists_are_refused_whole() {
    let folder = Folder::new("batch-lists");
    folder.write("bad.csv", "name,plant\na,1/(1+s\nb\na,1/(1+s)^2\n,exp(-s)*q\n");
    let message = folder.refused(&["batch", "--processes", "bad.csv", "--out", "rows.csv"]);
    for part in ["bad.csv:2", "bad.csv:3", "bad.csv:4", "bad.csv:5", "5 faults in bad.csv"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    folder.write("empty.csv", "name,plant\n");
    assert!(folder.refused(&["batch", "--processes", "empty.csv"]).contains("no process"));
    folder.write("list.csv", LIST);
    for (arguments, part) in [
        (&["--processes", "none.csv"][..], "none.csv"),
        (&["--processes", "list.txt"], "must end with .csv or .toml"),
        (&["--processes", "list.csv", "--out", "rows.txt"], "must end with .csv or .parquet"),
        (&["--processes", "list.csv", "--out", "list.csv", "--force"], "the list itself"),
        (&["--processes", "list.csv", "--shard", "3/2"], "2/4"),
        (&["--processes", "list.csv", "--methods", "pi-ms", "--shard", "9/9"], "make fewer parts"),
        (&["--processes", "list.csv", "--ms", "1.2,1.2", "--methods", "dob,dob"], "--methods"),
        (&["--processes", "list.csv", "--ms", "0.9"], "1.001 to 100"),
        (&["--processes", "list.csv", "--noise-ratio", "1"], "1.000001"),
        (&["--processes", "list.csv", "--methods", "momi", "--noise-ratio", "2"], "means nothing"),
        (&["--processes", "list.csv", "--set", "ah134"], "cannot be used with"),
        (&["--methods", "momi"], "--set"),
        (&["--processes", "list.csv", "--resume"], "--out"),
        (&["--list"], "--set"),
        (&["merge", "list.csv", "--out", "x.csv"], "no part of a study"),
        (&["merge", "none.csv", "list.csv", "--out", "x.csv"], "`none.csv` is no part"),
    ] {
        let message = folder.refused(&[&["batch"], arguments].concat());
        assert!(message.contains(part), "{arguments:?}: {message}");
    }
    let names = folder.names();
    assert_eq!(names, ["bad.csv", "empty.csv", "list.csv"]);
}

/// The exact indices are those of the sampled loop but for what sampling does to it: up to 3 % with 50 samples in the dead
/// time. Both have the same law: the period is the one that the plants have of their own.
#[test]
fn sampled_loops_are_near_the_continuous_ones() {
    let folder = Folder::new("batch-sampled");
    folder.write("list.csv", "name,plant\na,exp(-s)/(1+2*s)\nb,exp(-0.5*s)/((1+s)*(1+0.4*s))\n");
    let rows = |more: &[&str]| -> Vec<Value> {
        let start = [
            "batch",
            "--processes",
            "list.csv",
            "--methods",
            "pi-ms,dob,momi,de-momi",
            "--noise-ratio",
            "2",
            "--json",
        ];
        let made = json(&folder.run(&[&start[..], more].concat()));
        made["results"].as_array().expect("rows").clone()
    };
    let (exact, sampled) = (rows(&[]), rows(&["--ts", "0.005"]));
    for (exact, sampled) in exact.iter().zip(&sampled) {
        assert_eq!((exact["loop"].as_str(), sampled["loop"].as_str()), (Some("continuous"), Some("sampled")));
        assert!(exact["ts"].as_f64().is_some_and(|ts| ts == 0.005 || ts == 0.01));
        let same_law = ["kp", "ki", "tf", "tfd"].iter().all(|name| exact[name] == sampled[name]);
        let tolerance = if same_law { 0.03 } else { 0.06 };
        for column in [
            "setpoint_iae",
            "setpoint_ise",
            "setpoint_itae",
            "load_iae",
            "load_ise",
            "load_itae",
            "load_e_max",
            "ms",
        ] {
            let [x, y] = [exact, sampled].map(|row| row[column].as_f64().expect("a number"));
            assert!((x / y - 1.0).abs() <= tolerance, "{column}: {x} {y}\n{exact}");
        }
    }
}

/// The list is what is published, and can be read back.
#[test]
fn the_set_is_printed_as_it_is_published() {
    let folder = Folder::new("batch-set");
    let printed = folder.done(&["batch", "--set", "ah134", "--list"]);
    assert_eq!(printed, include_str!("../../../controller-design/processes/ah134.csv"));
    let object = json(&folder.run(&["batch", "--set", "ah134", "--list", "--json"]));
    assert_eq!(object["processes"].as_array().map(Vec::len), Some(134));
    folder.write("list.csv", &printed);
    let rows = |plants: &[&str]| {
        let arguments = [&["batch"], plants, &["--methods", "simc", "--json"]].concat();
        json(&folder.run(&arguments))["results"].clone()
    };
    let (own, built_in) = (rows(&["--processes", "list.csv"]), rows(&["--set", "ah134"]));
    assert_eq!(own, built_in);
}
