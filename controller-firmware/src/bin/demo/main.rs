//! Control loops as a user would build them: a timer interrupt runs them, the main context watches and retunes.
//!
//! | file | holds |
//! |---|---|
//! | `heater.rs` | a fast loop: ADC on SPI, PWM channel, law with a disturbance estimator, parameters replaced while it runs |
//! | `oven.rs` | a slow loop: ADC and DAC (for a recorder) on I2C, relay |
//! | `run.rs` | start-up and interrupts |
//! | `telemetry.rs` | what goes from the interrupt to the main context |
//! | `watch.rs` | the main loop: logs, the operator, another tuning |
//! | `heater_law.rs`, `oven_law.rs` | the laws, exported from `demo/loop.toml` and `demo/oven.toml` |
//! | `rig/` | plants and devices, simulated: what a board's own drivers take the place of |
//!
//! In the folder `controller-firmware`: `cargo run --release`. Its log is held by `demo/expected.txt`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod heater;
#[cfg(target_os = "none")]
#[rustfmt::skip]
#[allow(unreachable_pub, reason = "exported: what it offers is not all used here")]
mod heater_law;
#[cfg(target_os = "none")]
mod oven;
#[cfg(target_os = "none")]
#[rustfmt::skip]
#[allow(unreachable_pub, reason = "exported: what it offers is not all used here")]
mod oven_law;
#[cfg(target_os = "none")]
mod rig;
#[cfg(target_os = "none")]
mod run;
#[cfg(target_os = "none")]
mod telemetry;
#[cfg(target_os = "none")]
mod watch;

#[cfg(not(target_os = "none"))]
fn main() {
    println!("demo: runs on a microcontroller; in the folder controller-firmware: cargo run --release");
}
