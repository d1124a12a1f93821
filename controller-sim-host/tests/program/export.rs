//! A loop for the target, on the command line.

use crate::folder::{BASE, Folder, json, keys, text};

const TWO: &str = "
version = 1
ts = 0.1
duration = 5.0
[plant]
tf = \"1/(1+s)\"
[[controller]]
name = \"first\"
pid = { kp = 1.0, ki = 1.0 }
[[controller]]
name = \"second\"
pid = { kp = 2.0, ki = 1.0 }
estimator = { gain = 1.0, a1 = 1.0, a2 = 0.0, dead_time = 1.0, kfd = 0.5, tfd = 0.5 }
limits = { lo = -10.0, hi = 10.0 }
measurement = { lo = -5.0, hi = 5.0 }
";

#[test]
fn a_loop_is_written_to_the_screen_or_to_a_file() {
    let folder = Folder::new("export");
    folder.write("two.toml", TWO);
    let shown = folder.done(&["export", "two.toml", "--format", "rust", "--controller", "second"]);
    for part in [
        "//! second: the loop of `two.toml`",
        "kp: 2.0,",
        "pub const CAPACITY: usize = 11;",
        "const _: () = assert!(",
    ] {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
    let saved = ["export", "two.toml", "--format", "rust", "--controller", "second", "--save", "law.rs"];
    assert_eq!(folder.done(&saved), "wrote law.rs\n");
    assert_eq!(folder.read("law.rs"), shown);
    let again = folder.run(&saved);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("--force"), "{}", text(&again.stderr));
    let object = json(&folder.run(&[
        "export",
        "two.toml",
        "--format",
        "rust",
        "--controller",
        "second",
        "--precision",
        "f64",
        "--json",
    ]));
    assert_eq!(
        keys(&object).join(" "),
        "version controller format precision ts capacity text warnings saved"
    );
    assert!(object["text"].as_str().is_some_and(|text| text.contains("Controller<f64")));
    assert!(object["saved"].is_null());
}

#[test]
fn what_cannot_be_exported_says_what_to_do() {
    let folder = Folder::new("export-refused");
    folder.write("two.toml", TWO);
    folder.write("base.toml", BASE);
    let fails = |arguments: &[&str], code: i32, part: &str| {
        let output = folder.run(&[&["export", "--format", "rust"], arguments].concat());
        let said = text(&output.stderr);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(code), ""), "{said}");
        assert!(said.contains(part), "`{part}` is not in:\n{said}");
    };
    fails(&["two.toml"], 2, "`first`, `second`");
    fails(&["two.toml", "--controller", "secnd"], 2, "did you mean `second`?");
    fails(&["two.toml", "--controller", "second", "--capacity", "4"], 3, "--capacity");
    fails(&["two.toml", "--controller", "first", "--save", "no/law.rs"], 2, "mkdir -p no");
    fails(&["absent.toml"], 2, "absent.toml");
    assert_eq!(folder.names(), ["base.toml", "two.toml"]);
}

/// What the help shows can be typed.
#[test]
fn the_example_of_set_works_on_a_designed_loop() {
    let folder = Folder::new("export-set");
    let plant = "exp(-0.2*s)/((1+0.2*s)*(1+s))";
    folder.done(&["design", "--plant", plant, "--method", "de-momi", "--ts", "0.01", "--save", "loop.toml"]);
    let help = folder.done(&["export", "--help"]);
    let example = help.split("--set '").nth(1).and_then(|rest| rest.split('\'').next()).expect("an example");
    let shown = folder.done(&["export", "loop.toml", "--format", "rust", "--set", example]);
    assert!(shown.contains("kp: 2.0,"), "{example}\n{shown}");
}

#[test]
fn a_loop_is_written_for_a_plc() {
    let folder = Folder::new("export-st");
    folder.write("two.toml", TWO);
    let export = |format: &str, more: &[&str]| {
        let arguments = ["export", "two.toml", "--controller", "second", "--format", format];
        folder.done(&[&arguments, more].concat())
    };
    let block = export("st", &[]);
    for part in ["FUNCTION_BLOCK FB_SECOND\n", "    KP : REAL := 2.0;", "(* second: the loop of two.toml"] {
        assert!(block.contains(part), "`{part}` is not in:\n{block}");
    }
    assert!(export("st", &["--precision", "f64"]).contains("    KP : LREAL := 2.0;"));
    assert!(export("st-test", &[]).starts_with("PROGRAM TEST_SECOND\n"));
    let header = export("c", &[]);
    for part in ["#define LOOP_SECOND_TS 0.1\n", "#define LOOP_SECOND_DELAY 10\n", "config->kfd = 0.5;"] {
        assert!(header.contains(part), "`{part}` is not in:\n{header}");
    }
    assert_eq!(export("st", &["--save", "second.st"]), "wrote second.st\n");
    assert_eq!(folder.read("second.st"), block);
    let arguments = ["export", "two.toml", "--controller", "second", "--format", "st", "--json"];
    let object = json(&folder.run(&arguments));
    assert_eq!((object["format"].as_str(), object["text"].as_str()), (Some("st"), Some(&*block)));
}

