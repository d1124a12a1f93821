//! `batch sample`: closed forms of a loop of first order, files that do not depend on how they were made, worst samples that
//! are run again.

use crate::folder::{Folder, json, text};
use controller_sim_host::scenario::{NoFiles, read_with};
use controller_sim_host::simulate::{Precision, RunOptions, run};
use serde_json::Value;
use std::collections::BTreeMap;

/// Rows of a table by names of their columns.
fn table(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|e| panic!("{column}: {e} {row:?}"))
}

/// Sampled every second, its pole is at one half: `ts/tau = ln 2`.
const FIRST_ORDER: &str = r#"
version = 1
ts = 1.0
duration = 40.0
substeps = 2
[plant]
tf = "2*1/(1+1.4426950408889634*s)"
[[event]]
at = 0.0
setpoint = 1.0
[[controller]]
name = "P"
pid = { kp = 1.0 }
[uncertainty]
gain = "2..3.1 abs"
"#;

/// With `a = 1/2` and `b = gain/2`: the closed loop's pole is `a - b`, unstable from a gain of 3 on; `|S| = |z-a|/|z-a+b|` is
/// largest at `z = -1`, where it is `1.5/(1.5-b)`.
#[test]
fn a_loop_of_first_order_is_as_its_closed_form() {
    let folder = Folder::new("sample-closed-form");
    folder.write("p.toml", FIRST_ORDER);
    let (n, limit, top) = (4000, 3.0, 3.1);
    let arguments = ["batch", "sample", "p.toml", "-n", "4000", "--seed", "5", "--out", "rows.csv", "--json"];
    let made = json(&folder.run(&arguments));
    let rows = table(&folder.read("rows.csv"));
    assert_eq!(rows.len(), n);
    let of_gain = |gain: f64| 1.5 / (1.5 - 0.5 * gain);
    let (mut gains, mut ms) = (Vec::new(), Vec::new());
    for row in &rows {
        let gain = number(row, "gain");
        gains.push(gain);
        let is_stable = gain < limit;
        assert_eq!(row["status"], if is_stable { "stable" } else { "unstable" }, "{row:?}");
        if is_stable {
            let found = number(row, "ms");
            // Near the limit the distance to it is the difference of two roundings of 1.5.
            let tolerance = 1e-9 + 1e-14 * found;
            assert!((found / of_gain(gain) - 1.0).abs() < tolerance, "{gain}: {found} {}", of_gain(gain));
            assert!((number(row, "gm") / (limit / gain) - 1.0).abs() < 1e-6, "{row:?}");
            ms.push(found);
        } else {
            assert_eq!((number(row, "unstable_poles"), &*row["ms"]), (1.0, ""));
        }
    }
    // Kolmogorov's statistic, once in a thousand sets beyond this; the seed is fixed.
    gains.sort_by(f64::total_cmp);
    let gap = |(i, gain): (usize, &f64)| {
        let share = (gain - 2.0) / (top - 2.0);
        (share - i as f64 / n as f64).abs().max((share - (i + 1) as f64 / n as f64).abs())
    };
    let distance = gains.iter().enumerate().map(gap).fold(0.0, f64::max);
    assert!(distance < 1.95 / (n as f64).sqrt(), "{distance}");
    // One eleventh of the gains is beyond the limit: within four standard errors, and the interval tells so.
    let (share, unstable) = (0.1 / 1.1, n - ms.len());
    let deviation = (n as f64 * share * (1.0 - share)).sqrt();
    assert!((unstable as f64 - n as f64 * share).abs() < 4.0 * deviation, "{unstable}");
    let told = &made["controllers"][0]["unstable"];
    let at = |key: &str| told[key].as_f64().expect("a number");
    assert_eq!(at("share"), unstable as f64 / n as f64);
    assert!(at("lo") < share && share < at("hi") && told["interval"] == "clopper-pearson", "{told}");
    // Quantiles: those of the sorted list but for the width of a class, and of the closed form but for chance.
    ms.sort_by(f64::total_cmp);
    let metrics = made["controllers"][0]["metrics"].as_array().expect("metrics");
    let told = metrics.iter().find(|metric| metric["name"] == "ms").expect("Ms");
    for (key, p) in [("p5", 0.05), ("p50", 0.5), ("p95", 0.95)] {
        let value = told[key].as_f64().expect("a number");
        let exact = ms[(p * ms.len() as f64).ceil() as usize - 1];
        // 14 bits, two of them lost: Ms spans more than a factor of a thousand.
        assert!((value / exact - 1.0).abs() < 1.0 / 4096.0, "{key}: {value} {exact}");
        let spread = 4.0 * (p * (1.0 - p) / ms.len() as f64).sqrt();
        let ends = [p - spread, p + spread].map(|p| of_gain(2.0 + p.min(0.9999) * (limit - 2.0)));
        assert!(ends[0] < value && value < ends[1], "{key}: {value} {ends:?}");
    }
    assert_eq!(told["count"].as_u64(), Some(ms.len() as u64));
    let mean = ms.iter().sum::<f64>() / ms.len() as f64;
    assert!((told["mean"].as_f64().expect("a number") / mean - 1.0).abs() < 1e-12);
}

