//! Checks that need no tool: they look at text and files.

use std::path::{Path, PathBuf};

use crate::manifest::Manifest;
use crate::shell::{Cmd, Outcome};

/// All crates that may stand in the core's tree: its three direct dependencies, and what heapless brings.
const ALLOWED: [&str; 7] = [
    "controller-core",
    "critical-section",
    "heapless",
    "libm",
    // of heapless
    "byteorder",
    "hash32",
    "stable_deref_trait",
];

/// What the core's optional features add to what is flashed: `defmt`, and what it brings. The crates of its macros run in the
/// compiler and are none of the core's.
const OPTIONAL: [&str; 2] = ["defmt", "bitflags"];

/// A source file has fewer lines than this: one that grows further wants to be several.
const MAX_LINES: usize = 600;

/// Names that say nothing about what is inside.
const EMPTY_NAMES: [&str; 6] = ["util", "utils", "helper", "helpers", "misc", "common"];

/// Signs of unfinished work. Put together from pieces, or this file would find itself.
const UNFINISHED: [&str; 4] =
    [concat!("to", "do!"), concat!("unimple", "mented!"), concat!("FIX", "ME"), concat!("#[ig", "nore")];

/// Folders that exist on one machine only.
const MACHINE_PATHS: [&str; 3] = [concat!("/ro", "ot/"), concat!("/ho", "me/"), concat!("/Us", "ers/")];

/// Checks the output of `cargo tree --prefix none` against the allow-list, with the additions of the optional features or
/// without; gives the number of different crates.
pub(crate) fn allowed_dependencies(tree: &str, optional: bool) -> Outcome<usize> {
    let additions: &[&str] = if optional { &OPTIONAL } else { &[] };
    let mut found: Vec<&str> = tree.lines().filter_map(|line| line.split_whitespace().next()).collect();
    found.sort_unstable();
    found.dedup();
    if found.is_empty() {
        return Err("cargo tree printed nothing".into());
    }
    let intruders: Vec<&str> =
        found.iter().copied().filter(|name| !ALLOWED.contains(name) && !additions.contains(name)).collect();
    if intruders.is_empty() {
        Ok(found.len())
    } else {
        Err(format!(
            "not allowed below controller-core{}: {} (see ALLOWED in xtask/src/checks.rs)",
            if optional { " with all features" } else { "" },
            intruders.join(", ")
        ))
    }
}

/// Checks that all outputs are equal, line for line; gives the number of lines.
pub(crate) fn same_output(outputs: &[(&str, String)]) -> Outcome<usize> {
    let Some(((first_name, first), others)) = outputs.split_first() else {
        return Err("nothing to compare".into());
    };
    if first.trim().is_empty() {
        return Err(format!("{first_name} printed nothing"));
    }
    let mut differences = Vec::new();
    for (name, other) in others.iter().filter(|(_, other)| other != first) {
        let (mut a, mut b) = (first.lines(), other.lines());
        // Outputs that differ only in line ends have no differing line; they are different all the same.
        let pair = loop {
            match (a.next(), b.next()) {
                (None, None) => break ("(end)", "(end)"),
                (x, y) if x == y => {}
                (x, y) => break (x.unwrap_or("(end)"), y.unwrap_or("(end)")),
            }
        };
        differences.push(format!("{first_name}: {}\n{name}: {}", pair.0, pair.1));
    }
    if differences.is_empty() {
        Ok(first.lines().count())
    } else {
        Err(format!("different bits, first differing line of each:\n{}", differences.join("\n")))
    }
}

/// Checks that each name stands in the text as a word of its own (`DE-MOMI` does not count as `MOMI`).
pub(crate) fn mentions(text: &str, names: &[&str]) -> Outcome {
    let words: Vec<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '-')).collect();
    let absent: Vec<&str> = names.iter().copied().filter(|name| !words.contains(name)).collect();
    if absent.is_empty() { Ok(()) } else { Err(format!("the output does not mention {}", absent.join(", "))) }
}

