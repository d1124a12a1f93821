//! The table for people, beside other controllers that were measured in the same way.

use controller_pil::board::BOARDS;

use super::budget;
use super::measure::{Function, Row};

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

/// A controller of others: name, features, instructions of a step, bytes of code, bytes of RAM.
type Peer = [&'static str; 5];

/// Measured on the reference board with the same method; C by GCC 12.2 `-O2 -mcpu=cortex-m4 -ffp-contract=off`, Rust with
/// the release profile of this workspace; four classes of inputs, 500 steps each.
const PEERS: [Peer; 10] = [
    ["CMSIS-DSP `arm_pid_f32`", "PID on the error", "17", "66", "36"],
    ["CMSIS-DSP `arm_pid_q31`", "PID on the error, fixed point", "20", "48", "36"],
    ["idsp 0.23 `Biquad` f32", "any 2nd order, 1", "18", "66", "28"],
    ["idsp 0.23 `BiquadClamp` f32", "1, D1, S, CL, O", "30", "110", "40"],
    ["idsp 0.23 `BiquadClamp` Q32", "1, D1, S, CL, O, fixed point", "37", "106", "52"],
    ["DiscretePIDs.jl, its algorithm in C, f32", "W, D1, S, BC, O", "37-42", "162", "68"],
    ["the same, f64", "W, D1, S, BC, O", "1403-1897", "304 + float library", "136"],
    ["Arduino-PID `Compute`, float", "S, CL, T", "42-52", "272", "52"],
    ["crate `pid` 4.0, f32", "S, CL", "124", "326", "44"],
    ["crate `discrete_pid` 0.3, f32", "D1, S, CL, O, T", "173", "620", "120"],
];

/// What each of ours has, in the same letters.
fn features(block: &str) -> &'static str {
    match block {
        "pid" => "W, D1, K",
        "pid-limit" => "W, D1, S, R, BC, K",
        "de-2" | "de-1" | "dob-1" | "dob-3" => "disturbance, dead time, K",
        "adrc" => "disturbance, K",
        "loop-pid" => "W, D1, S, R, BC, O, M, K",
        "loop-pid-de" | "loop-pi-dob" => "W, D1, S, R, BC, O, M, disturbance, dead time, K",
        _ => "S, R, O, M, disturbance, K",
    }
}

/// The page.
pub(super) fn page(rows: &[Row], compiler: &str) -> String {
    let reference = |row: &&Row| row.board.name == BOARDS[0].name;
    let single = |row: &&Row| row.number == "f32";
    let mut text = format!(
        "# What a step costs\n\n\
         Written by `cargo xtask size --update` and checked by `cargo xtask size`; {compiler}, release profile. Every number\n\
         of every board, with the classes of inputs, is in `tests/target/`.\n\n\
         Instructions are counted in the emulator, exactly, from the first instruction of a call to its return. They are not\n\
         cycles: a Cortex-M4F takes about 1.5 to 2 cycles for one of this code, more with wait states of the flash. Code and\n\
         stack are those of the function with everything it calls; RAM is law and state, with a delay line of 24 samples\n\
         where there is one (one number more for each further sample). One number means: the same for every input.\n\n\
         ## Reference board: {}, f32\n\n\
         | block | instructions | at | budget | by hand | code B | RAM B | stack B |\n|---|---|---|---|---|---|---|---|\n",
        BOARDS[0].core
    );
    let mut notes = Vec::new();
    for row in rows.iter().filter(reference).filter(single) {
        let budget = budget::of(row);
        let number = |x: Option<u32>| x.map_or("-".into(), |x| x.to_string());
        text.push_str(&format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} |\n",
            name(&row.block),
            most(&row.step),
            row.step.dearest().unwrap_or("-"),
            number(budget.map(|budget| budget.most)),
            number(budget.and_then(|budget| budget.by_hand)),
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
    text.push_str("\n\"By hand\" is what the same equations take without compensated addition.\n");
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
    text.push_str(&beside_others(rows));
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
        "\nCores without a floating-point unit, and all but the M7 in f64, compute with a library: the count then depends on\n\
         the numbers.\n\n## Building a law, and swapping it\n\n\
         On the reference board in f32. `new` computes in f64, which this core does in software: build laws when the program\n\
         starts, or in the main context.\n\n\
         | block | `new`: instructions | stack B | `adopt`: instructions | stack B |\n|---|---|---|---|---|\n",
    );
    for row in rows.iter().filter(reference).filter(single) {
        let (name, new, adopt) = (name(&row.block), most(&row.new), most(&row.adopt));
        text.push_str(&format!("| {name} | {new} | {} | {adopt} | {} |\n", row.new.stack, row.adopt.stack));
    }
    text.push_str(
        "\n`new` of a loop is without that of its compensator. While a law of 220 bytes is handed to the interrupt by a\n\
         `ParamCell`, interrupts are off for 237 instructions (the rung `swap` counts them and fails above 250).\n",
    );
    text
}

