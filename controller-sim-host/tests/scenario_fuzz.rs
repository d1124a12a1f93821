//! Any text at all: never a panic, and every place inside the text.

use controller_sim_host::demo;
use controller_sim_host::output::{Severity, Source, Trouble, error_json, render};
use controller_sim_host::scenario::{Fault, Files, SourceText, override_key, read, read_with};
use controller_sim_host::simulate::Precision;

const TEXTS: [&str; 7] = [
    demo::SCENARIO,
    include_str!("../scenarios/windup.toml"),
    include_str!("../scenarios/sensor.toml"),
    include_str!("data/base.toml"),
    include_str!("../scenarios/two-tank.toml"),
    RIGS,
    SEVERAL,
];

/// Plants that are not linear, and an actuator that sticks.
const RIGS: &str = r#"version = 1
ts = 0.5
duration = 20.0
[plant]
heater = { gain = 0.8, gain_cool = 0.1, tau_heat = 60.0, tau_cool = 240.0, ambient = 20.0, sensor_lag = 10.0, dead_time = 6.0 }
[initial]
setpoint = 30.0
[actuator]
lo = 0.0
hi = 100.0
deadband = 0.1
stiction = { band = 3.0, jump = 1.0 }
[[event]]
at = 1.0
disturbance = { ramp = 1.0, duration = 5.0 }
[[controller]]
name = "PI"
design = { method = "simc" }
limits = { lo = 0.0, hi = 100.0 }
"#;

/// A scenario with a sweep, and the files that it names.
const SEVERAL: &str = include_str!("data/several/scenario.toml");
const DESIGN: &str = include_str!("data/several/loop.toml");
const LOG: &str = include_str!("data/several/log.csv");

/// The two files, as they are or not.
struct Two {
    design: String,
    log: String,
}

impl Files for Two {
    fn load(&self, path: &str) -> Result<String, String> {
        match path {
            "loop.toml" => Ok(self.design.clone()),
            "log.csv" => Ok(self.log.clone()),
            _ => Err(format!("there is no file `{path}`; did you mean `log.csv`?")),
        }
    }
}

/// What is put in: characters that mean something in TOML or in expressions, and some that mean trouble.
const PIECES: [&str; 36] = [
    "{",
    "}",
    "[",
    "]",
    "[[",
    "]]",
    "=",
    ",",
    ".",
    "\"",
    "\"\"\"",
    "'",
    "\n",
    "\r\n",
    "\r",
    "#",
    "\\",
    "\\u00e9",
    "\u{e9}",
    "\u{1f600}",
    "\u{feff}",
    "\u{0}",
    "\t",
    " ",
    "-",
    "1e999",
    "nan",
    "inf",
    "0",
    "1e-300",
    "-1",
    "99999999999999999999",
    "s",
    "exp(",
    ")",
    "true",
];

/// A small generator with a fixed start: the same texts on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

/// A random character boundary of `text`.
fn place(text: &str, random: &mut Random) -> usize {
    let at = random.below(text.len() + 1);
    (0..=at).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

fn mutate(text: &mut String, random: &mut Random) {
    match random.below(6) {
        0 => {
            let piece = PIECES[random.below(PIECES.len())];
            text.insert_str(place(text, random), piece);
        }
        1 => {
            let start = place(text, random);
            let length = random.below(12);
            let end = (start..text.len()).filter(|&i| text.is_char_boundary(i)).nth(length);
            text.replace_range(start..end.unwrap_or(text.len()), "");
        }
        2 => text.truncate(place(text, random)),
        3 => {
            let mut lines: Vec<&str> = text.lines().collect();
            let (from, to) = (random.below(lines.len()), random.below(lines.len()));
            if let Some(line) = lines.get(from).copied() {
                lines.insert(to, line);
            }
            *text = lines.join("\n");
        }
        4 => {
            let mut lines: Vec<&str> = text.lines().collect();
            if !lines.is_empty() {
                lines.remove(random.below(lines.len()));
            }
            *text = lines.join("\n");
        }
        _ => {
            let (start, piece) = (place(text, random), PIECES[random.below(PIECES.len())]);
            let end = (start + 1..=text.len()).find(|&i| text.is_char_boundary(i)).unwrap_or(text.len());
            text.replace_range(start..end, piece);
        }
    }
}

fn check(text: &str, faults: &[Fault], severity: Severity) {
    for fault in faults {
        let own = text;
        let text = fault.source.as_ref().map_or(own, |source| &source.text);
        for span in std::iter::once(&fault.span).chain(fault.related.as_ref().map(|related| &related.span)) {
            assert!(text.get(span.clone()).is_some(), "{span:?} is not in:\n{text}\n{fault:?}");
        }
        assert!(!fault.message.is_empty() && !fault.message.contains('\n'), "{fault:?}");
        let place = fault.place(own);
        assert!(place.line <= text.matches('\n').count() + 1, "{fault:?}");
    }
    let source = Source { name: "fuzz.toml", text };
    for colours in [false, true] {
        let shown = render(source, faults, severity, colours);
        assert_eq!(shown.is_empty(), faults.is_empty());
    }
    let json = error_json(&[Trouble::Scenario(
        SourceText { name: "fuzz.toml".to_owned(), text: text.to_owned() },
        faults.to_vec(),
    )]);
    assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok(), "{json}");
}

