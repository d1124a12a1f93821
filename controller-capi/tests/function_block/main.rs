//! The function block against numbers worked out by hand.
#![allow(missing_docs, missing_debug_implementations, unreachable_pub)]
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::missing_safety_doc,
    clippy::undocumented_unsafe_blocks
)]
#![allow(clippy::panic, clippy::modulo_arithmetic, clippy::integer_division)]

mod behaviour;
mod damage;
mod memory;
mod parameters;
mod period;
mod rig;
mod spans;
