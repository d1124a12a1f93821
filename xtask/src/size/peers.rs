//! Other controllers, measured in the same way, beside ours.

use controller_pil::board::BOARDS;

use super::markdown::{most, name};
use super::measure::Row;

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

/// Both in one table, and where a smaller one is cheaper.
pub(super) fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "f32 on the reference board unless the name says otherwise. W: set-point weight; D1: filter of first order; S:\n\
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
         which costs {}, in a usual sample {}. On cores without a floating-point unit the fixed-point forms (idsp: 35 on an\n\
         M3) take 20 to 60 times fewer instructions than a law of ours.\n",
        count("pid"),
        count("pid-limit"),
        count("loop-pid"),
        ours.clone()
            .find(|row| row.block == "loop-pid")
            .and_then(|row| row.step.class("nominal"))
            .map_or("-".into(), |range| range.to_string())
    ));
    text
}
