//! What the checks of the report pages run with: a browser, Node and two packages for it.
//!
//! Whatever is missing is installed when that may be done without asking (by the superuser, or one whom `sudo` lets
//! without a password, on a system with `apt-get`); otherwise the person is told the one command.

use std::path::{Path, PathBuf};

use crate::packages;
use crate::shell::{Cmd, Outcome, target_dir};

/// The folder with the checks, below the workspace root.
pub(crate) const CHECKS: &str = "tests/browser";

/// Files that say which packages are installed, and how.
const MANIFESTS: [&str; 3] = ["package.json", "package-lock.json", ".npmrc"];

/// The lock file that was last installed from.
const INSTALLED: &str = "installed-lock.json";

/// What the browser is called on different systems.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome-stable", "google-chrome"];

/// The oldest Node that the packages run on.
const LEAST_NODE: u32 = 18;

/// Everything is there.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Tools {
    /// The program of the browser.
    pub(crate) chromium: PathBuf,
    /// The folder that the packages are installed in.
    pub(crate) modules: PathBuf,
}

/// Installs what is missing where that may be done, and says where things are; or else, in one line, what is lacking
/// and the command to run. An error means that the checks themselves are broken.
pub(crate) fn ready(root: &Path) -> Outcome<Result<Tools, String>> {
    if let Some(message) = install_programs(root) {
        return Ok(Err(message));
    }
    let Some(chromium) = chromium() else {
        return Ok(Err("Chromium was installed but is not found; name it in CHROMIUM".into()));
    };
    Ok(modules(root)?.map(|modules| Tools { chromium, modules }))
}

/// Installs the programs that are missing; gives the message when it cannot.
fn install_programs(root: &Path) -> Option<String> {
    let lacking = lacking_programs(root);
    if lacking.is_empty() {
        return None;
    }
    if !packages::can_install(root) {
        let names = lacking.join(" ");
        return Some(format!("missing: {names}; install Chromium (or name it in CHROMIUM), Node and npm"));
    }
    packages::install(root, &lacking, || lacking_programs(root).is_empty())
}

/// The packages of Debian for the programs that are not there.
fn lacking_programs(root: &Path) -> Vec<&'static str> {
    let node = Cmd::new("node", root).arg("--version").probe();
    let mut lacking = Vec::new();
    if chromium().is_none() {
        lacking.push("chromium");
    }
    if !node.is_some_and(|version| is_recent_node(&version)) {
        lacking.push("nodejs");
    }
    if Cmd::new("npm", root).arg("--version").probe().is_none() {
        lacking.push("npm");
    }
    lacking
}

/// The browser: named in CHROMIUM, or found on the path.
fn chromium() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM").filter(|name| !name.is_empty()) {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    BROWSERS.iter().flat_map(|name| folders.iter().map(move |dir| dir.join(name))).find(|file| file.is_file())
}

/// Reads the answer of `node --version`, which is `v20.1.2`.
fn is_recent_node(answer: &str) -> bool {
    let major = answer.trim().trim_start_matches('v').split('.').next();
    major.and_then(|number| number.parse::<u32>().ok()).is_some_and(|number| number >= LEAST_NODE)
}

/// Installs the packages below the target folder, when the lock file is not that of the last time; gives the folder,
/// or what to do.
fn modules(root: &Path) -> Outcome<Result<PathBuf, String>> {
    let folder = target_dir(root).join("browser");
    let io = |what: &Path, error: std::io::Error| format!("cannot write {}: {error}", what.display());
    std::fs::create_dir_all(&folder).map_err(|e| io(&folder, e))?;
    let lock = root.join(CHECKS).join("package-lock.json");
    let wanted = std::fs::read(&lock).map_err(|e| format!("cannot read {}: {e}", lock.display()))?;
    let stamp = folder.join(INSTALLED);
    if std::fs::read(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(Ok(folder));
    }
    for name in MANIFESTS {
        let from = root.join(CHECKS).join(name);
        std::fs::copy(&from, folder.join(name)).map_err(|e| io(&from, e))?;
    }
    // No package runs anything at its installation, and none is asked about.
    let install = Cmd::new("npm", &folder).args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"]);
    if let Err(message) = install.run() {
        println!("{message}");
        return Ok(Err(format!(
            "the npm packages of {CHECKS} cannot be fetched; with a network run: cargo xtask setup"
        )));
    }
    std::fs::write(&stamp, wanted).map_err(|e| io(&stamp, e))?;
    Ok(Ok(folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_node_is_no_node() {
        assert!(is_recent_node("v20.11.1\n") && is_recent_node("v18.0.0"));
        assert!(!is_recent_node("v16.20.2\n") && !is_recent_node("") && !is_recent_node("node"));
    }

    #[test]
    fn the_lock_file_names_no_address_and_pins_what_the_manifest_asks_for() {
        let read = |name: &str| {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
            std::fs::read_to_string(root.join(CHECKS).join(name)).unwrap()
        };
        let (manifest, lock) = (read("package.json"), read("package-lock.json"));
        assert!(!lock.contains("\"resolved\"") && !lock.contains("//"));
        let dependencies = manifest.split_once("\"dependencies\": {").unwrap().1.split_once('}').unwrap().0;
        let mut count = 0;
        for line in dependencies.lines().filter(|line| line.contains(':')) {
            let (_, version) = line.split_once(':').unwrap();
            let version = version.trim().trim_matches([',', '"']);
            assert!(version.split('.').all(|part| part.parse::<u32>().is_ok()), "{line} is not exact");
            assert!(lock.contains(line.trim().trim_end_matches(',')), "{line} is not in the lock file");
            count += 1;
        }
        assert_eq!(count, 2);
    }

    #[test]
    fn missing_checks_are_an_error_and_not_a_lack() {
        let root = std::env::temp_dir().join(format!("controller-xtask-no-checks-{}", std::process::id()));
        std::fs::create_dir_all(&root).unwrap();
        let message = modules(&root);
        std::fs::remove_dir_all(&root).unwrap();
        assert!(message.unwrap_err().contains("package-lock.json"));
    }
}