/// A loop with an estimator and one without, noise, a limited actuator; a wide range of dead times: some loops are unstable.
const DE: &str = r#"
version = 1
ts = 0.02
duration = 12.0
substeps = 4
[plant]
sopdt = { gain = 1.0, tau1 = 1.0, tau2 = 0.2, dead_time = 0.2 }
[noise]
std = 0.001
[actuator]
lo = -10.0
hi = 10.0
read_back = true
[[event]]
at = 0.0
setpoint = 1.0
[[event]]
at = 6.0
disturbance = 1.0
[[controller]]
name = "DE-MOMI"
pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119, b = 1.0, c = 1.0 }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.69, tfd = 0.06 }
[[controller]]
name = "PI, \"slow\""
pid = { kp = 0.8, ki = 0.7 }
[uncertainty]
gain = "+-30 %"
lag = "0.5..2 log"
dead_time = "0.5..3 normal"
actuator = { hi = "2..4 abs" }
noise.std = "0..0.002 abs"
"#;

#[test]
fn files_do_not_depend_on_how_they_were_made() {
    let folder = Folder::new("sample-bytes");
    folder.write("de.toml", DE);
    let study = ["batch", "sample", "de.toml", "-n", "25", "--precision", "f32", "--quiet"];
    let run = |more: &[&str]| folder.done(&[&study[..], more].concat());
    let summary = |shown: &str| shown.split("\nwrote ").next().map(str::to_owned);
    for kind in ["csv", "parquet"] {
        let name = |stem: &str| format!("{stem}.{kind}");
        let one = run(&["--jobs", "1", "--out", &name("one")]);
        let two = run(&["--jobs", "2", "--out", &name("two")]);
        assert_eq!(summary(&one), summary(&two));
        let whole = folder.bytes(&name("one"));
        assert!(whole == folder.bytes(&name("two")), "{kind}: threads");
        // Parts of 17, 17 and 16 rows: they begin in the middle of a sample.
        let parts: Vec<String> = (1..=3).map(|i| name(&format!("part{i}"))).collect();
        for (i, part) in parts.iter().enumerate() {
            run(&["--shard", &format!("{}/3", i + 1), "--out", part]);
        }
        let merged = ["batch", "merge", &parts[2], &parts[0], &parts[1], "--out", &name("merged")];
        let shown = folder.done(&merged);
        assert!(whole == folder.bytes(&name("merged")), "{kind}: shards");
        assert!(shown.contains("DE-MOMI: ") && shown.contains("Clopper-Pearson"), "{shown}");
        // The statistics are those of the whole.
        let of = |shown: &str| shown.split_once("\nDE-MOMI").map(|(_, rest)| summary(rest));
        assert_eq!(of(&shown), of(&one));
    }
    folder.done(&["batch", "merge", "part1.csv", "part2.parquet", "part3.csv", "--out", "mixed.csv"]);
    let whole = folder.read("one.csv");
    assert!(whole == folder.read("mixed.csv"));
    let end_of_row = whole.match_indices('\n').nth(7).map_or(0, |(i, _)| i + 1);
    for cut in [0, 5, whole.len() / 3, end_of_row, end_of_row + 1, whole.len() - 1, whole.len()] {
        folder.write("cut.csv", &whole[..cut]);
        let shown = run(&["--out", "cut.csv", "--resume"]);
        assert!(shown.contains("wrote cut.csv: 50 rows"), "{shown}");
        assert_eq!(summary(&shown), summary(&run(&["--out", "two.csv", "--resume"])));
        assert!(whole == folder.read("cut.csv"), "cut at {cut}");
        folder.write("cut.parquet.rows.csv", &whole[..cut]);
        run(&["--out", "cut.parquet", "--resume"]);
        assert!(folder.bytes("one.parquet") == folder.bytes("cut.parquet"), "cut at {cut}");
        std::fs::remove_file(folder.0.join("cut.parquet")).expect("removable");
    }
    // Another study is told apart by its seed, its ranges, its scenario, its number type.
    for other in
        [&["--seed", "2"][..], &["--vary", "gain=+-31%"], &["--set", "latency=0.01"], &["--precision", "f64"]]
    {
        let arguments =
            ["batch", "sample", "de.toml", "-n", "25", "--precision", "f32", "--out", "one.csv", "--resume"];
        let arguments: Vec<&str> = match other {
            ["--precision", _] => arguments.iter().map(|a| if *a == "f32" { "f64" } else { a }).collect(),
            other => [&arguments[..], other].concat(),
        };
        let message = folder.refused(&arguments);
        assert!(message.contains("another study"), "{message}");
        assert!(whole == folder.read("one.csv"));
    }
    // Samples of a larger study begin with those of the smaller one: they depend on their numbers alone.
    folder.done(&["batch", "sample", "de.toml", "-n", "30", "--precision", "f32", "--out", "more.csv"]);
    let values = |name: &str| -> Vec<BTreeMap<String, String>> {
        let mut rows = table(&folder.read(name));
        rows.iter_mut().for_each(|row| drop(row.remove("study")));
        rows
    };
    assert_eq!(values("more.csv")[..50], values("one.csv")[..]);
    // One quantity less changes no value of the others.
    let fewer = DE.replace("lag = \"0.5..2 log\"\n", "");
    folder.write("fewer.toml", &fewer);
    folder.done(&["batch", "sample", "fewer.toml", "-n", "25", "--precision", "f32", "--out", "fewer.csv"]);
    for (row, other) in values("one.csv").iter().zip(values("fewer.csv")) {
        assert!(
            ["gain", "dead_time", "actuator_hi", "noise_std", "noise_seed"]
                .iter()
                .all(|q| row[*q] == other[*q])
        );
    }
}

