//! The table for people.

use controller_pil::board::BOARDS;

use super::measure::{Function, Row};
use super::{budget, peers};
use crate::swap::INTERRUPTS_OFF;

/// Names of the blocks.
const NAMES: [(&str, &str); 11] = [
    ("pid", "`Pid`"),
    ("pid-limit", "`Pid` + `Limit` + `AntiWindup`"),
    ("de-2", "`Compensator`, DE, model of 2nd order"),
    ("de-1", "`Compensator`, DE, model of 1st order"),
    ("dob-1", "`Compensator`, DOB, 1st order"),
    ("dob-3", "`Compensator`, DOB, 3rd order"),
    ("adrc", "`Adrc`"),
    ("loop-pid", "`Controller`, PID"),
    ("loop-pid-de", "`Controller`, PID + DE"),
    ("loop-pi-dob", "`Controller`, PI + DOB"),
    ("loop-adrc", "`Controller`, ADRC"),
];

/// The page.
pub(super) fn page(rows: &[Row], compiler: &str) -> String {
    let reference = |row: &&Row| row.board.name == BOARDS[0].name;
    let single = |row: &&Row| row.number == "f32";
    let mut text = format!(
        "# What a step costs\n\n\
         Written by `cargo xtask size --update` and checked by `cargo xtask size`; {compiler}, release profile. Every number\n\
         of every board, with the classes of inputs, is in `tests/target/`.\n\n\
         Instructions are counted in the emulator, exactly, from the first instruction of a call to its return. They are not\n\
         cycles: a Cortex-M4F takes about 1.5 to 1.8 cycles for one of this code, more with wait states of the flash. Code and\n\
         stack are those of the function with everything it calls; RAM is law and state, with a delay line of 24 samples\n\
         where there is one (one number more for each further sample). One number means: the same for every input.\n\n\
         ## Reference board: {}, f32\n\n\
         | block | instructions | at | budget | by hand | code B | RAM B | stack B |\n|---|---|---|---|---|---|---|---|\n",
        BOARDS[0].core
    );
    let mut notes = Vec::new();
    for row in rows.iter().filter(reference).filter(single) {
        let budget = budget::of(row);
        text.push_str(&format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} |\n",
            name(&row.block),
            most(&row.step),
            row.step.dearest().unwrap_or("-"),
            budget.map_or("-".into(), |budget| budget.most.to_string()),
            budget.map_or("-".into(), |budget| budget.by_hand.to_string()),
            row.step.code,
            row.law + row.state,
            row.step.stack
        ));
        if let Some(note) = budget.and_then(|budget| budget.known)
            && !notes.contains(&note)
        {
            notes.push(note);
        }
    }
    let stack = rows.iter().filter(reference).filter(single).find_map(budget::stack_note);
    text.push_str(
        "\n\"By hand\" is what the same equations take without compensated addition; of a whole loop a usual sample, with only a\n\
         range and with everything in use, counted block by block.\n",
    );
    for note in notes {
        text.push_str(&format!("\nLoops above their budget: {note}.\n"));
    }
    if let Some(note) = stack {
        text.push_str(&format!("\nStack, at most {} bytes for a step: {note}.\n", budget::STACK));
    }
    text.push_str("\n### Loops by class of input\n\n");
    let loops: Vec<&Row> =
        rows.iter().filter(reference).filter(single).filter(|row| row.block.starts_with("loop")).collect();
    text.push_str("| input |");
    loops.iter().for_each(|row| text.push_str(&format!(" {} |", name(&row.block))));
    text.push_str(&format!("\n|---|{}\n", "---|".repeat(loops.len())));
    if let Some(first) = loops.first() {
        for (class, _) in &first.step.classes {
            text.push_str(&format!("| {class} |"));
            for row in &loops {
                text.push_str(&format!(" {} |", row.step.class(class).map_or("-".into(), |x| x.to_string())));
            }
            text.push('\n');
        }
    }
    text.push_str(CLASSES);
    text.push_str(&format!("\n## Beside others\n\n{}", peers::table(rows)));
    text.push_str("\n## All boards: instructions of a step\n\n| block |");
    for board in &BOARDS {
        text.push_str(&format!(" {} f32 | f64 |", board.core.trim_start_matches("Cortex-")));
    }
    text.push_str(&format!("\n|---|{}\n", "---|---|".repeat(BOARDS.len())));
    for (block, name) in NAMES {
        text.push_str(&format!("| {name} |"));
        for board in &BOARDS {
            for number in ["f32", "f64"] {
                let row = rows
                    .iter()
                    .find(|row| row.board.name == board.name && row.block == block && row.number == number);
                text.push_str(&format!(" {} |", row.map_or("-".into(), |row| most(&row.step))));
            }
        }
        text.push('\n');
    }
    text.push_str(
        &format!("\nCores without a floating-point unit, and all but the M7 in f64, compute with a library: the count then depends on\n\
         the numbers. {}\n\n## Building a law, and swapping it\n\n\
         On the reference board in f32. `new` computes in f64, which this core does in software: build laws when the program\n\
         starts, or in the main context.\n\n\
         | block | `new`: instructions | stack B | `adopt`: instructions | stack B |\n|---|---|---|---|---|\n", in_software(rows)),
    );
    for row in rows.iter().filter(reference).filter(single) {
        let (name, new, adopt) = (name(&row.block), most(&row.new), most(&row.adopt));
        text.push_str(&format!("| {name} | {new} | {} | {adopt} | {} |\n", row.new.stack, row.adopt.stack));
    }
    text.push_str(&format!(
        "\n`new` of a loop is without that of its compensator. While a law of 220 bytes is handed to the interrupt by a\n\
         `ParamCell`, interrupts are off for {INTERRUPTS_OFF} instructions (the rung `swap` counts them).\n",
    ));
    text
}

