//! Design files that a scenario includes.

use controller_sim_host::scenario::{Change, Fault, Files, Read, ReadAll, code, read, read_with};
use controller_sim_host::simulate::Precision;
use std::collections::BTreeMap;

const DESIGN: &str = r#"version = 1
title = "the design"
ts = 0.1
duration = 50
latency = 0.05
substeps = 3
[units]
y = "bar"
[plant]
tf = "2*exp(-s)/(1+10*s)"
[initial]
setpoint = 1.0
[noise]
std = 0.01
[sensor]
lo = -5
[actuator]
hi = 7
[[event]]
at = 1
setpoint = 2.0
[[controller]]
name = "designed"
pid = { kp = 2.0, ki = 0.2 }
"#;

struct InMemory(BTreeMap<String, String>);

impl Files for InMemory {
    fn load(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| format!("there is no file `{path}`"))
    }
}

fn files(list: &[(&str, &str)]) -> InMemory {
    InMemory(list.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect())
}

fn all(text: &str, list: &[(&str, &str)]) -> Result<ReadAll, Vec<Fault>> {
    read_with("s.toml", text, Precision::F64, &files(list))
}

/// A text, the files, the code and a part of the fault.
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a str, &'a str);

fn one(text: &str, list: &[(&str, &str)]) -> Read {
    let mut all = all(text, list).unwrap_or_else(|faults| panic!("{text}: {faults:?}"));
    assert_eq!(all.cases.len(), 1);
    Read { scenario: all.cases.remove(0).scenario, warnings: all.warnings }
}

/// Where each fault is - the file, empty for the scenario itself, line and column - and what it says.
fn faults(text: &str, list: &[(&str, &str)]) -> Vec<(String, usize, usize, &'static str, String)> {
    let shown = |fault: Fault| {
        let place = fault.place(text);
        let name = fault.source.as_ref().map_or(String::new(), |source| source.name.clone());
        (
            name,
            place.line,
            place.column,
            fault.code,
            format!("{} | {}", fault.message, fault.help.unwrap_or_default()),
        )
    };
    all(text, list).expect_err(text).into_iter().map(shown).collect()
}

#[test]
fn a_design_file_alone_is_all_that_is_needed() {
    let mut expected = read(DESIGN, Precision::F64).expect("no faults").scenario;
    expected.title = String::new();
    assert_eq!(one("version = 1\ninclude = \"loop.toml\"\n", &[("loop.toml", DESIGN)]).scenario, expected);
    assert_eq!(one("version = 1\ninclude = [\"loop.toml\"]\n", &[("loop.toml", DESIGN)]).scenario, expected);
}

#[test]
fn what_the_scenario_says_counts() {
    let text = r#"version = 1
include = "loop.toml"
title = "mine"
ts = 0.2
[units]
u = "%"
[noise]
std = 0.5
seed = 3
[[event]]
at = 5
controller = "designed"
pid = { kp = 3.0 }
[[controller]]
name = "second"
pid = { kp = 1.0 }
"#;
    let scenario = one(text, &[("loop.toml", DESIGN)]).scenario;
    let design = read(DESIGN, Precision::F64).expect("no faults").scenario;
    assert_eq!((&*scenario.title, scenario.ts, scenario.duration), ("mine", 0.2, 50.0));
    // Tables as wholes.
    assert_eq!((&*scenario.units.y, &*scenario.units.u), ("", "%"));
    assert_eq!((&scenario.plant, scenario.initial), (&design.plant, design.initial));
    let names: Vec<&str> = scenario.controllers.iter().map(|c| &*c.name).collect();
    assert_eq!(names, ["designed", "second"]);
    assert_eq!(scenario.events.len(), 1);
    let Change::Parameters(list) = &scenario.events[0].changes[0] else { panic!("{:?}", scenario.events) };
    assert_eq!((list[0].0, list[0].1.config.pid.kp, list[0].1.config.pid.ki), (0, 3.0, 0.2));
}

#[test]
fn of_several_files_the_first_counts_and_all_controllers_are_there() {
    let other =
        DESIGN.replace("designed", "other").replace("ts = 0.1", "ts = 0.5").replace("kp = 2.0", "kp = 4.0");
    let scenario = one("version = 1\ninclude = [\"a\", \"b\"]", &[("a", DESIGN), ("b", &other)]).scenario;
    let gains: Vec<_> = scenario.controllers.iter().map(|c| (&*c.name, c.config.pid.kp)).collect();
    assert_eq!((scenario.ts, gains), (0.1, vec![("designed", 2.0), ("other", 4.0)]));
}