/// Checks all files of the workspace; gives their number.
pub(crate) fn hygiene(root: &Path) -> Outcome<usize> {
    let files = files(root)?;
    let mut faults = Vec::new();
    for file in &files {
        let bytes =
            std::fs::read(root.join(file)).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
        let text = String::from_utf8_lossy(&bytes);
        faults.extend(faults_of(file, &text).into_iter().map(|fault| format!("{}: {fault}", file.display())));
    }
    if !root.join("README.md").is_file() {
        faults.push("README.md is missing".into());
    }
    faults.extend(lint_faults(root)?);
    if faults.is_empty() {
        Ok(files.len())
    } else {
        Err(format!("{} faults\n{}", faults.len(), faults.join("\n")))
    }
}

/// The files that are, or are about to be, under version control.
fn files(root: &Path) -> Outcome<Vec<PathBuf>> {
    let list = Cmd::new("git", root)
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .capture()
        .map_err(|e| format!("{e}\nthe list of files comes from git"))?;
    // A file that was removed but not yet from the index is still listed; links to folders are not files.
    let mut files: Vec<PathBuf> =
        list.split('\0').map(PathBuf::from).filter(|path| root.join(path).is_file()).collect();
    files.sort_unstable();
    files.dedup();
    Ok(files)
}

/// What is wrong with one file.
fn faults_of(path: &Path, text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for pattern in MACHINE_PATHS {
        faults.extend(
            lines_with(text, pattern).map(|n| format!("line {n}: a path of one machine ({pattern})")),
        );
    }
    if path.extension().is_none_or(|extension| extension != "rs") {
        return faults;
    }
    for pattern in UNFINISHED {
        faults.extend(lines_with(text, pattern).map(|n| format!("line {n}: unfinished ({pattern})")));
    }
    let lines = text.lines().count();
    if lines >= MAX_LINES {
        faults.push(format!("{lines} lines; split it below {MAX_LINES}"));
    }
    // For `common/mod.rs` the name is that of the folder.
    let named = if path.ends_with("mod.rs") { path.parent().unwrap_or(path) } else { path };
    let stem = named.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if EMPTY_NAMES.contains(&stem.as_str()) {
        faults.push(format!("`{stem}` says nothing about what is inside"));
    }
    faults
}

/// The numbers of the lines that contain a pattern.
fn lines_with<'a>(text: &'a str, pattern: &'a str) -> impl Iterator<Item = usize> + 'a {
    text.lines().enumerate().filter(move |(_, line)| line.contains(pattern)).map(|(at, _)| at + 1)
}

/// Checks that undocumented items are warned about in every crate.
fn lint_faults(root: &Path) -> Outcome<Vec<String>> {
    let workspace = Manifest::read(&root.join("Cargo.toml"))?;
    let mut faults = Vec::new();
    if !warns_of_missing_docs(&workspace, "workspace.lints.rust") {
        faults.push("Cargo.toml: the workspace does not warn about missing_docs".to_string());
    }
    let members = workspace.table("workspace").map(|table| table.list("members")).unwrap_or_default();
    if members.is_empty() {
        faults.push("Cargo.toml: the workspace lists no members".to_string());
    }
    for member in members {
        let manifest = Manifest::read(&root.join(&member).join("Cargo.toml"))?;
        // Cargo cannot inherit lints and add to them: a crate with stricter ones has a list of its own.
        if !inherits_lints(&manifest) && !warns_of_missing_docs(&manifest, "lints.rust") {
            faults.push(format!(
                "{member}/Cargo.toml: neither `[lints] workspace = true` nor its own missing_docs"
            ));
        }
    }
    Ok(faults)
}

/// Whether a crate takes the lints of the workspace.
fn inherits_lints(manifest: &Manifest) -> bool {
    manifest.table("lints").and_then(|lints| lints.raw("workspace")) == Some("true")
}

