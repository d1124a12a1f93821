//! A control loop as a user would build it: a timer interrupt runs it, the main context watches and retunes it.
//!
//! | file | holds |
//! |---|---|
//! | `heater_law.rs` | the loop, exported from `demo/loop.toml`, which `controller-sim design --save` wrote |
//! | `task.rs` | the control task: sensor, law, actuator, telemetry |
//! | `rig.rs` | the heater and its converters, simulated: what a board's own drivers take the place of |
//!
//! In the folder `controller-firmware`: `cargo run --release`. Its log is held by `demo/expected.txt`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[rustfmt::skip]
#[allow(unreachable_pub, reason = "exported: what it offers is not all used here")]
mod heater_law;
#[cfg(target_os = "none")]
mod rig;
#[cfg(target_os = "none")]
mod run;
#[cfg(target_os = "none")]
mod task;

#[cfg(not(target_os = "none"))]
fn main() {
    println!("demo: runs on a microcontroller; in the folder controller-firmware: cargo run --release");
}
