//! An exported block and `CTL_LOOP` of the C interface speak one language: what has the same name has the same type, the same
//! codes, the same meaning. Where they differ is in the tables here, and on the page of the exported block.

use crate::loops::{all, scenario};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::simulate::Precision;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Inputs and outputs that only exported blocks have.
const ONLY_EXPORTED: &[&str] = &["OP_UNLIM"];

/// Inputs and outputs that only `CTL_LOOP` has: a measured period, counts and spans, a restart by command, the parameters,
/// which are numbers of the design in an exported block, and errors by number.
const ONLY_CTL_LOOP: &[&str] = &[
    "TCYC",
    "PERIOD",
    "SCAN_DIV",
    "RESTART",
    "PV_RAW",
    "PV_SRC",
    "PV_RAW_LO",
    "PV_RAW_HI",
    "OP_RAW",
    "OP_RAW_LO",
    "OP_RAW_HI",
    "OP_PERCENT",
    "KP_PERCENT",
    "PV_LO",
    "PV_HI",
    "PV_UNDER",
    "PV_OVER",
    "OP_LO",
    "OP_HI",
    "TS",
    "B",
    "C",
    "TT",
    "AW",
    "TRAPEZOID",
    "DIRECT",
    "DEADBAND",
    "SP_LIM_LO",
    "SP_LIM_HI",
    "SP_RATE_UP",
    "SP_RATE_DN",
    "SP_TRACK",
    "OP_LIM_LO",
    "OP_LIM_HI",
    "OP_RATE_UP",
    "OP_RATE_DN",
    "OP_INIT",
    "OFF_OP",
    "OFF_HOLD",
    "FAIL_ACT",
    "FAIL_OP",
    "FAIL_RATE",
    "FAIL_HOLD",
    "FAIL_ACK",
    "HH_EN",
    "H_EN",
    "L_EN",
    "LL_EN",
    "HH_LIM",
    "H_LIM",
    "L_LIM",
    "LL_LIM",
    "DEV_LIM",
    "ALM_HYST",
    "LATENCY",
    "COMP",
    "KFD",
    "TFD",
    "ALPHA",
    "FILTER_ORDER",
    "M_GAIN",
    "M_DEAD",
    "M_INTEG",
    "M_T1",
    "M_T2",
    "M_T3",
    "M_T4",
    "M_A1",
    "M_A2",
    "M_TZ",
    "ERROR",
    "ERROR_PARAM",
    "ERROR_REASON",
    "FAULT",
];

/// Inputs and outputs of both whose comment has other words.
const OTHER_WORDS: &[(&str, &str)] = &[
    ("PV", "there is no span and no PV_SRC; valid from PV_MIN to PV_MAX"),
    ("FF", "its range is that of the design"),
    ("KP", "the design gives the direction in place of DIRECT; there is no KP_PERCENT"),
    ("STATUS", "another page"),
];

/// Inputs that a loop has only if the form of `KP`, `TN`, `TV` reaches it.
const TUNING: &[&str] = &["KP", "TN", "TV", "TF"];

/// Own variables of an exported block with the name of a parameter of `CTL_LOOP`: the same thing, fixed by the design.
const FIXED: &[&str] = &[
    "DEADBAND",
    "SP_LIM_LO",
    "SP_LIM_HI",
    "OP_LIM_LO",
    "OP_LIM_HI",
    "OP_INIT",
    "OFF_OP",
    "FAIL_OP",
    "FAIL_HOLD",
    "HH_LIM",
    "H_LIM",
    "L_LIM",
    "LL_LIM",
    "DEV_LIM",
];

#[derive(Debug, Clone, PartialEq)]
struct Declared {
    section: String,
    kind: String,
    initial: Option<String>,
    comment: String,
}

