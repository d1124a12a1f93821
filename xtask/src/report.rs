//! The rung that opens the program's pages in a browser.

use std::path::{Path, PathBuf};

use crate::browser::{self, CHECKS, Tools};
use crate::ladder::Done;
use crate::long_runs::LongRun;
use crate::memory;
use crate::program;
use crate::shell::{Cmd, Outcome, target_dir};

/// Where the scenarios are that come with the program, below the workspace root.
const SCENARIOS: &str = "controller-sim-host/scenarios";
/// Folders of it whose scenarios run; others may hold parts that scenarios include.
const FOLDERS: [&str; 2] = ["", "figures"];

/// A scenario in which a person steps the output, below the workspace root.
const STEP_TEST: &str = "tests/browser/step-test.toml";

/// The records that pages are made of: the file, and the scenario that it is a run of.
const RECORDS: [(&str, &str); 2] = [("step.csv", "step-test.toml"), ("loop.csv", "load-experiment.toml")];

/// Pages of commands that do not simulate a scenario: the name, and the words of the command.
const STUDIES: [(&str, &[&str]); 6] = [
    ("identify", &["identify", "step.csv"]),
    ("tune", &["tune", "step.csv", "--limits", "0:100"]),
    ("assess-good", &["assess", "loop.csv", "--controller", "well tuned"]),
    ("assess-swings", &["assess", "loop.csv", "--controller", "ti too short"]),
    ("analyze", &["analyze", "demo.toml"]),
    ("analyze-blocks", &["analyze", "latency.toml"]),
];

/// Pages of many loops: the name, and the words of the command.
const SHEETS: [(&str, &[&str]); 3] = [
    ("figure", &["reproduce", "--figure", "dob-10"]),
    ("map", &["batch", "map", "--x", "L=0.1:0.9:5", "--y", "alpha_ratio=0.01:100:5:log", "--at", "ms=1.4"]),
    ("samples", &["batch", "sample", "first.toml", "-n", "40", "--vary", "gain=+-10%", "--quiet"]),
];

/// Samples of the long page.
const LONG: u64 = 1_000_000;
/// Most bytes of the long page: one that is decimated has far less, one that is not has 50 times as much.
const MOST_BYTES: u64 = 1_500_000;

/// Builds a page of every scenario, of several at once and of a long run; opens each in the browser and checks it.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    let tools = match browser::ready(root)? {
        Ok(tools) => tools,
        Err(message) => return Ok(Done::Lacking(message)),
    };
    let program = program::checked(root)?;
    let base = target_dir(root);
    let (pages, shots) = (emptied(&base.join("report-pages"))?, emptied(&base.join("report-shots"))?);
    let scratch = emptied(&base.join("report-scratch"))?;
    // First: checks that cannot fail would say nothing about the pages.
    node(root, "self_test.mjs", &tools).arg("--scratch").arg(&scratch).run()?;
    let mut built = short_pages(root, &program, &pages)?;
    built.extend(studies(root, &program, &pages)?);
    built.push(long_page(&program, &pages)?);
    let memory = memory::ladder(&program, &scratch)?.map_or_else(String::new, |remark| format!("; {remark}"));
    let list = built.iter().map(|name| pages.join(name));
    let checked = node(root, "check.mjs", &tools).arg("--shots").arg(&shots).args(list).run();
    println!("  to look at: {}", shots.display());
    checked.map_err(|message| format!("pages have faults, listed above\n{message}"))?;
    Ok(Done::Passed(format!("{} pages without a fault{memory}", built.len())))
}

/// A page of every scenario, one of the demo and one of several scenarios; gives their names.
///
/// The scenarios are copied beside the pages, so that the commands on the pages are as short as a person's.
fn short_pages(root: &Path, program: &Path, pages: &Path) -> Outcome<Vec<String>> {
    copy_folder(&root.join(SCENARIOS), pages)?;
    let scenarios = scenarios(pages)?;
    let mut built = Vec::new();
    let mut build = |name: &str, words: &[&str]| -> Outcome {
        let page = format!("{name}.html");
        Cmd::new(program, pages).args(words).args(["--report", &page]).capture()?;
        built.push(page);
        Ok(())
    };
    build("built-in", &["demo"])?;
    for path in &scenarios {
        let stem = Path::new(path).file_stem().unwrap_or_default().to_string_lossy();
        build(&stem, &["run", path])?;
    }
    let several: Vec<&str> =
        std::iter::once("run").chain(scenarios.iter().take(2).map(String::as_str)).collect();
    build("several-at-once", &several)?;
    Ok(built)
}

