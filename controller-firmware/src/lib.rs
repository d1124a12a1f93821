//! What the images share.
//!
//! Built for a microcontroller, this is the start-up, the end and the console of an image on an emulated board; built
//! for a laptop it is what both can run, so that their results can be compared.
#![no_std]

#[cfg(target_os = "none")]
pub mod image;
#[cfg(target_os = "none")]
pub mod stack;
pub mod swap;
#[cfg(all(target_os = "none", feature = "timed-lock"))]
pub mod timed_lock;
pub mod trace;

#[cfg(all(target_os = "none", feature = "timed-lock", feature = "single-core"))]
compile_error!("there can be one critical section: timed-lock needs --no-default-features");

/// The name of the board this was built for.
pub const BOARD: &str = env!("CONTROLLER_BOARD");

/// Clock of the board's system timer \[Hz\].
#[cfg(target_os = "none")]
pub const CLOCK: u32 = match u32::from_str_radix(env!("CONTROLLER_CLOCK"), 10) {
    Ok(hertz) => hertz,
    Err(_) => panic!("the build script gives a whole number"),
};