/// The declarations of a block: one variable a line.
fn declarations(text: &str) -> BTreeMap<String, Declared> {
    let mut section = None;
    let mut found = BTreeMap::new();
    for line in text.lines().map(str::trim) {
        match line {
            "VAR_INPUT" | "VAR_OUTPUT" | "VAR" => section = Some(line.to_owned()),
            "END_VAR" => section = None,
            _ => {}
        }
        let (Some(section), Some((name, rest))) = (&section, line.split_once(" : ")) else { continue };
        if line.starts_with("(*") {
            continue;
        }
        let (declared, comment) = rest.split_once(';').expect("a semicolon ends a declaration");
        let (kind, initial) = match declared.split_once(" := ") {
            Some((kind, initial)) => (kind, Some(initial.to_owned())),
            None => (declared, None),
        };
        let comment = comment.trim().trim_start_matches("(*").trim_end_matches("*)").trim().to_owned();
        let variable = Declared { section: section.clone(), kind: kind.to_owned(), initial, comment };
        assert_eq!(found.insert(name.trim().to_owned(), variable), None, "{name} is declared twice");
    }
    found
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|why| panic!("{path}: {why}"))
}

fn is_wired(variable: &Declared) -> bool {
    variable.section != "VAR"
}

/// What is wrong with the names of an exported block.
fn faults(ctl_loop: &BTreeMap<String, Declared>, exported: &BTreeMap<String, Declared>) -> Vec<String> {
    let mut faults = Vec::new();
    for (name, own) in exported {
        let Some(other) = ctl_loop.get(name) else {
            if is_wired(own) && !ONLY_EXPORTED.contains(&name.as_str()) {
                faults.push(format!("{name} is neither in CTL_LOOP nor in the table"));
            }
            continue;
        };
        if own.kind != other.kind {
            faults.push(format!("{name} is {} here and {} there", own.kind, other.kind));
        }
        if !is_wired(own) {
            if !FIXED.contains(&name.as_str()) {
                faults.push(format!("{name} is a variable of the block's own with a name of CTL_LOOP"));
            }
            continue;
        }
        if own.section != other.section {
            faults.push(format!("{name} is in {} here and in {} there", own.section, other.section));
        }
        // Codes and flags; numbers are those of the design.
        if !own.kind.ends_with("REAL") && own.initial != other.initial {
            faults.push(format!("{name} begins as {:?} here and as {:?} there", own.initial, other.initial));
        }
        let (said, _) = own.comment.split_once("; this loop has n").unwrap_or((&own.comment, ""));
        let differs = said != other.comment;
        if differs != OTHER_WORDS.iter().any(|(listed, _)| listed == name) {
            faults.push(format!("{name} is `{said}` here and `{}` there", other.comment));
        }
    }
    for (name, other) in ctl_loop.iter().filter(|(_, other)| is_wired(other)) {
        let here = exported.get(name).is_some_and(is_wired);
        let listed = ONLY_CTL_LOOP.contains(&name.as_str());
        let optional = TUNING.contains(&name.as_str());
        if here == listed && !optional {
            faults.push(format!(
                "{name}, {} of CTL_LOOP: here {here}, in the table of what is not {listed}",
                other.section
            ));
        }
    }
    faults
}

#[test]
fn the_names_of_both_blocks_mean_the_same() {
    let scenario = scenario(all());
    let mut tunable = BTreeSet::new();
    for (precision, file) in [(Precision::F32, "CTL_LOOP.st"), (Precision::F64, "CTL_LOOP_L.st")] {
        let ctl_loop = declarations(&read(&format!("controller-capi/iec/{file}")));
        assert!(ctl_loop.len() > 100, "{}", ctl_loop.len());
        for spec in &scenario.controllers {
            let export = Export::new(&scenario, spec, precision, None).expect("a loop");
            let text = export.text(Format::StructuredText, "a.toml").expect("a text");
            let exported = declarations(&text);
            assert_eq!(faults(&ctl_loop, &exported), Vec::<String>::new(), "{}", spec.name);
            let tuning = TUNING.iter().filter(|name| exported.contains_key(**name)).count();
            assert!(tuning == 0 || tuning == TUNING.len(), "{}: {tuning}", spec.name);
            tunable.insert(tuning);
        }
    }
    assert_eq!(tunable.len(), 2, "there are loops of both kinds");
}