/// What the classes of a loop's inputs are.
const CLASSES: &str = "
nominal: closed, good samples, a set-point that moves, noise, an offset; options: read-back, inhibition, uncertain samples,
a compensator switched in and out; high, low: at a limit; a mode: all samples in which it is asked for, the change to it from
every other one among them; bad: held samples; fallback: after these; return: the first good ones; start: the first samples
of a zeroed state; random: any bits in any input. Each in three configurations: only a range, everything configured,
conditional anti-windup.
";

fn beside_others(rows: &[Row]) -> String {
    let mut text = String::from(
        "\n## Beside others\n\n\
         f32 on the reference board unless the name says otherwise. W: set-point weight; D1: filter of first order; S:\n\
         saturation; R: rate limits; BC: back-calculation; CL: clamped state against windup; O: offset; T: checks the time; M:\n\
         modes, bad samples, alarms, read-back; K: compensated addition, which does not stall in single precision; 1: one degree\n\
         of freedom.\n\n\
         | controller | has | instructions | code B | RAM B |\n|---|---|---|---|---|\n",
    );
    for [name, has, instructions, code, ram] in PEERS {
        text.push_str(&format!("| {name} | {has} | {instructions} | {code} | {ram} |\n"));
    }
    let ours = rows.iter().filter(|row| row.board.name == BOARDS[0].name && row.number == "f32");
    for row in ours.clone() {
        text.push_str(&format!(
            "| **ours:** {} | {} | {} | {} | {} |\n",
            name(&row.block),
            features(&row.block),
            most(&row.step),
            row.step.code,
            row.law + row.state
        ));
    }
    let count = |block: &str| {
        let row = ours.clone().find(|row| row.block == block);
        row.map_or("-".into(), |row| most(&row.step))
    };
    text.push_str(&format!(
        "\nWhere a smaller one is cheaper: a PID on the error alone takes 17 instructions in CMSIS-DSP, a clamped biquad 30 in\n\
         idsp; our bare `Pid` takes {}, for two degrees of freedom, the filter and three compensated sums. The algorithm of\n\
         DiscretePIDs.jl has saturation and back-calculation in 37 to 42; ours with a rate limit and compensated sums takes {}.\n\
         A loop that needs no modes, no check of its measurement and no alarms should take these blocks and not `Controller`,\n\
         which costs {}. On cores without a floating-point unit the fixed-point forms (idsp: 35 on an M3) are some thirty times\n\
         cheaper than anything here.\n",
        count("pid"),
        count("pid-limit"),
        count("loop-pid")
    ));
    text
}

fn name(block: &str) -> &str {
    NAMES.iter().find(|(known, _)| *known == block).map_or(block, |(_, name)| name)
}

fn most(function: &Function) -> String {
    function.all().map_or("-".into(), |range| range.to_string())
}
