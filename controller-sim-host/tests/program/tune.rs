//! `tune`, on recordings of different kinds.

use crate::folder::{Folder, json, text};
use crate::schema::check;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A cooling valve: opening it lowers the temperature; a log of a European recorder with decimal commas, units below the
/// names, noise and two seconds between rows. Two lags, 40 and 15 s, 6 s of dead time, gain -0.8.
fn valve() -> String {
    let (gain, slow, fast, dead_time) = (-0.8, 40.0, 15.0, 6.0);
    let mut state: u64 = 7;
    let mut noise = || {
        // The mean of twelve uniform numbers, near enough to a Gaussian one.
        let sum: f64 = (0..12)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            })
            .sum();
        0.03 * (sum - 6.0)
    };
    let mut text = "Zeit;Ventil;Temperatur\ns;%;degC\n".to_owned();
    for row in 0..400 {
        let t = 2.0 * f64::from(row);
        let after: f64 = t - 60.0 - dead_time;
        let step = if after > 0.0 {
            1.0 - (slow * (-after / slow).exp() - fast * (-after / fast).exp()) / (slow - fast)
        } else {
            0.0
        };
        let (u, y) = (if t < 60.0 { 30.0 } else { 45.0 }, 72.0 + gain * 15.0 * step + noise());
        text.push_str(&format!("{t:.1};{u:.1};{y:.3}\n").replace('.', ","));
    }
    text
}

#[test]
fn a_noisy_log_of_a_cooling_valve_gives_a_robust_loop() {
    let folder = Folder::new("tune-valve");
    folder.write("valve.csv", &valve());
    let arguments = [
        "tune",
        "valve.csv",
        "--input",
        "Ventil",
        "--output",
        "Temperatur",
        "--time",
        "Zeit",
        "--limits",
        "0:100",
        "--save",
        "loop.toml",
        "--report",
        "loop.html",
        "--json",
    ];
    let tuned = json(&folder.run(&arguments));
    check(&tuned);
    let model = &tuned["identified"]["model"];
    for (key, expected, tolerance) in
        [("gain", -0.8, 0.01), ("a1", 55.0, 2.0), ("a2", 600.0, 60.0), ("dead_time", 6.0, 1.0)]
    {
        assert!((number(&model[key]) - expected).abs() < tolerance, "{key}: {model}");
    }
    // 0.03 of noise: five sigma.
    assert!(number(&tuned["worst_residual"]) < 0.15, "{}", tuned["worst_residual"]);
    let design = &tuned["design"];
    assert!(number(&design["pid"]["ki"]) < 0.0, "the gain is negative: {design}");
    assert!(
        number(&design["discrete"]["robustness"]["ms"]) <= 2.0 && number(&design["robustness"]["ms"]) <= 2.0,
        "{design}"
    );
    assert!(design["estimator"].is_object());
    let page = folder.read("loop.html");
    for part in [
        "For the commissioning file",
        "Temperatur",
        "Nyquist",
        "degC",
        "sampling period ts",
        "KP, gain",
        "TN, reset time",
        "TV, derivative time",
        ">output from<",
        ">output to<",
        "good <span class=\"unit\">(at most 2)",
        "white noise, std(u)/std(n)",
    ] {
        assert!(page.contains(part), "`{part}` is not on the page");
    }
    let run = json(&folder.run(&["run", "loop.toml", "--json", "--precision", "f32"]));
    let load = &run["controllers"][0]["events"][1]["metrics"];
    assert!((number(&load["iae"]) / number(&tuned["load_step"]["iae"]) - 1.0).abs() < 0.02, "{load}");
    let analysed = json(&folder.run(&["analyze", "loop.toml", "--json"]));
    let ms = number(&analysed["controllers"][0]["discrete"]["robustness"]["ms"]);
    assert!((ms / number(&design["discrete"]["robustness"]["ms"]) - 1.0).abs() < 1e-9, "{ms}");
}