/// Whether a table of lints has `missing_docs` at a level that shows.
fn warns_of_missing_docs(manifest: &Manifest, table: &str) -> bool {
    let level = manifest.table(table).and_then(|lints| lints.string("missing_docs"));
    matches!(level.as_deref(), Some("warn" | "deny" | "forbid"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn allowed_trees_pass() {
        let tree = "controller-core v0.1.0 (/somewhere/controller-core)\ncritical-section v1.2.0\nheapless v0.9.3\n\
                    hash32 v0.3.1\nbyteorder v1.5.0\nstable_deref_trait v1.2.1\nlibm v0.2.16\nlibm v0.2.16 (*)\n";
        assert_eq!(allowed_dependencies(tree, false), Ok(7));
        // What a feature adds is allowed with the features only.
        let more = format!("{tree}defmt v1.2.0\nbitflags v1.3.2\n");
        assert_eq!(allowed_dependencies(&more, true), Ok(9));
        assert!(allowed_dependencies(&more, false).unwrap_err().contains("controller-core: bitflags, defmt"));
    }

    #[test]
    fn an_intruder_is_named() {
        let tree = "controller-core v0.1.0\nlibm v0.2.16\nserde v1.0.229\nlibm-extra v1.0.0\n";
        let message = allowed_dependencies(tree, true).unwrap_err();
        assert!(message.contains("libm-extra, serde"), "{message}");
        assert!(allowed_dependencies("", false).is_err());
    }

    #[test]
    fn equal_outputs_pass_and_one_bit_is_found() {
        let text = "pid f32 00ff\ndob f32 1234\n".to_string();
        let other = "pid f32 00ff\ndob f32 1235\n".to_string();
        assert_eq!(same_output(&[("opt-0", text.clone()), ("opt-3", text.clone())]), Ok(2));
        let message = same_output(&[("opt-0", text.clone()), ("opt-3", other)]).unwrap_err();
        assert!(message.ends_with("opt-0: dob f32 1234\nopt-3: dob f32 1235"), "{message}");
        let short = "pid f32 00ff\n".to_string();
        let message = same_output(&[("opt-0", text.clone()), ("native", short)]).unwrap_err();
        assert!(message.ends_with("native: (end)"), "{message}");
        assert!(same_output(&[("opt-0", text.clone()), ("opt-3", text.trim_end().to_string())]).is_err());
    }

    #[test]
    fn empty_outputs_are_not_equal_bits() {
        assert!(same_output(&[("opt-0", String::new()), ("opt-3", String::new())]).is_err());
        assert!(same_output(&[]).is_err());
    }

    #[test]
    fn names_count_as_whole_words() {
        let names = ["MOMI", "DRMO", "DE-MOMI"];
        assert!(mentions("| MOMI | 1\n| DRMO | 2\nDE-MOMI: 3", &names).is_ok());
        assert!(mentions("DRMO DE-MOMI", &names).unwrap_err().ends_with("mention MOMI"));
    }

    #[test]
    fn clean_files_have_no_faults() {
        assert!(faults_of(Path::new("core/src/pid.rs"), "//! A block.\n").is_empty());
        // Only sources have to be short and finished.
        let marker = UNFINISHED[2];
        assert!(faults_of(Path::new("notes.md"), &format!("{marker}\n").repeat(1000)).is_empty());
    }

    #[test]
    fn every_kind_of_fault_is_found() {
        for pattern in UNFINISHED {
            let faults = faults_of(Path::new("a.rs"), &format!("fn f() {{}}\n// {pattern}\n"));
            assert_eq!(faults, [format!("line 2: unfinished ({pattern})")]);
        }
        for pattern in MACHINE_PATHS {
            assert_eq!(faults_of(Path::new("a.toml"), &format!("p = \"{pattern}x\"")).len(), 1);
        }
        assert!(faults_of(Path::new("a.rs"), &"\n".repeat(MAX_LINES - 1)).is_empty());
        assert_eq!(faults_of(Path::new("a.rs"), &"\n".repeat(MAX_LINES)).len(), 1);
        assert_eq!(faults_of(Path::new("src/utils.rs"), "").len(), 1);
        assert_eq!(faults_of(Path::new("tests/common/mod.rs"), "").len(), 1);
        assert!(faults_of(Path::new("tests/traces/mod.rs"), "").is_empty());
    }

    #[test]
    fn lints_come_from_the_workspace_or_are_as_strict() {
        assert!(inherits_lints(&Manifest::parse("[lints]\nworkspace = true\n")));
        assert!(!inherits_lints(&Manifest::parse("[lints]\nworkspace = false\n")));
        assert!(!inherits_lints(&Manifest::parse("[package]\nname = \"x\"\n")));
        let warns = |level: &str| {
            let manifest = Manifest::parse(&format!("[lints.rust]\nmissing_docs = {level}\n"));
            warns_of_missing_docs(&manifest, "lints.rust")
        };
        assert!(warns("\"deny\"") && warns("{ level = \"warn\", priority = 1 }"));
        assert!(!warns("\"allow\""));
        assert!(!warns_of_missing_docs(&Manifest::parse(""), "lints.rust"));
    }
}
