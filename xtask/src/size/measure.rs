//! Builds the meter's images, runs them, reads what they print.

use std::path::{Path, PathBuf};

use controller_pil::board::{BOARDS, Board};

use crate::shell::{Cmd, Outcome, target_dir};

/// The images, one for each number type.
const IMAGES: [&str; 2] = ["meter-f32", "meter-f64"];
/// Seconds that an image may run: some, and much more on a busy machine.
const SECONDS: &str = "300";

/// Least and most instructions of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    pub(super) least: u32,
    pub(super) most: u32,
}

impl Range {
    /// Both together.
    fn and(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.least == self.most {
            f.pad(&self.most.to_string())
        } else {
            f.pad(&format!("{}-{}", self.least, self.most))
        }
    }
}

/// One function: a step, a swap of the law, the building of a law.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Function {
    /// Instructions by the class of the input.
    pub(super) classes: Vec<(String, Range)>,
    /// Where it begins in its image.
    pub(super) address: String,
    /// Bytes of code, with all that it calls.
    pub(super) code: u32,
    /// Bytes of stack, with all that it calls.
    pub(super) stack: u32,
}

impl Function {
    /// Over all classes.
    pub(super) fn all(&self) -> Option<Range> {
        self.classes.iter().map(|(_, range)| *range).reduce(Range::and)
    }

    /// The class with the most instructions, the first one of several; nothing when all are the same.
    pub(super) fn dearest(&self) -> Option<&str> {
        let all = self.all().filter(|all| all.least != all.most)?;
        self.classes.iter().find(|(_, range)| range.most == all.most).map(|(class, _)| class.as_str())
    }

    /// The instructions of one class.
    pub(super) fn class(&self, name: &str) -> Option<Range> {
        self.classes.iter().find(|(class, _)| class == name).map(|(_, range)| *range)
    }
}

/// A block in one number type on one board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) board: &'static Board,
    pub(super) block: String,
    pub(super) number: String,
    /// Bytes of the law and of its state.
    pub(super) law: u32,
    pub(super) state: u32,
    pub(super) step: Function,
    pub(super) adopt: Function,
    pub(super) new: Function,
}

impl Row {
    /// Whether the board computes in this number type by itself, not by a library.
    pub(super) fn in_hardware(&self) -> bool {
        self.board.target.ends_with("hf") && (self.number == "f32" || self.board.core == "Cortex-M7")
    }
}

/// Measures everything on every board.
pub(super) fn all(root: &Path) -> Outcome<Vec<Row>> {
    Cmd::cargo(root).args(["build", "--quiet", "-p", "controller-emulate"]).run()?;
    let tool =
        |name: &str| target_dir(root).join("debug").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let (emulate, footprint) = (tool("controller-emulate"), tool("footprint"));
    let mut rows = Vec::new();
    for board in &BOARDS {
        let folder = build(root, board)?;
        for image in IMAGES {
            let image = folder.join(image);
            let lines = Cmd::new(&emulate, root).env("EMULATE_SECONDS", SECONDS).arg(&image).capture()?;
            let mut measured = read(board, &lines)?;
            let functions = || measured.iter().flat_map(|row| [&row.step, &row.adopt, &row.new]);
            let addresses: Vec<String> = functions().map(|function| function.address.clone()).collect();
            let sizes = Cmd::new(&footprint, root).arg(&image).args(addresses).capture()?;
            add_sizes(&mut measured, &sizes)?;
            rows.extend(measured);
        }
    }
    Ok(rows)
}

/// Builds the images of a board; gives their folder.
fn build(root: &Path, board: &Board) -> Outcome<PathBuf> {
    // The compiler tells the sizes of stack frames only when it is allowed what is not stable. The code is the same.
    let mut flags = String::from("-Zemit-stack-sizes");
    if let Some(cpu) = board.cpu {
        // This variable parts words by this character.
        flags.push_str(&format!("\u{1f}-Ctarget-cpu={cpu}"));
    }
    let folder = target_dir(root).join("size").join(board.name);
    let mut cmd = Cmd::cargo(root)
        .env("CONTROLLER_BOARD", board.name)
        .env("RUSTC_BOOTSTRAP", "1")
        // Incremental builds cut the code into other pieces.
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_ENCODED_RUSTFLAGS", &flags)
        .args(["build", "--quiet", "--release", "-p", "controller-firmware", "--target", board.target])
        .args(["--config=profile.release.debug=false", "--target-dir"])
        .arg(&folder);
    for image in IMAGES {
        cmd = cmd.args(["--bin", image]);
    }
    cmd.run()?;
    Ok(folder.join(board.target).join("release"))
}

