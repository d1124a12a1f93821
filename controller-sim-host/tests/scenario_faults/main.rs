//! Mistakes in scenarios: each is named at its line and column, with the help that fits.
//!
//! How every message looks to a person is kept in `data/messages.txt`, byte for byte. After a change that is meant, look
//! at the new texts and keep them: `RENEW_MESSAGES=1 cargo test -p controller-sim-host --test scenario_faults`.

mod adrc;
mod around;
mod basics;
mod controllers;
mod odd;
mod plants;
mod several;
mod signals;
mod single;
mod text;

use controller_sim_host::output::{Severity, Source, render};
use controller_sim_host::scenario::{Fault, FolderFiles, read_with};
use controller_sim_host::simulate::Precision;
use std::fmt::Write;

/// The scenario that the mistakes are made in. The numbers of its lines stand in the tables.
const BASE: &str = include_str!("../data/base.toml");

/// The files that it may name.
const FILES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/files");

/// How every message looks.
const MESSAGES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/messages.txt");

/// `(code, line, column, part of the message, part of the help)`; the help is empty where there need be none. A fault in
/// an included file has its name behind the code, as in `syntax@loop.toml`.
type Expected = (&'static str, usize, usize, &'static str, &'static str);
/// What is replaced by what, in the first place where it occurs, and every fault that this makes.
type Case = (&'static [(&'static str, &'static str)], &'static [Expected]);

const GAINS: &str = "kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119";
const LIMITS: &str = "limits = { lo = -10.0, hi = 10.0 }";
const WIDE: &str = "limits = { lo = -1e12, hi = 1e12 }\nmeasurement = { lo = -1e12, hi = 1e12 }";
const PLANT: &str = "exp(-0.2*s)/((1+0.2*s)*(1+s))";
const TF: &str = "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"";
const MODEL: &str = "model = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"";
const EVENT: &str = "disturbance = 1.0";
const VERSION: &str = "version = 1";
const LAST: &str = "kfd = 0.69, tfd = 0.06 }";

const TABLES: [&[Case]; 8] = [
    text::CASES,
    basics::CASES,
    controllers::CASES,
    signals::CASES,
    around::CASES,
    plants::CASES,
    several::CASES,
    adrc::CASES,
];

fn edited(edits: &[(&str, &str)]) -> String {
    let mut text = BASE.to_owned();
    for (from, to) in edits {
        assert!(text.contains(from), "`{from}` is not in the base");
        text = text.replacen(from, to, 1);
    }
    text
}

/// Everything that is wrong, or else everything that is odd.
fn found(text: &str, precision: Precision) -> Result<Vec<Fault>, Vec<Fault>> {
    read_with("s.toml", text, precision, &FolderFiles::new(FILES)).map(|read| read.warnings)
}

fn faults(text: &str, precision: Precision) -> Vec<Fault> {
    found(text, precision).expect_err(text)
}

fn shown(text: &str, faults: &[Fault], severity: Severity) -> String {
    render(Source { name: "s.toml", text }, faults, severity, false)
}

/// What differs between the faults that were found and those expected; empty when nothing does.
fn differences(text: &str, found: &[Fault], expected: &[Expected]) -> String {
    let shown = shown(text, found, Severity::Error);
    let mut wrong = Vec::new();
    if found.len() != expected.len() {
        wrong.push(format!("{} faults instead of {}", found.len(), expected.len()));
    }
    for (fault, (code, line, column, message, help)) in found.iter().zip(expected) {
        let place = fault.place(text);
        let (code, name) = code.split_once('@').unwrap_or((code, "s.toml"));
        if (fault.code, place.line, place.column) != (code, *line, *column) {
            let at = format!("{} at {}:{}", fault.code, place.line, place.column);
            wrong.push(format!("not {code} at {line}:{column} but {at}"));
        }
        let said = fault.help.as_deref().unwrap_or("");
        for (part, whole) in [(message, &*fault.message), (help, said)] {
            if !whole.contains(part) {
                wrong.push(format!("`{part}` is not in `{whole}`"));
            }
        }
        if fault.message.ends_with('.') || fault.message.contains('\n') {
            wrong.push(format!("`{}` is not one line without a full stop", fault.message));
        }
        if !shown.contains(&format!("{name}:{line}:{column}")) {
            wrong.push(format!("{name}:{line}:{column} is not shown"));
        }
    }
    if wrong.is_empty() { String::new() } else { format!("{}\n{shown}", wrong.join("\n")) }
}

/// Every place lies inside its text, and on character boundaries.
fn check_places(text: &str, faults: &[Fault]) {
    for fault in faults {
        let text = fault.source.as_ref().map_or(text, |source| &source.text);
        for span in std::iter::once(&fault.span).chain(fault.related.as_ref().map(|related| &related.span)) {
            assert!(text.get(span.clone()).is_some(), "{span:?} is not in:\n{text}\n{fault:?}");
        }
    }
}

#[test]
fn the_base_is_good() {
    assert_eq!(found(BASE, Precision::F32), Ok(Vec::new()));
}

#[test]
fn every_fault_is_named_at_its_place() {
    let mut wrong = String::new();
    let mut count = 0;
    for (edits, expected) in TABLES.into_iter().flatten() {
        count += 1;
        let text = edited(edits);
        match found(&text, Precision::F64) {
            Ok(_) => wrong.push_str(&format!("{edits:?}:\nwas read\n")),
            Err(faults) => {
                check_places(&text, &faults);
                let differences = differences(&text, &faults, expected);
                if !differences.is_empty() {
                    wrong.push_str(&format!("{edits:?}:\n{differences}\n"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(count >= 250, "{count} cases");
}

/// What a person sees of every mistake, and of everything odd.
#[test]
fn every_message_looks_as_it_did() {
    let mut all =
        String::from("How every message of a scenario looks; written by the test `scenario_faults`.\n");
    let cases = TABLES.into_iter().flatten().map(|case| (case, Severity::Error));
    for ((edits, _), severity) in cases.chain(odd::CASES.iter().map(|case| (case, Severity::Warning))) {
        let text = edited(edits);
        let list = match found(&text, Precision::F64) {
            Ok(list) | Err(list) => list,
        };
        if list.is_empty() {
            continue;
        }
        let _ = writeln!(all, "\n{}", "=".repeat(100));
        for (old, new) in *edits {
            let _ = writeln!(all, "{old:?} -> {new:?}");
        }
        let _ = writeln!(all, "\n{}", shown(&text, &list, severity).trim_end());
    }
    if std::env::var_os("RENEW_MESSAGES").is_some() {
        std::fs::write(MESSAGES, &all).expect("the messages can be written");
        return;
    }
    let kept = std::fs::read_to_string(MESSAGES).expect("the messages are there");
    let differing = kept.lines().zip(all.lines()).position(|(old, new)| old != new);
    assert!(
        kept == all,
        "line {} of {MESSAGES} is different now:\n{}",
        differing.map_or(kept.lines().count().min(all.lines().count()), |at| at) + 1,
        differing.and_then(|at| all.lines().nth(at)).unwrap_or("")
    );
}

#[test]
fn a_text_without_anything_has_one_fault() {
    for (text, message) in [("", "is empty"), (" \n\n", "is empty"), ("# later\n", "has comments only")] {
        let found = faults(text, Precision::F64);
        assert_eq!(differences(text, &found, &[("missing-key", 1, 1, message, "demo --save")]), "");
    }
}

#[test]
fn odd_scenarios_are_read_with_warnings() {
    let mut wrong = String::new();
    for (edits, expected) in odd::CASES {
        let text = edited(edits);
        let found = found(&text, Precision::F64).unwrap_or_else(|faults| panic!("{edits:?}: {faults:?}"));
        check_places(&text, &found);
        let differences = differences(&text, &found, expected);
        if !differences.is_empty() {
            wrong.push_str(&format!("{edits:?}:\n{differences}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A text with a million mistakes is refused as soon as nobody would read on.
#[test]
fn the_number_of_faults_has_a_limit() {
    let text: String = (0..20_000).map(|i| format!("key{i} = 1\n")).collect();
    assert_eq!(faults(&text, Precision::F64).len(), 100);
}