/// A point between thousands, from 1000 on, is read by the decimal commas of the other columns; numbers that jump by a
/// factor of a thousand, however they came there, are no step response.
#[test]
fn a_record_that_no_model_explains_gives_no_loop() {
    let folder = Folder::new("tune-gross");
    let record = |thousands: fn(f64) -> String| -> String {
        let row = |row: i32| {
            let t = 2.0 * f64::from(row);
            let after = t - 66.0;
            let rise = 1.0 - ((-after / 40.0_f64).exp() * 40.0 - (-after / 15.0_f64).exp() * 15.0) / 25.0;
            let y = if after > 0.0 { 900.0 + 200.0 * rise } else { 900.0 };
            format!("{t};{},5;{}\n", if t < 60.0 { 300 } else { 400 }, thousands(y.round()))
        };
        "Zeit;MV;PV\n".to_owned() + &(0..300).map(row).collect::<String>()
    };
    let grouped = |y: f64| {
        if y < 1000.0 { format!("{y}") } else { format!("1.{:03}", y - 1000.0) }
    };
    folder.write("grouped.csv", &record(grouped));
    let output = folder.run(&["tune", "grouped.csv", "--limits", "0:1000", "--json"]);
    let tuned = json(&output);
    let gain = number(&tuned["identified"]["model"]["gain"]);
    assert!((gain - 2.0).abs() < 0.05, "{tuned}");
    folder.write(
        "jumps.csv",
        &record(|y| if y < 1000.0 { format!("{y},0") } else { format!("{:.4}", y / 1000.0) }),
    );
    for method in ["de-momi", "advise"] {
        let output = folder.run(&["tune", "jumps.csv", "--limits", "0:1000", "--method", method]);
        let shown = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{method}: {shown}");
        assert!(shown.contains("no model explains the record") && shown.contains("--report"), "{shown}");
    }
}

/// The recorded heater, where it is at hand: 10 bits, one row before the step, a doubled time stamp.
#[test]
fn the_recorded_heater_gives_a_loop_for_the_commissioning_file() {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/heater-step.csv");
    let Ok(record) = fs::read_to_string(&log) else {
        println!("not run: the recording is not at hand");
        return;
    };
    let folder = Folder::new("tune-heater");
    folder.write("heater.csv", &record);
    let arguments =
        ["tune", "heater.csv", "--limits", "0:100", "--save", "loop.toml", "--report", "loop.html", "--json"];
    let tuned = json(&folder.run(&arguments));
    check(&tuned);
    assert!(number(&tuned["worst_residual"]) < 1.0, "{}", tuned["worst_residual"]);
    assert!(number(&tuned["design"]["discrete"]["robustness"]["ms"]) <= 2.0);
    assert!(tuned["design"]["estimator"].is_object());
    folder.done(&["run", "loop.toml"]);
    for method in ["momi", "drmo", "pi-ms", "dob", "amigo"] {
        let tuned =
            json(&folder.run(&["tune", "heater.csv", "--method", method, "--limits", "0:100", "--json"]));
        check(&tuned);
        assert!(number(&tuned["design"]["discrete"]["robustness"]["ms"]) <= 2.0, "{method}");
    }
}

/// The rows of a log without times and the period of the controller are two things.
#[test]
fn a_log_without_times_is_tuned_for_any_period() {
    let folder = Folder::new("tune-untimed");
    let log = valve();
    folder.write("timed.csv", &log);
    let bare: String =
        log.lines().filter_map(|line| line.split_once(';')).map(|(_, rest)| format!("{rest}\n")).collect();
    folder.write("bare.csv", &bare);
    let common =
        ["--input", "Ventil", "--output", "Temperatur", "--method", "momi", "--limits", "0:100", "--json"];
    let tuned = |options: &[&str]| json(&folder.run(&[&["tune"], options, &common[..]].concat()));
    let timed = tuned(&["timed.csv", "--time", "Zeit", "--ts", "5"]);
    let untimed = tuned(&["bare.csv", "--log-ts", "2", "--ts", "5"]);
    assert_eq!(timed["design"]["pid"], untimed["design"]["pid"], "{untimed}");
    assert_eq!(untimed["design"]["ts"], 5.0);
    assert_eq!(tuned(&["bare.csv", "--log-ts", "2"])["design"]["ts"], 2.0);
    let refused = folder.refused(&["tune", "bare.csv", "--ts", "5"]);
    assert!(refused.contains("`--log-ts S`"), "{refused}");
}

