//! Python with pinned packages, each set in a folder of its own below the target folder.

use std::path::{Path, PathBuf};

use crate::shell::{Cmd, Outcome, target_dir};

/// The packages that parse exported Structured Text, below the workspace root. The test looks for their Python in
/// `structured-text/python` of the target folder.
const STRUCTURED_TEXT: &str = "tests/structured_text/requirements.txt";

/// Makes the Python that the tests of exported Structured Text use; gives the message when it cannot.
pub(crate) fn structured_text(root: &Path) -> Option<String> {
    let made = environment(root, "structured-text", STRUCTURED_TEXT);
    made.err().map(|message| format!("no parser of Structured Text in Python: {message}"))
}

/// The Python with the packages of `requirements`, made when it is not there: `python` below the folder `name`.
pub(crate) fn environment(root: &Path, name: &str, requirements: &str) -> Outcome<PathBuf> {
    let folder = target_dir(root).join(name);
    let environment = folder.join("python");
    let python = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let wanted =
        std::fs::read(root.join(requirements)).map_err(|e| format!("cannot read {requirements}: {e}"))?;
    let stamp = environment.join("installed.txt");
    if python.is_file() && std::fs::read(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(python);
    }
    std::fs::create_dir_all(&folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
    Cmd::new("python3", root)
        .args(["-m", "venv", "--clear"])
        .arg(&environment)
        .run()
        .map_err(|e| format!("{e}\nit needs Python 3.11 or later with venv; on Debian run: sudo apt-get install -y python3-venv"))?;
    Cmd::new(&python, root)
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", requirements])
        .run()?;
    std::fs::write(&stamp, wanted).map_err(|e| format!("cannot write {}: {e}", stamp.display()))?;
    Ok(python)
}
