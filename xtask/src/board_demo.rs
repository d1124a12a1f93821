//! The firmware's demo, as a user starts it and on every board: what it logs is committed. And the loop of the guide.

use std::path::Path;
use std::time::Instant;

use controller_pil::board::BOARDS;

use crate::emulator::{self, REFERENCE};
use crate::ladder::Done;
use crate::shell::{Cmd, Outcome, target_dir};

/// The folder in which a user types `cargo run`.
const FOLDER: &str = "controller-firmware";
/// What the demo logs, decoded: the same on every board.
const EXPECTED: &str = "demo/expected.txt";
/// Set to write that file anew.
const RENEW: &str = "RENEW_DEMO";
/// Seconds that an image may take.
const SECONDS: u32 = 60;

/// Design files of the demo's loops and the modules that are exported from them.
const LAWS: [(&str, &str); 2] = [("demo/loop.toml", "heater_law.rs"), ("demo/oven.toml", "oven_law.rs")];

/// The image of the guide, what it prints at its end, and what of it the guide shows: whole files, or from a line on.
const FIRST: &str = "first";
const FIRST_ENDS: &str = "after 800 samples: 600 tenths of a degree\n";
const SHOWN: [(&str, &str); 3] =
    [("control.rs", "use "), ("fault.rs", "use "), ("main.rs", "#[cortex_m_rt::entry]")];
const GUIDE: &str = "README.md";
/// The words that make it fail, and the exit code that says that its heater was turned off.
const FAILURES: [&str; 3] = ["panic", "fault", "interrupt"];
const TURNED_OFF: i32 = 101;
/// The chip that has room for it, and its RAM \[bytes\]: half of what the emulated board has.
const SMALL: &str = "microbit";
const SMALL_RAM: u32 = 16 << 10;

/// How the build script is asked for a board.
const BOARD: &str = "CONTROLLER_BOARD";
/// How it is asked for less RAM.
const RAM_SIZE: &str = "CONTROLLER_RAM_SIZE";

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    if let Some(end) = emulator::lacking(root)? {
        return Ok(end);
    }
    let folder = root.join(FOLDER);
    shown(&folder)?;
    exported(root)?;
    let log = without_places(&Cmd::new("cargo", &folder).arg("run").capture()?);
    print!("{log}");
    let file = folder.join(EXPECTED);
    if std::env::var_os(RENEW).is_some() {
        std::fs::write(&file, &log).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    }
    let expected = read(&file)?;
    let lines = same(&expected, &log)?;
    let mut took = 0.0;
    for board in &BOARDS {
        let image = emulator::image(root, board, "demo", &[])?;
        let start = Instant::now();
        let log = emulator::emulated(root, &image, &[], SECONDS).capture()?;
        if board == REFERENCE {
            took = start.elapsed().as_secs_f64();
        }
        same(&expected, &log).map_err(|e| format!("{} ({}): {e}", board.name, board.core))?;
    }
    let first = first(root)?;
    misnamed(root)?;
    Ok(Done::Passed(format!(
        "{lines} lines on {} boards, as in {FOLDER}/{EXPECTED}; 10 s of the {} in {took:.2} s; {first}",
        BOARDS.len(),
        REFERENCE.core
    )))
}

/// Runs the guide's loop: on the reference board, to its end and into each of its failures, and on a small chip.
fn first(root: &Path) -> Outcome<String> {
    let image = emulator::image(root, REFERENCE, FIRST, &[])?;
    stack(&emulator::emulated(root, &image, &[], SECONDS).capture()?)?;
    for failure in FAILURES {
        let (code, text) = emulator::emulated(root, &image, &[failure], SECONDS).ended()?;
        if code != Some(TURNED_OFF) || !turned_off(&text) {
            return Err(format!("{text}\nafter a {failure} the guide's loop ended with {code:?}, heater on"));
        }
    }
    let small = emulator::board(SMALL)?;
    let build = Cmd::cargo(root).args(["build", "-p", emulator::FIRMWARE, "--bin", FIRST]);
    emulator::for_board(build, root, small).env(RAM_SIZE, &SMALL_RAM.to_string()).run()?;
    let image = target_dir(root).join(small.target).join("release").join(FIRST);
    let (used, size) = stack(&emulator::emulated(root, &image, &[], SECONDS).capture()?)?;
    // What is no stack is static.
    if !(SMALL_RAM / 2..=SMALL_RAM).contains(&size) {
        return Err(format!("{} has a stack of {size} bytes: not linked for {SMALL_RAM}", image.display()));
    }
    Ok(format!(
        "the guide's loop takes {used} bytes of stack in {} KiB of RAM ({}), its heater goes off after {} failures",
        SMALL_RAM / 1024,
        small.core,
        FAILURES.len()
    ))
}

