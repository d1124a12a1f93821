//! The rung that opens the program's pages in a browser.

use std::path::{Path, PathBuf};

use crate::browser::{self, CHECKS, Tools};
use crate::ladder::Done;
use crate::long_runs::LongRun;
use crate::memory;
use crate::rungs;
use crate::shell::{Cmd, Outcome, target_dir};

/// Where the scenarios are that come with the program, below the workspace root.
const SCENARIOS: [&str; 2] = ["controller-sim-host/scenarios", "controller-sim-host/scenarios/figures"];

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
    let program = rungs::program(root)?;
    let base = target_dir(root);
    let (pages, shots) = (emptied(&base.join("report-pages"))?, emptied(&base.join("report-shots"))?);
    let scratch = emptied(&base.join("report-scratch"))?;
    // First: checks that cannot fail would say nothing about the pages.
    node(root, "self_test.mjs", &tools).arg("--scratch").arg(&scratch).run()?;
    let mut built = short_pages(root, &program, &pages)?;
    built.push(long_page(&program, &scratch, &pages)?);
    node(root, "check.mjs", &tools).arg("--shots").arg(&shots).args(&built).run()?;
    println!("  to look at: {}", shots.display());
    let memory = memory::ladder(&program, &scratch)?.map_or_else(String::new, |remark| format!("; {remark}"));
    Ok(Done::Passed(format!("{} pages without a fault{memory}", built.len())))
}

/// A page of every scenario, one of the demo and one of several scenarios.
fn short_pages(root: &Path, program: &Path, pages: &Path) -> Outcome<Vec<PathBuf>> {
    let scenarios = scenarios(root)?;
    let mut built = Vec::new();
    let mut build = |name: &str, words: &[PathBuf]| -> Outcome {
        let page = pages.join(format!("{name}.html"));
        Cmd::new(program, pages).args(words).arg("--report").arg(&page).capture()?;
        built.push(page);
        Ok(())
    };
    build("built-in", &["demo".into()])?;
    for path in &scenarios {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        build(&name, &["run".into(), path.clone()])?;
    }
    let several: Vec<PathBuf> =
        std::iter::once("run".into()).chain(scenarios.iter().take(2).cloned()).collect();
    build("several-at-once", &several)?;
    Ok(built)
}

/// The page of a long noisy run, which must stay small.
fn long_page(program: &Path, scratch: &Path, pages: &Path) -> Outcome<PathBuf> {
    let scenario = scratch.join("long.toml");
    let text = LongRun { samples: LONG, every: LONG / 20, noise: true }.text();
    std::fs::write(&scenario, text).map_err(|e| format!("cannot write {}: {e}", scenario.display()))?;
    let page = pages.join("long-run.html");
    Cmd::new(program, pages).arg("run").arg(&scenario).arg("--report").arg(&page).capture()?;
    let bytes = std::fs::metadata(&page).map_err(|e| format!("no page {}: {e}", page.display()))?.len();
    if bytes >= MOST_BYTES {
        return Err(format!("the page of {LONG} samples has {bytes} bytes; allowed: below {MOST_BYTES}"));
    }
    Ok(page)
}

/// The scenarios that come with the program, in order.
fn scenarios(root: &Path) -> Outcome<Vec<PathBuf>> {
    let mut found = Vec::new();
    for folder in SCENARIOS.iter().map(|name| root.join(name)).filter(|folder| folder.is_dir()) {
        let list =
            std::fs::read_dir(&folder).map_err(|e| format!("cannot read {}: {e}", folder.display()))?;
        let mut files: Vec<PathBuf> = list.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
        files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
        files.sort();
        found.extend(files);
    }
    if found.is_empty() { Err(format!("no scenario in {}", SCENARIOS[0])) } else { Ok(found) }
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
        let found = scenarios(root).unwrap();
        assert!(found.iter().any(|path| path.ends_with("demo.toml")), "{found:?}");
        assert!(scenarios(Path::new("no-such-folder")).unwrap_err().contains(SCENARIOS[0]));
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