/// Four equal lags under much noise; without limits the output goes where it wants, and that is said.
#[test]
fn the_residual_and_the_output_that_is_asked_for_are_said() {
    let folder = Folder::new("tune-rich");
    let mut text = "time,u,y\n".to_owned();
    for row in 0..1200 {
        let t = 0.1 * f64::from(row);
        let x = (t - 10.0).max(0.0);
        // 3/(1+s)^4, and noise of one part in a hundred of the change, from a fixed sequence.
        let step = 1.0 - (-x).exp() * (1.0 + x + x * x / 2.0 + x * x * x / 6.0);
        let noise = f64::from((row * 7919 + row * row % 104_729) % 1000) / 1000.0 - 0.5;
        text.push_str(&format!(
            "{t:.1},{},{:.5}\n",
            if t < 10.0 { 5 } else { 7 },
            1.0 + 6.0 * step + 0.2 * noise
        ));
    }
    folder.write("four.csv", &text);
    let tuned = json(&folder.run(&["tune", "four.csv", "--json"]));
    check(&tuned);
    // Half of the noise's range is 0.1; the rest is what two lags leave of four.
    assert!((0.09..0.25).contains(&number(&tuned["worst_residual"])), "{}", tuned["worst_residual"]);
    let (lo, hi) = (number(&tuned["u_range"][0]), number(&tuned["u_range"][1]));
    // It rests at 7 without the load, at 6.6 with it, and without limits the first move goes beyond 8.
    assert!(lo <= 6.6 && hi > 8.0, "{lo} {hi}");
    let shown = folder.done(&["tune", "four.csv"]);
    for part in ["no limits given: the simulated output is not limited", "--limits LO:HI", "largest |u| "] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let limited = json(&folder.run(&["tune", "four.csv", "--limits", "0:8", "--json"]));
    let (lo, hi) = (number(&limited["u_range"][0]), number(&limited["u_range"][1]));
    assert!(lo >= 0.0 && hi <= 8.0, "{lo} {hi}");
    assert!(!limited["warnings"].to_string().contains("no limits given"), "{}", limited["warnings"]);
}

#[test]
fn what_gives_no_loop_is_refused() {
    let folder = Folder::new("tune-wrong");
    let flat: String = (0..100).map(|row| format!("{row},1.0,2.0\n")).collect();
    folder.write("flat.csv", &format!("t,u,y\n{flat}"));
    let output = folder.run(&["tune", "flat.csv"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(3), ""));
    assert!(text(&output.stderr).contains("help: "), "{}", text(&output.stderr));
    folder.write("valve.csv", &valve());
    let shown = folder.refused(&["tune", "valve.csv", "--input", "Pumpe"]);
    assert!(shown.contains("Pumpe"), "{shown}");
    let shown = folder.refused(&["tune", "valve.csv", "--method", "advise", "--save", "a.toml"]);
    assert!(shown.contains("need one method"), "{shown}");
    let shown = folder.done(&["tune", "valve.csv", "--method", "advise"]);
    assert!(shown.contains("de-momi") && shown.contains("take it when"), "{shown}");
    let shown = folder.refused(&["tune", "valve.csv", "--save", "valve.csv", "--force"]);
    assert!(shown.contains("is the log itself"), "{shown}");
    let columns = ["--input", "2", "--output", "3", "--time", "1"];
    let quiet = json(&folder.run(
        &[&["tune", "valve.csv", "--kpidn", "100", "--limits", "35:45", "--json"][..], &columns].concat(),
    ));
    let warned = quiet["warnings"].as_array().is_some_and(|all| {
        all.iter().filter_map(Value::as_str).any(|one| one.contains("times the noise gain"))
    });
    assert!(warned || quiet["error"].is_object(), "{quiet}");
}