/// Checks how the guide's loop ends; the bytes of stack that it used, and that it had.
fn stack(text: &str) -> Outcome<(u32, u32)> {
    let numbers = text
        .strip_prefix(FIRST_ENDS)
        .and_then(|rest| rest.strip_suffix(" bytes of stack\n"))
        .and_then(|rest| rest.split_once(" of "));
    match numbers.map(|(used, size)| (used.parse(), size.parse())) {
        Some((Ok(used), Ok(size))) => Ok((used, size)),
        _ => Err(format!(
            "the guide's loop ends with\n  {text}and should with\n  {FIRST_ENDS}  .. of .. bytes of stack"
        )),
    }
}

/// Whether the guide's loop says that its heater was on, and is off.
fn turned_off(text: &str) -> bool {
    let duties = text.strip_prefix("the duty was ").and_then(|rest| rest.split_once(" and is "));
    duties.is_some_and(|(was, is)| was.parse().is_ok_and(|was: u16| was > 0) && is == "0\n")
}

/// A board that there is not: told in a line that names those that there are, not by a panic of the build script.
fn misnamed(root: &Path) -> Outcome {
    let (built, text) = Cmd::cargo(root)
        .env(BOARD, "no-such-board")
        .args(["build", "-p", emulator::FIRMWARE, "--bin", FIRST, "--release", "--target", REFERENCE.target])
        .attempt()?;
    let told = text.lines().any(|line| line.starts_with("error: ") && line.contains(REFERENCE.name));
    if built || !told || text.contains("panicked") {
        return Err(format!("{text}\na board that there is not must be refused in one line"));
    }
    Ok(())
}

/// Checks that the laws in the demo are what is exported from its design files.
fn exported(root: &Path) -> Outcome {
    for (design, module) in LAWS {
        let design = format!("{FOLDER}/{design}");
        let text = Cmd::cargo(root)
            .args(["run", "--quiet", "--release", "--package", "controller-sim-host", "--"])
            .args(["export", &design, "--format", "rust"])
            .capture()?;
        let module = format!("{FOLDER}/src/bin/demo/{module}");
        if read(&root.join(&module))? != text {
            return Err(format!("{module} is not what is exported from {design}"));
        }
    }
    Ok(())
}

/// Checks that the guide's code is that of the image.
fn shown(folder: &Path) -> Outcome {
    let guide = read(&folder.join(GUIDE))?;
    for (file, from) in SHOWN {
        let text = read(&folder.join("src/bin").join(FIRST).join(file))?;
        let part =
            part(&text, from).ok_or_else(|| format!("{file} has no line that begins with `{from}`"))?;
        if !guide.contains(&format!("```rust\n{part}```\n")) {
            return Err(format!("{FOLDER}/{GUIDE} does not show {file} as it is compiled:\n{part}"));
        }
    }
    Ok(())
}

/// From the first line that begins with `from` to the end, or to the first empty line after a closing brace at the margin that
/// something conditional follows.
fn part<'a>(text: &'a str, from: &str) -> Option<&'a str> {
    let begin = if text.starts_with(from) { 0 } else { text.find(&format!("\n{from}"))? + 1 };
    let part = text.get(begin..)?;
    part.find("}\n\n#[cfg").map_or(Some(part), |end| part.get(..end + 2))
}

fn read(file: &Path) -> Outcome<String> {
    std::fs::read_to_string(file).map_err(|e| format!("cannot read {}: {e}", file.display()))
}

/// The log without the names of the functions that wrote it, which only an image with full debug information has, as `cargo
/// run` builds it.
fn without_places(log: &str) -> String {
    let place = |line: &str| line.ends_with(')').then(|| line.rfind(" (demo::")).flatten();
    let cut = |line: &str| place(line).and_then(|at| line.get(..at)).unwrap_or(line).to_owned() + "\n";
    log.lines().map(cut).collect()
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

    #[test]
    fn an_end_of_the_guides_loop_is_read_and_checked() {
        assert_eq!(stack(&format!("{FIRST_ENDS}10 of 20 bytes of stack\n")), Ok((10, 20)));
        assert!(stack("after 800 samples: 599 tenths of a degree\n10 of 20 bytes of stack\n").is_err());
        assert!(stack(FIRST_ENDS).is_err());
        assert!(turned_off("the duty was 334 and is 0\n"));
        for text in ["the duty was 0 and is 0\n", "the duty was 334 and is 1\n", "", "error: stopped\n"] {
            assert!(!turned_off(text), "{text}");
        }
    }

    #[test]
    fn places_are_cut_off_and_nothing_else() {
        assert_eq!(without_places("a (b) (demo::run::{impl#0}::c)\nd (e)\n"), "a (b)\nd (e)\n");
    }

    #[test]
    fn a_part_ends_with_the_file_or_before_what_is_for_the_host() {
        let text = "//! x\n\nuse a;\nfn b() {\n}\n\nfn c() {\n}\n\n#[cfg(not(x))]\nfn c() {}\n";
        assert_eq!(part(text, "use "), Some("use a;\nfn b() {\n}\n\nfn c() {\n}\n"));
        assert_eq!(part(text, "fn c"), Some("fn c() {\n}\n"));
        assert_eq!(part("use a;\n", "use"), Some("use a;\n"));
        assert_eq!(part(text, "struct"), None);
    }
}