/// Whether the text is good; every message of it is checked.
fn check_reading(text: &str, precision: Precision, files: &dyn Files) -> bool {
    match read_with("fuzz.toml", text, precision, files) {
        Ok(read) => {
            assert!(!read.cases.is_empty());
            check(text, &read.warnings, Severity::Warning);
            true
        }
        Err(faults) => {
            assert!(!faults.is_empty(), "no reason given for:\n{text}");
            check(text, &faults, Severity::Error);
            false
        }
    }
}

#[test]
fn no_text_makes_the_reader_panic() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut good, mut bad) = (0, 0);
    for round in 0..4000 {
        let mut text = TEXTS[round % TEXTS.len()].to_owned();
        let mut files = Two { design: DESIGN.to_owned(), log: LOG.to_owned() };
        let changed = match round % (4 * TEXTS.len()) {
            6 => &mut files.design,
            13 => &mut files.log,
            _ => &mut text,
        };
        for _ in 0..=random.below(4) {
            mutate(changed, &mut random);
        }
        let precision = if round % 2 == 0 { Precision::F64 } else { Precision::F32 };
        if check_reading(&text, precision, &files) {
            good += 1;
        } else {
            bad += 1;
        }
    }
    // Both kinds must be among them, or the test shows nothing.
    assert!(good > 100 && bad > 1000, "{good} good, {bad} bad");
}

/// Any path and any value: either a text that can be read, for better or worse, or a fault inside the old one.
#[test]
fn no_key_makes_overriding_panic() {
    let parts = [
        "controller",
        "event",
        "plant",
        "inner",
        "2",
        "observer",
        "pid",
        "kp",
        "model",
        "\"",
        ".",
        "",
        "\u{e9}",
        "title",
    ];
    let files = Two { design: DESIGN.to_owned(), log: LOG.to_owned() };
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let (mut good, mut set) = (0, 0);
    for _ in 0..3000 {
        let count = 1 + random.below(4);
        let key: Vec<&str> = (0..count).map(|_| parts[random.below(parts.len())]).collect();
        let value = PIECES[random.below(PIECES.len())];
        match override_key(SEVERAL, &key.join("."), value) {
            Ok(text) => {
                set += 1;
                good += usize::from(check_reading(&text, Precision::F64, &files));
            }
            Err(fault) => check(SEVERAL, &[fault], Severity::Error),
        }
    }
    assert!(set > 300 && good > 3, "{set} set, {good} good");
}

#[test]
fn odd_texts() {
    let deep = format!("a = {}", "[".repeat(50_000));
    let nested = format!("plant = {}", "{ a = ".repeat(50_000));
    let long = format!("version = 1\nname = \"{}\"\n", "x".repeat(1_000_000));
    let dotted = format!("{} = 1\n", ["a"; 5_000].join("."));
    for text in
        ["", "\n", "\u{feff}", "\u{0}", "=", "[", "[[", "\"", "'''", "\r", &deep, &nested, &long, &dotted]
    {
        let faults = read(text, Precision::F64).expect_err("no scenario");
        check(text, &faults, Severity::Error);
    }
}