/// The test sees what it is for.
#[test]
fn a_name_with_another_meaning_is_found() {
    let ctl_loop = declarations(&read("controller-capi/iec/CTL_LOOP.st"));
    let text = read("tests/exported/dob_first_order.st");
    assert_eq!(faults(&ctl_loop, &declarations(&text)), Vec::<String>::new());
    for (from, to) in [
        ("PV_QUALITY : DINT := 2;", "PV_QUALITY : DINT := 0;"),
        ("2 good, 1 uncertain", "0 good, 1 uncertain"),
        ("MAN : BOOL;", "MAN : REAL;"),
        ("1 off, 2 manual", "0 off, 1 manual"),
        ("AUTO : BOOL := TRUE;", "AUTO : BOOL;"),
        ("SP_REMOTE : REAL;", "SP_CAS : REAL;"),
        ("    PV_MIN : REAL;", "    PV_LO : REAL;"),
        ("Output [OP unit], within its limits", "Output before the limits"),
    ] {
        let other = text.replacen(from, to, 1);
        assert!(other != text && !faults(&ctl_loop, &declarations(&other)).is_empty(), "{from} -> {to}");
    }
}

/// The names in backticks of the lines between two headings.
fn named(page: &str, heading: &str) -> BTreeSet<String> {
    let (_, behind) = page.split_once(heading).unwrap_or_else(|| panic!("no `{heading}`"));
    let part = behind.split("\n## ").next().unwrap_or(behind);
    let words = part.split('`').skip(1).step_by(2).map(str::to_owned);
    words
        .filter(|word| word.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_'))
        .collect()
}

#[test]
fn the_page_lists_what_only_one_of_them_has() {
    let page = read("controller-capi/iec/EXPORTED.md");
    let listed = named(&page, "\n## What differs from CTL_LOOP");
    let other: Vec<&str> =
        OTHER_WORDS.iter().map(|(name, _)| *name).filter(|name| *name != "STATUS").collect();
    for name in ONLY_CTL_LOOP.iter().chain(ONLY_EXPORTED).chain(TUNING).chain(&other) {
        assert!(listed.contains(*name), "`{name}` is not in the table of EXPORTED.md");
    }
    // And nothing else that is the same in both.
    let known: BTreeSet<&str> =
        ONLY_CTL_LOOP.iter().chain(ONLY_EXPORTED).chain(TUNING).chain(&other).copied().collect();
    let ctl_loop = declarations(&read("controller-capi/iec/CTL_LOOP.st"));
    let same: Vec<&String> =
        ctl_loop.keys().filter(|name| listed.contains(*name) && !known.contains(name.as_str())).collect();
    assert_eq!(same, ["ACK", "OP", "PV_QUALITY", "STATE"].iter().collect::<Vec<_>>());
}

/// The page's table of status bits is that of the block.
#[test]
fn the_page_has_every_bit() {
    let page = read("controller-capi/iec/EXPORTED.md");
    let text = read("tests/exported/dob_first_order.st");
    let bits: BTreeSet<&str> = text
        .lines()
        .filter_map(|line| line.split_once("(* bit ")?.1.split_once(':'))
        .map(|(bit, _)| bit)
        .filter(|bit| *bit != "12")
        .collect();
    assert_eq!(bits.len(), 21);
    let (_, table) = page.split_once("\n## STATUS").expect("a section");
    for bit in bits {
        assert!(table.contains(&format!("\n| {bit} | ")), "bit {bit}");
    }
}

/// The page's program is accepted, and what it wires is there.
#[test]
fn the_program_of_the_page_is_accepted() {
    let page = read("controller-capi/iec/EXPORTED.md");
    let (_, behind) = page.split_once("```iecst\n").expect("a program");
    let (program, _) = behind.split_once("```").expect("its end");
    let unit = iec61131::Parser::new(program).parse().unwrap_or_else(|fault| panic!("{fault}\n{program}"));
    assert_eq!(unit.declarations.len(), 1);
    let exported = declarations(&read("tests/exported/dob_first_order.st"));
    for (name, section) in [("SP", "VAR_INPUT"), ("PV", "VAR_INPUT"), ("OP", "VAR_OUTPUT")] {
        assert!(program.contains(name) && exported[name].section == section, "{name}");
    }
}