/// How much more software takes, a law in any sample and a loop in a usual one.
fn in_software(rows: &[Row]) -> String {
    let mut laws = Vec::new();
    let mut loops = Vec::new();
    for row in rows.iter().filter(|row| !row.in_hardware()) {
        let is_loop = row.block.starts_with("loop");
        let count = |row: &Row| if is_loop { row.step.class("nominal") } else { row.step.all() };
        let reference = rows.iter().find(|other| {
            (other.board.name, other.number.as_str(), &other.block) == (BOARDS[0].name, "f32", &row.block)
        });
        if let (Some(one), Some(many)) = (reference.and_then(count), count(row)) {
            let list = if is_loop { &mut loops } else { &mut laws };
            list.extend([many.least / one.least.max(1), many.most.div_ceil(one.most.max(1))]);
        }
    }
    let span =
        |list: &[u32]| (list.iter().min().copied().unwrap_or(0), list.iter().max().copied().unwrap_or(0));
    let ((a, b), (c, d)) = (span(&laws), span(&loops));
    format!(
        "Beside the reference\nboard in f32 a law takes {a} to {b} times as many instructions, a loop in a usual sample {c} to {d} times."
    )
}

/// What the classes of a loop's inputs are.
const CLASSES: &str = "
nominal: closed, good samples, a set-point that moves, noise, an offset; options: read-back, inhibition, uncertain samples,
a compensator switched in and out; high, low: at a limit; a mode: all samples in which it is asked for, the change to it from
every other one among them; bad: held samples; fallback: after these; return: the first good ones; start: the first samples
of a zeroed state; random: any bits in any input. Each in three configurations: only a range, everything configured,
conditional anti-windup.
";

pub(super) fn name(block: &str) -> &str {
    NAMES.iter().find(|(known, _)| *known == block).map_or(block, |(_, name)| name)
}

pub(super) fn most(function: &Function) -> String {
    function.all().map_or("-".into(), |range| range.to_string())
}
