//! Images that fail: each ends by itself, with its exit code, its words and its output off.

use std::path::Path;

use crate::emulator::{self, REFERENCE};
use crate::shell::Outcome;

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
    Ok(format!("{} failures end safely, an image for another place is refused", WAYS.len()))
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
