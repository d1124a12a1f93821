//! The committed table.

use super::budget;
use super::measure::Row;

/// The table as it is committed.
pub(super) fn text(rows: &[Row], compiler: &str) -> String {
    let mut text = format!(
        "# What the blocks cost on the emulated boards. Written by `cargo xtask size --update`, checked by `cargo xtask size`.\n\
         # {compiler}, release profile. Instructions of one call, least-most over all inputs; they are not cycles.\n\
         # Bytes: code with all that is called, the law, its state, the most stack with all that is called.\n\
         # A second line gives the classes of inputs where a step's instructions differ.\n\n"
    );
    let line = |words: [&str; 13]| {
        const WIDTHS: [usize; 13] = [11, 12, 5, 12, 7, 6, 5, 6, 12, 6, 16, 7, 7];
        let cells: Vec<String> =
            words.iter().zip(WIDTHS).map(|(word, width)| format!("{word:width$}")).collect();
        format!("{}\n", cells.join(" ").trim_end())
    };
    let head = [
        "board", "block", "type", "step", "code", "stack", "law", "state", "swap", "stack", "new", "code",
        "stack",
    ];
    text.push_str(&line(head));
    for row in rows {
        let range = |function: &super::measure::Function| {
            function.all().map(|range| range.to_string()).unwrap_or_default()
        };
        let numbers =
            [row.step.code, row.step.stack, row.law, row.state, row.adopt.stack, row.new.code, row.new.stack]
                .map(|number| number.to_string());
        let [code, stack, law, state, swap_stack, new_code, new_stack] = &numbers;
        let (step, swap, new) = (range(&row.step), range(&row.adopt), range(&row.new));
        text.push_str(&line([
            row.board.name,
            &row.block,
            &row.number,
            &step,
            code,
            stack,
            law,
            state,
            &swap,
            swap_stack,
            &new,
            new_code,
            new_stack,
        ]));
        if row.step.dearest().is_some() {
            let classes: Vec<String> =
                row.step.classes.iter().map(|(class, range)| format!("{class} {range}")).collect();
            text.push_str(&format!("    {}\n", classes.join(", ")));
        }
        if let Some(budget) = budget::of(row) {
            let hand = format!(", by hand {}", budget.by_hand);
            let note = budget.known.map(|note| format!("; note: {note}")).unwrap_or_default();
            text.push_str(&format!("    budget {}{hand}{note}\n", budget.most));
        }
    }
    text
}

/// What a loop card needs of it: instructions of a step, least and most over all inputs and over usual ones, bytes of law
/// and state.
pub(super) fn csv(rows: &[Row]) -> String {
    let mut text = "board,block,type,least,most,usual_least,usual_most,law,state\n".to_owned();
    for row in rows {
        let Some(all) = row.step.all() else { continue };
        let usual =
            row.step.classes.iter().find(|(class, _)| class == "nominal").map_or(all, |(_, range)| *range);
        let (board, block, number) = (row.board.name, &row.block, &row.number);
        text.push_str(&format!(
            "{board},{block},{number},{},{},{},{},{},{}\n",
            all.least, all.most, usual.least, usual.most, row.law, row.state
        ));
    }
    text
}

/// The first lines in which two texts differ, at most a few.
pub(super) fn difference(old: &str, new: &str) -> String {
    const MOST: usize = 20;
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let mut text = String::new();
    let mut count = 0;
    for at in 0..old.len().max(new.len()) {
        let (was, is) = (old.get(at), new.get(at));
        if was != is && count < MOST {
            text.push_str(&format!("- {}\n+ {}\n", was.unwrap_or(&""), is.unwrap_or(&"")));
        }
        count += usize::from(was != is);
    }
    text.push_str(&format!("{count} lines differ\n"));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_shown_line_by_line() {
        assert_eq!(difference("a\nb\nc\n", "a\nx\nc\nd\n"), "- b\n+ x\n- \n+ d\n2 lines differ\n");
        assert_eq!(difference("a\n", "a\n"), "0 lines differ\n");
    }
}