#[test]
fn a_plc_gets_no_adrc() {
    let folder = Folder::new("export-st-adrc");
    let (base, _) = TWO.split_once("[[controller]]").expect("controllers");
    let adrc = "[[controller]]\nname = \"a\"\nadrc = { b0 = 5.0, kp = 4.0, kd = 4.0, beta1 = 24.0, beta2 = 192.0, beta3 = 512.0 }\n";
    folder.write("adrc.toml", &[base, adrc].concat());
    for format in ["st", "st-test", "c"] {
        let output = folder.run(&["export", "adrc.toml", "--format", format]);
        let said = text(&output.stderr);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(3), ""), "{said}");
        assert!(said.contains("`a` is an ADRC") && said.contains("--format rust"), "{said}");
    }
    let output = folder.run(&["export", "adrc.toml", "--format", "st", "--json"]);
    assert_eq!((output.status.code(), json(&output)["error"]["code"].as_str()), (Some(3), Some("refused")));
}

/// Two loops; of each there is something to warn of, and only the first one has its ranges.
const WARNED: &str = "
version = 1
ts = 0.1
duration = 5.0
[plant]
tf = \"1/(1+s)\"
[[controller]]
name = \"given\"
pid = { kp = 1.0, ki = 1.0, kd = 0.1, tf = 0.06 }
limits = { lo = -5.0, hi = 5.0 }
measurement = { lo = -3.0, hi = 3.0 }
[[controller]]
name = \"open\"
pid = { kp = 1.0, ki = 1.0, kd = 0.1, tf = 0.07 }
setpoint = { lo = 0.0, hi = 0.5 }
[[event]]
at = 1.0
setpoint = 1.0
";

#[test]
fn only_what_concerns_the_loop_is_warned_of() {
    let folder = Folder::new("export-warnings");
    folder.write("two.toml", WARNED);
    let said = |controller: &str, format: &str| {
        let output = folder.run(&["export", "two.toml", "--controller", controller, "--format", format]);
        assert!(output.status.success());
        text(&output.stderr).to_owned()
    };
    for format in ["rust", "st", "st-test", "c"] {
        let (given, open) = (said("given", format), said("open", format));
        assert!(
            given.contains("tf = 0.06") && !given.contains("tf = 0.07") && !given.contains("open"),
            "{given}"
        );
        assert!(
            open.contains("tf = 0.07") && !open.contains("tf = 0.06") && !open.contains("given"),
            "{open}"
        );
        assert!(open.contains("`setpoint` of `open`"), "{open}");
        assert!(!given.contains("open-range"), "{given}");
        assert_eq!(
            open.matches("warning[open-range]").count(),
            if format == "rust" { 0 } else { 2 },
            "{open}"
        );
    }
    let open = said("open", "st");
    for part in
        ["`limits = { lo = 0.0, hi = 100.0 }`", "`measurement = { lo = 0.0, hi = 100.0 }`", "-1000000.0"]
    {
        assert!(open.contains(part), "`{part}` is not in:\n{open}");
    }
    for format in ["st", "st-test", "c"] {
        let file = |controller| {
            let arguments = ["export", "two.toml", "--controller", controller, "--format", format];
            text(&folder.run(&arguments).stdout).to_owned()
        };
        assert!(!file("given").contains("WARNING"), "{format}");
        let open = file("open");
        assert_eq!(open.matches("WARNING: ").count(), 2, "{open}");
        assert!(
            open.contains("key limits with lo and hi") && open.contains("key measurement with"),
            "{open}"
        );
    }
    let object =
        json(&folder.run(&["export", "two.toml", "--controller", "open", "--format", "st", "--json"]));
    let codes: Vec<&str> = object["warnings"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|warning| warning["code"].as_str().expect("a code"))
        .collect();
    assert_eq!(codes, ["fast-filter", "clamped", "open-range", "open-range"]);
}

/// The words of a line of a shell, quotes taken off.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (n, part) in line.split('\'').enumerate() {
        if n % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// The page for the PLC can be followed as it is written.
#[test]
fn the_page_leads_to_a_block() {
    let page = include_str!("../../../controller-capi/iec/EXPORTED.md");
    let folder = Folder::new("export-page");
    let commands: Vec<Vec<String>> = page
        .lines()
        .filter_map(|line| line.trim().strip_prefix("cargo run --release -p controller-sim-host -- "))
        .map(words)
        .collect();
    let [design, export] = &*commands else { panic!("{commands:?}") };
    let run = |words: &[String]| folder.done(&words.iter().map(String::as_str).collect::<Vec<_>>());
    run(design);
    let line = page.lines().map(str::trim).find(|line| line.starts_with("measurement = ")).expect("a line");
    let file = folder.read("loop.toml");
    let limits = file.lines().find(|line| line.starts_with("limits = ")).expect("limits");
    folder.write("loop.toml", &file.replace(limits, &format!("{limits}\n{line}")));
    // Nothing is warned of.
    assert_eq!(run(export), "wrote loop.st\n");
    let block = folder.read("loop.st");
    let used = page.lines().find_map(|line| line.trim().strip_prefix("TANK : ")).expect("an instance");
    assert!(block.starts_with(&format!("FUNCTION_BLOCK {}\n", used.trim_end_matches(';'))), "{used}");
    assert!(block.contains("Call it once every 0.1 s,") && !block.contains("WARNING"), "{block}");
}