/// What an image has printed.
fn read(board: &'static Board, lines: &str) -> Outcome<Vec<Row>> {
    let mut rows: Vec<Row> = Vec::new();
    for line in lines.lines() {
        let wrong = || format!("the meter says what nobody understands: {line}");
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["bytes", block, number, law, state] = words[..] {
            let [law, state] = [law, state].map(|word| word.parse().ok());
            rows.push(Row {
                board,
                block: block.into(),
                number: number.into(),
                law: law.ok_or_else(wrong)?,
                state: state.ok_or_else(wrong)?,
                step: Function::default(),
                adopt: Function::default(),
                new: Function::default(),
            });
            continue;
        }
        let row = rows.last_mut().ok_or_else(wrong)?;
        let &[kind, what, block, number, ref rest @ ..] = &words[..] else { return Err(wrong()) };
        let function = match what {
            "step" => &mut row.step,
            "adopt" => &mut row.adopt,
            "new" => &mut row.new,
            _ => return Err(wrong()),
        };
        if block != row.block || number != row.number {
            return Err(wrong());
        }
        match (kind, rest) {
            ("code", [address]) => function.address = (*address).into(),
            ("count", [class, least, most]) => {
                let [least, most] = [least, most].map(|word| word.parse().ok());
                let range = Range { least: least.ok_or_else(wrong)?, most: most.ok_or_else(wrong)? };
                match function.classes.iter_mut().find(|(known, _)| known == class) {
                    Some((_, known)) => *known = known.and(range),
                    None => function.classes.push(((*class).into(), range)),
                }
            }
            _ => return Err(wrong()),
        }
    }
    if rows.is_empty() { Err("the meter has measured nothing".into()) } else { Ok(rows) }
}

/// What `footprint` has printed for the functions of these rows.
fn add_sizes(rows: &mut [Row], lines: &str) -> Outcome {
    let mut lines = lines.lines();
    for function in rows.iter_mut().flat_map(|row| [&mut row.step, &mut row.adopt, &mut row.new]) {
        let line = lines.next().unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        let sizes = match words[..] {
            [address, code, stack] if address == function.address => {
                code.parse().ok().zip(stack.parse().ok())
            }
            _ => None,
        };
        (function.code, function.stack) =
            sizes.ok_or_else(|| format!("not a size of {}: {line}", function.address))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: &str = "bytes pid f32 28 36\ncode step pid f32 0x10\ncode adopt pid f32 0x20\ncode new pid f32 0x30\n\
        count new pid f32 all 90 90\ncount new pid f32 all 80 80\ncount step pid f32 nominal 50 52\n\
        count step pid f32 random 51 60\ncount adopt pid f32 all 36 36\n";

    #[test]
    fn the_meters_lines_become_rows() {
        let mut rows = read(&BOARDS[0], LINES).unwrap();
        add_sizes(&mut rows, "0x10 200 8\n0x20 40 0\n0x30 900 400\n").unwrap();
        let [row] = &rows[..] else { panic!("one row") };
        assert_eq!((row.law, row.state, row.step.code, row.new.stack), (28, 36, 200, 400));
        assert_eq!(row.step.all().unwrap().to_string(), "50-60");
        assert_eq!((row.step.dearest(), row.adopt.dearest()), (Some("random"), None));
        assert_eq!(row.new.all().unwrap().to_string(), "80-90");
        assert_eq!(row.adopt.all().unwrap().to_string(), "36");
    }

    #[test]
    fn other_lines_are_refused() {
        assert!(read(&BOARDS[0], "").is_err());
        assert!(read(&BOARDS[0], "hard fault at 0\n").is_err());
        assert!(read(&BOARDS[0], &format!("{LINES}count step de-2 f32 nominal 1 2\n")).is_err());
        let mut rows = read(&BOARDS[0], LINES).unwrap();
        assert!(add_sizes(&mut rows, "0x10 200 8\n0x24 40 0\n").is_err());
    }
}
