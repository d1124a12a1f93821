//! The function block of IEC 61131-3: the loop with the variables that a PLC's engineer expects, so that every runtime that can call
//! C gets the same block. Its page is `iec/README.md`.
//!
//! | module | holds |
//! |---|---|
//! | [`vars`] | the variables |
//! | `parameters` | parameters of the block to the configuration of a loop, and faults back |
//! | `span` | counts, per cent, engineering units |
//! | `period` | the measured period of the task against TS |
//! | `instance` | the memory, at any address |
//! | `scan` | what a call does |
//! | [`exports`] | the functions |

pub mod exports;
mod instance;
mod parameters;
mod period;
mod scan;
mod span;
pub mod vars;

pub use vars::Vars;

/// The number types, with what the header says of their function blocks.
pub trait Number: crate::block::Number {
    /// First word of an instance.
    const FB_MAGIC: u32;
    /// Size of an instance but for the block of its loop \[bytes\].
    const FB_FIXED: usize;
}

impl Number for f32 {
    const FB_MAGIC: u32 = 0x4642_4C43;
    const FB_FIXED: usize = 416;
}

impl Number for f64 {
    const FB_MAGIC: u32 = 0x4642_4C44;
    const FB_FIXED: usize = 640;
}

const _: () = assert!(fits::<f32>() && fits::<f64>());

const fn fits<T: Number>() -> bool {
    size_of::<instance::Instance<T>>() <= T::FB_FIXED
        && T::FB_FIXED.is_multiple_of(crate::block::ALIGN)
        // Every bit pattern is an instance: else `None` would be one that is not, and take no room.
        && size_of::<Option<instance::Instance<T>>>() > size_of::<instance::Instance<T>>()
}

/// Types of variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// REAL, LREAL.
    Real,
    /// DINT.
    Whole,
    /// DWORD.
    Bits,
    /// BOOL.
    Flag,
}

/// Status bits of the function block; the others are those of [`controller_core::Status`].
pub mod status {
    /// The measured period is more than 10 % off TS.
    pub const PERIOD_OFF: u32 = 0x0100_0000;
    /// The compensator is not used because the period is, or was, more than 30 % off.
    pub const COMPENSATOR_OUT: u32 = 0x0200_0000;
    /// The parameters were refused; the old ones are in force.
    pub const REFUSED: u32 = 0x0400_0000;
    /// What was in the memory could not be used; the loop has begun anew. Until ACK.
    pub const STATE_LOST: u32 = 0x0800_0000;
    /// There is no loop; OP is as it was.
    pub const NOT_RUNNING: u32 = 0x1000_0000;
}

/// Size of an instance for up to `delay` samples of dead time and latency \[bytes\]; 0: there is no such block.
pub(crate) fn size<T: Number>(delay: u32) -> usize {
    match crate::block::size::<T>(delay) {
        0 => 0,
        size => size + T::FB_FIXED + crate::block::ALIGN,
    }
}

/// Size of an instance that never has a compensator \[bytes\].
pub(crate) const fn size_without_compensator<T: Number>() -> usize {
    T::SIZE_WITHOUT_COMPENSATOR + T::FB_FIXED + crate::block::ALIGN
}
