//! The controller behind a C interface: [`controller_core::Controller`] with its PID, disturbance estimator or observer,
//! limits, modes, bad-sample handling and alarms, in a block of memory that the caller owns.
//!
//! The header is `include/ctl.h`; every name here is explained there for C. This crate is an `rlib`, so that Rust code can
//! test it; the archive for a C linker is built by `controller-capi/staticlib`.
//!
//! # What holds
//!
//! * No allocation, no globals, no callbacks, no unwinding; calls on different blocks do not disturb each other.
//! * A block holds no address. It may be moved and copied as bytes between two calls, delay memory included.
//! * Zero bytes are a block that is not initialised, and every call says so.
//! * A call that fails changes nothing that was intact.
//! * Whatever bits a block holds, no call reads or writes beyond it.
//! * The same inputs give the same bits as [`controller_core::Controller::step`] on any machine.
//!
//! # Modules
//!
//! | module | holds |
//! |---|---|
//! | [`config`] | the configuration as C sees it, and its translation |
//! | [`io`] | inputs and outputs of a step |
//! | [`fault`] | error codes, faults of a configuration, their texts |
//! | `block` | the caller's memory: layout, checks, where the delay memory is |
//! | `header` | the beginning of a block: whose it is, sums |
//! | `calls` | what each function does, for both number types |
//! | [`exports`] | the functions themselves |
//! | [`plc`] | the function block of IEC 61131-3 over them, with the header `include/ctl_fb.h` |
#![no_std]

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::indexing_slicing, clippy::modulo_arithmetic)]
mod any_bits;
mod block;
mod calls;
pub mod config;
pub mod exports;
pub mod fault;
mod header;
pub mod io;
pub mod plc;
mod snapshot;

pub use block::{MAX_DELAY, Number};
pub use config::Config;
pub use exports::*;
pub use fault::{Error, Fault, Faults, MAX_FAULTS};
pub use io::{Input, Output};
pub use plc::exports::*;

/// Version of the interface: of the structures, the codes and the functions of the header.
pub const ABI_VERSION: u32 = 1;