/// The pages of processes, experiments and loops, beside the scenarios; gives their names.
fn studies(root: &Path, program: &Path, pages: &Path) -> Outcome<Vec<String>> {
    std::fs::copy(root.join(STEP_TEST), pages.join("step-test.toml"))
        .map_err(|e| format!("cannot copy {STEP_TEST}: {e}"))?;
    for (record, scenario) in RECORDS {
        Cmd::new(program, pages).args(["run", scenario, "--quiet", "--csv", record]).capture()?;
    }
    let build = |(name, words): (&str, &[&str])| {
        let page = format!("{name}.html");
        Cmd::new(program, pages).args(words).args(["--report", &page]).capture()?;
        Ok(page)
    };
    STUDIES.into_iter().chain(SHEETS).map(build).collect()
}

/// The page of a long noisy run, which must stay small; gives its name.
fn long_page(program: &Path, pages: &Path) -> Outcome<String> {
    let (scenario, page) = ("long-run.toml", "long-run.html");
    let text = LongRun { samples: LONG, every: LONG / 20, noise: true }.text();
    std::fs::write(pages.join(scenario), text).map_err(|e| format!("cannot write {scenario}: {e}"))?;
    Cmd::new(program, pages).args(["run", scenario, "--report", page]).capture()?;
    let bytes = std::fs::metadata(pages.join(page)).map_err(|e| format!("no page {page}: {e}"))?.len();
    if bytes >= MOST_BYTES {
        return Err(format!("the page of {LONG} samples has {bytes} bytes; allowed: below {MOST_BYTES}"));
    }
    Ok(page.to_string())
}

/// The scenarios below a folder, by their paths from there, in order.
fn scenarios(base: &Path) -> Outcome<Vec<String>> {
    let mut found = Vec::new();
    for folder in FOLDERS.iter().map(Path::new).filter(|folder| base.join(folder).is_dir()) {
        for name in names(&base.join(folder))? {
            if name.ends_with(".toml") {
                found.push(folder.join(name).to_string_lossy().into_owned());
            }
        }
    }
    if found.is_empty() { Err(format!("no scenario in {}", base.display())) } else { Ok(found) }
}

/// Copies all files of a folder and of those in it.
fn copy_folder(from: &Path, to: &Path) -> Outcome {
    std::fs::create_dir_all(to).map_err(|e| format!("cannot create {}: {e}", to.display()))?;
    for name in names(from)? {
        let (source, copy) = (from.join(&name), to.join(&name));
        if source.is_dir() {
            copy_folder(&source, &copy)?;
        } else {
            std::fs::copy(&source, &copy).map_err(|e| format!("cannot copy {}: {e}", source.display()))?;
        }
    }
    Ok(())
}

/// What is in a folder, in order.
fn names(folder: &Path) -> Outcome<Vec<String>> {
    let unreadable = |e: std::io::Error| format!("cannot read {}: {e}", folder.display());
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        names.push(entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// One of the scripts of the checks.
fn node(root: &Path, script: &str, tools: &Tools) -> Cmd {
    Cmd::new("node", root)
        .arg(format!("{CHECKS}/{script}"))
        .arg("--modules")
        .arg(&tools.modules)
        .arg("--chromium")
        .arg(&tools.chromium)
}

/// The folder, with nothing in it: what an earlier run left behind must not pass for a result of this one.
fn emptied(folder: &Path) -> Outcome<PathBuf> {
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|e| format!("cannot empty {}: {e}", folder.display()))?;
    }
    std::fs::create_dir_all(folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
    Ok(folder.to_path_buf())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenarios_of_the_program_are_found() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let found = scenarios(&root.join(SCENARIOS)).unwrap();
        assert!(found.contains(&"demo.toml".to_string()), "{found:?}");
        assert!(scenarios(Path::new("no-such-folder")).unwrap_err().contains("no-such-folder"));
    }

    #[test]
    fn studies_are_made_of_what_there_is() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let scenarios = scenarios(&root.join(SCENARIOS)).unwrap();
        let step_test = Path::new(STEP_TEST).file_name().unwrap().to_str().unwrap();
        assert!(root.join(STEP_TEST).is_file());
        for (record, scenario) in RECORDS {
            assert!(scenario == step_test || scenarios.contains(&scenario.to_string()), "{scenario}");
            assert!(STUDIES.iter().any(|(_, words)| words.contains(&record)), "{record}");
        }
        for (name, words) in STUDIES {
            let input = words[1].to_string();
            assert!(
                RECORDS.iter().any(|(record, _)| *record == input) || scenarios.contains(&input),
                "{name}"
            );
            // Pages of the scenarios are called after them.
            assert!(!scenarios.contains(&format!("{name}.toml")), "{name}");
        }
    }

    #[test]
    fn an_emptied_folder_is_empty() {
        let folder = std::env::temp_dir().join(format!("controller-xtask-emptied-{}", std::process::id()));
        emptied(&folder).unwrap();
        std::fs::write(folder.join("old.html"), "").unwrap();
        emptied(&folder).unwrap();
        let count = std::fs::read_dir(&folder).unwrap().count();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(count, 0);
    }
}