/// Every worst sample is a scenario whose run gives the numbers of its row, all bits of them.
#[test]
fn worst_samples_are_run_again() {
    let folder = Folder::new("sample-worst");
    folder.write("de.toml", DE);
    for (precision, number_type) in [("f32", Precision::F32), ("f64", Precision::F64)] {
        let study = ["batch", "sample", "de.toml", "-n", "60", "--precision", precision, "--json"];
        let out = format!("{precision}.csv");
        let made = json(&folder.run(&[&study[..], &["--out", &out, "--worst", precision]].concat()));
        let rows = table(&folder.read(&out));
        assert!(rows.iter().any(|row| row["status"] == "unstable"), "{made}");
        let files = made["worst"].as_array().expect("files");
        assert!(files.len() > 3);
        let mut reached = 0;
        for file in files {
            let name = file["file"].as_str().expect("a name");
            let text = folder.read(name);
            let number_of_it = file["sample"].to_string();
            let read = read_with(name, &text, number_type, &NoFiles).expect("a scenario");
            let options = RunOptions { precision: number_type, ..RunOptions::default() };
            let result = run(&read.cases[0].scenario, options).expect("a run");
            for one in &result.controllers {
                let is_it = |row: &&BTreeMap<String, String>| {
                    row["sample"] == number_of_it && row["controller"] == one.name
                };
                let row = rows.iter().find(is_it).expect("its row");
                for (i, event) in one.events.iter().enumerate() {
                    let m = &event.metrics;
                    let values = [
                        ("ie", m.ie),
                        ("iae", m.iae),
                        ("ise", m.ise),
                        ("itae", m.itae),
                        ("e_max", m.e_max),
                        ("tv", m.tv),
                    ];
                    for (name, value) in values {
                        let cell = number(row, &format!("e{}_{name}", i + 1));
                        assert_eq!(cell.to_bits(), value.to_bits(), "{name} of {}", one.name);
                    }
                }
            }
            // The margins are those that `analyze` tells, and the list says what it is the worst in.
            let analysed = json(&folder.run(&["analyze", name, "--json"]));
            // Without a stable loop there is an error in place of the margins.
            let none = Vec::new();
            let controllers = analysed["controllers"].as_array().unwrap_or(&none);
            for of in file["of"].as_array().expect("a list") {
                reached += 1;
                let own = controllers.iter().find(|one| one["name"] == of["controller"]);
                match of["metric"].as_str().expect("a name") {
                    name @ ("ms" | "mt" | "gm" | "pm_deg" | "delay_margin") => {
                        let margin = &own.expect("its analysis")["discrete"]["robustness"][name];
                        let [told, margin] = [&of["value"], margin].map(|x| x.as_f64().expect("a number"));
                        assert!((margin / told - 1.0).abs() < 1e-12, "{own:?} {of}");
                    }
                    "unstable" => assert!(text.contains("the unstable loop with the largest IAE"), "{text}"),
                    metric => assert!(text.contains(&format!("{metric} = ")), "{text}"),
                }
            }
        }
        // Five margins, twelve indices, and the unstable one, of each controller that has it.
        assert!((34..=36).contains(&reached), "{reached}");
        // The worst IAE is the largest among the stable rows.
        for controller in ["DE-MOMI", "PI, \"slow\""] {
            let stable =
                rows.iter().filter(|row| row["controller"] == controller && row["status"] == "stable");
            let largest = stable.map(|row| number(row, "e2_iae")).fold(0.0, f64::max);
            let controllers = made["controllers"].as_array().expect("controllers");
            let own = controllers.iter().find(|one| one["name"] == controller).expect("its numbers");
            let metrics = own["metrics"].as_array().expect("metrics");
            let iae = metrics.iter().find(|metric| metric["name"] == "e2_iae").expect("IAE");
            assert!((iae["worst"].as_f64().expect("a number") / largest - 1.0).abs() < 1e-15);
        }
        // A folder with something in it is not written into.
        let again = folder.run(&[&study[..], &["--worst", precision]].concat());
        assert_eq!(again.status.code(), Some(2), "{}", text(&again.stdout));
    }
}

