//! What a step may cost on the reference board in single precision.

use controller_pil::board::BOARDS;

use super::measure::{Range, Row};
use crate::shell::Outcome;

/// Most bytes of stack of a step in single precision where the core has a floating-point unit.
pub(super) const STACK: u32 = 64;

/// The budget of a block.
pub(super) struct Budget {
    pub(super) block: &'static str,
    /// Most instructions of a step, whatever its input.
    pub(super) most: u32,
    /// What the same equations take when written by hand, without compensated addition.
    pub(super) by_hand: Range,
    /// Why the budget is not kept, if it is known not to be.
    pub(super) known: Option<&'static str>,
}

/// All budgets.
pub(super) const BUDGETS: [Budget; 5] = [
    Budget { block: "pid", most: 65, by_hand: Range { least: 40, most: 40 }, known: None },
    Budget { block: "de-2", most: 105, by_hand: Range { least: 68, most: 68 }, known: None },
    Budget { block: "dob-1", most: 60, by_hand: Range { least: 35, most: 35 }, known: None },
    Budget { block: "loop-pid", most: 210, by_hand: LOOP_BY_HAND, known: Some(LOOP) },
    Budget { block: "loop-pid-de", most: 315, by_hand: LOOP_DE_BY_HAND, known: Some(LOOP) },
];

/// A usual sample of a closed PID loop, counted and not written. With only a range: entry and return 4, range of the
/// measurement 9, mode, quality and memory of bad samples 6, set-point 13, offset 10, read-back 4, PID 40, anti-windup 5,
/// sum 3, range of the output 8, alarms 2, the eleven fields of the result 17. With everything in use: rates of set-point
/// and output 16, range of the read-back 8, deadband 8, five alarms 30 more.
const LOOP_BY_HAND: Range = Range { least: 121, most: 183 };
/// The same with the 68 of an estimator.
const LOOP_DE_BY_HAND: Range = Range { least: 189, most: 251 };

/// Why a whole loop takes more than was hoped for.
const LOOP: &str = "a usual sample (nominal) asks about mode, quality, read-back, inhibition and alarms at 3 to 4 \
                    instructions each; the most is a sample that changes the mode, starts or settles the loop and \
                    refuses inputs, all at once: parts of two laws";

/// Why the stack of a whole loop is more than [`STACK`].
const LOOP_STACK: &str = "no whole loop keeps to it: the first frame alone, which is all that a usual sample needs, is \
                          72 to 112 bytes, and the functions for rare samples (another mode, a bad measurement, \
                          settling) add theirs";

/// The budget of a row, if it has one.
pub(super) fn of(row: &Row) -> Option<&'static Budget> {
    let reference = row.board.name == BOARDS[0].name && row.number == "f32";
    BUDGETS.iter().find(|budget| reference && budget.block == row.block)
}

/// Why a step takes more stack than it should, if it does.
pub(super) fn stack_note(row: &Row) -> Option<&'static str> {
    let limited = row.number == "f32" && row.in_hardware() && row.step.stack > STACK;
    limited.then_some(if row.block.starts_with("loop") { LOOP_STACK } else { "" })
}

/// Whether every step keeps to its budget, or is known not to.
pub(super) fn check(rows: &[Row]) -> Outcome {
    let mut faults = Vec::new();
    for row in rows {
        let most = row.step.all().map_or(u32::MAX, |range| range.most);
        match of(row) {
            Some(Budget { most: limit, known: None, block, .. }) if most > *limit => {
                faults.push(format!("a step of {block} takes {most} instructions, its budget is {limit}"));
            }
            Some(Budget { most: limit, known: Some(_), block, .. }) if most <= *limit => {
                faults.push(format!("{block} keeps its budget of {limit}: it is no longer known not to"));
            }
            _ => {}
        }
        if !row.block.starts_with("loop")
            && row.block != "pid-limit"
            && row.in_hardware()
            && row.step.dearest().is_some()
        {
            let (block, number, board) = (&row.block, &row.number, row.board.name);
            faults.push(format!(
                "a step of {block} in {number} on {board} must take the same for every input: {:?}",
                row.step.classes
            ));
        }
        if stack_note(row) == Some("") {
            let (block, board, stack) = (&row.block, row.board.name, row.step.stack);
            faults
                .push(format!("a step of {block} takes {stack} bytes of stack on {board}, at most {STACK}"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
}

#[cfg(test)]
mod tests {
    use super::super::measure::Function;
    use super::*;

    fn row(block: &str, most: u32, stack: u32) -> Row {
        let range = Range { least: most, most };
        let step = Function { classes: vec![("nominal".into(), range)], stack, ..Function::default() };
        let (adopt, new) = (Function::default(), Function::default());
        let [block, number] = [block, "f32"].map(String::from);
        Row { board: &BOARDS[0], block, number, law: 0, state: 0, step, adopt, new }
    }

    #[test]
    fn a_step_over_its_budget_is_refused_unless_it_is_known() {
        assert!(check(&[row("pid", 65, 64), row("other", 9999, 64)]).is_ok());
        assert!(check(&[row("pid", 66, 8)]).unwrap_err().contains("budget is 65"));
        assert!(check(&[row("loop-pid", 211, 8)]).is_ok());
        assert!(check(&[row("loop-pid", 210, 8)]).unwrap_err().contains("no longer"));
    }

    #[test]
    fn a_law_takes_the_same_for_every_input() {
        let mut uneven = row("pid", 60, 8);
        uneven.step.classes.push(("random".into(), Range { least: 58, most: 60 }));
        assert!(check(&[uneven.clone()]).unwrap_err().contains("for every input"));
        uneven.number = "f64".into();
        assert!(check(&[uneven]).is_ok(), "in software a number decides");
    }

    #[test]
    fn stack_is_limited_but_for_whole_loops() {
        assert!(check(&[row("pid", 60, 72)]).unwrap_err().contains("72 bytes"));
        assert!(check(&[row("loop-pid", 300, 72)]).is_ok());
    }
}
