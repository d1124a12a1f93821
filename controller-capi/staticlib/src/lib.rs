//! The archive `libctl.a`: the functions of `controller-capi` and nothing else.
//!
//! Built with `--profile embedded` it needs no operating system; built with another profile, for debugging on a host, it
//! brings Rust's standard library along.
#![cfg_attr(panic = "abort", no_std)]

pub use controller_capi::*;

/// No function of the archive can panic, so the linker throws this away.
#[cfg(all(panic = "abort", not(test)))]
#[panic_handler]
fn on_panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