/// Values that are no plant have a row that says why; the others go on.
#[test]
fn impossible_samples_say_why() {
    let folder = Folder::new("sample-refused");
    folder.write("de.toml", DE);
    let base = ["batch", "sample", "de.toml", "-n", "40", "--json"];
    let made = json(
        &folder.run(
            &[
                &base[..],
                &["--vary", "lag2=-100..100 % uniform", "--vary", "lag1=-1..1", "--out", "rows.csv"],
            ]
            .concat(),
        ),
    );
    let rows = table(&folder.read("rows.csv"));
    let (mut refused, mut good) = (0, 0);
    for row in &rows {
        if number(row, "lag1") <= 0.0 {
            assert_eq!(
                (&*row["status"], &*row["reason"], &*row["e1_iae"]),
                ("refused", "lag1 is not above 0", "")
            );
            refused += 1;
        } else {
            assert!(["stable", "unstable"].contains(&&*row["status"]), "{row:?}");
            good += 1;
        }
    }
    assert!(refused > 20 && good > 20, "{refused} {good}");
    assert_eq!(made["counts"]["refused"].as_u64(), Some(refused));
    assert_eq!(made["causes"][0]["reason"], "lag1 is not above 0");
    // No row with a result: the exit code says so.
    let none = ["--vary", "actuator.lo=3..3.5 abs", "--vary", "actuator.hi=1..2 abs", "--out", "none.csv"];
    let output = folder.run(&[&base[..5], &none].concat());
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stdout));
    assert!(
        text(&output.stdout).contains("actuator.lo is not below actuator.hi"),
        "{}",
        text(&output.stdout)
    );
    // A dead time of too many samples is no reason to stop, nor to fill the memory.
    let long = folder.run(&[&base[..5], &["--vary", "dead_time=1e6..1e7 s", "--vary", "gain=1..1"]].concat());
    assert_eq!(long.status.code(), Some(3), "{}", text(&long.stdout));
    assert!(text(&long.stdout).contains("80 failed"), "{}", text(&long.stdout));
}

