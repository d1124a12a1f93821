//! Images that fail: each ends by itself, with its exit code, its words and its output off.

use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use crate::emulator::{self, REFERENCE};
use crate::shell::{Cmd, Outcome, target_dir};

/// The image.
const FAIL: &str = "fail";

/// What the image says when the output stayed off.
const OFF: &str = "the output is 0";

/// A way to fail: the word for it, the exit code of the runner, what must be among its words.
const WAYS: [(&str, i32, &[&str]); 4] = [
    ("panic", 101, &[OFF, "on purpose"]),
    ("fault", 102, &[OFF, "hard fault at"]),
    ("twice", 101, &[OFF, "while making safe"]),
    ("spin", 124, &["stopped after 1 s"]),
];

/// Checks all of them on the reference board; a remark when all is well.
pub(crate) fn check(root: &Path) -> Outcome<String> {
    let image = emulator::image(root, REFERENCE, FAIL, &[])?;
    for (way, code, words) in WAYS {
        let (ended, text) = emulator::emulated(root, &image, &[way], 1).ended()?;
        let missing = words.iter().find(|word| !text.contains(**word));
        if ended != Some(code) || missing.is_some() {
            return Err(format!(
                "{text}\n{FAIL} {way} ended with {ended:?}; expected are {code} and {words:?}"
            ));
        }
    }
    misplaced(root, &image)?;
    let orphan = if cfg!(target_os = "linux") { orphaned(root, &image)? } else { "" };
    Ok(format!("{} failures end safely, an image for another place is refused{orphan}", WAYS.len()))
}

/// An image that never ends, whose runner is killed: the emulator must not outlive it.
fn orphaned(root: &Path, image: &Path) -> Outcome<&'static str> {
    // A name that no other process has in its command line.
    let copy = image.with_file_name(format!("fail-orphan-{}", std::process::id()));
    std::fs::copy(image, &copy).map_err(|e| format!("cannot write {}: {e}", copy.display()))?;
    Cmd::cargo(root).args(["build", "--quiet", "--package", "controller-emulate"]).run()?;
    let runner = target_dir(root).join("debug/controller-emulate");
    let mut command = Cmd::new(runner, root).env("EMULATE_SECONDS", "60").arg(&copy).arg("spin").command();
    let mut child =
        command.stdout(Stdio::null()).spawn().map_err(|e| format!("cannot start the runner: {e}"))?;
    let name = copy.to_string_lossy().into_owned();
    let began = waited_until(|| emulators_of(&name) > 0);
    let killed = child.kill().and_then(|()| child.wait());
    let ended = waited_until(|| emulators_of(&name) == 0);
    let _ = std::fs::remove_file(&copy);
    match (began, killed, ended) {
        (true, Ok(_), true) => Ok(", a killed runner takes the emulator with it"),
        (false, ..) => Err("the runner of an image that spins starts no emulator".into()),
        _ => Err(format!("an emulator outlives its runner: look for a process with {name}")),
    }
}

/// Processes of the emulator with this word in their command line, of Linux.
fn emulators_of(word: &str) -> usize {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let lines = entries.filter_map(|entry| std::fs::read(entry.path().join("cmdline")).ok());
    lines
        .filter(|line| {
            let line = String::from_utf8_lossy(line);
            line.starts_with("qemu-system-arm") && line.contains(word)
        })
        .count()
}

/// Waits for at most 10 s; whether it came true.
fn waited_until(condition: impl Fn() -> bool) -> bool {
    (0..1000).any(|_| {
        std::thread::sleep(Duration::from_millis(10));
        condition()
    })
}

/// An image that says it is for another board than it was linked for.
fn misplaced(root: &Path, image: &Path) -> Outcome {
    let mut bytes = std::fs::read(image).map_err(|e| format!("cannot read {}: {e}", image.display()))?;
    // Both names have the same length; this board has its flash elsewhere.
    let (name, other) = (REFERENCE.name.as_bytes(), b"mps2-an505");
    let at = bytes.windows(name.len()).position(|found| found == name);
    let place =
        at.and_then(|at| bytes.get_mut(at..at + other.len())).ok_or("the image does not name its board")?;
    place.copy_from_slice(other);
    let forged = image.with_file_name("fail-misplaced");
    std::fs::write(&forged, bytes).map_err(|e| format!("cannot write {}: {e}", forged.display()))?;
    let (ended, text) = emulator::emulated(root, &forged, &["panic"], 1).ended()?;
    if ended == Some(125) && text.contains("linked for flash at") {
        return Ok(());
    }
    Err(format!("{text}\nan image that is linked for another board was run ({ended:?})"))
}
