//! The firmware's demo, as a user starts it: what it logs is committed.

use std::path::Path;

use crate::emulator;
use crate::ladder::Done;
use crate::shell::{Cmd, Outcome};

/// The folder in which a user types `cargo run --release`.
const FOLDER: &str = "controller-firmware";
/// What the demo logs, decoded.
const EXPECTED: &str = "demo/expected.txt";
/// Set to write that file anew.
const RENEW: &str = "RENEW_DEMO";

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    if let Some(end) = emulator::lacking(root)? {
        return Ok(end);
    }
    let folder = root.join(FOLDER);
    let log = Cmd::new("cargo", &folder).args(["run", "--release"]).capture()?;
    print!("{log}");
    let file = folder.join(EXPECTED);
    if std::env::var_os(RENEW).is_some() {
        std::fs::write(&file, &log).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    }
    let expected =
        std::fs::read_to_string(&file).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
    same(&expected, &log).map(|lines| Done::Passed(format!("{lines} lines, as in {FOLDER}/{EXPECTED}")))
}

/// Compares line by line; the number of lines if all are the same.
fn same(expected: &str, log: &str) -> Outcome<usize> {
    let mut pairs = expected.lines().zip(log.lines()).enumerate();
    if let Some((k, (expected, got))) = pairs.find(|(_, (expected, got))| expected != got) {
        return Err(format!(
            "line {} of the demo's log is\n  {got}\nand was\n  {expected}\nif that is meant: {RENEW}=1",
            k + 1
        ));
    }
    let (was, is) = (expected.lines().count(), log.lines().count());
    if was == is {
        Ok(is)
    } else {
        Err(format!("the demo logs {is} lines, {was} are expected; if that is meant: {RENEW}=1"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_differs_or_is_missing_is_told() {
        assert_eq!(same("a\nb\n", "a\nb\n"), Ok(2));
        assert!(same("a\nb\n", "a\nc\n").unwrap_err().contains("line 2"));
        assert!(same("a\nb\n", "a\n").unwrap_err().contains("1 lines, 2"));
    }
}