/// What is wrong with the request is told before anything is written.
#[test]
fn mistakes_are_told() {
    let folder = Folder::new("sample-mistakes");
    folder.write("de.toml", DE);
    folder.write("none.toml", &FIRST_ORDER.replace("[uncertainty]\ngain = \"2..3.1 abs\"\n", ""));
    folder.write("sweep.toml", &format!("{FIRST_ORDER}[sweep]\nkey = \"latency\"\nvalues = [0.0, 0.1]\n"));
    folder.write("bad.toml", &FIRST_ORDER.replace("\"2..3.1 abs\"", "\"3..2\""));
    folder.write("odd.toml", &FIRST_ORDER.replace("gain =", "gian ="));
    folder.write("number.toml", &FIRST_ORDER.replace("\"2..3.1 abs\"", "0.2"));
    folder.write("u.toml", "gain = \"+-10 %\"\nlag7 = \"+-10 %\"\n");
    folder.write("syntax.toml", "gain = \n");
    for (arguments, part) in [
        (&["none.toml"][..], "nothing is drawn"),
        (&["sweep.toml", "--vary", "gain=+-1%"], "is a sweep"),
        (&["bad.toml"], "the range is empty"),
        (&["odd.toml"], "did you mean `gain`"),
        (&["number.toml"], "it is no text"),
        (&["de.toml", "--vary", "gain"], "NAME=RANGE"),
        (&["de.toml", "--vary", "gain=+-20"], "no unit"),
        (&["de.toml", "--vary", "gain=50..300 %"], "differences"),
        (&["de.toml", "--vary", "gian=+-20%"], "did you mean `gain`"),
        (&["de.toml", "--vary", "gain=-1..1 log"], "uniform logarithm"),
        (&["de.toml", "--vary", "lag3=+-20%"], "the plant has 2 lags"),
        (&["de.toml", "--vary", "zeros=+-20%"], "the plant has no zeros"),
        (&["de.toml", "--vary", "lags=-2..-1"], "no value from -2 to -1 is possible"),
        (&["de.toml", "--vary", "sensor.resolution=+-20%"], "is 0"),
        (&["de.toml", "--uncertainty", "u.toml"], "lag7"),
        (&["de.toml", "--uncertainty", "syntax.toml"], "syntax.toml"),
        (&["de.toml", "--uncertainty", "nowhere.toml"], "nowhere.toml"),
        (&["de.toml", "-n", "0"], "1..=1000000000"),
        (&["de.toml", "--shard", "3/2"], "2/4"),
        (&["de.toml", "-n", "1", "--shard", "1/9", "--out", "x.csv"], ""),
        (&["de.toml", "-n", "1", "--shard", "9/9"], "make fewer parts"),
        (&["de.toml", "--out", "de.toml", "--force"], "is read by the study"),
        (&["de.toml", "--out", "x.txt"], "must end with .csv or .parquet"),
        (&["de.toml", "--out", "x.csv", "--report", "x.csv"], "the same file"),
        (&["de.toml", "--resume"], "--out"),
        (&["de.toml", "--worst", "de.toml"], "is read by the study"),
        (&["nowhere.toml"], "nowhere.toml"),
        (&["--vary", "gain=+-20%"], "FILE"),
    ] {
        if part.is_empty() {
            folder.done(&[&["batch", "sample"], arguments].concat());
            std::fs::remove_file(folder.0.join("x.csv")).expect("removable");
            continue;
        }
        let message = folder.refused(&[&["batch", "sample"], arguments].concat());
        assert!(message.contains(part), "{arguments:?}: {message}");
    }
    assert!(!folder.names().iter().any(|name| name.ends_with(".csv")), "{:?}", folder.names());
    // A cascade is not analysed: refused, and said why.
    let cascade = FIRST_ORDER
        .replace("tf = ", "inner = \"1/(1+0.5*s)\"\ntf = ")
        .replace("pid = { kp = 1.0 }", "pid = { kp = 1.0 }\nsecondary = { pid = { kp = 1.0 } }");
    folder.write("cascade.toml", &cascade);
    let output = folder.run(&["batch", "sample", "cascade.toml"]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("a cascade is not analysed"));
    // Nor a plant that is not linear: what is drawn are gains, lags and dead times.
    folder.write("tank.toml", include_str!("../../scenarios/two-tank.toml"));
    let output = folder.run(&["batch", "sample", "tank.toml", "--vary", "gain=+-20%"]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("is not linear"), "{}", text(&output.stderr));
    let output = folder.run(&["analyze", "tank.toml", "--card"]);
    assert!(text(&output.stdout).contains("has no card"), "{}", text(&output.stdout));
    // Some samples are no scenario: the others have their rows, and the exit code says that some have none.
    let some = ["batch", "sample", "de.toml", "-n", "8", "--vary", "noise.std=-1..1 abs", "--json"];
    let output = folder.run(&some);
    let counts = &json(&output)["counts"];
    let count = |key: &str| counts[key].as_u64().expect("a number");
    assert!(count("refused") > 0 && count("stable") > 0, "{counts}");
    assert_eq!(output.status.code(), Some(3));
    // A range that is probably not meant.
    let shown = folder.done(&["batch", "sample", "de.toml", "-n", "3", "--vary", "lag1=2..3"]);
    assert!(shown.contains("warning: lag1 is drawn from 2 to 3, its nominal value is 1"), "{shown}");
}

/// The page has the distributions of all controllers, and numbers of the table.
#[test]
fn the_page_shows_the_distributions() {
    let folder = Folder::new("sample-page");
    folder.write("de.toml", DE);
    let shown = folder.done(&["batch", "sample", "de.toml", "-n", "50", "--report", "page.html"]);
    assert!(shown.ends_with("wrote page.html\n"), "{shown}");
    let page = folder.read("page.html");
    // The figure and its title.
    assert_eq!(page.matches("id=\"cdf-").count(), 2 * (5 + 12));
    assert_eq!(page.matches("class=\"l c0 k0\"").count(), 1 + 17, "a legend and a line in each");
    assert!(
        page.contains("Clopper-Pearson") && page.contains("batch sample de.toml -n 50 --report page.html")
    );
    let ms = shown.lines().find(|line| line.trim_start().starts_with("ms ")).expect("a line");
    assert!(ms.split_whitespace().skip(1).all(|number| page.contains(&format!(">{number}<"))), "{ms}");
    let value: Value = json(&folder.run(&["batch", "sample", "de.toml", "-n", "50", "--json"]));
    assert_eq!(value["drawn"]["quantities"].as_array().map(Vec::len), Some(6));
    assert!(value["report"].is_null() && value["out"].is_null());
}