/// A pressure in Pa, beyond the default range of 1e6: the file has ranges around it.
#[test]
fn a_pressure_in_pascal_is_tuned_and_run() {
    let folder = Folder::new("tune-pascal");
    let mut text = "time [s],valve [%],pressure [Pa]\n".to_owned();
    for row in 0..600 {
        let t = 0.5 * f64::from(row);
        let x = (t - 22.0).max(0.0);
        let step = 1.0 - (20.0 * (-x / 20.0).exp() - 6.0 * (-x / 6.0).exp()) / 14.0;
        text.push_str(&format!("{t:.1},{},{:.0}\n", if t < 20.0 { 40 } else { 50 }, 2.4e6 + 1.5e5 * step));
    }
    folder.write("pa.csv", &text);
    for limits in [&["--limits", "0:100"][..], &[]] {
        let arguments = [&["tune", "pa.csv", "--save", "pa.toml", "--force", "--json"][..], limits].concat();
        let tuned = json(&folder.run(&arguments));
        check(&tuned);
        assert!(!tuned["warnings"].to_string().contains("fallback"), "{}", tuned["warnings"]);
        let run = json(&folder.run(&["run", "pa.toml", "--json"]));
        assert!(run["warnings"].as_array().is_some_and(Vec::is_empty), "{}", run["warnings"]);
        // The recorded change, 1.5e5 Pa: a dead loop has the whole of it as its error to the end.
        let iae = number(&run["controllers"][0]["events"][0]["metrics"]["iae"]);
        assert!(iae > 0.0 && iae < 1.5e5 * 60.0, "{iae}");
    }
}

/// A first move into the limit is told from a loop that has room.
#[test]
fn a_limit_that_is_reached_is_said() {
    let folder = Folder::new("tune-limit");
    folder.write("valve.csv", &valve());
    let columns = ["--input", "Ventil", "--output", "Temperatur", "--time", "Zeit", "--method", "momi"];
    let tuned = |limits: &str| {
        let arguments = [&["tune", "valve.csv", "--limits", limits, "--json"][..], &columns].concat();
        json(&folder.run(&arguments))["warnings"].to_string()
    };
    assert!(tuned("29:46").contains("the output is at its limit 46"), "{}", tuned("29:46"));
    assert!(!tuned("-1000:1000").contains("limit"), "{}", tuned("-1000:1000"));
}

/// The noise passes through the whole controller: PID and estimator together, in the closed loop.
#[test]
fn noise_is_warned_of_by_the_gain_of_the_whole_controller() {
    let folder = Folder::new("tune-noise");
    folder.write("valve.csv", &valve());
    let columns = ["--input", "Ventil", "--output", "Temperatur", "--time", "Zeit"];
    let tuned =
        json(&folder.run(&[&["tune", "valve.csv", "--limits", "37:38", "--json"][..], &columns].concat()));
    let warnings: Vec<&str> =
        tuned["warnings"].as_array().expect("warnings").iter().filter_map(Value::as_str).collect();
    let said = warnings.iter().find(|text| text.starts_with("its noise (one sigma)")).expect("a warning");
    let gain = said.split("noise gain ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a gain");
    let white = number(&tuned["design"]["discrete"]["noise"]["white"]);
    assert!((gain.parse::<f64>().expect("a number") / white - 1.0).abs() < 1e-4, "{said}: {white}");
}
