//! Margins on the command line.

use crate::folder::{BASE, Folder, json, keys, text};

const LOOP: [&str; 10] = [
    "analyze",
    "--plant",
    "exp(-0.2*s)/((1+0.2*s)*(1+s))",
    "--kp",
    "2",
    "--ki",
    "1.6",
    "--ts",
    "0.01",
    "--json",
];

#[test]
fn a_loop_from_the_command_line_has_the_documented_shape() {
    let folder = Folder::new("analyze-typed");
    let output = folder.run(&LOOP);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
    let analysis = json(&output);
    assert_eq!(
        keys(&analysis).join(" "),
        "version scenario title case plant ts latency files controllers warnings"
    );
    let one = &analysis["controllers"][0];
    assert_eq!(keys(one).join(" "), "name refused stable unstable_poles continuous discrete warnings");
    let robustness = &one["discrete"]["robustness"];
    assert_eq!(
        keys(robustness).join(" "),
        "ms omega_ms mt omega_mt gm gm_low pm_deg delay_margin delay_margin_samples"
    );
    assert_eq!(keys(&one["discrete"]["noise"]).join(" "), "kpidn kden controller an white");
    let number = |form: &str, part: &str, key: &str| one[form][part][key].as_f64().expect("a number");
    // The hold takes half a sample of delay margin; the summed integral, with ki*ts/2 more gain, some more.
    let lost =
        number("continuous", "robustness", "delay_margin") - number("discrete", "robustness", "delay_margin");
    assert!(lost > 0.005 && lost < 0.01, "{lost}");
    let samples = number("discrete", "robustness", "delay_margin_samples");
    assert!((samples * 0.01 - number("discrete", "robustness", "delay_margin")).abs() < 1e-12);
    // A PI: kp at high frequency, kp + ki*ts in the same sample.
    assert!((number("continuous", "noise", "an") - 2.0).abs() < 1e-12);
    assert!((number("discrete", "noise", "an") - 2.016).abs() < 1e-12);
    assert!(one["continuous"]["noise"]["white"].is_null());
    assert_eq!(folder.names(), [] as [&str; 0]);
}

#[test]
fn each_controller_of_a_scenario_is_analysed() {
    let folder = Folder::new("analyze-scenario");
    folder.write("s.toml", BASE);
    let shown = folder.done(&["analyze", "s.toml"]);
    for part in ["continuous", "sampled", "Ms, largest", "delay margin", "samples", "K_PIDn", "white noise"] {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    assert!(shown.lines().all(|line| line.chars().count() <= 100 && line.trim_end() == line), "{shown}");
    let analysis = json(&folder.run(&["analyze", "s.toml", "--json"]));
    let run = json(&folder.run(&["run", "s.toml", "--json"]));
    let names = |value: &serde_json::Value| -> Vec<String> {
        value["controllers"].as_array().expect("a list").iter().map(|c| c["name"].to_string()).collect()
    };
    assert_eq!(names(&analysis), names(&run));
    let late = json(&folder.run(&["analyze", "s.toml", "--json", "--set", "latency=0.05"]));
    let ms = |value: &serde_json::Value| value["controllers"][0]["discrete"]["robustness"]["ms"].as_f64();
    assert!(ms(&late) > ms(&analysis));
}

#[test]
fn an_unstable_loop_is_refused() {
    let folder = Folder::new("analyze-unstable");
    let mut arguments = LOOP;
    arguments[4] = "50";
    let output = folder.run(&arguments);
    assert_eq!(output.status.code(), Some(3));
    let error = json(&output);
    assert_eq!(error["error"]["code"], "unstable");
    assert!(error["error"]["message"].as_str().expect("text").contains("2 poles outside the unit circle"));
    let output = folder.run(&arguments[..9]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(3), ""));
}

#[test]
fn slow_sampling_is_warned_of() {
    let folder = Folder::new("analyze-slow");
    let mut arguments = LOOP;
    arguments[8] = "0.1";
    let analysis = json(&folder.run(&arguments));
    let warnings = analysis["controllers"][0]["warnings"].to_string();
    assert!(warnings.contains("below 10: ts is too long"), "{warnings}");
}

#[test]
fn mistakes_are_told_with_their_place() {
    let folder = Folder::new("analyze-mistakes");
    for (arguments, part) in [
        (&["analyze"][..], "FILE"),
        (&["analyze", "--plant", "1/(1+s)", "--kp", "1"], "--ts"),
        (&["analyze", "--plant", "1/(1+", "--kp", "1", "--ts", "0.1"], "^"),
        (&["analyze", "--plant", "1/(1+s)", "--kd", "1", "--ts", "0.1"], "tf"),
        (&["analyze", "--plant", "1/(1+s)", "--kp", "1", "--ts", "-1"], "ts"),
        (&["analyze", "none.toml"], "none.toml"),
        (&["analyze", "--plant", "1/(1+s)", "--kp", "1", "--ts", "0.1", "--force"], "--report"),
    ] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(part), "{arguments:?}: {}", text(&output.stderr));
    }
}

#[test]
fn a_report_is_written_once_and_the_same_every_time() {
    let folder = Folder::new("analyze-report");
    folder.write("s.toml", BASE);
    let shown = folder.done(&["analyze", "s.toml", "--report", "r.html"]);
    assert!(shown.contains("wrote r.html"), "{shown}");
    let first = folder.read("r.html");
    for part in ["Nyquist plot", "Sensitivity", "frequency [rad/s]", "Phase of L", "Ms = ", "noise to output"]
    {
        assert!(first.contains(part), "`{part}`");
    }
    for outside in ["http://", "https://", "src=", "NaN", "inf "] {
        assert!(!first.contains(outside), "`{outside}`");
    }
    assert!(folder.refused(&["analyze", "s.toml", "--report", "r.html"]).contains("--force"));
    folder.done(&["analyze", "s.toml", "--report", "r.html", "--force"]);
    // The command is on the page.
    let shown = |page: &str| page.split("How this page was made").next().map(str::to_owned);
    assert!(shown(&folder.read("r.html")) == shown(&first), "another page");
    assert!(
        folder.refused(&["analyze", "s.toml", "--report", "s.toml", "--force"]).contains("not overwritten")
    );
    assert_eq!(folder.read("s.toml"), BASE);
}