#[test]
fn faults_of_an_included_file_show_its_text() {
    let text = "version = 1\ninclude = \"loop.toml\"\nlatency = -1\n";
    let broken = DESIGN.replace("kp = 2.0", "Kp = 2.0").replace("y = \"bar\"", "y = 3");
    let found = faults(text, &[("loop.toml", &broken)]);
    let said: Vec<_> = found.iter().map(|f| (&*f.0, f.1, f.2, f.3)).collect();
    assert_eq!(
        said,
        [
            ("", 3, 11, code::OUT_OF_RANGE),
            ("loop.toml", 8, 5, code::WRONG_TYPE),
            ("loop.toml", 24, 9, code::UNKNOWN_KEY),
        ]
    );
    // Its syntax, beside what is certain of the rest.
    let found = faults(text, &[("loop.toml", &DESIGN.replace("duration = 50", "duration = 50 s"))]);
    let said: Vec<_> = found.iter().map(|f| (&*f.0, f.1, f.3)).collect();
    assert_eq!(said, [("", 3, code::OUT_OF_RANGE), ("loop.toml", 4, code::SYNTAX)]);
    let found = faults("version = 1\ninclude = \"loop.toml\"\n", &[("loop.toml", "{ \"a\": 1 }")]);
    assert_eq!((found.len(), &*found[0].0, found[0].3), (1, "loop.toml", code::SYNTAX));
    // An event of the scenario that a parameter of the file makes wrong.
    let text = "version = 1\ninclude = \"loop.toml\"\n[[event]]\nat = 1\nlimits = { hi = -10 }\n";
    let limited = format!("{DESIGN}limits = {{ lo = -5, hi = 5 }}\n");
    let found = faults(text, &[("loop.toml", &limited)]);
    assert_eq!((found.len(), found[0].3), (1, code::CONFLICT), "{found:?}");
    assert_eq!((&*found[0].0, found[0].1, found[0].2), ("loop.toml", 25, 17));
    assert!(found[0].4.ends_with("the upper bound: line 5 of `s.toml`"), "{found:?}");
}

#[test]
fn what_cannot_be_included() {
    let none = DESIGN.split("[[controller]]").next().expect("a beginning");
    let two = format!("{DESIGN}[[controller]]\nname = \"b\"\npid = {{ kp = 1 }}\n");
    let nested = DESIGN.replacen("version = 1", "version = 1\ninclude = \"x\"", 1);
    let swept = format!("{DESIGN}[sweep]\nkey = \"ts\"\nvalues = [1, 2]\n");
    let own = "version = 1\ninclude = \"s.toml\"\n";
    #[rustfmt::skip]
    let cases: &[Case<'_>] = &[
        ("version = 1\ninclude = \"lop\"", &[], code::FILE, "there is no file `lop`"),
        ("version = 1\ninclude = 3", &[], code::WRONG_TYPE, "`include` is a number; the name of a file"),
        (own, &[("s.toml", own)], code::FILE, "`s.toml` includes itself"),
        ("version = 1\ninclude = [\"a\", \"a\"]", &[("a", DESIGN)], code::DUPLICATE, "`a` is included twice"),
        ("version = 1\ninclude = \"a\"", &[("a", none)], code::CONFLICT, "`a` has 0 controllers; an included file has exactly one"),
        ("version = 1\ninclude = \"a\"", &[("a", &two)], code::CONFLICT, "`a` has 2 controllers"),
        ("version = 1\ninclude = \"a\"", &[("a", &nested)], code::NOT_SUPPORTED, "cannot include others"),
        ("version = 1\ninclude = \"a\"", &[("a", &swept)], code::NOT_SUPPORTED, "cannot be a sweep"),
        ("version = 1\ninclude = \"a\"", &[("a", &DESIGN.replace("version = 1\n", ""))], code::MISSING_KEY, "`version` is missing"),
        ("version = 1\ninclude = \"a\"", &[("a", &format!("x = 1\n{DESIGN}"))], code::UNKNOWN_KEY, "unknown key `x`"),
        ("version = 1\ninclude = [\"a\", \"b\"]", &[("a", DESIGN), ("b", DESIGN)], code::DUPLICATE,
            "two controllers named `designed` | give each a name of its own; the first one: line 23 of `a`"),
    ];
    for (text, list, code, part) in cases {
        let found = faults(text, list);
        assert!(found.iter().any(|f| f.3 == *code && f.4.contains(part)), "`{part}` is not in {found:?}");
        let extra = if part.contains("controllers named") || part.contains("twice") { 2 } else { 1 };
        assert!(found.len() <= extra, "{found:?}");
    }
    let text = "version = 1\ninclude = \"a\"\n";
    let found = read(text, Precision::F64).expect_err("no files here");
    assert_eq!((found.len(), found[0].code), (1, code::FILE), "{found:?}");
}

#[test]
fn a_key_of_an_included_file_is_swept() {
    let text =
        "version = 1\ninclude = \"a\"\n[sweep]\nkey = \"controller.designed.pid.kp\"\nvalues = [1, 2]\n";
    let read = all(text, &[("a", DESIGN)]).expect("no faults");
    let gains: Vec<f64> = read.cases.iter().map(|case| case.scenario.controllers[0].config.pid.kp).collect();
    assert_eq!(gains, [1.0, 2.0]);
    let text = text.replace("[1, 2]", "[1, nan]");
    let found = faults(&text, &[("a", DESIGN)]);
    assert_eq!((found.len(), &*found[0].0, found[0].1, found[0].2), (1, "", 5, 14), "{found:?}");
    // One that is not written anywhere.
    let text = text.replace("[1, nan]", "[1, 2]").replace("pid.kp", "limits.hi");
    let read = all(&text, &[("a", DESIGN)]).expect("no faults");
    assert_eq!(read.cases[0].scenario.controllers[0].config.limits.hi, 1.0);
    // A fault elsewhere in that file keeps its place.
    let found = faults(&text, &[("a", &DESIGN.replace("ki = 0.2", "Ki = 0.2"))]);
    assert_eq!((found.len(), &*found[0].0, found[0].1, found[0].2), (1, "a", 24, 19), "{found:?}");
}
