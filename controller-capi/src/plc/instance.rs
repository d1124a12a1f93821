//! The memory of the function block: what it remembers itself, then the block of its loop.
//!
//! It may be at any address, aligned or not, and at another one in each call: an array of words in a runtime is moved, and
//! not every runtime aligns it. The contents begin at the first aligned address; where they are found elsewhere, they are
//! moved there first.

use super::Number;
use super::parameters::Refusal;
use super::period::Watch;
use super::vars::{Flags, Parameters, Reports, Results};
use crate::block::{ALIGN, Block};
use crate::fault::Error;
use core::ffi::c_void;

/// What the last sample gave; the calls without one give it again.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Given<T> {
    pub(crate) results: Results<T>,
    pub(crate) reports: Reports,
    pub(crate) flags: Flags,
}

/// A set of parameters that was refused: it is not tried again until it changes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Refused {
    /// Of its numbers; 0: the parameters are those in force.
    pub(crate) digest: u64,
    pub(crate) error: i32,
    pub(crate) refusal: Refusal,
}

/// What the block remembers between two calls, but for its loop.
#[repr(C, align(8))]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Instance<T> {
    magic: u32,
    /// Its complement.
    seal: u32,
    /// The parameters in force.
    pub(crate) parameters: Parameters<T>,
    pub(crate) refused: Refused,
    pub(crate) watch: Watch,
    /// Calls since the law ran.
    pub(crate) since: u32,
    /// 1: the law has run.
    pub(crate) ran: u8,
    /// Not 0: seen since the law ran.
    pub(crate) ack: u8,
    pub(crate) restart: u8,
    /// 1: what was there before could not be used, and nobody has acknowledged it.
    pub(crate) lost: u8,
    pub(crate) given: Given<T>,
}

impl<T: Number> Instance<T> {
    pub(crate) fn new(parameters: Parameters<T>, lost: bool) -> Self {
        Self {
            magic: T::FB_MAGIC,
            seal: !T::FB_MAGIC,
            parameters,
            refused: Refused::default(),
            watch: Watch::default(),
            since: 0,
            ran: 0,
            ack: 0,
            restart: 0,
            lost: u8::from(lost),
            given: Given::default(),
        }
    }
}

/// What is in the memory.
pub(crate) enum Contents {
    /// Zero bytes.
    Nothing,
    /// Something that this library has not written, or that has been damaged.
    Unknown,
    /// An instance and its loop.
    Running,
}

/// The caller's memory in one call.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The first aligned address.
    start: *mut u8,
    /// Bytes of the loop's block.
    pub(crate) loop_size: usize,
}

impl Place {
    /// Finds the contents and brings them to their place.
    ///
    /// # Errors
    /// Null; too small for a loop without a compensator, or for the loop that is there.
    ///
    /// # Safety
    /// `size` bytes at `state` are the caller's to read and write and are not used by anybody else meanwhile. If they begin
    /// like an instance, this library has written them.
    pub(crate) unsafe fn find<T: Number>(state: *mut c_void, size: usize) -> Result<(Self, Contents), Error> {
        if state.is_null() {
            return Err(Error::Null);
        }
        // What is left at every address.
        let usable = size.saturating_sub(ALIGN - 1) & !(ALIGN - 1);
        let loop_size = usable.saturating_sub(T::FB_FIXED);
        if loop_size < T::SIZE_WITHOUT_COMPENSATOR {
            return Err(Error::Size);
        }
        let memory: *mut u8 = state.cast();
        let offset = memory.addr().wrapping_neg() & (ALIGN - 1);
        let place = Self { start: memory.wrapping_add(offset), loop_size };
        // SAFETY: the offsets are less than what `usable` leaves, and a header is smaller than it.
        let header = |at: usize| unsafe { memory.wrapping_add(at).cast::<[u32; 2]>().read_unaligned() };
        let Some(found) =
            core::iter::once(offset).chain(0..ALIGN).find(|&at| header(at) == [T::FB_MAGIC, !T::FB_MAGIC])
        else {
            let nothing = header(offset) == [0, 0];
            return Ok((place, if nothing { Contents::Nothing } else { Contents::Unknown }));
        };
        if found != offset {
            // SAFETY: both are `usable` bytes within the `size` bytes of the caller; what the move leaves over is cleared, so
            // that it is not found again.
            unsafe {
                memory.wrapping_add(found).copy_to(place.start, usable);
                let (rest, count) = if found < offset {
                    (memory.wrapping_add(found), offset - found)
                } else {
                    (place.start.wrapping_add(usable), found - offset)
                };
                rest.write_bytes(0, count);
            }
        }
        // SAFETY: by the caller, with the sizes checked above.
        match unsafe { Block::<T>::open(place.loop_memory::<T>(), loop_size) } {
            Ok(_) => Ok((place, Contents::Running)),
            Err(Error::Size) => Err(Error::Size),
            Err(_) => Ok((place, Contents::Unknown)),
        }
    }

    /// The block of the loop.
    pub(crate) fn loop_memory<T: Number>(&self) -> *mut c_void {
        self.start.wrapping_add(T::FB_FIXED).cast()
    }

    /// # Safety
    /// As for [`find`](Self::find), and an instance has been found or written here. One reference at a time.
    pub(crate) unsafe fn instance<'a, T: Number>(&self) -> &'a mut Instance<T> {
        // SAFETY: aligned, and by the caller.
        unsafe { &mut *self.start.cast::<Instance<T>>() }
    }

    /// # Safety
    /// As for [`find`](Self::find).
    pub(crate) unsafe fn write<T: Number>(&self, instance: Instance<T>) {
        // SAFETY: aligned, and there is room for it.
        unsafe { self.start.cast::<Instance<T>>().write(instance) }
    }
}
